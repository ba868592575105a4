(** A robot with an aid that does what another robot does: before each of its actions it may look round, so that it
    knows what the other robot would perceive. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Aids Algorithm1 Bisimulation Correct Mapper.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** How a robot looks round: it knows what it wants to know, or does something, and continues with what it
    perceives. *)
Inductive look (O E Q : Type) := Know of Q | Try of E & (O -> look O E Q).

Arguments Know {O E Q}.
Arguments Try {O E Q}.

Section Imitation.

Variables (O E O' E' A : Type) (robot : robot_of O E A).

(** How the other robot's actions are done, and how to look round at the start, and after each of them. *)
Variables (do_as : E -> action_with E') (at_start after : O' -> look O' (action_with E') O).

(** What the other robot has perceived, and the look for what it perceives now. *)
Definition plan : Type := seq O * look O' (action_with E') O.

Definition decide (p : plan) : decision (action_with E') A :=
  match p.2 with
  | Know o => match robot (rcons p.1 o) with Act e => Act (do_as e) | Answer a => Answer a end
  | Try e _ => Act e
  end.

Definition continue (p : plan) (seen : O') : plan :=
  match p.2 with
  | Know o => (rcons p.1 o, after seen)
  | Try _ go => (p.1, go seen)
  end.

Definition imitating : robot_of O' (action_with E') A := fun past =>
  if past is first :: later then decide (foldl continue ([::], at_start first) later)
  else match robot [::] with Act e => Act (do_as e) | Answer a => Answer a end.

Variables (I : environment_of O E) (J : environment_of O' (action_with E')).

Definition is_take (e : action_with E') : bool := if e is Take _ then true else false.

(** A look does only what is possible, and ends with what is known, in a state, after so many actions, of which so
    many take doors. *)
Fixpoint ends (l : look O' (action_with E') O) (s : state J) (Q : O -> state J -> nat -> nat -> Prop) : Prop :=
  match l with
  | Know o => Q o s 0 0
  | Try e go =>
      possible s e /\
      ends (go (sense (next_state s e))) (next_state s e) (fun o s' k m => Q o s' k.+1 (is_take e + m))
  end.

Lemma endsW l s (Q R : O -> state J -> nat -> nat -> Prop) :
  ends l s Q -> (forall o s' k m, Q o s' k m -> R o s' k m) -> ends l s R.
Proof.
elim: l s Q R => [o|e go IH] s Q R /=; first by move=> q; apply.
by move=> [can all] weaker; split=> //; apply: IH all _ => o s' k m; apply: weaker.
Qed.

(** The states of both robots fit; each look keeps that, with so many actions and doors at most. *)
Variables (fits : state I -> state J -> Prop) (actions_first doors_first actions_each doors_each : nat).

Hypothesis fits_first :
  ends (at_start (sense (first_state J))) (first_state J) (fun o s k m =>
    [/\ o = sense (first_state I), fits (first_state I) s, k <= actions_first & m <= doors_first]).

Hypothesis fits_next : forall p s e, fits p s -> possible p e ->
  possible s (do_as e) /\
  ends (after (sense (next_state s (do_as e)))) (next_state s (do_as e)) (fun o s' k m =>
    [/\ o = sense (next_state p e), fits (next_state p e) s', k <= actions_each & m <= doors_each]).

(** The other robot does only what is possible. *)
Hypothesis only_possible : possible_only robot I.

Definition plan_after (past : seq O') : plan :=
  if past is first :: later then foldl continue ([::], at_start first) later
  else ([::], at_start (sense (first_state J))).

(** After [n] decisions, by which it has taken [m] doors, the robot is in this state, and follows this plan. *)
Definition reached n m (p : plan) (s : state J) : Prop :=
  [/\ exists2 past, situation imitating J n = (past, s) & 0 < size past /\ plan_after past = p,
      doors_used imitating J n = m
    & forall j e, j < n -> imitating (history imitating J j) = Act e -> possible (situation imitating J j).2 e].

Lemma reached_next n m p s e : reached n m p s -> decide p = Act e -> possible s e ->
  reached n.+1 (is_take e + m) (continue p (sense (next_state s e))) (next_state s e).
Proof.
move=> [[past at_n [some planned]] used only] does can.
have does' : imitating past = Act e by case: past some planned {at_n} => //= first later _ ->.
split.
- exists (rcons past (sense (next_state s e))); first by rewrite /= at_n does'.
  by rewrite size_rcons; case: past some planned {at_n does'} => //= first later _ <-; rewrite -cats1 foldl_cat.
- rewrite addnC -used /doors_used -[in LHS]addn1 iotaD count_cat /= addn0 add0n /history at_n does'.
  by [].
move=> j e'; rewrite ltnS leq_eqVlt => /predU1P[->|]; last exact: only.
by rewrite /history at_n /= does' => -[<-].
Qed.

Lemma reached_ends l n m past s Q : reached n m (past, l) s -> ends l s Q ->
  exists o s' k m', Q o s' k m' /\ reached (n + k) (m' + m) (past, Know o) s'.
Proof.
elim: l n m s Q => [o|e go IH] n m s Q at_n /=; first by move=> q; exists o, s, 0, 0; rewrite addn0.
move=> [can all]; have at_n1 := reached_next at_n erefl can.
have [o [s' [k [m' [q at_k]]]]] := IH _ _ _ _ _ at_n1 all.
by exists o, s', k.+1, (is_take e + m'); rewrite -addSnnS -addnA addnCA.
Qed.

Lemma imitate n : exists n' m past o s',
  [/\ n' <= actions_first + n * actions_each.+1, m <= doors_first + n * doors_each.+1,
      rcons past o = history robot I n, fits (situation robot I n).2 s' & reached n' m (past, Know o) s'].
Proof.
elim: n => [|n [n' [m [past [o [s [n'_le m_le pastE fits_s go]]]]]]].
  have at_0 : reached 0 0 ([::], at_start (sense (first_state J))) (first_state J).
    by split=> //; exists [:: sense (first_state J)].
  have [o [s [k [m [[-> fits_s k_le m_le] go]]]]] := reached_ends at_0 fits_first.
  by exists k, m, [::], (sense (first_state I)), s; rewrite !mul0n !addn0; rewrite add0n addn0 in go.
have more k c : k + n * c <= k + n.+1 * c by rewrite leq_add2l leq_mul2r leqnSn orbT.
rewrite historyS; case decided: (robot _) => [e|a]; last first.
  exists n', m, past, o, s; split=> //; [exact: leq_trans n'_le (more _ _) | exact: leq_trans m_le (more _ _) |].
  by move: decided fits_s; rewrite /history /=; case: (situation robot I n) => x y /= ->.
have can := only_possible decided; have [can' all] := fits_next fits_s can.
have does : decide (past, Know o) = Act (do_as e) by rewrite /decide /= pastE decided.
have [o' [s' [k [m' [[o'E fits_s' k_le m'_le] go']]]]] := reached_ends (reached_next go does can') all.
exists (n'.+1 + k), (m' + (is_take (do_as e) + m)), (rcons past o), o', s'; split.
- by rewrite addSnnS addnC mulSn addnCA; apply: leq_add.
- rewrite addnA mulSn [X in _ <= X]addnCA; apply: leq_add => //; rewrite -[doors_each.+1]addn1; apply: leq_add => //.
  by case: is_take.
- by rewrite o'E pastE.
- by move: decided fits_s'; rewrite /history /=; case: (situation robot I n) => x y /= ->.
exact: go'.
Qed.

(** So it gives the same answers. *)
Lemma imitating_answers n a : robot (history robot I n) = Answer a ->
  exists n',
    [/\ imitating (history imitating J n') = Answer a, fits (situation robot I n).2 (situation imitating J n').2,
        possible_only imitating J,
        doors_used imitating J n' <= doors_first + n * doors_each.+1
      & n' <= actions_first + n * actions_each.+1].
Proof.
move=> answered; have [n' [m [past [o [s [n'_le m_le pastE fits_s go]]]]]] := imitate n.
have [[past' at_n' [some planned]] used only] := go.
have stops : imitating (history imitating J n') = Answer a.
  rewrite /history at_n' /=; case: past' some planned {at_n'} => //= first later _ ->.
  by rewrite /decide /= pastE answered.
exists n'; rewrite used at_n'; split=> // j e; case: (ltnP j n') => [lt|le]; first exact: only.
by have := history_answered (j - n') stops; rewrite subnKC // => ->; rewrite stops.
Qed.

End Imitation.

(** * In place of a robot with a directional marker *)

Section Directional.

Variables (X : aid) (W : start).

Notation seen := (nat * sightings X)%type.
Notation action := (action_with (aid_action X)).

Variables (at_start after : seen -> look seen action percept).
Variables (fits : W -> state (with_aid X W) -> Prop) (actions_first doors_first actions_each doors_each : nat).

Hypothesis fits_pose : forall p s, fits p s -> s.1 = p.

Hypothesis fits_first :
  ends (at_start (sense (first_state (with_aid X W)))) (first_state (with_aid X W)) (fun o s k m =>
    [/\ o = perceive directional (facing W), fits (facing W) s, k <= actions_first & m <= doors_first]).

Hypothesis fits_next : forall p s i, fits p s -> i < degree p ->
  possible s (Take i) /\
  ends (after (sense (next_state s (Take i)))) (next_state s (Take i)) (fun o s' k m =>
    [/\ o = perceive directional (traverse p i), fits (traverse p i) s', k <= actions_each & m <= doors_each]).

Definition in_place_of A (robot : strategy A) : robot_of seen action A := imitating robot Take at_start after.

Lemma in_place_of_answers A (robot : strategy A) n a :
  possible_only robot (moving directional W) ->
  robot (history robot (moving directional W) n) = Answer a ->
  let robot' := in_place_of robot in
  exists n',
    [/\ robot' (history robot' (with_aid X W) n') = Answer a,
        (situation robot' (with_aid X W) n').2.1 = (situation robot (moving directional W) n).2,
        possible_only robot' (with_aid X W),
        doors_used robot' (with_aid X W) n' <= doors_first + n * doors_each.+1
      & n' <= actions_first + n * actions_each.+1].
Proof.
move=> only answered; have [n' [answered' /fits_pose same possible' used n'_le]] :=
  imitating_answers (I := moving directional W) fits_first fits_next only answered.
by exists n'.
Qed.

Lemma in_place_of_locates :
  let robot := in_place_of locating_mapper in
  exists map n,
    [/\ robot (history robot (with_aid X W) n) = Answer map,
        exists f : map -> W, [/\ isomorphism f, f (facing map) = facing W
          & f (Algorithm1.robot map) = (situation robot (with_aid X W) n).2.1],
        possible_only robot (with_aid X W),
        doors_used robot (with_aid X W) n <= doors_first + cost W (edges W) * doors_each.+1
      & n <= actions_first + cost W (edges W) * actions_each.+1].
Proof.
move=> robot; have [map [k [answered located doors k_le]]] := locating_mapper_maps W.
have [n [answered' at_n only used n_le]] := in_place_of_answers doors answered.
exists map, n; split=> //; first by rewrite at_n.
  by apply: leq_trans used _; rewrite leq_add2l leq_mul2r k_le orbT.
by apply: leq_trans n_le _; rewrite leq_add2l leq_mul2r k_le orbT.
Qed.

Lemma in_place_of_maps : maps_start (with_aid X) (in_place_of mapper) W.
Proof.
have [map [k [answered located doors _]]] := locating_mapper_maps W.
have [map' [n answered'] iso] := mapper_maps W; exists map' => //.
have [j i|n' [answered'' _ _ _ _]] := in_place_of_answers _ answered'; last by exists n'.
rewrite /history situation_mapper => does; apply: doors; move: does.
by rewrite /mapper /history; case: (locating_mapper _) => // i' [->].
Qed.

End Directional.
