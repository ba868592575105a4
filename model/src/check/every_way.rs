//! An explorer with all choices. Of Algorithm 1: every order at line 5, and at line 9 among the hypotheses that
//! the percept on arrival has not already contradicted. Section 2.3.

use std::{collections::HashMap, vec};

use super::{ChoicesLimit, Costs, EveryWay, judge};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph, Vertex},
    enumerate::Watch,
    isomorphism::Candidate,
    mapping::{Explorer, FACING, Flaw, MapWalk, PartialMap, StateKey},
    world::GraphWorld,
};

/// The memory that the states of one start may take, in bytes by a generous estimate.
const MAX_BYTES: usize = 1 << 30;

/// The default number of states of one start that may be explored.
pub const DEFAULT_STATE_BUDGET: u64 = 1_000_000;

/// Runs an explorer on a start with all choices, and judges the end of every run. States that are
/// [compared](Explorer::state_key) are explored once; runs are counted. The search stops after `budget` states,
/// including those within a round, when the states take 1 GiB of memory, or when the watch stops it.
///
/// # Errors
/// Returns the first [`Flaw`].
pub fn every_way<E: Explorer>(
    mut explorer: E,
    graph: &EmbeddedGraph,
    facing: Dart,
    budget: u64,
    watch: &dyn Watch,
) -> Result<EveryWay, Flaw> {
    let mut world = GraphWorld::with_marker(graph, explorer.marker(), facing);
    let bound = explorer.move_bound(graph.edge_count(), graph.vertex_count());
    explorer.limit_darts(graph.dart_count());
    explorer.begin(&mut world, &mut ())?;
    let mut search = Search {
        facing,
        budget,
        watch,
        begun: [0; 2],
        bytes: 0,
        limit: None,
        known: HashMap::new(),
        rounds: Vec::new(),
        stack: Vec::new(),
        candidate: Candidate::default(),
    };
    let is_compared = explorer.state_key().is_some();
    let Futures { runs, costs } = search.run(world, explorer)?;
    match costs.max() {
        Some(moves) if moves > bound => Err(Flaw::TooManyMoves { moves, bound }),
        _ => {
            let [begun, within_rounds] = search.begun;
            let states = if is_compared { search.known.len() as u64 } else { begun };
            Ok(EveryWay { states, within_rounds, runs, costs, limit: search.limit })
        }
    }
}

/// What can follow a state: the number of runs, and the moves that they still take.
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

    fn bytes(&self) -> usize {
        64 + self.costs.bytes()
    }
}

/// A round: what begins at a state between two rounds, by one choice.
struct Round {
    /// The number of vertices of the map at its beginning.
    vertices: usize,
    /// What can follow each state within it: the hypotheses that are left.
    known: HashMap<Vec<Dart>, Futures>,
    bytes: usize,
}

/// Where a state is kept when all that can follow it is known.
enum Kept {
    /// It is not compared.
    Nowhere,
    Round {
        state: (PartialMap, Vertex),
        follows: Follows,
    },
    WithinRound(Vec<Dart>),
}

/// A state whose choices are being followed, one after the other.
struct SearchFrame<'g, E: Explorer> {
    kept: Kept,
    world: GraphWorld<'g, E::Marker>,
    explorer: E,
    /// Those that were not followed yet.
    choices: vec::IntoIter<E::Choice>,
    /// The moves of the step by the last choice.
    moves: u64,
    futures: Futures,
    bytes: usize,
}

/// What a state between two rounds follows.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Follows {
    /// The beginning, or a confirmed hypothesis.
    Known,
    /// The state within a round in which no hypothesis is left: the place is new.
    NoHypothesis,
}

struct Search<'g, 'w, E: Explorer> {
    facing: Dart,
    budget: u64,
    watch: &'w dyn Watch,
    /// States begun between two rounds, and within one.
    begun: [u64; 2],
    /// An estimate of the memory that the states take.
    bytes: usize,
    /// The first limit that was reached.
    limit: Option<ChoicesLimit>,
    /// For each state between two rounds, what can follow it, and the robot's pose in the world.
    known: HashMap<(PartialMap, Vertex), (Futures, Dart)>,
    /// The rounds that have begun: one for each state between two rounds on the stack.
    rounds: Vec<Round>,
    stack: Vec<SearchFrame<'g, E>>,
    candidate: Candidate,
}

impl<'g, E: Explorer> Search<'g, '_, E> {
    /// What can follow the first state. The stack is explicit: it is as deep as the run has choices.
    fn run(&mut self, world: GraphWorld<'g, E::Marker>, explorer: E) -> Result<Futures, Flaw> {
        let mut found = self.enter(world, explorer)?;
        while let Some(frame) = self.stack.last_mut() {
            if let Some(futures) = found.take() {
                frame.futures.include(&futures, frame.moves);
                if matches!(frame.kept, Kept::Round { .. }) {
                    let round = self.rounds.pop();
                    self.bytes -= round.map_or(0, |round| round.bytes);
                }
            }
            let next =
                frame.choices.next().filter(|_| self.limit != Some(ChoicesLimit::Interrupted));
            found = match next {
                Some(choice) => self.follow(choice)?,
                None => self.leave(),
            };
        }
        Ok(found.unwrap_or_default())
    }

    /// Whether one more state may be begun, between two rounds (0) or within one (1).
    fn begin(&mut self, level: usize) -> bool {
        if self.limit.is_none() {
            self.limit = if self.watch.stop() {
                Some(ChoicesLimit::Interrupted)
            } else if self.begun.iter().sum::<u64>() >= self.budget {
                Some(ChoicesLimit::States(self.budget))
            } else {
                (self.bytes > MAX_BYTES).then_some(ChoicesLimit::Memory)
            };
        }
        let may = self.limit.is_none();
        self.begun[level] += u64::from(may);
        may
    }

    /// Enters a state. Returns what can follow it, or `None` if that must be searched for: then the state is on
    /// the stack.
    fn enter(
        &mut self,
        world: GraphWorld<'g, E::Marker>,
        explorer: E,
    ) -> Result<Option<Futures>, Flaw> {
        let (level, kept) = match explorer.state_key() {
            None => (0, Kept::Nowhere),
            Some(StateKey::WithinRound(hypotheses)) => {
                if let Some(known) = self.in_round(&hypotheses) {
                    return Ok(Some(known));
                }
                (1, Kept::WithinRound(hypotheses))
            }
            Some(StateKey::Round(map, vertex)) => {
                let grown =
                    self.rounds.last().is_some_and(|last| map.vertex_count() > last.vertices);
                let follows = if grown { Follows::NoHypothesis } else { Follows::Known };
                if grown {
                    if let Some(known) = self.in_round(&[]) {
                        return Ok(Some(known));
                    }
                    if !self.begin(1) {
                        return Ok(Some(Futures::default()));
                    }
                }
                let state = (map, vertex);
                if let Some((futures, truly)) = self.known.get(&state) {
                    // One state, one place in the world; it may have been entered by another dart.
                    if world.graph().vertex(*truly) != world.graph().vertex(world.pose()) {
                        let believed = explorer.map_walk().map_or(FACING, MapWalk::robot);
                        return Err(Flaw::WrongPose {
                            believed,
                            image: *truly,
                            truly: world.pose(),
                        });
                    }
                    let futures = futures.clone();
                    self.keep_in_round(follows, &futures);
                    return Ok(Some(futures));
                }
                (0, Kept::Round { state, follows })
            }
        };
        if !self.begin(level) {
            return Ok(Some(Futures::default()));
        }
        self.push(kept, world, explorer)?;
        Ok(None)
    }

    /// What can follow a choice at the state on top of the stack. As [`Self::enter`].
    fn follow(&mut self, choice: E::Choice) -> Result<Option<Futures>, Flaw> {
        let Some(frame) = self.stack.last_mut() else { return Ok(None) };
        let (mut world, mut next) = (frame.world.clone(), frame.explorer.clone());
        next.step(choice, &mut world, &mut ())?;
        frame.moves = world.moves() - frame.world.moves();
        if let Kept::Round { state, .. } = &frame.kept {
            let (vertices, known) = (state.0.vertex_count(), HashMap::new());
            self.rounds.push(Round { vertices, known, bytes: 0 });
        }
        self.enter(world, next)
    }

    /// Puts a state on the stack. At the end of a run there is no choice: then the run is judged.
    fn push(
        &mut self,
        kept: Kept,
        world: GraphWorld<'g, E::Marker>,
        mut explorer: E,
    ) -> Result<(), Flaw> {
        let choices = explorer.choices()?;
        let mut futures = Futures::default();
        if choices.is_empty() {
            judge(&explorer, self.facing, &world, &mut self.candidate)?;
            futures.include(&Futures { runs: 1, costs: Costs::nothing() }, 0);
        }
        let darts = explorer.map_walk().map_or(0, |walk| walk.map().dart_count());
        let bytes = 500 + 100 * darts + 20 * choices.len();
        self.bytes += bytes;
        let choices = choices.into_iter();
        self.stack.push(SearchFrame { kept, world, explorer, choices, moves: 0, futures, bytes });
        Ok(())
    }

    /// Removes the state on top of the stack, whose choices were all followed. Returns what can follow it.
    fn leave(&mut self) -> Option<Futures> {
        let SearchFrame { kept, world, futures, bytes, .. } = self.stack.pop()?;
        self.bytes -= bytes;
        match kept {
            Kept::Nowhere => {}
            Kept::WithinRound(hypotheses) => self.insert_in_round(hypotheses, &futures),
            Kept::Round { state, follows } => {
                self.bytes += 100 + 20 * state.0.dart_count() + futures.bytes();
                self.known.insert(state, (futures.clone(), world.pose()));
                self.keep_in_round(follows, &futures);
            }
        }
        Some(futures)
    }

    /// What can follow a state of the present round, if it is known.
    fn in_round(&self, hypotheses: &[Dart]) -> Option<Futures> {
        self.rounds.last()?.known.get(hypotheses).cloned()
    }

    fn keep_in_round(&mut self, follows: Follows, futures: &Futures) {
        if follows == Follows::NoHypothesis {
            self.insert_in_round(Vec::new(), futures);
        }
    }

    fn insert_in_round(&mut self, hypotheses: Vec<Dart>, futures: &Futures) {
        let Some(round) = self.rounds.last_mut() else { return };
        let bytes = 40 + 4 * hypotheses.len() + futures.bytes();
        round.bytes += bytes;
        self.bytes += bytes;
        round.known.insert(hypotheses, futures.clone());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mapping::Algorithm1Run;

    /// Stops at once.
    struct Stopped;

    impl Watch for Stopped {
        fn stop(&self) -> bool {
            true
        }
    }

    #[test]
    fn the_limit_that_was_reached_is_named() {
        let limit = |budget, watch: &dyn Watch| {
            let ways = every_way(
                Algorithm1Run::default(),
                &EmbeddedGraph::cycle(5),
                Dart(0),
                budget,
                watch,
            )
            .unwrap();
            (ways.limit, ways.states + ways.within_rounds <= budget)
        };
        assert_eq!(limit(1000, &()), (None, true));
        assert_eq!(limit(9, &()), (Some(ChoicesLimit::States(9)), true));
        assert_eq!(limit(1000, &Stopped), (Some(ChoicesLimit::Interrupted), true));
    }
}
