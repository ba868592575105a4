(** A robot with a marker that identifies the facing dart can do what any robot with a directional marker
    does: at each vertex where the marker may be, it looks behind all doors. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Markers Walks Arithmetic Parts.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Section Simulation.

Variables (M : marker) (near beyond : pred percept) (A : Type) (robot : strategy A).

(** What the robot does next. [past] are the percepts that the simulated robot has had.
    - [Ready past turned degree]: what the simulated robot does; it stands there turned by [turned].
    - [LookBehind past here i]: look behind the door [i] of the vertex where it perceived [here]; it has
      looked behind the doors before, so that the next door is door 1.
    - [TurnBack past here i found]: come back from there, where the mark was found or not. *)
Inductive plan :=
  | Ready of seq percept & door & nat
  | LookBehind of seq percept & percept & door
  | TurnBack of seq percept & percept & door & bool.

Definition arrive past (seen : percept) : plan :=
  if near seen then LookBehind past seen 0 else Ready (rcons past (seen.1, Nothing)) 0 seen.1.

Definition decide (p : plan) : decision door A :=
  match p with
  | Ready past turned degree =>
      match robot past with
      | Act i => Act ((i + degree - turned) %% degree)
      | Answer a => Answer a
      end
  | LookBehind _ _ i => Act (if i is 0 then 0 else 1)
  | TurnBack _ _ _ _ => Act 0
  end.

Definition continue (p : plan) (seen : percept) : plan :=
  match p with
  | Ready past _ _ => arrive past seen
  | LookBehind past here i => TurnBack past here i (beyond seen)
  | TurnBack past here i found =>
      if found then Ready (rcons past (here.1, Pointing i)) i here.1
      else if i.+1 < here.1 then LookBehind past here i.+1
      else Ready (rcons past (here.1, Nothing)) i here.1
  end.

Definition plan_after (past : seq percept) : plan :=
  if past is first :: later then foldl continue (arrive [::] first) later else Ready [::] 0 0.

Definition simulating : strategy A := fun past => decide (plan_after past).

Variable W : start.

(** The plan fits the robot's pose: it knows how many doors there are. *)
Definition fits (p : plan) (pose : W) : bool :=
  match p with
  | Ready _ _ degree_here => degree_here == degree pose
  | LookBehind _ here i => (here.1 == degree pose) && (i < here.1)
  | TurnBack _ here i _ => (here.1 == degree (opposite pose)) && (i < here.1)
  end.

Lemma fits_arrive past (pose : W) : fits (arrive past (perceive M pose)) pose.
Proof. by rewrite /arrive; case: ifP => _ //=; rewrite eqxx degree_gt0. Qed.

Lemma fits_continue p (pose : W) i : fits p pose -> decide p = Act i ->
  i < degree pose /\ fits (continue p (perceive M (traverse pose i))) (traverse pose i).
Proof.
case: p => [past turned k|past here j|past here j found] /=.
- move/eqP->; case: (robot past) => // d [<-]; split; last exact: fits_arrive.
  by rewrite ltn_pmod ?degree_gt0.
- case/andP=> /eqP hereE j_lt [<-]; rewrite /traverse /= oppositeK degree_turn hereE eqxx.
  by rewrite -hereE j_lt; case: j j_lt => [|j] /(leq_trans _) ->.
case/andP=> /eqP hereE j_lt [<-]; rewrite degree_gt0 /traverse /=; split=> //.
by case: found; [|case: ifP]; rewrite /= hereE ?eqxx // => ->.
Qed.

(** Whatever the marker identifies, the robot takes only doors that exist. *)
Lemma simulating_doors n i :
  simulating (history simulating (moving M W) n) = Act i -> i < degree (situation simulating (moving M W) n).2.
Proof.
suff fits_n k : let: (past, pose) := situation simulating (moving M W) k in
                past != [::] /\ fits (plan_after past) pose.
  have := fits_n n; rewrite /history; case: (situation _ _ n) => past pose [_ /fits_continue fits_i].
  by move=> /fits_i[].
elim: k => [|k] /=; first by split; last exact: fits_arrive.
case: (situation _ _ k) => past pose [some fits_p].
case decided: (simulating past) => [j|//]; have [_ fits_j] := fits_continue fits_p decided.
case: past some decided fits_j {fits_p} => // first later _ _ fits_j; split=> //.
by rewrite /plan_after rcons_cons -cats1 foldl_cat.
Qed.

Hypothesis M_identifies : identifies M near beyond W.
Variable bound : nat.
Hypothesis small : forall d : W, degree d <= bound.

(** The robot follows this plan, at this pose, after a number of moves. *)
Definition follows n (p : plan) (pose : W) : Prop :=
  exists2 past, situation simulating (moving M W) n = (past, pose) & past != [::] /\ plan_after past = p.

Lemma follows_next n p pose i : follows n p pose -> decide p = Act i ->
  follows n.+1 (continue p (perceive M (traverse pose i))) (traverse pose i).
Proof.
move=> [past at_n [some planned]] leaves; exists (rcons past (perceive M (traverse pose i))).
  by rewrite /= at_n {1}/simulating planned leaves.
case: past some planned {at_n} => // first later _ <-; split=> //.
by rewrite /plan_after rcons_cons -cats1 foldl_cat.
Qed.

Lemma follows_start : follows 0 (arrive [::] (perceive M (facing W))) (facing W).
Proof. by exists [:: perceive M (facing W)]. Qed.

(** The robot knows the simulated percept, and how far it is turned. *)
Definition ready n past (pose : W) : Prop :=
  exists2 t, t < degree pose & follows n (Ready past t (degree pose)) (turn pose t).

Lemma look_behind n past (p : W) i :
  near (perceive M p) -> i < degree p -> (forall j, j < i -> turn p j != facing W) ->
  follows n (LookBehind past (perceive M p) i) (turn p i.-1) ->
  exists2 n', n' <= n + 2 * (degree p - i) & ready n' (rcons past (perceive directional p)) p.
Proof.
move=> at_p; have [k le] := ubnP (degree p - i); elim: k n i le => // k IH n i le.
move=> i_lt none /follows_next go.
have two : n.+2 <= n + 2 * (degree p - i) by rewrite -addn2 leq_add2l -{1}[2]muln1 leq_mul2l subn_gt0.
have {go} : follows n.+1 (TurnBack past (perceive M p) i (turn p i == facing W)) (opposite (turn p i)).
  have -> : (turn p i == facing W) = beyond (perceive M (opposite (turn p i))).
    by rewrite -(M_identifies (same_vertex_turn p i)) at_p.
  by case: i {le two i_lt none} go => [|i] go; apply: (go _ erefl).
move/follows_next/(_ erefl); rewrite /= {1}/traverse /= oppositeK.
have pointing : turn p i = facing W -> perceive directional p = (degree p, Pointing i).
  move=> facing_i; rewrite /perceive /directional -facing_i same_vertex_turn.
  by rewrite findex_turn.
case: eqP => [/pointing seen_p go|/eqP not_i].
  by exists n.+2 => //; exists i => //; rewrite seen_p.
have {}none j : j < i.+1 -> turn p j != facing W.
  by rewrite ltnS leq_eqVlt => /predU1P[->|/none].
case: ifP => [next|last_door] go.
  have [|n' n'_le ready'] := IH n.+2 i.+1 _ next none go; first by arithmetic.
  by exists n' => //; arithmetic.
exists n.+2 => //; exists i => //; have -> : perceive directional p = (degree p, Nothing); last exact: go.
rewrite /perceive /directional; case: ifP => // /same_vertexP[j facing_j].
have := none (j %% degree p); rewrite turn_mod -facing_j eqxx => /(_ _)/negP[] //.
by apply: leq_trans (ltn_pmod _ (degree_gt0 p)) _; rewrite leqNgt last_door.
Qed.

Lemma simulate_arrive n past (p : W) : follows n (arrive past (perceive M p)) p ->
  exists2 n', n' <= n + 2 * bound & ready n' (rcons past (perceive directional p)) p.
Proof.
rewrite /arrive; case: ifP => [at_p|away] go.
  have [//|n' n'_le ready'] := look_behind at_p (degree_gt0 p) _ go; exists n' => //.
  by apply: leq_trans n'_le _; rewrite leq_add2l leq_mul2l subn0 small orbT.
exists n; first exact: leq_addr.
exists 0; first exact: degree_gt0.
have -> : perceive directional p = (degree p, Nothing); last exact: go.
rewrite /perceive /directional; case: ifP => // /same_vertexP[j facing_j].
by have := M_identifies (same_vertex_turn p j); rewrite -facing_j eqxx away.
Qed.

(** For each move of the simulated robot, the robot makes at most this many more. *)
Lemma simulate n : exists2 n', n' <= n + n.+1 * (2 * bound)
  & let: (past, pose) := situation robot (moving directional W) n in ready n' past pose.
Proof.
elim: n => [|n [n' n'_le]] /=.
  by have [n' n'_le ready'] := simulate_arrive follows_start; exists n' => //; rewrite mul1n.
case: (situation _ _ n) => past pose [t t_lt follows'].
case decided: (robot past) => [i|a]; last first.
  by exists n'; [arithmetic | exists t].
have leaves : decide (Ready past t (degree pose)) = Act ((i + degree pose - t) %% degree pose).
  by rewrite /= decided.
have := follows_next follows' leaves.
have -> : traverse (turn pose t) ((i + degree pose - t) %% degree pose) = traverse pose i.
  rewrite /traverse -turnD -(turn_mod pose (t + _)) modnDmr.
  by rewrite subnKC ?(leq_trans (ltnW t_lt)) ?leq_addl // modnDr turn_mod.
move=> /simulate_arrive[n'' n''_le ready'']; exists n'' => //.
by rewrite mulSn; arithmetic.
Qed.

Lemma simulating_answers n a : robot (history robot (moving directional W) n) = Answer a ->
  exists2 n', n' <= n + n.+1 * (2 * bound) & simulating (history simulating (moving M W) n') = Answer a.
Proof.
have [n' n'_le] := simulate n; rewrite /history; case: (situation _ _ n) => past pose.
move=> [t _ [past' at_n' [_ planned]]] answered; exists n' => //.
by rewrite at_n' /simulating planned /= answered.
Qed.

End Simulation.
