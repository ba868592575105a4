(** A robot's program: what it does, one move at a time, with every choice that is left open.

    A program knows nothing of the world but what is perceived behind the doors that it takes: it is a
    tree, and the world only says where in it the robot is. Definitions only. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** Return an answer; move by a door, and go on with what is perceived behind it; or choose anything that
    is allowed, where nothing says otherwise the default. *)
Inductive program (A : Type) : Type :=
  | Return of A
  | Move of door & (percept -> program A)
  | Choose (T : Type) of T -> bool & T & (T -> program A).

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
Definition choose T (allowed : T -> bool) (default : T) : program T := Choose allowed default (@Return T).

(** Moves by one door after the other, whatever is perceived. *)
Fixpoint moves (doors : seq door) : program unit :=
  if doors is i :: others then (move i ;; moves others) else Return tt.

(** Whatever is chosen: the program, begun at this pose, takes only doors that there are, and comes to an
    end, with an answer, at a pose, after a number of moves, of which [Q] holds. That the default is allowed
    says that there always is a choice. That it comes to an end need not be said: no program is endless. *)
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

(** What a robot that obeys the program, and chooses the default each time, does after it has perceived
    this behind the doors that it took. *)
Fixpoint obey A (p : program A) (past : seq percept) : decision A :=
  match p with
  | Return a => Answer a
  | Move i go => if past is seen :: later then obey (go seen) later else Leave i
  | Choose T _ default go => obey (go default) past
  end.

(** Such a robot as a strategy; the program may depend on what is perceived at the start. *)
Definition obeying A (p : percept -> program A) : strategy A :=
  fun past => if past is first :: later then obey (p first) later else Leave 0.
