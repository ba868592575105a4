//! The report on a log as data. [`words`](super::words) makes sentences of it, [`json`](super::json) its JSON lines.

mod events;
mod facts;

use serde::Serialize;
use toposlam_logs::{Format, error::OffsetUnit};
use toposlam_model::{
    driving::visit::JUNCTION_SHAPES,
    embedded_graph::Dart,
    folding::{FoldedTrail, SearchLimit},
    mapping::MappingAlgorithm,
    trace::{AlgorithmCase, AllowedStep, MatchedChoices, MisfitReason},
};

pub(super) use events::MarkerSeen;
pub use events::{EventPose, PoseName, ReportedEvent, ReportedVisit};
pub use facts::{
    ComparedDoors, Facts, MapSize, OpenDoor, RecordedWorld, SmallestFound, UnprovedDivergence,
    WorldFact,
};

use super::{
    check::{CheckedLog, LogSource},
    config::{ConformConfig, RunDriver},
    divergence::{Divergence, DivergenceCause, FaultClass},
    events::CheckedKind,
    judgement::{ConformVerdict, ReachedLimit},
};

/// The largest number of candidates or doors that are listed.
pub(super) const LISTED: usize = 8;

/// The reports on the logs of one command.
#[derive(Clone, Debug, Default)]
pub struct ConformReports {
    pub logs: Vec<LogReport>,
    pub unread: Vec<UnreadLog>,
    /// The cases that the logs must cover together, if some are required.
    pub required: Option<RequiredCoverage>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnreadLog {
    pub log: String,
    pub cause: String,
}

#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct RequiredCoverage {
    pub required: Vec<String>,
    pub not_covered: Vec<String>,
    /// The cases of Algorithm 1, if all logs are compared with the folding explorer.
    pub not_applicable: Vec<String>,
}

/// A file that was read for a report.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SourceFile {
    /// What it is, for example `log`.
    pub role: &'static str,
    pub path: String,
    /// The SHA-256 hash of its bytes, in hexadecimal.
    pub sha256: String,
}

/// The report on a log. It is serialized as a line of `conform --json`.
#[derive(Clone, Debug, Default)]
pub struct LogReport {
    pub log: String,
    pub verdict: ConformVerdict,
    pub events: Vec<ReportedEvent>,
    /// The junctions that the robot visited, as they were inferred.
    pub visits: Vec<ReportedVisit>,
    pub divergence: Option<DivergenceReport>,
    /// The number of events before the divergence or the first junction that was not recognised, or of all.
    pub matched: usize,
    /// The number of poses that remain possible.
    pub candidates: usize,
    pub coverage: Vec<CoveredCase>,
    pub limits: Vec<Limit>,
    pub tolerated: Vec<ToleratedQuirk>,
    /// The events of a shorter log that diverges in the same way.
    pub shorter: Vec<CheckedKind>,
    /// The command that checks it, if it was written.
    pub command: Option<String>,
    pub facts: Facts,
    pub driver: RunDriver,
    /// When the first message was recorded, in nanoseconds; `None` if there is none.
    pub begun: Option<u64>,
    /// The files that were read, if their hashes are wanted.
    pub sources: Vec<SourceFile>,
    /// The camera image at the divergence, or the last one before it, as a JPEG or PNG file.
    pub image: Option<Vec<u8>>,
    /// What the events before the divergence, or all events, prove about the world; `None` if this is not
    /// known, or if the log determines its world.
    pub folded: Option<FoldedReport>,
}

/// The first divergence. Its JSON has the event, what is allowed instead, and the numbers of the cause.
#[derive(Clone, Debug, Serialize)]
pub struct DivergenceReport {
    /// The number of the event, from 1; one more than there are if an event is missing at the end.
    #[serde(skip)]
    pub event: usize,
    /// Seconds since the first message; `None` if the log has no times.
    #[serde(skip)]
    pub time: Option<f64>,
    /// The message of the event; none at the end.
    #[serde(skip)]
    pub message: Option<MessagePlace>,
    #[serde(skip)]
    pub fault: FaultClass,
    pub found: Option<CheckedKind>,
    /// The first of what is allowed instead.
    pub allowed: Vec<Allowed>,
    /// The number of all that is allowed instead.
    pub allowed_total: usize,
    #[serde(flatten)]
    pub cause: DivergenceCause,
}

/// What is allowed instead of an event.
#[derive(Clone, Debug, PartialEq)]
pub enum Allowed {
    /// In a pose of the known world.
    InWorld(PoseName, MisfitReason),
    Step(AllowedStep),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MessagePlace {
    /// From 1.
    pub number: u64,
    /// Its offset in its file.
    pub offset: u64,
    pub unit: OffsetUnit,
}

/// A specification case, and how often a log covered it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CoveredCase {
    pub case: &'static str,
    pub count: u64,
    /// Whether the known world can reach it; `None` if no world is known.
    pub reachable: Option<bool>,
    /// Whether a complete run from the log's start has it: the algorithm with its default choices, in the
    /// known world.
    pub expected: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Limit {
    /// The option of `conform` that raises it.
    pub option: Option<&'static str>,
    pub value: Option<u64>,
    /// Whether the verdict depends on it.
    pub decides: bool,
    /// The number of the event at which it was reached.
    pub event: Option<usize>,
    #[serde(skip)]
    pub reached: ReachedLimit,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ToleratedQuirk {
    pub name: String,
    pub reason: String,
    pub events: Vec<usize>,
}

/// A folded trail that does not determine its world.
#[derive(Clone, Debug)]
pub struct FoldedReport {
    pub trail: FoldedTrail,
    /// The dart by which the robot first came to each vertex.
    pub entries: Vec<Dart>,
}

impl CheckedLog {
    /// The report on a log that was checked.
    pub fn report(&self, source: &LogSource, log: String) -> LogReport {
        let judgement = &self.judgement;
        let divergence = judgement.divergence.as_ref();
        let events = self.reported_events(source);
        let matched = divergence.map(|found| found.event).or(judgement.unrecognised);
        LogReport {
            log,
            verdict: judgement.verdict(),
            visits: ReportedVisit::all(&self.extracted, judgement.possible.as_ref()),
            divergence: divergence.map(|divergence| self.divergence_report(source, divergence)),
            matched: matched.unwrap_or(events.len()),
            candidates: judgement.candidates(),
            coverage: self.coverage(),
            limits: judgement.limits().into_iter().map(|limit| self.limit(limit)).collect(),
            tolerated: self.tolerated(),
            facts: self.facts(source),
            driver: self.config.driver,
            begun: source.log.start(),
            folded: self.folded(),
            events,
            ..LogReport::default()
        }
    }

    fn divergence_report(&self, source: &LogSource, divergence: &Divergence) -> DivergenceReport {
        let Divergence { event: index, ref cause, fault } = *divergence;
        let events = &self.judgement.events.events;
        let begun = source.log.start().unwrap_or(0);
        let event = events.get(index);
        let time = event.or(events.last()).map_or(begun, |event| event.source.time);
        // Lines need not have stamps.
        let are_known = source.log.irregular_times().is_none_or(|times| times.are_known());
        let has_times = are_known
            && (source.log.format() != Format::Events
                || events.iter().any(|event| event.source.time > 0));
        let (allowed, allowed_total) = self.allowed(cause);
        DivergenceReport {
            event: index + 1,
            time: has_times.then(|| time.saturating_sub(begun) as f64 / 1e9),
            message: event.map(|event| MessagePlace {
                number: event.source.id.0,
                offset: event.source.offset,
                unit: source.log.offset_unit(),
            }),
            fault,
            cause: cause.clone(),
            found: event.map(|event| event.kind.clone()),
            allowed,
            allowed_total,
        }
    }

    fn allowed(&self, cause: &DivergenceCause) -> (Vec<Allowed>, usize) {
        match cause {
            DivergenceCause::World(misfit) => {
                let allowed = misfit.candidates.iter().take(LISTED).filter_map(|(state, why)| {
                    Some(Allowed::InWorld(self.known.as_ref()?.pose_name(state.pose), *why))
                });
                (allowed.collect(), misfit.candidates.len())
            }
            DivergenceCause::Algorithm(departure) => {
                let allowed = departure.allowed.iter().copied().map(Allowed::Step);
                (allowed.collect(), departure.allowed.len())
            }
            _ => (Vec::new(), 0),
        }
    }

    fn coverage(&self) -> Vec<CoveredCase> {
        let Self { judgement: super::Judgement { coverage, algorithm, .. }, known, .. } = self;
        let known = known.as_ref();
        let is_default =
            algorithm.as_ref().map(|followed| followed.choices) == Some(MatchedChoices::Default);
        let run = known.filter(|_| is_default);
        // Percepts of other robots may have no shapes.
        let shaped = run.filter(|_| !coverage.junctions.is_empty());
        let mut cases = Vec::new();
        // Other algorithms do not have its cases.
        if algorithm.as_ref().is_none_or(|it| it.algorithm == MappingAlgorithm::Algorithm1) {
            cases.extend(AlgorithmCase::ALL.map(|case| CoveredCase {
                case: case.name(),
                count: coverage.algorithm.count(case),
                reachable: known.map(|known| known.reaches(case)),
                expected: run.is_some_and(|known| known.expects(case)),
            }));
        }
        cases.extend(JUNCTION_SHAPES.map(|(shape, case)| CoveredCase {
            case,
            count: coverage.junctions.get(&shape).copied().unwrap_or(0),
            reachable: known.and_then(|known| known.has_shape(shape)),
            expected: shaped.is_some_and(|known| known.expects_shape(shape)),
        }));
        cases
    }

    /// A limit that was reached, and the option that raises it.
    fn limit(&self, reached: ReachedLimit) -> Limit {
        let ConformConfig { search, dart_bound, .. } = self.config;
        let none = Limit { option: None, value: None, decides: true, event: None, reached };
        let raised = |option, value| Limit { option: Some(option), value: Some(value), ..none };
        let of_search = |limit| match limit {
            SearchLimit::Edges => raised("--max-edges", search.max_edges.unwrap_or(0) as u64),
            SearchLimit::Steps => raised("--max-steps", search.steps),
            SearchLimit::Decisions | SearchLimit::Stopped | SearchLimit::Aid => none,
        };
        match reached {
            ReachedLimit::SmallerWorld(limit) => Limit { decides: false, ..of_search(limit) },
            ReachedLimit::World(limit) => of_search(limit),
            ReachedLimit::Darts { event, bound, .. } => {
                let option = (bound == dart_bound).then_some("--max-darts");
                Limit { option, value: Some(bound as u64), event: Some(event + 1), ..none }
            }
        }
    }

    fn tolerated(&self) -> Vec<ToleratedQuirk> {
        let tolerated = self.quirks.quirks.iter().enumerate().map(|(place, quirk)| {
            let these = self.judgement.tolerated.iter().filter(|(_, of)| *of == place);
            ToleratedQuirk {
                name: quirk.name.clone(),
                reason: quirk.reason.clone(),
                events: these.map(|(divergence, _)| divergence.event + 1).collect(),
            }
        });
        tolerated.collect()
    }

    fn folded(&self) -> Option<FoldedReport> {
        let trail = self.judgement.trail.clone()?;
        let entries = trail.first_entries(self.judgement.trace.doors());
        (self.judgement.determines_world() != Some(true)).then_some(FoldedReport { trail, entries })
    }
}

impl LogReport {
    /// Whether its coverage says something: a robot that no algorithm drove, or whose percepts have no shapes, need not show
    /// any case.
    pub fn has_coverage(&self) -> bool {
        self.coverage.iter().any(|case| case.count > 0)
    }

    /// The coverage of several logs together. A case is reachable if it is in the world of any log.
    pub fn coverage_of(reports: &[Self]) -> Vec<CoveredCase> {
        let mut together: Vec<CoveredCase> = Vec::new();
        for covered in reports.iter().flat_map(|report| &report.coverage) {
            match together.iter_mut().find(|known| known.case == covered.case) {
                None => together.push(covered.clone()),
                Some(known) => {
                    known.count = known.count.saturating_add(covered.count);
                    known.expected |= covered.expected;
                    known.reachable = match (known.reachable, covered.reachable) {
                        (Some(true), _) | (_, Some(true)) => Some(true),
                        (Some(false), Some(false)) => Some(false),
                        _ => None,
                    };
                }
            }
        }
        together
    }
}

impl RequiredCoverage {
    /// Which required cases are not covered by these logs.
    #[must_use]
    pub fn from_reports(required: &[String], reports: &[LogReport]) -> Self {
        let all = LogReport::coverage_of(reports);
        let covers = |case: &String| all.iter().any(|known| known.case == case && known.count > 0);
        let not_covered: Vec<_> = required.iter().filter(|case| !covers(case)).cloned().collect();
        let is_foreign = |case: &&String| !all.iter().any(|known| known.case == case.as_str());
        let not_applicable = not_covered.iter().filter(is_foreign).cloned().collect();
        Self { required: required.to_vec(), not_covered, not_applicable }
    }
}

/// The names of all cases: those of Algorithm 1, and the shapes of junctions.
pub fn case_names() -> impl Iterator<Item = &'static str> {
    let shapes = JUNCTION_SHAPES.into_iter().map(|(_, name)| name);
    AlgorithmCase::ALL.into_iter().map(AlgorithmCase::name).chain(shapes)
}
