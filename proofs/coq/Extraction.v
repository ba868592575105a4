(** The two mapping algorithms as a program of OCaml, which [compare/main.ml] runs and a test compares with
    the ones of toposlam, on every small start.

    Trusted is what Coq's extraction does, and that booleans, options, pairs and lists are OCaml's own.
    Numbers are not replaced: they are Coq's [nat], with Coq's arithmetic. *)

From mathcomp Require Import ssreflect.
From Coq Require Extraction ExtrOcamlBasic.
From toposlam Require Import Spec Algorithm1.
From toposlam Require Program MovableMarker.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** What a robot does that obeys a program and chooses the default each time. *)
Inductive deeds (A : Type) :=
  | Answers of A
  | Leaves of door & (percept -> deeds A)
  | PicksUp of deeds A
  | Drops of deeds A.

Arguments Answers {A}.
Arguments Leaves {A}.
Arguments PicksUp {A}.
Arguments Drops {A}.

Fixpoint by_default A (p : Program.program A) : deeds A :=
  match p with
  | Program.Return a => Answers a
  | Program.Move i go => Leaves i (fun seen => by_default (go seen))
  | Program.Choose T _ default go => by_default (go default)
  end.

Fixpoint handling_by_default A (p : MovableMarker.handling_program A) : deeds A :=
  match p with
  | MovableMarker.Return a => Answers a
  | MovableMarker.Move i go => Leaves i (fun seen => handling_by_default (go seen))
  | MovableMarker.PickUp go => PicksUp (handling_by_default go)
  | MovableMarker.Drop go => Drops (handling_by_default go)
  | MovableMarker.Choose T _ default go => handling_by_default (go default)
  end.

(** So many rounds are allowed, and this is perceived at the start. *)
Definition directional_mapping bound seen := by_default (algorithm1 any_path bound seen).
Definition movable_mapping bound seen := handling_by_default (MovableMarker.movable any_path bound seen).

Extraction Language OCaml.
(* That the proofs of comparisons are looked into, and some names of theirs, is of no account: no value
   depends on them. *)
Set Warnings "-extraction-opaque-accessed,-extraction-reserved-identifier".
Extraction "mappings.ml" directional_mapping movable_mapping.
