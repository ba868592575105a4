//! The page of conformance reports, in a browser.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::{fs, io::Cursor, path::Path};

use toposlam_conform::{ConformVerdict, FaultClass};
use toposlam_draw::{
    page::conform_page,
    picture::{OpenGraph, WorldPicture, open_svg, svg},
    report::{
        ConformReports, CoveredCase, DivergenceReport, EventLine, FoldedReport, LogReport,
        MessagePlace, ReportOrigin, SourceFile,
    },
};
use toposlam_logs::error::OffsetUnit;
use toposlam_model::{
    folding::fold,
    format::world_file,
    percept::Door,
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

fn conforming(log: &str, events: usize) -> LogReport {
    let line = |number: usize| {
        let (what, then) = if number % 2 == 1 {
            ("perceives 3 doors, no marker", "2 poses are left: corner:0, tee:1")
        } else {
            ("leaves by door 1", "it is in a hallway; the same 2 poses are left")
        };
        let time = number as f64 * 4.7;
        EventLine { number, time, what: what.to_owned(), then: then.to_owned() }
    };
    let cases = [
        ("new-vertex", 12, true),
        ("confirmed", 7, true),
        ("rejected-at-once", 31, true),
        ("rejected-on-the-way", 2, true),
        ("rejected-at-the-end", 0, false),
        ("marker-seen", 4, true),
        ("marker-missed", 0, true),
        ("junction: dead end", 6, true),
        ("junction: T entered by the stem", 5, true),
        ("junction: L to the left", 0, false),
    ];
    LogReport {
        log: log.to_owned(),
        verdict: ConformVerdict::Conforms,
        remarks: Vec::new(),
        facts: [
            ("format", "MCAP, zstd, 4811 messages on 6 topics, 12.4 MB"),
            ("world", "worlds/shape-6.toml: 6 junctions, 6 hallways"),
            ("marker", "directional, at the start"),
            ("driver", "Algorithm 1, every choice it leaves open"),
            ("events from", "the messages of the algorithm's own topics /percept and /door"),
        ]
        .map(|(name, fact)| (name, fact.to_owned()))
        .into(),
        begun: Some("2023-11-14 22:13:20.000 UTC".to_owned()),
        sources: vec![SourceFile {
            role: "log",
            path: "logs/shape-6.mcap".to_owned(),
            sha256: "9f86d081884c7d65".repeat(4),
        }],
        events: (1..=events).map(line).collect(),
        divergence: None,
        coverage: cases
            .map(|(case, count, reachable)| CoveredCase {
                case: case.to_owned(),
                count,
                reachable: Some(reachable),
                expected: case == "marker-missed",
            })
            .into(),
        tolerated: vec![(
            "glare".to_owned(),
            "the sun stands low in the window at the east end until ten".to_owned(),
            vec![3, 5],
        )],
        shorter: Vec::new(),
        command: None,
        image: None,
        twin: None,
        folded: None,
        world: Some(world()),
    }
}

fn world() -> String {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/worlds/shape-6.toml");
    let world = world_file::read(&fs::read(file).unwrap()).unwrap();
    svg(&WorldPicture::from(&world))
}

/// The folded trail of half of a run.
fn folded() -> FoldedReport {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/worlds/building-12.toml");
    let world = world_file::read(&fs::read(file).unwrap()).unwrap();
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
    FoldedReport {
        vertices: trail.vertex_count(),
        open_doors: trail.open_count(),
        drawing: open_svg(&OpenGraph::of_trail(&trail, &entries)),
    }
}

fn diverged(log: &str, events: usize, at: usize) -> LogReport {
    LogReport {
        verdict: ConformVerdict::Diverged,
        divergence: Some(DivergenceReport {
            event: at,
            time: Some(at as f64 * 4.7),
            message: Some(MessagePlace { number: 4711, offset: 1_234_567, unit: OffsetUnit::Byte }),
            fault: FaultClass::Perception,
            cause: "percept",
            what: "perceives 4 doors, no marker".to_owned(),
            why: "at none of the 2 poses left in the known world this is so".to_owned(),
            allowed: [
                "3 doors, no marker: for tee:1",
                "2 doors, the marker at door 1: for corner:0",
            ]
            .map(str::to_owned)
            .into(),
        }),
        shorter: [
            "perceives 2 doors, the marker at door 1",
            "leaves by door 1",
            "perceives 4 doors",
        ]
        .map(str::to_owned)
        .into(),
        command: Some("toposlam conform shorter.mcap --world worlds/shape-6.toml".to_owned()),
        image: Some(picture()),
        ..conforming(log, events)
    }
}

fn incomplete(log: &str) -> LogReport {
    LogReport {
        verdict: ConformVerdict::Incomplete,
        remarks: vec!["the log ends before the map is complete: its recorder stopped".to_owned()],
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
