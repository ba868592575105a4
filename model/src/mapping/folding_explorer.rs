//! The folding explorer: mapping with a directional marker, in fewer moves than Algorithm 1.
//!
//! Its map is the [folded trail](crate::folding). It ends when no dart is open, and the folded trail is
//! then the world. So two places are only ever proved to be *one*; that they are two follows at the
//! end. The robot keeps a *core* of places that are pairwise distinct, and *pending* places behind core
//! darts. A *hypothesis* is that a pending place is entered by a certain core dart. It is alive as long
//! as the trail with the two poses united does not contradict itself.

use std::collections::{HashSet, VecDeque};

use super::{Contradiction, MappingError};
use crate::{
    embedded_graph::Dart,
    folding::{FoldedTrail, MAX_DARTS, TrailError},
    percept::{Door, Percept, Sighting},
    world::World,
};

/// How many times nearer an open core dart must be than the cheapest test, to be taken first.
const EXPLORE_FACTOR: usize = 4;

/// A dart of the core: a core place, and the index clockwise from the dart by which it was entered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
struct CoreDart {
    place: usize,
    index: u32,
}

/// A pending place: the far end of an edge of the core that is not a core place.
#[derive(Clone, Copy, Debug)]
struct Pending {
    /// The core dart that leads there.
    edge: CoreDart,
    /// The pose behind it, as a dart of a root.
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

/// The state of a run of the folding explorer.
#[derive(Clone, Debug, Default)]
pub struct FoldingExploration {
    trail: FoldedTrail,
    /// The pose by which each core place was first entered.
    core: Vec<Dart>,
    /// Hypotheses that are refuted: pending edges and core darts.
    refuted: HashSet<(CoreDart, CoreDart)>,
    /// The core place of each trail vertex that is a root.
    core_of: Vec<Option<usize>>,
    /// A shortest way from the robot to each trail vertex that is a root.
    from_robot: Vec<Option<Way>>,
    queue: VecDeque<Dart>,
    /// For each core place, the moves of a shortest way to the marker through the core, and the index
    /// of the dart by which it leaves.
    to_marker: Vec<Option<(usize, u32)>>,
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
    Ok(())
}

impl FoldingExploration {
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
        self.trail = FoldedTrail::new(percept)?;
        self.core = vec![self.trail.pose()];
        self.refuted.clear();
        Ok(())
    }

    /// What to do next; `None` if no dart is open.
    fn plan(&mut self) -> Option<Plan> {
        let pending = self.promote();
        if self.trail.open_count() == 0 {
            return None;
        }
        self.find_ways_from_robot();
        let moves_to = |dart: Dart| self.way_to(dart).map(|way| way.moves);
        let core_darts = self.core_darts();
        let open = core_darts
            .iter()
            .map(|&dart| self.dart(dart))
            .filter(|&dart| self.trail.opposite(dart).is_none())
            .filter_map(|dart| Some((moves_to(dart)?, dart)))
            .min_by_key(|&(moves, _)| moves);
        let nearest = pending
            .into_iter()
            .filter_map(|pending| Some((moves_to(pending.far)?, pending)))
            .min_by_key(|&(moves, _)| moves);
        let test = nearest.and_then(|(_, pending)| self.cheapest_test(pending));
        match (open, test) {
            (Some((moves, open)), Some(test)) if EXPLORE_FACTOR * moves < test.cost => {
                Some(Plan::Explore(open))
            }
            (_, Some(test)) => Some(Plan::Test(test)),
            (Some((_, open)), None) => Some(Plan::Explore(open)),
            (None, None) => None,
        }
    }

    /// Adds the pending places without a living hypothesis to the core, and returns the others.
    fn promote(&mut self) -> Vec<Pending> {
        'core: loop {
            self.mark_core();
            let mut all = Vec::new();
            for edge in self.core_darts() {
                let Some(far) = self.trail.opposite(self.dart(edge)) else { continue };
                if self.core_place(far).is_some() {
                    continue;
                }
                let pending = Pending { edge, far };
                if !self.has_hypothesis(pending) {
                    self.core.push(far);
                    continue 'core;
                }
                all.push(pending);
            }
            return all;
        }
    }

    fn mark_core(&mut self) {
        self.core_of.clear();
        self.core_of.resize(self.trail.trail_vertex_count(), None);
        for (place, &pose) in self.core.iter().enumerate() {
            self.core_of[self.trail.vertex(pose)] = Some(place);
        }
    }

    fn core_place(&self, dart: Dart) -> Option<usize> {
        self.core_of[self.trail.vertex(dart)]
    }

    fn core_darts(&self) -> Vec<CoreDart> {
        let mut all = Vec::new();
        for (place, &pose) in self.core.iter().enumerate() {
            all.extend((0..self.trail.degree(pose)).map(|index| CoreDart { place, index }));
        }
        all
    }

    fn dart(&self, CoreDart { place, index }: CoreDart) -> Dart {
        self.trail.behind(self.core[place], Door(index))
    }

    /// Core darts that do not lead to a core place.
    fn unresolved(&self) -> impl Iterator<Item = CoreDart> {
        let leads_on = |&dart: &CoreDart| {
            self.trail.opposite(self.dart(dart)).is_none_or(|far| self.core_place(far).is_none())
        };
        self.core_darts().into_iter().filter(leads_on)
    }

    fn has_hypothesis(&mut self, pending: Pending) -> bool {
        let all: Vec<CoreDart> = self.unresolved().collect();
        all.into_iter().any(|dart| self.is_alive(pending, dart))
    }

    /// Whether a pending place may be entered by a core dart.
    fn is_alive(&mut self, pending: Pending, dart: CoreDart) -> bool {
        if self.refuted.contains(&(pending.edge, dart)) {
            return false;
        }
        let one = self.dart(dart);
        let alive = self.trail.with_united(pending.far, one, |_| ()).is_ok();
        if !alive {
            self.refuted.insert((pending.edge, dart));
        }
        alive
    }

    /// The cheapest walk that confirms a hypothesis about a place if it ends at the marker.
    fn cheapest_test(&mut self, pending: Pending) -> Option<Test> {
        self.find_ways_to_marker();
        let open: Vec<(usize, Dart)> = self
            .trail
            .vertices()
            .flat_map(|first| self.trail.darts_around(first))
            .filter(|&dart| self.trail.opposite(dart).is_none())
            .filter_map(|dart| Some((self.way_to(dart)?.moves, dart)))
            .collect();
        let mut tests: Vec<Test> = Vec::new();
        for hypothesis in self.unresolved().collect::<Vec<_>>() {
            if !self.is_alive(pending, hypothesis) {
                continue;
            }
            let target = self.dart(hypothesis);
            let (core, to_marker) = (&self.core, &self.to_marker);
            let found = self.trail.with_united(pending.far, target, |united| {
                let mut core_of = vec![None; united.trail_vertex_count()];
                for (place, &pose) in core.iter().enumerate() {
                    core_of[united.vertex(pose)] = Some(place);
                }
                for &(moves, open) in &open {
                    let Some(far) = united.opposite(open) else { continue };
                    let Some(place) = core_of[united.vertex(far)] else { continue };
                    let Some((rest, _)) = to_marker[place] else { continue };
                    let entry = CoreDart { place, index: united.door(core[place], far).0 };
                    let cost = moves + 1 + rest;
                    tests.push(Test { pending, hypothesis, open, entry, cost });
                }
            });
            debug_assert!(found.is_ok(), "the hypothesis is alive");
        }
        tests.sort_by_key(|test| test.cost);
        tests.into_iter().find(|test| self.confirms(test))
    }

    /// Whether the success of a test forces its hypothesis.
    fn confirms(&mut self, test: &Test) -> bool {
        let entry = self.dart(test.entry);
        let Some(leaving) = self.trail.opposite(entry) else { return false };
        let (far, target) = (test.pending.far, self.dart(test.hypothesis));
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

    /// A breadth-first search through the core, from the marker, which lies at the first core place.
    fn find_ways_to_marker(&mut self) {
        self.to_marker.clear();
        self.to_marker.resize(self.core.len(), None);
        self.to_marker[0] = Some((0, 0));
        let mut queue = VecDeque::from([0]);
        while let Some(place) = queue.pop_front() {
            let moves = self.to_marker[place].map_or(0, |(moves, _)| moves) + 1;
            for index in 0..self.trail.degree(self.core[place]) {
                let dart = self.dart(CoreDart { place, index });
                let Some(far) = self.trail.opposite(dart) else { continue };
                let Some(next) = self.core_place(far) else { continue };
                if self.to_marker[next].is_none() {
                    let leaving = self.trail.door(self.core[next], far).0;
                    self.to_marker[next] = Some((moves, leaving));
                    queue.push_back(next);
                }
            }
        }
    }

    /// Walks through the trail to a vertex.
    fn walk_to<W: World>(
        &mut self,
        dart: Dart,
        world: &mut W,
    ) -> Result<(), MappingError<W::Error>> {
        let mut leaving = Vec::new();
        let mut at = dart;
        while let Some(way) = self.way_to(at)
            && way.moves > 0
            && let Some(before) = self.trail.opposite(way.entry)
        {
            leaving.push(before);
            at = before;
        }
        for dart in leaving.into_iter().rev() {
            self.take(dart, world)?;
        }
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
        while percept.sighting == Sighting::Nothing && self.is_open(&test) {
            let Some((1.., leaving)) = self.to_marker[believed.place] else { break };
            let dart = CoreDart { place: believed.place, index: leaving };
            let door = self.trail.door(self.dart(believed), self.dart(dart));
            let leaving = self.trail.behind(self.trail.pose(), door);
            let Some(next) = self.trail.opposite(self.dart(dart)) else { break };
            self.mark_core();
            let Some(place) = self.core_place(next) else { break };
            percept = self.take(leaving, world)?;
            let index = self.trail.door(self.core[place], next).0;
            believed = CoreDart { place, index };
        }
        Ok(())
    }

    /// Whether a hypothesis is neither confirmed nor refuted.
    fn is_open(&mut self, test: &Test) -> bool {
        let target = self.dart(test.hypothesis);
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
