//! Algorithm 1 with all choices: every order at line 5, and at line 9 among the hypotheses that the
//! percept on arrival has not already contradicted. Section 2.3.

use std::collections::HashMap;

use super::{Costs, Flaw, OpenChoices, judge};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph, Vertex},
    enumerate::Watch,
    isomorphism::Candidate,
    mapping::{Choices, Exploration, PartialMap, ValidationResult},
    world::GraphWorld,
};

/// All runs of Algorithm 1 on one start.
// paper: cost.shape-6, cost.shape-8
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EveryWay {
    /// Distinct states at line 4: the map, numbered by discovery, and the robot's vertex in it.
    pub states: u64,
    /// Distinct sequences of choices. Stays at the largest `u128` if there are more.
    pub runs: u128,
    /// The numbers of moves that occur among the runs.
    pub costs: Costs,
    /// Whether these are all: the budget of states was not used up.
    pub complete: bool,
}

/// How many states of one start are explored where nobody says otherwise.
pub const DEFAULT_STATE_BUDGET: u64 = 1_000_000;

/// The search is as deep as the world has edges. One with more is not begun: its states are beyond
/// counting anyway.
const MAX_EDGES: usize = 100;

/// Runs an algorithm on a start with all choices, and judges the end of every run. States are
/// explored once, runs are counted. After `budget` states, those within a round (what is left of H)
/// included, or when the watch says stop, no new one is begun.
///
/// # Errors
/// The first [`Flaw`].
pub fn every_way(
    algorithm: &impl OpenChoices,
    graph: &EmbeddedGraph,
    facing: Dart,
    budget: u64,
    watch: &impl Watch,
) -> Result<EveryWay, Flaw> {
    let mut world = GraphWorld::new(graph, facing);
    let mut exploration = Exploration::new(graph.dart_count());
    exploration.begin(&mut world, &mut ())?;
    let budget = if graph.edge_count() > MAX_EDGES { 0 } else { budget };
    let mut search = Search {
        algorithm,
        facing,
        budget,
        watch,
        begun: 0,
        complete: true,
        known: HashMap::new(),
        candidate: Candidate::default(),
    };
    let Futures { runs, costs } = search.line_4(&world, &exploration)?;
    let bound = algorithm.move_bound(graph.edge_count(), graph.vertex_count());
    match costs.max() {
        Some(moves) if moves > bound => Err(Flaw::TooManyMoves { moves, bound }),
        _ => {
            let states = search.known.len() as u64;
            Ok(EveryWay { states, runs, costs, complete: search.complete })
        }
    }
}

/// What can come after a state: how many runs, and how many more moves they take.
#[derive(Clone, Default)]
struct Futures {
    runs: u128,
    costs: Costs,
}

impl Futures {
    fn include(&mut self, other: &Self, moves: u64) {
        self.runs = self.runs.saturating_add(other.runs);
        self.costs.include(&other.costs, moves);
    }
}

struct Search<'w, A, W> {
    algorithm: &'w A,
    facing: Dart,
    budget: u64,
    watch: &'w W,
    /// States begun, at line 4 and at line 8.
    begun: u64,
    complete: bool,
    /// For each state at line 4 what can come after it, and where the robot truly was.
    known: HashMap<(PartialMap, Vertex), (Futures, Dart)>,
    candidate: Candidate,
}

/// Takes this edge.
struct ThisEdge(Dart);

/// Takes the hypothesis at this place.
struct ThisHypothesis(usize);

impl Choices for ThisEdge {
    fn next_edge(&mut self, _: &PartialMap, _: Dart, _: Dart) -> Dart {
        self.0
    }
}

impl Choices for ThisHypothesis {
    fn next_hypothesis(&mut self, _: &PartialMap, _: &[Dart]) -> usize {
        self.0
    }
}

impl<A: OpenChoices, W: Watch> Search<'_, A, W> {
    /// Whether one more state may be begun.
    fn begin(&mut self) -> bool {
        let may = self.begun < self.budget && !self.watch.stop();
        self.begun += u64::from(may);
        self.complete &= may;
        may
    }

    /// Every choice at line 5.
    fn line_4(&mut self, world: &GraphWorld, exploration: &Exploration) -> Result<Futures, Flaw> {
        let map = exploration.map();
        let state = (map.clone(), map.vertex(exploration.robot()));
        if let Some((futures, truly)) = self.known.get(&state) {
            // One state, one place in the world; it may have been entered by another dart.
            if world.graph().vertex(*truly) != world.graph().vertex(world.pose()) {
                let believed = exploration.robot();
                return Err(Flaw::WrongPose { believed, image: *truly, truly: world.pose() });
            }
            return Ok(futures.clone());
        }
        if !self.begin() {
            return Ok(Futures::default());
        }
        let mut futures = Futures::default();
        if map.unexplored_is_empty() {
            judge(self.algorithm, exploration, self.facing, world, &mut self.candidate)?;
            futures.include(&Futures { runs: 1, costs: Costs::nothing() }, 0);
        }
        for edge in map.unexplored() {
            let (mut world, mut next) = (world.clone(), exploration.clone());
            if let Some(edge) = next.next_edge(&mut ThisEdge(edge)) {
                next.explore(edge, &mut world, &mut ())?;
                let after = self.line_8(&world, &next, &mut HashMap::new())?;
                futures.include(&after, next.moves() - exploration.moves());
            }
        }
        self.known.insert(state, (futures.clone(), world.pose()));
        Ok(futures)
    }

    /// Every choice at line 9. What is left of H decides the state within the round.
    fn line_8(
        &mut self,
        world: &GraphWorld,
        exploration: &Exploration,
        known: &mut HashMap<Vec<Dart>, Futures>,
    ) -> Result<Futures, Flaw> {
        if let Some(known) = known.get(exploration.hypotheses()) {
            return Ok(known.clone());
        }
        if !self.begin() {
            return Ok(Futures::default());
        }
        let mut futures = Futures::default();
        if exploration.hypotheses().is_empty() {
            let (mut world, mut next) = (world.clone(), exploration.clone());
            next.add_place(&mut world, &mut ())?;
            futures = self.line_4(&world, &next)?;
        }
        for place in 0..exploration.hypotheses().len() {
            let (mut world, mut next) = (world.clone(), exploration.clone());
            if let Some(hypothesis) = next.next_hypothesis(&mut ThisHypothesis(place)) {
                let after =
                    match self.algorithm.try_path(&mut next, hypothesis, &mut world, &mut ())? {
                        ValidationResult::Confirmed => {
                            next.close_loop(hypothesis, &mut world, &mut ());
                            self.line_4(&world, &next)?
                        }
                        ValidationResult::Rejected => self.line_8(&world, &next, known)?,
                    };
                futures.include(&after, next.moves() - exploration.moves());
            }
        }
        known.insert(exploration.hypotheses().to_vec(), futures.clone());
        Ok(futures)
    }
}
