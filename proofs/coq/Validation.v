(** A hypothesis is confirmed exactly when it is true. Section 2.3, lines 8 to 17. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program Algorithm1 Walks Arithmetic Always Maps Embedding.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Section Validation.

Variables (S : partial_map) (W : start) (place : nat -> W).
Hypothesis em : embeds S place.

Let wf := em_wf em.

(** Leaving by a door, as counted by a robot that has turned. *)
Lemma traverse_turned (q : W) turned i : turned <= degree q ->
  traverse (turn q turned) ((i + degree q - turned) %% degree q) = traverse q i.
Proof.
move=> le; rewrite /traverse -turnD -(turn_mod q (turned + _)) modnDmr.
by rewrite subnKC ?(leq_trans le) ?leq_addl // modnDr turn_mod.
Qed.

(** Turned in the map as in the world. *)
Lemma turned_to_known d i : d < size S ->
  turned_to S d i < size S /\ place (turned_to S d i) = turn (place d) i.
Proof.
move=> lt; have [bounds out] := wf_bounds wf lt; have gt0 := doors_gt0 em lt.
have near : vertex S d <= turned_to S d i < vertex S d + doors S d by rewrite leq_addr ltn_add2l ltn_pmod.
have e_lt : turned_to S d i < size S by case/andP: near => _ e_lt; apply: leq_trans e_lt out.
have [same _] := wf_same wf lt near; split=> //.
rewrite (em_turn em e_lt) same (em_turn em lt) -turnD addKn.
by rewrite -(degree_vertex em) // turn_mod.
Qed.

Variable test : hypothesis_test.
Hypothesis test_valid : valid test.

(** The robot set out from [t], has walked by [before] to [q], and goes back. *)
Lemma reject_spec (t q : W) turned before :
  q = walk t before -> turned < degree q -> (before != [::] -> turned = 0 /\ head 0 before < degree t) ->
  always (moving directional W)
    (moves (way_back (taken t before)) ;; Return (Rejected (head (turned, 0) (taken t before)).1))
    (turn q turned)
    (fun ended r k => exists i, [/\ ended = Rejected i, r = turn t i, i < degree t & k = size before]).
Proof.
move=> qE turned_lt; case: before qE => [qE _|i before qE /(_ isT)[-> i_lt]].
  by rewrite qE in turned_lt *; exists turned.
apply: always_moves_bind; first by rewrite qE; apply: way_back_passable.
rewrite -[turn q 0]/q qE way_backK; exists i; split=> //.
by rewrite addn0 /= size_rev size_map size_taken.
Qed.

(** The robot should then be at [pose]. If it is there, all percepts have matched; and if they have at the end,
    it is there. *)
Lemma follow_spec darts (t q : W) pose (matched : bool) turned before :
  pose < size S -> leads S (vertex S pose) darts 0 ->
  q = walk t before -> turned < degree q -> (before != [::] -> turned = 0 /\ head 0 before < degree t) ->
  (place pose = q -> matched) -> (darts = [::] -> matched -> perceive directional q = expected S pose) ->
  always (moving directional W) (follow test S matched (degree q) turned pose darts (taken t before)) (turn q turned)
    (fun ended r k =>
       match ended with
       | Confirmed pose' => [/\ place pose = q, pose' < size S, r = place pose' & k <= size darts]
       | Rejected i => [/\ place pose <> q, r = turn t i, i < degree t
                         & k <= 2 * size darts + size before]
       end).
Proof.
elim: darts q pose matched turned before => [|d darts IH] q pose matched turned before lt /=.
  move=> /eqP at_start qE turned_lt back if_true; case: matched if_true => [_|false_pose] at_end /=.
    have placed := expected_inj em lt at_start (at_end erefl isT).
    by have [ok ->] := turned_to_known turned lt; rewrite placed.
  apply: alwaysW (reject_spec qE turned_lt back) => _ r k [i [-> -> i_lt ->]].
  by split=> // /false_pose.
case/andP=> /eqP same; case dd': (other S d) => [d'|//] /= path qE turned_lt back if_true _.
have [d'_lt _ _] := wf_other wf dd'.
set i := door_to S pose d.
have goes_on_true : place pose = q -> matched && (i < degree q).
  by move=> placed; rewrite (if_true placed) -placed -(em_doors em lt) (door_to_lt em).
case: ifP => [/andP[_ i_lt]|stuck]; last first.
  apply: alwaysW (reject_spec qE turned_lt back) => _ r k [j [-> -> j_lt ->]]; split=> //.
    by move/goes_on_true/andP=> [ok i_lt]; rewrite ok i_lt in stuck.
  exact: leq_addl.
rewrite /= traverse_turned ?(ltnW turned_lt) // degree_turn ltn_pmod ?degree_gt0 //; split=> //; set q' := traverse q i.
have q'E : q' = walk t (rcons before i) by rewrite walk_rcons -qE.
have -> : rcons (taken t before) (i, degree q) = taken t (rcons before i) by rewrite taken_rcons -qE.
have head_lt : head 0 (rcons before i) < degree t.
  case: (before) back qE => [_ qt|j before' back _]; last by case: back.
  by rewrite /= -[t]/(walk t [::]) -qt.
have was_there : place d' = q' -> place pose = q.
  by rewrite -(traverse_known em lt dd' same) => /traverse_inj.
set matched' := matched && _.
have if_true' : place d' = q' -> matched'.
  move=> placed; rewrite /matched' (if_true (was_there placed)) -placed -(expectedE em) //.
  exact: matches_expected.
have at_end : darts = [::] -> matched' -> perceive directional q' = expected S d'.
  by rewrite /matched' => -> /andP[_]; apply: matches_at_end.
have := IH q' d' matched' 0 (rcons before i) d'_lt path q'E (degree_gt0 _) (fun _ => conj erefl head_lt)
  if_true' at_end.
apply: alwaysW => -[pose'|j] r k [].
  by move/was_there=> -> pose'_lt -> k_le; split.
move=> placed -> j_lt k_le; split=> //.
  by move=> there; apply: placed; rewrite -(traverse_known em lt dd' same) there.
by move: k_le; rewrite size_rcons => k_le; arithmetic.
Qed.

(** The robot has just reached a place, and has turned since. *)
Lemma validate_spec (t : W) h path turned :
  h < size S -> leads S (vertex S h) path 0 -> turned < degree t ->
  always (moving directional W) (validate test S (perceive directional t) turned h path) (turn t turned)
    (fun ended r k =>
       match ended with
       | Confirmed pose => [/\ place h = t, pose < size S, r = place pose & k <= size path]
       | Rejected i => [/\ place h <> t, r = turn t i, i < degree t & k <= 2 * size path]
       end).
Proof.
move=> lt leads_there turned_lt; rewrite -[2 * _]addn0.
apply: (@follow_spec path t t h _ turned [::]) => // [<-|->].
  by rewrite -(expectedE em) // matches_expected.
exact: matches_at_end.
Qed.

End Validation.
