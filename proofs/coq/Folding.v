(** What a walk proves, with a directional marker. Definitions only. Beyond Section 2.3; the terms are those
    of [docs/folding.md]. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** * The walk of a robot *)

(** The doors that the robot has taken after a number of decisions. *)
Fixpoint doors_taken A (robot : strategy A) (M : marker) (W : start) (decisions : nat) : seq door :=
  if decisions is earlier.+1 then
    let doors := doors_taken robot M W earlier in
    if robot (history robot (moving M W) earlier) is Act i then rcons doors i else doors
  else [::].

(** Whether a walk goes over the edge of a dart, in either direction. *)
Fixpoint traverses (G : embedded_graph) (pose : G) (doors : seq door) (d : G) : bool :=
  if doors is i :: others then
    [|| turn pose i == d, traverse pose i == d | traverses (traverse pose i) others d]
  else false.

(** How often a walk in a start comes back to the marked vertex. *)
Definition returns (W : start) (doors : seq door) : nat :=
  count (fun k => same_vertex (walk (facing W) (take k.+1 doors)) (facing W)) (iota 0 (size doors)).

(** Whether a walk leads from the marker to the vertex of a dart without going over these edges. *)
Definition near_without (W : start) (far : pred W) (d : W) : bool :=
  connect (fun x y => (y == clockwise x) || (y == opposite x) && ~~ far x) (facing W) d.

(** The number of these edges, by one dart of each; and of the vertices that are not near without them. *)
Definition far_edges (W : start) (far : pred W) : nat := #|[set d : W | (froot opposite d == d) && far d]|.
Definition far_vertices (W : start) (far : pred W) : nat :=
  #|[set d : W | (froot clockwise d == d) && ~~ near_without far d]|.

(** * The folded trail *)

Section Trail.

(** The doors of a walk, and the percepts at its beginning and behind each door. *)
Variables (doors : seq door) (seen : seq percept).

(** A dart of the trail: the number of the visit, and the door that leads to the dart from the entry dart of
    this visit. *)
Definition trail_dart := (nat * door)%type.

Definition degree_seen (visit : nat) : nat := (nth (0, Nothing) seen visit).1.
Definition sighting_seen (visit : nat) : sighting := (nth (0, Nothing) seen visit).2.

(** The walk goes over an edge with these two darts: from a visit to the next, or seen from there. *)
Inductive one_edge : trail_dart -> trail_dart -> Prop :=
  | Onward visit : visit < size doors -> one_edge (visit, nth 0 doors visit) (visit.+1, 0)
  | Backward visit : visit < size doors -> one_edge (visit.+1, 0) (visit, nth 0 doors visit).

(** The darts of the trail that are one dart: the facing dart, each time that the marker is seen; and what
    follows from that. *)
Inductive folded : trail_dart -> trail_dart -> Prop :=
  | Same x : folded x x
  | Swapped x y : folded x y -> folded y x
  | Linked x y z : folded x y -> folded y z -> folded x z
  | Around visit i : folded (visit, i + degree_seen visit) (visit, i)
  | Marked visit i visit' j :
      sighting_seen visit = Pointing i -> sighting_seen visit' = Pointing j -> folded (visit, i) (visit', j)
  | Turned x y : folded x y -> folded (x.1, x.2.+1) (y.1, y.2.+1)
  | Beyond x x' y y' : one_edge x x' -> one_edge y y' -> folded x y -> folded x' y'.

(** The walk has gone over the edge of this dart, as far as the folded trail shows. Otherwise the dart is
    open. *)
Definition followed (x : trail_dart) : Prop := exists y z, folded x y /\ one_edge y z.

(** No dart is open. *)
Definition complete : Prop :=
  forall visit i, visit < size seen -> i < degree_seen visit -> followed (visit, i).

(** A dart of the vertex of another, as far as the folded trail shows. *)
Definition at_vertex_of (x y : trail_dart) : Prop := exists i, folded (x.1, i) y.

(** No edge of the folded trail is a loop, and no two are parallel. *)
Definition simple_trail : Prop :=
  (forall x y, one_edge x y -> ~ at_vertex_of x y) /\
  (forall x y x' y', one_edge x y -> one_edge x' y' -> at_vertex_of x x' -> at_vertex_of y y' -> folded x x').

End Trail.

(** The percepts of a walk in a start with a directional marker. *)
Definition sees (W : start) (doors : seq door) : seq percept := percepts directional (facing W) doors.

(** The dart of a start for which a dart of the trail stands. *)
Definition dart_of (W : start) (doors : seq door) (x : trail_dart) : W :=
  turn (walk (facing W) (take x.1 doors)) x.2.

(** How many percepts are not what they should be. *)
Definition false_percepts (right perceived : seq percept) : nat :=
  count (fun both => both.1 != both.2) (zip right perceived).
