(** Marking aids: what a robot may use to mark places, as small transition systems on a world; and the aids of
    toposlam that move. Definitions only. Beyond the paper; the names are those of [docs/aids.md]. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** * Marking aids *)

(** A marking aid. In a world it has a state: where markers lie, where a string runs, where other robots
    stand. It adds a sighting to the percept of a robot, which depends on the robot's pose. And it has actions beside
    doors. *)
Record aid := Aid {
  sightings : Type;
  aid_action : Type;
  placed : embedded_graph -> Type;
  (** Its state at a start with this facing dart. *)
  first_placed : forall G : embedded_graph, G -> placed G;
  (** What a robot with this pose sees of it. *)
  shows : forall G : embedded_graph, G -> placed G -> sightings;
  (** Which actions a robot with this pose can do, and what they do. *)
  can_act : forall G : embedded_graph, G -> placed G -> aid_action -> bool;
  act : forall G : embedded_graph, G -> placed G -> aid_action -> placed G;
  (** Whether a robot can leave by this dart, and what that does. *)
  can_leave : forall G : embedded_graph, placed G -> G -> bool;
  leave : forall G : embedded_graph, placed G -> G -> placed G
}.

(** What a robot with an aid can do: take a door, or do something with its aid. *)
Inductive action_with (A : Type) := Take of door | Use of A.

Arguments Take {A}.

(** A robot in a world with an aid. The state is its pose, and the state of the aid. An action that the aid does not
    allow changes nothing. After each action the robot perceives its place, also if it has not moved. *)
Definition with_aid (X : aid) (W : start) : environment_of (nat * sightings X) (action_with (aid_action X)) := {|
  state := W * placed X W;
  first_state := (facing W, first_placed X (facing W));
  possible := fun s e =>
    match e with
    | Take i => (i < degree s.1) && can_leave s.2 (turn s.1 i)
    | Use a => can_act s.1 s.2 a
    end;
  next_state := fun s e =>
    match e with
    | Take i => if can_leave s.2 (turn s.1 i) then (traverse s.1 i, leave s.2 (turn s.1 i)) else s
    | Use a => if can_act s.1 s.2 a then (s.1, act s.1 s.2 a) else s
    end;
  sense := fun s => (degree s.1, shows s.1 s.2)
|}.

(** A robot does only what is possible. *)
Definition possible_only O E A (robot : robot_of O E A) (I : environment_of O E) : Prop :=
  forall decisions e, robot (history robot I decisions) = Act e -> possible (situation robot I decisions).2 e.

Definition takes_door E A (d : decision (action_with E) A) : bool := if d is Act (Take _) then true else false.

(** How many doors a robot takes in its first decisions. *)
Definition doors_used O E A (robot : robot_of O (action_with E) A) (I : environment_of O (action_with E))
    (decisions : nat) : nat :=
  count (fun earlier => takes_door (robot (history robot I earlier))) (iota 0 decisions).

(** * Markers that are picked up and dropped *)

(** The place of a marker: the vertex of a dart, or none while the robot carries it. *)
Definition lies_at (G : embedded_graph) (pose : G) (place : option G) : bool :=
  if place is Some spot then same_vertex pose spot else false.

Definition is_carried (G : embedded_graph) (place : option G) : bool := ~~ place.

Inductive holding := PickUp | Drop.

(** So many undirected markers that look alike. The robot sees how many lie where it is. It picks up one of them, or
    drops one that it carries. *)
Definition markers_alike (number : nat) : aid := {|
  sightings := nat;
  aid_action := holding;
  placed := fun G => seq (option G);
  first_placed := fun G facing => nseq number (Some facing);
  shows := fun G pose places => count (lies_at pose) places;
  can_act := fun G pose places a =>
    match a with PickUp => has (lies_at pose) places | Drop => has (@is_carried G) places end;
  act := fun G pose places a =>
    match a with
    | PickUp => set_nth None places (find (lies_at pose) places) None
    | Drop => set_nth None places (find (@is_carried G) places) (Some pose)
    end;
  can_leave := fun _ _ _ => true;
  leave := fun _ places _ => places
|}.

Inductive holding_one := PickUpMarker of nat | DropMarker of nat.

(** So many undirected markers that look different. The robot sees which of them lie where it is. *)
Definition markers_distinct (number : nat) : aid := {|
  sightings := seq bool;
  aid_action := holding_one;
  placed := fun G => seq (option G);
  first_placed := fun G facing => nseq number (Some facing);
  shows := fun G pose places => map (lies_at pose) places;
  can_act := fun G pose places a =>
    match a with
    | PickUpMarker i => nth false (map (lies_at pose) places) i
    | DropMarker i => nth false (map (@is_carried G) places) i
    end;
  act := fun G pose places a =>
    match a with
    | PickUpMarker i => set_nth None places i None
    | DropMarker i => set_nth None places i (Some pose)
    end;
  can_leave := fun _ _ _ => true;
  leave := fun _ places _ => places
|}.

(** One directional marker. It points along the robot's entry dart when it is dropped. The robot sees the door along
    which it points, if it lies where the robot is. *)
Definition movable_directional : aid := {|
  sightings := option door;
  aid_action := holding;
  placed := fun G => option G;
  first_placed := fun G facing => Some facing;
  shows := fun G pose place =>
    if place is Some along then
      if same_vertex pose along then Some (findex clockwise pose along) else None
    else None;
  can_act := fun G pose place a => match a with PickUp => lies_at pose place | Drop => is_carried place end;
  act := fun G pose place a => match a with PickUp => None | Drop => Some pose end;
  can_leave := fun _ _ _ => true;
  leave := fun _ place _ => place
|}.

(** A directional marker that stays, and an undirected one that is picked up, carried and dropped. The robot sees the
    door along which the one points, and whether the other lies here. *)
Definition directional_and_movable : aid := {|
  sightings := option door * bool;
  aid_action := holding;
  placed := fun G => (G * option G)%type;
  first_placed := fun G facing => (facing, Some facing);
  shows := fun G pose places =>
    (if same_vertex pose places.1 then Some (findex clockwise pose places.1) else None, lies_at pose places.2);
  can_act := fun G pose places a =>
    match a with PickUp => lies_at pose places.2 | Drop => is_carried places.2 end;
  act := fun G pose places a => (places.1, match a with PickUp => None | Drop => Some pose end);
  can_leave := fun _ _ _ => true;
  leave := fun _ places _ => places
|}.

(** * Other robots *)

(** What is known of another robot: it is here; it is with an earlier one of the others; or it is
    elsewhere, at a vertex with so many doors. Where robots are together, a robot with a heading shows along which door
    it stands. *)
Inductive companion := Here of option door | With of nat & option door | Elsewhere of nat.

Definition stands_along (heading : bool) (G : embedded_graph) (pose other : G) : option door :=
  if heading then Some (findex clockwise pose other) else None.

(** What is known of the other robot of this number. *)
Definition companion_seen (heading : bool) (G : embedded_graph) (pose : G) (robots : seq G) (number : nat) :
    companion :=
  let other := nth pose robots number in
  if same_vertex pose other then Here (stands_along heading pose other) else
  let earlier := find (same_vertex other) (take number robots) in
  if earlier < number then With earlier (stands_along heading (nth pose robots earlier) other)
  else Elsewhere (degree other).

(** Another robot goes through a door, counted from its own entry dart. *)
Inductive sending := Send of nat & door.

(** So many other robots, which the robot sends through doors; all begin with the same entry dart. *)
Definition team (heading : bool) (others : nat) : aid := {|
  sightings := seq companion;
  aid_action := sending;
  placed := fun G => seq G;
  first_placed := fun G facing => nseq others facing;
  shows := fun G pose robots => mkseq (companion_seen heading pose robots) (size robots);
  can_act := fun G pose robots a =>
    let: Send number i := a in (number < size robots) && (i < degree (nth pose robots number));
  act := fun G pose robots a =>
    let: Send number i := a in set_nth pose robots number (traverse (nth pose robots number) i);
  can_leave := fun _ _ _ => true;
  leave := fun _ robots _ => robots
|}.

(** * A string *)

(** Where a string is: its fixed end, at the vertex of a dart; the darts by which it leaves each vertex on its way,
    the last one first; and its free end, at the vertex of a dart, or none while the robot holds it. *)
Record string_place (G : Type) := StringPlace { fixed_end : G; string_way : seq G; free_end : option G }.

(** What a robot sees of it: the doors through which it runs here, which end is here, and the door through which it
    runs from the robot's hand. *)
Record string_view := StringView {
  runs_through : seq door;
  fixed_here : bool;
  free_here : bool;
  from_hand : option door
}.

(** The last dart behind which string runs from the robot's hand. *)
Definition string_behind (G : embedded_graph) (x : string_place G) : option G :=
  omap opposite (ohead (string_way x)).

Definition runs_over (G : embedded_graph) (x : string_place G) (d : G) : bool :=
  has (fun e => (d == e) || (d == opposite e)) (string_way x).

(** A string of this length, in edges. While the robot holds the free end, a move takes an edge's length of it; by the
    dart from which it runs into the hand, that length is wound in. *)
Definition string (length : nat) : aid := {|
  sightings := string_view;
  aid_action := holding;
  placed := fun G => string_place G;
  first_placed := fun G facing => StringPlace facing [::] None;
  shows := fun G pose x => {|
    runs_through := [seq i <- iota 0 (degree pose) | runs_over x (turn pose i)];
    fixed_here := same_vertex pose (fixed_end x);
    free_here := lies_at pose (free_end x);
    from_hand := if is_carried (free_end x) then omap (findex clockwise pose) (string_behind x) else None
  |};
  can_act := fun G pose x a => match a with PickUp => lies_at pose (free_end x) | Drop => is_carried (free_end x) end;
  act := fun G pose x a =>
    StringPlace (fixed_end x) (string_way x) (match a with PickUp => None | Drop => Some pose end);
  can_leave := fun G x by_dart =>
    [|| ~~ is_carried (free_end x), string_behind x == Some by_dart | size (string_way x) < length];
  leave := fun G x by_dart =>
    if ~~ is_carried (free_end x) then x
    else if string_behind x == Some by_dart then StringPlace (fixed_end x) (behead (string_way x)) None
    else StringPlace (fixed_end x) (by_dart :: string_way x) None
|}.

(** * What an aid shows *)

(** Poses of two starts correspond, so that vertices correspond: the facing darts do, corresponding poses have the
    same degree, each door leads them to corresponding poses, and those at one vertex correspond to those at one
    vertex. *)
Definition same_vertices (V W : start) (R : V -> W -> Prop) : Prop :=
  [/\ R (facing V) (facing W),
      forall p q, R p q -> degree p = degree q,
      forall p q i, R p q -> R (traverse p i) (traverse q i)
    & forall p q p' q', R p q -> R p' q' -> same_vertex p p' = same_vertex q q'].

(** An aid shows only at which vertices its parts are: whenever poses of two starts correspond so, its states do.
    The first ones correspond, they are seen alike from corresponding poses, and actions and moves keep that. *)
Definition shows_only_vertices (X : aid) : Prop :=
  forall (V W : start) (R : V -> W -> Prop), same_vertices R ->
  exists S : placed X V -> placed X W -> Prop,
    S (first_placed X (facing V)) (first_placed X (facing W)) /\
    forall p q x y, R p q -> S x y ->
      [/\ shows p x = shows q y,
          forall a, can_act p x a = can_act q y a /\ (can_act p x a -> S (act p x a) (act q y a))
        & forall i, can_leave x (turn p i) = can_leave y (turn q i) /\ S (leave x (turn p i)) (leave y (turn q i))].

(** An aid has a front if it shows, as it is at the start, and as long as the robot takes doors only, what a
    directional marker shows. *)
Definition has_front (X : aid) : Prop :=
  exists read : nat * sightings X -> percept, forall W : start,
    let first := first_placed X (facing W) in
    forall p : W,
      [/\ read (degree p, shows p first) = perceive directional p, can_leave first p & leave first p = first].
