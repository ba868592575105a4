(** The runs of a program, composed of the runs of its parts. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program Walks.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Section Always.

Variables (E : Type) (I : environment E).
Implicit Type s : state I.

Lemma alwaysW A (p : program_of E A) s (Q R : A -> state I -> nat -> Prop) :
  (forall a t k, Q a t k -> R a t k) -> always I p s Q -> always I p s R.
Proof.
elim: p s Q R => [a|e go IH|T ok default go IH] s Q R QR /=; first exact: QR.
- by case=> can all; split=> //; apply: IH all => a t k; apply: QR.
- by case=> okd all; split=> // x /all; apply: IH.
Qed.

(** What holds for all runs holds for some run. *)
Lemma alwaysF A (p : program_of E A) s : ~ always I p s (fun _ _ _ => False).
Proof.
by elim: p s => [a|e go IH|T ok default go IH] s //= [] => [_ /IH|okd /(_ default okd)/IH].
Qed.

Lemma always_bind A B (p : program_of E A) (next : A -> program_of E B) s Q :
  always I p s (fun a t k => always I (next a) t (fun b u l => Q b u (k + l))) -> always I (let* a := p in next a) s Q.
Proof.
elim: p s Q => [a|e go IH|T ok default go IH] s Q //=.
- by case=> can all; split=> //; apply: IH; apply: alwaysW all.
- by case=> okd all; split=> // x /all; apply: IH.
Qed.

(** A part of a program whose end is known, and the rest. *)
Lemma always_then A B (p : program_of E A) (next : A -> program_of E B) s Q R :
  always I p s Q -> (forall a t k, Q a t k -> always I (next a) t (fun b u l => R b u (k + l))) ->
  always I (let* a := p in next a) s R.
Proof. by move=> p_Q next_R; apply/always_bind/alwaysW/p_Q. Qed.

(** And the other way round. *)
Lemma always_bindE A B (p : program_of E A) (next : A -> program_of E B) s Q :
  always I (let* a := p in next a) s Q -> always I p s (fun a t k => always I (next a) t (fun b u l => Q b u (k + l))).
Proof.
elim: p s Q => [a|e go IH|T ok default go IH] s Q //=.
- by case=> can all; split=> //; apply: alwaysW (IH _ _ _ all).
- by case=> okd all; split=> // x /all; apply: IH.
Qed.

End Always.

(** * Moves *)

Section Moving.

Variables (M : marker) (W : start).

Lemma always_moves doors (pose : W) (Q : unit -> W -> nat -> Prop) :
  passable pose doors -> Q tt (walk pose doors) (size doors) -> always (moving M W) (moves doors) pose Q.
Proof.
elim: doors pose Q => [|i doors IH] pose Q //= /andP[open_i open_doors] HQ.
by split=> //; apply: IH.
Qed.

(** Moves at the beginning of a program. *)
Lemma always_moves_bind B doors (next : unit -> program B) (pose : W) Q :
  passable pose doors ->
  always (moving M W) (next tt) (walk pose doors) (fun b r l => Q b r (size doors + l)) ->
  always (moving M W) (bind (moves doors) next) pose Q.
Proof. by move=> open_doors all; apply: always_bind; apply: always_moves. Qed.

End Moving.
