(** What the checker follows of a run with a marker that is carried is what a robot does and perceives. *)

From Coq Require Import BinNat FMapPositive.
From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Markers Walks Aids Verdicts Checker CheckerTables CheckerSteps.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Section Runs.

Variables (T : tables) (W : start) (number : W -> N) (word : aid_word).
Hypothesis T_fits : fits T number.

(** The state of the aid, by the place of the marker. *)
Definition marker_at (word : aid_word) : option W -> placed (aid_of word) W :=
  match word with WordMovable => fun place => [:: place] | WordMovableDirectional => id end.

Let robot (p : W) (place : option W) : state (with_aid (aid_of word) W) := (p, marker_at word place).

Lemma lies_inE p place : lies_in T (number p) (omap number place) = lies_at p place.
Proof. by case: place => //= spot; rewrite same_vertex_inE. Qed.

Lemma aid_seen_inE p place :
  sighting_of (aid_seen_in T word (number p) (omap number place)) =
  seen_of_aid (Aids.shows p (marker_at word place : placed (aid_of word) W)).
Proof.
rewrite /aid_seen_in /marker_at; case: word; case: place => [spot|] //=; rewrite same_vertex_inE //.
  by rewrite addn0; case: ifP.
by case: ifP => //= near; rewrite door_inE.
Qed.

Lemma senses_inE p place seen : senses_in T word (number p) (omap number place) seen <-> senses (robot p place) seen.
Proof.
case: seen => g s; rewrite /senses_in /senses /= eqbP degree_inE // same_sightingP aid_seen_inE.
split=> [/andP[/eqP gE /eqP sE]|[-> sE]]; first by rewrite /percept_of /= gE sE.
by rewrite eqxx sE eqxx.
Qed.

Lemma after_deedE p place d :
  if after_deed T (number p) (omap number place) d is Some (e, place') then
    possible (robot p place) (action_of word d) /\
    exists q spot, [/\ e = number q, place' = omap number spot
                     & next_state (robot p place) (action_of word d) = robot q spot]
  else ~~ possible (robot p place) (action_of word d).
Proof.
case: d => [i||] /=.
- rewrite ltbP degree_inE //; have -> : action_of word (DeedDoor i) = Take (N.to_nat i) by case: word.
  case: ifP => lt; last by rewrite /robot; case: (word); rewrite /= ?lt.
  split; first by rewrite /robot; case: (word); rewrite /= ?lt.
  exists (traverse p (N.to_nat i)), place; rewrite traverse_inE //; split=> //.
  by rewrite /robot; case: (word).
- rewrite lies_inE; rewrite /robot; case: (word) => /=; rewrite ?orbF; case: ifP => here; rewrite ?here //.
    by split=> //; exists p, None.
  by split=> //; exists p, None.
by rewrite /robot; case: (word); case: place => //=; split=> //; exists p, (Some p).
Qed.

Lemma wrong_deedE n p place deeds :
  wrong_deed T word n (number p) (omap number place) deeds = None <-> does (robot p place) deeds.
Proof.
elim: deeds n p place => //= -[d seen] deeds IH n p place; have := after_deedE p place d.
case: (after_deed _ _ _ _) => [[e place']|] /=; last by move/negP=> not; split=> // -[].
case=> can [q [spot [-> -> nextE]]]; rewrite nextE; split.
  by case: ifP => // sees /IH later; split=> //; case: seen sees => // seen /senses_inE.
case=> _ sees /IH later.
have -> : (if seen is Some seen then senses_in T word (number q) (omap number spot) seen else true) = true.
  by case: seen sees => // seen /senses_inE.
exact: later.
Qed.

End Runs.

Lemma wrong_in_runE T (W : start) (number : W -> N) (r : run_text) (p : W) : fits T number ->
  wrong_in_run T (aid_line r) r (number p) = None <-> runs r p.
Proof.
move=> T_fits; have facingE : Some (facing_dart T) = omap number (Some (facing W)).
  by rewrite /= (facing_dartE T_fits).
rewrite /wrong_in_run facingE /runs.
have -> : first_placed (aid_of (aid_line r)) (facing W) = marker_at (aid_line r) (Some (facing W)).
  by case: (aid_line r).
split; last by case=> /(senses_inE _ T_fits)-> /(wrong_deedE _ T_fits).
by case: ifP => // /(senses_inE _ T_fits) sees /(wrong_deedE _ T_fits).
Qed.
