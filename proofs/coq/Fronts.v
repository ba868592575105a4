(** A robot whose aid has a front can do whatever a robot with a directional marker does, with the same moves. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Aids Algorithm1 Walks Bisimulation Impossible Correct Mapper.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** * Aids with a front *)

Lemma movable_directional_front : has_front movable_directional.
Proof.
exists (fun seen => (seen.1, if seen.2 is Some i then Pointing i else Nothing)) => W p /=; split=> //.
by rewrite /perceive /directional; case: ifP.
Qed.

Lemma team_front others : 0 < others -> has_front (team true others).
Proof.
case: others => // others _.
exists (fun seen => (seen.1, if seen.2 is Here (Some i) :: _ then Pointing i else Nothing)) => W p /=; split=> //.
by rewrite /perceive /directional /companion_seen /=; case: ifP.
Qed.

(** * The same robot with another aid *)

Section Simulation.

Variables (X : aid) (read : nat * sightings X -> percept) (A : Type) (robot : strategy A).

(** It reads its percepts as those of a robot with a directional marker, and only takes doors. *)
Definition reading : robot_of (nat * sightings X) (action_with (aid_action X)) A := fun past =>
  match robot (map read past) with Act i => Act (Take i) | Answer a => Answer a end.

Variable W : start.
Hypothesis front : forall p : W,
  let first := first_placed X (facing W) in
  [/\ read (degree p, shows p first) = perceive directional p, can_leave first p & leave first p = first].

Lemma reading_situation n :
  (map read (situation reading (with_aid X W) n).1, (situation reading (with_aid X W) n).2) =
  ((situation robot (moving directional W) n).1,
   ((situation robot (moving directional W) n).2, first_placed X (facing W))).
Proof.
elim: n => [|n] /=; first by have [-> _ _] := front (facing W).
case: (situation reading _ n) => past s /=; case: (situation robot _ n) => past' p /= [same ->].
rewrite /reading same; case: (robot past') => [i|a] /=; last by rewrite same.
have [_ -> ->] := front (turn p i); rewrite /= map_rcons same.
by have [-> _ _] := front (traverse p i).
Qed.

Lemma reading_history n :
  reading (history reading (with_aid X W) n) =
  match robot (history robot (moving directional W) n) with Act i => Act (Take i) | Answer a => Answer a end.
Proof. by have [same _] := reading_situation n; rewrite /history /reading same. Qed.

Lemma reading_state n :
  (situation reading (with_aid X W) n).2 =
  ((situation robot (moving directional W) n).2, first_placed X (facing W)).
Proof. by have [_] := reading_situation n. Qed.

Lemma reading_possible n e : (forall i, robot (history robot (moving directional W) n) = Act i ->
    i < degree (situation robot (moving directional W) n).2) ->
  reading (history reading (with_aid X W) n) = Act e ->
  possible (situation reading (with_aid X W) n).2 e.
Proof.
move=> doors; rewrite reading_history; case does: (robot _) => [i|a] //= [<-]; rewrite reading_state /=.
by rewrite doors //; have [_ ->] := front (turn (situation robot (moving directional W) n).2 i).
Qed.

End Simulation.

(** * So such an aid suffices *)

Section Front.

Variable X : aid.
Hypothesis front : has_front X.

Lemma front_locates : exists robot : robot_of (nat * sightings X) (action_with (aid_action X)) located,
  forall W : start, exists map n,
    [/\ robot (history robot (with_aid X W) n) = Answer map,
        exists f : map -> W, [/\ isomorphism f, f (facing map) = facing W
          & f (Algorithm1.robot map) = (situation robot (with_aid X W) n).2.1],
        forall j e, robot (history robot (with_aid X W) j) = Act e ->
          possible (situation robot (with_aid X W) j).2 e
      & n <= cost W (edges W)].
Proof.
have [read reads] := front; exists (reading read locating_mapper) => W.
have [map [n [answered located doors n_le]]] := locating_mapper_maps W; exists map, n.
split=> //; first by rewrite (reading_history _ (reads W)) answered.
  by rewrite (reading_state _ (reads W)).
by move=> j e; apply: (reading_possible (reads W)) => i; apply: doors.
Qed.

Lemma front_determines V W : bisimilar (with_aid X) V W -> isomorphic_starts V W.
Proof.
have [read reads] := front; move=> same.
have maps_W (U : start) : maps_start (with_aid X) (reading read mapper) U.
  have [map [n answered] iso] := mapper_maps U; exists map => //; exists n.
  by rewrite (reading_history _ (reads U)) answered.
exact: bisimilar_maps_start same (maps_W V) (maps_W W).
Qed.

End Front.
