(** A robot that runs a program is a strategy, and has the properties that always hold for the program.
    Section 2.1. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Section Obeying.

Variables (A : Type) (M : marker) (W : start).

(** From a situation in which the robot runs [p]. *)
Lemma obeys_from (robot : strategy A) p past n (pose : W) (Q : A -> W -> nat -> Prop) :
  situation robot M W n = (past, pose) -> (forall later, robot (past ++ later) = obey p later) ->
  always M p pose Q ->
  exists a k,
    [/\ robot (history robot M W (n + k)) = Answer a, Q a (situation robot M W (n + k)).2 k
      & forall j i, n <= j -> robot (history robot M W j) = Leave i ->
          i < degree (situation robot M W j).2].
Proof.
elim: p past n pose Q => [a|i go IH|T ok default go IH] past n pose Q at_n obeys /=.
- have answered : robot past = Answer a by have := obeys [::]; rewrite cats0.
  exists a, 0; rewrite addn0 /history at_n; split=> // j i /subnKC <-.
  have -> : situation robot M W (n + (j - n)) = (past, pose).
    by elim: (j - n) => [|l stays]; rewrite ?addn0 // addnS /= stays answered.
  by rewrite /= answered.
- case=> open_i all; have leaves : robot past = Leave i by have := obeys [::]; rewrite cats0.
  set pose' := traverse pose i; set seen := perceive M pose'.
  have at_n1 : situation robot M W n.+1 = (rcons past seen, pose') by rewrite /= at_n leaves.
  have obeys' later : robot (rcons past seen ++ later) = obey (go seen) later by rewrite cat_rcons obeys.
  have [a [k [answered q doors]]] := IH _ _ _ _ _ at_n1 obeys' all.
  exists a, k.+1; rewrite -addSnnS; split=> // j i'; rewrite leq_eqVlt => /predU1P[<-|]; last exact: doors.
  by rewrite /history at_n /= leaves => -[<-].
- by case=> okd /(_ default okd); apply: IH at_n obeys.
Qed.

Lemma obeying_always (p : percept -> program A) (Q : A -> W -> nat -> Prop) :
  always M (p (perceive M (facing W))) (facing W) Q ->
  let robot := obeying p in
  exists a n,
    [/\ robot (history robot M W n) = Answer a, Q a (situation robot M W n).2 n
      & forall j i, robot (history robot M W j) = Leave i -> i < degree (situation robot M W j).2].
Proof.
move=> all robot; pose at_first : situation robot M W 0 = ([:: perceive M (facing W)], facing W) := erefl.
have [//|a [n [answered q doors]]] := obeys_from at_first _ all.
by exists a, n; split=> // j i; apply: doors.
Qed.

End Obeying.
