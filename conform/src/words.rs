//! The sentences of a report, for every renderer.

use std::collections::BTreeSet;

use toposlam_logs::record::{Arrival, RunEnding};
use toposlam_model::{
    counts::{counted, grouped, vertices},
    driving::visit::JunctionShape,
    folding::SearchLimit,
    mapping::MappingAlgorithm,
    percept::{Percept, Sighting},
    trace::{Departure, MatchedChoices, MisfitReason, TraceEventKind},
};
use toposlam_vision::visits::network_fit::{NetworkFault, NetworkFit};

use super::{
    config::RunDriver,
    divergence::{DivergenceCause, FaultClass},
    events::{CheckedKind, UndecidedCause},
    extract::{Evidence, SkippedMessages},
    judgement::{ConformVerdict, ReachedLimit, Unproved},
    marked_visits::AddedMarker,
    measured_hallways::MeasuredHallways,
    possible_visits::{PossibleVisits, VisitFit},
    report::{
        Allowed, ComparedDoors, ConformReports, CoveredCase, DivergenceReport, EventPose, Facts,
        LISTED, Limit, LogReport, MapSize, MessagePlace, OpenDoor, PoseName, RequiredCoverage,
        UnprovedDivergence, WorldFact,
    },
    scan_odometry::StampCounts,
    scan_track::MatchedScans,
    twin::TwinWorld,
};

/// A scanner with a field of view of fewer degrees does not see what is behind the robot.
const ALL_AROUND: f64 = 270.0;

/// The verdict on a log.
pub fn verdict(verdict: ConformVerdict) -> &'static str {
    match verdict {
        ConformVerdict::Conforms => "conforms",
        ConformVerdict::Diverged => "diverges",
        ConformVerdict::NotKnown => "not known",
    }
}

/// The result of a log in one sentence.
pub fn result(report: &LogReport) -> String {
    match (&report.divergence, remarks(report).into_iter().next()) {
        (Some(divergence), _) => {
            let DivergenceReport { event, fault, cause, .. } = divergence;
            format!("diverges at event {event} ({fault}): {}; {cause}", found(divergence))
        }
        (None, Some(remark)) => remark,
        (None, None) => verdict(report.verdict).to_owned(),
    }
}

/// The number of logs with each verdict.
pub fn together(reports: &ConformReports) -> String {
    let [conform, diverged, not_known] =
        [ConformVerdict::Conforms, ConformVerdict::Diverged, ConformVerdict::NotKnown]
            .map(|verdict| reports.count(verdict));
    let unread = match reports.unread.len() {
        0 => String::new(),
        count => format!(", {count} unreadable"),
    };
    let logs = counted(reports.logs.len() + reports.unread.len(), "log");
    format!("{logs}: {conform} conform, {diverged} diverge, {not_known} not known{unread}")
}

pub fn fault(fault: FaultClass) -> &'static str {
    match fault {
        FaultClass::Perception => "a wrong percept",
        FaultClass::Motion => "the robot did not drive as commanded",
        FaultClass::Algorithm => "a door that the algorithm does not take, or a wrong map",
        FaultClass::Log => "the log contradicts itself",
    }
}

/// How many events of a log without a divergence fit; `None` if some visits are not certain.
pub fn fits(report: &LogReport) -> Option<String> {
    let Facts { contradiction, possible, unrecognised, .. } = &report.facts;
    let is_open = |visits: &PossibleVisits| visits.visits > visits.certain;
    if contradiction.is_none() && possible.as_ref().is_some_and(is_open) {
        return None;
    }
    let first = contradiction.as_ref().map(|found| found.event);
    if let Some(event) = first.or(unrecognised.map(|(event, _)| event)) {
        return Some(match event {
            1 => "No event is known to fit.".to_owned(),
            _ => format!("The events before event {} fit.", grouped(event as u128)),
        });
    }
    let all = match report.events.len() {
        0 => return Some("There are no events.".to_owned()),
        1 => "The only event fits".to_owned(),
        count => format!("All {} events fit", grouped(count as u128)),
    };
    let tolerated = report.tolerated.iter().flat_map(|quirk| &quirk.events);
    Some(match tolerated.collect::<BTreeSet<_>>().len() {
        0 => all + ".",
        1 => all + ", except one that is tolerated.",
        count => format!("{all}, except {} that are tolerated.", grouped(count as u128)),
    })
}

/// How often something was tolerated.
pub fn times(count: usize) -> String {
    match count {
        1 => "once".to_owned(),
        count => format!("{} times", grouped(count as u128)),
    }
}

pub fn event(kind: &CheckedKind) -> String {
    match kind {
        CheckedKind::Arrival { arrival, .. } => {
            let Arrival { degree, sighting, shape, .. } = *arrival;
            let name = shape.and_then(JunctionShape::name);
            let shape = name.map_or(String::new(), |name| format!(" ({name})"));
            // A judged percept has its sighting.
            let sighting = sighting.unwrap_or(Sighting::Nothing);
            format!("percept: {}{shape}", Percept { degree, sighting })
        }
        CheckedKind::Door { door, .. } => format!("door {}", door.0),
        CheckedKind::Action { action, .. } => action.to_string(),
        CheckedKind::LeftBetweenDoors { off } => {
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

/// What is known of the robot's pose after an event.
pub fn event_pose(pose: &EventPose) -> String {
    match pose {
        EventPose::At(pose) => pose_name(pose),
        EventPose::Candidates(count) => format!("{count} candidate poses"),
    }
}

fn pose_name(PoseName { vertex, from }: &PoseName) -> String {
    format!("at {vertex}, having come from {from}")
}

pub fn found(divergence: &DivergenceReport) -> String {
    divergence.found.as_ref().map_or("end of the log".to_owned(), event)
}

/// Where a message stands in its log.
pub fn message_place(place: &MessagePlace) -> String {
    let [number, offset] = [place.number, place.offset].map(|number| grouped(number.into()));
    format!("message {number} of the log, at {} {offset}", place.unit.name())
}

/// What is allowed instead.
pub fn allowed(divergence: &DivergenceReport) -> Vec<String> {
    match divergence.cause {
        DivergenceCause::Number { expected, .. } => return vec![format!("number {expected}")],
        DivergenceCause::Moves { made, .. } => return vec![counted(made, "move")],
        _ => {}
    }
    let mut listed: Vec<_> = divergence
        .allowed
        .iter()
        .map(|allowed| match allowed {
            Allowed::Step(step) => step.to_string(),
            Allowed::InWorld(pose, MisfitReason::Percept { expected }) => {
                format!("{}: {expected}", pose_name(pose))
            }
            Allowed::InWorld(pose, MisfitReason::NoSuchDoor { degree }) => {
                format!("{}: doors 0 to {}", pose_name(pose), degree.saturating_sub(1))
            }
            Allowed::InWorld(pose, MisfitReason::Refused(refused)) => {
                format!("{}: {refused}", pose_name(pose))
            }
        })
        .collect();
    listed.extend(more(listed.len(), divergence.allowed_total));
    listed
}

/// How many of all are not listed.
fn more(listed: usize, all: usize) -> Option<String> {
    (all > listed).then(|| format!("and {} more", all - listed))
}

/// The reasons for the verdict, and further remarks; what was skipped or repaired comes last.
pub fn remarks(report: &LogReport) -> Vec<String> {
    let LogReport { facts, verdict, events, .. } = report;
    let mut remarks: Vec<String> = other_world(facts).into_iter().collect();
    remarks.extend(facts.truncated.as_ref().map(|truncation| format!("the log is {truncation}")));
    match &facts.ending {
        Some(RunEnding::Stopped) => remarks.push("the run was stopped".to_owned()),
        Some(RunEnding::GaveUp(cause)) => {
            let colon = if cause.is_empty() { "" } else { ": " };
            remarks.push(format!("the run was given up{colon}{cause}"));
        }
        Some(RunEnding::OutOfBudget(cause)) => remarks.push(cause.clone()),
        None if facts.lacks_end => {
            remarks.push("the log does not record how the run ended".to_owned());
        }
        Some(RunEnding::Mapped) | None => {}
    }
    let diverges = report.divergence.as_ref().map(|found| (found.event, &found.cause));
    let contradicts = facts.contradiction.as_ref().map(|found| (found.event, &found.cause));
    if let Some((1, cause)) = diverges.or(contradicts) {
        if !facts.has_head && facts.world.as_ref().is_some_and(|world| world.start.is_some()) {
            remarks.push("the log may begin elsewhere: --start any tries every start".to_owned());
        }
        // The first percept is not that of the start of a run.
        if let DivergenceCause::Algorithm(Departure { event, .. }) = cause
            && let TraceEventKind::Percept(_) = event.kind
        {
            let cause = "the log may begin in the middle of a run: --driver anyone compares the doors with no \
                         algorithm";
            remarks.push(cause.to_owned());
        }
    }
    remarks.extend(facts.possible.as_ref().and_then(|visits| no_network(&visits.network)));
    if facts.matched_scans.is_some() {
        let cause = "the log has no odometry: how far the robot drove along corridors is not known";
        remarks.push(cause.to_owned());
    }
    remarks.extend(facts.contradiction.as_ref().map(unproved));
    remarks.extend(facts.possible.as_ref().and_then(|visits| possible(visits, report)));
    if let Some((event, why)) = facts.unrecognised
        && facts.possible.is_none()
    {
        let what = match why {
            UndecidedCause::UnseenWay => {
                format!("at event {event} the robot drove where its scanner did not look")
            }
            _ => format!("the junction of event {event} was not recognised"),
        };
        remarks.push(format!("{what}: the events from there on are not checked"));
    }
    if let (Some(event), None) = (facts.lost, &facts.world) {
        remarks.push(format!(
            "the robot got lost before event {event}: the events from there on are compared with no world; \
             add --world"
        ));
    }
    let last = events.last().map(|event| &event.kind);
    if let (RunDriver::Anyone, Some(CheckedKind::Door { .. })) = (report.driver, last) {
        remarks.push("the log ends with a door: where it led is not recorded".to_owned());
    }
    // What was not searched matters only if nothing diverged.
    if *verdict != ConformVerdict::Diverged {
        remarks.extend(report.limits.iter().map(|reached| limit(reached, facts)));
    }
    if *verdict == ConformVerdict::Conforms && facts.doors.is_some_and(|doors| doors.is_cut) {
        remarks.push("the log ends before the map is complete".to_owned());
    }
    if facts.unreadable_images > 0 {
        let images = counted(facts.unreadable_images as usize, "image");
        remarks.push(format!("{images} could not be decoded and were skipped"));
    }
    remarks.extend(reading(facts));
    remarks
}

/// What does not fit, and why it accuses nobody.
fn unproved(divergence: &UnprovedDivergence) -> String {
    let UnprovedDivergence { event: number, found, cause, why } = divergence;
    let found = found.as_ref().map_or("end of the log".to_owned(), event);
    let why = match why {
        Unproved::Scans => "what scans show may be wrong where the robot did not drive",
        Unproved::Poses => "where odometry drifts, a pass may lie beside the place that it is of",
        Unproved::Lost => {
            "the log records that the robot got lost, which inferred events do not show"
        }
        Unproved::Obstacle => {
            "the log records that the robot turned back at an obstacle, which inferred events do not show"
        }
    };
    format!("event {number} does not fit: {found}; {cause}. This accuses nobody: {why}")
}

/// Why the building is no network of corridors.
fn no_network(network: &NetworkFit) -> Option<String> {
    let why = match network.fault? {
        NetworkFault::Wide => {
            let part = (100.0 * network.wide).round();
            format!("on {part} % of the robot's way free space is wider than a corridor")
        }
        NetworkFault::ManyDoors => {
            let visits = counted(network.many_doors, "visit");
            format!("{visits} may be of places with more doors than a junction of corridors has")
        }
    };
    Some(format!("this building is not a network of corridors: {why}"))
}

/// The visits of a log that are not certain, and whether some choice of their percepts fits.
fn possible(visits: &PossibleVisits, report: &LogReport) -> Option<String> {
    let PossibleVisits { visits: all, certain, fit, algorithm, decided_by_world, .. } = visits;
    let (world, no_choice) = if report.facts.world.is_some() {
        ("the world", "the world fits no choice of their percepts")
    } else {
        ("some world", "no world fits any choice of their percepts")
    };
    let mut parts = Vec::new();
    if certain < all {
        parts.push(format!("{} of {all} visits not certain", all - certain));
    }
    match fit {
        VisitFit::Fits | VisitFit::NotKnown if certain == all => {}
        // The first event that does not fit is named.
        VisitFit::Contradiction if report.facts.contradiction.is_some() => {}
        VisitFit::Contradiction => parts.push(no_choice.to_owned()),
        VisitFit::Anything => parts.push(
            "any visits would fit: there is no marker, and the robot never turned back".to_owned(),
        ),
        VisitFit::UnseenWay => parts.push(
            "the robot drove where its scanner did not look, and may have passed more there"
                .to_owned(),
        ),
        VisitFit::NotKnown => {
            parts.push(format!("whether their percepts fit {world} is not known"));
        }
        VisitFit::Fits if report.driver != RunDriver::Anyone && *algorithm != Some(VisitFit::Fits) => {
            let doors = match algorithm {
                Some(VisitFit::Contradiction) => {
                    "the algorithm does not take the doors of any that does"
                }
                Some(_) => "whether the algorithm takes the doors of one that does is not known",
                None => "the doors of the algorithm are not compared with it",
            };
            parts.push(format!("a choice of their percepts fits {world}, but {doors}"));
        }
        VisitFit::Fits if *algorithm == Some(VisitFit::Fits) && visits.is_certain_enough() => {
            parts.push(format!(
                "a choice of their percepts fits {world}, and the algorithm takes its doors"
            ));
        }
        VisitFit::Fits if visits.is_certain_enough() => {
            parts.push(format!("a choice of their percepts fits {world}"));
        }
        VisitFit::Fits => parts.push(format!(
            "a choice of their percepts fits {world}, which says little: less than two thirds are certain"
        )),
    }
    if *fit == VisitFit::Fits && visits.records_map && certain < all {
        parts.push("the map that the log records is not compared".to_owned());
    }
    let decided: Vec<_> = decided_by_world.iter().map(|visit| (visit + 1).to_string()).collect();
    match &decided[..] {
        [] => {}
        [one] => parts.push(format!("the world decides visit {one}")),
        several => parts.push(format!("the world decides visits {}", several.join(", "))),
    }
    // If they agreed at each place, less would fit.
    let is_chosen = match fit {
        VisitFit::Fits => certain < all && *all > 1,
        VisitFit::Contradiction => certain < all || is_driven(report),
        _ => false,
    };
    if is_chosen {
        parts.push("visits of one place are chosen from one by one".to_owned());
    }
    (!parts.is_empty()).then(|| parts.join("; "))
}

/// Whether what was driven or is seen to end does not fit the known world.
fn is_driven(report: &LogReport) -> bool {
    let cause = report.facts.contradiction.as_ref().map(|found| &found.cause);
    matches!(cause, Some(DivergenceCause::Driven))
}

/// A remark on a log that was recorded in another world.
pub fn other_world(facts: &Facts) -> Option<String> {
    let recorded = facts.recorded.as_ref().filter(|it| it.same_world == Some(false))?;
    let comma = if recorded.world.is_empty() { "" } else { ", " };
    Some(format!("the log was recorded in another world{comma}{}", recorded.world))
}

/// Remarks on what was skipped or repaired when the log was read.
pub fn reading(facts: &Facts) -> Vec<String> {
    let times = facts.line_times.map(|times| times.to_string());
    let skipped = [skipped_lines(facts), times, skipped_messages(facts.skipped_messages)];
    let repaired = facts.reading.iter().map(ToString::to_string);
    skipped.into_iter().chain(stamps(facts.stamps)).flatten().chain(repaired).collect()
}

/// Remarks on messages that were not recorded in the order of their stamps.
fn stamps(counts: StampCounts) -> [Option<String>; 2] {
    let StampCounts { late_scans, late_odometry, other_clock } = counts;
    let late = [(late_scans, "scan"), (late_odometry, "odometry reading")];
    let late = late.into_iter().filter(|(count, _)| *count > 0);
    let late: Vec<_> = late.map(|(count, what)| counted(count as usize, what)).collect();
    let late = (!late.is_empty())
        .then(|| format!("recorded late, and placed by the stamps: {}", late.join(", ")));
    let other = (other_clock > 0).then(|| {
        let scans = counted(other_clock as usize, "scan");
        format!("placed by the order of the log: {scans} whose stamps are far from those of the odometry")
    });
    [late, other]
}

/// A remark on the lines that were skipped; `None` if there are none.
fn skipped_lines(facts: &Facts) -> Option<String> {
    facts.skipped_lines.as_ref().map(|skipped| format!("skipped {skipped}"))
}

/// A remark on the messages that were skipped; `None` if there are none.
fn skipped_messages(skipped: SkippedMessages) -> Option<String> {
    let SkippedMessages { off_clock, scans_without_odometry } = skipped;
    let far = format!("{} whose time is far from that of all others", grouped(off_clock.into()));
    let scans = format!("{} without odometry", counted(scans_without_odometry as usize, "scan"));
    let reasons = [(off_clock, far), (scans_without_odometry, scans)];
    let reasons = reasons.into_iter().filter(|(count, _)| *count > 0);
    let parts: Vec<_> = reasons.map(|(_, what)| what).collect();
    (!parts.is_empty()).then(|| format!("skipped messages: {}", parts.join(", ")))
}

/// A limit that was reached, and the option that raises it.
fn limit(reached: &Limit, facts: &Facts) -> String {
    let Limit { option, value, .. } = *reached;
    let option = option.map_or(String::new(), |option| format!(" ({option})"));
    let value = value.unwrap_or_default() as usize;
    let search = |limit| match limit {
        SearchLimit::Edges => {
            let edges = counted(value, "edge");
            format!("the search was limited to worlds with at most {edges}{option}")
        }
        SearchLimit::Steps => {
            format!("the search reached its limit of {}{option}", counted(value, "step"))
        }
        SearchLimit::Decisions => "the search has too many places to decide".to_owned(),
        SearchLimit::Stopped => "the search was stopped".to_owned(),
        SearchLimit::Aid => "worlds are not searched for a marking aid that moves".to_owned(),
    };
    match reached.reached {
        ReachedLimit::SmallerWorld(limit) => {
            format!("a smaller world may explain it: {}", search(limit))
        }
        ReachedLimit::World(limit) => {
            let class = facts.class.map_or(String::new(), |class| format!(" of class {class}"));
            format!("no world{class} was found: {}", search(limit))
        }
        ReachedLimit::Darts { algorithm, event, .. } => {
            let darts = counted(value, "edge end");
            format!(
                "{} was followed up to event {}: its map has more than {darts} there{option}",
                algorithm.in_words(),
                event + 1
            )
        }
    }
}

/// What was checked, and against what: names and texts.
pub fn facts(report: &LogReport) -> Vec<(&'static str, String)> {
    let facts = &report.facts;
    let field = facts.field_of_view.to_degrees();
    let is_narrow = facts.evidence == Evidence::Laser && field < ALL_AROUND;
    let texts = [
        ("events", Some(events(report))),
        (
            "scanner",
            is_narrow.then(|| {
                let unseen = "arms that point back beside the robot's way are hardly seen";
                format!("{field:.0} degrees: {unseen}")
            }),
        ),
        (
            "odometry",
            match facts.matched_scans {
                Some(matched) => Some(without_odometry(matched)),
                None => facts.drift.map(drift),
            },
        ),
        ("marker", facts.added_marker.map(added_marker)),
        ("world", Some(world(report))),
        ("lengths", lengths(facts.lengths)),
        ("unique", unique(facts)),
        ("twin", facts.twin.as_ref().map(twin)),
        ("doors", facts.doors.map(doors)),
        ("map", facts.map.map(map)),
    ];
    texts.into_iter().filter_map(|(name, text)| Some((name, text?))).collect()
}

fn events(report: &LogReport) -> String {
    let Facts { evidence, images, scans, matched_scans, .. } = report.facts;
    let count = counted(report.events.len(), "event");
    let source = match evidence {
        Evidence::Recorded => "recorded in the log".to_owned(),
        Evidence::Scenes => "inferred from scenes and odometry".to_owned(),
        Evidence::Images => {
            format!("inferred from {} images and odometry", grouped(images.into()))
        }
        Evidence::Laser => {
            let odometry = if matched_scans.is_some() { "" } else { " and odometry" };
            format!("inferred from {} laser scans{odometry}", grouped(scans.into()))
        }
    };
    format!("{count}, {source}")
}

fn drift(drift: f64) -> String {
    let drift = drift.to_degrees();
    let what = "scans are matched with the walls of earlier ones";
    format!("its heading drifts by {drift:.1} degrees in 10 m: {what}")
}

fn without_odometry(MatchedScans { unmatched, .. }: MatchedScans) -> String {
    let skipped = match unmatched {
        0 => String::new(),
        1 => "; 1 scan that matches nothing is skipped".to_owned(),
        _ => format!("; {} that match nothing are skipped", counted(unmatched as usize, "scan")),
    };
    format!(
        "not recorded: scans are placed by the walls of earlier ones, and lengths along corridors are not \
         certain{skipped}"
    )
}

fn added_marker(added: AddedMarker) -> String {
    match added {
        AddedMarker::Assumed { position: [x, y], heading, seen } => {
            let towards = heading.map_or(String::new(), |heading| {
                format!(", heading {:.0} degrees", heading.to_degrees())
            });
            format!(
                "assumed, not in the log: at x {x:.1} m, y {y:.1} m of odometry{towards}; seen at {}",
                counted(seen, "visit")
            )
        }
        AddedMarker::Fiducial { sightings, elsewhere } => {
            let elsewhere = match elsewhere {
                0 => String::new(),
                count => format!(", {count} of them at no junction that was visited"),
            };
            format!("a fiducial with {}{elsewhere}", counted(sightings, "sighting"))
        }
    }
}

fn world(report: &LogReport) -> String {
    let facts = &report.facts;
    if let Some(world) = &facts.world
        && let Some(left) = world.candidates_left
    {
        let WorldFact { name, start, candidates_at_start, pose, .. } = world;
        let from = match start {
            None => "from any start".to_owned(),
            Some(start) => format!("from {start}"),
        };
        let diverges = report.divergence.is_some() || facts.contradiction.is_some();
        let fit = match (diverges, left, pose) {
            (true, ..) => {
                format!("{} at the start", counted(*candidates_at_start, "candidate pose"))
            }
            (false, _, Some(pose)) => format!("the robot is {}", pose_name(pose)),
            (false, left, None) => format!("{} left", counted(left, "candidate pose")),
        };
        return format!("{name}, {from}; {fit}");
    }
    let Some(smallest) = &facts.smallest else { return "unknown".to_owned() };
    let size = format!("{}, {}", counted(smallest.edges, "edge"), vertices(smallest.vertices));
    match (facts.unique, smallest.least) {
        (Some(true), _) => format!("unknown; the only one that explains the log has {size}"),
        (_, true) => format!("unknown; the smallest that explains the log has {size}"),
        (_, false) => format!("unknown; one that explains the log has {size}"),
    }
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

/// Whether the log determines its world; `None` if that is not known.
pub fn unique(facts: &Facts) -> Option<String> {
    let Some(doors) = &facts.never_followed else {
        return (facts.unique == Some(false)).then(|| {
            let ways =
                format!("the junction of the marker may have been entered in {} ways", facts.ways);
            format!("This log does not determine its world: {ways}.")
        });
    };
    let never = match doors.len() {
        0 => return Some("This log determines its world.".to_owned()),
        1 => "1 door was".to_owned(),
        count => format!("{count} doors were"),
    };
    let door = |OpenDoor { vertex, door, toward }: &OpenDoor| match toward {
        Some(toward) => format!("{vertex} toward {toward}"),
        None => format!("{vertex} door {door}"),
    };
    let mut listed: Vec<String> = doors.iter().take(LISTED).map(door).collect();
    listed.extend(more(listed.len(), doors.len()));
    let listed = listed.join(", ");
    Some(format!("This log does not determine its world: {never} never followed: {listed}."))
}

fn twin(twin: &TwinWorld) -> String {
    let TwinWorld { vertices: count, edges, genus, figure, worlds, marker, first_figure, .. } =
        twin;
    let first = first_figure.map_or(String::new(), |figure| format!(", {figure} of the paper"));
    let other = figure.map_or(String::new(), |figure| format!(": {figure} of the paper"));
    let size = format!("{}, {} and genus {genus}", vertices(*count), counted(*edges, "edge"));
    let more = match (worlds, twin.may_be_more) {
        (1, false) => String::new(),
        (count, false) => format!(" There are {count} such worlds with as many edges."),
        (count, true) => format!(" There are at least {count} such worlds with as many edges."),
    };
    format!(
        "Another world explains this log as well, with {size}{other}. With an {} marker no walk \
         distinguishes it from the world above{first}.{more}",
        marker.name()
    )
}

fn doors(doors: ComparedDoors) -> String {
    let ComparedDoors { algorithm, choices, recovers, departs_after, .. } = doors;
    let choices = match (choices, algorithm) {
        (MatchedChoices::Default, MappingAlgorithm::Algorithm1) => {
            "those of Algorithm 1 with its default choices".to_owned()
        }
        (MatchedChoices::Default, other) => {
            let recovery = if recovers { " with recovery" } else { "" };
            format!("those of {}{recovery}", other.in_words())
        }
        (MatchedChoices::Other { from: None }, _) => {
            "allowed by Algorithm 1; with its default choices it would continue".to_owned()
        }
        (MatchedChoices::Other { from: Some(event) }, _) => {
            let event = event + 1;
            format!("allowed by Algorithm 1; not its default choices from event {event} on")
        }
    };
    match departs_after {
        Some(event) => format!("{choices}; up to event {event}"),
        None => choices,
    }
}

fn map(MapSize { complete, vertices: count, edges, unexplored }: MapSize) -> String {
    let size = format!("{}, {}", vertices(count), counted(edges, "edge"));
    if complete {
        format!("complete: {size}")
    } else {
        format!("{size} known, {} unexplored", counted(unexplored, "edge end"))
    }
}

/// The cases that are covered, and those that are not but can be.
pub fn covered(coverage: &[CoveredCase]) -> String {
    // A run that diverged may cover cases that its world does not have.
    let is_possible = |case: &&CoveredCase| case.count > 0 || case.reachable != Some(false);
    let (covered, missed): (Vec<_>, Vec<_>) =
        coverage.iter().filter(is_possible).partition(|case| case.count > 0);
    let counts: Vec<_> = covered
        .iter()
        .map(|CoveredCase { case, count, .. }| format!("{case} {}", grouped((*count).into())))
        .collect();
    let missed: Vec<_> = missed.iter().map(|case| case.case).collect();
    let part = |head: &str, list: String| {
        if list.is_empty() { String::new() } else { format!("{head}: {list}") }
    };
    format!(
        "{} of {} cases{}{}",
        covered.len(),
        covered.len() + missed.len(),
        part("", counts.join(", ")),
        part("; not covered", missed.join(", "))
    )
}

/// Which required cases are not covered.
pub fn required(coverage: &RequiredCoverage) -> String {
    let RequiredCoverage { required, not_covered, not_applicable } = coverage;
    let not_covered = match &not_covered[..] {
        [] => "all are covered".to_owned(),
        not => format!("not covered: {}", not.join(", ")),
    };
    let foreign = match &not_applicable[..] {
        [] => String::new(),
        cases => format!("; only Algorithm 1 has these cases: {}", cases.join(", ")),
    };
    let cases = if required.len() == 1 { "required case" } else { "required cases" };
    format!("{} {cases}: {not_covered}{foreign}", required.len())
}
