(** Other kinds of markers. Definitions only. Beyond Section 2.2; the names are those of toposlam. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** A mark in the middle of the facing edge, which the robot notices when it has traversed this edge. *)
Definition undirected_edge : marker :=
  fun W pose => if (pose == facing W) || (pose == opposite (facing W)) then Passed else Nothing.

(** An arrow in the middle of the facing edge, away from the start vertex. At the start the robot counts as
    having come in against it. *)
Definition directed_edge : marker :=
  fun W pose =>
    if pose == facing W then PassedAgainst
    else if pose == opposite (facing W) then PassedAlong else Nothing.

(** Two markers that look alike, at both ends of the facing edge. *)
Definition two_identical : marker :=
  fun W pose =>
    match same_vertex pose (facing W), same_vertex pose (opposite (facing W)) with
    | true, true => Two
    | true, false | false, true => Lying
    | false, false => Nothing
    end.

(** Markers that look different at two vertices. *)
Definition two_looks (W : start) (first second pose : W) : sighting :=
  match same_vertex pose first, same_vertex pose second with
  | true, true => Both
  | true, false => First
  | false, true => Second
  | false, false => Nothing
  end.

(** Two markers that look different, at both ends of the facing edge. *)
Definition two_distinct : marker :=
  fun W pose => two_looks (facing W) (opposite (facing W)) pose.

(** Two markers that look different, at the start vertex and two edges further: over the facing edge, and on
    by door 1. *)
Definition two_distant : marker :=
  fun W pose => two_looks (facing W) (walk (facing W) [:: 0; 1]) pose.

(** In this world the marker shows which dart is the facing dart: there, and nowhere else, the robot perceives
    something near the dart's vertex, and something behind its edge. *)
Definition identifies (M : marker) (near beyond : pred percept) (W : start) : Prop :=
  forall p d : W, same_vertex p d ->
    near (perceive M p) && beyond (perceive M (opposite d)) = (d == facing W).
