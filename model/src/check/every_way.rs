//! An explorer with all choices. Of Algorithm 1: every order at line 5, and at line 9 among the hypotheses that
//! the percept on arrival has not already contradicted. Section 2.3.

use hashbrown::HashMap;
use smallvec::SmallVec;

use super::{ChoicesLimit, Costs, EveryWay, judge, judge::check_moves};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::Watch,
    isomorphism::Candidate,
    mapping::{Explorer, FACING, Flaw, MapWalk, StateLevel},
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
        (graph, facing): (&EmbeddedGraph, Dart),
        memory: &mut SearchMemory<E>,
        watch: &dyn Watch,
    ) -> Result<Option<EveryWay>, Flaw> {
        match self {
            Self::Default => Ok(None),
            Self::All { budget } => {
                every_way_in(memory, new(), (graph, facing), budget, watch).map(Some)
            }
        }
    }
}

/// Runs an explorer on a start with all choices, and judges the end of every run. States that are
/// [compared](Explorer::write_key) are explored once; runs are counted. The search stops after `budget` states,
/// including those within a round, when the states take 1 GiB of memory, or when the watch stops it.
///
/// # Errors
/// Returns the first [`Flaw`].
pub fn every_way<E: Explorer>(
    explorer: E,
    graph: &EmbeddedGraph,
    facing: Dart,
    budget: u64,
    watch: &dyn Watch,
) -> Result<EveryWay, Flaw> {
    every_way_in(&mut SearchMemory::default(), explorer, (graph, facing), budget, watch)
}

fn every_way_in<E: Explorer>(
    memory: &mut SearchMemory<E>,
    mut explorer: E,
    (graph, facing): (&EmbeddedGraph, Dart),
    budget: u64,
    watch: &dyn Watch,
) -> Result<EveryWay, Flaw> {
    memory.known.clear();
    memory.choices.clear();
    let mut world = GraphWorld::with_aid(graph, explorer.aid(), facing);
    let bound = explorer.move_bound(graph.edge_count(), graph.vertex_count());
    explorer.limit_darts(graph.dart_count());
    explorer.begin(&mut world)?;
    let search = Search {
        facing,
        budget,
        watch,
        is_compared: explorer.write_key(&mut memory.key).is_some(),
        begun: [0; 2],
        bytes: 0,
        limit: None,
        rounds: Vec::new(),
        stack: Vec::new(),
        all: Futures::default(),
        memory,
    };
    let ways = search.run(world, Box::new(explorer))?;
    check_moves(ways.costs.max().unwrap_or(0), bound)?;
    Ok(ways)
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

/// A key of a state: a short one needs no memory elsewhere.
type Key = SmallVec<[u32; 6]>;

/// A round: what begins at a state between two rounds, by one choice.
struct Round {
    vertices: usize,
    /// The number of states on the stack when it begins.
    first: usize,
    /// What can follow a state within it, by the hypotheses that are left, if it can be reached in several ways.
    known: HashMap<Key, Futures>,
    bytes: usize,
}

impl Round {
    /// Whether a state within it that is entered on a stack with so many states can be reached in several ways: at least
    /// two hypotheses were rejected, in any order.
    fn meets(&self, stack: usize) -> bool {
        stack >= self.first + 2
    }
}

/// A state whose choices are being followed, one after the other.
struct SearchFrame<'g, E: Explorer> {
    /// Where it is kept when all that can follow it is known; `None` if it is not compared.
    key: Option<(StateLevel, Key)>,
    /// Whether it follows the state within a round in which no hypothesis is left: the place is new.
    is_new_place: bool,
    world: GraphWorld<'g, E::Aid>,
    /// `None` once the last choice was made.
    explorer: Option<Box<E>>,
    /// The vertices and the darts that the explorer knows.
    known: (usize, usize),
    /// Where its choices begin, and the next one, among those of all states on the stack.
    first_choice: usize,
    next_choice: usize,
    moves: u64,
    futures: Futures,
    bytes: usize,
}

impl<E: Explorer> SearchFrame<'_, E> {
    fn is_between_rounds(&self) -> bool {
        matches!(self.key, Some((StateLevel::BetweenRounds, _)))
    }
}

struct Search<'g, 'm, E: Explorer> {
    facing: Dart,
    budget: u64,
    watch: &'m dyn Watch,
    /// Whether equal states are explored once.
    is_compared: bool,
    /// States begun between two rounds, and within one.
    begun: [u64; 2],
    bytes: usize,
    limit: Option<ChoicesLimit>,
    /// The rounds that have begun: one for each state between two rounds on the stack.
    rounds: Vec<Round>,
    stack: Vec<SearchFrame<'g, E>>,
    /// What can follow the first state.
    all: Futures,
    memory: &'m mut SearchMemory<E>,
}

/// What a search knows. The next search uses its memory again.
pub struct SearchMemory<E: Explorer> {
    /// For each state between two rounds, what can follow it, and the robot's pose in the world.
    known: HashMap<Key, (Futures, Dart)>,
    /// The choices of the states on the stack.
    choices: Vec<E::Choice>,
    /// Scratch: the key of the state that is entered.
    key: Vec<u32>,
    /// Explorers whose memory is used again.
    spare: Vec<Box<E>>,
    /// The same of finished rounds.
    spare_rounds: Vec<HashMap<Key, Futures>>,
    candidate: Candidate,
}

impl<E: Explorer> Default for SearchMemory<E> {
    fn default() -> Self {
        Self {
            known: HashMap::new(),
            choices: Vec::new(),
            key: Vec::new(),
            spare: Vec::new(),
            spare_rounds: Vec::new(),
            candidate: Candidate::default(),
        }
    }
}

impl<'g, E: Explorer> Search<'g, '_, E> {
    /// What can follow the first state. The stack is explicit: it is as deep as the run has choices.
    fn run(mut self, world: GraphWorld<'g, E::Aid>, explorer: Box<E>) -> Result<EveryWay, Flaw> {
        self.enter(world, explorer)?;
        while let Some(frame) = self.stack.last_mut() {
            let next = self.memory.choices.get(frame.next_choice).copied();
            frame.next_choice += 1;
            match next.filter(|_| self.limit != Some(ChoicesLimit::Interrupted)) {
                Some(choice) => self.follow(choice)?,
                None => self.leave(),
            }
        }
        let [begun, within_rounds] = self.begun;
        let states = if self.is_compared { self.memory.known.len() as u64 } else { begun };
        let Futures { runs, costs } = self.all;
        Ok(EveryWay { states, within_rounds, runs, costs, limit: self.limit })
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

    /// Enters a state. If what can follow it must be searched for, it is on the stack then.
    fn enter(&mut self, world: GraphWorld<'g, E::Aid>, mut explorer: Box<E>) -> Result<(), Flaw> {
        let level = explorer.write_key(&mut self.memory.key);
        let known = known_size(&*explorer);
        let is_new_place = level == Some(StateLevel::BetweenRounds)
            && self.rounds.last().is_some_and(|last| known.0 > last.vertices);
        if self.is_known(level, is_new_place, &world, &explorer)? {
            self.memory.spare.push(explorer);
            self.end_round();
            return Ok(());
        }
        let first_choice = self.memory.choices.len();
        explorer.add_choices(&mut self.memory.choices)?;
        let choices = self.memory.choices.len() - first_choice;
        let mut futures = Futures::default();
        // At the end of a run there is no choice: then the run is judged.
        if choices == 0 {
            judge(&*explorer, self.facing, &world, &mut self.memory.candidate)?;
            futures = Futures { runs: 1, costs: Costs::nothing() };
        }
        let bytes = 500 + 100 * known.1 + 20 * choices;
        self.bytes += bytes;
        self.stack.push(SearchFrame {
            key: level.map(|level| (level, Key::from_slice(&self.memory.key))),
            is_new_place,
            world,
            explorer: Some(explorer),
            known,
            first_choice,
            next_choice: first_choice,
            moves: 0,
            futures,
            bytes,
        });
        Ok(())
    }

    /// Whether what can follow a state takes no search: if it was searched before, or the search has reached its limit. Then
    /// that can follow the state on top of the stack, too.
    fn is_known(
        &mut self,
        level: Option<StateLevel>,
        is_new_place: bool,
        world: &GraphWorld<'g, E::Aid>,
        explorer: &E,
    ) -> Result<bool, Flaw> {
        let is_within = level == Some(StateLevel::WithinRound);
        if is_within || is_new_place {
            let hypotheses = if is_within { &self.memory.key[..] } else { &[] };
            let round = self.rounds.last().filter(|round| round.meets(self.stack.len()));
            if let Some(futures) = round.and_then(|round| round.known.get(hypotheses)) {
                include(&mut self.stack, &mut self.all, futures);
                return Ok(true);
            }
        }
        if is_new_place && !self.begin(1) {
            return Ok(true);
        }
        if level == Some(StateLevel::BetweenRounds)
            && let Some((futures, image)) = self.memory.known.get(&self.memory.key[..])
        {
            // One state, one place in the world; it may have been entered by another dart.
            let (graph, truly, image) = (world.graph(), world.pose(), *image);
            if graph.vertex(image) != graph.vertex(truly) {
                let believed = explorer.map_walk().map_or(FACING, MapWalk::robot);
                return Err(Flaw::WrongPose { believed, image, truly });
            }
            include(&mut self.stack, &mut self.all, futures);
            if is_new_place {
                let futures = futures.clone();
                self.keep_in_round(Key::new(), futures);
            }
            return Ok(true);
        }
        Ok(!self.begin(usize::from(is_within)))
    }

    /// Makes a choice at the state on top of the stack, and enters the state that follows.
    fn follow(&mut self, choice: E::Choice) -> Result<(), Flaw> {
        let stack = self.stack.len();
        let Some(frame) = self.stack.last_mut() else { return Ok(()) };
        let mut world = frame.world.clone();
        let next = if frame.next_choice == self.memory.choices.len() {
            frame.explorer.take()
        } else if let (Some(explorer), Some(mut spare)) = (&frame.explorer, self.memory.spare.pop())
        {
            spare.clone_from(explorer);
            Some(spare)
        } else {
            frame.explorer.clone()
        };
        let Some(mut next) = next else { return Ok(()) };
        next.step(choice, &mut world)?;
        frame.moves = world.moves() - frame.world.moves();
        if frame.is_between_rounds() {
            let known = self.memory.spare_rounds.pop().unwrap_or_default();
            let (vertices, first) = (frame.known.0, stack);
            self.rounds.push(Round { vertices, first, known, bytes: 0 });
        }
        self.enter(world, next)
    }

    /// Removes the state on top of the stack, whose choices were all followed. What can follow it can follow the one below.
    fn leave(&mut self) {
        let Some(frame) = self.stack.pop() else { return };
        let SearchFrame { key, is_new_place, world, explorer, known, futures, .. } = frame;
        self.memory.choices.truncate(frame.first_choice);
        self.bytes -= frame.bytes;
        include(&mut self.stack, &mut self.all, &futures);
        match key {
            None => {}
            Some((StateLevel::WithinRound, left)) => self.keep_in_round(left, futures),
            Some((StateLevel::BetweenRounds, key)) => {
                self.bytes += 100 + 20 * known.1 + futures.bytes();
                if is_new_place {
                    self.keep_in_round(Key::new(), futures.clone());
                }
                self.memory.known.insert(key, (futures, world.pose()));
            }
        }
        self.memory.spare.extend(explorer);
        self.end_round();
    }

    /// Ends the round that a choice at the state on top of the stack began: what can follow that choice is known.
    fn end_round(&mut self) {
        if self.stack.last().is_some_and(SearchFrame::is_between_rounds)
            && let Some(Round { mut known, bytes, .. }) = self.rounds.pop()
        {
            self.bytes -= bytes;
            known.clear();
            self.memory.spare_rounds.push(known);
        }
    }

    fn keep_in_round(&mut self, hypotheses: Key, futures: Futures) {
        let stack = self.stack.len();
        let Some(round) = self.rounds.last_mut().filter(|round| round.meets(stack)) else { return };
        let bytes = 40 + size_of::<u32>() * hypotheses.len() + futures.bytes();
        round.bytes += bytes;
        self.bytes += bytes;
        round.known.insert(hypotheses, futures);
    }
}

/// What can follow a state can follow the one on top of the stack, too, or all runs if there is none.
fn include<E: Explorer>(stack: &mut [SearchFrame<'_, E>], all: &mut Futures, futures: &Futures) {
    match stack.last_mut() {
        Some(frame) => frame.futures.include(futures, frame.moves),
        None => all.include(futures, 0),
    }
}

/// The vertices and the darts that an explorer knows.
fn known_size(explorer: &impl Explorer) -> (usize, usize) {
    let map = explorer.map_walk().map(MapWalk::map);
    map.map_or((0, 0), |map| (map.vertex_count(), map.dart_count()))
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

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

    /// The states of a start between two rounds, and those within one: for each state between two, and each edge there, the
    /// sets of hypotheses that can be left, and none if the place is new.
    fn states(graph: &EmbeddedGraph) -> [u64; 2] {
        let mut world = GraphWorld::with_aid(graph, DirectionalMarker, Dart(0));
        let mut begin = Algorithm1Run::default();
        begin.begin(&mut world).unwrap();
        let key = |run: &Algorithm1Run| {
            let mut key = Vec::new();
            (run.write_key(&mut key).unwrap(), key)
        };
        let (mut between, mut within) = (HashSet::from([key(&begin).1]), 0);
        let mut open = vec![(begin, world)];
        while let Some((mut begin, world)) = open.pop() {
            for edge in begin.choices().unwrap() {
                let mut left = HashSet::new();
                let mut round = vec![(begin.clone(), world.clone(), edge)];
                while let Some((mut run, mut world, choice)) = round.pop() {
                    run.step(choice, &mut world).unwrap();
                    let (level, key) = key(&run);
                    if level == StateLevel::WithinRound {
                        if left.insert(key) {
                            let choices = run.choices().unwrap();
                            let next = |choice| (run.clone(), world.clone(), choice);
                            round.extend(choices.into_iter().map(next));
                        }
                        continue;
                    }
                    if known_size(&run).0 > known_size(&begin).0 {
                        left.insert(Vec::new());
                    }
                    if between.insert(key) {
                        open.push((run, world));
                    }
                }
                within += left.len() as u64;
            }
        }
        [between.len() as u64, within]
    }

    #[test]
    fn each_state_is_begun_once() {
        let graphs = (1..=3).flat_map(|edges| starts(Class::Multigraph, edges));
        for graph in graphs.chain([EmbeddedGraph::cycle(4), EmbeddedGraph::cycle(5)]) {
            let explorer = Algorithm1Run::default();
            let ways = every_way(explorer, &graph, Dart(0), DEFAULT_STATE_BUDGET, &()).unwrap();
            assert_eq!([ways.states, ways.within_rounds], states(&graph), "{graph:?}");
        }
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

        fn add_choices(&mut self, choices: &mut Vec<MappingChoice>) -> Result<(), InvalidStep> {
            choices.extend(self.run.choices()?.into_iter().map(|choice| match choice {
                MappingChoice::Hypothesis(index) => MappingChoice::Hypothesis(index + self.off),
                edge @ MappingChoice::Edge(_) => edge,
            }));
            Ok(())
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
