(** Aids with a front, and how a robot looks at them in place of a directional marker. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Aids Imitation.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** * Aids with a front *)

Lemma movable_directional_front : has_front movable_directional.
Proof.
exists (fun seen => (seen.1, if seen.2 is Some i then Pointing i else Nothing)) => W p /=; split=> //.
by rewrite /perceive /directional; case: ifP.
Qed.

Lemma directional_and_movable_front : has_front directional_and_movable.
Proof.
exists (fun seen => (seen.1, if seen.2.1 is Some i then Pointing i else Nothing)) => W p /=; split=> //.
by rewrite /perceive /directional; case: ifP.
Qed.

Lemma team_front others : 0 < others -> has_front (team true others).
Proof.
case: others => // others _.
exists (fun seen => (seen.1, if seen.2 is Here (Some i) :: _ then Pointing i else Nothing)) => W p /=; split=> //.
by rewrite /perceive /directional /companion_seen /=; case: ifP.
Qed.

(** * It looks like a directional marker *)

Section Front.

Variables (X : aid) (read : nat * sightings X -> percept).

(** The robot reads its percepts as those of a robot with a directional marker. *)
Definition read_front (seen : nat * sightings X) : look (nat * sightings X) (action_with (aid_action X)) percept :=
  Know (read seen).

Variable W : start.
Hypothesis front : forall p : W,
  let first := first_placed X (facing W) in
  [/\ read (degree p, shows p first) = perceive directional p, can_leave first p & leave first p = first].

(** Nothing happens to the aid. *)
Definition untouched (p : W) (s : state (with_aid X W)) : Prop := s = (p, first_placed X (facing W)).

Lemma untouched_pose p s : untouched p s -> s.1 = p.
Proof. by move->. Qed.

Lemma untouched_first :
  ends (read_front (sense (first_state (with_aid X W)))) (first_state (with_aid X W)) (fun o s k m =>
    [/\ o = perceive directional (facing W), untouched (facing W) s, k <= 0 & m <= 0]).
Proof. by have [same _ _] := front (facing W); rewrite /= same. Qed.

Lemma untouched_next p s i : untouched p s -> i < degree p ->
  possible s (Take i) /\
  ends (read_front (sense (next_state s (Take i)))) (next_state s (Take i)) (fun o s' k m =>
    [/\ o = perceive directional (traverse p i), untouched (traverse p i) s', k <= 0 & m <= 0]).
Proof.
move=> -> lt /=; have [_ -> ->] := front (turn p i); rewrite lt /=; split=> //.
by have [-> _ _] := front (traverse p i).
Qed.

End Front.
