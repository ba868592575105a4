(** The two mapping algorithms as an OCaml program, which [compare/main.ml] runs and a test compares with
    those of toposlam, on every small start. This trusts Coq's extraction, and its mapping of booleans,
    options, pairs and lists to OCaml's own. Numbers are not mapped: they are Coq's [nat], with Coq's
    arithmetic. *)

From mathcomp Require Import ssreflect.
From Coq Require Extraction ExtrOcamlBasic.
From toposlam Require Import Spec Algorithm1.
From toposlam Require Program MovableMarker.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** The decisions of a robot that runs a program with the default choices. *)
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

(** With a limit on rounds, and the percept at the start. *)
Definition directional_mapping bound seen := by_default (algorithm1 any_path bound seen).
Definition movable_mapping bound seen := handling_by_default (MovableMarker.movable any_path bound seen).

Extraction Language OCaml.
(* Extraction warns that it opens proofs of comparisons; no value depends on them. *)
Set Warnings "-extraction-opaque-accessed,-extraction-reserved-identifier".
Extraction "mappings.ml" directional_mapping movable_mapping.
