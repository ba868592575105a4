//! An explorer with all choices. Of Algorithm 1: every order at line 5, and at line 9 among the hypotheses that
//! the percept on arrival has not already contradicted. Section 2.3.

use std::vec;

use hashbrown::HashMap;

use super::{ChoicesLimit, Costs, EveryWay, judge, judge::check_moves};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::Watch,
    isomorphism::Candidate,
    mapping::{Explorer, FACING, Flaw, MapWalk, StateKey},
    world::GraphWorld,
};

/// The memory that the states of one start may take, in bytes by a generous estimate.
const MAX_BYTES: usize = 1 << 30;

/// The default number of states of one start that may be explored.
pub const DEFAULT_STATE_BUDGET: u64 = 1_000_000;

/// The choices of the runs that are checked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RunChoices {
    /// The default ones: one run.
    #[default]
    Default,
    /// The default ones, and then all: every run.
    All {
        /// The number of states of one start that may be explored.
        budget: u64,
    },
}

impl RunChoices {
    /// Makes and judges the other runs of a start, if they are to be checked.
    ///
    /// # Errors
    /// Returns the first [`Flaw`].
    pub fn others<E: Explorer>(
        self,
        new: impl Fn() -> E,
        graph: &EmbeddedGraph,
        facing: Dart,
        watch: &dyn Watch,
    ) -> Result<Option<EveryWay>, Flaw> {
        match self {
            Self::Default => Ok(None),
            Self::All { budget } => every_way(new(), graph, facing, budget, watch).map(Some),
        }
    }
}

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
    let mut world = GraphWorld::with_aid(graph, explorer.aid(), facing);
    let bound = explorer.move_bound(graph.edge_count(), graph.vertex_count());
    explorer.limit_darts(graph.dart_count());
    explorer.begin(&mut world)?;
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
        spare: Vec::new(),
        spare_rounds: Vec::new(),
        candidate: Candidate::default(),
    };
    let is_compared = explorer.state_key().is_some();
    let Futures { runs, costs } = search.run(world, Box::new(explorer))?;
    check_moves(costs.max().unwrap_or(0), bound)?;
    let [begun, within_rounds] = search.begun;
    let states = if is_compared { search.known.len() as u64 } else { begun };
    Ok(EveryWay { states, within_rounds, runs, costs, limit: search.limit })
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
    vertices: usize,
    /// What can follow each state within it: the hypotheses that are left.
    known: HashMap<Vec<Dart>, Futures>,
    bytes: usize,
}

/// A state whose choices are being followed, one after the other.
struct SearchFrame<'g, E: Explorer> {
    /// Where it is kept when all that can follow it is known; `None` if it is not compared.
    key: Option<StateKey>,
    /// Whether it follows the state within a round in which no hypothesis is left: the place is new.
    is_new_place: bool,
    world: GraphWorld<'g, E::Aid>,
    explorer: Box<E>,
    choices: vec::IntoIter<E::Choice>,
    moves: u64,
    futures: Futures,
    bytes: usize,
}

struct Search<'g, 'w, E: Explorer> {
    facing: Dart,
    budget: u64,
    watch: &'w dyn Watch,
    /// States begun between two rounds, and within one.
    begun: [u64; 2],
    bytes: usize,
    limit: Option<ChoicesLimit>,
    /// For each state between two rounds, what can follow it, and the robot's pose in the world.
    known: HashMap<StateKey, (Futures, Dart)>,
    /// The rounds that have begun: one for each state between two rounds on the stack.
    rounds: Vec<Round>,
    stack: Vec<SearchFrame<'g, E>>,
    /// Explorers whose memory is used again.
    spare: Vec<Box<E>>,
    /// The same of finished rounds.
    spare_rounds: Vec<HashMap<Vec<Dart>, Futures>>,
    candidate: Candidate,
}

impl<'g, E: Explorer> Search<'g, '_, E> {
    /// What can follow the first state. The stack is explicit: it is as deep as the run has choices.
    fn run(&mut self, world: GraphWorld<'g, E::Aid>, explorer: Box<E>) -> Result<Futures, Flaw> {
        let mut found = self.enter(world, explorer)?;
        while let Some(frame) = self.stack.last_mut() {
            if let Some(futures) = found.take() {
                frame.futures.include(&futures, frame.moves);
                if matches!(frame.key, Some(StateKey::Round(_)))
                    && let Some(Round { mut known, bytes, .. }) = self.rounds.pop()
                {
                    self.bytes -= bytes;
                    known.clear();
                    self.spare_rounds.push(known);
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
        world: GraphWorld<'g, E::Aid>,
        mut explorer: Box<E>,
    ) -> Result<Option<Futures>, Flaw> {
        let key = explorer.state_key();
        let vertices = known_size(&*explorer).0;
        let is_new_place = matches!(key, Some(StateKey::Round(_)))
            && self.rounds.last().is_some_and(|last| vertices > last.vertices);
        if let Some(futures) = self.known(key.as_ref(), is_new_place, &world, &explorer)? {
            self.spare.push(explorer);
            return Ok(Some(futures));
        }
        let choices = explorer.choices()?;
        let mut futures = Futures::default();
        // At the end of a run there is no choice: then the run is judged.
        if choices.is_empty() {
            judge(&*explorer, self.facing, &world, &mut self.candidate)?;
            futures.include(&Futures { runs: 1, costs: Costs::nothing() }, 0);
        }
        let bytes = 500 + 100 * known_size(&*explorer).1 + 20 * choices.len();
        self.bytes += bytes;
        let (choices, moves) = (choices.into_iter(), 0);
        let frame =
            SearchFrame { key, is_new_place, world, explorer, choices, moves, futures, bytes };
        self.stack.push(frame);
        Ok(None)
    }

    /// What can follow a state, without a search: if it was searched before, or the search has reached its limit.
    fn known(
        &mut self,
        key: Option<&StateKey>,
        is_new_place: bool,
        world: &GraphWorld<'g, E::Aid>,
        explorer: &E,
    ) -> Result<Option<Futures>, Flaw> {
        let mut level = 0;
        if let Some(StateKey::WithinRound(hypotheses)) = key {
            if let Some(known) = self.in_round(hypotheses) {
                return Ok(Some(known));
            }
            level = 1;
        }
        if is_new_place {
            if let Some(known) = self.in_round(&[]) {
                return Ok(Some(known));
            }
            if !self.begin(1) {
                return Ok(Some(Futures::default()));
            }
        }
        if let Some((futures, image)) = key.and_then(|key| self.known.get(key)) {
            // One state, one place in the world; it may have been entered by another dart.
            let (graph, truly, image) = (world.graph(), world.pose(), *image);
            if graph.vertex(image) != graph.vertex(truly) {
                let believed = explorer.map_walk().map_or(FACING, MapWalk::robot);
                return Err(Flaw::WrongPose { believed, image, truly });
            }
            let futures = futures.clone();
            self.keep_new_place(is_new_place, &futures);
            return Ok(Some(futures));
        }
        Ok((!self.begin(level)).then(Futures::default))
    }

    /// What can follow a choice at the state on top of the stack. As [`Self::enter`].
    fn follow(&mut self, choice: E::Choice) -> Result<Option<Futures>, Flaw> {
        let Some(frame) = self.stack.last_mut() else { return Ok(None) };
        let mut world = frame.world.clone();
        let mut next = match self.spare.pop() {
            Some(mut spare) => {
                spare.clone_from(&frame.explorer);
                spare
            }
            None => frame.explorer.clone(),
        };
        next.step(choice, &mut world)?;
        frame.moves = world.moves() - frame.world.moves();
        if let Some(StateKey::Round(_)) = &frame.key {
            let vertices = known_size(&*frame.explorer).0;
            let known = self.spare_rounds.pop().unwrap_or_default();
            self.rounds.push(Round { vertices, known, bytes: 0 });
        }
        self.enter(world, next)
    }

    /// Removes the state on top of the stack, whose choices were all followed. Returns what can follow it.
    fn leave(&mut self) -> Option<Futures> {
        let SearchFrame { key, is_new_place, world, explorer, futures, bytes, .. } =
            self.stack.pop()?;
        self.bytes -= bytes;
        match key {
            None => {}
            Some(StateKey::WithinRound(hypotheses)) => self.keep_in_round(hypotheses, &futures),
            Some(key) => {
                self.bytes += 100 + 20 * known_size(&*explorer).1 + futures.bytes();
                self.known.insert(key, (futures.clone(), world.pose()));
                self.keep_new_place(is_new_place, &futures);
            }
        }
        self.spare.push(explorer);
        Some(futures)
    }

    fn in_round(&self, hypotheses: &[Dart]) -> Option<Futures> {
        self.rounds.last()?.known.get(hypotheses).cloned()
    }

    fn keep_new_place(&mut self, is_new_place: bool, futures: &Futures) {
        if is_new_place {
            self.keep_in_round(Vec::new(), futures);
        }
    }

    fn keep_in_round(&mut self, hypotheses: Vec<Dart>, futures: &Futures) {
        let Some(round) = self.rounds.last_mut() else { return };
        let bytes = 40 + 4 * hypotheses.len() + futures.bytes();
        round.bytes += bytes;
        self.bytes += bytes;
        round.known.insert(hypotheses, futures.clone());
    }
}

/// The vertices and the darts that an explorer knows.
fn known_size(explorer: &impl Explorer) -> (usize, usize) {
    let map = explorer.map_walk().map(MapWalk::map);
    map.map_or((0, 0), |map| (map.vertex_count(), map.dart_count()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        any_graph::{StopAt, starts},
        check::smallest_failure::delegate_to_run,
        enumerate::Class,
        mapping::{Algorithm1Run, InvalidStep, Mapped, MappingChoice, MappingError, ObservedWorld},
        marker::DirectionalMarker,
    };

    #[test]
    fn a_search_that_is_stopped_says_so() {
        let cycle = EmbeddedGraph::cycle(5);
        let stopped = StopAt::new(1);
        let ways = every_way(Algorithm1Run::default(), &cycle, Dart(0), 1000, &stopped).unwrap();
        assert_eq!(ways.limit, Some(ChoicesLimit::Interrupted));
    }

    /// Algorithm 1 with other choices, or with another bound.
    #[derive(Clone)]
    struct Altered {
        /// By how much the numbers of hypotheses are off.
        off: usize,
        /// It claims to need no more moves than these.
        claimed: u64,
        run: Algorithm1Run,
    }

    impl Explorer for Altered {
        delegate_to_run!(DirectionalMarker, MappingChoice);

        fn choices(&mut self) -> Result<Vec<MappingChoice>, InvalidStep> {
            let choices = self.run.choices()?.into_iter().map(|choice| match choice {
                MappingChoice::Hypothesis(index) => MappingChoice::Hypothesis(index + self.off),
                edge @ MappingChoice::Edge(_) => edge,
            });
            Ok(choices.collect())
        }

        fn step<W: ObservedWorld>(&mut self, choice: MappingChoice, world: &mut W) -> Mapped<W> {
            self.run.step(choice, world)
        }

        fn move_bound(&self, _: usize, _: usize) -> u64 {
            self.claimed
        }
    }

    fn altered(graph: &EmbeddedGraph, off: usize, claimed: u64) -> Result<EveryWay, Flaw> {
        let run = Altered { off, claimed, run: Algorithm1Run::default() };
        every_way(run, graph, Dart(0), DEFAULT_STATE_BUDGET, &())
    }

    /// Choices that are not open are an error. They are not replaced by others, with less coverage.
    #[test]
    fn a_broken_enumeration_of_choices_fails() {
        let graphs = starts(Class::Multigraph, 3);
        let flaws: Vec<_> =
            graphs.iter().filter_map(|graph| altered(graph, 1, u64::MAX).err()).collect();
        assert!(!flaws.is_empty());
        for flaw in flaws {
            let Flaw::Error(MappingError::InvalidStep(InvalidStep::NoHypothesis { index, left })) =
                flaw
            else {
                panic!("{flaw}")
            };
            assert_eq!(index, left);
        }
    }

    /// States are explored once, so the run with the most moves may be none that was followed to its end.
    #[test]
    fn the_most_moves_of_all_runs_are_compared_with_the_bound() {
        for graph in (1..=3).flat_map(|edges| starts(Class::Multigraph, edges)) {
            let moves = altered(&graph, 0, u64::MAX).unwrap().costs.max().unwrap();
            assert!(altered(&graph, 0, moves).is_ok());
            let bound = moves - 1;
            let flaw = Flaw::TooManyMoves { moves, bound };
            assert_eq!(altered(&graph, 0, bound), Err(flaw));
        }
    }
}
