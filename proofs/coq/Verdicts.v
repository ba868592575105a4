(** Definitions only: what a proof of a verdict contains, and what its claims say. The format is that of
    [docs/proofs-of-verdicts.md]; the checker is in [Checker.v]. Numbers are binary, for the program that is
    extracted from it. *)

From Coq Require List.
From Coq Require Import BinNat.
From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Markers Walks Aids.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** * What is written *)

(** A world: the darts of each vertex clockwise, the two darts of each edge, and the facing dart. *)
Record world_text := WorldText {
  vertex_lines : seq (seq N);
  edge_lines : seq (N * N);
  facing_line : N
}.

Inductive marker_word :=
  | WordNone | WordUndirected | WordDirectional | WordUndirectedEdge | WordDirectedEdge | WordTwoIdentical
  | WordTwoDistinct.

Inductive sighting_word :=
  | WordNothing | WordLying | WordPointing of N | WordTwo | WordFirst | WordSecond | WordBoth
  | WordPassed | WordAlong | WordAgainst.

(** A walk: what was perceived at each visit, and the door that was taken from each visit to the next. *)
Record walk_text := WalkText {
  see_lines : seq (N * sighting_word);
  door_lines : seq N
}.

(** Where percepts are not certain, a visit has alternatives: that there is no vertex; or a percept, and the door that
    was taken, if it is known. If there is no vertex, a robot has gone through, or it has turned back. *)
Inductive alternative := NoVertex | Junction of N * sighting_word & option N.

Record visit_text := VisitText { turned_back : bool; alternatives : seq alternative }.

(** A run of a robot with a marker that it picks up, carries and drops: what it perceived at first, and what it did,
    each time with what it then perceived, if that is known. *)
Inductive aid_word := WordMovable | WordMovableDirectional.

Inductive deed := DeedDoor of N | DeedPickUp | DeedDrop.

Record run_text := RunText {
  aid_line : aid_word;
  first_see : N * sighting_word;
  deed_lines : seq (deed * option (N * sighting_word))
}.

(** What all claims of a proof are about. *)
Record setting := Setting {
  worlds : seq world_text;
  marker_line : marker_word;
  walk_line : option walk_text;
  visits_line : option (seq visit_text);
  run_line : option run_text
}.

(** The edge of a move, from its visit to the next or back. *)
Inductive passage := Along of N | Against of N.

(** Two darts of the walk are one: the facing dart, seen at two visits; or those to which two passages lead. *)
Inductive step := Mark of N & N | Beyond of passage & passage.

Inductive contradiction :=
  | ByStep of step | BySightings of N & N | ByEdge of N | ByPercept of N | ByDoor of N | ByNoMarker.

(** A proof that no robot has made some visits goes through all choices, depth first. A line chooses an alternative of
    the next visit, by its number, with a door if that is not known; or two darts of the walk of what is chosen are one;
    or this walk is impossible, or its last percept is not that of the vertex to which the robot has turned back, and
    the next alternative follows. *)
Inductive choice_line :=
  | Choose of N & option N | Unite of step | Close of contradiction | CloseBack.

(** The claims, each with what its proof needs. Darts are given by their numbers. Without a list of darts, a walk
    diverges from any, and visits misfit any. What is chosen for a visit is an alternative, and a door. *)
Inductive claim :=
  | Determined of N & seq step
  | Unexplained of seq step & contradiction
  | Conforms of N
  | Diverges of option (seq N)
  | Indistinguishable of seq (N * N)
  | Distinguishable of seq (N * N * seq N)
  | Isomorphic of seq (N * N)
  | NotIsomorphic of seq (N * N * seq N)
  | Fits of N & seq (N * option N)
  | Misfits of option (seq N)
  | Impossible of seq choice_line.

(** * What it says *)

Definition marker_of (word : marker_word) : marker :=
  match word with
  | WordNone => no_marker
  | WordUndirected => undirected
  | WordDirectional => directional
  | WordUndirectedEdge => undirected_edge
  | WordDirectedEdge => directed_edge
  | WordTwoIdentical => two_identical
  | WordTwoDistinct => two_distinct
  end.

Definition sighting_of (word : sighting_word) : sighting :=
  match word with
  | WordNothing => Nothing
  | WordLying => Lying
  | WordPointing i => Pointing (N.to_nat i)
  | WordTwo => Two
  | WordFirst => First
  | WordSecond => Second
  | WordBoth => Both
  | WordPassed => Passed
  | WordAlong => PassedAlong
  | WordAgainst => PassedAgainst
  end.

Definition doors_of (doors : seq N) : seq door := map N.to_nat doors.

Definition percept_of (seen : N * sighting_word) : percept := (N.to_nat seen.1, sighting_of seen.2).

Definition seen_of (w : walk_text) : seq percept := map percept_of (see_lines w).

(** From this pose the walk has these percepts, and the doors that it takes exist. *)
Definition gives (M : marker) (W : start) (pose : W) (w : walk_text) : Prop :=
  percepts M pose (doors_of (door_lines w)) = seen_of w /\ passable pose (doors_of (door_lines w)).

(** A robot with a pose visits by an alternative, and comes to the next vertex with another pose. At the last visit it
    stays where it is if its door is not known. *)
Definition visits_by (M : marker) (W : start) (back last : bool) (a : alternative) (pose next : W) : Prop :=
  match a with
  | NoVertex => next = if back then opposite pose else pose
  | Junction seen (Some i) =>
      [/\ perceive M pose = percept_of seen, N.to_nat i < degree pose & next = traverse pose (N.to_nat i)]
  | Junction seen None =>
      perceive M pose = percept_of seen /\
      if last then next = pose else exists2 i, i < degree pose & next = traverse pose i
  end.

(** With one alternative of each visit, from this pose. *)
Fixpoint makes (M : marker) (W : start) (pose : W) (visits : seq visit_text) : Prop :=
  if visits is v :: others then
    exists a next,
      [/\ List.In a (alternatives v), visits_by M (turned_back v) (nilp others) a pose next & makes M next others]
  else True.

Definition aid_of (word : aid_word) : aid :=
  match word with WordMovable => markers_alike 1 | WordMovableDirectional => movable_directional end.

(** What is seen of it: the one marker that lies here, or the door along which it points. *)
Definition seen_of_aid (word : aid_word) : sightings (aid_of word) -> sighting :=
  match word with
  | WordMovable => fun lying => if lying == 0 then Nothing else Lying
  | WordMovableDirectional => fun along => if along is Some i then Pointing i else Nothing
  end.

Definition action_of (word : aid_word) (d : deed) : action_with (aid_action (aid_of word)) :=
  match word, d with
  | _, DeedDoor i => Take (N.to_nat i)
  | WordMovable, DeedPickUp => Use (PickUp : aid_action (aid_of WordMovable))
  | WordMovable, DeedDrop => Use (Drop : aid_action (aid_of WordMovable))
  | WordMovableDirectional, DeedPickUp => Use (PickUp : aid_action (aid_of WordMovableDirectional))
  | WordMovableDirectional, DeedDrop => Use (Drop : aid_action (aid_of WordMovableDirectional))
  end.

(** In this state of the robot and its aid it perceives this. *)
Definition senses (word : aid_word) (W : start) (s : state (with_aid (aid_of word) W))
    (seen : N * sighting_word) : Prop :=
  let: (degree, shown) := sense s in (degree, seen_of_aid shown) = percept_of seen.

(** From this state the robot can do what it did, and then perceives what is known. *)
Fixpoint does (word : aid_word) (W : start) (s : state (with_aid (aid_of word) W))
    (deeds : seq (deed * option (N * sighting_word))) : Prop :=
  if deeds is (d, seen) :: others then
    let next := next_state s (action_of word d) in
    [/\ possible s (action_of word d), (if seen is Some seen then senses next seen else True) & does next others]
  else True.

(** From this pose, with the marker by the facing dart. *)
Definition runs (r : run_text) (W : start) (pose : W) : Prop :=
  let s : state (with_aid (aid_of (aid_line r)) W) := (pose, first_placed (aid_of (aid_line r)) (facing W)) in
  senses s (first_see r) /\ does s (deed_lines r).

(** Each dart of a vertex with the next one clockwise: the last with the first. *)
Definition clockwise_pairs (line : seq N) : seq (N * N) := zip line (rot 1 line).

(** A text describes a start whose darts are numbered. *)
Definition describes (t : world_text) (W : start) (number : W -> N) : Prop :=
  [/\ injective number,
      forall n, n \in flatten (vertex_lines t) <-> exists d, number d = n,
      forall d, (number d, number (clockwise d)) \in flatten (map clockwise_pairs (vertex_lines t)),
      forall d, (number d, number (opposite d)) \in edge_lines t \/ (number (opposite d), number d) \in edge_lines t
    & number (facing W) = facing_line t].

(** There is a start that the text describes, and in each of them this is true. *)
Definition in_world (t : world_text) (claimed : forall W : start, (W -> N) -> Prop) : Prop :=
  (exists W number, @describes t W number) /\ forall W number, @describes t W number -> claimed W number.

Arguments in_world : clear implicits.

(** The dart with this number has a property. *)
Definition at_dart (W : start) (number : W -> N) (n : N) (claimed : W -> Prop) : Prop :=
  exists2 d, number d = n & claimed d.

Definition claim_true (s : setting) (c : claim) : Prop :=
  let M := marker_of (marker_line s) in
  match c, worlds s, walk_line s with
  | Determined from _, [:: t], Some w =>
      in_world t (fun W number => at_dart number from (fun pose : W =>
        gives directional pose w /\
        forall (V : start) (p : V), percepts directional p (doors_of (door_lines w)) = seen_of w ->
          exists f : V -> W, [/\ isomorphism f, f (facing V) = facing W & f p = pose]))
  | Unexplained _ _, [::], Some w => forall (V : start) (p : V), ~ gives M p w
  | Conforms from, [:: t], Some w =>
      in_world t (fun W number => at_dart number from (fun pose : W => gives M pose w))
  | Conforms from, [:: t], None =>
      if run_line s is Some r then in_world t (fun W number => at_dart number from (fun pose : W => runs r pose))
      else False
  | Diverges from, [:: t], None =>
      if run_line s is Some r then
        in_world t (fun W number => forall pose : W,
          (if from is Some poses then number pose \in poses else true) -> ~ runs r pose)
      else False
  | Diverges from, [:: t], Some w =>
      in_world t (fun W number => forall pose : W,
        (if from is Some poses then number pose \in poses else true) -> ~ gives M pose w)
  | Indistinguishable pairs, [:: t; u], _ =>
      in_world t (fun V number => in_world u (fun W number' =>
        forall pair, pair \in pairs ->
          at_dart number pair.1 (fun p : V => at_dart number' pair.2 (fun q : W => alike M p q))))
  | Distinguishable walks, [:: t; u], _ =>
      in_world t (fun V number => in_world u (fun W number' =>
        forall pair doors, (pair, doors) \in walks ->
          at_dart number pair.1 (fun p : V => at_dart number' pair.2 (fun q : W =>
            [/\ passable p (doors_of doors), passable q (doors_of doors)
              & percepts M p (doors_of doors) <> percepts M q (doors_of doors)]))))
  | Isomorphic _, [:: t; u], _ =>
      in_world t (fun V _ => in_world u (fun W _ => isomorphic V W))
  | NotIsomorphic _, [:: t; u], _ =>
      in_world t (fun V _ => in_world u (fun W _ => ~ isomorphic V W))
  | Fits from _, [:: t], _ =>
      if visits_line s is Some visits then
        in_world t (fun W number => at_dart number from (fun pose : W => makes M pose visits))
      else False
  | Misfits from, [:: t], _ =>
      if visits_line s is Some visits then
        in_world t (fun W number => forall pose : W,
          (if from is Some poses then number pose \in poses else true) -> ~ makes M pose visits)
      else False
  | Impossible _, [::], _ =>
      if visits_line s is Some visits then forall (V : start) (p : V), ~ makes M p visits else False
  | _, _, _ => False
  end.
