//! Matches a trace with a robot that recovers.

use super::{
    AlgorithmCoverage, AlgorithmMatch, MatchEnd, MatchedChoices, Trace, TraceWorld,
    TraceWorldError, match_end::RunStop,
};
use crate::{
    mapping::{
        ArrivalMeasurement, FoldingEvent, FoldingRun, MapDart, MapWalk, MappingAlgorithm,
        MappingError, MappingEvent, Observed, Observer, RecoveryConfig, Relocate, SafeguardEvent,
        StepPurpose, map_with_recovery,
    },
    percept::{Door, Percept, WalkEvent},
    world::World,
};

/// What is recorded of a visit besides its percept.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RecordedVisit {
    /// What was measured on the way to it.
    pub measured: ArrivalMeasurement,
    /// Whether the robot stands before an obstacle.
    pub is_blocked: bool,
}

/// Matches a trace with a robot that recovers, from its start at the marker. `visits` are those of its percepts. At
/// most `bound` darts may become known: then the robot forgets all, and what it does is only known if that is
/// its own bound.
pub fn match_recovering(
    config: RecoveryConfig,
    trace: &Trace,
    visits: &[RecordedVisit],
    bound: usize,
) -> AlgorithmMatch {
    let algorithm = MappingAlgorithm::Folding;
    let mut exploration = FoldingRun::new(bound);
    let mut world = RecordedWorld { world: TraceWorld::after(trace, 0), visits };
    let mut observer = StepObserver::default();
    let observed = &mut Observed::new(&mut world, &mut observer);
    let mapped = map_with_recovery(observed, &mut exploration, config, &[]);
    let position = world.world.position();
    let is_end = position.moves == trace.doors().len();
    let stop = match mapped {
        Ok(_) => RunStop::after_end(position, StepPurpose::Audited, trace),
        // After many recoveries the robot gives up.
        Err(MappingError::Contradiction(_)) if is_end => Some(RunStop::EndOfTrace),
        Err(MappingError::Contradiction(contradiction)) => {
            RunStop::after_end(position, StepPurpose::Contradicted(contradiction), trace)
        }
        Err(error) => Some(RunStop::new(&error, position, observer.purpose)),
    };
    let stop = match (stop, observer.too_large) {
        (Some(RunStop::Departure { .. }), Some(event)) => Some(RunStop::Bound { event, bound }),
        (stop, _) => stop,
    };
    AlgorithmMatch {
        algorithm,
        choices: MatchedChoices::Default,
        reached: MatchEnd::of_only_run(stop, algorithm, trace),
        run: exploration.into(),
        coverage: AlgorithmCoverage::default(),
    }
}

/// A recorded world in which the robot may have got lost.
struct RecordedWorld<'t> {
    world: TraceWorld<'t>,
    visits: &'t [RecordedVisit],
}

impl RecordedWorld<'_> {
    fn visit(&self) -> RecordedVisit {
        self.visits.get(self.world.moves()).copied().unwrap_or_default()
    }
}

impl World for RecordedWorld<'_> {
    type Error = TraceWorldError;

    fn percept(&mut self) -> Result<Percept, TraceWorldError> {
        self.world.percept()
    }

    fn traverse(&mut self, door: Door) -> Result<(), TraceWorldError> {
        self.world.traverse(door)
    }
}

impl Relocate for RecordedWorld<'_> {
    fn relocate(&mut self, error: TraceWorldError) -> Result<(), TraceWorldError> {
        if self.world.relocate() { Ok(()) } else { Err(error) }
    }

    fn measured(&self) -> ArrivalMeasurement {
        self.visit().measured
    }

    fn is_blocked(&self) -> bool {
        self.visit().is_blocked
    }
}

/// What the robot is doing.
struct StepObserver {
    purpose: StepPurpose,
    /// The event at which more darts than the bound would be known, the first time.
    too_large: Option<WalkEvent>,
}

impl Default for StepObserver {
    fn default() -> Self {
        Self { purpose: StepPurpose::GoOn, too_large: None }
    }
}

impl Observer<RecordedWorld<'_>> for StepObserver {
    fn event(&mut self, world: &mut RecordedWorld, walk: &MapWalk, event: MappingEvent) {
        use SafeguardEvent::{
            AuditBegun, AuditPassed, BlockedRetried, Contradicted, MarkerFound, Relocated, TooLarge,
        };
        let named = |dart| MapDart::new(walk.map(), dart);
        self.purpose = match event {
            MappingEvent::Folding(FoldingEvent::Testing { edge, hypothesis, .. }) => {
                StepPurpose::Test { edge: named(edge), hypothesis: named(hypothesis) }
            }
            MappingEvent::Folding(_) | MappingEvent::Safeguard(MarkerFound { .. }) => {
                StepPurpose::GoOn
            }
            MappingEvent::Safeguard(AuditBegun) => StepPurpose::Audit,
            MappingEvent::Safeguard(BlockedRetried { .. }) => StepPurpose::TryBlocked,
            MappingEvent::Safeguard(Contradicted(_) | Relocated) => StepPurpose::FindMarker,
            MappingEvent::Safeguard(TooLarge { .. }) => {
                self.too_large.get_or_insert(WalkEvent::Percept(world.world.moves()));
                StepPurpose::FindMarker
            }
            MappingEvent::Safeguard(AuditPassed { .. }) => StepPurpose::Audited,
            _ => return,
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        percept::Sighting,
        trace::{MatchEnd, TraceEventKind},
    };

    /// A robot at the end of a chain whose next vertex has another degree each time.
    fn contradictory(moves: usize) -> Trace {
        let percept = |degree, sighting| TraceEventKind::Percept(Percept { degree, sighting });
        let start = percept(1, Sighting::Pointing(Door::BACK));
        let mut events = vec![start];
        for at in 0..moves {
            events.push(TraceEventKind::Door(Door::BACK));
            let is_start = at % 2 == 1;
            events.push(if is_start {
                start
            } else {
                percept(1 + at as u32 % 4, Sighting::Nothing)
            });
        }
        Trace::new(events).unwrap()
    }

    fn reached(trace: &Trace, most_recoveries: u32, bound: usize) -> MatchEnd {
        let config = RecoveryConfig { most_recoveries, ..RecoveryConfig::default() };
        match_recovering(config, trace, &[], bound).reached
    }

    #[test]
    fn a_robot_gives_up_at_a_contradiction_after_its_last_recovery() {
        // The vertex has one door, and the next time three: the audit contradicts itself.
        let ended = (1..12).find(|&moves| {
            matches!(reached(&contradictory(moves + 1), 0, 100), MatchEnd::Departure(_))
        });
        let ended = ended.unwrap();
        assert_eq!(reached(&contradictory(ended), 0, 100), MatchEnd::EndOfTrace);
        let MatchEnd::Departure(departure) = reached(&contradictory(ended + 1), 0, 100) else {
            panic!()
        };
        assert_eq!(departure.event.id, 2 * ended + 1);
        assert!(matches!(departure.allowed[0].purpose, StepPurpose::Contradicted(_)));
        // With a recovery it goes on.
        let goes_on = reached(&contradictory(ended + 1), 1, 100);
        assert!(!matches!(goes_on, MatchEnd::Departure(_)), "{goes_on:?}");
    }

    #[test]
    fn a_departure_after_the_bound_on_darts_is_not_known() {
        // A vertex with three doors, of which the robot would not take the last.
        let percept = |degree, sighting| TraceEventKind::Percept(Percept { degree, sighting });
        let start = percept(1, Sighting::Pointing(Door::BACK));
        let (far, end) = (percept(3, Sighting::Nothing), percept(1, Sighting::Nothing));
        let door = |door| TraceEventKind::Door(Door(door));
        let trace = Trace::new([start, door(0), far, door(2), end]);
        let trace = trace.unwrap();
        assert!(matches!(reached(&trace, 32, 100), MatchEnd::Departure(_)));
        let MatchEnd::Bound { event, bound } = reached(&trace, 32, 2) else { panic!() };
        assert_eq!((event.id, bound), (2, 2));
    }
}
