(** The theorems, for every world. Each follows the sentence that it states. [Spec.v], [Algorithm1.v],
    [MovableMarker.v], [Markers.v], [Aids.v], [Folding.v], [Certificate.v], [FoldingExplorer.v], [Verdicts.v] and
    [Checker.v] define the terms; the proofs are in the other files. *)

From Coq Require BinNums.
From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program Algorithm1 Folding Certificate FoldingExplorer GivenActions
  Markers Aids.
From toposlam Require Walks Bisimulation Separates Figures Impossible Always Obeying Embedding Validation.
From toposlam Require Rounds Correct Mapper Classes MovableMarker MovableCorrect Covering.
From toposlam Require Moves Trail Unfolding Determined Simulation Identifying Coprime Multigraphs Tours
  Returns MovableCost MovableMapper ShortTours Lollipop ExplorerCorrect GivenActionsCorrect CertificateNeeded
  CertificateAttained AidIsomorphisms AidsAtVertices Imitation Fronts Strings
  HeldMarkers RoundTeams Plane Deeds Verdicts Checker CheckerWorlds CheckerSound.

Import Figures(cycle_3, cycle_4, figure_1a, figure_1b, smallest_a, smallest_b, edge_a, edge_b).
Import Figures(corridor_a, corridor_b, planar_a, planar_b).
Import Multigraphs(theta_plane, theta_torus, two_loops_plane, two_loops_torus, paths_a, paths_b, one_vertex).
Import Tours(chain_2, chain_3).
Import Embedding(embeds).
Import MovableMarker(handling_action, handling, can_handle, movable).
Import Plane(in_the_plane).
Import Deeds(deeds_of, decides, leaves, handles, chooses).
Import Verdicts(world_text, setting, claim, describes, claim_true).
Import Checker(wrong_world, tables_of, prepare, check, Accepted).

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** * Walks *)

(** The same doors never lead two different poses of a world to the same pose. Paper: 2.1. *)
Theorem walk_inj (G : embedded_graph) (doors : seq door) :
  injective (fun pose : G => walk pose doors).
Proof. (* paper: motion.path *)
exact: Walks.walk_inj.
Qed.

(** The way back along a path ends at the vertex where it began, and the robot is then turned by the first
    door of the path. Paper: 2.3; Algorithm 1, line 15. *)
Theorem way_backK (G : embedded_graph) (pose : G) (doors : seq door) :
  walk (walk pose doors) (way_back (taken pose doors)) = turn pose (head 0 doors).
Proof. (* paper: alg1.15 *)
exact: Walks.way_backK.
Qed.

(** * Markers that do not suffice, and one that does *)

(** Two starts are indistinguishable, i.e. every door sequence gives the same percepts, exactly if there
    is a bisimulation of their poses. Paper: 2.2; the proof about Figure 1. *)
Theorem bisimilarP (M : marker) (V W : start) :
  bisimilar (moving M) V W <-> indistinguishable M V W.
Proof. exact: Bisimulation.bisimilarP. Qed.

(** In bisimilar starts every robot has the same history, whatever its actions and its strategy, and so gives the
    same answer. Paper: 2.2. *)
Theorem bisimilar_history O E A (robot : robot_of O E A) (I : start -> environment_of O E) (V W : start) :
  bisimilar I V W ->
  (forall decisions, history robot (I V) decisions = history robot (I W) decisions) /\
  (forall answer, answers robot (I V) answer <-> answers robot (I W) answer).
Proof. (* paper: world.interface *)
by move=> same; split; [apply: Bisimulation.bisimilar_history
                       | apply: Bisimulation.bisimilar_answers].
Qed.

(** Without a marker, no robot maps both the cycle of 3 and the cycle of 4. Paper: 2.2. *)
Theorem no_marker_impossible (robot : strategy embedded_graph) :
  ~ (maps (moving no_marker) robot cycle_3 /\ maps (moving no_marker) robot cycle_4).
Proof. (* paper: marker.none-insufficient, marker.none-cycles *)
exact: Impossible.no_marker_impossible.
Qed.

(** The two worlds of Figure 1 have neither loops nor parallel edges and are not isomorphic, but bisimilar
    with one undirected marker at the hub. Paper: 2.2; Figure 1. *)
Theorem figure_1_indistinguishable :
  [/\ simple figure_1a, simple figure_1b, ~ isomorphic figure_1a figure_1b
    & bisimilar (moving undirected) figure_1a figure_1b].
Proof. (* paper: fig1.different, fig1.step *)
have [simple_a simple_b] := Figures.figure_1_simple.
split=> //; [exact: Figures.figure_1_not_isomorphic | exact: Figures.figure_1_bisimilar].
Qed.

(** Two worlds of 6 edges, the smallest such pair that an exhaustive search finds, have neither loops nor
    parallel edges and are not isomorphic, but bisimilar with one undirected marker at the start vertex.
    Paper: 2.2. *)
Theorem smaller_pair_indistinguishable :
  [/\ simple smallest_a, simple smallest_b, ~ isomorphic smallest_a smallest_b
    & bisimilar (moving undirected) smallest_a smallest_b].
Proof.
have [simple_a simple_b] := Figures.smallest_simple.
split=> //; [exact: Figures.smallest_not_isomorphic | exact: Figures.smallest_bisimilar].
Qed.

(** With one undirected marker that stays at the start vertex, no robot maps both worlds of Figure 1, nor
    both of the smaller pair. Paper: 2.2. *)
Theorem undirected_marker_impossible (robot : strategy embedded_graph) :
  ~ (maps (moving undirected) robot figure_1a /\ maps (moving undirected) robot figure_1b) /\
  ~ (maps (moving undirected) robot smallest_a /\ maps (moving undirected) robot smallest_b).
Proof. (* paper: marker.undirected-insufficient *)
exact: Impossible.undirected_marker_impossible.
Qed.

(** With a directional marker, two starts are indistinguishable exactly if they are isomorphic, facing to
    facing. Paper: 2.3. *)
Theorem indistinguishable_directionalP (V W : start) :
  indistinguishable directional V W <-> isomorphic_starts V W.
Proof. exact: Separates.indistinguishable_directionalP. Qed.

(** If one robot maps two indistinguishable starts, and knows where it began, then they are isomorphic,
    facing to facing. Paper: 2.2. *)
Theorem mapped_indistinguishable_iso (robot : strategy start) (M : marker) (V W : start) :
  maps_start (moving M) robot V -> maps_start (moving M) robot W -> indistinguishable M V W -> isomorphic_starts V W.
Proof.
by move=> maps_V maps_W /Bisimulation.bisimilarP same;
   apply: Impossible.bisimilar_maps_start same maps_V maps_W.
Qed.

(** * Programs *)

(** If a property always holds for a program, it holds for the robot that runs the program with the
    default choices: the robot answers, and until then does only what is possible. Paper: 2.1. *)
Theorem obeying_always E (I : environment E) A (p : percept -> program_of E A) (Q : A -> state I -> nat -> Prop) :
  always I (p (sense (first_state I))) (first_state I) Q ->
  let robot := obeying p in
  exists answer n,
    [/\ robot (history robot I n) = Answer answer, Q answer (situation robot I n).2 n
      & forall j e, robot (history robot I j) = Act e -> possible (situation robot I j).2 e].
Proof. exact: Obeying.obeying_always. Qed.

(** * Algorithm 1 *)

(** These theorems are about every valid test of hypotheses. A test is what the robot does at lines 7, 12 and
    13: which hypotheses it raises, which percepts match, and whether it goes on after one that does not. It is
    valid if it accepts what is expected, and at the end of a path nothing else. *)

(** The test as printed is valid: a hypothesis for each unexplored edge, the degrees along the path, and the
    marker with its direction at the end. So is that of toposlam: whole percepts, and back at the first mismatch.
    Paper: 2.3; Algorithm 1, lines 7, 12 and 13. *)
Theorem valid_tests : valid as_printed /\ valid step_by_step.
Proof. (* paper: alg1.hypotheses, alg1.13 *)
by split; [exact: Correct.as_printed_valid | exact: Correct.step_by_step_valid].
Qed.

Section Line4.

Variables (W : start) (S : partial_map) (place : nat -> W) (pose : nat).

(** When Algorithm 1 first reaches line 4, the known map is a part of the world, and the robot is where it
    believes it is. Paper: 2.3; Algorithm 1, lines 1 to 3. *)
Theorem embeds_at_start : embeds (with_vertex [::] (degree (facing W))) (@turn W (facing W)).
Proof. (* paper: alg1.2, alg1.3 *)
exact: Correct.embeds_at_start.
Qed.

(** If, at line 4, the known map is a part of the world and the robot is where it believes it is, then so
    they are after the round. Paper: 2.3; Algorithm 1, lines 5 to 23. *)
Theorem embeds_explore (test : hypothesis_test) :
  valid test -> embeds S place -> pose < size S -> unexplored S != [::] ->
  always (moving directional W) (explore test any_path S pose) (place pose)
    (fun after there _ => exists place' : nat -> W,
       [/\ embeds after.1 place', after.2 < size after.1 & there = place' after.2]).
Proof. (* paper: alg1.4, alg1.located *)
move=> ok known lt some; have short T path : size path < known_vertices T -> any_path T path by [].
apply: Always.alwaysW (Rounds.explore_spec ok short known lt some).
by move=> after r k [[place' [known' lt' -> _]] _]; exists place'.
Qed.

End Line4.

Section Validation.

(** The known map [S] is a part of the world, given by [place]. The robot came to [t], and has turned by
    [turned] since: not at all if it has rejected no hypothesis yet. It follows a path from the hypothesis [h]
    to the marked vertex. *)
Variables (test : hypothesis_test) (S : partial_map) (W : start) (place : nat -> W) (t : W).
Variables (h : nat) (path : seq nat) (turned : door).
Hypotheses (test_valid : valid test) (known : embeds S place) (h_known : h < size S).
Hypotheses (path_leads : leads S (vertex S h) path 0) (turned_exists : turned < degree t).

Let once := Validation.validate_spec known test_valid h_known path_leads turned_exists.

(** A confirmed hypothesis is true: the robot came in by the dart of the hypothesis, and it is then where
    it believes it is. Paper: 2.3; Algorithm 1, lines 16 and 17. *)
Theorem validation_sound :
  always (moving directional W) (validate test S (perceive directional t) turned h path) (turn t turned)
    (fun ended pose _ => forall believed, ended = Confirmed believed ->
       place h = t /\ place believed = pose).
Proof. (* paper: alg1.validation, alg1.17 *)
apply: Always.alwaysW once.
by case=> [believed|turned'] pose k // [placed _ -> _] _ [<-].
Qed.

(** A true hypothesis is confirmed. Paper: 2.3; Algorithm 1, lines 12 to 17. *)
Theorem validation_complete :
  place h = t ->
  always (moving directional W) (validate test S (perceive directional t) turned h path) (turn t turned)
    (fun ended _ _ => exists believed, ended = Confirmed believed).
Proof. (* paper: alg1.16 *)
move=> true_h; apply: Always.alwaysW once.
by case=> [believed|turned'] pose k; [exists believed | case].
Qed.

(** After a rejected hypothesis the robot is where it was, turned by a door that it knows. Paper: 2.3;
    Algorithm 1, lines 14 and 15. *)
Theorem rejection_returns :
  always (moving directional W) (validate test S (perceive directional t) turned h path) (turn t turned)
    (fun ended pose _ => forall turned', ended = Rejected turned' -> pose = turn t turned').
Proof. (* paper: alg1.14, alg1.15 *)
apply: Always.alwaysW once.
by case=> [believed|turned'] pose k // [_ -> _ _] _ [<-].
Qed.

End Validation.

(** Of any hypotheses about a place, tried in any order and by any paths, the true one is confirmed. If there
    is none, all are rejected, and the robot is where it was. Paper: 2.3; Algorithm 1, lines 8 to 17. *)
Theorem hypotheses_decided (test : hypothesis_test) (S : partial_map) (W : start) (place : nat -> W) (t : W)
    (H : seq nat) :
  valid test -> embeds S place -> {subset H <= unexplored S} ->
  always (moving directional W) (try_all test any_path (size H) S (perceive directional t) 0 H) t
    (fun became pose _ =>
       match became with
       | Loop h believed => [/\ h \in H, place h = t & place believed = pose]
       | New turned => (forall h, h \in H -> place h <> t) /\ pose = turn t turned
       end).
Proof. (* paper: alg1.8, alg1.9 *)
move=> ok known sub; have short T path : size path < known_vertices T -> any_path T path by [].
have := Rounds.try_all_spec ok short known (erefl (size H)) sub (Walks.degree_gt0 t).
by apply: Always.alwaysW => -[h believed|turned] pose k [_] [] => [? ? _ ->|].
Qed.

(** In every world, from every start, Algorithm 1 ends, with any choice of an edge at line 5, of a
    hypothesis at line 9, and of paths through the known map at lines 6 and 10, and with any valid test of
    hypotheses. Its map is isomorphic to the world, facing to facing, and the robot is where it believes it is.
    As many rounds suffice as the world has edges. Paper: 2.3; Algorithm 1. *)
Theorem algorithm1_correct (test : hypothesis_test) (W : start) (bound : nat) :
  valid test -> edges W <= bound ->
  always (moving directional W) (algorithm1 test any_path bound (perceive directional (facing W))) (facing W)
    (fun answer pose _ => right_answer answer pose).
Proof. (* paper: alg1.isomorphic, alg1.located, alg1.terminates, alg1.every-world *)
move=> ok enough; have short S path : size path < known_vertices S -> any_path S path by [].
by apply: Always.alwaysW (Correct.algorithm1_spec ok short enough) => answer pose k [].
Qed.

(** With paths that have fewer edges than there are known vertices, such as shortest paths, Algorithm 1
    makes at most m n + 2 m^2 (n - 1) moves, with any other choices and any valid test. Paper: 2.3; the cost of
    Algorithm 1. *)
Theorem algorithm1_cost (test : hypothesis_test) (W : start) (bound : nat) :
  let m := edges W in
  let n := vertices W in
  valid test -> m <= bound ->
  always (moving directional W) (algorithm1 test short_paths bound (perceive directional (facing W))) (facing W)
    (fun _ _ moves => moves <= m * n + 2 * m ^ 2 * (n - 1)).
Proof. (* paper: cost.bound *)
move=> m n ok enough; have short S path : size path < known_vertices S -> short_paths S path by [].
apply: Always.alwaysW (Correct.algorithm1_spec ok short enough) => answer pose k [_].
by rewrite /Correct.cost -mulnn subn1; apply.
Qed.

(** With any limit on rounds, also with one that is too low, Algorithm 1 answers nothing or rightly. Paper:
    2.3; Algorithm 1. *)
Theorem algorithm1_sound (test : hypothesis_test) (W : start) (bound : nat) :
  valid test ->
  always (moving directional W) (algorithm1 test any_path bound (perceive directional (facing W))) (facing W)
    (fun answer pose _ => answer = None \/ right_answer answer pose).
Proof. by move=> ok; apply: (Correct.algorithm1_sound ok) => S path. Qed.

(** One directional marker suffices: there is one robot that maps every world with such a marker, without
    any knowledge of that world. Paper: 1 and 2.3. *)
Theorem directional_marker_suffices :
  exists robot : strategy start, forall W : start, maps_start (moving directional) robot W.
Proof. (* paper: marker.directional-sufficient *)
by exists Mapper.mapper; apply: Mapper.mapper_maps.
Qed.

(** One robot also knows where it is in its map, takes only doors that exist, and makes at most
    m n + 2 m^2 (n - 1) moves. Paper: 1 and 2.3. *)
Theorem directional_marker_locates :
  exists robot : strategy located, forall W : start, exists map decisions,
    let m := edges W in
    let n := vertices W in
    let pose := (situation robot (moving directional W) decisions).2 in
    [/\ robot (history robot (moving directional W) decisions) = Answer map,
        exists f : map -> W, [/\ isomorphism f, f (facing map) = facing W & f (Algorithm1.robot map) = pose],
        forall j i, robot (history robot (moving directional W) j) = Act i ->
          i < degree (situation robot (moving directional W) j).2
      & decisions <= m * n + 2 * m ^ 2 * (n - 1)].
Proof.
exists Mapper.locating_mapper => W; have := Mapper.locating_mapper_maps W.
by rewrite /Correct.cost -mulnn subn1.
Qed.

(** * More than the paper *)

(** In two starts that are indistinguishable with one undirected marker, all classes of poses that
    perceive the same for ever have the same size, in both worlds, and this size divides the degree of the
    marked vertex. Paper: beyond 2.2. *)
Theorem card_class_dvd (V W : start) :
  indistinguishable undirected V W ->
  exists size, size %| degree (facing V) /\
    forall X Y, (X = V \/ X = W) -> (Y = V \/ Y = W) ->
    forall p : X, exists2 C : pred Y, forall q, C q <-> alike undirected p q & #|C| = size.
Proof.
move=> same; have [size [divides VV WW VW WV]] := Classes.indistinguishable_classes same.
exists size; split=> // X Y [->|->] [->|->] p; exists (Classes.class undirected _ p) => // q;
  split=> /Classes.alikeP //.
Qed.

(** With one marker that can be picked up and dropped, the mapping algorithm of Dudek, Jenkin, Milios and
    Wilkes maps every world without loops and parallel edges, with any choices; the robot is then where it
    believes it is, with the marker in hand. Paper: 2.3; place validation, back-link validation. *)
Theorem movable_marker_correct (W : start) (bound : nat) :
  simple W -> edges W <= bound ->
  let begin := first_state (handling W) in
  always (handling W) (movable any_path bound (sense begin)) begin
    (fun answer s _ => s.2 = None /\ right_answer answer s.1).
Proof. (* paper: movable.place, movable.back-link *)
move=> simple_W enough; have short S path : size path < known_vertices S -> any_path S path by [].
exact: (MovableCorrect.movable_marker_correct short simple_W enough).
Qed.

(** With any limit on rounds, also with one that is too low, it answers nothing or rightly. Paper: 2.3. *)
Theorem movable_marker_sound (W : start) (bound : nat) :
  simple W ->
  let begin := first_state (handling W) in
  always (handling W) (movable any_path bound (sense begin)) begin
    (fun answer s _ => s.2 = None /\ (answer = None \/ right_answer answer s.1)).
Proof.
move=> simple_W; have short S path : size path < known_vertices S -> any_path S path by [].
exact: (MovableCorrect.movable_marker_sound short simple_W).
Qed.

(** With paths that have fewer edges than there are known vertices, it does at most
    1 + m ((n + 4) (n - 1) + 4 m + 8) actions: moves, pick-ups and drops. Paper: 2.3. *)
Theorem movable_marker_cost (W : start) (bound : nat) :
  simple W ->
  let m := edges W in
  let n := vertices W in
  let begin := first_state (handling W) in
  always (handling W) (movable short_paths bound (sense begin)) begin
    (fun _ _ actions => actions <= 1 + m * ((n + 4) * (n - 1) + 4 * m + 8)).
Proof.
move=> simple_W m n begin; have short S path : size path < known_vertices S -> short_paths S path by [].
rewrite -addnA [4 * m + 8]addnC addnA subn1.
exact: (MovableCost.movable_cost short simple_W (fun S path => id)).
Qed.

(** So one robot maps every world without loops and parallel edges with one movable marker, within this bound.
    It knows where it is in its map, carries the marker in the end, takes only doors that exist, picks up the
    marker only where it lies, and drops it only if it carries it. Paper: 1 and 2.3. *)
Theorem movable_marker_locates :
  exists robot : strategy_of handling_action located, forall W : start, simple W ->
  exists map decisions,
    let m := edges W in
    let n := vertices W in
    let: (pose, lying) := (situation robot (handling W) decisions).2 in
    [/\ robot (history robot (handling W) decisions) = Answer map, lying = None,
        exists f : map -> W, [/\ isomorphism f, f (facing map) = facing W & f (Algorithm1.robot map) = pose],
        forall j e, robot (history robot (handling W) j) = Act e -> can_handle (situation robot (handling W) j).2 e
      & decisions <= 1 + m * ((n + 4) * (n - 1) + 4 * m + 8)].
Proof.
exists MovableMapper.movable_mapper => W /MovableMapper.movable_mapper_maps.
by rewrite /MovableCost.round_cost -addnA [8 + _]addnC addnA subn1.
Qed.

(** * Which markers suffice *)

(** A marker is as good as a directional one if it identifies the facing dart: only near its vertex, and then
    behind its edge, the robot perceives certain percepts. Any robot with a directional marker can be
    simulated. For each of its moves, and at the start, that costs at most twice the largest degree more. The
    simulating robot takes only doors that exist, in every world. Paper: beyond 2.3. *)
Theorem as_good_as_directional (M : marker) (near beyond : pred percept) A (robot : strategy A) :
  exists robot' : strategy A,
    (forall (W : start) (bound : nat),
       identifies M near beyond W -> (forall d : W, degree d <= bound) ->
       forall n answer, robot (history robot (moving directional W) n) = Answer answer ->
       exists2 n', n' <= n + n.+1 * (2 * bound) & robot' (history robot' (moving M W) n') = Answer answer) /\
    (forall (W : start) j i,
       robot' (history robot' (moving M W) j) = Act i -> i < degree (situation robot' (moving M W) j).2).
Proof.
exists (Simulation.simulating near beyond robot); split=> [W bound identifies_W small n answer|W j i].
  exact: Simulation.simulating_answers.
exact: Simulation.simulating_doors.
Qed.

(** So one robot maps every world with an arrow on an edge. Paper: beyond 2.3. *)
Theorem directed_edge_suffices :
  exists robot : strategy start, forall W : start, maps_start (moving directed_edge) robot W.
Proof.
have [robot maps_W] := Identifying.identifying_suffices directed_edge predT (fun seen => seen.2 == PassedAlong).
by exists robot => W; apply/maps_W/Identifying.directed_edge_identifies.
Qed.

(** One robot maps every world without loops and parallel edges with two markers that look different, at both
    ends of an edge. Paper: beyond 2.3. *)
Theorem two_distinct_suffices_simple :
  exists robot : strategy start, forall W : start, simple W -> maps_start (moving two_distinct) robot W.
Proof.
have [robot maps_W] :=
  Identifying.identifying_suffices two_distinct (fun seen => seen.2 == First) (fun seen => seen.2 == Second).
by exists robot => W simple_W; apply/maps_W/Identifying.two_distinct_identifies.
Qed.

(** An undirected marker suffices if it lies at a dead end: at a vertex of degree 1. Paper:
    beyond 2.2. *)
Theorem undirected_dead_end_suffices :
  exists robot : strategy start, forall W : start,
    degree (facing W) = 1 -> maps_start (moving undirected) robot W.
Proof.
have [robot maps_W] := Identifying.identifying_suffices undirected (fun seen => seen == (1, Lying)) predT.
by exists robot => W dead_end; apply/maps_W/Identifying.dead_end_identifies.
Qed.

(** An undirected marker distinguishes a start from all others if the degree of the marked vertex and the
    number of darts have no common divisor. Paper: beyond 2.2. *)
Theorem coprime_degree_determines (V W : start) :
  coprime (degree (facing W)) #|W| -> indistinguishable undirected V W -> isomorphic_starts V W.
Proof. exact: Coprime.coprime_degree_determines. Qed.

(** An undirected marker does not suffice in worlds without loops and parallel edges whose degrees are at most
    three: two such worlds with 6 edges are bisimilar, and no robot maps both. Paper: beyond 2.2. *)
Theorem undirected_corridor_impossible (robot : strategy embedded_graph) :
  [/\ simple corridor_a /\ simple corridor_b,
      (forall d : corridor_a, degree d = 3) /\ (forall d : corridor_b, degree d = 3),
      ~ isomorphic corridor_a corridor_b, bisimilar (moving undirected) corridor_a corridor_b
    & ~ (maps (moving undirected) robot corridor_a /\ maps (moving undirected) robot corridor_b)].
Proof.
have same := Figures.corridor_bisimilar; have differ := Figures.corridor_not_isomorphic.
split=> //; [exact: Figures.corridor_simple | exact: Figures.corridor_degree |].
exact: Impossible.bisimilar_impossible same differ robot.
Qed.

(** Nor does it in worlds without loops and parallel edges in the plane, by two such worlds with 8 edges. Paper: beyond
    2.2. *)
Theorem undirected_planar_impossible (robot : strategy embedded_graph) :
  [/\ simple planar_a /\ simple planar_b, in_the_plane planar_a /\ in_the_plane planar_b,
      ~ isomorphic planar_a planar_b, bisimilar (moving undirected) planar_a planar_b
    & ~ (maps (moving undirected) robot planar_a /\ maps (moving undirected) robot planar_b)].
Proof.
have same := Figures.planar_bisimilar; have differ := Figures.planar_not_isomorphic.
split=> //; [exact: Figures.planar_simple | exact: Plane.planar_in_the_plane |].
exact: Impossible.bisimilar_impossible same differ robot.
Qed.

(** A mark on an edge does not suffice, not even in worlds without loops and parallel edges: two such worlds
    with 7 edges are bisimilar, and no robot maps both. Paper: beyond 2.2. *)
Theorem undirected_edge_impossible (robot : strategy embedded_graph) :
  [/\ simple edge_a, simple edge_b, ~ isomorphic edge_a edge_b, bisimilar (moving undirected_edge) edge_a edge_b
    & ~ (maps (moving undirected_edge) robot edge_a /\ maps (moving undirected_edge) robot edge_b)].
Proof.
have [simple_a simple_b] := Figures.edge_simple; have same := Figures.edge_undirected_edge.
have differ := Figures.edge_not_isomorphic; split=> //; exact: Impossible.bisimilar_impossible same differ robot.
Qed.

(** Nor do two markers that look alike at both ends of an edge, in the same two worlds. Paper: beyond 2.2. *)
Theorem two_identical_impossible (robot : strategy embedded_graph) :
  [/\ simple edge_a, simple edge_b, ~ isomorphic edge_a edge_b, bisimilar (moving two_identical) edge_a edge_b
    & ~ (maps (moving two_identical) robot edge_a /\ maps (moving two_identical) robot edge_b)].
Proof.
have [simple_a simple_b] := Figures.edge_simple; have same := Figures.edge_two_identical.
have differ := Figures.edge_not_isomorphic; split=> //; exact: Impossible.bisimilar_impossible same differ robot.
Qed.

(** Two markers that look different at both ends of an edge do not suffice in worlds with parallel edges, nor
    in worlds with loops: the two worlds of three parallel edges, in the plane and on the torus, are not isomorphic
    but bisimilar, and so are two of two loops. No robot maps both of a pair. Paper: beyond 2.2. *)
Theorem two_distinct_impossible (robot : strategy embedded_graph) :
  [/\ ~ isomorphic theta_plane theta_torus, bisimilar (moving two_distinct) theta_plane theta_torus
    & ~ (maps (moving two_distinct) robot theta_plane /\ maps (moving two_distinct) robot theta_torus)] /\
  [/\ ~ isomorphic two_loops_plane two_loops_torus, bisimilar (moving two_distinct) two_loops_plane two_loops_torus
    & ~ (maps (moving two_distinct) robot two_loops_plane /\ maps (moving two_distinct) robot two_loops_torus)].
Proof.
have differ := Multigraphs.theta_not_isomorphic; have same := Multigraphs.theta_two_distinct.
have differ' := Multigraphs.loops_not_isomorphic; have same' := Multigraphs.loops_two_distinct.
by split; split=> //; [apply: Impossible.bisimilar_impossible same differ robot
                      | apply: Impossible.bisimilar_impossible same' differ' robot].
Qed.

(** Two markers that look different and are not adjacent do not suffice, not even in worlds without loops and
    parallel edges: two such worlds with 6 edges are bisimilar, and no robot maps both. Paper: beyond 2.2. *)
Theorem two_distant_impossible (robot : strategy embedded_graph) :
  [/\ simple paths_a, simple paths_b, ~ isomorphic paths_a paths_b, bisimilar (moving two_distant) paths_a paths_b
    & ~ (maps (moving two_distant) robot paths_a /\ maps (moving two_distant) robot paths_b)].
Proof.
have [simple_a simple_b] := Multigraphs.paths_simple; have same := Multigraphs.paths_two_distant.
have differ := Multigraphs.paths_not_isomorphic; split=> //; exact: Impossible.bisimilar_impossible same differ robot.
Qed.

(** One movable marker does not suffice in worlds with parallel edges, nor in worlds with loops: the same pairs are
    bisimilar for robots that can pick it up and drop it, and no robot maps both of a pair. Paper: beyond 2.3. *)
Theorem movable_marker_impossible (robot : strategy_of handling_action embedded_graph) :
  [/\ ~ isomorphic theta_plane theta_torus, bisimilar handling theta_plane theta_torus
    & ~ (maps handling robot theta_plane /\ maps handling robot theta_torus)] /\
  [/\ ~ isomorphic two_loops_plane two_loops_torus, bisimilar handling two_loops_plane two_loops_torus
    & ~ (maps handling robot two_loops_plane /\ maps handling robot two_loops_torus)].
Proof.
have differ := Multigraphs.theta_not_isomorphic; have same := Multigraphs.theta_handling.
have differ' := Multigraphs.loops_not_isomorphic; have same' := Multigraphs.loops_handling.
by split; split=> //; [apply: Impossible.bisimilar_impossible same differ robot
                      | apply: Impossible.bisimilar_impossible same' differ' robot].
Qed.

(** * Aids that move *)

(** No aid of toposlam that moves shows more than an isomorphism keeps: with each of them, isomorphic starts are
    bisimilar. Paper: beyond 2.3. *)
Theorem isomorphic_starts_bisimilar (number : nat) (heading : bool) (V W : start) :
  isomorphic_starts V W ->
  [/\ bisimilar (with_aid (markers_alike number)) V W, bisimilar (with_aid (markers_distinct number)) V W,
      bisimilar (with_aid movable_directional) V W /\ bisimilar (with_aid directional_and_movable) V W,
      bisimilar (with_aid (team heading number)) V W
    & bisimilar (with_aid (string number)) V W].
Proof.
split; try split; apply: AidIsomorphisms.isomorphic_bisimilar => //.
- exact: AidIsomorphisms.alike_keeps_isomorphisms.
- exact: AidIsomorphisms.distinct_keeps_isomorphisms.
- exact: AidIsomorphisms.directional_keeps_isomorphisms.
- exact: AidIsomorphisms.directional_and_movable_keeps_isomorphisms.
- exact: AidIsomorphisms.team_keeps_isomorphisms.
exact: AidIsomorphisms.string_keeps_isomorphisms.
Qed.

(** Any number of movable markers, alike or not, show only at which vertices they lie; and any number of other robots
    that show no heading show only at which vertices they are. Paper: beyond 2.3. *)
Theorem aids_at_vertices (number : nat) :
  [/\ shows_only_vertices (markers_alike number), shows_only_vertices (markers_distinct number)
    & shows_only_vertices (team false number)].
Proof.
split; [exact: AidsAtVertices.markers_alike_at_vertices | exact: AidsAtVertices.markers_distinct_at_vertices |].
exact: AidsAtVertices.team_at_vertices.
Qed.

(** With an aid that shows only vertices, starts are bisimilar if their poses correspond such that degrees are equal,
    each door leads to corresponding poses, and those at one vertex correspond to those at one vertex. Paper: beyond
    2.3. *)
Theorem aids_at_vertices_bisimilar (X : aid) (V W : start) (R : V -> W -> Prop) :
  shows_only_vertices X -> same_vertices R -> bisimilar (with_aid X) V W.
Proof. exact: AidsAtVertices.aids_at_vertices_bisimilar. Qed.

(** So any two bouquets, worlds with one vertex, are bisimilar with such an aid if they have the same degree. Paper:
    beyond 2.3. *)
Theorem bouquets_bisimilar (X : aid) (V W : start) :
  shows_only_vertices X -> one_vertex V -> one_vertex W -> degree (facing V) = degree (facing W) ->
  bisimilar (with_aid X) V W.
Proof.
move=> only one_V one_W; rewrite !Multigraphs.one_vertex_degree // => same.
exact: AidsAtVertices.aids_at_vertices_bisimilar only (AidsAtVertices.bouquets_same_vertices one_V one_W same).
Qed.

(** Such an aid does not suffice in worlds with parallel edges, nor in worlds with loops: the two worlds of three
    parallel edges, in the plane and on the torus, are bisimilar with it, and so are those of two loops. No robot maps
    both of a pair. Paper: beyond 2.3. *)
Theorem aids_at_vertices_impossible (X : aid) :
  shows_only_vertices X ->
  forall robot : robot_of (nat * sightings X) (action_with (aid_action X)) embedded_graph,
  [/\ ~ isomorphic theta_plane theta_torus, bisimilar (with_aid X) theta_plane theta_torus
    & ~ (maps (with_aid X) robot theta_plane /\ maps (with_aid X) robot theta_torus)] /\
  [/\ ~ isomorphic two_loops_plane two_loops_torus, bisimilar (with_aid X) two_loops_plane two_loops_torus
    & ~ (maps (with_aid X) robot two_loops_plane /\ maps (with_aid X) robot two_loops_torus)].
Proof.
move=> only robot; have differ := Multigraphs.theta_not_isomorphic; have differ' := Multigraphs.loops_not_isomorphic.
have same := AidsAtVertices.aids_at_vertices_bisimilar only AidsAtVertices.theta_same_vertices.
have same' := AidsAtVertices.aids_at_vertices_bisimilar only AidsAtVertices.loops_same_vertices.
by split; split=> //; [apply: Impossible.bisimilar_impossible same differ robot
                      | apply: Impossible.bisimilar_impossible same' differ' robot].
Qed.

(** A directional marker that can be carried has a front: if it stays where it is at the start, it shows what one
    shows that cannot be carried. So has one that stays beside a movable marker, and so have other robots that show
    their heading, if there is at least one. Paper: beyond 2.3. *)
Theorem aids_with_a_front (others : nat) :
  [/\ has_front movable_directional, has_front directional_and_movable & 0 < others -> has_front (team true others)].
Proof.
split; [exact: Fronts.movable_directional_front | exact: Fronts.directional_and_movable_front |].
exact: Fronts.team_front.
Qed.

(** Such an aid is as good as a directional marker: any robot with a directional marker can be simulated, if it takes
    only doors that exist. The simulating robot gives the same answer in the same pose, does only what is possible,
    and does no more actions. Paper: beyond 2.3. *)
Theorem front_as_good_as_directional (X : aid) A (robot : strategy A) :
  has_front X ->
  exists robot' : robot_of (nat * sightings X) (action_with (aid_action X)) A,
  forall W : start, possible_only robot (moving directional W) ->
  forall n answer, robot (history robot (moving directional W) n) = Answer answer ->
  exists n',
    [/\ robot' (history robot' (with_aid X W) n') = Answer answer,
        (situation robot' (with_aid X W) n').2.1 = (situation robot (moving directional W) n).2,
        possible_only robot' (with_aid X W)
      & n' <= n].
Proof.
move=> [read front]; pose look := Fronts.read_front read; exists (Imitation.in_place_of look look robot).
move=> W only n answer answered; have [n' [answered' same possible _ n'_le]] := Imitation.in_place_of_answers
  (@Fronts.untouched_pose _ W) (Fronts.untouched_first (front W)) (Fronts.untouched_next (front W)) only answered.
by exists n'; rewrite muln1 in n'_le.
Qed.

(** Starts that are bisimilar with such an aid are isomorphic, facing to facing. Paper: beyond 2.3. *)
Theorem front_determines (X : aid) (V W : start) :
  has_front X -> bisimilar (with_aid X) V W -> isomorphic_starts V W.
Proof.
move=> [read front] same; have maps_W U := Imitation.in_place_of_maps
  (@Fronts.untouched_pose _ U) (Fronts.untouched_first (front U)) (Fronts.untouched_next (front U)).
exact: Impossible.bisimilar_maps_start same (maps_W V) (maps_W W).
Qed.

(** One robot maps every world with such an aid. It knows where it is in its map, does only what is possible, and
    makes at most m n + 2 m^2 (n - 1) moves. Paper: beyond 2.3. *)
Theorem front_suffices (X : aid) :
  has_front X ->
  exists robot : robot_of (nat * sightings X) (action_with (aid_action X)) located,
  forall W : start, exists map decisions,
    let m := edges W in
    let n := vertices W in
    let pose := (situation robot (with_aid X W) decisions).2.1 in
    [/\ robot (history robot (with_aid X W) decisions) = Answer map,
        exists f : map -> W, [/\ isomorphism f, f (facing map) = facing W & f (Algorithm1.robot map) = pose],
        possible_only robot (with_aid X W)
      & decisions <= m * n + 2 * m ^ 2 * (n - 1)].
Proof.
move=> [read front]; pose look := Fronts.read_front read.
exists (Imitation.in_place_of look look Mapper.locating_mapper) => W.
have [map [n [answered located only _ n_le]]] := Imitation.in_place_of_locates
  (@Fronts.untouched_pose _ W) (Fronts.untouched_first (front W)) (Fronts.untouched_next (front W)).
by exists map, n; split=> //; move: n_le; rewrite muln1 /Correct.cost -mulnn subn1.
Qed.

(** A string as long as an edge, or longer, is as good as a directional marker, too: any robot with a directional
    marker can be simulated, if it takes only doors that exist. The simulating robot gives the same answer in the same
    pose, and does only what is possible. It makes at most 2 moves more, and does at most 3 times as many actions and
    5 more. Paper: beyond 2.3. *)
Theorem string_as_good_as_directional A (robot : strategy A) :
  exists robot' : robot_of (nat * string_view) (action_with holding) A,
  forall (W : start) (length : nat), 0 < length -> possible_only robot (moving directional W) ->
  forall n answer, robot (history robot (moving directional W) n) = Answer answer ->
  let with_string := with_aid (string length) W in
  exists n',
    [/\ robot' (history robot' with_string n') = Answer answer,
        (situation robot' with_string n').2.1 = (situation robot (moving directional W) n).2,
        possible_only robot' with_string, doors_used robot' with_string n' <= n + 2
      & n' <= 3 * n + 5].
Proof.
exists (Imitation.in_place_of (X := string 1) Strings.lay_string Strings.look_at_string robot).
move=> W length length_gt0 only n answer answered.
have [n' [answered' same possible used n'_le]] := Imitation.in_place_of_answers
  (@Strings.laid_pose length W) (Strings.laid_first W length_gt0) (@Strings.laid_next length W) only answered.
by exists n'; rewrite [n + 2]addnC [3 * n + 5]addnC [3 * n]mulnC; split=> //; rewrite -[n]muln1.
Qed.

(** Starts that are bisimilar with such a string are isomorphic, facing to facing. Paper: beyond 2.3. *)
Theorem string_determines (length : nat) (V W : start) :
  0 < length -> bisimilar (with_aid (string length)) V W -> isomorphic_starts V W.
Proof.
move=> length_gt0 same; have maps_W U := Imitation.in_place_of_maps
  (@Strings.laid_pose length U) (Strings.laid_first U length_gt0) (@Strings.laid_next length U).
exact: Impossible.bisimilar_maps_start same (maps_W V) (maps_W W).
Qed.

(** One robot maps every world with such a string, whatever its length. It knows where it is in its map, and does only
    what is possible. It makes at most m n + 2 m^2 (n - 1) + 2 moves, and at most 3 (m n + 2 m^2 (n - 1)) + 5 actions:
    moves, pick-ups and drops. Paper: beyond 2.3. *)
Theorem string_suffices :
  exists robot : robot_of (nat * string_view) (action_with holding) located,
  forall (W : start) (length : nat), 0 < length -> exists map decisions,
    let m := edges W in
    let n := vertices W in
    let bound := m * n + 2 * m ^ 2 * (n - 1) in
    let with_string := with_aid (string length) W in
    let pose := (situation robot with_string decisions).2.1 in
    [/\ robot (history robot with_string decisions) = Answer map,
        exists f : map -> W, [/\ isomorphism f, f (facing map) = facing W & f (Algorithm1.robot map) = pose],
        possible_only robot with_string, doors_used robot with_string decisions <= bound + 2
      & decisions <= 3 * bound + 5].
Proof.
exists (Imitation.in_place_of (X := string 1) Strings.lay_string Strings.look_at_string Mapper.locating_mapper).
move=> W length length_gt0; have [map [n [answered located only used n_le]]] := Imitation.in_place_of_locates
  (@Strings.laid_pose length W) (Strings.laid_first W length_gt0) (@Strings.laid_next length W).
move: n_le used; rewrite /Correct.cost -mulnn subn1 muln1 addnC [2 + _]addnC mulnC => n_le used.
by exists map, n.
Qed.

(** In worlds without loops and parallel edges any number of movable markers suffices, alike or not, but at least one:
    one robot maps all of these worlds. It knows where it is in its map, and does only what is possible. For each
    marker but one it does one action more than the bound for one marker allows: it picks that marker up, and keeps
    it. Paper: beyond 2.3. *)
Theorem movable_markers_suffice_simple (number : nat) (X : aid) :
  0 < number -> X = markers_alike number \/ X = markers_distinct number ->
  exists robot : robot_of (nat * sightings X) (action_with (aid_action X)) located,
  forall W : start, simple W -> exists map decisions,
    let m := edges W in
    let n := vertices W in
    let pose := (situation robot (with_aid X W) decisions).2.1 in
    [/\ robot (history robot (with_aid X W) decisions) = Answer map,
        exists f : map -> W, [/\ isomorphism f, f (facing map) = facing W & f (Algorithm1.robot map) = pose],
        possible_only robot (with_aid X W)
      & decisions <= number - 1 + (1 + m * ((n + 4) * (n - 1) + 4 * m + 8))].
Proof.
case: number => // held _ kind; rewrite subn1 /=.
have mapper (W : start) : simple W -> exists map n,
    [/\ MovableMapper.movable_mapper (history MovableMapper.movable_mapper (handling W) n) = Answer map,
        exists f : map -> W, [/\ isomorphism f, f (facing map) = facing W
          & f (Algorithm1.robot map) = (situation MovableMapper.movable_mapper (handling W) n).2.1],
        possible_only MovableMapper.movable_mapper (handling W)
      & n <= 1 + edges W * ((vertices W + 4) * (vertices W - 1) + 4 * edges W + 8)].
  move=> /MovableMapper.movable_mapper_maps[map [n at_n]]; exists map, n.
  move: at_n; rewrite /MovableCost.round_cost -addnA [8 + _]addnC addnA subn1 /possible_only.
  by case: (situation _ _ n).2 => pose lying [].
case: kind => ->.
- exists (Imitation.imitating MovableMapper.movable_mapper HeldMarkers.do_with_alike
    (HeldMarkers.pick_up_alike held) HeldMarkers.look_at_alike) => W simple_W.
  have [map [n [answered located only n_le]]] := mapper W simple_W.
  have [n' [answered' [a [b [_ at_n']]] possible _ n'_le]] :=
    Imitation.imitating_answers (HeldMarkers.alike_first held W) (@HeldMarkers.alike_next held W) only answered.
  exists map, n'; rewrite at_n'; split=> //; apply: leq_trans n'_le _.
  by rewrite muln1 leq_add2l.
exists (Imitation.imitating MovableMapper.movable_mapper HeldMarkers.do_with_first
  (HeldMarkers.pick_up_others held) HeldMarkers.look_at_first) => W simple_W.
have [map [n [answered located only n_le]]] := mapper W simple_W.
have [n' [answered' at_n' possible _ n'_le]] :=
  Imitation.imitating_answers (HeldMarkers.distinct_first held W) (@HeldMarkers.distinct_next held W) only answered.
exists map, n'; rewrite at_n'; split=> //; apply: leq_trans n'_le _.
by rewrite muln1 leq_add2l.
Qed.

(** So does another robot that shows no heading: one robot maps every world without loops and parallel edges with
    such robots, if there is at least one. It knows where it is in its map, and does only what is possible. If all
    degrees are at most d, it does at most (2 d + 5) (m n + 2 m^2 (n - 1)) + 2 d + 4 actions: moves of both. Paper:
    beyond 2.3. *)
Theorem round_team_suffices_simple :
  exists robot : robot_of (nat * seq companion) (action_with sending) located,
  forall (W : start) (others d : nat), 0 < others -> simple W -> (forall p : W, degree p <= d) ->
  exists map decisions,
    let m := edges W in
    let n := vertices W in
    let in_team := with_aid (team false others) W in
    let pose := (situation robot in_team decisions).2.1 in
    [/\ robot (history robot in_team decisions) = Answer map,
        exists f : map -> W, [/\ isomorphism f, f (facing map) = facing W & f (Algorithm1.robot map) = pose],
        possible_only robot in_team
      & decisions <= (2 * d + 5) * (m * n + 2 * m ^ 2 * (n - 1)) + (2 * d + 4)].
Proof.
pose look := RoundTeams.look_at_team.
exists (Imitation.in_place_of (X := team false 1) look look Mapper.locating_mapper).
move=> W [//|others] d _ simple_W small.
have [map [n [answered located only _ n_le]]] := Imitation.in_place_of_locates
  (@RoundTeams.waits_pose others W) (RoundTeams.waits_first others simple_W small)
  (@RoundTeams.waits_next others W simple_W d small).
exists map, n; split=> //; move: n_le.
by rewrite /Correct.cost -mulnn subn1 addnC -addnS mulnC.
Qed.

(** * Folding *)

(** A folded trail without open darts is the world: if the darts of one start map to the darts of another,
    so that opposites and clockwise successors are kept, and only the facing dart maps to the facing dart,
    then both starts are isomorphic. Paper: beyond 2.3. *)
Theorem covering_isomorphic (V W : start) (f : V -> W) :
  (forall d, f (opposite d) = opposite (f d)) ->
  (forall d, f (clockwise d) = clockwise (f d)) ->
  (forall d, f d = facing W <-> d = facing V) ->
  isomorphic_starts V W.
Proof. exact: Covering.covering_isomorphic. Qed.

(** The folded trail of a walk maps, locally one to one, into every start with the percepts of this walk: darts of
    the trail that are folded stand for one dart of the start; those at both ends of an edge for opposite darts; the
    next one around a visit for the next one clockwise; the one that the marker points to for the facing dart; and
    the darts of a visit for all darts of a vertex, different ones for different ones. Paper: beyond 2.3. *)
Theorem folding_sound (W : start) (doors : seq door) :
  let seen := sees W doors in
  let dart := dart_of W doors in
  [/\ forall x y, folded doors seen x y -> dart x = dart y,
      forall x y, one_edge doors x y -> dart y = opposite (dart x),
      forall visit i, dart (visit, i.+1) = clockwise (dart (visit, i)),
      forall visit i, sighting_seen seen visit = Pointing i -> dart (visit, i) = facing W
    & forall visit, visit < size seen ->
        (forall i, degree (dart (visit, i)) = degree_seen seen visit) /\
        (forall i j, i < degree_seen seen visit -> j < degree_seen seen visit ->
           dart (visit, i) = dart (visit, j) -> i = j)].
Proof.
split=> // [x y|x y|visit i|visit visit_lt].
- exact: Trail.folding_sound.
- exact: Trail.one_edge_dart.
- exact: Trail.dart_of_pointing.
by split=> [i|i j i_lt j_lt]; [apply: Trail.degree_dart_of | apply: Trail.visit_inj].
Qed.

(** If no dart of the folded trail is open, every start with the percepts of the walk is isomorphic to it, facing to
    facing: each dart of the start is one of the trail, and darts of the trail that stand for one dart are folded.
    So all these starts are isomorphic. Paper: beyond 2.3. *)
Theorem complete_folding_determines (V W : start) (doors : seq door) :
  let seen := sees W doors in
  sees V doors = seen -> complete doors seen ->
  [/\ forall d : V, exists2 x, x.1 < size seen & dart_of V doors x = d,
      forall x y, x.1 < size seen -> y.1 < size seen -> dart_of V doors x = dart_of V doors y -> folded doors seen x y
    & isomorphic_starts V W].
Proof.
rewrite /= => same; rewrite -same => whole; split; first exact: Trail.complete_folding_onto.
  exact: Unfolding.complete_folding_inj.
by apply: (Trail.complete_folding_determines same); rewrite -same.
Qed.

(** If a dart of the folded trail is open, two worlds that are not isomorphic have the percepts of the walk.
    They are simple if the folded trail is, and their degrees are at most its greatest degree, or 2. Paper:
    beyond 2.3. *)
Theorem open_folding_ambiguous (W : start) (doors : seq door) (visit : nat) (i : door) :
  let seen := sees W doors in
  visit < size seen -> ~ followed doors seen (visit, i) ->
  exists V V' : start,
    [/\ sees V doors = seen, sees V' doors = seen, ~ isomorphic V V',
        simple_trail doors seen -> simple V /\ simple V'
      & forall bound, 2 <= bound -> (forall visit, visit < size seen -> degree_seen seen visit <= bound) ->
          (forall d : V, degree d <= bound) /\ (forall d : V', degree d <= bound)].
Proof. exact: Unfolding.open_folding_ambiguous. Qed.

(** In a world without loops and parallel edges every folded trail is simple. Paper: beyond 2.3. *)
Theorem simple_folding (W : start) (doors : seq door) : simple W -> simple_trail doors (sees W doors).
Proof. exact: Unfolding.simple_folding. Qed.

(** A robot maps every start exactly if in each it answers, when its folded trail is complete, with a start
    that has its percepts. Paper: beyond 2.3. *)
Theorem correct_iff_complete (robot : strategy start) :
  (forall W, maps_start (moving directional) robot W) <->
  (forall W, exists n map,
     let past := history robot (moving directional W) n in
     let doors := doors_taken robot directional W n in
     [/\ robot past = Answer map, sees map doors = past & complete doors past]).
Proof. exact: Determined.correct_iff_complete. Qed.

(** A robot that maps every world has gone over every edge before it answers. Paper: beyond 2.3. *)
Theorem every_edge_is_traversed (robot : strategy start) :
  (forall W, maps_start (moving directional) robot W) ->
  forall (W : start) n answer, robot (history robot (moving directional W) n) = Answer answer ->
  forall d : W, traverses (facing W) (doors_taken robot directional W n) d.
Proof. exact: Moves.every_edge_is_traversed. Qed.

(** So it makes at least as many moves as the world has edges. Paper: beyond 2.3. *)
Theorem at_least_m_moves (robot : strategy start) :
  (forall W, maps_start (moving directional) robot W) ->
  forall (W : start) n answer, robot (history robot (moving directional W) n) = Answer answer ->
  edges W <= size (doors_taken robot directional W n).
Proof. exact: Moves.at_least_m_moves. Qed.

(** And it comes back to the marked vertex at least m - n + 1 times. Paper: beyond 2.3. *)
Theorem returns_needed (robot : strategy start) :
  (forall W, maps_start (moving directional) robot W) ->
  forall (W : start) n answer, robot (history robot (moving directional W) n) = Answer answer ->
  edges W < vertices W + returns W (doors_taken robot directional W n).
Proof. by move=> maps_all W n answer; apply: Returns.returns_needed. Qed.

(** Cycles far from the marker cost much: if a set of far edges is at least [depth] moves from the marker, it
    makes at least 2 depth + 1 moves for each of them, except as many as there are vertices that cannot be
    reached without them. Paper: beyond 2.3. *)
Theorem far_cycles_cost (robot : strategy start) :
  (forall W, maps_start (moving directional) robot W) ->
  forall (W : start) n answer, robot (history robot (moving directional W) n) = Answer answer ->
  forall (far : pred W) (depth : nat),
  (forall d, far (opposite d) = far d) ->
  (forall doors d, same_vertex (walk (facing W) doors) d -> far d -> depth <= size doors) ->
  (2 * depth + 1) * (far_edges far - far_vertices far) <= size (doors_taken robot directional W n).
Proof. by move=> maps_all W n answer answered far depth; apply: Returns.far_cycles_cost maps_all answered. Qed.

(** So order m n moves are needed. For any two numbers there is a world of a chain of k + 1 edges, which begins
    at the marker and ends at a vertex with l loops, in which every robot that maps every world makes at least
    (2 k + 3) l moves. If l > k, that is at least half of m n. Paper: beyond 2.3. *)
Theorem lower_bound (k l : nat) :
  exists W : start, [/\ edges W = k + 1 + l, vertices W = k + 2
    & forall robot : strategy start, (forall V, maps_start (moving directional) robot V) ->
      forall n answer, robot (history robot (moving directional W) n) = Answer answer ->
      let moves := size (doors_taken robot directional W n) in
      (2 * k + 3) * l <= moves /\ (k < l -> edges W * vertices W <= 2 * moves)].
Proof.
exists (Lollipop.lollipop k l); rewrite Lollipop.lollipop_edges Lollipop.lollipop_vertices addn1 addn2.
split=> // robot maps_all n answer answered.
have cost : (2 * k + 3) * l <= size (doors_taken robot directional (Lollipop.lollipop k l) n).
  by have := Lollipop.lollipop_cost maps_all answered; rewrite mulnS -addnA addnC -addnA.
split=> // k_lt; apply: leq_trans (_ : 2 * ((2 * k + 3) * l) <= _); last by rewrite leq_mul2l.
apply: leq_trans (_ : (l + l) * k.+2 <= _); first by rewrite leq_mul2r leq_add2r k_lt orbT.
by rewrite addnn -mul2n -mulnA leq_mul2l /= mulnC leq_mul2r -addn2 leq_add ?orbT // mul2n -addnn leq_addr.
Qed.

(** In every world there is a walk with a complete folded trail that has as many moves as the formula of the
    certificate says. Paper: beyond 2.3. *)
Theorem certificate_attained (W : start) :
  exists2 doors, complete doors (sees W doors) & size doors = certificate_moves W.
Proof. exact: CertificateAttained.certificate_attained. Qed.

(** No walk with a complete folded trail has fewer moves. Paper: beyond 2.3. *)
Theorem certificate_shortest (W : start) (doors : seq door) :
  complete doors (sees W doors) -> certificate_moves W <= size doors.
Proof. exact: CertificateAttained.certificate_shortest. Qed.

(** So a robot that maps every world makes at least as many moves in each. Paper: beyond 2.3. *)
Theorem certificate_needed (robot : strategy start) :
  (forall W, maps_start (moving directional) robot W) ->
  forall (W : start) n answer, robot (history robot (moving directional W) n) = Answer answer ->
  certificate_moves W <= size (doors_taken robot directional W n).
Proof.
move=> maps_all W n answer answered; apply: CertificateNeeded.certificate_needed.
exact: Returns.robot_determined answered.
Qed.

(** The formula of the certificate: it is a lower bound for every robot that maps every world, in each world, and
    it is attained, by the shortest walk with a complete folded trail. Paper: beyond 2.3. *)
Theorem certificate_length (W : start) :
  [/\ forall robot : strategy start, (forall V, maps_start (moving directional) robot V) ->
        forall n answer, robot (history robot (moving directional W) n) = Answer answer ->
        certificate_moves W <= size (doors_taken robot directional W n),
      forall doors, complete doors (sees W doors) -> certificate_moves W <= size doors
    & exists2 doors, complete doors (sees W doors) & size doors = certificate_moves W].
Proof.
split=> [robot maps_all n answer answered|doors whole|].
- exact: certificate_needed answered.
- exact: certificate_shortest.
exact: certificate_attained.
Qed.

(** The folding explorer maps every world from every start, in whatever order it draws its conclusions, whichever
    darts it explores and hypotheses it tests, by any ways through the map and its trail, and whenever its tests
    become strict. Its map is isomorphic to the world, facing to facing, and the robot is where it believes it is.
    2 m (m + 1) actions suffice. Paper: beyond 2.3. *)
Theorem folding_explorer_correct (W : start) (patience : partial_map -> nat) (bound : nat) :
  2 * edges W * (edges W + 1) <= bound ->
  always (moving directional W) (folding_explorer any_length patience bound (perceive directional (facing W)))
    (facing W)
    (fun answer pose _ => right_answer answer pose).
Proof.
move=> enough; have short k l : k <= l -> any_length k l by [].
apply: Always.alwaysW (ExplorerCorrect.folding_explorer_spec patience short W 0 bound).
by move=> answer pose k [[//|[_]]]; rewrite ltnNge enough.
Qed.

(** With any limit on actions, also with one that is too low, it answers nothing or rightly. Paper: beyond 2.3. *)
Theorem folding_explorer_sound (W : start) (patience : partial_map -> nat) (bound : nat) :
  always (moving directional W) (folding_explorer any_length patience bound (perceive directional (facing W)))
    (facing W)
    (fun answer pose _ => answer = None \/ right_answer answer pose).
Proof.
have short k l : k <= l -> any_length k l by [].
apply: Always.alwaysW (ExplorerCorrect.folding_explorer_spec patience short W 0 bound).
by move=> answer pose k [[right|[none _]] _]; [right | left].
Qed.

(** With ways and paths that are not longer than those through the map, and with strict tests after
    4 n m + 200 moves, for a map with n vertices and m edges, it makes at most
    6 n m^2 + 18 n m + 2 m + 2 n + 802 moves, with any other choices. Paper: beyond 2.3. *)
Theorem folding_explorer_cost (W : start) (bound : nat) :
  let m := edges W in
  let n := vertices W in
  always (moving directional W) (folding_explorer no_longer usual_patience bound (perceive directional (facing W)))
    (facing W)
    (fun _ _ moves => moves <= 6 * n * m ^ 2 + 18 * n * m + 2 * m + 2 * n + 802).
Proof. exact: ExplorerCorrect.folding_explorer_cost. Qed.

(** The explorer that is compared with the running one, whose actions are given from outside, is the folding
    explorer: what always holds for the folding explorer holds for it, as long as the actions are allowed. Paper:
    beyond 2.3. *)
Theorem always_guided_explorer (M : marker) (W : start) (allowed : nat -> nat -> bool) (patience : partial_map -> nat)
    (bound : nat) (seen : percept) (pose : W) (Q : option (partial_map * nat) -> W -> nat -> Prop) :
  always (moving M W) (folding_explorer allowed patience bound seen) pose Q ->
  always_guided M (guided_explorer allowed patience bound seen) pose Q.
Proof. exact: GivenActionsCorrect.always_guided_actions. Qed.

(** * Maps that can be checked *)

(** A walk whose folded trail in a map is complete checks the map: from a pose of a world it has the percepts
    that the map predicts exactly if this pose is the facing dart and the map is isomorphic to the world,
    facing to facing. Paper: beyond 2.3. *)
Theorem tour_checks_the_map (map : start) (tour : seq door) :
  complete tour (sees map tour) ->
  forall (W : start) (pose : W),
    percepts directional pose tour = sees map tour <-> pose = facing W /\ isomorphic_starts map W.
Proof. exact: Tours.tour_checks_the_map. Qed.

(** From a map alone such a walk can be computed, with at most 2 m (2 n - 1) moves. Paper: beyond 2.3. *)
Theorem tour_of_map (map : start) :
  let m := edges map in
  let n := vertices map in
  {tour : seq door | complete tour (sees map tour) & size tour <= 2 * m * (2 * n - 1)}.
Proof. exact: ShortTours.tour_of_map. Qed.

(** If at most k percepts of k + 1 such walks are false, and all walks have the percepts that the map predicts,
    then the map is right, wherever the walks began. Paper: beyond 2.3. *)
Theorem k_false_percepts (map W : start) (tour : seq door) (k : nat)
    (poses : 'I_k.+1 -> W) (perceived : 'I_k.+1 -> seq percept) :
  complete tour (sees map tour) ->
  (forall walk, perceived walk = sees map tour) ->
  \sum_walk false_percepts (percepts directional (poses walk) tour) (perceived walk) <= k ->
  isomorphic_starts map W.
Proof. exact: Tours.k_false_percepts. Qed.

(** One such walk can confirm a wrong map if one of its percepts is false: in a chain of three vertices it has
    the percepts that a chain of two predicts. Paper: beyond 2.3. *)
Theorem one_false_percept :
  [/\ complete [:: 0] (sees chain_2 [:: 0]), ~ isomorphic chain_2 chain_3
    & false_percepts (sees chain_3 [:: 0]) (sees chain_2 [:: 0]) = 1].
Proof. exact: Tours.one_false_percept. Qed.

(** * What is extracted *)

(** A robot that does what is extracted from a program, with the default choices, takes the decisions of the robot
    that obeys the program: one that only moves, and one with a movable marker. Paper: beyond 2.3. *)
Theorem extracted_obeys A :
  (forall (p : Program.program A) (past : seq percept),
     decides id 0 0 (deeds_of (@leaves A) p) past = obey p past) /\
  (forall (p : program_of handling_action A) (past : seq percept),
     decides MovableMarker.LeaveBy MovableMarker.PickUp MovableMarker.Drop (deeds_of (@handles A) p) past =
     obey p past).
Proof. by split; [apply: Deeds.decides_moves | apply: Deeds.decides_handles]. Qed.

(** And whichever of the listed options it chooses by its number, it is an allowed one. Paper: beyond 2.3. *)
Theorem extracted_choices A (T : eqType) (xs : seq T) (default : T) (go : T -> Deeds.deeds A) (n i : nat) next :
  xs != [::] -> chooses (among xs) default go = Deeds.Chooses n next -> i < n ->
  exists2 x, allows (among xs) x & next (Some i) = go x.
Proof. exact: Deeds.chooses_listed. Qed.

(** * Proofs of verdicts *)

(** What the checker of proofs accepts is true: an accepted claim of each kind is true of all worlds of which it
    speaks. The page on proofs of verdicts, [docs/proofs-of-verdicts.md], says what is claimed. Paper: beyond 2.3. *)
Theorem checker_sound (s : setting) (c : claim) : check (prepare s) c = Accepted -> claim_true s c.
Proof. exact: CheckerSound.checker_sound. Qed.

(** Where it finds nothing wrong with the text of a world, the text describes a start, and only one, up to
    isomorphism. Paper: beyond 2.3. *)
Theorem accepted_world (t : world_text) :
  wrong_world t (tables_of t) = None ->
  (exists (W : start) (number : W -> BinNums.N), describes t number) /\
  forall (V W : start) (number : V -> BinNums.N) (number' : W -> BinNums.N),
    describes t number -> describes t number' ->
    exists f : V -> W, [/\ isomorphism f, f (facing V) = facing W & forall d, number' (f d) = number d].
Proof.
move=> right; split; first exact: CheckerWorlds.world_exists.
by move=> V W number number'; apply: CheckerWorlds.described_once.
Qed.
