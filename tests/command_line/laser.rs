//! Logs with laser scans: messages off the clock, and the log of a real robot. Most facts are in `tests/facts/laser.txt`.

use std::{
    env,
    path::{Path, PathBuf},
};

use mcap::Message;
use serde_json::{Value, json};

use super::{Scratch, containers::rewritten, flat, has, objects, stdout};

const LASER: &str = "--events laser --driver anyone --marker none";

/// A time in nanoseconds that is far from all others: the year 2106.
const FAR: u64 = 4_294_967_000_000_000_000;

/// What `conform` prints of a log, whatever the verdict.
fn conform(scratch: &Scratch, log: &str) -> Value {
    let output = scratch.run(&format!("conform {log} {LASER} --json"));
    objects(&stdout(&output)).pop().unwrap_or_else(|| panic!("{output:?}"))
}

/// Whether a remark is among those of a report.
fn has_remark(report: &Value, remark: &str) -> bool {
    report["remarks"].as_array().unwrap().iter().any(|other| other == remark)
}

/// In shape 6 no hallway is as long as 10 m.
#[test]
fn the_vertices_of_a_run_are_in_its_log_and_the_command_line_overrides_them() {
    let scratch = Scratch::new("laser_vertices");
    scratch.out("simulate worlds/shape-6.toml --sensor laser --noise 0.1 --log run.mcap", 0);
    let bytes = std::fs::read(scratch.path("run.mcap")).unwrap();
    let recorded: &[u8] = b"min-arm=3 corners=yes";
    assert!(bytes.windows(recorded.len()).any(|part| part == recorded));
    let visits = |options: &str| {
        let output = scratch.run(&format!("conform run.mcap {LASER} --json {options}"));
        let lines = objects(&stdout(&output)).into_iter();
        lines.filter(|line| line["kind"] == "event").collect::<Vec<_>>()
    };
    let by_log = visits("");
    for (params, is_same) in [
        ("[visit]\nrange = 2.5", true),
        ("[arm]\nmin_arm = 3.0", true),
        ("[corner]\ncorners = true", true),
        ("[corner]\ncorners = false", false),
    ] {
        std::fs::write(scratch.path("params.toml"), params).unwrap();
        assert_eq!(visits("--laser-params params.toml") == by_log, is_same, "{params}");
    }
    assert!(by_log.len() > 1 && visits("--corners no").len() < by_log.len());
    // A robot that drives by its camera records none.
    scratch.out("simulate worlds/shape-6.toml --by-scene --log scenes.mcap", 0);
    let bytes = std::fs::read(scratch.path("scenes.mcap")).unwrap();
    assert!(!bytes.windows(7).any(|part| part == b"min-arm"));
}

/// The recorder of an MCAP file or a database of rosbag2 has a clock.
#[test]
fn messages_off_the_clock_are_skipped_and_counted() {
    let scratch = Scratch::new("laser_containers");
    let run = "simulate worlds/laser/long-8.toml --sensor laser --noise 0.1 --log run.mcap";
    scratch.out(run, 0);
    let log = scratch.path("run.mcap");
    for (file, format) in [("changed.mcap", "mcap"), ("run.db3", "db3")] {
        if format == "db3" && !cfg!(feature = "sqlite") {
            continue;
        }
        let changed = scratch.path(file);
        // Seconds since 1970, as on a real robot.
        let begun = 1_700_000_000_000_000_000;
        rewritten(&log, &changed, |_, message| {
            message.log_time += begun;
            true
        });
        scratch.facts(&[(&format!("info {file}"), 0, json!({ "format": format }))]);
        let before = conform(&scratch, file);
        let none = json!({"off_clock": 0, "scans_without_odometry": 0});
        has(&before, &json!({ "skipped_messages": none, "events": 21 }), file);
        // Two scans and an odometry far ahead, and a scan at the very beginning of time.
        let (mut scans, mut odometry) = (0, 0);
        rewritten(&log, &changed, |_, message| {
            message.log_time += begun;
            match &*message.channel.topic {
                "/scan" => scans += 1,
                "/odom" => odometry += 1,
                _ => return true,
            }
            match (&*message.channel.topic, scans, odometry) {
                ("/scan", 100 | 200, _) | ("/odom", _, 500) => message.log_time = FAR,
                ("/scan", 300, _) => message.log_time = 0,
                _ => {}
            }
            true
        });
        let remark = "skipped messages: 4 whose time is far from that of all others";
        let after = conform(&scratch, file);
        assert!(has_remark(&after, remark), "{after}");
        has(
            &after,
            &json!({
                "skipped_messages": {"off_clock": 4, "scans_without_odometry": 0},
                "scans": before["scans"].as_u64().unwrap() - 3,
                "verdict": before["verdict"], "events": before["events"], "event": before["event"],
                "cause": before["cause"], "lengths": before["lengths"],
            }),
            file,
        );
    }
    // The odometry begins late, or never. Of the scans before it, the last 50 wait for it.
    let changed = scratch.path("changed.mcap");
    let is_odometry = |message: &Message| message.channel.topic == "/odom";
    let mut seen = 0;
    rewritten(&log, &changed, |_, message| {
        seen += usize::from(message.channel.topic == "/scan");
        seen > 60 || !is_odometry(message)
    });
    let late = conform(&scratch, "changed.mcap");
    let without = late["skipped_messages"]["scans_without_odometry"].as_u64().unwrap();
    assert!((9..=11).contains(&without), "{late}");
    let remark = format!("skipped messages: {without} scans without odometry");
    has(&late, &json!({ "skipped_messages.off_clock": 0 }), "late odometry");
    assert!(has_remark(&late, &remark), "{late}");
    // Without odometry scans are placed by the walls of earlier ones, while these are not too far apart.
    let without_odometry = |covered_from: u64| {
        let mut number = 0;
        rewritten(&log, &changed, |_, message| {
            if message.channel.topic == "/scan" {
                number += 1;
                if number > covered_from {
                    // All readings stand before the number of intensities, which is 0. A scanner that is covered has no
                    // returns.
                    let (end, nothing) = (message.data.len() - 4, f32::INFINITY.to_le_bytes());
                    for range in message.data.to_mut()[end - 4 * 360..end].chunks_exact_mut(4) {
                        range.copy_from_slice(&nothing);
                    }
                }
            }
            let is_kept = message.log_time < 1000 * 1_000_000_000;
            is_kept && !is_odometry(message) && message.channel.topic != "/tf"
        });
    };
    without_odometry(u64::MAX);
    let by_scans = conform(&scratch, "changed.mcap");
    has(&by_scans, &json!({ "verdict": "not-known", "evidence": "laser" }), "no odometry");
    assert!(by_scans["matched_scans"]["placed"].as_u64() > Some(100), "{by_scans}");
    without_odometry(100);
    let message = scratch.error(&format!("conform changed.mcap {LASER}"));
    assert!(message.contains("its scans do not match the walls of earlier ones"), "{message}");
    let message = scratch.error("conform changed.mcap --events images");
    assert!(message.contains("this needs image and odometry, and"), "{message}");
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
    for part in ["Figure 1(b) of the paper", "no walk distinguishes"] {
        assert!(flat(&text).contains(part), "{text}");
    }
}

/// Even what was driven fits no other world. A log whose odometry may drift is not accused of it.
#[test]
fn what_was_driven_in_a_real_building_does_not_fit_another_one() {
    let Some(logs) = carmen() else { return };
    let scratch = Scratch::new("real_elsewhere");
    let conform = |name: &str, world: &str| {
        let log = logs.join(name).with_extension("log.gz");
        format!(
            "conform {} --events laser --driver anyone --marker none --world {world}",
            log.display()
        )
    };
    let contradicts = json!({ "verdict": "not-known", "contradiction.cause": "driven" });
    let conforms = json!({ "verdict": "conforms", "contradiction": null });
    scratch.facts(&[
        (&conform("aces", "worlds/real/aces.toml"), 0, conforms),
        (&conform("aces", "worlds/shape-6.toml"), 3, contradicts.clone()),
        (&conform("aces", "worlds/real/seattle.toml --start any"), 3, contradicts),
    ]);
}
