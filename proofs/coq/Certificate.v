(** Certificates: how few moves determine a world, with a directional marker. Definitions only. Beyond Section 2.3;
    the terms are those of [docs/folding.md]. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Folding.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Section Certificate.

Variable W : start.

(** Whether a walk with so many moves leads from the marker to the vertex of a dart. *)
Fixpoint reached (moves : nat) (d : W) : bool :=
  if moves is others.+1 then [exists e, same_vertex d e && reached others (opposite e)]
  else same_vertex (facing W) d.

(** The least number of moves from the marker to the vertex of a dart. *)
Definition distance (d : W) : nat := find (reached^~ d) (iota 0 #|W|).

(** The edges that hang, by the dart of each that is farther from the marker: at the vertex of this dart, and
    behind its other darts, there is a tree without the marker. *)
Definition hanging : {set W} :=
  fixset (fun trees : {set W} =>
    [set d | ~~ same_vertex (facing W) d & [forall e, same_vertex d e && (e != d) ==> (opposite e \in trees)]]).

(** The number of hanging edges between the vertex of a dart and the marker. *)
Definition edge_of (d : W) : pred W := fun e => (e == d) || (e == opposite d).
Definition hanging_above (d : W) : nat := #|[set e in hanging | ~~ near_without (edge_of e) d]|.

(** The sum of distance u + distance v + 1 over all edges uv, without 2 distance v for each vertex v, which is what
    the edges of a breadth-first tree contribute; twice the number of hanging edges; and what the last way
    saves, which leads to a hanging leaf and not back. *)
Definition certificate_moves : nat :=
  edges W + \sum_(d : W) distance d - 2 * (\sum_(d : W | froot clockwise d == d) distance d)
  + 2 * #|hanging| - \max_(leaf in hanging | degree leaf == 1) (2 * hanging_above leaf - distance leaf).

End Certificate.
