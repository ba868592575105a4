(** A program as data for a robot outside Coq: what it does next, and how it goes on with the percept. That is what is
    extracted. Beyond the paper. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec.
From toposlam Require Program MovableMarker.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** What a robot does that runs a program. [Chooses n go]: it chooses one of the [n] listed options, by its
    number from 0, or the default. It makes the default choice of what is not listed: of paths, and of places and
    back-links for a movable marker. *)
Inductive deeds (A : Type) :=
  | Answers of A
  | Leaves of door & (percept -> deeds A)
  | PicksUp of (percept -> deeds A)
  | Drops of (percept -> deeds A)
  | Chooses of nat & (option nat -> deeds A).

Arguments Answers {A}.
Arguments Leaves {A}.
Arguments PicksUp {A}.
Arguments Drops {A}.
Arguments Chooses {A}.

Definition chooses A T (o : Program.options T) (default : T) (go : T -> deeds A) : deeds A :=
  if Program.listed o is [::] then go default
  else Chooses (size (Program.listed o))
         (fun i => go (if i is Some i then nth default (Program.listed o) i else default)).

(** How a robot does an action and goes on. *)
Definition leaves A (i : door) (go : percept -> deeds A) := Leaves i go.
Definition handles A (e : MovableMarker.handling_action) (go : percept -> deeds A) :=
  match e with
  | MovableMarker.LeaveBy i => Leaves i go
  | MovableMarker.PickUp => PicksUp go
  | MovableMarker.Drop => Drops go
  end.

Fixpoint deeds_of E A (does : E -> (percept -> deeds A) -> deeds A) (p : Program.program_of E A) : deeds A :=
  match p with
  | Program.Return a => Answers a
  | Program.Do e go => does e (fun seen => deeds_of does (go seen))
  | Program.Choose T o default go => chooses o default (fun x => deeds_of does (go x))
  end.

(** The decision of a robot that does this with the default choices, after these percepts. *)
Fixpoint decides E A (leave : door -> E) (pick_up drop : E) (d : deeds A) (past : seq percept) : decision E A :=
  match d, past with
  | Answers a, _ => Answer a
  | Chooses _ go, _ => decides leave pick_up drop (go None) past
  | Leaves _ go, seen :: later | PicksUp go, seen :: later | Drops go, seen :: later =>
      decides leave pick_up drop (go seen) later
  | Leaves i _, [::] => Act (leave i)
  | PicksUp _, [::] => Act pick_up
  | Drops _, [::] => Act drop
  end.

(** It is the decision of the robot that obeys the program. *)
Lemma decides_moves A (p : Program.program A) past :
  decides id 0 0 (deeds_of (@leaves A) p) past = Program.obey p past.
Proof.
elim: p past => [//|i go IH|T o default go IH] past /=; first by case: past => //= seen later; rewrite IH.
by rewrite /chooses; case: (Program.listed o) => [|x xs] /=; rewrite IH.
Qed.

Lemma decides_handles A (p : Program.program_of MovableMarker.handling_action A) past :
  decides MovableMarker.LeaveBy MovableMarker.PickUp MovableMarker.Drop (deeds_of (@handles A) p) past =
  Program.obey p past.
Proof.
elim: p past => [//|e go IH|T o default go IH] past /=.
  by case: e => [i||] /=; case: past => //= seen later; rewrite IH.
by rewrite /chooses; case: (Program.listed o) => [|x xs] /=; rewrite IH.
Qed.

(** A choice by its number is one of those that are listed. *)
Lemma chooses_listed A (T : eqType) (xs : seq T) default (go : T -> deeds A) n next i :
  xs != [::] -> chooses (Program.among xs) default go = Chooses n next -> i < n ->
  exists2 x, Program.allows (Program.among xs) x & next (Some i) = go x.
Proof.
case: xs => //= x xs _ [<- <-] lt; exists (nth default (x :: xs) i) => //; exact: mem_nth.
Qed.
