//! The folding explorer of a robot that also has an undirected marker to carry.
//!
//! The robot leaves the movable marker at a place of the map near which it explores. A test may then end there, and not
//! at the directional marker. The movable marker shows the vertex, and not the dart by which the robot came in. So a
//! test may only end there if the hypothesis follows whichever dart that was.

use super::{FoldingRun, FoldingStep, HypothesisTest, Pending, Ways, steps::worthwhile};
use crate::{
    aid::{AidAction, AidKind, directional_and_movable::DirectionalAndMovable},
    clone_in_place::clone_in_place,
    embedded_graph::{Dart, Vertex},
    folding::{ArrivalSenses, FoldedTrail, TrailError},
    injected_flaw::InjectedFlaw,
    mapping::{
        Contradiction, CostOrder, Explorer, ExplorerInfo, FoldingEvent, InvalidStep, MapWalk,
        Mapped, MappingEvent, MovableEvent, ObservedWorld, StepPurpose, movable_markers::handle,
        partial_map::START, tree::BreadthFirstTree,
    },
    percept::{Door, Percept, Sighting, TwoMarkersView},
    world::World,
};

/// The fewest edges over which the robot fetches the movable marker. This figure and the next are the best that were
/// tried.
const FAR: usize = 6;
/// The fewest moves of a test that ends at the directional marker before which the robot fetches the movable marker.
const LONG: usize = 12;

/// What the robot does next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WithMovableStep {
    /// What it does without the movable marker.
    Fold(FoldingStep),
    /// A test that ends at the movable marker.
    Test(HypothesisTest),
    /// It goes to the movable marker, picks it up and drops it at another vertex.
    Carry { to: Vertex },
}

/// The state of a run with both markers. Between two steps the movable marker lies at a vertex of the map.
#[derive(Debug)]
pub struct WithMovableRun {
    run: FoldingRun,
    /// Where the movable marker lies.
    base: Vertex,
    /// Whether the last step carried the marker. The next one does not.
    has_carried: bool,
    /// Scratch.
    to_base: BreadthFirstTree,
    from_base: Ways,
}

clone_in_place!(WithMovableRun { run, base, has_carried; scratch to_base, from_base });

impl Default for WithMovableRun {
    fn default() -> Self {
        Self {
            run: FoldingRun::default(),
            base: START,
            has_carried: false,
            to_base: BreadthFirstTree::default(),
            from_base: Ways::default(),
        }
    }
}

impl From<WithMovableRun> for MapWalk {
    fn from(run: WithMovableRun) -> Self {
        run.run.into()
    }
}

/// The folding explorer with both markers. The default choices are those of the folding explorer, except that a test
/// that takes fewer moves to the movable marker ends there, and that the robot carries this marker first:
///
/// * on its way to an open dart of the map, if the movable marker is on a shortest way there;
/// * otherwise, if it is no farther from that dart than the directional marker, and comes at least 6 edges closer;
/// * likewise before a test of 12 moves or more that ends at the directional marker.
///
/// It drops the marker at the last vertex without another open dart on the way from the marker to that dart.
impl Explorer for WithMovableRun {
    type Aid = AidKind;
    type Choice = WithMovableStep;

    fn info(&self) -> ExplorerInfo {
        ExplorerInfo {
            option: self.aid().name(),
            title: "Folding explorer with a movable marker",
            in_words: "the folding explorer with a movable marker",
            order: CostOrder::EdgesSquaredVertices,
        }
    }

    fn aid(&self) -> AidKind {
        AidKind::DirectionalAndMovable(DirectionalAndMovable)
    }

    fn limit_darts(&mut self, max_darts: usize) {
        self.run.limit_darts(max_darts);
    }

    fn begin<W: ObservedWorld>(&mut self, world: &mut W) -> Mapped<W> {
        (self.base, self.has_carried) = (START, false);
        let mut world = WithoutMovable { world, is_here: false };
        self.run.begin_after(0, &mut world)?;
        Ok(self.expect_marker(&world)?)
    }

    fn choose(&mut self) -> Result<Option<WithMovableStep>, InvalidStep> {
        let Some(step) = self.run.choose()? else { return Ok(None) };
        let test = self.tests_instead_of(step).into_iter().next();
        let mut carry = || self.carry_before(step).filter(|(_, is_worthwhile)| *is_worthwhile);
        let step = match test {
            Some(test) => WithMovableStep::Test(test),
            None => carry().map_or(WithMovableStep::Fold(step), |(step, _)| step),
        };
        Ok(Some(step))
    }

    fn add_choices(&mut self, choices: &mut Vec<WithMovableStep>) -> Result<(), InvalidStep> {
        let first = choices.len();
        choices.extend(self.choose()?);
        for step in self.run.choices()? {
            let tests = self.tests_instead_of(step).into_iter().map(WithMovableStep::Test);
            let carry = self.carry_before(step).map(|(step, _)| step);
            for choice in tests.chain(carry).chain([WithMovableStep::Fold(step)]) {
                if !choices[first..].contains(&choice) {
                    choices.push(choice);
                }
            }
        }
        Ok(())
    }

    fn step<W: ObservedWorld>(&mut self, step: WithMovableStep, world: &mut W) -> Mapped<W> {
        let mut world = WithoutMovable { world, is_here: false };
        self.has_carried = matches!(step, WithMovableStep::Carry { .. });
        match step {
            WithMovableStep::Fold(step) => self.run.step(step, &mut world)?,
            WithMovableStep::Test(test) => self.test(test, &mut world)?,
            WithMovableStep::Carry { to } => self.carry(to, &mut world)?,
        }
        Ok(self.expect_marker(&world)?)
    }

    fn map_walk(&self) -> Option<&MapWalk> {
        self.run.map_walk()
    }

    fn purpose(&self, step: Option<WithMovableStep>) -> StepPurpose {
        match step {
            None => self.run.purpose(None),
            Some(WithMovableStep::Fold(step)) => self.run.purpose(Some(step)),
            Some(WithMovableStep::Test(test)) => self.run.purpose(Some(FoldingStep::Test(test))),
            Some(WithMovableStep::Carry { to }) => StepPurpose::CarryMarker(to),
        }
    }

    /// That of the folding explorer, and `4 n m + n + 201`.
    ///
    /// After `4 n m + 200` moves it neither carries the marker nor ends a test there. So at most one step with the
    /// movable marker ends later. It begins with a way between places that the robot has seen, and ends with at most
    /// `n + 1` moves.
    fn move_bound(&self, edges: usize, vertices: usize) -> u64 {
        let (m, n) = (edges as u64, vertices as u64);
        let step = n.saturating_mul(m).saturating_mul(4).saturating_add(n).saturating_add(201);
        self.run.move_bound(edges, vertices).saturating_add(step)
    }
}

impl WithMovableRun {
    /// The tests that may be made instead of a step, the cheapest first: they end at the movable marker in fewer moves
    /// than the test at the directional marker, or are worth their moves before the robot goes to an open dart of the map.
    fn tests_instead_of(&mut self, step: FoldingStep) -> Vec<HypothesisTest> {
        let run = &mut self.run;
        if self.base == START || run.is_late() || !run.is_followed(self.base, None) {
            return Vec::new();
        }
        run.from_robot.find(&run.trail);
        let near = |pending: &Pending| run.from_robot.moves_to(&run.trail, pending.far);
        let Some(pending) = run.pending.iter().copied().min_by_key(near) else { return Vec::new() };
        let most = match step {
            FoldingStep::Test(test) => test.cost.saturating_sub(1),
            FoldingStep::Explore(edge) => {
                worthwhile(run.from_robot.moves_to(&run.trail, run.in_trail[edge.at()]))
            }
        };
        self.to_base.grow_from(&run.walk.map, self.base);
        run.list_tests(pending, most, &self.to_base);
        let mut tests: Vec<_> = run.tests.iter().map(|test| test.0).collect();
        tests.sort_unstable();
        tests.retain(|test| self.confirms(pending, test));
        tests
    }

    /// Whether the success of a test forces its hypothesis: for each dart by which the robot may then have come in, the
    /// way back contradicts the trail, or ends at the open dart as the hypothesis predicts.
    fn confirms(&mut self, pending: Pending, test: &HypothesisTest) -> bool {
        if !self.run.is_alive(pending, test.hypothesis) {
            return false;
        }
        if InjectedFlaw::VertexTakenForPose.is_present() {
            return true;
        }
        let mut believed = test.entry;
        let mut way = Vec::new();
        while let Some((door, next)) = self.to_base.toward_root(self.run.map(), believed) {
            way.push((door, self.run.map().expected(believed)));
            believed = next;
        }
        let entry = self.run.in_trail[believed.at()];
        let seen = self.run.map().expected(believed);
        (0..seen.degree).all(|turn| {
            let pose = self.run.trail.behind(entry, Door(turn));
            match self.run.way_back(pose, &way, seen) {
                WayBack::Contradiction => true,
                WayBack::Unknown => false,
                WayBack::From(leaving) => {
                    let hypothesis = Some(test.hypothesis.0);
                    let forces = |trail: &FoldedTrail| trail.number(pending.far) == hypothesis;
                    self.run.trail.with_united(test.open, leaving, forces) != Ok(false)
                }
            }
        })
    }

    /// Where the robot carries the marker before a step, and whether that is worth its moves.
    fn carry_before(&mut self, step: FoldingStep) -> Option<(WithMovableStep, bool)> {
        let run = &mut self.run;
        if self.has_carried || run.is_late() {
            return None;
        }
        let (target, edge, is_long) = match step {
            FoldingStep::Explore(edge) => (run.in_trail[edge.at()], edge, true),
            FoldingStep::Test(test) => (test.open, test.edge, test.cost >= LONG),
        };
        let base = run.in_trail[run.map().first_dart(self.base).at()];
        let (trail, ways) = (&run.trail, &mut self.from_base);
        ways.clear();
        ways.find_from(trail, run.in_trail[0]);
        let to_directional = ways.moves_to(trail, target);
        ways.find_from(trail, base);
        let distance = ways.moves_to(trail, target);
        ways.darts_to(trail, target, &mut run.way);
        let entries = run.way.iter().filter_map(|&dart| trail.opposite(dart));
        let known = entries.zip(1..).filter_map(|(entry, edges)| {
            let vertex = run.walk.map.vertex(Dart(trail.number(entry)?));
            Some((vertex, edges))
        });
        let (to, edges) =
            known.filter(|&(vertex, _)| run.is_followed(vertex, Some(edge))).last()?;
        run.from_robot.find(trail);
        let [direct, there] = [target, base].map(|dart| run.from_robot.moves_to(trail, dart));
        let is_on_way = there + distance == direct;
        let is_worthwhile = is_on_way || distance <= to_directional && edges >= FAR;
        Some((WithMovableStep::Carry { to }, is_long && is_worthwhile))
    }

    /// Goes to the movable marker and carries it to a vertex.
    fn carry<W: ObservedWorld>(
        &mut self,
        to: Vertex,
        world: &mut WithoutMovable<'_, W>,
    ) -> Mapped<W> {
        let [base, to_dart] =
            [self.base, to].map(|vertex| self.run.in_trail[self.run.map().first_dart(vertex).at()]);
        self.run.go_to(base, world)?;
        self.handle(AidAction::PickUp, world)?;
        self.run.go_to(to_dart, world)?;
        self.handle(AidAction::Drop, world)?;
        self.base = to;
        Ok(())
    }

    /// Walks to the movable marker as if a hypothesis were true, until it is confirmed or refuted.
    fn test<W: ObservedWorld>(
        &mut self,
        test: HypothesisTest,
        world: &mut WithoutMovable<'_, W>,
    ) -> Mapped<W> {
        let HypothesisTest { edge, hypothesis, .. } = test;
        self.to_base.grow_from(&self.run.walk.map, self.base);
        let (to_base, base) = (&self.to_base, self.base);
        let is_confirmed =
            self.run.walk_to_root(test, to_base, world, |map, believed, perceived, world| {
                let expected = of_both(map.expected(believed), map.vertex(believed) == base);
                [expected, of_both(perceived, world.is_here)]
            })?;
        if is_confirmed && let Some(far) = self.run.trail.opposite(self.run.in_trail[edge.at()]) {
            let before = self.run.trail.vertex_count();
            let target = self.run.in_trail[hypothesis.at()];
            self.run.trail.unite(far, target).map_err(TrailError::from)?;
            self.run.from_robot.clear();
            self.run.find_robot();
            self.run.report_folding(before, world);
        }
        self.run.settle(world)
    }

    fn handle<W: ObservedWorld>(
        &self,
        action: AidAction,
        world: &mut WithoutMovable<'_, W>,
    ) -> Mapped<W> {
        handle(action, world.world)?;
        world.is_here = action == AidAction::Drop;
        world.event(self.run.walk(), MappingEvent::Movable(MovableEvent::Did(action)));
        Ok(())
    }

    /// At a place of the map the marker is seen if it lies there.
    fn expect_marker<W>(&self, world: &WithoutMovable<'_, W>) -> Result<(), Contradiction> {
        let Some(pose) = self.run.trail.number(self.run.trail.pose()).map(Dart) else {
            return Ok(());
        };
        let map = self.run.map();
        let vertex = map.vertex(pose);
        if world.is_here == (vertex == self.base) {
            return Ok(());
        }
        let [perceived, expected] =
            [world.is_here, !world.is_here].map(|is_here| of_both(map.expected(pose), is_here));
        Err(Contradiction::KnownPlace { vertex, index: map.index(pose), expected, perceived })
    }
}

/// The way back from a pose, as far as the trail knows it.
enum WayBack {
    /// The dart by which the robot left for it.
    From(Dart),
    Unknown,
    /// The robot has not come by it.
    Contradiction,
}

impl FoldingRun {
    /// Whether the robot has followed every dart of a vertex, except for one.
    fn is_followed(&self, vertex: Vertex, except: Option<Dart>) -> bool {
        let is_followed = |dart: Dart| self.trail.opposite(self.in_trail[dart.at()]).is_some();
        self.map().darts_of(vertex).all(|dart| Some(dart) == except || is_followed(dart))
    }

    /// The dart by which the robot left for the first of some places. At each it took a door, and perceived this. At the
    /// last one it has this pose and perceived `seen`, and there the movable marker lies.
    fn way_back(&self, pose: Dart, way: &[(Door, Percept)], seen: Percept) -> WayBack {
        let trail = &self.trail;
        let marked = trail.vertex(pose);
        let differs = |pose: Dart, seen: Percept| {
            let known = trail.number(pose).map(|number| self.map().expected(Dart(number)));
            trail.degree(pose) != seen.degree || known.is_some_and(|known| known != seen)
        };
        if differs(pose, seen) {
            return WayBack::Contradiction;
        }
        let mut pose = pose;
        for &(door, percept) in way.iter().rev() {
            let Some(leaving) = trail.opposite(pose) else { return WayBack::Unknown };
            pose = trail.behind(leaving, door.inverse(trail.degree(leaving)));
            if trail.vertex(pose) == marked || differs(pose, percept) {
                return WayBack::Contradiction;
            }
        }
        trail.opposite(pose).map_or(WayBack::Unknown, WayBack::From)
    }
}

/// What is perceived with the movable marker, or without it.
fn of_both(percept: Percept, movable: bool) -> Percept {
    let along = if let Sighting::Pointing(door) = percept.sighting { Some(door) } else { None };
    Percept { sighting: TwoMarkersView { along, movable }.sighting(), ..percept }
}

/// A world in which the movable marker is not perceived.
struct WithoutMovable<'w, W> {
    world: &'w mut W,
    /// Whether that marker lies where the robot is.
    is_here: bool,
}

impl<W: ObservedWorld> World for WithoutMovable<'_, W> {
    type Error = W::Error;

    fn percept(&mut self) -> Result<Percept, W::Error> {
        let percept = self.world.percept()?;
        let view = match percept.sighting {
            Sighting::TwoMarkers(view) => view,
            Sighting::Nothing => TwoMarkersView::default(),
            // It is of another aid.
            _ => return Ok(percept),
        };
        self.is_here = view.movable;
        let sighting = view.along.map_or(Sighting::Nothing, Sighting::Pointing);
        Ok(Percept { sighting, ..percept })
    }

    fn traverse(&mut self, door: Door) -> Result<(), W::Error> {
        self.world.traverse(door)
    }

    fn senses(&mut self) -> ArrivalSenses {
        self.world.senses()
    }
}

impl<W: ObservedWorld> ObservedWorld for WithoutMovable<'_, W> {
    fn event(&mut self, walk: &MapWalk, event: MappingEvent) {
        use MappingEvent::{Folding, Moved, Started};
        let of_both = |percept| of_both(percept, self.is_here);
        let event = match event {
            Started { percept } => Started { percept: of_both(percept) },
            Moved { door, percept } => Moved { door, percept: of_both(percept) },
            Folding(FoldingEvent::Explored { edge, percept }) => {
                Folding(FoldingEvent::Explored { edge, percept: of_both(percept) })
            }
            other => other,
        };
        self.world.event(walk, event);
    }
}
