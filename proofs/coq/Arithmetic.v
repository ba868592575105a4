(** Inequalities of numbers, decided by Coq's own procedure. *)

From mathcomp Require Import all_ssreflect.
From Coq Require Import Lia.

(** MathComp's order and operations are those of Coq's library under other names. *)
Ltac arithmetic :=
  try apply/leP;
  repeat match goal with
  | H : is_true (andb _ _) |- _ => case/andP: H => ? ?
  end;
  repeat match goal with
  | H : is_true (leq _ _) |- _ => move/leP: H
  | H : @eq nat _ _ |- _ => move: H
  end;
  rewrite -?plusE -?minusE -?multE; lia.
