//! The page of conformance reports, in a browser.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::{fs, io::Cursor, path::Path};

use toposlam_conform::{
    Allowed, CheckedKind, ConformReports, ConformVerdict, CoveredCase, DivergenceCause,
    DivergenceReport, EventPose, EventSource, Facts, FaultClass, FoldedReport, LogReport,
    MessagePlace, PoseName, ReportedEvent, SourceFile, ToleratedQuirk, WorldFact,
};
use toposlam_draw::page::{ReportOrigin, conform_page};
use toposlam_logs::{error::OffsetUnit, record::Arrival};
use toposlam_model::{
    folding::fold,
    format::{named_world::NamedWorld, world_file},
    percept::{Door, Percept, Sighting},
    trace::MisfitReason,
    world::{GraphWorld, World},
};

use crate::browser;

/// What a camera under a mirror might see.
fn picture() -> Vec<u8> {
    let pixel = |x: u32, y: u32| {
        let (right, down) = (f64::from(x) - 320.0, f64::from(y) - 240.0);
        match right.hypot(down) {
            225.0.. => image::Rgb([20, 20, 24]),
            ..50.0 => image::Rgb([60, 60, 70]),
            _ if right.abs() < 70.0 || (down.abs() < 60.0 && right > 0.0) => {
                image::Rgb([60, 190, 90])
            }
            _ => image::Rgb([200, 190, 180]),
        }
    };
    let mut file = Cursor::new(Vec::new());
    let image = image::RgbImage::from_fn(640, 480, pixel);
    image.write_to(&mut file, image::ImageFormat::Jpeg).unwrap();
    file.into_inner()
}

fn world(name: &str) -> NamedWorld {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("worlds").join(name);
    world_file::read(&fs::read(file).unwrap()).unwrap()
}

fn arrival(degree: u32) -> CheckedKind {
    let sighting = Some(Sighting::Nothing);
    let arrival = Arrival { number: None, degree, sighting, form: None, entry: None };
    CheckedKind::Arrival { arrival, entry_off: None, hallway: None }
}

fn conforming(log: &str, events: usize) -> LogReport {
    let door = CheckedKind::Door { number: None, door: Door(1), off: None };
    let event = |number: usize| ReportedEvent {
        number,
        source: EventSource::default(),
        time: number as f64 * 4.7,
        kind: if number % 2 == 1 { arrival(3) } else { door.clone() },
        pose: None,
        then: Some(EventPose::Candidates(2)),
    };
    let cases = [
        ("new-vertex", 12, true),
        ("confirmed", 7, true),
        ("rejected-at-once", 31, true),
        ("rejected-on-the-way", 2, true),
        ("rejected-at-the-end", 0, false),
        ("marker-seen", 4, true),
        ("marker-missed", 0, true),
        ("dead-end", 6, true),
        ("t-by-stem", 5, true),
        ("l-left", 0, false),
    ];
    let known = WorldFact {
        name: "shape-6".to_owned(),
        start: None,
        candidates_at_start: 12,
        candidates_left: Some(2),
        pose: None,
        world: world("shape-6.toml"),
    };
    LogReport {
        log: log.to_owned(),
        verdict: ConformVerdict::Conforms,
        facts: Facts { world: Some(known), ..Facts::default() },
        begun: Some(1_700_000_000_000_000_000),
        sources: vec![SourceFile {
            role: "log",
            path: "logs/shape-6.mcap".to_owned(),
            sha256: "9f86d081884c7d65".repeat(4),
        }],
        events: (1..=events).map(event).collect(),
        coverage: cases
            .map(|(case, count, reachable)| CoveredCase {
                case,
                count,
                reachable: Some(reachable),
                expected: case == "marker-missed",
            })
            .into(),
        tolerated: vec![ToleratedQuirk {
            name: "glare".to_owned(),
            reason: "the sun stands low in the window at the east end until ten".to_owned(),
            events: vec![3, 5],
        }],
        ..LogReport::default()
    }
}

/// The folded trail of half of a run.
fn folded() -> FoldedReport {
    let world = world("building-12.toml");
    let (mut percepts, mut doors) = (Vec::new(), Vec::new());
    let mut robot = GraphWorld::new(&world.graph, world.start.unwrap());
    for door in [1, 1, 1, 2, 1, 1, 1, 0, 1] {
        percepts.push(robot.sensed());
        let door = Door(door % robot.sensed().degree);
        robot.traverse(door).unwrap();
        doors.push(door);
    }
    percepts.push(robot.sensed());
    let trail = fold(&percepts, &doors).unwrap();
    let entries = trail.first_entries(&doors);
    FoldedReport { trail, entries }
}

fn diverged(log: &str, events: usize, at: usize) -> LogReport {
    let allowed = |vertex: &str, degree| {
        let pose = PoseName { vertex: vertex.to_owned(), from: "north".to_owned() };
        let expected = Percept { degree, sighting: Sighting::Nothing };
        Allowed::InWorld(pose, MisfitReason::Percept { expected })
    };
    LogReport {
        verdict: ConformVerdict::Diverged,
        divergence: Some(DivergenceReport {
            event: at,
            time: Some(at as f64 * 4.7),
            message: Some(MessagePlace { number: 4711, offset: 1_234_567, unit: OffsetUnit::Byte }),
            fault: FaultClass::Perception,
            cause: DivergenceCause::WrongMap,
            found: Some(arrival(4)),
            allowed: vec![allowed("tee", 3), allowed("corner", 2)],
            allowed_total: 2,
        }),
        shorter: vec![arrival(2), arrival(4)],
        command: Some("toposlam conform shorter.mcap --world worlds/shape-6.toml".to_owned()),
        image: Some(picture()),
        ..conforming(log, events)
    }
}

fn incomplete(log: &str) -> LogReport {
    LogReport {
        verdict: ConformVerdict::Incomplete,
        tolerated: Vec::new(),
        folded: Some(folded()),
        ..conforming(log, 31)
    }
}

#[test]
fn the_page_of_a_report_opens_and_leads_to_its_events() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let right = conforming("logs/monday.mcap", 211);
    let wrong = diverged("logs/tuesday.mcap", 10_000, 7_003);
    let cut = incomplete("logs/wednesday-<b>of-the-second-floor</b>-2026-11-22-08-15.mcap");
    let origin = ReportOrigin {
        version: "0.1.0".to_owned(),
        command: "toposlam conform logs/monday.mcap --world worlds/shape-6.toml".to_owned(),
    };
    let pages = [
        ("conforms", vec![right.clone()]),
        ("diverged", vec![wrong.clone()]),
        ("open", vec![cut.clone()]),
        ("several", vec![right, wrong, cut]),
    ];
    let pages = pages.map(|(name, reports)| {
        let file = folder.join(format!("conform-{name}.html"));
        fs::write(
            &file,
            conform_page(&ConformReports { logs: reports, ..ConformReports::default() }, &origin),
        )
        .unwrap();
        format!("{name}={}", file.display())
    });
    browser::open("conform_page.mjs", &pages);
}
