(** The aids of [Aids.v] as an OCaml program, which [compare/aids.ml] runs and a test compares with those of toposlam:
    what a robot perceives along walks in small starts, and what it can do. This trusts Coq's extraction, as
    [Extraction.v] does. *)

From mathcomp Require Import all_ssreflect.
From Coq Require Extraction ExtrOcamlBasic.
From toposlam Require Import Spec Aids.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** The start with so many darts, whose facing dart is dart 0. The program has no proofs: whoever gives the two
    permutations has to know that they are those of an embedded graph. *)
Definition start_of (others : nat) (opposite clockwise : 'I_others.+1 -> 'I_others.+1)
    (oppositeK : involutive opposite) (opposite_neq : forall d, opposite d != d) (clockwise_inj : injective clockwise)
    (connected : forall d e, connect (fun x y => (y == opposite x) || (y == clockwise x)) d e) : start :=
  @Start (EmbeddedGraph oppositeK opposite_neq clockwise_inj connected) ord0.

(** What a robot perceives at the start and after each action, and which of the listed actions are possible there. *)
Definition along (X : aid) (W : start) (listed actions : seq (action_with (aid_action X))) :
    seq (nat * sightings X * seq bool) :=
  let I := with_aid X W in
  let situation s := (sense s, map (@possible _ _ I s) listed) in
  map situation (first_state I :: scanl (@next_state _ _ I) (first_state I) actions).

Definition along_alike number := @along (markers_alike number).
Definition along_distinct number := @along (markers_distinct number).
Definition along_directional := @along movable_directional.
Definition along_both := @along directional_and_movable.
Definition along_team heading others := @along (team heading others).
Definition along_string length := @along (string length).

Extraction Language OCaml.
(* What it makes would not have a general type in OCaml. *)
Extraction Inline SimplPred.
Set Warnings "-extraction-opaque-accessed,-extraction-reserved-identifier".
Extraction "aids.ml" start_of along_alike along_distinct along_directional along_both along_team along_string.
