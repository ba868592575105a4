(** A robot that runs a program is a strategy, and has the properties that always hold for the program.
    Section 2.1. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** * A program on given percepts *)

(** Its answer and the remaining percepts, or the action that comes next. *)
Fixpoint finish E A (p : program_of E A) (past : seq percept) : E + A * seq percept :=
  match p with
  | Return a => inr (a, past)
  | Do e go => if past is seen :: later then finish (go seen) later else inl e
  | Choose T _ default go => finish (go default) past
  end.

Section Finish.

Variable E : Type.

Lemma obey_bind A B (p : program_of E A) (next : A -> program_of E B) past :
  obey (let* a := p in next a) past =
  match finish p past with inl e => Act e | inr (a, later) => obey (next a) later end.
Proof. by elim: p past => [a|e go IH|T ok default go IH] [|seen past] /=. Qed.

Lemma finish_bind A B (p : program_of E A) (next : A -> program_of E B) past :
  finish (let* a := p in next a) past =
  match finish p past with inl e => inl e | inr (a, later) => finish (next a) later end.
Proof. by elim: p past => [a|e go IH|T ok default go IH] [|seen past] /=. Qed.

Lemma finish_le A (p : program_of E A) past a later :
  finish p past = inr (a, later) -> size later <= size past.
Proof.
elim: p past => [b|e go IH|T ok default go IH] past /=; first by case=> _ ->.
  by case: past => // seen past /IH le; apply: leq_trans le (leqnSn _).
exact: IH.
Qed.

(** An action needs a percept. *)
Lemma finish_do_lt A e (next : percept -> program_of E A) past a later :
  finish (let* seen := do_action e in next seen) past = inr (a, later) -> size later < size past.
Proof. by case: past => //= seen past ended; rewrite ltnS; apply: finish_le ended. Qed.

End Finish.

(** * A robot that does what a program does *)

Section Obeying.

Variables (E A : Type) (I : environment E).
Implicit Type s : state I.

(** The percepts of a robot that runs the program to its end. *)
Fixpoint heard (p : program_of E A) s : seq percept :=
  match p with
  | Return _ => [::]
  | Do e go => sense (next_state s e) :: heard (go (sense (next_state s e))) (next_state s e)
  | Choose T _ default go => heard (go default) s
  end.

Lemma always_heard p s Q : always I p s Q -> exists a t, Q a t (size (heard p s)).
Proof.
elim: p s Q => [a|e go IH|T ok default go IH] s Q /=; first by exists a, s.
  by case=> _ /IH.
by case=> okd /(_ default okd)/IH.
Qed.

Variables (B : Type) (report : decision E A -> decision E B).
Hypothesis report_act : forall e, report (Act e) = Act e.

(** A strategy that does what the program does until it ends reports the program's answer. *)
Lemma obedient (robot : strategy_of E B) p past n s (Q : A -> state I -> nat -> Prop) :
  situation robot I n = (past, s) -> always I p s Q ->
  (forall later, size later <= size (heard p s) -> robot (past ++ later) = report (obey p later)) ->
  (forall a t k, Q a t k -> exists b, report (Answer a) = Answer b) ->
  exists a k,
    [/\ robot (history robot I (n + k)) = report (Answer a), Q a (situation robot I (n + k)).2 k
      & forall j e, n <= j -> robot (history robot I j) = Act e -> possible (situation robot I j).2 e].
Proof.
elim: p past n s Q => [a|e go IH|T ok default go IH] past n s Q at_n /=.
- move=> q obeys reports; have [b reported] := reports a s 0 q.
  have answered : robot past = Answer b by have := obeys [::] isT; rewrite cats0 /= reported.
  exists a, 0; rewrite addn0 /history at_n reported; split=> // j e /subnKC <-.
  have -> : situation robot I (n + (j - n)) = (past, s).
    by elim: (j - n) => [|l stays]; rewrite ?addn0 // addnS /= stays answered.
  by rewrite /= answered.
- case=> can all obeys reports; set s' := next_state s e; set seen := sense s'.
  have does : robot past = Act e by have := obeys [::] isT; rewrite cats0 /= report_act.
  have at_n1 : situation robot I n.+1 = (rcons past seen, s') by rewrite /= at_n does.
  have obeys' later : size later <= size (heard (go seen) s') ->
      robot (rcons past seen ++ later) = report (obey (go seen) later).
    by move=> le; rewrite cat_rcons obeys.
  have [|a [k [answered q only]]] := IH _ _ _ _ _ at_n1 all obeys'.
    by move=> a t k; apply: reports.
  exists a, k.+1; rewrite -addSnnS; split=> // j e'; rewrite leq_eqVlt => /predU1P[<-|]; last exact: only.
  by rewrite /history at_n /= does => -[<-].
by case=> okd /(_ default okd); apply: IH at_n.
Qed.

End Obeying.

Lemma obeying_always E A (I : environment E) (p : percept -> program_of E A) (Q : A -> state I -> nat -> Prop) :
  always I (p (sense (first_state I))) (first_state I) Q ->
  let robot := obeying p in
  exists a n,
    [/\ robot (history robot I n) = Answer a, Q a (situation robot I n).2 n
      & forall j e, robot (history robot I j) = Act e -> possible (situation robot I j).2 e].
Proof.
move=> all robot.
have at_first : situation robot I 0 = ([:: sense (first_state I)], first_state I) by [].
have [//|//|a t k _|a [n [answered q only]]] := obedient (report := id) _ at_first all; first by exists a.
by exists a, n; split=> // j e; apply: only.
Qed.
