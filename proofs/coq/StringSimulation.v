(** A robot with a string can do whatever a robot with a directional marker does. It lays the string over the edge
    behind it at the start, and comes back. If that edge is a loop, it takes the free end again at each visit, to see
    which of the two doors is which. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Aids Algorithm1 Walks Arithmetic Bisimulation Parts Impossible Correct Mapper.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Section Simulation.

Variables (length : nat) (A : Type) (robot : strategy A).

Notation seen_with_string := (nat * string_view)%type.

(** What the robot does next, when the string is laid. [past] are the percepts that the simulated robot has had.
    - [Ready past]: what the simulated robot does.
    - [TakeEnd past]: pick up the free end, to see through which door it runs.
    - [LeaveEnd past]: drop it again. *)
Inductive plan := Ready of seq percept | TakeEnd of seq percept | LeaveEnd of seq percept.

Definition arrive past (seen : seen_with_string) : plan :=
  if fixed_here seen.2 then
    if runs_through seen.2 is [:: i] then Ready (rcons past (seen.1, Pointing i)) else TakeEnd past
  else Ready (rcons past (seen.1, Nothing)).

Definition decide (p : plan) : decision (action_with holding) A :=
  match p with
  | Ready past => match robot past with Act i => Act (Take i) | Answer a => Answer a end
  | TakeEnd _ => Act (Use PickUp)
  | LeaveEnd _ => Act (Use Drop)
  end.

Definition continue (p : plan) (seen : seen_with_string) : plan :=
  match p with
  | Ready past => arrive past seen
  | TakeEnd past =>
      let others := [seq i <- runs_through seen.2 | from_hand seen.2 != Some i] in
      LeaveEnd (rcons past (seen.1, Pointing (head 0 others)))
  | LeaveEnd past => Ready past
  end.

(** Its first actions lay the string: go by door 0, drop the end, come back. *)
Definition simulating : robot_of seen_with_string (action_with holding) A := fun past =>
  match past with
  | [:: _; _] => Act (Use Drop)
  | _ :: _ :: _ :: seen :: later => decide (foldl continue (arrive [::] seen) later)
  | _ => Act (Take 0)
  end.

Variable W : start.
Hypothesis length_gt0 : 0 < length.

Let I := with_aid (string length) W.
Let f := facing W.

(** The string lies over the facing edge. *)
Definition laid (free : option W) : string_place W := StringPlace f [:: f] free.

(** * What the robot sees then *)

Lemma turn_is (p d : W) i : same_vertex p d -> i < degree p -> (turn p i == d) = (i == findex clockwise p d).
Proof.
move=> pd lt; apply/eqP/eqP => [<-|->]; first by rewrite findex_turn.
exact: iter_findex.
Qed.

Lemma doors_to (p d : W) : same_vertex p d -> [seq i <- iota 0 (degree p) | turn p i == d] = [:: findex clockwise p d].
Proof.
move=> pd; rewrite -(@filter_pred1_uniq _ (iota 0 (degree p))) ?iota_uniq ?mem_iota ?findex_max //.
by apply: eq_in_filter => i; rewrite mem_iota => /andP[_ lt]; rewrite turn_is.
Qed.

Lemma over_facing free d : runs_over (laid free) d = (d == f) || (d == opposite f).
Proof. by rewrite /runs_over /= orbF. Qed.

(** If the edge is no loop, it runs through one door of the start vertex. *)
Lemma one_door (p : W) free : same_vertex p f -> ~~ same_vertex f (opposite f) ->
  [seq i <- iota 0 (degree p) | runs_over (laid free) (turn p i)] = [:: findex clockwise p f].
Proof.
move=> pf not_loop; rewrite -(doors_to pf); apply: eq_filter => i; rewrite over_facing.
case: (turn p i =P opposite f) => [back|_]; last exact: orbF.
have := not_loop; rewrite -back (same_vertex_trans _ (same_vertex_turn p i)) //.
by rewrite same_vertex_sym.
Qed.

(** If it is a loop, through two, one of which is that of the other end. *)
Lemma two_doors (p : W) free i : same_vertex p f -> same_vertex f (opposite f) ->
  [seq i <- iota 0 (degree p) | runs_over (laid free) (turn p i)] <> [:: i].
Proof.
move=> pf loop one; have pb := same_vertex_trans pf loop.
have there (d : W) : same_vertex p d -> (d == f) || (d == opposite f) -> findex clockwise p d = i.
  move=> pd on; apply/eqP; rewrite -mem_seq1 -one mem_filter over_facing mem_iota /= findex_max // andbT.
  by rewrite /turn iter_findex.
have f_i : findex clockwise p f = i by apply: there; rewrite ?eqxx.
have b_i : findex clockwise p (opposite f) = i by apply: there; rewrite ?eqxx ?orbT.
have /eqP[] := opposite_neq f; rewrite -[LHS](iter_findex pb) -[RHS](iter_findex pf) f_i b_i.
by [].
Qed.

Lemma other_door (p : W) free : same_vertex p f -> same_vertex f (opposite f) ->
  [seq i <- [seq i <- iota 0 (degree p) | runs_over (laid free) (turn p i)]
     | Some (findex clockwise p (opposite f)) != Some i] = [:: findex clockwise p f].
Proof.
move=> pf loop; have pb := same_vertex_trans pf loop; rewrite -filter_predI -(doors_to pf).
apply: eq_in_filter => i; rewrite mem_iota /= over_facing => lt.
rewrite (inj_eq (@Some_inj _)) [_ == i]eq_sym -(turn_is pb lt); case: (turn p i =P opposite f) => [->|_].
  by rewrite (negPf (opposite_neq f)).
by rewrite orbF.
Qed.

(** * The simulation *)

(** The simulated robot takes only doors that exist. *)
Definition takes_doors := forall n i, robot (history robot (moving directional W) n) = Act i ->
  i < degree (situation robot (moving directional W) n).2.

Definition plan_after (past : seq seen_with_string) : plan :=
  if past is _ :: _ :: _ :: seen :: later then foldl continue (arrive [::] seen) later else Ready [::].

(** After [n] decisions, by which it has taken [moves] doors, the robot is in this state, and follows this plan. *)
Definition reached n moves (p : plan) (s : state I) : Prop :=
  [/\ (situation simulating I n).2 = s,
      3 < size (history simulating I n) /\ plan_after (history simulating I n) = p,
      doors_used simulating I n = moves
    & takes_doors -> forall j e, j < n -> simulating (history simulating I j) = Act e ->
        possible (situation simulating I j).2 e].

Lemma situationS n : situation simulating I n.+1 =
  let: (past, s) := situation simulating I n in
  if simulating past is Act e then (rcons past (sense (next_state s e)), next_state s e) else (past, s).
Proof. by []. Qed.

Lemma doors_usedS n : doors_used simulating I n.+1 =
  doors_used simulating I n + takes_door (simulating (history simulating I n)).
Proof. by rewrite /doors_used -[in LHS]addn1 iotaD count_cat /= addn0. Qed.

Lemma simulating_planned past : 3 < size past -> simulating past = decide (plan_after past).
Proof. by case: past => [|a [|b [|c [|d past]]]]. Qed.

Lemma reached_next n moves p s e : reached n moves p s -> decide p = Act e -> (takes_doors -> possible s e) ->
  reached n.+1 (moves + takes_door (Act e : decision _ A)) (continue p (sense (next_state s e))) (next_state s e).
Proof.
move=> [at_n [long planned] used only] does can.
have does' : simulating (history simulating I n) = Act e by rewrite simulating_planned // planned.
split.
- by rewrite /=; move: does' at_n; rewrite /history; case: (situation simulating I n) => past t /= -> ->.
- rewrite historyS does' at_n size_rcons (ltn_trans long) //; split=> //.
  by case: history long planned => [|a [|b [|c [|d past]]]] // _ <-; rewrite /= -cats1 foldl_cat.
- by rewrite doors_usedS used does'.
move=> ok j e'; rewrite ltnS leq_eqVlt => /predU1P[->|]; last exact: only.
by rewrite does' at_n => -[<-]; apply: can.
Qed.

Let home := (f, laid (Some (opposite f))).

Lemma string_laid : reached 3 2 (arrive [::] (sense (home : state I))) home.
Proof.
pose see (s : state I) := sense s.
have at_1 : situation simulating I 1 = ([:: see (first_state I); see (opposite f, laid None)], (opposite f, laid None)).
  by rewrite /= length_gt0.
have at_2 : situation simulating I 2 =
    (rcons (situation simulating I 1).1 (see (opposite f, laid (Some (opposite f)))), (opposite f, laid (Some (opposite f)))).
  by rewrite situationS at_1.
have at_3 : situation simulating I 3 = (rcons (situation simulating I 2).1 (see home), home).
  by rewrite situationS at_2 at_1 /= /traverse /= oppositeK.
split; [by rewrite at_3 | by rewrite /history at_3 at_2 at_1 | by rewrite !doors_usedS /history at_2 at_1 |].
move=> _ [|[|[|j]]] e // _; rewrite /history ?at_2 ?at_1 /= => -[<-] /=; first by rewrite degree_gt0.
  by [].
by rewrite degree_gt0.
Qed.

(** The robot has the percept of the simulated one. *)
Lemma arrive_ready n moves past (p d : W) :
  reached n moves (arrive past (sense ((p, laid (Some d)) : state I))) (p, laid (Some d)) ->
  same_vertex d (opposite f) ->
  exists n' d', [/\ n' <= n + 2, same_vertex d' (opposite f)
    & reached n' moves (Ready (rcons past (perceive directional p))) (p, laid (Some d'))].
Proof.
rewrite /arrive /= -/f /perceive /directional -/f => go free.
have more : n <= n + 2 by rewrite leq_addr.
move: go; case: ifP => pf; last by move=> go; exists n, d.
case: (boolP (same_vertex f (opposite f))) => [loop|not_loop]; last by rewrite one_door // => go; exists n, d.
have look : reached n moves (TakeEnd past) (p, laid (Some d)) -> exists n' d', [/\ n' <= n + 2, same_vertex d' (opposite f)
    & reached n' moves (Ready (rcons past (degree p, Pointing (findex clockwise p f)))) (p, laid (Some d'))].
  move=> /reached_next/(_ erefl) go; have pb := same_vertex_trans pf loop.
  have pd : same_vertex p d by apply: same_vertex_trans pb _; rewrite same_vertex_sym.
  have {go} := go (fun=> pd); rewrite /= pd addn0 -/(laid None) other_door //.
  move=> /reached_next/(_ erefl (fun=> isT)); rewrite /= addn0 => go.
  by exists n.+2, p; rewrite addn2.
have several := @two_doors p (Some d) _ pf loop; move: several.
by case: filter => [|i [|j doors]] several go; [apply: look | case: (several i) | apply: look].
Qed.

(** For each move of the simulated robot, the robot makes one, and has at most two actions more. *)
Lemma simulate n : exists n' moves d, [/\ n' <= 3 * n + 5, moves <= n + 2, same_vertex d (opposite f)
  & let: (past, p) := situation robot (moving directional W) n in reached n' moves (Ready past) (p, laid (Some d))].
Proof.
elim: n => [|n [n' [moves [d [n'_le moves_le free]]]]].
  have [n' [d [n'_le free go]]] := arrive_ready string_laid (same_vertex_refl _).
  by exists n', 2, d.
rewrite /=; case at_n: (situation robot _ n) => [past p] go.
have more : n' + 3 <= 3 * n.+1 + 5 by rewrite mulnS addnC -addnA leq_add2l.
case decided: (robot past) => [i|a].
  have does : decide (Ready past) = Act (Take i) by rewrite /= decided.
  have can : takes_doors -> possible ((p, laid (Some d)) : state I) (Take i).
    by move/(_ n i); rewrite /history at_n => /(_ decided) lt; rewrite /= lt.
  have [n'' [d' [n''_le free' go']]] := arrive_ready (reached_next go does can) free.
  exists n'', (moves + 1), d'; split; [|by rewrite addn1 addSn ltnS|exact: free'|exact: go'].
  by apply: leq_trans n''_le (leq_trans _ more); rewrite addSnnS.
exists n', moves, d; split; [|exact: leqW|exact: free|exact: go].
by apply: leq_trans (leq_addr _ _) more.
Qed.

Lemma simulating_answers n a : robot (history robot (moving directional W) n) = Answer a ->
  exists n' d,
    [/\ n' <= 3 * n + 5, simulating (history simulating I n') = Answer a,
        (situation simulating I n').2 = ((situation robot (moving directional W) n).2, laid (Some d)),
        doors_used simulating I n' <= n + 2
      & takes_doors -> forall j e, simulating (history simulating I j) = Act e -> possible (situation simulating I j).2 e].
Proof.
have [n' [moves [d [n'_le moves_le free]]]] := simulate n.
rewrite /history; case: (situation robot _ n) => past p [at_n' [long planned] used only] answered.
have stops : simulating (history simulating I n') = Answer a.
  by rewrite simulating_planned // planned /= answered.
exists n', d; split=> //; first by rewrite used.
move=> ok j e; case: (ltnP j n') => [lt|le does]; first exact: only.
by have := history_answered (j - n') stops; rewrite subnKC // => same; move: does; rewrite -/(history simulating I j) same stops.
Qed.

End Simulation.

(** * So a string suffices *)

Section Lengths.

Variables (length : nat) (W : start).
Hypothesis length_gt0 : 0 < length.

Lemma string_locates :
  let robot := simulating locating_mapper in
  exists map n,
    [/\ robot (history robot (with_aid (string length) W) n) = Answer map,
        exists f : map -> W, [/\ isomorphism f, f (facing map) = facing W
          & f (Algorithm1.robot map) = (situation robot (with_aid (string length) W) n).2.1],
        forall j e, robot (history robot (with_aid (string length) W) j) = Act e ->
          possible (situation robot (with_aid (string length) W) j).2 e,
        n <= 3 * cost W (edges W) + 5
      & doors_used robot (with_aid (string length) W) n <= cost W (edges W) + 2].
Proof.
move=> robot; have [map [k [answered located doors k_le]]] := locating_mapper_maps W.
have [n [d [n_le answered' at_n used only]]] := simulating_answers length_gt0 answered.
exists map, n; split=> //; first by rewrite at_n.
- exact: only.
- by apply: leq_trans n_le _; rewrite leq_add2r leq_mul2l.
by apply: leq_trans used _; rewrite leq_add2r.
Qed.

Lemma string_maps : maps_start (with_aid (string length)) (simulating mapper) W.
Proof.
have [map [k answered] iso] := mapper_maps W; exists map => //.
by have [n [d [_ answered' _ _ _]]] := simulating_answers length_gt0 answered; exists n.
Qed.

End Lengths.

Lemma string_determines length V W : 0 < length -> bisimilar (with_aid (string length)) V W -> isomorphic_starts V W.
Proof.
by move=> length_gt0 same; apply: bisimilar_maps_start same (string_maps V length_gt0) (string_maps W length_gt0).
Qed.
