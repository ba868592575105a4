(** What a robot that maps every world has to do in each. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Folding Walks Bisimulation Parts Complete Subdivision.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** * The walk of a robot *)

Lemma percepts_rcons M (W : start) (p : W) doors i :
  percepts M p (rcons doors i) = rcons (percepts M p doors) (perceive M (walk p (rcons doors i) : W)).
Proof. by elim: doors p => [|j doors IH] p //=; rewrite IH. Qed.

Section Robot.

Variables (A : Type) (robot : strategy A) (M : marker).

Lemma situation_walk (W : start) n :
  situation robot (moving M W) n =
  (percepts M (facing W) (doors_taken robot M W n), walk (facing W) (doors_taken robot M W n)).
Proof.
elim: n => //= n IH; rewrite /history IH /=; case: (robot _) => // i.
by rewrite percepts_rcons -walk_rcons.
Qed.

Lemma history_walk (W : start) n :
  history robot (moving M W) n = percepts M (facing W) (doors_taken robot M W n).
Proof. by rewrite /history situation_walk. Qed.

Lemma size_doors_taken (W : start) n : size (doors_taken robot M W n) <= n.
Proof.
elim: n => //= n IH; case: (robot _) => [i|_]; first by rewrite size_rcons.
exact: leq_trans IH (leqnSn n).
Qed.

(** In a start where the walk has the same percepts, the robot does the same. *)
Lemma eq_doors_taken (V W : start) n :
  percepts M (facing V) (doors_taken robot M W n) = percepts M (facing W) (doors_taken robot M W n) ->
  doors_taken robot M V n = doors_taken robot M W n.
Proof.
elim: n => //= n IH; rewrite !history_walk; move: IH; set dV := doors_taken _ _ V n.
set dW := doors_taken _ _ W n => IH.
case decided: (robot (percepts M (facing W) dW)) => [i|a].
  rewrite !percepts_rcons => /rcons_inj[same _]; have -> := IH same.
  by rewrite same decided.
by move=> same; have -> := IH same; rewrite same decided.
Qed.

Lemma eq_history (V W : start) n :
  percepts M (facing V) (doors_taken robot M W n) = percepts M (facing W) (doors_taken robot M W n) ->
  history robot (moving M V) n = history robot (moving M W) n.
Proof. by move=> same; rewrite !history_walk (eq_doors_taken same). Qed.

End Robot.

(** If the walk of a robot that maps two starts has the same percepts in both, they are isomorphic. *)
Lemma mapped_iso (robot : strategy start) M (V W : start) n answer :
  maps_start (moving M) robot V -> maps_start (moving M) robot W ->
  robot (history robot (moving M W) n) = Answer answer ->
  percepts M (facing V) (doors_taken robot M W n) = percepts M (facing W) (doors_taken robot M W n) ->
  isomorphic_starts V W.
Proof.
move=> [map map_V iso_V] [map' map_W iso_W] answered /eq_history same.
have iso_a : isomorphic_starts answer V.
  by rewrite -(answers_inj map_V (ex_intro _ n (etrans (congr1 _ same) answered))).
have iso_b : isomorphic_starts answer W.
  by rewrite -(answers_inj map_W (ex_intro _ n answered)).
exact: isomorphic_starts_trans (isomorphic_starts_sym iso_a) iso_b.
Qed.

(** * Every edge *)

Lemma every_edge_is_traversed (robot : strategy start) :
  (forall W, maps_start (moving directional) robot W) ->
  forall (W : start) n answer, robot (history robot (moving directional W) n) = Answer answer ->
  forall d : W, traverses (facing W) (doors_taken robot directional W n) d.
Proof.
move=> maps_all W n answer answered d; apply: contraT => avoids.
have [f [iso _]] : isomorphic_starts (subdivided d) W.
  by apply: mapped_iso answered _ => //; apply: subdivided_percepts.
by case: (@subdivided_not_isomorphic W d); exists f.
Qed.

(** The darts of the edges that a walk goes over. *)
Fixpoint traversed (G : embedded_graph) (pose : G) doors : seq G :=
  if doors is i :: others then [:: turn pose i, traverse pose i & traversed (traverse pose i) others]
  else [::].

Lemma mem_traversed (G : embedded_graph) (pose : G) doors d :
  traverses pose doors d = (d \in traversed pose doors).
Proof. by elim: doors pose => //= i doors IH pose; rewrite IH !inE ![_ == d]eq_sym. Qed.

Lemma size_traversed (G : embedded_graph) (pose : G) doors :
  size (traversed pose doors) = 2 * size doors.
Proof. by elim: doors pose => //= i doors IH pose; rewrite IH mulnS. Qed.

Lemma edges_le_moves (G : embedded_graph) (pose : G) doors :
  (forall d, traverses pose doors d) -> edges G <= size doors.
Proof.
move=> all_edges; rewrite -(leq_pmul2l (m := 2)) // -card_darts -(size_traversed pose).
apply: leq_trans (card_size _); apply/subset_leq_card/subsetP=> d _.
by rewrite -mem_traversed.
Qed.

Lemma at_least_m_moves (robot : strategy start) :
  (forall W, maps_start (moving directional) robot W) ->
  forall (W : start) n answer, robot (history robot (moving directional W) n) = Answer answer ->
  edges W <= size (doors_taken robot directional W n).
Proof.
by move=> maps_all W n answer answered; apply/edges_le_moves/every_edge_is_traversed/answered.
Qed.
