(** The runs of a program, composed of the runs of its parts. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program Walks.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Section Always.

Variables (M : marker) (W : start).

Lemma always_weaken A (p : program A) (pose : W) (Q R : A -> W -> nat -> Prop) :
  (forall a q k, Q a q k -> R a q k) -> always M p pose Q -> always M p pose R.
Proof.
elim: p pose Q R => [a|i go IH|T ok default go IH] pose Q R QR /=; first exact: QR.
- by case=> open_i all; split=> //; apply: IH all => a q k; apply: QR.
- by case=> okd all; split=> // x /all; apply: IH.
Qed.

(** What holds for all runs holds for some run. *)
Lemma some_run A (p : program A) (pose : W) : ~ always M p pose (fun _ _ _ => False).
Proof.
by elim: p pose => [a|i go IH|T ok default go IH] pose //= [] => [_ /IH|okd /(_ default okd)/IH].
Qed.

Lemma always_bind A B (p : program A) (next : A -> program B) (pose : W) Q :
  always M p pose (fun a q k => always M (next a) q (fun b r l => Q b r (k + l))) ->
  always M (let* a := p in next a) pose Q.
Proof.
elim: p pose Q => [a|i go IH|T ok default go IH] pose Q //=.
- by case=> open_i H; split=> //; apply: IH; apply: always_weaken H.
- by case=> okd all; split=> // x /all; apply: IH.
Qed.

Lemma always_moves doors (pose : W) (Q : unit -> W -> nat -> Prop) :
  passable pose doors -> Q tt (walk pose doors) (size doors) -> always M (moves doors) pose Q.
Proof.
elim: doors pose Q => [|i doors IH] pose Q //= /andP[open_i open_doors] HQ.
by split=> //; apply: IH.
Qed.

(** Moves at the beginning of a program. *)
Lemma always_moves_bind B doors (next : unit -> program B) (pose : W) Q :
  passable pose doors -> always M (next tt) (walk pose doors) (fun b r l => Q b r (size doors + l)) ->
  always M (bind (moves doors) next) pose Q.
Proof. by move=> open_doors H; apply: always_bind; apply: always_moves. Qed.

End Always.
