//! Logs of a laser scanner: a robot in a building of corridors, whose scans are computed here, and two real
//! robots where their logs are present.

use std::{
    env,
    f64::consts::{FRAC_PI_2, PI, TAU},
    fmt::Write as _,
    fs,
    path::{Path, PathBuf},
};

use serde_json::{Value, json};

use super::{folder, objects, run, stderr, stdout};

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

/// The log around the ring, in a folder.
fn written(name: &str) -> (PathBuf, String) {
    let folder = folder(name);
    let path = folder.join("ring.log");
    let way: Vec<_> = WAY.into_iter().chain([WAY[0]]).collect();
    fs::write(&path, log(&way)).unwrap();
    let path = path.to_str().unwrap().to_owned();
    (folder, path)
}

/// The exit code and the lines of `--json`.
fn conform(log: &str, options: &[&str]) -> (Option<i32>, Vec<Value>) {
    let arguments =
        [&["conform", log, "--events", "laser", "--driver", "anyone", "--json"], options];
    let output = run(arguments.concat());
    assert!(output.status.code() != Some(2), "{}", stderr(&output));
    (output.status.code(), objects(&stdout(&output)))
}

fn markers(lines: &[Value]) -> Vec<&Value> {
    lines.iter().filter(|line| line["kind"] == "event").map(|line| &line["marker"]).collect()
}

/// At the T the robot came from the stem, and then from the south: along door 0, and along door 1.
#[test]
fn a_marker_can_be_assumed_where_the_robot_began_or_at_a_place() {
    let (folder, log) = written("assumed_marker");
    let (code, lines) = conform(&log, &["--marker", "none"]);
    assert_eq!(code, Some(0));
    let verdict = lines.last().unwrap();
    assert_eq!((&verdict["unique"], &verdict["assumed_marker"]), (&false.into(), &Value::Null));
    let scanner = verdict["facts"]["scanner"].as_str().unwrap();
    assert!(scanner.starts_with("180 degrees: arms that point back"), "{scanner}");
    // Without a marker the two visits may be of different junctions.
    assert_eq!((lines.len(), &verdict["open_doors"]), (3, &4.into()), "{verdict}");
    let mapping = folder.join("mapping.toml");
    let mapping_text = mapping.to_str().unwrap();
    for (at, options) in [
        (None, vec!["--assume-marker"]),
        // Nearer to the stem than to the other arms.
        (Some("[0.5, -0.5, 2.8]"), vec!["--assume-marker", "--topics", mapping_text]),
    ] {
        if let Some(at) = at {
            fs::write(&mapping, format!("[marker]\nat = {at}\n")).unwrap();
        }
        let (code, lines) = conform(&log, &options);
        assert_eq!((code, markers(&lines)), (Some(0), vec![&json!(0), &json!(1)]), "{lines:?}");
        let verdict = lines.last().unwrap();
        assert_eq!(verdict["assumed_marker"]["seen"], 2);
        assert!(
            verdict["facts"]["marker"].as_str().unwrap().starts_with("assumed, not in the log: ")
        );
        // The ring is closed; the end of the stem was never seen.
        let never = json!([{"vertex": "v0", "door": 0, "toward": null}]);
        assert_eq!((&verdict["unique"], &verdict["never_followed"]), (&false.into(), &never));
    }
    // In the known building the marker may lie anywhere.
    let world = ["--world", "worlds/real/seattle.toml", "--start", "any"];
    let with_place = ["--assume-marker", "--topics", mapping_text];
    let (code, lines) = conform(&log, &[&world[..], &with_place].concat());
    assert_eq!((code, &lines[2]["verdict"]), (Some(0), &"conforms".into()), "{lines:?}");
    // An undirected marker leaves open how the robot came back.
    let (code, lines) = conform(&log, &["--assume-marker", "--marker", "undirected"]);
    let verdict = lines.last().unwrap();
    assert_eq!((code, &verdict["unique"]), (Some(0), &false.into()));
    let unique = "This log does not determine its world: the junction of the marker may have been entered in 2 ways.";
    assert_eq!(verdict["facts"]["unique"], unique);
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_marker_that_is_assumed_is_bad_usage_unless_it_is_asked_for() {
    let (folder, log) = written("assumed_marker_usage");
    let mapping = folder.join("mapping.toml");
    fs::write(&mapping, "[marker]\nat = [0, 0, 3.14]\n").unwrap();
    let flat = folder.join("flat.toml");
    fs::write(&flat, "[marker]\nat = [0, 0]\n").unwrap();
    let fiducial = folder.join("fiducial.toml");
    fs::write(&fiducial, "[marker]\ntopic = \"/tag\"\n").unwrap();
    let lines = folder.join("lines.jsonl");
    fs::write(&lines, "{\"degree\":3,\"door\":1}\n{\"degree\":3,\"door\":null}\n").unwrap();
    let [mapping, flat, fiducial, lines] =
        [&mapping, &flat, &fiducial, &lines].map(|path| path.to_str().unwrap());
    for (log, options, message) in [
        (
            &*log,
            &["--topics", mapping][..],
            "[marker] at of --topics: the log has no marker there; to assume one, add --assume-marker",
        ),
        (
            &log,
            &["--topics", flat, "--assume-marker"],
            "[marker] at of --topics: a directional marker needs a heading: at = [x, y, heading]",
        ),
        (&log, &["--topics", fiducial], "the log has no topic \"/tag\"; it has: FLASER"),
        (
            &log,
            &["--assume-marker", "--marker", "none"],
            "--assume-marker: this needs another marker than none",
        ),
        (
            lines,
            &["--assume-marker"],
            "--assume-marker: this is for events that are inferred from laser scans",
        ),
        (
            lines,
            &["--picture", "a.svg", "--marker", "none"],
            "--picture: this is for events that are inferred from laser scans",
        ),
    ] {
        let output = run([&["conform", log, "--driver", "anyone"], options].concat());
        assert_eq!(output.status.code(), Some(2), "{options:?} {}", stdout(&output));
        assert!(stderr(&output).contains(message), "{options:?}: {}", stderr(&output));
    }
    // The algorithms need a directional marker.
    let output = run(["conform", &log, "--marker", "undirected", "--assume-marker"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("--marker undirected: the algorithms need the directional"));
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn an_unknown_parameter_of_sensing_is_an_error_with_its_place() {
    let (folder, log) = written("laser_parameters");
    let params = folder.join("params.toml");
    fs::write(&params, "[corner]\n[arm]\nmin = 2.0\n").unwrap();
    let params = params.to_str().unwrap();
    let output = run(["conform", &log, "--laser-params", params]);
    assert_eq!(output.status.code(), Some(2));
    let cause = "params.toml: line 3, column 1: arm.min: unknown key; expected one of: min_arm, ";
    assert!(stderr(&output).contains(cause), "{}", stderr(&output));
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_log_that_begins_elsewhere_than_its_world_has_a_hint() {
    let (folder, log) = written("laser_elsewhere");
    let world = ["--marker", "none", "--world", "worlds/figure-1a.toml"];
    let (code, lines) = conform(&log, &world);
    let verdict = lines.last().unwrap();
    assert_eq!((code, &verdict["event"]), (Some(1), &1.into()), "{verdict}");
    let end = "the log ends with a door: where it led is not recorded";
    let hint = "the log may begin elsewhere: --start any tries every start";
    assert_eq!(verdict["remarks"], json!([hint, end]));
    // With it the log begins at some T of the wheel.
    let (_, lines) = conform(&log, &[&world[..], &["--start", "any"]].concat());
    assert_eq!(lines.last().unwrap()["remarks"], json!([end]), "{lines:?}");
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn scans_that_a_log_does_not_have_are_an_error() {
    let (folder, log) = written("laser_scans");
    let output = run(["sense", &log, "--scans", "9999"]);
    assert_eq!(output.status.code(), Some(2), "{}", stdout(&output));
    let message = stderr(&output);
    assert!(
        message.contains("--scans: the log has 2") && message.contains("counted from 0"),
        "{message}"
    );
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn the_picture_of_a_run_shows_its_visits() {
    let (folder, log) = written("laser_picture");
    let [svg, png] = ["run.svg", "run.png"].map(|name| folder.join(name));
    for picture in [&svg, &png] {
        let (code, _) =
            conform(&log, &["--marker", "none", "--picture", picture.to_str().unwrap()]);
        assert_eq!(code, Some(0));
    }
    let text = fs::read_to_string(svg).unwrap();
    for part in [">ring</text>", ">2 visits of junctions; the log conforms</text>", ">3</text>"] {
        assert!(text.contains(part), "{part}");
    }
    assert_eq!(text.matches("class=\"junction\"").count(), 1, "both visits are at one junction");
    assert!(fs::read(png).unwrap().starts_with(b"\x89PNG"));
    fs::remove_dir_all(folder).unwrap();
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
    let folder = folder("real_twin");
    let mapping = folder.join("hub.toml");
    fs::write(&mapping, "[marker]\nat = [-0.8, -18.6]\n").unwrap();
    let log = logs.join("aces.log.gz");
    let log = log.to_str().unwrap();
    let marker =
        ["--marker", "undirected", "--assume-marker", "--topics", mapping.to_str().unwrap()];
    for world in [&["--world", "worlds/real/aces.toml"][..], &["--class", "planar"]] {
        let (code, lines) = conform(log, &[&marker[..], world].concat());
        let verdict = lines.last().unwrap();
        assert_eq!((code, &verdict["verdict"]), (Some(0), &"conforms".into()), "{verdict}");
        assert_eq!(verdict["twin"]["figure"], "Figure 1(b)");
        assert_eq!(verdict["twin"]["genus"], 1);
        let sentence = verdict["facts"]["twin"].as_str().unwrap();
        assert!(sentence.contains("Figure 1(b) of the paper"), "{sentence}");
        assert!(sentence.contains("no walk distinguishes"), "{sentence}");
    }
    // With a directional marker there is none.
    let (_, lines) = conform(log, &["--assume-marker", "--world", "worlds/real/aces.toml"]);
    let verdict = lines.last().unwrap();
    assert_eq!((&verdict["verdict"], &verdict["twin"]), (&"conforms".into(), &Value::Null));
    fs::remove_dir_all(folder).unwrap();
}
