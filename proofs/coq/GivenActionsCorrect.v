(** Every run of the folding explorer with given actions that are allowed is a run of the folding explorer. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program Algorithm1 FoldingExplorer GivenActions Always.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Section Guided.

Variables (M : marker) (W : start).

Lemma always_guidedW g (pose : W) (Q R : option (partial_map * nat) -> W -> nat -> Prop) :
  (forall a q k, Q a q k -> R a q k) -> always_guided M g pose Q -> always_guided M g pose R.
Proof.
elim: g pose Q R => [K|||i go IH|K ask IH] pose Q R QR //=; try exact: QR.
- by case=> open_i all; split=> //; apply: IH all => a q k; apply: QR.
by move=> all a; apply: IH (all a).
Qed.

Lemma always_guided_by p next (pose : W) Q :
  always (moving M W) p pose (fun K q k => always_guided M (next K) q (fun a r l => Q a r (k + l))) ->
  always_guided M (guided_by p next) pose Q.
Proof.
elim: p pose Q => [K|i go IH|T ok default go IH] pose Q //=.
- by case=> open_i all; split=> //; apply: IH.
by case=> okd all; apply/IH/all.
Qed.

Lemma always_guided_actions allowed patience bound K (pose : W) Q :
  always (moving M W) (explorer_actions allowed patience bound K) pose Q ->
  always_guided M (guided_actions allowed patience bound K) pose Q.
Proof.
elim: bound K pose Q => [|bound IH] K pose Q /=; case: (unexplored _) => //= e U [_ all] a.
case: ifP => //= a_ok; apply: always_guided_by.
by apply: alwaysW (always_bindE (all a a_ok)) => K' q k; apply: IH.
Qed.

End Guided.
