//! How a robot maps: by which algorithm, and what it does for a map that is right.

use std::{fmt, str::FromStr};

use super::{
    EarlierWalk, FoldingRun, MapWalk, Mapped, MappedWorld, MappingAlgorithm, MappingEvent,
    Observed, ObservedWorld, Observer, RecoveryConfig, Relocate,
    audit::{AuditMove, audit_times},
    map_with_recovery,
};

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MappingMethod {
    /// By an algorithm. It gives up at a contradiction, or if it gets lost.
    By {
        algorithm: MappingAlgorithm,
        /// The number of audits of the complete map.
        audits: u32,
    },
    /// By the folding explorer. It audits its map, and recovers.
    Recovering(RecoveryConfig),
}

impl Default for MappingMethod {
    fn default() -> Self {
        Self::from(MappingAlgorithm::default())
    }
}

impl From<MappingAlgorithm> for MappingMethod {
    fn from(algorithm: MappingAlgorithm) -> Self {
        Self::By { algorithm, audits: 0 }
    }
}

impl MappingMethod {
    pub fn algorithm(self) -> MappingAlgorithm {
        match self {
            Self::By { algorithm, .. } => algorithm,
            Self::Recovering(_) => MappingAlgorithm::Folding,
        }
    }

    pub fn audits(self) -> u32 {
        match self {
            Self::By { audits, .. } | Self::Recovering(RecoveryConfig { audits, .. }) => audits,
        }
    }

    pub fn recovers(self) -> bool {
        matches!(self, Self::Recovering(_))
    }

    /// Whether the robot tries blocked doors once more at the end.
    pub fn retries_blocked(self) -> bool {
        matches!(self, Self::Recovering(RecoveryConfig { retries_blocked: true, .. }))
    }

    /// Maps a world. At its start the robot stands at the marked vertex, with its back to the facing door. A robot that
    /// recovers may also go on from earlier walks, wherever it stands. Returns the robot's walk, too.
    ///
    /// # Errors
    /// Returns an error if the world does, if it contradicts itself, or if the map has more than `bound` darts.
    /// The walk then holds what is known so far. A robot that recovers only returns errors from which it
    /// cannot.
    pub fn map_world<W: Relocate>(
        self,
        world: &mut W,
        bound: usize,
        earlier: &[EarlierWalk],
        observer: &mut impl Observer<W>,
    ) -> (MapWalk, Mapped<W, MappedWorld>) {
        match self {
            Self::By { algorithm, audits } => {
                let (walk, mapped) = algorithm.map_world(world, bound, observer);
                let world = &mut Observed::new(world, observer);
                let mapped = mapped.and_then(|()| audited(&walk, audits, world));
                (walk, mapped)
            }
            Self::Recovering(config) => {
                let mut run = FoldingRun::new(bound);
                let world = &mut Observed::new(world, observer);
                let mapped = map_with_recovery(world, &mut run, config, earlier);
                (run.into(), mapped)
            }
        }
    }
}

fn audited<W: ObservedWorld>(walk: &MapWalk, audits: u32, world: &mut W) -> Mapped<W, MappedWorld> {
    let (pose, audited_percepts) = audit_times(audits, world, walk, |world, made| {
        let AuditMove { door, percept, .. } = made;
        world.event(walk, MappingEvent::Moved { door, percept });
    })?;
    let audit_moves = audited_percepts.iter().map(|percepts| percepts - 1).sum();
    let moves = walk.moves() + audit_moves;
    let (recoveries, blocked) = (0, Vec::new());
    Ok(MappedWorld { pose, moves, audit_moves, audited_percepts, recoveries, blocked })
}

/// The name in logs.
impl fmt::Display for MappingMethod {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        let algorithm = self.algorithm();
        match (self.recovers(), self.audits()) {
            (true, audits) => {
                let retries = if self.retries_blocked() { " retrying" } else { "" };
                write!(out, "{algorithm} recovering{retries} audits={audits}")
            }
            (false, 0) => write!(out, "{algorithm}"),
            (false, audits) => write!(out, "{algorithm} audits={audits}"),
        }
    }
}

impl FromStr for MappingMethod {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let mut words = name.split(' ');
        let algorithm = words.next().unwrap_or_default().parse()?;
        let (mut recovers, mut retries_blocked, mut audits) = (false, false, 0);
        for word in words {
            let count = word.strip_prefix("audits=").and_then(|count| count.parse().ok());
            match (word, count) {
                ("recovering", _) if algorithm == MappingAlgorithm::Folding => recovers = true,
                ("retrying", _) if recovers => retries_blocked = true,
                (_, Some(count)) => audits = count,
                _ => return Err(format!("`{word}` does not follow the name of an algorithm")),
            }
        }
        Ok(if recovers {
            Self::Recovering(RecoveryConfig {
                audits,
                retries_blocked,
                ..RecoveryConfig::default()
            })
        } else {
            Self::By { algorithm, audits }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        aid::{RefusedAction, State},
        any_graph::by_neighbours,
        embedded_graph::{Dart, EmbeddedGraph},
        isomorphism::Bijection,
        mapping::{ArrivalMeasurement, FACING},
        measurement::{HallwayMeasurement, MeasurementNoise},
        percept::{Door, Percept},
        world::{GraphWorld, World},
    };

    /// Two triangles that share a vertex, and a dead end at it.
    fn bow_tie() -> EmbeddedGraph {
        by_neighbours("x: a b c d end | a: x b | b: a x | c: x d | d: c x | end: x")
    }

    /// The image in the world of a pose in a map, which is right.
    fn image(run: &MapWalk, graph: &EmbeddedGraph, pose: Dart) -> Option<Dart> {
        let map = run.map().complete().unwrap();
        let bijection = Bijection::of_starts((map, FACING), (graph, FACING));
        assert!(bijection.verify(map, graph));
        bijection.image(pose)
    }

    const FOLDING: MappingAlgorithm = MappingAlgorithm::Folding;

    #[test]
    fn audits_and_recovery_do_not_change_how_a_map_is_made() {
        let graph = bow_tie();
        let mapped = |method: MappingMethod| {
            let mut world = GraphWorld::new(&graph, FACING);
            let (run, mapped) = method.map_world(&mut world, 100, &[], &mut ());
            let mapped = mapped.unwrap();
            assert_eq!(mapped.moves, world.moves());
            assert_eq!(mapped.moves, run.moves() + mapped.audit_moves);
            assert_eq!(mapped.audited_percepts.len(), method.audits() as usize);
            assert_eq!(image(&run, &graph, mapped.pose), Some(world.pose()));
            (run.moves(), mapped.audit_moves)
        };
        for algorithm in MappingAlgorithm::with_fixed_marker() {
            let [none, one, two] =
                [0, 1, 2].map(|audits| mapped(MappingMethod::By { algorithm, audits }));
            assert_eq!([none.0, none.1, one.0, two.0], [none.0, 0, none.0, none.0]);
            assert!(one.1 > 0 && two.1 > one.1);
        }
        let one = mapped(MappingMethod::By { algorithm: FOLDING, audits: 1 });
        assert_eq!(mapped(MappingMethod::Recovering(RecoveryConfig::default())), one);
    }

    #[test]
    fn a_robot_goes_on_from_an_earlier_walk_wherever_it_is_switched_on() {
        let graph = bow_tie();
        // The first moves of the folding explorer.
        let first = GraphWorld::new(&graph, FACING).sensed();
        let mut moves = Vec::new();
        let mut listen = |_: &mut GraphWorld, _: &MapWalk, event| {
            if let MappingEvent::Moved { door, percept } = event {
                moves.push((door, percept));
            }
        };
        let mut world = GraphWorld::new(&graph, FACING);
        FOLDING.map_world(&mut world, 100, &mut listen).1.unwrap();
        for known in [3, moves.len() / 2, moves.len()] {
            let earlier = [EarlierWalk::new(first, moves[..known].iter().copied(), false)];
            for pose in graph.darts() {
                let world = GraphWorld::new(&graph, FACING);
                let placed = world.state().placed;
                let mut world = world.at(State { pose, placed });
                let method = MappingMethod::Recovering(RecoveryConfig::default());
                let (run, mapped) = method.map_world(&mut world, 100, &earlier, &mut ());
                assert_eq!(image(&run, &graph, mapped.unwrap().pose), Some(world.pose()));
                if known == moves.len() {
                    // It only goes to the marker, and audits what it knows.
                    assert!(run.moves() <= 3, "{}", run.moves());
                }
            }
        }
    }

    #[test]
    fn a_method_is_read_from_its_name() {
        for name in [
            "algorithm1",
            "folding",
            "algorithm1 audits=2",
            "folding audits=1",
            "folding recovering audits=1",
            "folding recovering retrying audits=2",
            "movable",
            "team-2-round",
        ] {
            assert_eq!(name.parse::<MappingMethod>().unwrap().to_string(), name);
        }
        for (name, error) in [
            ("folding slowly", "`slowly` does not follow the name of an algorithm"),
            ("algorithm1 recovering", "`recovering` does not follow the name of an algorithm"),
            ("folding retrying", "`retrying` does not follow the name of an algorithm"),
            ("folding audits=-1", "`audits=-1` does not follow the name of an algorithm"),
        ] {
            assert_eq!(name.parse::<MappingMethod>(), Err(error.to_owned()));
        }
        let unknown = "depth-first".parse::<MappingMethod>().unwrap_err();
        assert!(
            unknown.starts_with("`depth-first` is no algorithm; they are algorithm1, folding,")
        );
    }

    /// A robot that is carried after a move, to this pose. It measures the hallways, of which each has another
    /// length.
    struct Carried<'g> {
        world: GraphWorld<'g>,
        after_and_to: (u64, Dart),
        length: Option<f64>,
    }

    impl World for Carried<'_> {
        type Error = RefusedAction;

        fn percept(&mut self) -> Result<Percept, RefusedAction> {
            self.world.percept()
        }

        fn traverse(&mut self, door: Door) -> Result<(), RefusedAction> {
            self.world.traverse(door)?;
            let (graph, State { pose, placed }) = (self.world.graph(), self.world.state());
            self.length = Some(5.0 + 2.0 * f64::from(pose.0.min(graph.opposite(pose).0)));
            if self.world.moves() == self.after_and_to.0 {
                self.world = self.world.clone().at(State { pose: self.after_and_to.1, placed });
            }
            Ok(())
        }
    }

    impl Relocate for Carried<'_> {
        fn relocate(&mut self, _: RefusedAction) -> Result<(), RefusedAction> {
            self.traverse(Door::BACK)
        }

        fn measured(&self) -> ArrivalMeasurement {
            let hallway = self.length.map(|length| HallwayMeasurement { length, turn: None });
            ArrivalMeasurement { hallway, shape: None }
        }
    }

    #[test]
    fn lengths_show_that_a_robot_was_carried_unless_nothing_comes_after_it() {
        let graph = by_neighbours(
            "hub: a b c | a: hub a-end | b: hub b-end | c: hub c-end | a-end: a | b-end: b | c-end: c",
        );
        let run = |after_and_to, noise| {
            let world = GraphWorld::new(&graph, FACING);
            let mut world = Carried { world, after_and_to, length: None };
            let config = RecoveryConfig { noise, ..RecoveryConfig::default() };
            let method = MappingMethod::Recovering(config);
            let (run, mapped) = method.map_world(&mut world, 100, &[], &mut ());
            let mapped = mapped.unwrap();
            (image(&run, &graph, mapped.pose) == Some(world.world.pose()), mapped)
        };
        let noise = MeasurementNoise { standing: 0.1, ..MeasurementNoise::UNKNOWN };
        let noise = Some(noise.times(0.1, 1.0));
        let (is_there, never) = run((u64::MAX, FACING), noise);
        assert!(is_there && never.recoveries == 0);
        let (mut without, mut with) = (0, 0);
        for after in 1..=never.moves {
            for to in graph.darts() {
                without += u32::from(!run((after, to), None).0);
                let is_there = run((after, to), noise).0;
                assert!(is_there || after == never.moves, "carried to {to:?} after {after} moves");
                with += u32::from(!is_there);
            }
        }
        assert!(with > 0 && with < without, "{with} of {without}");
    }
}
