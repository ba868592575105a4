(** What the theorems speak of: worlds, what a robot perceives in them, markers, robots, and when two
    worlds are the same or cannot be told apart. Sections 2.1 and 2.2 of the paper.

    The words are those of toposlam; definitions only. Algorithm 1 is in [Algorithm1.v], what is proved
    of both in [Theorems.v]. *)

From mathcomp Require Import all_ssreflect.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** * Worlds *)

(** An embedded graph: a finite set of darts (ends of edges) with two permutations. [opposite] leads to
    the other end of the same edge, [clockwise] to the next dart around the same vertex. Loops and
    parallel edges are allowed; everything can be reached from everywhere. *)
Record embedded_graph := EmbeddedGraph {
  dart :> finType;
  opposite : dart -> dart;
  clockwise : dart -> dart;
  opposite_involutive : involutive opposite;
  opposite_moves : forall d, opposite d != d;
  clockwise_injective : injective clockwise;
  connected : forall d e,
    connect (fun x y => (y == opposite x) || (y == clockwise x)) d e
}.

Arguments opposite {_}.
Arguments clockwise {_}.

(** A start: a world, and the dart by which the robot counts as having come in, its facing dart. So the
    world of a start has at least one edge. *)
Record start := Start { graph :> embedded_graph; facing : graph }.

Arguments facing : clear implicits.

(** Any number is a door: see [turn]. *)
Definition door := nat.

Section EmbeddedGraph.

Variable G : embedded_graph.

(** The number of edges, [m], and of vertices, [n]. *)
Definition edges := #|G| ./2.
Definition vertices := fcard (@clockwise G) G.

Definition same_vertex (d e : G) := fconnect clockwise d e.

(** The number of doors of a dart's vertex. *)
Definition degree (d : G) := order clockwise d.

(** A pose is the dart by which the robot has come in. Door [i] is the [i]-th dart clockwise from it; they
    are counted round and round, so that door [degree] is door 0 again, the way back. *)
Definition turn (pose : G) (i : door) : G := iter i clockwise pose.

(** The robot leaves by a door, and comes in by the other end of that edge. *)
Definition traverse (pose : G) (i : door) : G := opposite (turn pose i).

(** Where a door sequence leads. *)
Definition walk (pose : G) (doors : seq door) : G := foldl traverse pose doors.

End EmbeddedGraph.

(** The doors that a walk takes, each with the degree of the vertex at which it is taken. *)
Fixpoint taken (G : embedded_graph) (pose : G) (doors : seq door) : seq (door * nat) :=
  if doors is i :: others then (i, degree pose) :: taken (traverse pose i) others else [::].

(** The door that undoes door [i], at a vertex with so many doors. *)
Definition inverse_door (doors : nat) (i : door) : door := (doors - i %% doors) %% doors.

(** The way back along a path, from the doors that it took and the degrees of the vertices at which it
    took them: turn round, then undo every turn but the first, the last one first. *)
Definition way_back (taken : seq (door * nat)) : seq door :=
  if taken is _ :: others then 0 :: rev [seq inverse_door step.2 step.1 | step <- others] else [::].

(** No loops, no parallel edges. *)
Definition simple (G : embedded_graph) :=
  (forall d : G, ~~ same_vertex d (opposite d)) /\
  (forall d e : G, same_vertex d e -> same_vertex (opposite d) (opposite e) -> d = e).

(** * Percepts and markers *)

(** What a marker adds to a percept: nothing; an undirected marker lies here; a directional one does, and
    points along this door. *)
Inductive sighting := Nothing | Lying | Pointing of door.

(** Sightings can be compared. *)
Definition sighting_code (s : sighting) : option (option nat) :=
  match s with Nothing => None | Lying => Some None | Pointing i => Some (Some i) end.
Definition sighting_of_code (c : option (option nat)) : sighting :=
  match c with None => Nothing | Some None => Lying | Some (Some i) => Pointing i end.
Lemma sighting_codeK : cancel sighting_code sighting_of_code.
Proof. by case. Qed.
Canonical sighting_eqType := EqType sighting (CanEqMixin sighting_codeK).

(** What the robot senses where it comes in: the number of doors, and what the marker adds. *)
Definition percept := (nat * sighting)%type.

(** A kind of marker: what it adds to the percept of a robot with this pose, in the world in which it was
    placed at the start. *)
Definition marker := forall W : start, W -> sighting.

Definition no_marker : marker := fun _ _ => Nothing.

(** One undirected immovable marker, at the start vertex from the beginning. *)
Definition undirected : marker :=
  fun W pose => if same_vertex pose (facing W) then Lying else Nothing.

(** One directional immovable marker, at the start vertex from the beginning, along the facing dart. *)
Definition directional : marker :=
  fun W pose =>
    if same_vertex pose (facing W) then Pointing (findex clockwise pose (facing W)) else Nothing.

Definition perceive (M : marker) (W : start) (pose : W) : percept := (degree pose, M W pose).

(** What is perceived along a door sequence, where it begins and behind each door. *)
Fixpoint percepts (M : marker) (W : start) (pose : W) (doors : seq door) : seq percept :=
  perceive M pose
    :: (if doors is i :: others then percepts M (traverse pose i) others else [::]).

(** * Robots *)

(** All that a deterministic robot can do: from what it has perceived so far it decides by which door to
    leave, or what to answer. *)
Inductive decision (A : Type) := Leave of door | Answer of A.

Arguments Leave {A}.

Definition strategy (A : Type) := seq percept -> decision A.

Section Runs.

Variables (A : Type) (robot : strategy A) (M : marker) (W : start).

(** What the robot has perceived after so many decisions, and where it is then. *)
Fixpoint situation (decisions : nat) : seq percept * W :=
  if decisions is earlier.+1 then
    let: (past, pose) := situation earlier in
    if robot past is Leave i then
      (rcons past (perceive M (traverse pose i)), traverse pose i)
    else (past, pose)
  else ([:: perceive M (facing W)], facing W).

Definition history decisions := (situation decisions).1.

Definition answers (a : A) := exists decisions, robot (history decisions) = Answer a.

End Runs.

(** * The same, and indistinguishable *)

(** A bijection of darts that keeps both permutations. *)
Definition isomorphism (G H : embedded_graph) (f : G -> H) :=
  [/\ bijective f,
      forall d, f (opposite d) = opposite (f d)
    & forall d, f (clockwise d) = clockwise (f d)].

Definition isomorphic (G H : embedded_graph) := exists f : G -> H, isomorphism f.

(** Between starts it also takes facing to facing. *)
Definition isomorphic_starts (V W : start) :=
  exists f : V -> W, isomorphism f /\ f (facing V) = facing W.

(** From these poses every door sequence gives the same percepts. *)
Definition alike (M : marker) (V W : start) (p : V) (q : W) :=
  forall doors, percepts M p doors = percepts M q doors.

(** Two starts that no robot can tell apart. *)
Definition indistinguishable (M : marker) (V W : start) := alike M (facing V) (facing W).

(** The certificate of that: a relation of poses that holds at the starts, within which the percepts are
    the same, and out of which no door leads. *)
Definition bisimilar (M : marker) (V W : start) :=
  exists R : V -> W -> Prop,
    R (facing V) (facing W) /\
    forall p q, R p q ->
      perceive M p = perceive M q /\ forall i, R (traverse p i) (traverse q i).

(** The robot answers with a map isomorphic to the world in which it is. *)
Definition maps (M : marker) (robot : strategy embedded_graph) (W : start) :=
  exists2 map : embedded_graph, answers robot M W map & isomorphic map W.

(** More than that: its map also tells where in it the robot began. *)
Definition maps_start (M : marker) (robot : strategy start) (W : start) :=
  exists2 map : start, answers robot M W map & isomorphic_starts map W.
