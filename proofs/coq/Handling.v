(** Robots that handle one movable marker, as strategies: like [strategy] in [Spec.v], for the marker of
    [MovableMarker.v]. Definitions only. Section 2.3. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program.
From toposlam Require MovableMarker.

Import MovableMarker(handling_action, LeaveBy, PickUp, Drop).

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** From its percepts so far the robot decides by which door to leave, to pick up the marker or to drop it,
    or what to answer. It perceives its place again when it has picked up or dropped the marker. *)
Inductive handling (A : Type) := Act of handling_action | Report of A.

Arguments Act {A}.

Definition handling_strategy (A : Type) := seq percept -> handling A.

(** The robot's pose and the place of the marker after an action. It cannot pick up a marker that does not lie there,
    and cannot drop one that it does not carry. *)
Definition handle (W : start) (e : handling_action) (pose : W) (lying : option W) : W * option W :=
  match e with
  | LeaveBy i => (traverse pose i, lying)
  | PickUp => (pose, if lying is Some spot then if same_vertex pose spot then None else lying else lying)
  | Drop => (pose, if lying is None then Some pose else lying)
  end.

Section Runs.

Variables (A : Type) (robot : handling_strategy A) (W : start).

(** The robot's percepts, its pose and the place of the marker after a number of decisions. *)
Fixpoint handling_situation (decisions : nat) : seq percept * (W * option W) :=
  if decisions is earlier.+1 then
    let: (past, (pose, lying)) := handling_situation earlier in
    if robot past is Act e then
      let: (pose', lying') := handle e pose lying in
      (rcons past (MovableMarker.perceive_lying lying' pose'), (pose', lying'))
    else (past, (pose, lying))
  else
    ([:: MovableMarker.perceive_lying (Some (facing W)) (facing W)], (facing W, Some (facing W))).

Definition handling_history decisions := (handling_situation decisions).1.

Definition reports (a : A) := exists decisions, robot (handling_history decisions) = Report a.

End Runs.

(** The robot answers with a map that is isomorphic to its world. *)
Definition handling_maps (robot : handling_strategy embedded_graph) (W : start) :=
  exists2 map : embedded_graph, reports robot W map & isomorphic map W.

(** * Programs as strategies *)

(** The decision of a robot that runs the program of [MovableMarker.v] with the default choices, after these
    percepts. *)
Fixpoint obey_handling A (p : program_of handling_action A) (past : seq percept) : handling A :=
  match p with
  | Return a => Report a
  | Do e go => if past is seen :: later then obey_handling (go seen) later else Act e
  | Choose T _ default go => obey_handling (go default) past
  end.

(** For all choices: the program, begun at this pose and with this place of the marker, ends within a number
    of decisions: moves, pick-ups and drops. *)
Fixpoint within (W : start) A (decisions : nat) (p : program_of handling_action A)
    (pose : W) (lying : option W) : Prop :=
  match p with
  | Return _ => True
  | Do e go =>
      if decisions is others.+1 then
        let: (pose', lying') := handle e pose lying in
        within others (go (MovableMarker.perceive_lying lying' pose')) pose' lying'
      else False
  | Choose T allowed _ go => forall x, allowed x -> within decisions (go x) pose lying
  end.
