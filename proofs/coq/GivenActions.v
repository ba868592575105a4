(** The folding explorer with actions that are given from outside. So the actions of the running explorer are
    compared: an action that is not allowed ends the run. Definitions only. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program Algorithm1 FoldingExplorer.

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
