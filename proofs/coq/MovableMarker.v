(** One marker that can be picked up and dropped, and the mapping algorithm for simple worlds that uses
    it. Section 2.3, after Dudek, Jenkin, Milios and Wilkes, "Robotic exploration as graph construction"
    (1991), the paper's reference 8. As in [Algorithm1.v], the open choices stay open: the edge to
    explore, the order in which places and darts are tried, and the paths between them. Definitions only.
    *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program Algorithm1.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** * Programs of a robot that handles a marker *)

(** Besides leaving by a door, the robot may pick up the marker, carry it and drop it. *)
Inductive handling_action := LeaveBy of door | PickUp | Drop.

Notation handling_program := (program_of handling_action).

Definition move (i : door) : handling_program percept := do_action (LeaveBy i).
Definition pick_up : handling_program percept := do_action PickUp.
Definition drop : handling_program percept := do_action Drop.

(** Moves by one door after the other, for any percepts. *)
Definition moves (doors : seq door) : handling_program unit := do_all [seq LeaveBy i | i <- doors].

(** * Worlds with such a marker *)

Section Handling.

Variable W : start.

(** The place of the marker: the vertex of a dart, or none if the robot carries it. *)
Definition marker_place := option W.

(** A robot sees the marker at the vertex where it lies, and does not see it in its hand. *)
Definition perceive_lying (lying : marker_place) (pose : W) : percept :=
  (degree pose,
   if lying is Some spot then if same_vertex pose spot then Lying else Nothing else Nothing).

(** The robot can leave by a door that exists, pick up a marker that lies where it is, and drop one that it
    carries. *)
Definition can_handle (s : W * marker_place) (e : handling_action) : bool :=
  let: (pose, lying) := s in
  match e, lying with
  | LeaveBy i, _ => i < degree pose
  | PickUp, Some spot => same_vertex pose spot
  | Drop, None => true
  | _, _ => false
  end.

(** An action that is not possible with the marker changes nothing. *)
Definition handle (s : W * marker_place) (e : handling_action) : W * marker_place :=
  let: (pose, lying) := s in
  match e, lying with
  | LeaveBy i, _ => (traverse pose i, lying)
  | PickUp, Some spot => (pose, if same_vertex pose spot then None else lying)
  | Drop, None => (pose, Some pose)
  | _, _ => s
  end.

(** A robot that handles the marker, which lies at the start vertex at first. The state is the robot's pose and the
    place of the marker. After each action it perceives its place, also if it has not moved. *)
Definition handling : environment handling_action := {|
  state := W * marker_place;
  first_state := (facing W, Some (facing W));
  possible := can_handle;
  next_state := handle;
  sense := fun s => perceive_lying s.2 s.1
|}.

End Handling.

(** * The algorithm *)

(** Whether the map has an edge between these vertices. *)
Definition joined (S : partial_map) v w := has (fun d => leads S v [:: d] w) (iota 0 (size S)).

(** Given two paths from the same vertex, as darts: whether a depth-first walk that takes the darts of
    each vertex in order reaches the end of the first path before the end of the second. *)
Fixpoint met_before (darts darts' : seq nat) : bool :=
  match darts, darts' with
  | [::], _ => true
  | _, [::] => false
  | d :: others, d' :: others' => (d < d') || (d == d') && met_before others others'
  end.

(** The candidates for the unknown end of [e], if this number of doors is perceived there: the known
    vertices with as many doors and an unexplored dart, except the known end of [e], because there are no
    loops, and its neighbours, because there are no parallel edges. Their order is that of a depth-first
    walk along the shortest paths from the known end. *)
Definition candidates (S : partial_map) e degree :=
  let way := from_root S (tree_from S (vertex S e)) in
  sort (fun v w => met_before (way v) (way w))
    [seq v <- undup [seq vertex S d | d <- unexplored S]
       | [&& doors S v == degree, v != vertex S e & ~~ joined S (vertex S e) v]].

(** The darts of vertex [v] that may be the back-link, the other end of the edge that led there. *)
Definition back_links (S : partial_map) v := [seq h <- unexplored S | vertex S h == v].

(** The result of a search: the marker was seen, and the robot has this pose; or it was not seen, the
    robot has this pose, and these candidates are left. *)
Inductive search := Found of nat | Missed of nat & seq nat.

(** The unknown end of an edge: a new vertex, where the robot stands with the marker in hand; or a known
    one, where the robot stands with this pose, and the marker lies. *)
Inductive arrival := NewPlace | KnownPlace of nat.

Section MovableMarker.

(** The paths through the map that may be chosen, among those that lead to their goals. *)
Variable allowed : partial_map -> seq nat -> bool.

(** A path through the map, for a robot at [pose], to vertex [v]. *)
Definition choose_path (S : partial_map) pose v : handling_program (seq nat) :=
  choose (fun path => leads S (vertex S pose) path v && allowed S path)
    (from_root S (tree_from S (vertex S pose)) v).

(** Goes to vertex [v]; returns the robot's pose there. *)
Definition travel (S : partial_map) pose v : handling_program nat :=
  let* path := choose_path S pose v in
  moves (doors_along S pose path) ;;
  Return (pose_behind S pose path).

(** Follows these darts until it sees the marker. The vertices where it does not see it, including the
    first, are no longer candidates. *)
Fixpoint look_along (S : partial_map) pose darts C : handling_program search :=
  let C' := [seq v <- C | v != vertex S pose] in
  if darts is d :: darts' then
    let pose' := odflt pose (other S d) in
    let* seen := move (door_to S pose d) in
    if seen.2 is Lying then Return (Found pose') else look_along S pose' darts' C'
  else Return (Missed pose C').

(** Visits the candidates [C] one after the other, until it sees the marker. Every visit removes a
    candidate, so that no more visits are needed than there are candidates. *)
Fixpoint look_for_marker fuel (S : partial_map) pose C : handling_program search :=
  if C is [::] then Return (Missed pose C) else
  if fuel is fuel'.+1 then
    let* v := choose (fun v => v \in C) (head 0 C) in
    let* path := choose_path S pose v in
    let* sought := look_along S pose path C in
    if sought is Missed pose' C' then look_for_marker fuel' S pose' C' else Return sought
  else Return (Missed pose C).

(** Place validation: is the unknown end of [e] a new vertex? The robot is there, with the marker in hand,
    and perceives this number of doors. *)
Definition validate_place (S : partial_map) e degree : handling_program arrival :=
  let C := candidates S e degree in
  (* No known vertex can be it: it is new. *)
  if C is [::] then Return NewPlace else
  (* Drop the marker there, go back, and look for it at every candidate. *)
  drop ;;
  move 0 ;;
  let* sought := look_for_marker (size C) S e C in
  match sought with
  (* Found: it is this vertex. *)
  | Found pose => Return (KnownPlace pose)
  (* Not found: it is new. Go there again, for the marker. *)
  | Missed pose _ =>
      let* near := travel S pose (vertex S e) in
      move (door_to S near e) ;;
      pick_up ;;
      Return NewPlace
  end.

(** Tries these darts of the robot's vertex one after the other, until it sees the marker behind one.
    Otherwise it returns by door 0, the way back, and so comes in by the dart that it tried. *)
Fixpoint try_back_links fuel (S : partial_map) pose links : handling_program (option nat) :=
  if links is [::] then Return None else
  if fuel is fuel'.+1 then
    let* h := choose (fun h => h \in links) (head 0 links) in
    let* seen := move (door_to S pose h) in
    if seen.2 is Lying then Return (Some h) else
    (move 0 ;; try_back_links fuel' S h (rem h links))
  else Return None.

(** Carries the marker from the robot's vertex to the known end of [e], drops it there, and returns
    without it. The dart behind which the marker lies is the other end of [e]. There the robot, which came
    in by [e], picks up the marker. Returns that dart and the robot's pose, or nothing if there is no such
    dart, which is impossible in a simple world. *)
Definition find_back_link (S : partial_map) pose e links : handling_program (option (nat * nat)) :=
  let* near := travel S pose (vertex S e) in
  drop ;;
  let* far := travel S near (vertex S pose) in
  let* found := try_back_links (size links) S far links in
  if found is Some h then (pick_up ;; Return (Some (h, e))) else Return None.

(** Back-link validation: which dart of the robot's vertex is the other end of [e]? The marker lies at
    this vertex; afterwards the robot carries it. *)
Definition validate_back_link (S : partial_map) pose e : handling_program (option (nat * nat)) :=
  let links := back_links S (vertex S pose) in
  pick_up ;;
  (* If only one dart can be it, it is. *)
  if links is [:: only] then Return (Some (only, pose)) else find_back_link S pose e links.

(** One round: an edge is explored. The robot is at [pose] in the map [S], and carries the marker. *)
Definition explore_edge (S : partial_map) pose : handling_program (option (partial_map * nat)) :=
  (* Remove an unexplored edge from U. *)
  let* e := choose_among (unexplored S) (nearest S (tree_from S (vertex S pose)) (unexplored S)) in
  (* Carry the marker through S to its known end, and over it to its unknown end. *)
  let* near := travel S pose (vertex S e) in
  let* seen := move (door_to S near e) in
  let* came := validate_place S e seen.1 in
  match came with
  | NewPlace => Return (Some (with_edge (with_vertex S seen.1) e (size S), size S))
  | KnownPlace pose' =>
      let* link := validate_back_link S pose' e in
      Return (if link is Some (h, pose'') then Some (with_edge S e h, pose'') else None)
  end.

(** While U is not empty; at most this number of rounds. *)
Fixpoint explore_edges bound (S : partial_map) pose : handling_program (option (partial_map * nat)) :=
  if unexplored S is [::] then Return (Some (S, pose)) else
  if bound is bound'.+1 then
    let* after := explore_edge S pose in
    if after is Some (S', pose') then explore_edges bound' S' pose' else Return None
  else Return None.

(** The marker lies at v0, where the robot perceives [seen] and picks it up: S is v0, U its edges. The
    answer is the map S with the robot's pose in it, or [None] if the rounds do not suffice, or if the
    world turns out not to be simple. *)
Definition movable bound (seen : percept) : handling_program (option (partial_map * nat)) :=
  pick_up ;; explore_edges bound (with_vertex [::] seen.1) 0.

End MovableMarker.
