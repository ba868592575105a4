(** A directional marker separates: starts that are indistinguishable with it are isomorphic. Section 2.3.
    *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Walks Bisimulation.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** * Isomorphic starts give the same percepts *)

(** A marker that sees no more than what an isomorphism keeps. *)
Definition invariant (M : marker) :=
  forall (V W : start) (f : V -> W), isomorphism f -> f (facing V) = facing W ->
    forall p, M W (f p) = M V p.

Lemma no_marker_invariant : invariant no_marker.
Proof. by []. Qed.

Lemma undirected_invariant : invariant undirected.
Proof. by move=> V W f iso start_f p; rewrite /undirected -start_f isomorphism_same_vertex. Qed.

Lemma directional_invariant : invariant directional.
Proof.
by move=> V W f iso start_f p; rewrite /directional -start_f isomorphism_same_vertex // isomorphism_findex.
Qed.

Lemma isomorphic_starts_indistinguishable M V W :
  invariant M -> isomorphic_starts V W -> indistinguishable M V W.
Proof.
move=> M_inv [f [iso start_f]] doors; apply: eq_percepts => {}doors.
by rewrite -start_f -isomorphism_walk // /perceive isomorphism_degree // M_inv.
Qed.

(** * With a directional marker, only isomorphic starts do *)

(** Only at the facing dart does the marker point along door 0. *)
Lemma pointing0P (W : start) (p : W) : directional p = Pointing 0 <-> p = facing W.
Proof.
rewrite /directional; split=> [|->]; last by rewrite same_vertex_refl findex0.
by case: ifP => // _ [] /eqP; rewrite findex_eq0 => /eqP.
Qed.

Section Bijection.

Variables V W : start.

Let reachable (p : V) : exists doors, walk (facing V) doors == p.
Proof. by have [doors <-] := connected_walk (facing V) p; exists doors; apply/eqP. Qed.

(** The end in [W] of a door sequence that leads to [p] in [V]. *)
Definition counterpart (p : V) : W := walk (facing W) (xchoose (reachable p)).

Hypothesis same : indistinguishable directional V W.

(** The end does not depend on the sequence: from there back to the marker, both come to the facing dart.
    *)
Lemma counterpart_walk doors : counterpart (walk (facing V) doors) = walk (facing W) doors.
Proof.
rewrite /counterpart; set other := xchoose _.
have V_same : walk (facing V) other = walk (facing V) doors := eqP (xchooseP (reachable _)).
have [back V_back] := connected_walk (walk (facing V) doors) (facing V).
have W_back ds : walk (facing V) ds = walk (facing V) doors -> walk (walk (facing W) ds) back = facing W.
  move=> V_ds; apply/pointing0P; rewrite -walk_cat.
  have := congr1 (last (0, Nothing)) (same (ds ++ back)); rewrite !last_percepts => -[_ <-].
  by apply/pointing0P; rewrite walk_cat V_ds.
by apply: (@walk_inj _ back); rewrite /= !W_back.
Qed.

End Bijection.

Lemma indistinguishable_directional V W : indistinguishable directional V W -> isomorphic_starts V W.
Proof.
move=> VW; have WV := indistinguishable_sym VW; exists (counterpart W); split.
  split=> [|p|p].
  - exists (counterpart V) => p; have [ds <-] := connected_walk (facing _) p;
      by rewrite !counterpart_walk.
  - have [ds <-] := connected_walk (facing _) p.
    by rewrite -[opposite _]walk_opposite -walk_cat !counterpart_walk // walk_cat.
  have [ds <-] := connected_walk (facing _) p.
  by rewrite -!walk_clockwise -walk_cat !counterpart_walk // walk_cat.
exact: (counterpart_walk VW [::]).
Qed.

Corollary indistinguishable_directionalP V W : indistinguishable directional V W <-> isomorphic_starts V W.
Proof.
split; first exact: indistinguishable_directional.
exact: isomorphic_starts_indistinguishable directional_invariant.
Qed.
