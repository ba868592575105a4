(** The mapping algorithms as an OCaml program, which [compare/main.ml] runs and a test compares with those of
    toposlam: on every small start with the default choices and with all choices, on larger ones with random
    choices; the folding explorer with the actions of the running one. This trusts Coq's extraction, and its
    mapping of booleans, options, pairs and lists to OCaml's own. Numbers are not mapped: they are Coq's [nat],
    with Coq's arithmetic. *)

From mathcomp Require Import all_ssreflect.
From Coq Require Extraction ExtrOcamlBasic.
From toposlam Require Import Spec Algorithm1 FoldingExplorer GivenActions Deeds.
From toposlam Require MovableMarker.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** With a limit on rounds, and the percept at the start. *)
Definition directional_mapping bound seen := deeds_of (@leaves _) (algorithm1 step_by_step any_path bound seen).
Definition movable_mapping bound seen := deeds_of (@handles _) (MovableMarker.movable any_path bound seen).

(** The folding explorer with given actions, with a limit on their number. Its ways are not longer than necessary, and
    its tests become strict when those of the running explorer do. *)
Definition folding_mapping bound seen := guided_explorer no_longer usual_patience bound seen.
(** The same with strict tests only. *)
Definition strict_folding_mapping bound seen := guided_explorer no_longer (fun=> 0) bound seen.

(** The path through the map that a test takes from a dart to the marker. *)
Definition path_to_marker S d : seq nat := to_root S (tree_from S 0) (vertex S d).

Extraction Language OCaml.
(* Extraction warns that it opens proofs of comparisons; no value depends on them. *)
Set Warnings "-extraction-opaque-accessed,-extraction-reserved-identifier".
Extraction "mappings.ml" directional_mapping movable_mapping folding_mapping strict_folding_mapping
  (* From these the walks of the running explorer are translated into actions. *)
  passages from_dart to_dart stands_for dart_in_trail far_end predicts pose_in_map path_to_marker.
