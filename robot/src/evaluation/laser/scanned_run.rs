//! A whole run by laser: a robot maps a random building by its scans alone. Corners are no vertices.
//!
//! At each junction it looks around, and decides by the views up to there how many doors there are. A pilot drives it
//! along the corridors, and a detector of its own reports the marker.

use std::{collections::BTreeMap, sync::Arc};

use rand::seq::IndexedRandom;
use thiserror::Error;
use toposlam_model::{
    check::{Folding, judge},
    embedded_graph::{Dart, EmbeddedGraph, Vertex},
    enumerate::Watch,
    isomorphism::Candidate,
    mapping::{DirectionalAlgorithm, MappingError, MappingRun},
    percept::{Door, Percept},
    world::{GraphWorld, World},
};
use toposlam_vision::laser::scan::{Reading, Scan};

use super::{
    super::parallel::made_in_turn,
    corridor_world::CorridorWorld,
    judged_walk::{LaserVerdict, WalkSampler},
    walk::WalkDriver,
};
use crate::{
    conform::{CheckedKind, EventSource, LaserEvents},
    simulator::{LaserScanner, ScannedBuilding},
};

/// A building as a graph: its bends are no vertices.
#[derive(Clone, Debug, PartialEq)]
pub struct SmoothedWorld {
    /// Junctions and dead ends.
    pub graph: EmbeddedGraph,
    /// The place of each vertex.
    places: Vec<usize>,
    /// For each dart, the places to its other end.
    chains: Vec<Vec<usize>>,
}

/// A whole run.
#[derive(Clone, Debug, PartialEq)]
pub struct ScannedRun {
    /// Its number among the runs of the seed.
    pub number: u64,
    /// The number of moves, and the length of the way, in metres.
    pub moves: u64,
    /// See `moves`.
    pub way: f64,
    /// How it ended.
    pub verdict: LaserVerdict,
}

/// Why a run ended early.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
enum ScanFailure {
    #[error("no junction is seen")]
    Missed,
    #[error("the number of doors is undecided")]
    Undecided,
    #[error("the number of doors is wrong")]
    WrongDegree,
    #[error("the door derived is not the one taken")]
    WrongDoor,
    #[error("the run was ended")]
    Stopped,
}

/// The robot begins this far from its first junction, or in the middle of the corridor, in metres.
const BEFORE: f64 = 9.0;
/// At a dead end, walls are nearer than this in every direction ahead, in metres...
const CLOSED: f64 = 2.5;
/// ... up to this angle to either side, in radians.
const AHEAD: f64 = 1.0;
/// The most darts that a map may have.
const MOST_DARTS: usize = 400;

impl SmoothedWorld {
    /// The graph of a building.
    #[must_use]
    pub fn of(world: &CorridorWorld) -> Option<Self> {
        let is_vertex = |place: &usize| !matches!(world.arms(*place).len(), 0 | 2);
        let places: Vec<usize> = (0..world.places.len()).filter(is_vertex).collect();
        let mut names: BTreeMap<[usize; 2], String> = BTreeMap::new();
        let mut chains = Vec::new();
        let mut lists: Vec<(String, Vec<String>)> = Vec::new();
        for &place in &places {
            let mut list = Vec::new();
            for arm in world.arms(place) {
                let mut chain = vec![place, arm.to];
                while let [.., from, at] = chain[..]
                    && world.arms(at).len() == 2
                {
                    chain.push(world.arms_from(at, from)[1].to);
                }
                // An edge is named after its first corridors at both ends.
                let count = names.len();
                let (Some(&end), Some(&before)) = (chain.last(), chain.iter().rev().nth(1)) else {
                    return None;
                };
                let known = names.get(&[end, before]).cloned();
                let name = known.unwrap_or_else(|| format!("e{count}"));
                names.insert([place, arm.to], name.clone());
                list.push(name);
                chains.push(chain);
            }
            lists.push((format!("v{place}"), list));
        }
        let graph = EmbeddedGraph::from_edge_lists(&lists).ok()?;
        Some(Self { graph, places, chains })
    }

    fn place(&self, vertex: Vertex) -> usize {
        self.places[vertex.at()]
    }
}

/// A building that is sensed with a laser scanner.
struct ScannedWorld<'w> {
    world: &'w CorridorWorld,
    smoothed: &'w SmoothedWorld,
    truth: GraphWorld<'w>,
    scanner: LaserScanner,
    events: LaserEvents,
    driver: WalkDriver,
    /// The number of steps that were sensed, and the last scan.
    sensed: usize,
    last: Option<Scan>,
    /// The doors that were taken at junctions with at least three doors.
    doors: Vec<u32>,
    watch: &'w dyn Watch,
}

impl ScannedWorld<'_> {
    fn sense(&mut self) -> Result<(), ScanFailure> {
        for number in self.sensed..self.driver.steps.len() {
            if self.watch.stop() {
                return Err(ScanFailure::Stopped);
            }
            let step = self.driver.steps[number];
            let Ok(scan) = self.scanner.scan(step.pose, number as u64, step.time) else { continue };
            let source = EventSource { time: number as u64, ..EventSource::default() };
            self.events.see(source, &scan, &step.odometry);
            self.last = Some(scan);
        }
        self.sensed = self.driver.steps.len();
        Ok(())
    }

    /// The number of doors here, as it is derived so far.
    fn degree(&self) -> Result<u32, ScanFailure> {
        if self.last.as_ref().is_some_and(is_dead_end) {
            return Ok(1);
        }
        let events = self.events.clone().finish();
        match events.last().map(|event| &event.kind) {
            Some(CheckedKind::Arrival { arrival, .. }) => Ok(arrival.degree),
            Some(CheckedKind::Undecided(_)) => Err(ScanFailure::Undecided),
            _ => Err(ScanFailure::Missed),
        }
    }

    /// Checks that the derived doors are those that were taken. The last ones may not be decided yet.
    fn check_doors(&self) -> Result<(), ScanFailure> {
        let events = self.events.clone().finish();
        let derived = events.iter().filter_map(|event| match event.kind {
            CheckedKind::Door { door, .. } => Some(door.0),
            _ => None,
        });
        let is_same = derived.zip(&self.doors).all(|(derived, &taken)| derived == taken);
        if is_same { Ok(()) } else { Err(ScanFailure::WrongDoor) }
    }
}

impl World for ScannedWorld<'_> {
    type Error = ScanFailure;

    fn percept(&mut self) -> Result<Percept, ScanFailure> {
        let truth = self.truth.sensed();
        if self.degree()? == truth.degree { Ok(truth) } else { Err(ScanFailure::WrongDegree) }
    }

    fn traverse(&mut self, door: Door) -> Result<(), ScanFailure> {
        let graph = &self.smoothed.graph;
        let dart = graph.behind(self.truth.pose(), door);
        if graph.degree_around(dart) >= 3 {
            self.doors.push(door.0);
        }
        self.truth.traverse(door).map_err(|_| ScanFailure::WrongDoor)?;
        for &place in &self.smoothed.chains[dart.at()][1..] {
            self.driver.drive_near(self.world.places[place]);
        }
        self.driver.look_around();
        self.sense()?;
        self.check_doors()
    }
}

/// Whether a robot that has driven along a corridor stands at its end.
fn is_dead_end(scan: &Scan) -> bool {
    let mut ahead = scan.readings().filter(|(bearing, _)| bearing.abs() < AHEAD);
    ahead.all(|(_, reading)| match reading {
        Reading::Hit(range) => range < CLOSED,
        Reading::NoReturn => false,
        Reading::Invalid => true,
    })
}

impl WalkSampler {
    /// Makes whole runs by their numbers on all threads. If the watch stops, some are missing.
    #[must_use]
    pub fn runs(&self, numbers: std::ops::Range<u64>, watch: &dyn Watch) -> Vec<ScannedRun> {
        made_in_turn(numbers, watch, Some, |number| self.run(number, watch))
    }

    /// Makes the whole run with this number by the folding explorer; `None` if the watch stops.
    fn run(&self, number: u64, watch: &dyn Watch) -> Option<ScannedRun> {
        let seed = self.run_seed(number);
        let world = CorridorWorld::random(self.buildings, seed);
        let smoothed = SmoothedWorld::of(&world)?;
        let params = self.scanner_of(number);
        let building = Arc::new(ScannedBuilding::new(&world.plan, &params, seed));
        let mut driver = WalkDriver::new(self.drift, seed);
        let is_junction = |dart: &Dart| smoothed.graph.degree_around(*dart) >= 3;
        let starts: Vec<Dart> = smoothed.graph.darts().filter(is_junction).collect();
        let &facing = starts.choose(&mut driver.chance)?;
        let start = world.places[smoothed.place(smoothed.graph.vertex(facing))];
        let behind = world.places[smoothed.chains[facing.at()][1]];
        let off = [0, 1].map(|axis| behind[axis] - start[axis]);
        let share = (BEFORE / off[0].hypot(off[1])).min(0.5);
        driver.begin_at([0, 1].map(|axis| start[axis] + share * off[axis]));
        driver.drive_near(start);
        driver.look_around();
        let mut scanned = ScannedWorld {
            world: &world,
            smoothed: &smoothed,
            truth: GraphWorld::new(&smoothed.graph, facing),
            scanner: LaserScanner::new(building, &params, seed),
            events: LaserEvents::new(self.sensing),
            driver,
            sensed: 0,
            last: None,
            doors: Vec::new(),
            watch,
        };
        let mut mapping = MappingRun::new(DirectionalAlgorithm::Folding, MOST_DARTS);
        let result = match scanned.sense() {
            Ok(()) => mapping.map_world(&mut scanned, &mut ()),
            Err(failure) => Err(MappingError::World(failure)),
        };
        let verdict = match result {
            Ok(()) => match &mapping {
                MappingRun::Folding(state) => {
                    let mut candidate = Candidate::default();
                    let flaw = judge(&Folding, state, facing, &scanned.truth, &mut candidate).err();
                    flaw.map_or(LaserVerdict::Right, |_| LaserVerdict::WrongDegree)
                }
                MappingRun::Algorithm1(_) => LaserVerdict::WrongDegree,
            },
            Err(MappingError::World(failure)) => match failure {
                ScanFailure::Stopped => return None,
                ScanFailure::Missed => LaserVerdict::Missed,
                ScanFailure::Undecided => LaserVerdict::Undecided,
                ScanFailure::WrongDegree => LaserVerdict::WrongDegree,
                ScanFailure::WrongDoor => LaserVerdict::WrongDoor,
            },
            Err(_) => LaserVerdict::WrongDegree,
        };
        Some(ScannedRun { number, moves: mapping.moves(), way: scanned.driver.way, verdict })
    }
}

#[cfg(test)]
mod tests {
    use super::{super::corridor_world::BuildingKind, *};

    #[test]
    fn the_graph_of_a_building_has_its_junctions_and_dead_ends() {
        for seed in 0..200 {
            let world = CorridorWorld::random(BuildingKind::Mixed, seed);
            let smoothed = SmoothedWorld::of(&world).unwrap();
            let graph = &smoothed.graph;
            let degrees = |degree: usize| {
                (0..world.places.len()).filter(|&place| world.arms(place).len() == degree).count()
            };
            assert_eq!(graph.vertex_count(), degrees(1) + degrees(3) + degrees(4) + degrees(5));
            // Each bend joins two corridors.
            assert_eq!(graph.edge_count(), world.links.len() - degrees(2));
            assert_eq!(graph.genus(), 0, "{seed}: a plan is planar");
            for dart in graph.darts() {
                let chain = &smoothed.chains[dart.at()];
                let mut back = smoothed.chains[graph.opposite(dart).at()].clone();
                back.reverse();
                assert_eq!(*chain, back, "{seed}");
                assert_eq!(chain[0], smoothed.place(graph.vertex(dart)));
            }
        }
    }
}
