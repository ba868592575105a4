(** A robot's program: its moves, one at a time, with open choices. A program depends on the world only
    through the percepts behind the doors that it takes: it is a tree, and the world decides which branch
    the robot takes. Definitions only. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** What may be chosen: everything for which [allows] holds. If it is one of a list, this is [listed]: only such
    a choice is made otherwise than by default when the program runs. *)
Record options (T : Type) := Options { allows :> T -> bool; listed : seq T }.

Definition such_that T (allowed : T -> bool) : options T := Options allowed [::].
Definition among (T : eqType) (xs : seq T) : options T := Options (fun x => x \in xs) xs.

(** Return an answer; move by a door, and continue with the percept behind it; or choose anything that is
    allowed, the default unless stated otherwise. *)
Inductive program (A : Type) : Type :=
  | Return of A
  | Move of door & (percept -> program A)
  | Choose (T : Type) of options T & T & (T -> program A).

Fixpoint bind A B (first : program A) (next : A -> program B) : program B :=
  match first with
  | Return a => next a
  | Move i go => Move i (fun seen => bind (go seen) next)
  | Choose T allowed default go => Choose allowed default (fun x => bind (go x) next)
  end.

Notation "'let*' x := first 'in' next" := (bind first (fun x => next))
  (at level 200, x name, first at level 100, next at level 200, right associativity).
Notation "first ;; next" := (bind first (fun=> next))
  (at level 100, next at level 200, right associativity).

Definition move (i : door) : program percept := Move i (@Return percept).
Definition choose T (allowed : T -> bool) (default : T) : program T :=
  Choose (such_that allowed) default (@Return T).
Definition choose_among (T : eqType) (xs : seq T) (default : T) : program T :=
  Choose (among xs) default (@Return T).

(** Moves by one door after the other, for any percepts. *)
Fixpoint moves (doors : seq door) : program unit :=
  if doors is i :: others then (move i ;; moves others) else Return tt.

(** For all choices: the program, begun at this pose, takes only doors that exist, and ends with an
    answer, at a pose, after a number of moves, for which [Q] holds. The default is always allowed, so
    there always is a choice. Termination needs no statement: no program is endless. *)
Fixpoint always A (M : marker) (W : start) (p : program A) (pose : W) (Q : A -> W -> nat -> Prop) : Prop :=
  match p with
  | Return a => Q a pose 0
  | Move i go =>
      i < degree pose /\
      always M (go (perceive M (traverse pose i))) (traverse pose i)
        (fun a pose' moves => Q a pose' moves.+1)
  | Choose T allowed default go =>
      allowed default /\ forall x, allowed x -> always M (go x) pose Q
  end.

(** The decision of a robot that runs the program with the default choices, after these percepts. *)
Fixpoint obey A (p : program A) (past : seq percept) : decision A :=
  match p with
  | Return a => Answer a
  | Move i go => if past is seen :: later then obey (go seen) later else Leave i
  | Choose T _ default go => obey (go default) past
  end.

(** Such a robot as a strategy; the program may depend on the percept at the start. *)
Definition obeying A (p : percept -> program A) : strategy A :=
  fun past => if past is first :: later then obey (p first) later else Leave 0.
