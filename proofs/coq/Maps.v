(** What holds of every map that Algorithm 1 builds, whatever the world. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program Algorithm1.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** The darts of a vertex stand together, the first one first; [other] is an involution where it is known;
    and every vertex can be reached from the start vertex. *)
Record well_formed (S : partial_map) : Prop := WellFormed {
  wf_some : 0 < size S;
  wf_first : vertex S 0 = 0;
  wf_bounds : forall d, d < size S ->
    vertex S d <= d < vertex S d + doors S d /\ vertex S d + doors S d <= size S;
  wf_same : forall d e, d < size S -> vertex S d <= e < vertex S d + doors S d ->
    vertex S e = vertex S d /\ doors S e = doors S d;
  wf_other : forall d d', other S d = Some d' -> [/\ d' < size S, d' != d & other S d' = Some d];
  wf_connected : forall P : nat -> bool, P 0 ->
    (forall d d', other S d = Some d' -> P (vertex S d) -> P (vertex S d')) ->
    forall d, d < size S -> P (vertex S d)
}.
