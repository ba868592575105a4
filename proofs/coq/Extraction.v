(** The mapping algorithms as an OCaml program, which [compare/main.ml] runs and a test compares with those of
    toposlam: on every small start with the default choices and with all choices, on larger ones with random
    choices; the folding explorer with the actions of the running one. This trusts Coq's extraction, and its
    mapping of booleans, options, pairs and lists to OCaml's own. Numbers are not mapped: they are Coq's [nat],
    with Coq's arithmetic. *)

From mathcomp Require Import all_ssreflect.
From Coq Require Extraction ExtrOcamlBasic.
From toposlam Require Import Spec Algorithm1 FoldingExplorer GivenActions.
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

(** With a limit on rounds, and the percept at the start. *)
Definition directional_mapping bound seen := deeds_of (@leaves _) (algorithm1 step_by_step any_path bound seen).
Definition movable_mapping bound seen := deeds_of (@handles _) (MovableMarker.movable any_path bound seen).

(** The folding explorer with given actions, with a limit on their number. Its ways are not longer than necessary, and
    its tests become strict when those of the running explorer do. *)
Definition folding_mapping bound seen := guided_explorer no_longer usual_patience bound seen.

(** The path through the map that a test takes from a dart to the marker. *)
Definition path_to_marker S d : seq nat := to_root S (tree_from S 0) (vertex S d).

Extraction Language OCaml.
(* Extraction warns that it opens proofs of comparisons; no value depends on them. *)
Set Warnings "-extraction-opaque-accessed,-extraction-reserved-identifier".
Extraction "mappings.ml" directional_mapping movable_mapping folding_mapping
  (* From these the walks of the running explorer are translated into actions. *)
  passages from_dart to_dart stands_for dart_in_trail far_end predicts pose_in_map path_to_marker.
