//! The folding explorer: mapping with a directional marker, in fewer moves than Algorithm 1.
//!
//! Its map is the [folded trail](crate::folding). It ends when no dart is open, and the folded trail is
//! then the world. So two places are only ever proved to be *one*; that they are two follows at the
//! end. The robot keeps a *core* of places that are pairwise distinct, and *pending* places behind core
//! darts. A *hypothesis* is that a pending place is entered by a certain core dart. It is alive as long
//! as the trail with the two poses united does not contradict itself.

use std::{collections::VecDeque, mem};

use super::{Contradiction, InvalidStep, MappingError};
use crate::{
    embedded_graph::Dart,
    folding::{FoldedTrail, MAX_DARTS, TrailError},
    percept::{Door, Percept, Sighting},
    world::World,
};

/// How many times nearer an open core dart must be than the marker is by the cheapest test, to be taken
/// first.
const EXPLORE_FACTOR: usize = 4;

/// The number of a dart of the core: those of one core place after those of the earlier ones, clockwise
/// from the dart by which the place was first entered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct CoreDart(u32);

impl CoreDart {
    fn at(self) -> usize {
        self.0 as usize
    }
}

/// A pending place: the far end of an edge of the core that is not a core place.
#[derive(Clone, Copy, Debug)]
struct Pending {
    /// The core dart that leads there.
    edge: CoreDart,
    /// The pose behind it.
    far: Dart,
}

/// A walk that confirms a hypothesis if it ends at the marker.
#[derive(Clone, Copy, Debug)]
struct Test {
    pending: Pending,
    hypothesis: CoreDart,
    /// The open dart that is taken.
    open: Dart,
    /// The core dart by which the robot then comes in, if the hypothesis is true.
    entry: CoreDart,
    /// The moves to the marker.
    cost: usize,
}

/// What the robot does next.
#[derive(Clone, Copy, Debug)]
enum Plan {
    /// It takes an open dart.
    Explore(Dart),
    /// It tests a hypothesis.
    Test(Test),
}

/// A shortest way to a vertex: its moves, and the dart by which it comes in.
#[derive(Clone, Copy, Debug)]
struct Way {
    moves: usize,
    entry: Dart,
}

/// The core: places that are pairwise distinct, as far as the folding proves by what is not possible.
#[derive(Clone, Debug, Default)]
struct Core {
    /// The first dart of each place.
    first: Vec<CoreDart>,
    /// The place of each dart.
    place: Vec<usize>,
    /// Each dart, as a dart of the trail.
    darts: Vec<Dart>,
    /// The place of each trail vertex that is a root.
    place_of: Vec<Option<usize>>,
    /// For each place, the moves of a shortest way to the marker through the core, and the dart by which
    /// it leaves.
    to_marker: Vec<Option<(usize, CoreDart)>>,
    queue: VecDeque<usize>,
}

/// The state of a run of the folding explorer. Memory is reused from run to run.
#[derive(Clone, Debug, Default)]
pub struct FoldingExploration {
    /// Whether it only makes strict tests.
    strict: bool,
    trail: FoldedTrail,
    core: Core,
    /// The core darts that do not lead to a core place.
    unresolved: Vec<CoreDart>,
    pending: Vec<Pending>,
    refuted: RefutedHypotheses,
    /// For each core dart, a hypothesis about its far end that was alive.
    witness: Vec<Option<CoreDart>>,
    /// A shortest way from the robot to each trail vertex that is a root.
    from_robot: Vec<Option<Way>>,
    queue: VecDeque<Dart>,
    /// For each dart that is an open dart of a root, the moves from the robot to it.
    open: Vec<Option<usize>>,
    tests: Vec<Test>,
    leaving: Vec<Dart>,
}

/// The hypotheses that are refuted. They stay so, because a trail only grows.
#[derive(Clone, Debug, Default)]
struct RefutedHypotheses {
    bits: Vec<u64>,
}

impl RefutedHypotheses {
    /// A number for each pair, so that those of the first `n` numbers are the first `n^2`.
    fn index(edge: CoreDart, dart: CoreDart) -> usize {
        let (edge, dart) = (edge.at(), dart.at());
        if edge < dart { dart * dart + edge } else { edge * edge + edge + dart }
    }

    fn contains(&self, edge: CoreDart, dart: CoreDart) -> bool {
        let index = Self::index(edge, dart);
        self.bits.get(index / 64).is_some_and(|bits| bits >> (index % 64) & 1 == 1)
    }

    fn insert(&mut self, edge: CoreDart, dart: CoreDart) {
        let index = Self::index(edge, dart);
        if self.bits.len() <= index / 64 {
            self.bits.resize(index / 64 + 1, 0);
        }
        self.bits[index / 64] |= 1 << (index % 64);
    }
}

/// Maps a world with the folding explorer. At its start the robot stands at the marked vertex, with its
/// back to the facing door. Afterwards the exploration's trail is
/// [complete](FoldedTrail::is_complete): it is the map.
///
/// # Errors
/// Returns an error if the world does, if it contradicts itself, or if the trail has too many darts.
pub fn map_by_folding<W: World>(
    world: &mut W,
    exploration: &mut FoldingExploration,
) -> Result<(), MappingError<W::Error>> {
    exploration.begin(world)?;
    while let Some(plan) = exploration.plan() {
        match plan {
            Plan::Explore(open) => exploration.explore(open, world)?,
            Plan::Test(test) => exploration.test(test, world)?,
        }
    }
    if exploration.trail.is_complete() { Ok(()) } else { Err(InvalidStep::NoPlan.into()) }
}

impl Core {
    fn clear(&mut self) {
        self.first.clear();
        self.place.clear();
        self.darts.clear();
    }

    /// Adds the place of a pose.
    fn add(&mut self, trail: &FoldedTrail, pose: Dart) {
        let place = self.first.len();
        self.first.push(CoreDart(self.darts.len() as u32));
        for door in 0..trail.degree(pose) {
            self.place.push(place);
            self.darts.push(trail.behind(pose, Door(door)));
        }
    }

    fn dart(&self, dart: CoreDart) -> Dart {
        self.darts[dart.at()]
    }

    fn place(&self, dart: CoreDart) -> usize {
        self.place[dart.at()]
    }

    /// The pose by which a place was first entered.
    fn pose(&self, place: usize) -> Dart {
        self.dart(self.first[place])
    }

    fn all(&self) -> impl Iterator<Item = CoreDart> + use<> {
        (0..self.darts.len() as u32).map(CoreDart)
    }

    /// Marks the classes of the trail that are core places.
    fn mark(&mut self, trail: &FoldedTrail) {
        let mut place_of = mem::take(&mut self.place_of);
        place_of.clear();
        place_of.resize(trail.trail_vertex_count(), None);
        for place in 0..self.first.len() {
            place_of[trail.vertex(self.pose(place))] = Some(place);
        }
        self.place_of = place_of;
    }

    /// The core dart that a dart of a trail is, if its class is [marked](Self::mark).
    fn number(&self, trail: &FoldedTrail, dart: Dart) -> Option<CoreDart> {
        let place = self.place_of[trail.vertex(dart)]?;
        Some(CoreDart(self.first[place].0 + trail.door(self.pose(place), dart).0))
    }

    /// The core dart at the other end of a dart's edge.
    fn opposite(&self, trail: &FoldedTrail, dart: CoreDart) -> Option<CoreDart> {
        self.number(trail, trail.opposite(self.dart(dart))?)
    }

    /// A breadth-first search through the core, from the marker, which lies at the first place.
    fn find_ways_to_marker(&mut self, trail: &FoldedTrail) {
        self.to_marker.clear();
        self.to_marker.resize(self.first.len(), None);
        self.to_marker[0] = Some((0, CoreDart(0)));
        let mut queue = mem::take(&mut self.queue);
        queue.clear();
        queue.push_back(0);
        while let Some(place) = queue.pop_front() {
            let moves = self.to_marker[place].map_or(0, |(moves, _)| moves) + 1;
            let first = self.first[place].0;
            for dart in first..first + trail.degree(self.pose(place)) {
                let Some(entry) = self.opposite(trail, CoreDart(dart)) else { continue };
                let way = &mut self.to_marker[self.place[entry.at()]];
                if way.is_none() {
                    *way = Some((moves, entry));
                    queue.push_back(self.place(entry));
                }
            }
        }
        self.queue = queue;
    }
}

impl FoldingExploration {
    /// An exploration that only makes strict tests: from the place itself, along the whole way to the
    /// marker, as Algorithm 1 does. It needs more moves.
    #[must_use]
    pub fn strict() -> Self {
        Self { strict: true, ..Self::default() }
    }

    /// The folded trail.
    #[must_use]
    pub fn trail(&self) -> &FoldedTrail {
        &self.trail
    }

    /// The first core place is the marker's.
    fn begin<W: World>(&mut self, world: &mut W) -> Result<(), MappingError<W::Error>> {
        let percept = world.percept().map_err(MappingError::World)?;
        if percept.sighting != Sighting::Pointing(Door::BACK) {
            return Err(Contradiction::Start { perceived: percept }.into());
        }
        self.trail.restart(percept)?;
        self.refuted.bits.clear();
        self.witness.clear();
        self.core.clear();
        self.core.add(&self.trail, self.trail.pose());
        Ok(())
    }

    /// What to do next; `None` if no dart is open.
    fn plan(&mut self) -> Option<Plan> {
        self.promote();
        if self.trail.open_count() == 0 {
            return None;
        }
        self.find_ways_from_robot();
        let moves_to = |dart: Dart| self.way_to(dart).map(|way| way.moves);
        let open = self
            .core
            .darts
            .iter()
            .filter(|&&dart| self.trail.opposite(dart).is_none())
            .filter_map(|&dart| Some((moves_to(dart)?, dart)))
            .min_by_key(|&(moves, _)| moves);
        let nearest = self
            .pending
            .iter()
            .filter_map(|&pending| Some((moves_to(pending.far)?, pending)))
            .min_by_key(|&(moves, _)| moves);
        let late = self.strict || self.trail.moves() > self.patience();
        let test = nearest.and_then(|(_, pending)| {
            self.core.find_ways_to_marker(&self.trail);
            let strict = if late { self.strict_test(pending) } else { None };
            strict.or_else(|| self.cheapest_test(pending))
        });
        match (open, test) {
            (_, Some(test)) if late => Some(Plan::Test(test)),
            (Some((moves, open)), Some(test)) if EXPLORE_FACTOR * moves < test.cost => {
                Some(Plan::Explore(open))
            }
            (_, Some(test)) => Some(Plan::Test(test)),
            (Some((_, open)), None) => Some(Plan::Explore(open)),
            (None, None) => None,
        }
    }

    /// The number of moves after which the robot only makes strict tests, `4 n m + 200` for `n` core places
    /// and `m` edges. A strict test takes at most as many moves as a validation of Algorithm 1.
    fn patience(&self) -> usize {
        2 * self.core.first.len() * self.core.darts.len() + 200
    }

    /// Finds the pending places. Those without a living hypothesis join the core.
    fn promote(&mut self) {
        loop {
            self.core.mark(&self.trail);
            self.unresolved.clear();
            self.pending.clear();
            for edge in self.core.all() {
                let far = self.trail.opposite(self.core.dart(edge));
                if far.is_some_and(|far| self.core.place_of[self.trail.vertex(far)].is_some()) {
                    continue;
                }
                self.unresolved.push(edge);
                if let Some(far) = far {
                    self.pending.push(Pending { edge, far });
                }
            }
            let pending = mem::take(&mut self.pending);
            let new = pending.iter().find(|&&pending| !self.has_hypothesis(pending)).copied();
            self.pending = pending;
            let Some(new) = new else { return };
            self.core.add(&self.trail, new.far);
        }
    }

    fn has_hypothesis(&mut self, pending: Pending) -> bool {
        self.witness.resize(self.core.darts.len(), None);
        if let Some(witness) = self.witness[pending.edge.at()]
            && self.is_alive(pending, witness)
        {
            return true;
        }
        let all = mem::take(&mut self.unresolved);
        let alive = all.iter().find(|&&dart| self.is_alive(pending, dart)).copied();
        self.unresolved = all;
        self.witness[pending.edge.at()] = alive;
        alive.is_some()
    }

    /// Whether a pending place may be entered by a core dart.
    fn is_alive(&mut self, pending: Pending, dart: CoreDart) -> bool {
        if self.refuted.contains(pending.edge, dart) {
            return false;
        }
        let one = self.core.dart(dart);
        let alive = self.trail.with_united(pending.far, one, |_| ()).is_ok();
        if !alive {
            self.refuted.insert(pending.edge, dart);
        }
        alive
    }

    /// The cheapest walk that confirms a hypothesis about a place if it ends at the marker. Of walks of
    /// one cost it is that with the first hypothesis, and the first open dart of the trail.
    fn cheapest_test(&mut self, pending: Pending) -> Option<Test> {
        let mut open = mem::take(&mut self.open);
        open.clear();
        open.resize(self.trail.dart_count(), None);
        for first in self.trail.vertices() {
            let Some(Way { moves, .. }) = self.way_to(first) else { continue };
            for dart in self.trail.darts_around(first) {
                open[dart.at()] = self.trail.opposite(dart).is_none().then_some(moves);
            }
        }
        let (mut tests, all) = (mem::take(&mut self.tests), mem::take(&mut self.unresolved));
        tests.clear();
        for &hypothesis in &all {
            if self.refuted.contains(pending.edge, hypothesis) {
                continue;
            }
            let target = self.core.dart(hypothesis);
            let core = &mut self.core;
            let united = self.trail.with_united(pending.far, target, |united| {
                core.mark(united);
                for dart in united.merged_darts() {
                    let Some(moves) = open[dart.at()] else { continue };
                    let entry = united.opposite(dart).and_then(|far| core.number(united, far));
                    let Some(entry) = entry else { continue };
                    let Some((rest, _)) = core.to_marker[core.place(entry)] else { continue };
                    let cost = moves + 1 + rest;
                    tests.push(Test { pending, hypothesis, open: dart, entry, cost });
                }
            });
            if united.is_err() {
                self.refuted.insert(pending.edge, hypothesis);
            }
        }
        tests.sort_by_key(|test| (test.cost, test.hypothesis, test.open));
        let found = tests.iter().find(|test| self.confirms(test)).copied();
        (self.open, self.tests, self.unresolved) = (open, tests, all);
        found
    }

    /// The walk from a pending place along the way to the marker that the first hypothesis predicts, as
    /// in Algorithm 1.
    fn strict_test(&mut self, pending: Pending) -> Option<Test> {
        let all = mem::take(&mut self.unresolved);
        let hypothesis = all.iter().copied().find(|&dart| self.is_alive(pending, dart));
        self.unresolved = all;
        let hypothesis = hypothesis?;
        let (mut pose, mut believed) = (pending.far, hypothesis);
        loop {
            let (cost @ 1.., leaving) = self.core.to_marker[self.core.place(believed)]? else {
                return None;
            };
            let entry = self.core.opposite(&self.trail, leaving)?;
            let (from, to) = (self.core.dart(believed), self.core.dart(leaving));
            let open = self.trail.behind(pose, self.trail.door(from, to));
            match self.trail.opposite(open) {
                None => return Some(Test { pending, hypothesis, open, entry, cost }),
                Some(next) => (pose, believed) = (next, entry),
            }
        }
    }

    /// Whether the success of a test forces its hypothesis.
    fn confirms(&mut self, test: &Test) -> bool {
        let Some(leaving) = self.trail.opposite(self.core.dart(test.entry)) else { return false };
        let (far, target) = (test.pending.far, self.core.dart(test.hypothesis));
        let forced = self.trail.with_united(test.open, leaving, |united| {
            united.root_of(far) == united.root_of(target)
        });
        forced == Ok(true)
    }

    /// A breadth-first search through the trail, from the robot.
    fn find_ways_from_robot(&mut self) {
        let Self { trail, from_robot, queue, .. } = self;
        from_robot.clear();
        from_robot.resize(trail.trail_vertex_count(), None);
        let pose = trail.pose();
        from_robot[trail.vertex(pose)] = Some(Way { moves: 0, entry: pose });
        queue.clear();
        queue.push_back(pose);
        while let Some(pose) = queue.pop_front() {
            let moves = from_robot[trail.vertex(pose)].map_or(0, |way| way.moves) + 1;
            for dart in trail.darts_around(pose) {
                let Some(entry) = trail.opposite(dart) else { continue };
                let way = &mut from_robot[trail.vertex(entry)];
                if way.is_none() {
                    *way = Some(Way { moves, entry });
                    queue.push_back(entry);
                }
            }
        }
    }

    fn way_to(&self, dart: Dart) -> Option<Way> {
        self.from_robot[self.trail.vertex(dart)]
    }

    /// Walks through the trail to a vertex.
    fn walk_to<W: World>(
        &mut self,
        dart: Dart,
        world: &mut W,
    ) -> Result<(), MappingError<W::Error>> {
        let mut leaving = mem::take(&mut self.leaving);
        leaving.clear();
        let mut at = dart;
        while let Some(Way { moves: 1.., entry }) = self.way_to(at)
            && let Some(before) = self.trail.opposite(entry)
        {
            leaving.push(before);
            at = before;
        }
        for &dart in leaving.iter().rev() {
            self.take(dart, world)?;
        }
        self.leaving = leaving;
        Ok(())
    }

    /// Takes a dart of the robot's vertex, and returns the percept behind it.
    fn take<W: World>(
        &mut self,
        dart: Dart,
        world: &mut W,
    ) -> Result<Percept, MappingError<W::Error>> {
        let door = self.trail.door(self.trail.pose(), dart);
        world.traverse(door).map_err(MappingError::World)?;
        let percept = world.percept().map_err(MappingError::World)?;
        self.trail.step(door, percept)?;
        Ok(percept)
    }

    /// Goes to an open dart and takes it.
    fn explore<W: World>(
        &mut self,
        open: Dart,
        world: &mut W,
    ) -> Result<(), MappingError<W::Error>> {
        self.walk_to(open, world)?;
        self.take(open, world).map(|_| ())
    }

    /// Walks to the marker as if a hypothesis were true, until it is confirmed or refuted.
    fn test<W: World>(&mut self, test: Test, world: &mut W) -> Result<(), MappingError<W::Error>> {
        self.walk_to(test.open, world)?;
        let mut percept = self.take(test.open, world)?;
        let mut believed = test.entry;
        while percept.sighting == Sighting::Nothing && self.is_undecided(&test) {
            let place = self.core.place(believed);
            let Some((1.., leaving)) = self.core.to_marker[place] else { break };
            let leaving = self.core.dart(leaving);
            let Some(next) = self.trail.opposite(leaving) else { break };
            let door = self.trail.door(self.core.dart(believed), leaving);
            self.core.mark(&self.trail);
            let Some(entry) = self.core.number(&self.trail, next) else { break };
            believed = entry;
            percept = self.take(self.trail.behind(self.trail.pose(), door), world)?;
        }
        Ok(())
    }

    /// Whether a hypothesis is neither confirmed nor refuted.
    fn is_undecided(&mut self, test: &Test) -> bool {
        let target = self.core.dart(test.hypothesis);
        self.trail.root_of(test.pending.far) != self.trail.root_of(target)
            && self.is_alive(test.pending, test.hypothesis)
    }
}

impl<E> From<TrailError> for MappingError<E> {
    fn from(error: TrailError) -> Self {
        match error {
            TrailError::Contradiction(reason) => Contradiction::Trail(reason).into(),
            TrailError::TooManyDarts => Self::Bound { bound: MAX_DARTS },
        }
    }
}
