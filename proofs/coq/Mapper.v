(** Algorithm 1 as a robot of Section 2.1: a strategy that depends only on its percepts. So there is a
    robot that maps every world with one directional marker. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program Algorithm1 Walks Arithmetic Always Correct.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** What a robot does that runs Algorithm 1: at the end it answers with the world of its map, and its pose in
    it. *)
Definition drawing (d : decision (option (partial_map * nat))) : decision located :=
  match d with
  | Leave i => Leave i
  | Answer (Some (T, pose)) => if drawn T pose is Some map then Answer map else Leave 0
  | Answer None => Leave 0
  end.

(** The robot runs Algorithm 1 with its default choices. It has made fewer rounds than it has percepts, so
    their number is a sufficient limit, and it need not know the size of the world. *)
Definition locating_mapper : strategy located := fun past =>
  if past is first :: later then drawing (obey (algorithm1 step_by_step short_paths (size past) first) later)
  else Leave 0.

(** The same robot, which answers without its pose. *)
Definition mapper : strategy start := fun past =>
  match locating_mapper past with Leave i => Leave i | Answer map => Answer (world map) end.

(** * The limit makes no difference before it is reached *)

(** A program, run on some percepts: its answer and the remaining percepts, or the door to take next. *)
Fixpoint finish A (p : program A) (past : seq percept) : door + A * seq percept :=
  match p with
  | Return a => inr (a, past)
  | Do i go => if past is seen :: later then finish (go seen) later else inl i
  | Choose T _ default go => finish (go default) past
  end.

Lemma obey_bind A B (p : program A) (next : A -> program B) past :
  obey (let* a := p in next a) past =
  match finish p past with inl i => Leave i | inr (a, later) => obey (next a) later end.
Proof. by elim: p past => [a|i go IH|T ok default go IH] [|seen past] /=. Qed.

Lemma finish_bind A B (p : program A) (next : A -> program B) past :
  finish (let* a := p in next a) past =
  match finish p past with inl i => inl i | inr (a, later) => finish (next a) later end.
Proof. by elim: p past => [a|i go IH|T ok default go IH] [|seen past] /=. Qed.

Lemma finish_le A (p : program A) past a later :
  finish p past = inr (a, later) -> size later <= size past.
Proof.
elim: p past => [b|i go IH|T ok default go IH] past /=; first by case=> _ ->.
  by case: past => // seen past /IH le; apply: leq_trans le (leqnSn _).
exact: IH.
Qed.

(** Every round has a percept. *)
Lemma explore_moves test allowed S pose past a later :
  finish (explore test allowed S pose) past = inr (a, later) -> size later < size past.
Proof.
rewrite /explore /= finish_bind; case moved: finish => [//|[u past']] /=.
case: past' moved => // seen past' moved ended.
exact: leq_ltn_trans (finish_le ended) (finish_le moved).
Qed.

Lemma same_rounds test allowed b b' S pose past : size past < b -> size past < b' ->
  obey (rounds test allowed b S pose) past = obey (rounds test allowed b' S pose) past.
Proof.
elim: b b' S pose past => // b IH [//|b'] S pose past le le'.
rewrite !another_round; case: (unexplored S) => // _ _; rewrite !obey_bind.
case explored: finish => [//|[after later]]; have lt := explore_moves explored.
by apply: IH; apply: leq_trans lt _.
Qed.

(** * The strategy does what the program does *)

Section Obedient.

Variables (A : Type) (M : marker) (W : start).

(** The percepts of a robot that runs the program to its end. *)
Fixpoint heard (p : program A) (pose : W) : seq percept :=
  match p with
  | Return _ => [::]
  | Do i go =>
      perceive M (traverse pose i) :: heard (go (perceive M (traverse pose i))) (traverse pose i)
  | Choose T _ default go => heard (go default) pose
  end.

Variables (B : Type) (report : decision A -> decision B).
Hypothesis report_leave : forall i, report (Leave i) = Leave i.

(** A strategy that does what the program does until it ends reports the program's answer. *)
Lemma obedient (robot : strategy B) p past n (pose : W) (Q : A -> W -> nat -> Prop) :
  situation robot M W n = (past, pose) -> always M p pose Q ->
  (forall later, size later <= size (heard p pose) -> robot (past ++ later) = report (obey p later)) ->
  (forall a r k, Q a r k -> exists b, report (Answer a) = Answer b) ->
  exists a k,
    [/\ robot (history robot M W (n + k)) = report (Answer a), Q a (situation robot M W (n + k)).2 k
      & forall j i, n <= j -> robot (history robot M W j) = Leave i ->
          i < degree (situation robot M W j).2].
Proof.
elim: p past n pose Q => [a|i go IH|T ok default go IH] past n pose Q at_n /=.
- move=> q obeys reports; have [b reported] := reports a pose 0 q.
  have answered : robot past = Answer b by have := obeys [::] isT; rewrite cats0 /= reported.
  exists a, 0; rewrite addn0 /history at_n reported; split=> // j i /subnKC <-.
  have -> : situation robot M W (n + (j - n)) = (past, pose).
    by elim: (j - n) => [|l stays]; rewrite ?addn0 // addnS /= stays answered.
  by rewrite /= answered.
- case=> open_i all obeys reports; set pose' := traverse pose i; set seen := perceive M pose'.
  have leaves : robot past = Leave i by have := obeys [::] isT; rewrite cats0 /= report_leave.
  have at_n1 : situation robot M W n.+1 = (rcons past seen, pose') by rewrite /= at_n leaves.
  have obeys' later : size later <= size (heard (go seen) pose') ->
      robot (rcons past seen ++ later) = report (obey (go seen) later).
    by move=> le; rewrite cat_rcons obeys.
  have [|a [k [answered q doors]]] := IH _ _ _ _ _ at_n1 all obeys'.
    by move=> a r k; apply: reports.
  exists a, k.+1; rewrite -addSnnS; split=> // j i'; rewrite leq_eqVlt => /predU1P[<-|]; last exact: doors.
  by rewrite /history at_n /= leaves => -[<-].
- by case=> okd /(_ default okd); apply: IH at_n.
Qed.

Lemma always_heard p pose Q : always M p pose Q ->
  exists a r, Q a r (size (heard p pose)).
Proof.
elim: p pose Q => [a|i go IH|T ok default go IH] pose Q /=; first by exists a, pose.
  by case=> _ /IH.
by case=> okd /(_ default okd)/IH.
Qed.

End Obedient.

(** One directional marker suffices, for the pose as well, and within the bound of Algorithm 1. *)
Lemma locating_mapper_maps W :
  let robot := locating_mapper in
  exists map n,
    [/\ robot (history robot directional W n) = Answer map,
        exists f : map -> W, [/\ isomorphism f, f (facing map) = facing W
          & f (Algorithm1.robot map) = (situation robot directional W n).2],
        forall j i, robot (history robot directional W j) = Leave i ->
          i < degree (situation robot directional W j).2
      & n <= cost W (edges W)].
Proof.
move=> robot; have short S path : size path < known_vertices S -> short_paths S path by [].
pose first := perceive directional (facing W).
pose bound := (edges W + cost W (edges W)).+1.
have le : edges W <= bound by rewrite /bound -addnS leq_addr.
have spec := algorithm1_spec step_by_step_valid short le.
have [_ [_ [_ cost_le]]] := always_heard spec.
have {cost_le} moves_le := cost_le (fun S path => id).
have at_first : situation robot directional W 0 = ([:: first], facing W) by [].
have [//|later later_le|answer r k [[T [p [map [-> _ drawn_map _]]]] _]|] :=
  @obedient _ _ _ _ drawing _ robot _ _ _ _ _ at_first spec.
- rewrite /robot /= (@same_rounds _ _ _ bound) //.
  by rewrite /bound !ltnS (leq_trans later_le) // (leq_trans moves_le) // leq_addl.
- by exists map; rewrite /= drawn_map.
move=> answer [n [answered [right cost_n] doors]]; move: right => [T [p [map [answerE _ drawn_map iso]]]].
exists map, n; split=> //; last exact: cost_n (fun S path => id).
  by rewrite answered answerE /= drawn_map.
by move=> j i; apply: doors.
Qed.

Lemma situation_mapper W n : situation mapper directional W n = situation locating_mapper directional W n.
Proof.
elim: n => //= n ->; case: (situation _ _ _ n) => past pose; rewrite /mapper.
by case: (locating_mapper past).
Qed.

Lemma mapper_maps W : maps_start directional mapper W.
Proof.
have [map [n [answered [f [iso facing_f _]] _ _]]] := locating_mapper_maps W.
exists (world map); last by exists f.
by exists n; move: answered; rewrite /history situation_mapper /mapper => ->.
Qed.
