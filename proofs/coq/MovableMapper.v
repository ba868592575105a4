(** The algorithm with one movable marker as a robot: a strategy that depends only on its percepts. So there is
    a robot that maps every simple world with a movable marker. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program Algorithm1 Walks Arithmetic Complete.
From toposlam Require Import MovableMarker MovableCorrect MovableCost.
From toposlam Require Handling.

Import Handling(handling, Act, Report, handling_strategy, handling_situation, handling_history, obey_handling).

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** What a robot does that runs the algorithm: at the end it answers with the world of its map, and its pose in
    it. *)
Definition drawing_handled (d : handling (option (partial_map * nat))) : handling located :=
  match d with
  | Act e => Act e
  | Report (Some (T, pose)) => if drawn T pose is Some map then Report map else Act Drop
  | Report None => Act Drop
  end.

(** The robot runs the algorithm with its default choices. It has made fewer rounds than it has percepts. *)
Definition movable_mapper : handling_strategy located := fun past =>
  if past is first :: later then drawing_handled (obey_handling (movable short_paths (size past) first) later)
  else Act Drop.

(** * The limit makes no difference before it is reached *)

(** A program, run on some percepts: its answer and the remaining percepts, if it ends. *)
Fixpoint finish A (p : handling_program A) (past : seq percept) : option (A * seq percept) :=
  match p with
  | Return a => Some (a, past)
  | Do _ go => if past is seen :: later then finish (go seen) later else None
  | Choose T _ default go => finish (go default) past
  end.

Lemma obey_same A B (p : handling_program A) (next next' : A -> handling_program B) past :
  (forall a later, finish p past = Some (a, later) ->
     obey_handling (next a) later = obey_handling (next' a) later) ->
  obey_handling (let* a := p in next a) past = obey_handling (let* a := p in next' a) past.
Proof.
elim: p past => [a|e go IH|T ok default go IH] past /= same; first exact: same.
  by case: past same => // seen past; apply: IH.
exact: IH.
Qed.

Lemma finish_bind A B (p : handling_program A) (next : A -> handling_program B) past :
  finish (let* a := p in next a) past =
  if finish p past is Some (a, later) then finish (next a) later else None.
Proof. by elim: p past => [a|e go IH|T ok default go IH] [|seen past] /=. Qed.

Lemma finish_le A (p : handling_program A) past a later :
  finish p past = Some (a, later) -> size later <= size past.
Proof.
elim: p past => [b|e go IH|T ok default go IH] past /=; first by case=> _ ->.
  by case: past => // seen past /IH le; apply: leq_trans le (leqnSn _).
exact: IH.
Qed.

Lemma finish_move A i (next : percept -> handling_program A) past a later :
  finish (let* seen := move i in next seen) past = Some (a, later) -> size later < size past.
Proof. by case: past => //= seen past ended; rewrite ltnS; apply: finish_le ended. Qed.

Lemma finish_choose_among A (T : eqType) (xs : seq T) default (next : T -> handling_program A) past :
  finish (let* x := choose_among xs default in next x) past = finish (next default) past.
Proof. by []. Qed.

(** Every round has a percept. *)
Lemma explore_edge_moves allowed S pose past a later :
  finish (explore_edge allowed S pose) past = Some (a, later) -> size later < size past.
Proof.
rewrite /explore_edge finish_choose_among finish_bind.
case went: (finish (travel _ _ _ _) past) => [[near past']|//] ended.
by apply: leq_trans (finish_le went); apply: finish_move ended.
Qed.

Lemma another_edge allowed bound S pose :
  explore_edges allowed bound.+1 S pose =
  if unexplored S is [::] then Return (Some (S, pose))
  else let* after := explore_edge allowed S pose in
       if after is Some (S', pose') then explore_edges allowed bound S' pose' else Return None.
Proof. by []. Qed.

Lemma same_edges allowed b b' S pose past : size past < b -> size past < b' ->
  obey_handling (explore_edges allowed b S pose) past = obey_handling (explore_edges allowed b' S pose) past.
Proof.
elim: b b' S pose past => // b IH [//|b'] S pose past le le'.
rewrite !another_edge; case: (unexplored S) => // _ _.
apply: obey_same => -[[S' pose']|] // later explored; have lt := explore_edge_moves explored.
by apply: IH; apply: leq_trans lt _.
Qed.

Lemma same_movable b b' first past : size past < b -> size past < b' ->
  obey_handling (movable short_paths b first) past = obey_handling (movable short_paths b' first) past.
Proof.
by case: past => // seen past lt lt'; apply: same_edges; apply: leq_trans (leqnSn _) _.
Qed.

(** * The strategy does what the program does *)

Section Obedient.

Variables (A B : Type) (W : start) (report : handling A -> handling B) (robot : handling_strategy B).
Hypothesis report_act : forall e, report (Act e) = Act e.

Notation situation := (handling_situation robot W).

Lemma obedient p past n (pose : W) l K (Q : A -> W -> option W -> Prop) :
  situation n = (past, (pose, l)) -> always_handling p pose l Q -> within K p pose l ->
  (forall later, size later <= K -> robot (past ++ later) = report (obey_handling p later)) ->
  (forall a r m, Q a r m -> exists b, report (Report a) = Report b) ->
  exists a k,
    [/\ robot (handling_history robot W (n + k)) = report (Report a),
        Q a (situation (n + k)).2.1 (situation (n + k)).2.2, k <= K
      & forall j i, n <= j -> robot (handling_history robot W j) = Act (LeaveBy i) -> i < degree (situation j).2.1].
Proof.
elim: p past n pose l K => [a|[i||] go IH|T ok default go IH] past n pose l K at_n /=.
- move=> q _ obeys reports; have [b reported] := reports a pose l q.
  have answered : robot past = Report b by have := obeys [::] isT; rewrite cats0 /= reported.
  exists a, 0; rewrite addn0 /handling_history at_n reported; split=> // j i /subnKC <-.
  have -> : situation (n + (j - n)) = (past, (pose, l)).
    by elim: (j - n) => [|k stays]; rewrite ?addn0 // addnS /= stays answered.
  by rewrite /= answered.
- case: K => // K [open_i all] p_K obeys reports.
  have does : robot past = Act (LeaveBy i) by have := obeys [::] isT; rewrite cats0 /= report_act.
  set seen := perceive_lying l (traverse pose i).
  have at_n1 : situation n.+1 = (rcons past seen, (traverse pose i, l)) by rewrite /= at_n does.
  have [|a [k [answered q k_le doors]]] := IH seen _ _ _ _ _ at_n1 all p_K _ reports.
    by move=> later le; rewrite cat_rcons obeys.
  exists a, k.+1; rewrite -addSnnS; split=> // j i'; rewrite leq_eqVlt => /predU1P[<-|]; last exact: doors.
  by rewrite /handling_history at_n /= does => -[<-].
- case: K l at_n => // K [spot|] // at_n [here all] /=; rewrite here => p_K obeys reports.
  have does : robot past = Act PickUp by have := obeys [::] isT; rewrite cats0 /= report_act.
  set seen := perceive_lying None pose.
  have at_n1 : situation n.+1 = (rcons past seen, (pose, None)) by rewrite /= at_n does /= here.
  have [|a [k [answered q k_le doors]]] := IH seen _ _ _ _ _ at_n1 all p_K _ reports.
    by move=> later le; rewrite cat_rcons obeys.
  exists a, k.+1; rewrite -addSnnS; split=> // j i'; rewrite leq_eqVlt => /predU1P[<-|]; last exact: doors.
  by rewrite /handling_history at_n /= does.
- case: K l at_n => // K [spot|] // at_n all p_K obeys reports.
  have does : robot past = Act Drop by have := obeys [::] isT; rewrite cats0 /= report_act.
  set seen := perceive_lying (Some pose) pose.
  have at_n1 : situation n.+1 = (rcons past seen, (pose, Some pose)) by rewrite /= at_n does.
  have [|a [k [answered q k_le doors]]] := IH seen _ _ _ _ _ at_n1 all p_K _ reports.
    by move=> later le; rewrite cat_rcons obeys.
  exists a, k.+1; rewrite -addSnnS; split=> // j i'; rewrite leq_eqVlt => /predU1P[<-|]; last exact: doors.
  by rewrite /handling_history at_n /= does.
case=> okd all p_K; exact: IH at_n (all default okd) (p_K default okd).
Qed.

End Obedient.

Lemma movable_mapper_maps (W : start) : simple W ->
  exists map n,
    let: (pose, lying) := (handling_situation movable_mapper W n).2 in
    [/\ movable_mapper (handling_history movable_mapper W n) = Report map, lying = None,
        exists f : map -> W, [/\ isomorphism f, f (facing map) = facing W & f (robot map) = pose],
        forall j i, movable_mapper (handling_history movable_mapper W j) = Act (LeaveBy i) ->
          i < degree (handling_situation movable_mapper W j).2.1
      & n <= 1 + edges W * round_cost W].
Proof.
move=> simple_W; have short S path : size path < known_vertices S -> short_paths S path by [].
pose K := 1 + edges W * round_cost W; pose bound := edges W + K.+1.
pose first := perceive_lying (Some (facing W)) (facing W).
have spec := movable_marker_answers_right short simple_W (leq_addr K.+1 (edges W)).
have p_K := movable_within short simple_W (fun S path => id) bound.
have at_first : handling_situation movable_mapper W 0 = ([:: first], (facing W, Some (facing W))) by [].
have [//|later later_le|answer r m [_ [T [p [map [-> _ drawn_map _]]]]]|] :=
  @obedient _ _ _ drawing_handled _ _ _ _ _ _ _ _ _ at_first spec p_K.
- rewrite -[LHS]/(drawing_handled (obey_handling (movable short_paths (size later).+1 first) later)).
  rewrite (@same_movable _ bound) //.
  by rewrite /bound addnS ltnS (leq_trans later_le) ?leq_addl.
- by exists map; rewrite /= drawn_map.
move=> answer [n [answered [lying right] n_le doors]].
move: right => [T [p [map [answerE _ drawn_map iso]]]]; exists map, n.
case: (handling_situation _ _ n).2 lying iso => pose l /= -> iso; split=> //.
  by rewrite answered answerE /= drawn_map.
by move=> j i; apply: doors.
Qed.
