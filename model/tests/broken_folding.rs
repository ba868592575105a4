//! The check fails on broken variants of mapping by folding, each on its smallest start.
//!
//! The variants are of a short explorer that folds its trail and makes strict tests. It does not save
//! moves; without a flaw it maps every start right.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::{borrow::Cow, collections::VecDeque};

use toposlam_model::{
    check::{Check, RunChoices, Shard},
    embedded_graph::Dart,
    enumerate::Class,
    folding::FoldedTrail,
    mapping::{ExploredMap, Explorer, Flaw, InvalidStep, MappingError, Observer},
    marker::Directional,
    percept::{Door, Percept, Sighting},
    world::World,
};

use crate::smallest_failure::{new, smallest_failure};

/// An explorer whose map is its folded trail.
#[derive(Clone, Default)]
struct Folding {
    broken: Option<Broken>,
    trail: FoldedTrail,
    /// The poses by which the places that are proved to be distinct were first entered.
    core: Vec<Dart>,
}

#[derive(Clone, Copy, Debug)]
enum Broken {
    /// Sightings of the marker are not united.
    UnionForgotten,
    /// A hypothesis that contradicts itself is alive.
    ContradictionIgnored,
    /// A place joins the core although a hypothesis about it is alive.
    PromotedTooEarly,
    /// A hypothesis is taken as confirmed if it is alive.
    NotTested,
    /// A test begins at the place of the hypothesis, so that its success confirms nothing.
    TestedElsewhere,
}

const BROKEN: [Broken; 5] = [
    Broken::UnionForgotten,
    Broken::ContradictionIgnored,
    Broken::PromotedTooEarly,
    Broken::NotTested,
    Broken::TestedElsewhere,
];

#[allow(clippy::needless_pass_by_value, reason = "errors are mapped by value")]
fn gave_up<E>(reason: impl ToString) -> MappingError<E> {
    MappingError::GaveUp(reason.to_string())
}

impl Folding {
    fn broken(broken: Broken) -> Self {
        Self { broken: Some(broken), ..Self::default() }
    }

    fn take<W: World>(
        &mut self,
        door: Door,
        world: &mut W,
    ) -> Result<Percept, MappingError<W::Error>> {
        world.traverse(door).map_err(MappingError::World)?;
        let mut percept = world.percept().map_err(MappingError::World)?;
        if let Some(Broken::UnionForgotten) = self.broken {
            percept.sighting = Sighting::Nothing;
        }
        self.trail.step(door, percept).map_err(gave_up)?;
        Ok(percept)
    }

    /// The doors of a shortest way from a pose to another vertex, through core places only if asked.
    fn way(&self, from: Dart, to: Dart, in_core: bool) -> Option<Vec<Door>> {
        let (trail, target) = (&self.trail, self.trail.vertex(to));
        let mut reached = vec![false; trail.trail_vertex_count()];
        reached[trail.vertex(from)] = true;
        let mut queue = VecDeque::from([(from, Vec::new())]);
        while let Some((pose, way)) = queue.pop_front() {
            if trail.vertex(pose) == target {
                return Some(way);
            }
            for door in (0..trail.degree(pose)).map(Door) {
                let Some(next) = trail.opposite(trail.behind(pose, door)) else { continue };
                let seen = &mut reached[trail.vertex(next)];
                if !*seen && (!in_core || self.is_in_core(next)) {
                    *seen = true;
                    queue.push_back((next, way.iter().copied().chain([door]).collect()));
                }
            }
        }
        None
    }

    fn is_in_core(&self, dart: Dart) -> bool {
        self.core.iter().any(|&pose| self.trail.vertex(pose) == self.trail.vertex(dart))
    }

    fn core_darts(&self) -> Vec<Dart> {
        self.core.iter().flat_map(|&pose| self.trail.darts_around(pose)).collect()
    }

    /// The core darts that do not lead to a core place as far as is known.
    fn unresolved(&self) -> Vec<Dart> {
        let leads_to_core =
            |dart: &Dart| self.trail.opposite(*dart).is_some_and(|far| self.is_in_core(far));
        self.core_darts().into_iter().filter(|dart| !leads_to_core(dart)).collect()
    }

    fn is_alive(&mut self, place: Dart, hypothesis: Dart) -> bool {
        match self.broken {
            Some(Broken::ContradictionIgnored) => true,
            _ => self.trail.with_united(place, hypothesis, |_| ()).is_ok(),
        }
    }

    /// The poses behind core darts that are not in the core, and a living hypothesis about each. Places
    /// without one join the core.
    fn pending(&mut self) -> Vec<(Dart, Dart)> {
        loop {
            let unresolved = self.unresolved();
            let places: Vec<Dart> =
                unresolved.iter().filter_map(|&dart| self.trail.opposite(dart)).collect();
            let mut pending = Vec::new();
            let mut new = None;
            for place in places {
                let alive = unresolved.iter().find(|&&dart| self.is_alive(place, dart));
                match (alive, self.broken) {
                    (Some(&hypothesis), broken)
                        if !matches!(broken, Some(Broken::PromotedTooEarly)) =>
                    {
                        pending.push((place, hypothesis));
                    }
                    _ => new = new.or(Some(place)),
                }
            }
            match new {
                Some(place) => self.core.push(place),
                None => return pending,
            }
        }
    }

    /// Goes to a place, and takes a way from there that would lead to the marker if the place were entered
    /// by the dart of the hypothesis.
    fn test<W: World>(
        &mut self,
        place: Dart,
        hypothesis: Dart,
        world: &mut W,
    ) -> Result<(), MappingError<W::Error>> {
        if let Some(Broken::NotTested) = self.broken {
            return self.trail.unite(place, hypothesis).map_err(gave_up);
        }
        let from = match self.broken {
            Some(Broken::TestedElsewhere) => hypothesis,
            _ => place,
        };
        let marker = self.core[0];
        let predicted = self.way(hypothesis, marker, true).ok_or_else(|| gave_up("no way"))?;
        for door in self.way(self.trail.pose(), from, false).ok_or_else(|| gave_up("no way"))? {
            self.take(door, world)?;
        }
        // From the second door on, the robot has come in by the dart that is predicted.
        let mut doors = predicted.into_iter();
        let first = doors.next().ok_or_else(|| gave_up("the marker is here"))?;
        let first = self.trail.door(self.trail.pose(), self.trail.behind(from, first));
        for door in [first].into_iter().chain(doors) {
            if door.0 >= self.trail.degree(self.trail.pose()) {
                return Ok(());
            }
            let percept = self.take(door, world)?;
            if percept.sighting != Sighting::Nothing || !self.is_alive(place, hypothesis) {
                return Ok(());
            }
        }
        Ok(())
    }

    /// Goes to the nearest open core dart, and takes it.
    fn explore_further<W: World>(&mut self, world: &mut W) -> Result<(), MappingError<W::Error>> {
        let open =
            self.core_darts().into_iter().filter(|&dart| self.trail.opposite(dart).is_none());
        let ways = open.filter_map(|dart| Some((self.way(self.trail.pose(), dart, false)?, dart)));
        let nearest = ways.min_by_key(|(way, _)| way.len());
        let (way, dart) = nearest.ok_or_else(|| gave_up("no dart of the core is open"))?;
        for door in way {
            self.take(door, world)?;
        }
        self.take(self.trail.door(self.trail.pose(), dart), world).map(|_| ())
    }
}

impl Explorer for Folding {
    type Marker = Directional;
    /// A place and a hypothesis to test; without one, the nearest open dart is taken.
    type Choice = Option<(Dart, Dart)>;

    fn marker(&self) -> Directional {
        Directional
    }

    fn begin<W: World>(
        &mut self,
        world: &mut W,
        _: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        let percept = world.percept().map_err(MappingError::World)?;
        self.trail = FoldedTrail::new(percept).map_err(gave_up)?;
        self.core = vec![self.trail.pose()];
        Ok(())
    }

    fn choose(&mut self) -> Result<Option<Self::Choice>, InvalidStep> {
        let pending = self.pending();
        Ok((self.trail.open_count() > 0).then(|| pending.first().copied()))
    }

    fn step<W: World>(
        &mut self,
        pending: Self::Choice,
        world: &mut W,
        _: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        match pending {
            Some((place, hypothesis)) => self.test(place, hypothesis, world),
            None => self.explore_further(world),
        }
    }

    fn explored(&self) -> Result<ExploredMap<'_>, Flaw> {
        let closed = self.trail.closed().ok_or_else(|| gave_up("nothing was seen"))?;
        let facing = closed.marker.ok_or_else(|| gave_up("the marker was not seen"))?;
        Ok(ExploredMap { graph: Cow::Owned(closed.graph), facing, pose: closed.pose })
    }

    fn move_bound(&self, edges: usize, vertices: usize) -> u64 {
        (4 * vertices * edges * (edges + 1)) as u64
    }
}

#[test]
fn without_a_flaw_every_start_is_mapped_right() {
    for edges in 1..=5 {
        let sweep = Check::new(Class::Multigraph, edges, Shard::WHOLE).unwrap();
        let tally = sweep.run(Folding::default, RunChoices::Default, &());
        assert_eq!((tally.failure, tally.mapped), (None, tally.starts));
        assert_eq!(tally.below_certificate, 0);
    }
}

#[test]
fn every_broken_variant_is_caught_on_a_small_start() {
    let caught =
        BROKEN.map(|broken| smallest_failure(|| Folding::broken(broken), Class::Multigraph, 4));
    let out_of_moves =
        |moves: u64| format!("after {moves} moves: no more than {moves} moves are allowed");
    let expected = [
        (1, vec![new(2), 1], out_of_moves(8)),
        (
            2,
            vec![new(3), new(1), 2],
            "after 1 moves: the explorer gave up: the marker is here".to_owned(),
        ),
        (3, vec![new(1), new(5), 3, 5], out_of_moves(96)),
        (
            3,
            vec![new(1), new(5), 5, 4],
            "after 3 moves: the explorer gave up: the junction after 2 moves would be turned onto \
             itself"
                .to_owned(),
        ),
        (2, vec![new(1), new(3), 3], out_of_moves(48)),
    ];
    assert_eq!(caught, expected);
}
