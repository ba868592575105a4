//! The sentences of reports: those of laser logs, and others of which commands print few examples.

use toposlam_model::{
    embedded_graph::EmbeddedGraph, format::named_world::NamedWorld, marker::MarkerKind,
};
use toposlam_vision::visits::network_fit::{NetworkFault, NetworkFit};

use super::*;
use crate::{
    AddedMarker, DivergenceReport, Evidence, Facts, LogReport, MatchedScans, MeasuredHallways,
    PossibleVisits, ReportedEvent, SkippedMessages, ToleratedQuirk, TwinWorld, UnprovedDivergence,
    VisitFit, WorldFact, scan_odometry::StampCounts, words,
};

/// A report of a robot that anyone drove, without facts.
fn report(change: impl FnOnce(&mut LogReport)) -> LogReport {
    let mut report = LogReport { driver: RunDriver::Anyone, ..LogReport::default() };
    report.facts.has_head = true;
    change(&mut report);
    report
}

fn facts(change: impl FnOnce(&mut Facts)) -> LogReport {
    report(|report| change(&mut report.facts))
}

fn visits(all: usize, certain: usize, fit: VisitFit) -> PossibleVisits {
    let mut visits = PossibleVisits::default();
    (visits.visits, visits.certain, visits.fit) = (all, certain, fit);
    visits
}

fn unproved(cause: DivergenceCause, why: Unproved) -> UnprovedDivergence {
    UnprovedDivergence { event: 3, found: Some(bare_door(1)), cause, why }
}

fn in_some_world() -> WorldFact {
    let world = NamedWorld::numbered("ring", "", EmbeddedGraph::cycle(3), None);
    WorldFact {
        name: "ring".to_owned(),
        start: None,
        candidates_at_start: 6,
        candidates_left: None,
        pose: None,
        world,
    }
}

#[test]
fn the_visits_of_a_laser_log_that_are_not_certain_are_remarked() {
    use VisitFit::{Anything, Contradiction, Fits, NotKnown, UnseenWay};
    let remarks_of =
        |visits: PossibleVisits| words::remarks(&facts(|facts| facts.possible = Some(visits)));
    let one = "1 of 3 visits not certain";
    let chosen = "visits of one place are chosen from one by one";
    let none: [&str; 0] = [];
    assert_eq!(remarks_of(visits(3, 3, Fits)), none);
    assert_eq!(remarks_of(visits(3, 3, NotKnown)), none);
    let fits = "a choice of their percepts fits some world";
    assert_eq!(remarks_of(visits(3, 2, Fits)), [format!("{one}; {fits}; {chosen}")]);
    let little = "which says little: less than two thirds are certain";
    assert_eq!(
        remarks_of(visits(3, 1, Fits)),
        [format!("2 of 3 visits not certain; {fits}, {little}; {chosen}")]
    );
    assert_eq!(
        remarks_of(visits(1, 0, Fits)),
        [format!("1 of 1 visits not certain; {fits}, {little}")]
    );
    let not_known = "whether their percepts fit some world is not known";
    assert_eq!(remarks_of(visits(3, 2, NotKnown)), [format!("{one}; {not_known}")]);
    let no_world = "no world fits any choice of their percepts";
    assert_eq!(remarks_of(visits(3, 3, Contradiction)), [no_world]);
    assert_eq!(remarks_of(visits(3, 2, Contradiction)), [format!("{one}; {no_world}; {chosen}")]);
    let anything = "any visits would fit: there is no marker, and the robot never turned back";
    assert_eq!(remarks_of(visits(3, 3, Anything)), [anything]);
    let unseen = "the robot drove where its scanner did not look, and may have passed more there";
    assert_eq!(remarks_of(visits(3, 3, UnseenWay)), [unseen]);
    // A known world.
    let in_world = |visits, decided: &[usize]| {
        let mut visits: PossibleVisits = visits;
        visits.decided_by_world = decided.to_vec();
        let report = facts(|facts| {
            (facts.possible, facts.world) = (Some(visits), Some(in_some_world()));
        });
        words::remarks(&report)
    };
    let fits = "a choice of their percepts fits the world";
    for (decided, part) in
        [(&[1][..], "the world decides visit 2"), (&[0, 2], "the world decides visits 1, 3")]
    {
        let expected = format!("{one}; {fits}; {part}; {chosen}");
        assert_eq!(in_world(visits(3, 2, Fits), decided), [expected]);
    }
    let no_choice = "the world fits no choice of their percepts";
    assert_eq!(in_world(visits(3, 3, Contradiction), &[]), [no_choice]);
}

#[test]
fn the_doors_of_an_algorithm_at_visits_that_are_not_certain_are_remarked() {
    let remarks_of = |algorithm| {
        let mut visits = visits(3, 2, VisitFit::Fits);
        visits.algorithm = algorithm;
        let report = report(|report| {
            report.driver = RunDriver::from(FOLDING);
            report.facts.possible = Some(visits);
        });
        words::remarks(&report)
    };
    let start = "1 of 3 visits not certain; a choice of their percepts fits some world, ";
    let end = "; visits of one place are chosen from one by one";
    for (algorithm, doors) in [
        (Some(VisitFit::Fits), "and the algorithm takes its doors"),
        (
            Some(VisitFit::Contradiction),
            "but the algorithm does not take the doors of any that does",
        ),
        (
            Some(VisitFit::NotKnown),
            "but whether the algorithm takes the doors of one that does is not known",
        ),
        (None, "but the doors of the algorithm are not compared with it"),
    ] {
        assert_eq!(remarks_of(algorithm), [format!("{start}{doors}{end}")]);
    }
}

#[test]
fn what_does_not_fit_and_accuses_nobody_is_remarked_with_its_reason() {
    let remarks_of = |cause: DivergenceCause, why| {
        let fit = VisitFit::Contradiction;
        words::remarks(&facts(|facts| {
            facts.contradiction = Some(unproved(cause, why));
            facts.possible = Some(visits(3, 3, fit));
        }))
    };
    let start = "event 3 does not fit: door 1; the robot turned back before it reached a junction. This accuses nobody: ";
    for (why, because) in [
        (Unproved::Scans, "what scans show may be wrong where the robot did not drive"),
        (Unproved::Poses, "where odometry drifts, a pass may lie beside the place that it is of"),
        (
            Unproved::Lost,
            "the log records that the robot got lost, which inferred events do not show",
        ),
        (
            Unproved::Obstacle,
            "the log records that the robot turned back at an obstacle, which inferred events do not show",
        ),
    ] {
        assert_eq!(remarks_of(DivergenceCause::TurnedBack, why), [format!("{start}{because}")]);
    }
    let [_, chosen] = &remarks_of(DivergenceCause::Driven, Unproved::Poses)[..] else { panic!() };
    assert_eq!(chosen, "visits of one place are chosen from one by one");
    let faults = FaultClass::ALL.map(words::fault);
    assert_eq!(
        faults,
        [
            "a wrong percept",
            "the robot did not drive as commanded",
            "a door that the algorithm does not take, or a wrong map",
            "the log contradicts itself",
        ]
    );
}

#[test]
fn a_building_that_is_no_network_of_corridors_is_remarked() {
    let remarks_of = |network| {
        let mut visits = visits(3, 3, VisitFit::Fits);
        visits = visits.in_building(network);
        words::remarks(&facts(|facts| facts.possible = Some(visits)))
    };
    let wide = NetworkFit { wide: 0.394, many_doors: 4, fault: Some(NetworkFault::Wide) };
    let start = "this building is not a network of corridors: ";
    let part = "on 39 % of the robot's way free space is wider than a corridor";
    assert_eq!(remarks_of(wide), [format!("{start}{part}")]);
    let doors = "4 visits may be of places with more doors than a junction of corridors has";
    let many = NetworkFit { fault: Some(NetworkFault::ManyDoors), ..wide };
    assert_eq!(remarks_of(many), [format!("{start}{doors}")]);
}

#[test]
fn the_events_that_fit_are_counted_unless_visits_are_not_certain() {
    let events = |report: &mut LogReport, count: usize| {
        let event = |number| ReportedEvent {
            number,
            source: EventSource::default(),
            time: 0.0,
            kind: bare_door(1),
            pose: None,
            then: None,
        };
        report.events = (1..=count).map(event).collect();
    };
    let fits = |count: usize, tolerated: &[usize], change: &dyn Fn(&mut Facts)| {
        words::fits(&report(|report| {
            events(report, count);
            let (name, reason) = ("ramp".to_owned(), "wheels slip".to_owned());
            report.tolerated = vec![ToleratedQuirk { name, reason, events: tolerated.to_vec() }];
            change(&mut report.facts);
        }))
    };
    let nothing = |_: &mut Facts| {};
    for (count, tolerated, text) in [
        (0, &[][..], "There are no events."),
        (1, &[], "The only event fits."),
        (3, &[], "All 3 events fit."),
        (3, &[2], "All 3 events fit, except one that is tolerated."),
        (3, &[2, 3], "All 3 events fit, except 2 that are tolerated."),
    ] {
        assert_eq!(fits(count, tolerated, &nothing).as_deref(), Some(text));
    }
    let certain = |all, certain| {
        move |facts: &mut Facts| facts.possible = Some(visits(all, certain, VisitFit::Fits))
    };
    assert_eq!(fits(3, &[], &certain(3, 2)), None);
    assert_eq!(fits(3, &[], &certain(3, 3)).as_deref(), Some("All 3 events fit."));
    let contradicts = |facts: &mut Facts| {
        certain(3, 2)(facts);
        facts.contradiction = Some(unproved(DivergenceCause::TurnedBack, Unproved::Scans));
    };
    assert_eq!(fits(3, &[], &contradicts).as_deref(), Some("The events before event 3 fit."));
    let unrecognised = |facts: &mut Facts| facts.unrecognised = Some((1, UndecidedCause::Unclear));
    assert_eq!(fits(3, &[], &unrecognised).as_deref(), Some("No event is known to fit."));
    assert_eq!([1, 2].map(words::times), ["once", "2 times"]);
}

#[test]
fn what_was_skipped_or_placed_otherwise_is_remarked() {
    let stamps = |late_scans, late_odometry, other_clock| {
        let counts = StampCounts { late_scans, late_odometry, other_clock };
        words::remarks(&facts(|facts| facts.stamps = counts))
    };
    assert_eq!(stamps(0, 0, 0), Vec::<String>::new());
    let late = "recorded late, and placed by the stamps: 1 scan, 2 odometry readings";
    let other =
        "placed by the order of the log: 3 scans whose stamps are far from those of the odometry";
    assert_eq!(stamps(1, 2, 3), [late, other]);
    let skipped = |off_clock, scans_without_odometry| {
        let skipped = SkippedMessages { off_clock, scans_without_odometry };
        words::remarks(&facts(|facts| facts.skipped_messages = skipped))
    };
    let far = "1 whose time is far from that of all others";
    assert_eq!(skipped(1, 0), [format!("skipped messages: {far}")]);
    assert_eq!(skipped(1, 2), [format!("skipped messages: {far}, 2 scans without odometry")]);
    let images = facts(|facts| facts.unreadable_images = 2);
    assert_eq!(words::remarks(&images), ["2 images could not be decoded and were skipped"]);
    let unseen = facts(|facts| facts.unrecognised = Some((3, UndecidedCause::UnseenWay)));
    let what = "at event 3 the robot drove where its scanner did not look: the events from there on are not checked";
    assert_eq!(words::remarks(&unseen), [what]);
    let lacks = facts(|facts| facts.lacks_end = true);
    assert_eq!(words::remarks(&lacks), ["the log does not record how the run ended"]);
}

#[test]
fn a_log_without_a_head_that_diverges_at_its_first_event_may_begin_elsewhere() {
    let begins = |has_head, start: Option<&str>| {
        let report = facts(|facts| {
            facts.has_head = has_head;
            let found = unproved(DivergenceCause::TurnedBack, Unproved::Scans);
            facts.contradiction = Some(UnprovedDivergence { event: 1, ..found });
            facts.world = Some(in_some_world());
            facts.world.as_mut().unwrap().start = start.map(str::to_owned);
        });
        let elsewhere = "the log may begin elsewhere: --start any tries every start";
        words::remarks(&report).contains(&elsewhere.to_owned())
    };
    assert!(begins(false, Some("v0:v1")));
    assert!(!begins(true, Some("v0:v1")) && !begins(false, None));
}

#[test]
fn the_scanner_the_odometry_and_the_marker_of_a_laser_log_are_facts() {
    let remarks_of = |name: &str, change: &dyn Fn(&mut Facts)| {
        let found = words::facts(&facts(|facts| {
            (facts.evidence, facts.field_of_view) = (Evidence::Laser, 360_f64.to_radians());
            change(facts);
        }));
        found.into_iter().find(|(fact, _)| *fact == name).map(|(_, text)| text)
    };
    let field =
        |degrees: f64| remarks_of("scanner", &|facts| facts.field_of_view = degrees.to_radians());
    let narrow = "180 degrees: arms that point back beside the robot's way are hardly seen";
    assert_eq!(field(180.0).as_deref(), Some(narrow));
    assert_eq!((field(270.0), field(360.0)), (None, None));
    let drift = remarks_of("odometry", &|facts| facts.drift = Some(1.5_f64.to_radians()));
    let matched = "its heading drifts by 1.5 degrees in 10 m: scans are matched with the walls of earlier ones";
    assert_eq!(drift.as_deref(), Some(matched));
    let unmatched = |unmatched| {
        let matched = MatchedScans { placed: 5, unmatched };
        remarks_of("odometry", &|facts| facts.matched_scans = Some(matched)).unwrap()
    };
    let placed = "not recorded: scans are placed by the walls of earlier ones, and lengths along corridors are not certain";
    assert_eq!(unmatched(0), placed);
    assert_eq!(unmatched(1), format!("{placed}; 1 scan that matches nothing is skipped"));
    assert_eq!(unmatched(2), format!("{placed}; 2 scans that match nothing are skipped"));
    let marker = |added| remarks_of("marker", &|facts| facts.added_marker = Some(added)).unwrap();
    let assumed = |heading| AddedMarker::Assumed { position: [1.0, -2.0], heading, seen: 3 };
    let place = "assumed, not in the log: at x 1.0 m, y -2.0 m of odometry";
    assert_eq!(marker(assumed(None)), format!("{place}; seen at 3 visits"));
    let heading = Some(std::f64::consts::FRAC_PI_2);
    assert_eq!(marker(assumed(heading)), format!("{place}, heading 90 degrees; seen at 3 visits"));
    let fiducial = |elsewhere| marker(AddedMarker::Fiducial { sightings: 4, elsewhere });
    assert_eq!(fiducial(0), "a fiducial with 4 sightings");
    assert_eq!(
        fiducial(1),
        "a fiducial with 4 sightings, 1 of them at no junction that was visited"
    );
    let lengths = |moves, measured, compared| {
        remarks_of("lengths", &|facts| {
            facts.lengths = MeasuredHallways { moves, measured, compared }
        })
    };
    assert_eq!(lengths(0, 0, 0), None);
    let none = "not compared: no odometry between the junctions";
    assert_eq!(lengths(4, 0, 0).as_deref(), Some(none));
    let once = "not compared: no hallway is known to be measured twice";
    assert_eq!(lengths(4, 3, 0).as_deref(), Some(once));
    let some = "2 of 4 moves compared with earlier ones";
    assert_eq!(lengths(4, 3, 2).as_deref(), Some(some));
}

#[test]
fn a_number_that_was_expected_is_what_is_allowed_instead() {
    let allowed = |cause: DivergenceCause| {
        let (fault, found) = (cause.fault(), Some(bare_door(1)));
        words::allowed(&DivergenceReport {
            event: 3,
            time: None,
            message: None,
            fault,
            found,
            allowed: Vec::new(),
            allowed_total: 0,
            cause,
        })
    };
    assert_eq!(allowed(DivergenceCause::Number { expected: 2, recorded: 5 }), ["number 2"]);
    assert_eq!(allowed(DivergenceCause::Moves { made: 7, recorded: 8 }), ["7 moves"]);
    assert!(allowed(DivergenceCause::TurnedBack).is_empty());
}

#[test]
fn a_twin_of_the_world_is_a_fact() {
    let twin = |worlds, figure, may_be_more| {
        let found = TwinWorld {
            vertices: 5,
            edges: 7,
            genus: 0,
            figure,
            worlds,
            world: in_some_world().world,
            marker: MarkerKind::Undirected,
            first_marker: Dart(0),
            first_figure: None,
            may_be_more,
        };
        let facts = words::facts(&facts(|facts| facts.twin = Some(found)));
        facts.into_iter().find(|(fact, _)| *fact == "twin").unwrap().1
    };
    let start = "Another world explains this log as well, with 5 vertices, 7 edges and genus 0";
    let end = "With an undirected marker no walk distinguishes it from the world above.";
    assert_eq!(twin(1, None, false), format!("{start}. {end}"));
    let drawn = twin(1, Some("Figure 1(b)"), false);
    assert_eq!(drawn, format!("{start}: Figure 1(b) of the paper. {end}"));
    let more = "There are 3 such worlds with as many edges.";
    assert_eq!(twin(3, None, false), format!("{start}. {end} {more}"));
    let at_least = "There are at least 3 such worlds with as many edges.";
    assert_eq!(twin(3, None, true), format!("{start}. {end} {at_least}"));
}
