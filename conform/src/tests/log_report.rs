//! The report on a log: its numbers, its visits, and the cases of several logs together.

use toposlam_logs::reader;
use toposlam_model::{aid::AidAction, marker::NoMarker};

use super::{
    log_check::{Question, fork_world, lines, past_fork},
    *,
};
use crate::{
    CheckedLog, ConformReports, CoveredCase, DoorChooser, Evidence, LogReport, LogSource,
    RobotStart, UnreadLog,
};

fn reported(checked: &CheckedLog, log: &[u8]) -> LogReport {
    let log = reader::Log::of_bytes(log.to_vec()).unwrap();
    let topics = toposlam_logs::topic_map::TopicMap::unambiguous(&log);
    let source = LogSource { log: &log, topics: &topics, head: None, sensor: None };
    checked.report(&source, "log".to_owned())
}

/// A log of a robot without a marker that goes where it likes.
fn by_anyone(log: &[u8], evidence: Evidence) -> Question<'_> {
    let (aid, doors) = (Some(NoMarker.into()), DoorChooser::Anyone);
    Question { aid, doors, ..Question::new(log, evidence) }
}

#[test]
fn events_are_counted_from_one_and_dated_since_the_first_message() {
    let mut walk = lines(&[(3, 1, None)]);
    walk.extend(b"{\"kind\":\"event\",\"degree\":null,\"door\":null}\n");
    let mut checked = by_anyone(&walk, Evidence::Recorded).checked().unwrap();
    let unclear = Some((3, UndecidedCause::Unclear));
    assert_eq!(reported(&checked, &walk).facts.unrecognised, unclear);
    let cause = DivergenceCause::WrongMap;
    let found = Divergence { event: 1, fault: cause.fault(), cause };
    checked.judgement.contradiction = Some((found.clone(), Unproved::Scans));
    checked.judgement.lost = Some(4);
    let text = "[[quirk]]\nname = \"other\"\ncause = \"map\"\nreason = \"none\"\n\
                [[quirk]]\nname = \"map\"\ncause = \"wrong-map\"\nreason = \"old\"\n";
    checked.quirks = Quirks::read(text).unwrap();
    checked.judgement.tolerated = vec![(found, 1)];
    let report = reported(&checked, &walk);
    assert_eq!(report.facts.contradiction.unwrap().event, 2);
    assert_eq!(report.facts.lost, Some(5));
    let tolerated: Vec<_> =
        report.tolerated.iter().map(|quirk| (&*quirk.name, &quirk.events[..])).collect();
    assert_eq!(tolerated, [("other", &[][..]), ("map", &[2])]);
    // The robot passes the fork 20 s after it began.
    let scans = past_fork();
    let checked = by_anyone(&scans, Evidence::Laser).checked().unwrap();
    let events = reported(&checked, &scans).events;
    assert!(events[0].number == 1 && (15.0..25.0).contains(&events[0].time), "{events:?}");
}

#[test]
fn a_visit_has_its_place_its_scan_and_the_way_on() {
    let scans = past_fork();
    let checked = by_anyone(&scans, Evidence::Laser).checked().unwrap();
    let [visit] = &reported(&checked, &scans).visits[..] else { panic!() };
    assert_eq!((visit.degree, visit.door, visit.way), (Some(3), Some(1), Some("through")));
    let [x, y] = visit.position.unwrap();
    assert!(x.hypot(y) < 0.5 && visit.exit.unwrap().abs() < 0.3, "{visit:?}");
    // Of the 40 scans.
    assert!((15..25).contains(&visit.scan.unwrap()), "{visit:?}");
    let walk = lines(&[(3, 1, None), (1, 0, None)]);
    let mut checked = by_anyone(&walk, Evidence::Recorded).checked().unwrap();
    let ways = |checked: &CheckedLog| {
        let visits = reported(checked, &walk).visits;
        visits.iter().map(|visit| visit.way.unwrap()).collect::<Vec<_>>()
    };
    assert_eq!(ways(&checked), ["through", "back"]);
    // What a robot perceives after it has dropped its marker is no other visit.
    let events = &mut checked.extracted.events.events;
    let drop = CheckedKind::Action { number: None, action: AidAction::Drop };
    let again = events[0].clone();
    events.insert(1, CheckedEvent { kind: drop, ..again.clone() });
    events.insert(2, again);
    assert_eq!(ways(&checked), ["through", "back"]);
}

#[test]
fn doors_that_were_never_followed_are_named_as_in_the_known_world() {
    let world = fork_world();
    let walk = lines(&[(1, 0, None), (3, 0, None), (1, 0, None)]);
    let question = Question {
        world: Some(&world),
        start: RobotStart::At("v1:v0"),
        ..by_anyone(&walk, Evidence::Recorded)
    };
    let report = reported(&question.checked().unwrap(), &walk);
    let doors: Vec<_> = report
        .facts
        .never_followed
        .as_ref()
        .unwrap()
        .iter()
        .map(|open| (&*open.vertex, open.door, open.toward.as_deref().unwrap()))
        .collect();
    assert_eq!(doors, [("v0", 1, "v2"), ("v0", 2, "v3")]);
    assert_eq!(report.folded.unwrap().entries.len(), 2);
    // A walk that determines its world has none.
    let ring = lines(&[(2, 1, Some(0)), (2, 1, None), (2, 1, Some(0))]);
    let checked =
        Question { doors: DoorChooser::Anyone, ..Question::new(&ring, Evidence::Recorded) };
    let report = reported(&checked.checked().unwrap(), &ring);
    assert!(report.folded.is_none() && report.facts.never_followed.unwrap().is_empty());
}

#[test]
fn a_limit_and_a_departure_are_at_an_event() {
    // Around a ring of two junctions, and on.
    let ring = lines(&[(2, 1, Some(0)), (2, 1, None)]);
    let question = Question::new(&ring, Evidence::Recorded);
    let mut bounded = question.checked().unwrap();
    assert_eq!(reported(&bounded, &ring).facts.doors.unwrap().departs_after, None);
    bounded.config.dart_bound = 2;
    let reached = bounded.config.follow(&bounded.judgement.trace, &bounded.judgement.events);
    bounded.judgement.algorithm = reached;
    let limits = reported(&bounded, &ring).limits;
    let [limit] = &limits[..] else { panic!("{limits:?}") };
    // It would know four darts after its third event.
    assert_eq!((limit.option, limit.value, limit.event), (Some("--max-darts"), Some(2), Some(3)));
    let aside = lines(&[(2, 1, Some(0)), (2, 0, None), (2, 1, Some(1)), (2, 1, None)]);
    let checked = Question {
        doors: DoorChooser::Algorithm(Some(FOLDING)),
        ..Question::new(&aside, Evidence::Recorded)
    };
    let report = reported(&checked.checked().unwrap(), &aside);
    let divergence = report.divergence.unwrap();
    assert_eq!(divergence.fault, FaultClass::Algorithm);
    assert_eq!(report.facts.doors.unwrap().departs_after, Some(divergence.event - 1));
}

/// A walk that the world does not have, from one start or from none.
#[test]
fn a_proof_is_about_the_poses_in_which_the_robot_may_have_begun() {
    let world = fork_world();
    let walk = lines(&[(1, 0, None), (2, 1, None), (2, 1, None)]);
    let proof = |start| {
        let question =
            Question { world: Some(&world), start, ..by_anyone(&walk, Evidence::Recorded) };
        let checked = question.checked().unwrap();
        let proofs = checked.proofs().unwrap();
        assert!(proofs.iter().all(|proof| proof.to_string().contains("\nclaim diverges\n")));
        proofs[0].to_string()
    };
    assert!(proof(RobotStart::Anywhere).contains("\nclaim diverges\nfrom any\n"));
    let west = world.start_from_text("v1:v0").unwrap();
    let from_west = format!("\nclaim diverges\nfrom {}\n", west.0);
    assert!(proof(RobotStart::At("v1:v0")).contains(&from_west));
}

#[test]
fn the_json_of_logs_counts_their_faults_and_lists_the_cases_that_a_world_cannot_reach() {
    let walk = lines(&[(2, 1, Some(0)), (3, 1, Some(0))]);
    let checked = by_anyone(&walk, Evidence::Recorded).checked().unwrap();
    let case = |case, reachable| CoveredCase { case, count: 0, reachable, expected: false };
    let coverage = vec![case("here", Some(true)), case("nowhere", Some(false)), case("any", None)];
    let diverged = LogReport { coverage, ..reported(&checked, &walk) };
    let fault = diverged.divergence.as_ref().unwrap().fault;
    let line = serde_json::to_value(&diverged).unwrap();
    assert_eq!(line["unreachable"], serde_json::json!(["nowhere"]));
    let unread = UnreadLog { log: "other".to_owned(), cause: "no log".to_owned() };
    let logs = vec![diverged.clone(), LogReport::default(), diverged];
    let reports = ConformReports { logs, unread: vec![unread], required: None };
    let together = serde_json::to_value(reports.together(&[])).unwrap();
    for class in FaultClass::ALL {
        assert_eq!(together["classes"][class.name()], if class == fault { 2 } else { 0 });
    }
    let counts = ["logs", "diverged", "not_known", "conform", "unreadable"];
    assert_eq!(counts.map(|name| together[name].as_u64().unwrap()), [4, 2, 1, 0, 1]);
}

#[test]
fn several_logs_together_reach_what_one_of_them_reaches() {
    let report = |reachable, expected, count| {
        let case = CoveredCase { case: "a-case", count, reachable, expected };
        LogReport { coverage: vec![case], ..LogReport::default() }
    };
    for (one, other, together) in [
        (Some(true), Some(false), Some(true)),
        (None, Some(true), Some(true)),
        (Some(false), Some(false), Some(false)),
        (Some(false), None, None),
        (None, None, None),
    ] {
        for (one, other) in [(one, other), (other, one)] {
            let both = LogReport::coverage_of(&[report(one, false, 2), report(other, true, 3)]);
            let case =
                CoveredCase { case: "a-case", count: 5, reachable: together, expected: true };
            assert_eq!(both, [case], "{one:?} {other:?}");
        }
    }
    let expected = LogReport::coverage_of(&[report(None, true, 0), report(None, true, 0)]);
    assert!(expected[0].expected);
    let has_coverage = |count| report(None, true, count).has_coverage();
    assert!(!has_coverage(0) && has_coverage(1));
}
