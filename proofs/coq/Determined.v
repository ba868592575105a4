(** A robot maps every world exactly if its folded trail is complete whenever it answers. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Folding Walks Bisimulation Separates Parts Moves Trail Unfolding.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Lemma isomorphic_sees (V W : start) doors : isomorphic_starts V W -> sees V doors = sees W doors.
Proof.
by move=> iso; apply: (isomorphic_starts_indistinguishable directional_invariant iso).
Qed.

(** A robot that maps every world goes on until no dart is open. *)
Lemma mapped_complete (robot : strategy start) :
  (forall W, maps_start (moving directional) robot W) ->
  forall (W : start) n answer, robot (history robot (moving directional W) n) = Answer answer ->
  complete (doors_taken robot directional W n) (history robot (moving directional W) n).
Proof.
move=> maps_all W n answer answered k i; rewrite history_walk; set doors := doors_taken _ _ _ _.
rewrite -/(sees W doors) => lt _; case: (@followed_orN W doors k i lt) => // open.
have [V [V' [V_W V'_W differ _ _]]] := open_folding_ambiguous lt open; case: differ.
have [f [f_iso _]] : isomorphic_starts V V'.
  have to_W X : sees X doors = sees W doors -> isomorphic_starts X W.
    exact: mapped_iso (maps_all X) (maps_all W) answered.
  exact: isomorphic_starts_trans (to_W V V_W) (isomorphic_starts_sym (to_W V' V'_W)).
by exists f.
Qed.

Lemma correct_iff_complete (robot : strategy start) :
  (forall W, maps_start (moving directional) robot W) <->
  (forall W, exists n map,
     let past := history robot (moving directional W) n in
     let doors := doors_taken robot directional W n in
     [/\ robot past = Answer map, sees map doors = past & complete doors past]).
Proof.
split=> [maps_all|ends] W.
  have [map [n answered] iso] := maps_all W; exists n, map; split=> //.
    by rewrite history_walk; apply: isomorphic_sees.
  exact: mapped_complete answered.
have [n [map [answered same complete_W]]] := ends W; exists map; first by exists n.
move: same complete_W; rewrite history_walk -/(sees W _).
exact: complete_folding_determines.
Qed.
