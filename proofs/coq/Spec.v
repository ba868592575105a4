(** Definitions only: worlds, percepts, markers, robots, and when two worlds are isomorphic or
    indistinguishable. Sections 2.1 and 2.2 of the paper. The terms are those of toposlam. Algorithm 1 is
    in [Algorithm1.v], the theorems are in [Theorems.v]. *)

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
  oppositeK : involutive opposite;
  opposite_neq : forall d, opposite d != d;
  clockwise_inj : injective clockwise;
  connected : forall d e,
    connect (fun x y => (y == opposite x) || (y == clockwise x)) d e
}.

Arguments opposite {_}.
Arguments clockwise {_}.

(** A start: a world and its facing dart, by which the robot counts as having come in. So the world of a
    start has at least one edge. *)
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

(** A pose is the dart by which the robot came in. Door [i] is the [i]-th dart clockwise from it, modulo
    the degree, so that door [degree] is door 0 again, the way back. *)
Definition turn (pose : G) (i : door) : G := iter i clockwise pose.

(** The robot leaves by a door, and comes in by the other end of that edge. *)
Definition traverse (pose : G) (i : door) : G := opposite (turn pose i).

(** The pose at the end of a door sequence. *)
Definition walk (pose : G) (doors : seq door) : G := foldl traverse pose doors.

End EmbeddedGraph.

(** The doors that a walk takes, each with the degree of the vertex at which it is taken. *)
Fixpoint taken (G : embedded_graph) (pose : G) (doors : seq door) : seq (door * nat) :=
  if doors is i :: others then (i, degree pose) :: taken (traverse pose i) others else [::].

(** The door that undoes door [i], at a vertex with [doors] doors. *)
Definition inverse_door (doors : nat) (i : door) : door := (doors - i %% doors) %% doors.

(** The way back along a path, from its doors and the degrees of the vertices at which it took them: turn
    round, then undo every turn except the first, the last one first. *)
Definition way_back (taken : seq (door * nat)) : seq door :=
  if taken is _ :: others then 0 :: rev [seq inverse_door step.2 step.1 | step <- others] else [::].

(** No loops, no parallel edges. *)
Definition simple (G : embedded_graph) :=
  (forall d : G, ~~ same_vertex d (opposite d)) /\
  (forall d e : G, same_vertex d e -> same_vertex (opposite d) (opposite e) -> d = e).

(** * Percepts and markers *)

(** What a marker adds to a percept: nothing; an undirected marker lies here; a directional marker lies
    here and points along this door; two markers that look alike lie here; of two markers that look
    different the first, the second or both lie here; the edge just traversed is marked, with an arrow along
    the traversal, or against it. *)
Inductive sighting :=
  | Nothing | Lying | Pointing of door | Two | First | Second | Both | Passed | PassedAlong | PassedAgainst.

(** Sightings can be compared. *)
Definition sighting_code (s : sighting) : nat + door :=
  match s with
  | Pointing i => inr i
  | Nothing => inl 0 | Lying => inl 1 | Two => inl 2 | First => inl 3 | Second => inl 4 | Both => inl 5
  | Passed => inl 6 | PassedAlong => inl 7 | PassedAgainst => inl 8
  end.
Definition sighting_of_code (c : nat + door) : sighting :=
  match c with
  | inr i => Pointing i
  | inl code => nth Nothing [:: Nothing; Lying; Two; First; Second; Both; Passed; PassedAlong; PassedAgainst] code
  end.
Lemma sighting_codeK : cancel sighting_code sighting_of_code.
Proof. by case. Qed.
Canonical sighting_eqType := EqType sighting (CanEqMixin sighting_codeK).

(** What the robot senses on arrival: the number of doors, and what the marker adds. *)
Definition percept := (nat * sighting)%type.

(** A kind of marker: what it adds to the percept of a robot with this pose, in the world in which it was
    placed at the start. *)
Definition marker := forall W : start, W -> sighting.

Definition no_marker : marker := fun _ _ => Nothing.

(** One undirected marker that stays at the start vertex. *)
Definition undirected : marker :=
  fun W pose => if same_vertex pose (facing W) then Lying else Nothing.

(** One directional marker that stays at the start vertex, along the facing dart. *)
Definition directional : marker :=
  fun W pose =>
    if same_vertex pose (facing W) then Pointing (findex clockwise pose (facing W)) else Nothing.

Definition perceive (M : marker) (W : start) (pose : W) : percept := (degree pose, M W pose).

(** The percepts along a door sequence: at its beginning and behind each door. *)
Fixpoint percepts (M : marker) (W : start) (pose : W) (doors : seq door) : seq percept :=
  perceive M pose
    :: (if doors is i :: others then percepts M (traverse pose i) others else [::]).

(** * Robots *)

(** What the actions [E] of a robot do: in a state some actions are possible, each leads to a state, and there the
    robot has a percept, one of [O]. *)
Record environment_of (O E : Type) := Environment {
  state : Type;
  first_state : state;
  possible : state -> E -> bool;
  next_state : state -> E -> state;
  sense : state -> O
}.

Notation environment := (environment_of percept).

(** A robot that only moves, in a world with a marker. The state is its pose, the actions are the doors by which it
    leaves, and it can leave by a door that exists. *)
Definition moving (M : marker) (W : start) : environment door := {|
  state := W;
  first_state := facing W;
  possible := fun pose i => i < degree pose;
  next_state := @traverse W;
  sense := @perceive M W
|}.

(** Any deterministic robot: from its percepts so far it decides what to do, or what to answer. *)
Inductive decision (E A : Type) := Act of E | Answer of A.

Arguments Act {E A}.
Arguments Answer {E A}.

Definition robot_of (O E A : Type) := seq O -> decision E A.

Notation strategy_of := (robot_of percept).
Notation strategy := (strategy_of door).

Section Runs.

Variables (O E A : Type) (robot : robot_of O E A) (I : environment_of O E).

(** The robot's percepts and its state after a number of decisions. *)
Fixpoint situation (decisions : nat) : seq O * state I :=
  if decisions is earlier.+1 then
    let: (past, s) := situation earlier in
    if robot past is Act e then (rcons past (sense (next_state s e)), next_state s e) else (past, s)
  else ([:: sense (first_state I)], first_state I).

Definition history decisions := (situation decisions).1.

Definition answers (a : A) := exists decisions, robot (history decisions) = Answer a.

End Runs.

(** * Isomorphic and indistinguishable *)

(** A bijection of darts that keeps both permutations. *)
Definition isomorphism (G H : embedded_graph) (f : G -> H) :=
  [/\ bijective f,
      forall d, f (opposite d) = opposite (f d)
    & forall d, f (clockwise d) = clockwise (f d)].

Definition isomorphic (G H : embedded_graph) := exists f : G -> H, isomorphism f.

(** Between starts it also maps facing to facing. *)
Definition isomorphic_starts (V W : start) :=
  exists f : V -> W, isomorphism f /\ f (facing V) = facing W.

(** From these poses every door sequence gives the same percepts. *)
Definition alike (M : marker) (V W : start) (p : V) (q : W) :=
  forall doors, percepts M p doors = percepts M q doors.

(** Two starts that no robot can distinguish. *)
Definition indistinguishable (M : marker) (V W : start) := alike M (facing V) (facing W).

(** The certificate for that: a relation of states that contains the first ones, whose related states have equal
    percepts, and that every action preserves. *)
Definition bisimilar O E (I : start -> environment_of O E) (V W : start) :=
  exists R : state (I V) -> state (I W) -> Prop,
    R (first_state (I V)) (first_state (I W)) /\
    forall s t, R s t -> sense s = sense t /\ forall e, R (next_state s e) (next_state t e).

(** The robot answers with a map that is isomorphic to its world. *)
Definition maps O E (I : start -> environment_of O E) (robot : robot_of O E embedded_graph) (W : start) :=
  exists2 map : embedded_graph, answers robot (I W) map & isomorphic map W.

(** And its map also contains the robot's start. *)
Definition maps_start O E (I : start -> environment_of O E) (robot : robot_of O E start) (W : start) :=
  exists2 map : start, answers robot (I W) map & isomorphic_starts map W.
