//! Logs of a laser scanner: a robot in a building of corridors, whose scans are computed here, and two real
//! robots where their logs are present.

use std::{
    env,
    f64::consts::{FRAC_PI_2, PI, TAU},
    fmt::Write as _,
    path::{Path, PathBuf},
};

use serde_json::{Value, json};

use super::{Scratch, has};

/// Corridors along the axes, 2 m wide: a T whose stem comes from the west, and a ring behind it.
const CORRIDORS: [([f64; 2], [f64; 2]); 5] = [
    ([-20.0, 0.0], [0.0, 0.0]),
    ([0.0, -12.0], [0.0, 12.0]),
    ([0.0, 12.0], [24.0, 12.0]),
    ([24.0, -12.0], [24.0, 12.0]),
    ([0.0, -12.0], [24.0, -12.0]),
];

/// Into the ring to the left, around it, and back into the stem.
const WAY: [[f64; 2]; 7] =
    [[-17.0, 0.0], [0.0, 0.0], [0.0, 12.0], [24.0, 12.0], [24.0, -12.0], [0.0, -12.0], [0.0, 0.0]];

fn is_free([x, y]: [f64; 2]) -> bool {
    CORRIDORS.iter().any(|([x0, y0], [x1, y1])| {
        (x0 - 1.0..=x1 + 1.0).contains(&x) && (y0 - 1.0..=y1 + 1.0).contains(&y)
    })
}

/// The range to the first wall, in steps of 5 cm.
fn range([x, y]: [f64; 2], bearing: f64) -> f64 {
    let (sine, cosine) = bearing.sin_cos();
    let steps = (0..1600).map(|step| f64::from(step) * 0.05);
    let wall = steps.into_iter().find(|range| !is_free([x + range * cosine, y + range * sine]));
    wall.unwrap_or(81.9)
}

/// A CARMEN log of a robot that drives from point to point, half a metre from scan to scan.
fn log(way: &[[f64; 2]]) -> String {
    let mut lines = String::new();
    let mut time = 0.0;
    let mut heading: Option<f64> = None;
    let mut see = |[x, y]: [f64; 2], heading: f64| {
        time += 1.0;
        let ranges = (0..=180).map(|degree: u32| {
            let bearing = heading - FRAC_PI_2 + f64::from(degree).to_radians();
            format!("{:.2}", range([x, y], bearing))
        });
        let ranges = ranges.collect::<Vec<_>>().join(" ");
        let pose = format!("{x} {y} {heading}");
        writeln!(lines, "FLASER 181 {ranges} {pose} {pose} {time} h {time}").unwrap();
    };
    for leg in way.windows(2) {
        let [dx, dy] = [0, 1].map(|axis| leg[1][axis] - leg[0][axis]);
        let ahead = dy.atan2(dx);
        if let Some(before) = heading {
            let turn = (ahead - before + 3.0 * PI).rem_euclid(TAU) - PI;
            for part in 1..4 {
                see(leg[0], ahead - turn * (1.0 - f64::from(part) / 4.0));
            }
        }
        heading = Some(ahead);
        let steps = (dx.hypot(dy) / 0.5).ceil();
        for step in 1..=steps as u32 {
            let part = f64::from(step) / steps;
            see([leg[0][0] + part * dx, leg[0][1] + part * dy], ahead);
        }
    }
    lines
}

/// A folder with the log around the ring, `ring.log`.
fn ring(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    let way: Vec<_> = WAY.into_iter().chain([WAY[0]]).collect();
    scratch.write("ring.log", log(&way));
    scratch
}

const RING: &str = "conform ring.log --events laser --driver anyone";

fn markers(lines: &[Value]) -> Vec<&Value> {
    lines.iter().filter(|line| line["kind"] == "event").map(|line| &line["marker"]).collect()
}

/// At the T the robot came from the stem, and then from the south: along door 0, and along door 1.
#[test]
fn a_marker_can_be_assumed_where_the_robot_began_or_at_a_place() {
    let scratch = ring("assumed_marker");
    // Without a marker the two visits may be of different junctions.
    let lines = scratch.lines(&format!("{RING} --marker none"), 0);
    has(&lines[2], &json!({ "unique": false, "assumed_marker": null, "open_doors": 4 }), RING);
    // Nearer to the stem than to the other arms.
    scratch.write("mapping.toml", "[marker]\nat = [0.5, -0.5, 2.8]\n");
    for options in ["--assume-marker", "--assume-marker --topics mapping.toml"] {
        let lines = scratch.lines(&format!("{RING} {options}"), 0);
        assert_eq!(markers(&lines), [&json!(0), &json!(1)], "{lines:?}");
        // The ring is closed; the end of the stem was never seen.
        let never = json!([{"vertex": "v0", "door": 0, "toward": null}]);
        has(
            lines.last().unwrap(),
            &json!({
                "assumed_marker.seen": 2, "unique": false, "never_followed": never,
            }),
            options,
        );
    }
    for (options, part) in [
        ("--marker none", "180 degrees: arms that point back"),
        ("--assume-marker", "assumed, not in the log: "),
        ("--assume-marker --marker undirected", "the marker may have been entered in 2 ways."),
    ] {
        let text = scratch.out(&format!("{RING} {options}"), 0);
        let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(text.contains(part.trim_end()), "{text}");
    }
    scratch.write("flat.toml", "[marker]\nat = [0, 0]\n");
    for (line, cause) in [
        (
            &*format!("{RING} --topics flat.toml --assume-marker"),
            "[marker] at of --topics: a directional marker needs a heading: at = [x, y, heading]",
        ),
        ("sense ring.log --scans 9999", "--scans: the log has 2"),
    ] {
        let message = scratch.error(line);
        assert!(message.contains(cause), "{message}");
    }
    scratch.facts(&[
        // In the known building the marker may lie anywhere.
        (&format!(
            "{RING} --world worlds/real/seattle.toml --start any --assume-marker --topics mapping.toml"
        ), 0, json!({ "verdict": "conforms" })),
        // An undirected marker leaves open how the robot came back.
        (&format!("{RING} --assume-marker --marker undirected"), 0, json!({ "unique": false })),
    ]);
}

#[test]
fn a_log_that_begins_elsewhere_than_its_world_has_a_hint() {
    let scratch = ring("laser_elsewhere");
    let world = format!("{RING} --marker none --world worlds/figure-1a.toml");
    let end = "the log ends with a door: where it led is not recorded";
    let hint = "the log may begin elsewhere: --start any tries every start";
    scratch.facts(&[(&world, 1, json!({ "event": 1, "remarks": [hint, end] }))]);
    // With it the log begins at some T of the wheel.
    let output = scratch.run(&format!("{world} --start any --json"));
    let last = super::objects(&super::stdout(&output)).pop().unwrap();
    assert_eq!(last["remarks"], json!([end]), "{last}");
}

#[test]
fn the_picture_of_a_run_shows_its_visits() {
    let scratch = ring("laser_picture");
    for picture in ["run.svg", "run.png"] {
        scratch.out(&format!("{RING} --marker none --picture {picture}"), 0);
    }
    let text = scratch.text("run.svg");
    for part in [">ring</text>", ">2 visits of junctions; the log conforms</text>", ">3</text>"] {
        assert!(text.contains(part), "{part}");
    }
    assert_eq!(text.matches("class=\"junction\"").count(), 1, "both visits are at one junction");
    assert!(scratch.bytes("run.png").starts_with(b"\x89PNG"));
}

/// The logs of two real robots, if they exist; `TOPOSLAM_CARMEN_LOGS` names their folder.
fn carmen() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/carmen");
    let folder = env::var_os("TOPOSLAM_CARMEN_LOGS").map_or(beside, PathBuf::from);
    let found = folder.join("aces.log.gz").is_file();
    if !found {
        eprintln!("skipped: there are no CARMEN logs in {}", folder.display());
    }
    found.then_some(folder)
}

/// With an undirected marker at the crossing the log of a real building does not distinguish the wheel in the
/// plane from the one on the torus: the paper's Figure 1. The smallest building on one floor that explains the
/// log is the wheel.
#[test]
fn a_real_building_and_its_twin_on_the_torus_explain_the_same_log() {
    let Some(logs) = carmen() else { return };
    let scratch = Scratch::new("real_twin");
    scratch.write("hub.toml", "[marker]\nat = [-0.8, -18.6]\n");
    let log = logs.join("aces.log.gz");
    let conform =
        format!("conform {} --events laser --driver anyone --assume-marker", log.display());
    let undirected = format!("{conform} --marker undirected --topics hub.toml");
    let twin = json!({ "verdict": "conforms", "twin.figure": "Figure 1(b)", "twin.genus": 1 });
    scratch.facts(&[
        (&format!("{undirected} --world worlds/real/aces.toml"), 0, twin.clone()),
        (&format!("{undirected} --class planar"), 0, twin),
        // With a directional marker there is none.
        (
            &format!("{conform} --world worlds/real/aces.toml"),
            0,
            json!({ "verdict": "conforms", "twin": null }),
        ),
    ]);
    let text = scratch.out(&format!("{undirected} --class planar"), 0);
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    for part in ["Figure 1(b) of the paper", "no walk distinguishes"] {
        assert!(text.contains(part), "{text}");
    }
}
