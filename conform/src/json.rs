//! The JSON of a report: its data, with the sentences that `docs/schema/conform.json` names beside them.

use std::collections::BTreeMap;

use serde::{Serialize, Serializer};
use toposlam_model::{
    percept::Percept,
    trace::{AllowedStep, MisfitReason},
};

use super::{
    divergence::{DivergenceCause, FaultClass},
    events::CheckedKind,
    judgement::ConformVerdict,
    report::{
        Allowed, ConformReports, CoveredCase, DivergenceReport, Facts, Limit, LogReport,
        MarkerSeen, MessagePlace,
    },
    words,
};

#[derive(Serialize)]
struct LogLine<'r> {
    log: &'r str,
    verdict: ConformVerdict,
    event: Option<usize>,
    class: Option<FaultClass>,
    events: usize,
    matched: usize,
    candidates: usize,
    coverage: BTreeMap<&'r str, u64>,
    unreachable: Vec<&'r str>,
    cause: Option<&'static str>,
    condition: Option<String>,
    allowed: Vec<String>,
    time: Option<f64>,
    message: Option<u64>,
    offset: Option<u64>,
    offset_unit: Option<&'static str>,
    #[serde(rename = "facts")]
    fact_texts: BTreeMap<&'static str, String>,
    remarks: Vec<String>,
    limits: &'r [Limit],
    tolerated: BTreeMap<&'r str, usize>,
    shorter: Vec<String>,
    divergence: Option<&'r DivergenceReport>,
    shorter_events: &'r [CheckedKind],
    command: Option<&'r str>,
    #[serde(flatten)]
    facts: &'r Facts,
}

impl Serialize for LogReport {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let divergence = self.divergence.as_ref();
        let place = divergence.and_then(|divergence| divergence.message);
        let unreachable = self.coverage.iter().filter(|covered| covered.reachable == Some(false));
        let line = LogLine {
            log: &self.log,
            verdict: self.verdict,
            event: divergence.map(|divergence| divergence.event),
            class: divergence.map(|divergence| divergence.fault),
            events: self.events.len(),
            matched: self.matched,
            candidates: self.candidates,
            coverage: counts(&self.coverage),
            unreachable: unreachable.map(|covered| covered.case).collect(),
            cause: divergence.map(|divergence| divergence.cause.name()),
            condition: divergence.map(|divergence| divergence.cause.to_string()),
            allowed: divergence.map(words::allowed).unwrap_or_default(),
            time: divergence.and_then(|divergence| divergence.time),
            message: place.map(|MessagePlace { number, .. }| number),
            offset: place.map(|MessagePlace { offset, .. }| offset),
            offset_unit: place.map(|MessagePlace { unit, .. }| unit.name()),
            fact_texts: words::facts(self).into_iter().collect(),
            remarks: words::remarks(self),
            limits: &self.limits,
            tolerated: self
                .tolerated
                .iter()
                .map(|quirk| (&*quirk.name, quirk.events.len()))
                .collect(),
            shorter: self.shorter.iter().map(words::event).collect(),
            divergence,
            shorter_events: &self.shorter,
            command: self.command.as_deref(),
            facts: &self.facts,
        };
        line.serialize(serializer)
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
    incomplete: usize,
    unreadable: usize,
    coverage: BTreeMap<&'r str, u64>,
    classes: BTreeMap<&'static str, usize>,
}

impl ConformReports {
    /// The number of logs with a verdict.
    #[must_use]
    pub fn count(&self, verdict: ConformVerdict) -> usize {
        self.logs.iter().filter(|report| report.verdict == verdict).count()
    }

    /// The logs together, with the cases that they cover.
    #[must_use]
    pub fn together<'r>(&self, coverage: &'r [CoveredCase]) -> LogsLine<'r> {
        let mut classes: BTreeMap<_, _> = FaultClass::ALL.map(|one| (one.name(), 0)).into();
        for divergence in self.logs.iter().filter_map(|report| report.divergence.as_ref()) {
            *classes.entry(divergence.fault.name()).or_default() += 1;
        }
        LogsLine {
            logs: self.logs.len() + self.unread.len(),
            conform: self.count(ConformVerdict::Conforms),
            diverged: self.count(ConformVerdict::Diverged),
            incomplete: self.count(ConformVerdict::Incomplete),
            unreadable: self.unread.len(),
            coverage: counts(coverage),
            classes,
        }
    }
}

/// What is perceived, or the door that is taken.
#[derive(Default, Serialize)]
struct Step {
    degree: Option<u32>,
    marker: Option<MarkerSeen>,
    door: Option<u32>,
}

impl CheckedKind {
    /// Its name.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Arrival { .. } => "percept",
            Self::Door { .. } => "door",
            Self::Aside { .. } => "aside",
            Self::TurnedBack => "turned-back",
            Self::Undecided(_) => "undecided",
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
                door: None,
            },
            Self::Door { door, .. } => Step { door: Some(door.0), ..Step::default() },
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
            Self::Step(AllowedStep { door, purpose }) => Fields {
                step: Step { door: door.map(|door| door.0), ..Step::default() },
                purpose: Some(purpose.to_string()),
                ..Fields::default()
            },
            Self::InWorld(pose, why) => {
                let (step, doors) = match *why {
                    MisfitReason::Percept { expected: Percept { degree, sighting } } => {
                        let marker = MarkerSeen::from_sighting(sighting);
                        (Step { degree: Some(degree), marker, door: None }, None)
                    }
                    MisfitReason::NoSuchDoor { degree } => (Step::default(), Some(degree)),
                };
                let (vertex, from) = (Some(&*pose.vertex), Some(&*pose.from));
                Fields { step, vertex, from, doors, purpose: None }
            }
        };
        fields.serialize(serializer)
    }
}

/// The numbers of a cause.
#[derive(Default, Serialize)]
struct CauseNumbers {
    /// The expected number of moves, edge ends or doors, and the recorded one.
    expected: Option<u64>,
    recorded: Option<u64>,
    /// The angle by which the robot missed a door, in radians.
    off: Option<f64>,
    /// The numbers of the events between which a measurement contradicts earlier ones, and of those between which
    /// these were made.
    between: Option<[usize; 2]>,
    earlier: Option<[usize; 2]>,
}

impl CauseNumbers {
    fn of(cause: &DivergenceCause) -> Self {
        let counts = |expected: u64, recorded: u64| Self {
            expected: Some(expected),
            recorded: Some(recorded),
            ..Self::default()
        };
        match *cause {
            DivergenceCause::Number { expected, recorded } => {
                counts(expected.into(), recorded.into())
            }
            DivergenceCause::Moves { made, recorded } => counts(made as u64, recorded),
            DivergenceCause::Form { degree, doors } => counts(doors.into(), degree.into()),
            DivergenceCause::Return { before, now } => counts(before.into(), now.into()),
            DivergenceCause::Unfinished { unexplored } => counts(unexplored.into(), 0),
            DivergenceCause::Aside { off } | DivergenceCause::Entry { off } => {
                Self { off: Some(off), ..Self::default() }
            }
            DivergenceCause::Measurement { between, earlier, .. } => {
                let [between, earlier] =
                    [between, earlier].map(|events| Some(events.map(|event| event + 1)));
                Self { between, earlier, ..Self::default() }
            }
            _ => Self::default(),
        }
    }
}

impl Serialize for DivergenceReport {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Fields<'d> {
            found: Option<&'d CheckedKind>,
            allowed: &'d [Allowed],
            allowed_total: usize,
            #[serde(flatten)]
            numbers: CauseNumbers,
        }
        let Self { found, allowed, allowed_total, cause, .. } = self;
        let (found, allowed_total) = (found.as_ref(), *allowed_total);
        let numbers = CauseNumbers::of(cause);
        Fields { found, allowed, allowed_total, numbers }.serialize(serializer)
    }
}
