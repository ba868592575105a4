//! Algorithm 1 with all choices: every order at line 5, and at line 9 among the hypotheses that the
//! percept on arrival has not already contradicted. Section 2.3.

use std::collections::HashMap;

use super::{Algorithm, CostOrder, Costs, EveryWay, Flaw, OpenChoices, judge};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph, Vertex},
    enumerate::Watch,
    isomorphism::Candidate,
    mapping::{Exploration, MappingChoice, MappingError, Observer, PartialMap},
    marker::Directional,
    world::{GraphWorld, Refused},
};

/// The default number of states of one start that may be explored.
pub const DEFAULT_STATE_BUDGET: u64 = 1_000_000;

/// The search is as deep as the number of edges. A larger world is not searched: it has too many
/// states anyway.
const MAX_EDGES: usize = 100;

/// Algorithm 1, or a variant of it, with the default choices, and then with all choices.
#[derive(Clone, Copy, Debug)]
pub struct AllChoices<A> {
    /// The algorithm.
    pub algorithm: A,
    /// The number of states of one start that may be explored.
    pub budget: u64,
}

impl<A: OpenChoices> Algorithm for AllChoices<A> {
    type Marker = Directional;
    type State = Exploration;

    fn name(&self) -> &'static str {
        self.algorithm.name()
    }

    fn order(&self) -> CostOrder {
        self.algorithm.order()
    }

    fn move_bound(&self, edges: usize, vertices: usize) -> u64 {
        self.algorithm.move_bound(edges, vertices)
    }

    fn run<'g>(
        &self,
        world: &mut GraphWorld<'g>,
        exploration: &mut Exploration,
        observer: &mut impl Observer<GraphWorld<'g>>,
    ) -> Result<(), MappingError<Refused>> {
        self.algorithm.run(world, exploration, observer)
    }

    fn other_runs(
        &self,
        graph: &EmbeddedGraph,
        facing: Dart,
        watch: &dyn Watch,
    ) -> Result<Option<EveryWay>, Flaw> {
        every_way(&self.algorithm, graph, facing, self.budget, watch).map(Some)
    }
}

/// Runs an algorithm on a start with all choices, and judges the end of every run. States are
/// explored once, runs are counted. The search stops after `budget` states, including those within a
/// round (the hypotheses that are left), or when the watch stops it.
///
/// # Errors
/// Returns the first [`Flaw`].
pub fn every_way(
    algorithm: &impl OpenChoices,
    graph: &EmbeddedGraph,
    facing: Dart,
    budget: u64,
    watch: &dyn Watch,
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

/// What can follow a state: the number of runs, and the moves that they still take.
#[derive(Clone, Default)]
struct Futures {
    runs: u128,
    costs: Costs,
}

/// What can follow each state of a round. A state is the hypotheses that are left.
type Round = HashMap<Vec<Dart>, Futures>;

impl Futures {
    fn include_all(&mut self, (other, moves): (Self, u64)) {
        self.include(&other, moves);
    }

    fn include(&mut self, other: &Self, moves: u64) {
        self.runs = self.runs.saturating_add(other.runs);
        self.costs.include(&other.costs, moves);
    }
}

struct Search<'w, A> {
    algorithm: &'w A,
    facing: Dart,
    budget: u64,
    watch: &'w dyn Watch,
    /// States begun, at line 4 and at line 8.
    begun: u64,
    complete: bool,
    /// For each state at line 4, what can follow it, and the robot's pose in the world.
    known: HashMap<(PartialMap, Vertex), (Futures, Dart)>,
    candidate: Candidate,
}

impl<A: OpenChoices> Search<'_, A> {
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
        for choice in exploration.open_choices() {
            futures.include_all(self.after(choice, world, exploration, &mut HashMap::new())?);
        }
        self.known.insert(state, (futures.clone(), world.pose()));
        Ok(futures)
    }

    /// Every choice at line 9. The hypotheses that are left are the state within the round.
    fn line_8(
        &mut self,
        world: &GraphWorld,
        exploration: &Exploration,
        round: &mut Round,
    ) -> Result<Futures, Flaw> {
        if let Some(known) = round.get(exploration.hypotheses()) {
            return Ok(known.clone());
        }
        if !self.begin() {
            return Ok(Futures::default());
        }
        let mut futures = Futures::default();
        for choice in exploration.open_choices() {
            futures.include_all(self.after(choice, world, exploration, round)?);
        }
        round.insert(exploration.hypotheses().to_vec(), futures.clone());
        Ok(futures)
    }

    /// What can follow a choice, and the moves of its step.
    fn after(
        &mut self,
        choice: MappingChoice,
        world: &GraphWorld,
        exploration: &Exploration,
        round: &mut Round,
    ) -> Result<(Futures, u64), Flaw> {
        let (mut world, mut next) = (world.clone(), exploration.clone());
        self.algorithm.step(&mut next, choice, &mut world, &mut ())?;
        let moves = next.moves() - exploration.moves();
        let futures = if next.is_at_line_8() {
            self.line_8(&world, &next, round)?
        } else if next.map().vertex_count() == exploration.map().vertex_count() {
            self.line_4(&world, &next)?
        } else if let Some(known) = round.get(&[][..]) {
            known.clone()
        } else if self.begin() {
            // The state at line 8 in which no hypothesis was left.
            let futures = self.line_4(&world, &next)?;
            round.insert(Vec::new(), futures.clone());
            futures
        } else {
            Futures::default()
        };
        Ok((futures, moves))
    }
}
