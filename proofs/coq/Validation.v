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
move=> le; rewrite /traverse -turn_add -(turn_mod q (turned + _)) modnDmr.
by rewrite subnKC ?(leq_trans le) ?leq_addl // modnDr turn_mod.
Qed.

(** The robot set out from [t] and has walked by [before] to [q], where it should be at [pose]. *)
Lemma follow_spec darts (t q : W) pose turned before :
  pose < size S -> leads S (vertex S pose) darts 0 ->
  q = walk t before -> turned <= degree q -> (darts = [::] -> turned = 0) ->
  (before != [::] -> head 0 before < degree t) ->
  perceive directional q = expected S pose ->
  always directional (follow S (degree q) turned pose darts (taken t before)) (turn q turned)
    (fun ended r k =>
       match ended with
       | Confirmed pose' => [/\ place pose = q, pose' < size S, r = place pose' & k <= size darts]
       | Rejected i => [/\ place pose <> q, r = turn t i, i < degree t
                         & k <= 2 * size darts + size before]
       end).
Proof.
elim: darts q pose turned before => [|d darts IH] q pose turned before lt /=.
  move=> /eqP at_start _ _ /(_ erefl) -> _ /(sighting_tells_pose em lt at_start) same.
  by split.
case/andP=> /eqP same; case dd': (other S d) => [d'|//] /= path qE turned_le _ before_lt fits.
have [d'_lt _ _] := wf_other wf dd'.
set i := door_to S pose d.
have i_lt : i < degree q.
  have <- : doors S pose = degree q by case: fits => ->.
  by rewrite (door_to_lt em).
have goes_on : place pose = q -> place d' = traverse q i.
  by move=> <-; rewrite (traverse_known em lt dd' same).
rewrite traverse_turned // degree_turn ltn_pmod ?degree_gt0 //; split=> //; set q' := traverse q i.
have q'E : q' = walk t (rcons before i) by rewrite walk_rcons -qE.
have takenE : rcons (taken t before) (i, degree q) = taken t (rcons before i).
  by rewrite taken_rcons -qE.
have head_lt : head 0 (rcons before i) < degree t.
  case: (before) before_lt qE => [_ qt|j before' before_lt _]; last exact: before_lt.
  by rewrite /= -[t]/(walk t [::]) -qt.
rewrite takenE; case: eqP => [seen|unlike] /=.
  have := IH q' d' 0 (rcons before i) d'_lt path q'E (leq0n _) (fun _ => erefl) (fun _ => head_lt) seen.
  apply: always_weaken => -[pose'|j] r k [] placed.
    move=> pose'_lt -> k_le; split=> //.
    apply: (@traverse_inj _ i); rewrite -/q' -placed.
    exact: traverse_known.
  move=> -> j_lt k_le; split=> //; first by move/goes_on/placed.
  by move: k_le; rewrite size_rcons => k_le; arithmetic.
apply: always_moves_bind => /=; first by rewrite q'E way_back_passable.
rewrite q'E retrace_walk.
have -> : (head (0, 0) (taken t (rcons before i))).1 = head 0 (rcons before i).
  by case: (before).
split=> //.
  by move/goes_on => placed; apply: unlike; rewrite (expected_is_perceived em) // placed.
have -> : size (way_back (taken t (rcons before i))) = (size before).+1.
  by rewrite -[in RHS](size_taken t before) taken_rcons /way_back; case: (taken t before) => //= s l;
     rewrite size_rev size_map size_rcons.
by arithmetic.
Qed.

(** The robot has just reached a place, and has turned since. *)
Lemma follow_once (t : W) h path turned :
  h < size S -> leads S (vertex S h) path 0 -> turned < degree t -> (path = [::] -> turned = 0) ->
  expected S h = perceive directional t ->
  always directional (follow S (degree t) turned h path [::]) (turn t turned)
    (fun ended r k =>
       match ended with
       | Confirmed pose => [/\ place h = t, pose < size S, r = place pose & k <= size path]
       | Rejected i => [/\ place h <> t, r = turn t i, i < degree t & k <= 2 * size path]
       end).
Proof.
move=> lt leads_there turned_lt at_marker fits; rewrite -[2 * _]addn0.
exact: (@follow_spec path t t h turned [::]) lt leads_there erefl (ltnW turned_lt) at_marker _ (esym fits).
Qed.

End Validation.
