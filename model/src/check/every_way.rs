//! Algorithm 1 with all choices: every order at line 5, and at line 9 among the hypotheses that the
//! percept on arrival has not already contradicted. Section 2.3.

use std::{collections::HashMap, vec};

use super::{ChoicesLimit, Costs, EveryWay, Flaw, OpenChoices, judge};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph, Vertex},
    enumerate::Watch,
    isomorphism::Candidate,
    mapping::{Exploration, MappingChoice, PartialMap},
    world::GraphWorld,
};

/// The memory that the states of one start may take, in bytes by a generous estimate.
const MAX_BYTES: usize = 1 << 30;

/// Runs an algorithm on a start with all choices, and judges the end of every run. States are
/// explored once, runs are counted. The search stops after `budget` states, including those within a
/// round (the hypotheses that are left), when the states take 1 GiB of memory, or when the watch stops
/// it.
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
    let mut search = Search {
        algorithm,
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
    let Futures { runs, costs } = search.run(world, exploration)?;
    let bound = algorithm.move_bound(graph.edge_count(), graph.vertex_count());
    match costs.max() {
        Some(moves) if moves > bound => Err(Flaw::TooManyMoves { moves, bound }),
        _ => {
            let (states, within_rounds) = (search.known.len() as u64, search.begun[1]);
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

/// What can follow each state of a round. A state is the hypotheses that are left.
#[derive(Default)]
struct Round {
    known: HashMap<Vec<Dart>, Futures>,
    bytes: usize,
}

/// A state whose choices are being followed, one after the other.
struct SearchFrame<'g> {
    line: Line,
    world: GraphWorld<'g>,
    exploration: Exploration,
    /// Those that were not followed yet.
    choices: vec::IntoIter<MappingChoice>,
    /// The moves of the step by the last choice.
    moves: u64,
    futures: Futures,
    bytes: usize,
}

/// Where a run waits for a choice.
enum Line {
    /// At line 4. Each choice begins a round. The state is that of the search.
    Four { state: (PartialMap, Vertex), follows: Follows },
    /// At line 8: the hypotheses that are left are the state within the round.
    Eight,
}

/// What a state at line 4 follows.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Follows {
    /// The beginning, or a confirmed hypothesis.
    Known,
    /// The state at line 8 in which no hypothesis is left: the place is new.
    NoHypothesis,
}

struct Search<'g, 'w, A> {
    algorithm: &'w A,
    facing: Dart,
    budget: u64,
    watch: &'w dyn Watch,
    /// States begun at line 4, and at line 8.
    begun: [u64; 2],
    /// An estimate of the memory that the states take.
    bytes: usize,
    /// The first limit that was reached.
    limit: Option<ChoicesLimit>,
    /// For each state at line 4, what can follow it, and the robot's pose in the world.
    known: HashMap<(PartialMap, Vertex), (Futures, Dart)>,
    /// The rounds that have begun: one for each state at line 4 on the stack.
    rounds: Vec<Round>,
    stack: Vec<SearchFrame<'g>>,
    candidate: Candidate,
}

impl<'g, A: OpenChoices> Search<'g, '_, A> {
    /// What can follow a state at line 4. The stack is explicit: it is as deep as the run has choices.
    fn run(&mut self, world: GraphWorld<'g>, exploration: Exploration) -> Result<Futures, Flaw> {
        let mut found = self.line_4(world, exploration, Follows::Known)?;
        while let Some(frame) = self.stack.last_mut() {
            if let Some(futures) = found.take() {
                frame.futures.include(&futures, frame.moves);
                if matches!(frame.line, Line::Four { .. }) {
                    let round = self.rounds.pop();
                    self.bytes -= round.map_or(0, |round| round.bytes);
                }
            }
            let next =
                frame.choices.next().filter(|_| self.limit != Some(ChoicesLimit::Interrupted));
            found = match next {
                Some(choice) => self.after(choice)?,
                None => self.leave(),
            };
        }
        Ok(found.unwrap_or_default())
    }

    /// Whether one more state may be begun, at line 4 or at line 8.
    fn begin(&mut self, line: usize) -> bool {
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
        self.begun[line] += u64::from(may);
        may
    }

    /// Every choice at line 5. Returns what can follow, or `None` if that must be searched for: then the
    /// state is on the stack.
    fn line_4(
        &mut self,
        world: GraphWorld<'g>,
        exploration: Exploration,
        follows: Follows,
    ) -> Result<Option<Futures>, Flaw> {
        let map = exploration.map();
        let state = (map.clone(), map.vertex(exploration.robot()));
        if let Some((futures, truly)) = self.known.get(&state) {
            // One state, one place in the world; it may have been entered by another dart.
            if world.graph().vertex(*truly) != world.graph().vertex(world.pose()) {
                let believed = exploration.robot();
                return Err(Flaw::WrongPose { believed, image: *truly, truly: world.pose() });
            }
            let futures = futures.clone();
            self.keep_in_round(follows, &futures);
            return Ok(Some(futures));
        }
        if !self.begin(0) {
            return Ok(Some(Futures::default()));
        }
        let mut futures = Futures::default();
        if map.unexplored_is_empty() {
            judge(self.algorithm, &exploration, self.facing, &world, &mut self.candidate)?;
            futures.include(&Futures { runs: 1, costs: Costs::nothing() }, 0);
        }
        self.push(Line::Four { state, follows }, world, exploration, futures);
        Ok(None)
    }

    /// Every choice at line 9. As [`Self::line_4`].
    fn line_8(&mut self, world: GraphWorld<'g>, exploration: Exploration) -> Option<Futures> {
        if let Some(known) = self.in_round(exploration.hypotheses()) {
            return Some(known);
        }
        if !self.begin(1) {
            return Some(Futures::default());
        }
        self.push(Line::Eight, world, exploration, Futures::default());
        None
    }

    /// What can follow a choice at the state on top of the stack. As [`Self::line_4`].
    fn after(&mut self, choice: MappingChoice) -> Result<Option<Futures>, Flaw> {
        let Some(frame) = self.stack.last_mut() else { return Ok(None) };
        let (mut world, mut next) = (frame.world.clone(), frame.exploration.clone());
        self.algorithm.step(&mut next, choice, &mut world, &mut ())?;
        frame.moves = next.moves() - frame.exploration.moves();
        let grown = next.map().vertex_count() > frame.exploration.map().vertex_count();
        if matches!(frame.line, Line::Four { .. }) {
            self.rounds.push(Round::default());
        }
        if next.is_at_line_8() {
            return Ok(self.line_8(world, next));
        }
        if !grown {
            return self.line_4(world, next, Follows::Known);
        }
        if let Some(known) = self.in_round(&[]) {
            return Ok(Some(known));
        }
        if !self.begin(1) {
            return Ok(Some(Futures::default()));
        }
        self.line_4(world, next, Follows::NoHypothesis)
    }

    fn push(
        &mut self,
        line: Line,
        world: GraphWorld<'g>,
        exploration: Exploration,
        futures: Futures,
    ) {
        let choices = exploration.open_choices().collect::<Vec<_>>();
        let bytes = 500 + 100 * exploration.map().dart_count() + 20 * choices.len();
        self.bytes += bytes;
        let choices = choices.into_iter();
        self.stack.push(SearchFrame {
            line,
            world,
            exploration,
            choices,
            moves: 0,
            futures,
            bytes,
        });
    }

    /// Removes the state on top of the stack, whose choices were all followed. Returns what can follow it.
    fn leave(&mut self) -> Option<Futures> {
        let SearchFrame { line, world, exploration, futures, bytes, .. } = self.stack.pop()?;
        self.bytes -= bytes;
        match line {
            Line::Eight => self.insert_in_round(exploration.hypotheses(), &futures),
            Line::Four { state, follows } => {
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
            self.insert_in_round(&[], futures);
        }
    }

    fn insert_in_round(&mut self, hypotheses: &[Dart], futures: &Futures) {
        let Some(round) = self.rounds.last_mut() else { return };
        let bytes = 40 + 4 * hypotheses.len() + futures.bytes();
        round.bytes += bytes;
        self.bytes += bytes;
        round.known.insert(hypotheses.to_vec(), futures.clone());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::Algorithm1;

    fn cycle(edges: usize) -> EmbeddedGraph {
        let name = |vertex: usize| format!("v{}", vertex % edges);
        let list = |vertex| (name(vertex), vec![name(vertex + edges - 1), name(vertex + 1)]);
        EmbeddedGraph::from_neighbour_lists(&(0..edges).map(list).collect::<Vec<_>>()).unwrap()
    }

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
            let ways = every_way(&Algorithm1, &cycle(5), Dart(0), budget, watch).unwrap();
            (ways.limit, ways.states + ways.within_rounds <= budget)
        };
        assert_eq!(limit(1000, &()), (None, true));
        assert_eq!(limit(9, &()), (Some(ChoicesLimit::States(9)), true));
        assert_eq!(limit(1000, &Stopped), (Some(ChoicesLimit::Interrupted), true));
    }
}
