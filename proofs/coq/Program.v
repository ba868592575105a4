(** A robot's program: its actions, one at a time, with open choices. A program depends on the world only
    through the percepts after its actions: it is a tree, and the world decides which branch the robot takes.
    Definitions only. *)

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

(** A program of a robot that can do the actions [E], and then perceives its place. Return an answer; do an action, and
    continue with the percept after it; or choose anything that is allowed, the default unless stated otherwise. *)
Inductive program_of (E A : Type) : Type :=
  | Return of A
  | Do of E & (percept -> program_of E A)
  | Choose (T : Type) of options T & T & (T -> program_of E A).

Arguments Return {E A}.

Fixpoint bind E A B (first : program_of E A) (next : A -> program_of E B) : program_of E B :=
  match first with
  | Return a => next a
  | Do e go => Do e (fun seen => bind (go seen) next)
  | Choose T allowed default go => Choose allowed default (fun x => bind (go x) next)
  end.

Notation "'let*' x := first 'in' next" := (bind first (fun x => next))
  (at level 200, x name, first at level 100, next at level 200, right associativity).
Notation "first ;; next" := (bind first (fun=> next))
  (at level 100, next at level 200, right associativity).

Definition do_action E (e : E) : program_of E percept := Do e Return.
Definition choose {E} T (allowed : T -> bool) (default : T) : program_of E T :=
  Choose (such_that allowed) default Return.
Definition choose_among {E} (T : eqType) (xs : seq T) (default : T) : program_of E T :=
  Choose (among xs) default Return.

(** Some actions, one after the other, for any percepts. *)
Fixpoint do_all E (actions : seq E) : program_of E unit :=
  if actions is e :: others then (do_action e ;; do_all others) else Return tt.

(** * The runs of a program *)

(** For all choices: the program, begun in this state, does only what is possible, and ends with an answer, in a
    state, after a number of actions, for which [Q] holds. The default is always allowed, so there always is a
    choice. Termination needs no statement: no program is endless. *)
Fixpoint always E (I : environment E) A (p : program_of E A) (s : state I) (Q : A -> state I -> nat -> Prop) : Prop :=
  match p with
  | Return a => Q a s 0
  | Do e go =>
      possible s e /\
      always (go (sense (next_state s e))) (next_state s e) (fun a s' actions => Q a s' actions.+1)
  | Choose T allowed default go =>
      allowed default /\ forall x, allowed x -> always (go x) s Q
  end.

Arguments always {E} I {A}.

(** The decision of a robot that runs the program with the default choices, after these percepts. *)
Fixpoint obey E A (p : program_of E A) (past : seq percept) : decision E A :=
  match p with
  | Return a => Answer a
  | Do e go => if past is seen :: later then obey (go seen) later else Act e
  | Choose T _ default go => obey (go default) past
  end.

(** Such a robot as a strategy; the program may depend on the percept at the start. *)
Definition obeying E A (p : percept -> program_of E A) : strategy_of E A :=
  fun past => obey (p (head (0, Nothing) past)) (behead past).

(** * A robot that only moves *)

(** Its actions are the doors by which it leaves. *)
Notation program := (program_of door).

Definition move (i : door) : program percept := do_action i.

(** Moves by one door after the other, for any percepts. *)
Definition moves (doors : seq door) : program unit := do_all doors.
