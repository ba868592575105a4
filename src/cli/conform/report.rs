//! The report of a judgement.

use std::path::Path;

use toposlam_conform::{
    CheckedEvent, CheckedKind, ConformVerdict, Divergence, DivergenceCause, Evidence, FORMS,
    LogHead, MeasuredHallways, Quirks, ReachedLimit, RunDriver, UndecidedCause,
};
use toposlam_logs::{
    Format,
    record::{Arrival, RunEnding},
};
use toposlam_model::{
    embedded_graph::Dart,
    folding::{SearchLimit, SmallestWorld},
    format::named_world::NamedWorld,
    mapping::{MappingAlgorithm, PartialMap},
    percept::{Percept, Sighting},
    trace::{AlgorithmCase, Departure, MatchEnd, MatchedChoices, MisfitReason, TraceEventKind},
};

use super::{JudgedLog, LISTED, folded_trail, minimise::Minimised, other_world::OtherWorld};
use crate::{
    cli::text::{counted, grouped, moment, vertices},
    picture::{self, WorldPicture},
    report::{CoveredCase, DivergenceReport, EventLine, LogReport, MessagePlace},
};

/// A scanner with a field of view of fewer degrees does not see what is behind the robot.
const ALL_AROUND: f64 = 270.0;

impl JudgedLog<'_> {
    /// The report of a log; with pictures if it is `shown` on a page.
    pub(super) fn report(
        &self,
        path: &Path,
        quirks: &Quirks,
        shorter: Option<Minimised>,
        shown: bool,
    ) -> LogReport {
        let verdict = self.judgement.verdict();
        let divergence = self.judgement.divergence.as_ref();
        let image = divergence.filter(|_| shown).and_then(|divergence| {
            let events = &self.judgement.events.events;
            let at = events.get(divergence.event).or(events.last())?;
            self.opened.image(at.source.id)
        });
        let (shorter, command) = shorter.map_or((Vec::new(), None), |shorter| {
            let events = shorter.events.events.iter().map(|event| what(&event.kind));
            (events.collect(), shorter.command)
        });
        LogReport {
            log: path.display().to_string(),
            verdict,
            remarks: self.remarks(verdict),
            facts: self.facts(),
            begun: self.opened.log.start().map(date_text),
            sources: Vec::new(),
            events: self.lines(),
            divergence: divergence.map(|divergence| self.divergence_report(divergence)),
            coverage: self.coverage(),
            tolerated: self.tolerated(quirks),
            shorter,
            command,
            image,
            folded: if shown { self.folded() } else { None },
            world: self.world().filter(|_| shown),
            twin: self.twin.as_ref().filter(|_| shown).map(OtherWorld::svg),
        }
    }

    fn remarks(&self, verdict: ConformVerdict) -> Vec<String> {
        let mut remarks = Vec::new();
        let head = LogHead(self.opened.run.as_ref());
        remarks.extend(self.known.as_ref().and_then(|known| head.other_world(&known.world.graph)));
        if let Some(truncation) = self.opened.log.truncation() {
            remarks.push(format!("the log is {truncation}"));
        }
        if let Some(skipped) = self.opened.log.skipped() {
            remarks.push(format!("skipped {skipped}"));
        }
        remarks.extend(self.gathered.skipped.in_words());
        let events = &self.judgement.events;
        match events.end.as_ref().map(|end| &end.ending) {
            Some(RunEnding::Stopped) => remarks.push("the run was stopped".to_owned()),
            Some(RunEnding::GaveUp(cause)) => {
                let colon = if cause.is_empty() { "" } else { ": " };
                remarks.push(format!("the run was given up{colon}{cause}"));
            }
            Some(RunEnding::OutOfBudget(cause)) => remarks.push(cause.clone()),
            None if events.has_head => {
                remarks.push("the log does not record how the run ended".to_owned());
            }
            Some(RunEnding::Mapped) | None => {}
        }
        let is_first = self.judgement.divergence.as_ref().is_some_and(|found| found.event == 0);
        let has_start = self.known.as_ref().is_some_and(|known| known.start.is_some());
        if is_first && has_start && self.opened.run.is_none() {
            remarks.push("the log may begin elsewhere: --start any tries every start".to_owned());
        }
        if self.judgement.divergence.as_ref().is_some_and(is_start_rule) {
            let cause = "the log may begin in the middle of a run: --driver anyone compares the doors with no \
                         algorithm";
            remarks.push(cause.to_owned());
        }
        if let Some(event) = self.judgement.unrecognised {
            let unseen = CheckedKind::Undecided(UndecidedCause::UnseenWay);
            let what = if events.events.get(event).is_some_and(|event| event.kind == unseen) {
                format!("at event {} the robot drove where its scanner did not look", event + 1)
            } else {
                format!("the junction of event {} was not recognised", event + 1)
            };
            remarks.push(format!("{what}: the events from there on are not checked"));
        }
        if let (Some(event), None) = (self.judgement.lost, &self.known) {
            remarks.push(format!(
                "the robot got lost before event {}: the events from there on are compared with no world; \
                 add --world",
                event + 1
            ));
        }
        let last = events.events.last().map(|event| &event.kind);
        if let (RunDriver::Anyone, Some(CheckedKind::Door { .. })) = (self.driver, last) {
            remarks.push("the log ends with a door: where it led is not recorded".to_owned());
        }
        // What was not searched matters only if nothing diverged.
        if verdict != ConformVerdict::Diverged {
            remarks.extend(self.judgement.limits().into_iter().map(|limit| self.limit(limit)));
        }
        if let (ConformVerdict::Conforms, Some(followed)) = (verdict, &self.judgement.algorithm)
            && followed.reached == MatchEnd::EndOfTrace
        {
            remarks.push("the log ends before the map is complete".to_owned());
        }
        if self.gathered.unreadable > 0 {
            let images = counted(self.gathered.unreadable as usize, "image");
            remarks.push(format!("{images} could not be decoded and were skipped"));
        }
        remarks
    }

    /// A limit that was reached, and the option that raises it.
    fn limit(&self, reached: ReachedLimit) -> String {
        let search = |limit| match limit {
            SearchLimit::Edges => {
                let edges = counted(self.search.max_edges.unwrap_or_default(), "edge");
                format!("the search was limited to worlds with at most {edges} (--max-edges)")
            }
            SearchLimit::Steps => {
                let steps = counted(self.search.steps as usize, "step");
                format!("the search reached its limit of {steps} (--max-steps)")
            }
            SearchLimit::Decisions => "the search has too many places to decide".to_owned(),
            SearchLimit::Stopped => "the search was stopped".to_owned(),
        };
        match reached {
            ReachedLimit::SmallerWorld(limit) => {
                format!("a smaller world may explain it: {}", search(limit))
            }
            ReachedLimit::World(limit) => {
                let class = self.search.class;
                format!("no world of class {class} was found: {}", search(limit))
            }
            ReachedLimit::Darts { algorithm, event, bound } => {
                let darts = counted(bound, "edge end");
                let option = if bound == self.dart_bound { " (--max-darts)" } else { "" };
                format!(
                    "{} was followed up to event {}: its map has more than {darts} there{option}",
                    algorithm.in_words(),
                    event + 1
                )
            }
        }
    }

    fn facts(&self) -> Vec<(&'static str, String)> {
        let judgement = &self.judgement;
        let count = counted(judgement.events.events.len(), "event");
        let made = match self.gathered.evidence {
            Evidence::Recorded => "recorded in the log".to_owned(),
            Evidence::Scenes => "inferred from scenes and odometry".to_owned(),
            Evidence::Pictures => {
                let images = grouped(self.gathered.pictures.into());
                format!("inferred from {images} images and odometry")
            }
            Evidence::Laser => {
                let scans = grouped(self.gathered.scans.into());
                format!("inferred from {scans} laser scans and odometry")
            }
        };
        let mut facts = vec![("events", format!("{count}, {made}"))];
        let field = self.gathered.field_of_view.to_degrees();
        if self.gathered.evidence == Evidence::Laser && field < ALL_AROUND {
            let unseen = "arms that point back beside the robot's way are hardly seen";
            facts.push(("scanner", format!("{field:.0} degrees: {unseen}")));
        }
        facts.extend(self.gathered.drift.map(|drift| {
            let drift = drift.to_degrees();
            let what = "scans are matched with the walls of earlier ones";
            ("odometry", format!("its heading drifts by {drift:.1} degrees in 10 m: {what}"))
        }));
        facts.extend(self.added.map(|added| ("marker", added.in_words())));
        match (&self.known, &judgement.poses) {
            (Some(known), Some(poses)) => {
                let world = known.world;
                let from = match known.start {
                    None => "from any start".to_owned(),
                    Some(start) => format!("from {}", world.start_text(start)),
                };
                let (begun, left) = (poses.left.first().unwrap_or(&0), poses.left.last());
                let fit = match (judgement.divergence.is_some(), left) {
                    (false, Some(1)) => poses.states.first().map_or(String::new(), |state| {
                        format!("the robot is {}", known.pose(state.pose))
                    }),
                    (false, left) => {
                        format!("{} left", counted(*left.unwrap_or(&0), "candidate pose"))
                    }
                    (true, _) => format!("{} at the start", counted(*begun, "candidate pose")),
                };
                facts.push(("world", format!("{}, {from}; {fit}", world.name)));
            }
            _ => facts.push(("world", self.unknown_world())),
        }
        facts.extend(lengths(judgement.measured).map(|lengths| ("lengths", lengths)));
        if let Some(doors) = folded_trail::open_doors(self) {
            facts.push(("unique", folded_trail::in_words(&doors)));
        } else if let (Some(false), ways) = (judgement.determines_world(), judgement.ways) {
            let ways = format!("the junction of the marker may have been entered in {ways} ways");
            facts.push(("unique", format!("This log does not determine its world: {ways}.")));
        }
        facts.extend(self.twin.as_ref().map(|twin| ("twin", twin.in_words())));
        if let Some(followed) = &judgement.algorithm {
            let choices = match (followed.choices, followed.algorithm) {
                (_, MappingAlgorithm::Folding) => {
                    let recovers =
                        matches!(self.driver, RunDriver::Method(method) if method.recovers());
                    let recovery = if recovers { " with recovery" } else { "" };
                    format!("those of the folding explorer{recovery}")
                }
                (MatchedChoices::Default, _) => {
                    "those of Algorithm 1 with its default choices".to_owned()
                }
                (MatchedChoices::Other { from: None }, _) => {
                    "allowed by Algorithm 1; with its default choices it would continue".to_owned()
                }
                (MatchedChoices::Other { from: Some(event) }, _) => {
                    format!(
                        "allowed by Algorithm 1; not its default choices from event {} on",
                        event + 1
                    )
                }
            };
            let doors = match &followed.reached {
                MatchEnd::Departure(departure) => {
                    format!("{choices}; up to event {}", departure.event.id)
                }
                _ => choices,
            };
            facts.push(("doors", doors));
            facts.push(("map", map_in_words(followed.run.map())));
        }
        facts
    }

    /// Every event, and the robot's pose after it.
    fn lines(&self) -> Vec<EventLine> {
        let judgement = &self.judgement;
        let begun = self.opened.log.start().unwrap_or(0);
        let mut before = String::new();
        let line = |(number, event): (usize, &CheckedEvent)| {
            let index = judgement.trace.index_of(number);
            // After a door it is not known where the robot is until it arrives.
            let in_trace = matches!(event.kind, CheckedKind::Arrival { .. }).then_some(index);
            let there = judgement.poses.as_ref().zip(self.known.as_ref()).zip(in_trace);
            let there = there.and_then(|((poses, known), event)| {
                Some(match (poses.alone.get(event)?, poses.left.get(event)?) {
                    (Some(state), _) => known.pose(state.pose),
                    (None, left) => format!("{left} candidate poses"),
                })
            });
            // A pose is shown only when it changes.
            let then = there.filter(|there| *there != before);
            if let Some(then) = &then {
                before.clone_from(then);
            }
            EventLine {
                number: number + 1,
                time: event.source.time.saturating_sub(begun) as f64 / 1e9,
                what: what(&event.kind),
                then: then.unwrap_or_default(),
            }
        };
        judgement.events.events.iter().enumerate().map(line).collect()
    }

    /// Whether the events have times. Lines need not have stamps.
    fn has_times(&self) -> bool {
        let mut events = self.judgement.events.events.iter();
        self.opened.log.format() != Format::Events || events.any(|event| event.source.time > 0)
    }

    fn divergence_report(&self, divergence: &Divergence) -> DivergenceReport {
        let events = &self.judgement.events.events;
        let begun = self.opened.log.start().unwrap_or(0);
        let event = events.get(divergence.event);
        let time = event.or(events.last()).map_or(begun, |event| event.source.time);
        DivergenceReport {
            event: divergence.event + 1,
            time: self.has_times().then(|| time.saturating_sub(begun) as f64 / 1e9),
            message: event.map(|event| MessagePlace {
                number: event.source.id.0,
                offset: event.source.offset,
                unit: self.opened.log.offset_unit(),
            }),
            fault: divergence.fault,
            cause: divergence.cause.name(),
            what: event.map_or("end of the log".to_owned(), |event| what(&event.kind)),
            why: divergence.cause.to_string(),
            allowed: self.allowed(&divergence.cause),
        }
    }

    /// What the specification allows instead.
    fn allowed(&self, cause: &DivergenceCause) -> Vec<String> {
        match cause {
            DivergenceCause::World(misfit) => {
                let candidate = |(state, why): &(toposlam_model::world::State, MisfitReason)| {
                    let pose = self.known.as_ref().map(|known| known.pose(state.pose));
                    let pose = pose.unwrap_or_default();
                    match why {
                        MisfitReason::Percept { expected } => format!("{pose}: {expected}"),
                        MisfitReason::NoSuchDoor { degree } => {
                            format!("{pose}: doors 0 to {}", degree.saturating_sub(1))
                        }
                    }
                };
                let mut allowed: Vec<_> =
                    misfit.candidates.iter().take(LISTED).map(candidate).collect();
                if let Some(more) = misfit.candidates.len().checked_sub(LISTED + 1) {
                    allowed.push(format!("and {} more", more + 1));
                }
                allowed
            }
            DivergenceCause::Algorithm(departure) => {
                departure.allowed.iter().map(ToString::to_string).collect()
            }
            DivergenceCause::Number { expected, .. } => vec![format!("number {expected}")],
            DivergenceCause::Moves { made, .. } => vec![counted(*made, "move")],
            _ => Vec::new(),
        }
    }

    fn coverage(&self) -> Vec<CoveredCase> {
        let JudgedLog { judgement, known, .. } = self;
        let default = judgement.algorithm.as_ref().map(|followed| followed.choices)
            == Some(MatchedChoices::Default);
        let run = known.as_ref().filter(|_| default);
        // Percepts of other robots may have no shapes.
        let shaped = run.filter(|_| !judgement.coverage.junctions.is_empty());
        // The folding explorer does not have the cases of Algorithm 1.
        let of_algorithm1 = if self.is_folding() { &[][..] } else { &AlgorithmCase::ALL };
        let cases = of_algorithm1.iter().map(|&case| CoveredCase {
            case: case.name().to_owned(),
            count: judgement.coverage.algorithm.count(case),
            reachable: known.as_ref().map(|known| known.reachable.count(case) > 0),
            expected: run.is_some_and(|known| known.expects_case(case)),
        });
        let junctions = FORMS.into_iter().map(|(form, name)| CoveredCase {
            case: name.to_owned(),
            count: judgement.coverage.junctions.get(&form).copied().unwrap_or(0),
            reachable: known
                .as_ref()
                .and_then(|known| known.forms.as_ref())
                .map(|forms| forms.contains(&form)),
            expected: shaped.is_some_and(|known| known.expects_form(form)),
        });
        cases.chain(junctions).collect()
    }

    fn tolerated(&self, quirks: &Quirks) -> Vec<(String, String, Vec<usize>)> {
        let tolerated = quirks.all().iter().enumerate().map(|(place, quirk)| {
            let these = self.judgement.tolerated.iter().filter(|(_, of)| *of == place);
            let events = these.map(|(divergence, _)| divergence.event + 1).collect();
            (quirk.name.clone(), quirk.reason.clone(), events)
        });
        tolerated.collect()
    }

    /// A drawing of the known world, or of the smallest one that explains the log.
    fn world(&self) -> Option<String> {
        match (&self.known, &self.judgement.smallest) {
            (Some(known), _) => {
                let own = WorldPicture::from(known.world);
                let placed = self.twin.as_ref().map(OtherWorld::first_marker);
                Some(picture::svg(&match placed {
                    None => own,
                    Some(placed) => {
                        WorldPicture { marker: self.marker, start: Some(placed), ..own }
                    }
                }))
            }
            (None, Some(SmallestWorld::World { graph, marker, .. })) => {
                let start = marker.or(Some(Dart(0)));
                let world = NamedWorld::numbered("smallest", "", graph.clone(), start);
                let world = NamedWorld { marker: Some(self.marker), ..world };
                Some(picture::svg(&WorldPicture::from(&world)))
            }
            _ => None,
        }
    }
}

/// Whether the first percept is not that of the start of a run.
fn is_start_rule(divergence: &Divergence) -> bool {
    let is_percept =
        |departure: &Departure| matches!(departure.event.kind, TraceEventKind::Percept(_));
    divergence.event == 0
        && matches!(&divergence.cause, DivergenceCause::Algorithm(departure) if is_percept(departure))
}

/// The date of a message, or the time on a clock that starts with the robot or the simulation.
fn date_text(nanoseconds: u64) -> String {
    let text = moment(nanoseconds);
    if text.ends_with("UTC") { text } else { format!("no date: {text} on the clock of the log") }
}

/// How many hallways were measured and compared; `None` if the robot did not move.
fn lengths(hallways: MeasuredHallways) -> Option<String> {
    let MeasuredHallways { moves, measured, compared } = hallways;
    match (moves, measured, compared) {
        (0, ..) => None,
        (_, 0, _) => Some("not compared: no odometry between the junctions".to_owned()),
        (_, _, 0) => Some("not compared: no hallway is known to be measured twice".to_owned()),
        _ => {
            let [compared, moves] = [compared, moves].map(|count| grouped(count as u128));
            Some(format!("{compared} of {moves} moves compared with earlier ones"))
        }
    }
}

fn map_in_words(map: &PartialMap) -> String {
    let known = (map.dart_count() - map.unexplored_count() as usize) / 2;
    let size = format!("{}, {}", vertices(map.vertex_count()), counted(known, "edge"));
    if map.complete().is_some() {
        format!("complete: {size}")
    } else {
        format!("{size} known, {} unexplored", counted(map.unexplored_count() as usize, "edge end"))
    }
}

/// The description of an event.
pub(super) fn what(kind: &CheckedKind) -> String {
    match kind {
        CheckedKind::Arrival { arrival, .. } => {
            let Arrival { degree, sighting, form, .. } = arrival;
            let name = form.and_then(|form| FORMS.iter().find(|(known, _)| *known == form));
            let kind = name.map_or(String::new(), |(_, name)| format!(" ({name})"));
            // A judged percept has its sighting.
            let sighting = sighting.unwrap_or(Sighting::Nothing);
            format!("percept: {}{kind}", Percept { degree: *degree, sighting })
        }
        CheckedKind::Door { door, .. } => format!("door {}", door.0),
        CheckedKind::Aside { off } => {
            format!("left {:.0} degrees off the nearest door", off.to_degrees())
        }
        CheckedKind::TurnedBack => "turned back".to_owned(),
        CheckedKind::Undecided(UndecidedCause::Unclear) => "junction not recognised".to_owned(),
        CheckedKind::Undecided(UndecidedCause::UnseenArm) => {
            "junction not recognised: the scanner did not look into an arm".to_owned()
        }
        CheckedKind::Undecided(UndecidedCause::UnseenWay) => {
            "drove where the scanner did not look".to_owned()
        }
    }
}
