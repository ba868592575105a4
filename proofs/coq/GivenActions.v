(** The folding explorer with actions that are given from outside. So the actions of the running explorer are
    compared: an action that is not allowed ends the run. Every such run is a run of the folding explorer. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program Algorithm1 FoldingExplorer Always.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** The robot's map is complete; the number of actions was too low; an action is not allowed; the robot leaves by
    a door, and goes on with the percept behind it; with this knowledge, it asks for its next action. *)
Inductive guided :=
  | Complete of knowledge
  | OutOfActions
  | NotAllowed
  | Leaving of door & (percept -> guided)
  | Asking of knowledge & (action -> guided).

(** The default choices are made in an action. There are none. *)
Fixpoint guided_by (p : program knowledge) (next : knowledge -> guided) : guided :=
  match p with
  | Return K => next K
  | Do i go => Leaving i (fun seen => guided_by (go seen) next)
  | Choose T _ default go => guided_by (go default) next
  end.

Section Explorer.

Variables (allowed : nat -> nat -> bool) (patience : partial_map -> nat).

Fixpoint guided_actions bound (K : knowledge) : guided :=
  if unexplored (known_map K) is [::] then Complete K else
  if bound is bound'.+1 then
    Asking K (fun a =>
      if allowed_action allowed patience K a then guided_by (perform K a) (guided_actions bound')
      else NotAllowed)
  else OutOfActions.

Definition guided_explorer bound (seen : percept) : guided := guided_actions bound (known_at_start seen).

End Explorer.

(** For all actions that may be given, [Q] holds in the end, if all of them are allowed. *)
Fixpoint always_guided (M : marker) (W : start) (g : guided) (pose : W)
    (Q : option (partial_map * nat) -> W -> nat -> Prop) : Prop :=
  match g with
  | Complete K => Q (Some (known_map K, pose_in_map K)) pose 0
  | OutOfActions => Q None pose 0
  | NotAllowed => True
  | Leaving i go =>
      i < degree pose /\
      always_guided M (go (perceive M (traverse pose i))) (traverse pose i)
        (fun a pose' moves => Q a pose' moves.+1)
  | Asking K ask => forall a, always_guided M (ask a) pose Q
  end.

Section Guided.

Variables (M : marker) (W : start).

Lemma always_bind_inv A B (p : program A) (next : A -> program B) (pose : W) Q :
  always M (let* a := p in next a) pose Q ->
  always M p pose (fun a q k => always M (next a) q (fun b r l => Q b r (k + l))).
Proof.
elim: p pose Q => [a|i go IH|T ok default go IH] pose Q //=.
- by case=> open_i /IH.
by case=> okd all; split=> // x /all /IH.
Qed.

Lemma always_guided_weaken g (pose : W) (Q R : option (partial_map * nat) -> W -> nat -> Prop) :
  (forall a q k, Q a q k -> R a q k) -> always_guided M g pose Q -> always_guided M g pose R.
Proof.
elim: g pose Q R => [K|||i go IH|K ask IH] pose Q R QR //=; try exact: QR.
- by case=> open_i all; split=> //; apply: IH all => a q k; apply: QR.
by move=> all a; apply: IH (all a).
Qed.

Lemma always_guided_by p next (pose : W) Q :
  always M p pose (fun K q k => always_guided M (next K) q (fun a r l => Q a r (k + l))) ->
  always_guided M (guided_by p next) pose Q.
Proof.
elim: p pose Q => [K|i go IH|T ok default go IH] pose Q //=.
- by case=> open_i all; split=> //; apply: IH.
by case=> okd all; apply/IH/all.
Qed.

Lemma always_guided_actions allowed patience bound K (pose : W) Q :
  always M (explorer_actions allowed patience bound K) pose Q ->
  always_guided M (guided_actions allowed patience bound K) pose Q.
Proof.
elim: bound K pose Q => [|bound IH] K pose Q /=; case: (unexplored _) => //= e U [_ all] a.
case: ifP => //= a_ok; apply: always_guided_by.
by apply: always_weaken (always_bind_inv (all a a_ok)) => K' q k; apply: IH.
Qed.

End Guided.
