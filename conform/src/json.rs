//! The JSON of a report: its data, with the sentences that `docs/schema/conform.json` names beside them.

use std::collections::BTreeMap;

use serde::{Serialize, Serializer, ser::SerializeMap};
use toposlam_model::{
    aid::Action,
    percept::Percept,
    trace::{AllowedStep, MisfitReason},
};

use super::{
    divergence::{DivergenceCause, FaultClass},
    events::CheckedKind,
    judgement::ConformVerdict,
    report::{Allowed, ConformReports, CoveredCase, Facts, LogReport, MarkerSeen},
    words,
};

/// The fields of a log's line before those of [`Facts`].
struct LogFields<'r>(&'r LogReport);

impl Serialize for LogFields<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self(report) = self;
        let divergence = report.divergence.as_ref();
        let place = divergence.and_then(|divergence| divergence.message);
        let unreachable = report.coverage.iter().filter(|case| case.reachable == Some(false));
        let tolerated = report.tolerated.iter().map(|quirk| (&*quirk.name, quirk.events.len()));
        let mut line = serializer.serialize_map(None)?;
        line.serialize_entry("log", &report.log)?;
        line.serialize_entry("verdict", &report.verdict)?;
        line.serialize_entry("event", &divergence.map(|divergence| divergence.event))?;
        line.serialize_entry("class", &divergence.map(|divergence| divergence.fault))?;
        line.serialize_entry("events", &report.events.len())?;
        line.serialize_entry("matched", &report.matched)?;
        line.serialize_entry("candidates", &report.candidates)?;
        line.serialize_entry("coverage", &counts(&report.coverage))?;
        line.serialize_entry("unreachable", &unreachable.map(|it| it.case).collect::<Vec<_>>())?;
        line.serialize_entry("cause", &divergence.map(|divergence| divergence.cause.name()))?;
        line.serialize_entry("condition", &divergence.map(|it| it.cause.to_string()))?;
        line.serialize_entry("allowed", &divergence.map(words::allowed).unwrap_or_default())?;
        line.serialize_entry("time", &divergence.and_then(|divergence| divergence.time))?;
        line.serialize_entry("message", &place.map(|place| place.number))?;
        line.serialize_entry("offset", &place.map(|place| place.offset))?;
        line.serialize_entry("offset_unit", &place.map(|place| place.unit.name()))?;
        line.serialize_entry("facts", &BTreeMap::from_iter(words::facts(report)))?;
        line.serialize_entry("remarks", &words::remarks(report))?;
        line.serialize_entry("limits", &report.limits)?;
        line.serialize_entry("tolerated", &tolerated.collect::<BTreeMap<_, _>>())?;
        let shorter: Vec<_> = report.shorter.iter().map(words::event).collect();
        line.serialize_entry("shorter", &shorter)?;
        line.serialize_entry("divergence", &divergence)?;
        line.serialize_entry("shorter_events", &report.shorter)?;
        line.serialize_entry("command", &report.command)?;
        line.end()
    }
}

impl Serialize for LogReport {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct LogLine<'r> {
            #[serde(flatten)]
            fields: LogFields<'r>,
            #[serde(flatten)]
            facts: &'r Facts,
        }
        LogLine { fields: LogFields(self), facts: &self.facts }.serialize(serializer)
    }
}

fn counts(coverage: &[CoveredCase]) -> BTreeMap<&str, u64> {
    coverage.iter().map(|covered| (covered.case, covered.count)).collect()
}

/// The JSON of several logs together.
#[derive(Serialize)]
pub struct LogsLine<'r> {
    logs: usize,
    conform: usize,
    diverged: usize,
    not_known: usize,
    unreadable: usize,
    coverage: BTreeMap<&'r str, u64>,
    classes: BTreeMap<&'static str, usize>,
}

impl ConformReports {
    pub fn count(&self, verdict: ConformVerdict) -> usize {
        self.logs.iter().filter(|report| report.verdict == verdict).count()
    }

    /// The logs together, with the cases that they cover.
    pub fn together<'r>(&self, coverage: &'r [CoveredCase]) -> LogsLine<'r> {
        let mut classes: BTreeMap<_, _> = FaultClass::ALL.map(|one| (one.name(), 0)).into();
        for divergence in self.logs.iter().filter_map(|report| report.divergence.as_ref()) {
            *classes.entry(divergence.fault.name()).or_default() += 1;
        }
        LogsLine {
            logs: self.logs.len() + self.unread.len(),
            conform: self.count(ConformVerdict::Conforms),
            diverged: self.count(ConformVerdict::Diverged),
            not_known: self.count(ConformVerdict::NotKnown),
            unreadable: self.unread.len(),
            coverage: counts(coverage),
            classes,
        }
    }
}

/// What is perceived, or the door that is taken, or what is done with the marking aid.
#[derive(Default, Serialize)]
struct Step {
    degree: Option<u32>,
    marker: Option<MarkerSeen>,
    door: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    action: Option<String>,
}

impl CheckedKind {
    pub fn name(&self) -> &'static str {
        match self {
            Self::Arrival { .. } => "percept",
            Self::Door { .. } => "door",
            Self::Action { .. } => "action",
            Self::LeftBetweenDoors { .. } => "aside",
            Self::TurnedBack => "turned-back",
            Self::Undecided(_) => "undecided",
        }
    }
}

impl From<Action> for Step {
    fn from(action: Action) -> Self {
        match action {
            Action::Take(door) => Self { door: Some(door.0), ..Self::default() },
            Action::Do(action) => Self { action: Some(action.to_string()), ..Self::default() },
        }
    }
}

impl Serialize for CheckedKind {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Fields {
            what: &'static str,
            #[serde(flatten)]
            step: Step,
        }
        let step = match self {
            Self::Arrival { arrival, .. } => Step {
                degree: Some(arrival.degree),
                marker: arrival.sighting.and_then(MarkerSeen::from_sighting),
                ..Step::default()
            },
            Self::Door { door, .. } => Step::from(Action::Take(*door)),
            Self::Action { action, .. } => Step::from(Action::Do(*action)),
            _ => Step::default(),
        };
        Fields { what: self.name(), step }.serialize(serializer)
    }
}

impl Serialize for Allowed {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Default, Serialize)]
        struct Fields<'a> {
            #[serde(flatten)]
            step: Step,
            vertex: Option<&'a str>,
            from: Option<&'a str>,
            doors: Option<u32>,
            purpose: Option<String>,
        }
        let fields = match self {
            Self::Step(AllowedStep { action, purpose }) => Fields {
                step: action.map(Step::from).unwrap_or_default(),
                purpose: Some(purpose.to_string()),
                ..Fields::default()
            },
            Self::InWorld(pose, why) => {
                let (step, doors) = match *why {
                    MisfitReason::Percept { expected: Percept { degree, sighting } } => {
                        let marker = MarkerSeen::from_sighting(sighting);
                        (Step { degree: Some(degree), marker, ..Step::default() }, None)
                    }
                    MisfitReason::NoSuchDoor { degree } => (Step::default(), Some(degree)),
                    MisfitReason::Refused(_) => (Step::default(), None),
                };
                let (vertex, from) = (Some(&*pose.vertex), Some(&*pose.from));
                Fields { step, vertex, from, doors, purpose: None }
            }
        };
        fields.serialize(serializer)
    }
}

/// The numbers of a cause.
impl Serialize for DivergenceCause {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        // The expected number of moves, edge ends or doors, and the recorded one.
        let counts: Option<[u64; 2]> = match *self {
            Self::Number { expected, recorded } => Some([expected.into(), recorded.into()]),
            Self::Moves { made, recorded } => Some([made as u64, recorded]),
            Self::Form { degree, doors } => Some([doors.into(), degree.into()]),
            Self::Return { before, now } => Some([before.into(), now.into()]),
            Self::Unfinished { unexplored } => Some([unexplored.into(), 0]),
            _ => None,
        };
        // The angle by which the robot missed a door, in radians.
        let off = match *self {
            Self::LeftBetweenDoors { off } | Self::Entry { off } => Some(off),
            _ => None,
        };
        // The numbers of the events between which a measurement contradicts earlier ones, and of those between which
        // these were made.
        let events = match *self {
            Self::Measurement { between, earlier, .. } => Some([between, earlier]),
            _ => None,
        };
        let events = events.map(|events| events.map(|events| events.map(|event| event + 1)));
        let mut numbers = serializer.serialize_map(Some(5))?;
        numbers.serialize_entry("expected", &counts.map(|[expected, _]| expected))?;
        numbers.serialize_entry("recorded", &counts.map(|[_, recorded]| recorded))?;
        numbers.serialize_entry("off", &off)?;
        numbers.serialize_entry("between", &events.map(|[between, _]| between))?;
        numbers.serialize_entry("earlier", &events.map(|[_, earlier]| earlier))?;
        numbers.end()
    }
}
