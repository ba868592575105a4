(** Algorithm 1 as a robot of Section 2.1: a strategy that depends only on its percepts. So there is a
    robot that maps every world with one directional marker. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program Algorithm1 Walks Arithmetic Always Correct.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** The robot runs Algorithm 1 with its default choices. It has made fewer rounds than it has percepts, so
    their number is a sufficient limit, and it need not know the size of the world. *)
Definition mapper : strategy start := fun past =>
  if past is first :: later then
    match obey (algorithm1 short_paths (size past) first) later with
    | Leave i => Leave i
    | Answer (Some (T, pose)) => if drawn T pose is Some map then Answer (map : start) else Leave 0
    | Answer None => Leave 0
    end
  else Leave 0.

(** * The limit makes no difference before it is reached *)

(** A program, run on some percepts: its answer and the remaining percepts, or the door to take next. *)
Fixpoint finish A (p : program A) (past : seq percept) : door + A * seq percept :=
  match p with
  | Return a => inr (a, past)
  | Move i go => if past is seen :: later then finish (go seen) later else inl i
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
Lemma explore_moves allowed S pose past a later :
  finish (explore allowed S pose) past = inr (a, later) -> size later < size past.
Proof.
rewrite /explore /= finish_bind; case moved: finish => [//|[u past']] /=.
case: past' moved => // seen past' moved ended.
exact: leq_ltn_trans (finish_le ended) (finish_le moved).
Qed.

Lemma same_rounds allowed b b' S pose past : size past < b -> size past < b' ->
  obey (rounds allowed b S pose) past = obey (rounds allowed b' S pose) past.
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
  | Move i go =>
      perceive M (traverse pose i) :: heard (go (perceive M (traverse pose i))) (traverse pose i)
  | Choose T _ default go => heard (go default) pose
  end.

Lemma always_heard p pose Q : always M p pose Q ->
  exists a r, obey p (heard p pose) = Answer a /\ Q a r (size (heard p pose)).
Proof.
elim: p pose Q => [a|i go IH|T ok default go IH] pose Q /=; first by exists a, pose.
  by case=> _ /IH.
by case=> okd /(_ default okd)/IH.
Qed.

Variables (B : Type) (report : decision A -> decision B).
Hypothesis report_leave : forall i, report (Leave i) = Leave i.

(** A strategy that does what the program does until it ends gives the same answer. *)
Lemma obedient (robot : strategy B) p past n (pose : W) a b :
  situation robot M W n = (past, pose) ->
  (forall later, size later <= size (heard p pose) -> robot (past ++ later) = report (obey p later)) ->
  obey p (heard p pose) = Answer a -> report (Answer a) = Answer b -> answers robot M W b.
Proof.
elim: p past n pose => [c|i go IH|T ok default go IH] past n pose at_n obeys /=.
- case=> <- reported; exists n; rewrite /history at_n /=.
  by have := obeys [::] isT; rewrite cats0 /= reported.
- set seen := perceive _ _ => ended reported.
  have leaves : robot past = Leave i by have := obeys [::] isT; rewrite cats0 /= report_leave.
  apply: (IH seen (rcons past seen) n.+1 (traverse pose i)) ended reported.
    by rewrite /= at_n leaves.
  by move=> later le; rewrite cat_rcons obeys.
- exact: IH at_n obeys.
Qed.

End Obedient.

(** One directional marker suffices. *)
Lemma mapper_maps W : maps_start directional mapper W.
Proof.
have short S path : size path < known_vertices S -> short_paths S path by [].
pose first := perceive directional (facing W).
pose bound := (edges W + cost W (edges W)).+1.
have le : edges W <= bound by rewrite /bound -addnS leq_addr.
have [answer [pose [ended [right cost_le]]]] := always_heard (algorithm1_spec short le).
have {cost_le} moves_le := cost_le (fun S path => id).
have [T [p [map [answered _ drawn_map [f [iso facing_f _]]]]]] := right.
exists (map : start); last by exists f.
pose report (d : decision (option (partial_map * nat))) : decision start :=
  match d with
  | Leave i => Leave i
  | Answer (Some (T, pose)) => if drawn T pose is Some map then Answer (map : start) else Leave 0
  | Answer None => Leave 0
  end.
have reported : report (Answer answer) = Answer (map : start) by rewrite /report answered drawn_map.
apply: (@obedient _ _ _ _ report _ _ _ [:: first] 0) ended reported => // later later_le.
rewrite /mapper /= (@same_rounds _ _ bound) //.
by rewrite /bound !ltnS (leq_trans later_le) // (leq_trans moves_le) // leq_addl.
Qed.
