(** Facts about walks: turns are counted modulo the degree, a walk can be undone, and some walk leads from
    every pose to every other. Section 2.1. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Section Walks.

Variable G : embedded_graph.
Implicit Types (p q r : G) (i j : door) (ds : seq door).

Lemma opposite_inj : injective (@opposite G).
Proof. exact: inv_inj (@oppositeK G). Qed.

(** * Vertices and turns *)

Lemma same_vertex_refl p : same_vertex p p.
Proof. exact: connect0. Qed.

Lemma same_vertex_sym p q : same_vertex p q = same_vertex q p.
Proof. exact: fconnect_sym (@clockwise_inj G) p q. Qed.

Lemma same_vertex_trans p q r : same_vertex p q -> same_vertex q r -> same_vertex p r.
Proof. exact: connect_trans. Qed.

Lemma same_vertex_turn p i : same_vertex p (turn p i).
Proof. exact: fconnect_iter. Qed.

Lemma same_vertexP p q : reflect (exists i, q = turn p i) (same_vertex p q).
Proof.
apply: (iffP idP) => [pq | [i ->]]; last exact: same_vertex_turn.
by exists (findex clockwise p q); rewrite /turn iter_findex.
Qed.

Lemma degree_gt0 p : 0 < degree p.
Proof. exact: order_gt0. Qed.

Lemma same_vertex_degree p q : same_vertex p q -> degree p = degree q.
Proof.
move=> pq; apply: eq_card; exact: same_connect (fconnect_sym (@clockwise_inj G)) _ _ pq.
Qed.

Lemma degree_turn p i : degree (turn p i) = degree p.
Proof. by rewrite -(same_vertex_degree (same_vertex_turn p i)). Qed.

Lemma turnD p i j : turn p (i + j) = turn (turn p i) j.
Proof. by rewrite /turn addnC iterD. Qed.

Lemma turn_inj i : injective (fun p => turn p i).
Proof. by elim: i => [|i IH] p q //= /(@clockwise_inj G) /IH. Qed.

Lemma turn_degree p : turn p (degree p) = p.
Proof. exact: iter_order (@clockwise_inj G) p. Qed.

Lemma turn_mod p i : turn p (i %% degree p) = turn p i.
Proof.
rewrite [in RHS](divn_eq i (degree p)) turnD; congr turn.
by elim: (i %/ _) => // k IH; rewrite mulSn turnD turn_degree.
Qed.

Lemma inverse_doorK p i : turn (turn p i) (inverse_door (degree p) i) = p.
Proof.
rewrite -(turn_mod p i) -[in inverse_door _ _](degree_turn p (i %% degree p)) /inverse_door turn_mod.
by rewrite degree_turn -turnD subnKC ?turn_degree // ltnW // ltn_pmod // degree_gt0.
Qed.

(** * Walks *)

Lemma traverse_inj i : injective (fun p => traverse p i).
Proof. by move=> p q /opposite_inj /turn_inj. Qed.

Lemma walk_cat p ds es : walk p (ds ++ es) = walk (walk p ds) es.
Proof. exact: foldl_cat. Qed.

Lemma walk_rcons p ds i : walk p (rcons ds i) = traverse (walk p ds) i.
Proof. by rewrite -cats1 walk_cat. Qed.

(** The same doors never lead two poses to the same pose. *)
Lemma walk_inj ds : injective (fun p => walk p ds).
Proof. by elim: ds => [|i ds IH] p q //= /IH /traverse_inj. Qed.

Lemma walk_opposite p : walk p [:: 0] = opposite p.
Proof. by []. Qed.

Lemma walk_clockwise p : walk p [:: 1; 0] = clockwise p.
Proof. exact: oppositeK. Qed.

(** Everything can be reached. *)
Lemma connected_walk p q : exists ds, walk p ds = q.
Proof.
have /connectP[s path_s ->] := connected p q; elim: s p path_s => [|r s IH] p /=; first by exists [::].
case/andP=> step /IH[ds <-]; case/orP: step => /eqP->; first by exists (0 :: ds).
by exists ([:: 1; 0] ++ ds); rewrite walk_cat walk_clockwise.
Qed.

(** * The way back *)

Lemma size_taken p ds : size (taken p ds) = size ds.
Proof. by elim: ds p => //= i ds IH p; rewrite IH. Qed.

Lemma taken_cat p ds es : taken p (ds ++ es) = taken p ds ++ taken (walk p ds) es.
Proof. by elim: ds p => //= i ds IH p; rewrite IH. Qed.

Lemma taken_rcons p ds i : taken p (rcons ds i) = rcons (taken p ds) (i, degree (walk p ds)).
Proof. by rewrite -!cats1 taken_cat. Qed.

(** The way back ends where the walk began, turned by its first door. *)
Lemma way_backK p ds : walk (walk p ds) (way_back (taken p ds)) = turn p (head 0 ds).
Proof.
case: ds => // i ds; elim: ds p i => [|j ds IH] p i; first exact: oppositeK.
pose p' := traverse p i; pose back := way_back (taken p' (j :: ds)).
have -> : way_back (taken p (i :: j :: ds)) = rcons back (inverse_door (degree p') j).
  by rewrite /back /= rev_cons.
rewrite walk_rcons [walk _ _]IH /traverse inverse_doorK; exact: oppositeK.
Qed.

(** Whether the doors of a walk are below the degrees of their vertices, as those of a real robot are. *)
Fixpoint passable (pose : G) (doors : seq door) : bool :=
  if doors is i :: others then (i < degree pose) && passable (traverse pose i) others else true.

Lemma passable_rcons p ds i : passable p (rcons ds i) = passable p ds && (i < degree (walk p ds)).
Proof. by elim: ds p => [|j ds IH] p /=; rewrite ?andbT // IH andbA. Qed.

Lemma way_back_passable p ds : passable (walk p ds) (way_back (taken p ds)).
Proof.
case: ds => // i ds; elim: ds p i => [|j ds IH] p i; first by rewrite /= degree_gt0.
pose p' := traverse p i; pose back := way_back (taken p' (j :: ds)).
have -> : way_back (taken p (i :: j :: ds)) = rcons back (inverse_door (degree p') j).
  by rewrite /back /= rev_cons.
have back_to : walk (walk p [:: i, j & ds]) back = turn p' j := way_backK p' (j :: ds).
by rewrite passable_rcons [passable _ _]IH back_to degree_turn ltn_pmod ?degree_gt0.
Qed.

End Walks.

(** * Percepts *)

Section Percepts.

Variables (M : marker) (W : start).
Implicit Types (p : W) (ds es : seq door).

Lemma last_percepts x p ds : last x (percepts M p ds) = perceive M (W := W) (walk p ds).
Proof. by elim: ds x p => //= i ds IH x p; rewrite IH. Qed.

(** The percepts along a door sequence are equal from two poses if those at its ends always are. *)
Lemma eq_percepts V (q : graph V) p :
  (forall ds, perceive M (W := V) (walk q ds) = perceive M (W := W) (walk p ds)) ->
  forall ds, percepts M q ds = percepts M p ds.
Proof.
move=> same ds; elim: ds p q same => [|i ds IH] p q same /=; first by rewrite (same [::]).
by rewrite (same [::]) (IH (traverse p i) (traverse q i)) // => es; exact: (same (i :: es)).
Qed.

End Percepts.
