//! The pages in a browser: walks in two worlds, runs, games, reports of conformance. Sections 2.1 to 2.3 and 6.

use std::fs;

use toposlam_model::aid::{AIDS, markers::MOVABLE};

use crate::{browser, output, program};

/// Writes a page by each of these commands, which end with the option for its file, and opens them in a browser.
/// Before each command stands its kind; OUT is the folder.
fn open(script: &str, name: &str, commands: &[(&str, &str)]) {
    let folder = output::folder(name);
    let pages = commands.iter().enumerate().map(|(number, (kind, command))| {
        let file = folder.join(format!("{kind}-{number}.html"));
        let command = command.replace("OUT", folder.to_str().unwrap());
        let output = program().args(command.split(' ')).arg(&file).output().unwrap();
        assert!(file.exists(), "{command}: {output:?}");
        format!("{kind}={}", file.display())
    });
    browser::open(script, &pages.collect::<Vec<_>>());
}

/// Figure 1: a random walk in its two worlds shows the same percepts in both as long as the marker does not point.
/// With a directional marker a walk distinguishes them. Other robots and a string are sent and laid by hand.
#[test]
#[ignore = "it takes long: `.ci/run`"]
fn the_percepts_of_figure_1_are_equal_until_the_marker_points() {
    let kinds = [
        "undirected",
        "undirected-edge",
        "directed-edge",
        "directional",
        "two-distinct",
        "movable",
        "movable-directional",
        "team-2",
        "string-2",
    ];
    let commands = kinds.map(|marker| {
        let kind = match marker {
            "undirected" => "alike",
            "team-2" => "team",
            "string-2" => "string",
            _ => "apart",
        };
        let worlds = "worlds/figure-1a.toml worlds/figure-1b.toml";
        (kind, format!("compare {worlds} --marker {marker} --html"))
    });
    open("walk_page.mjs", "walk-pages", &commands.each_ref().map(|(kind, line)| (*kind, &**line)));
}

#[test]
#[ignore = "it takes long: `.ci/run`"]
fn the_page_of_a_run_follows_it_to_its_end() {
    let by_scene = "worlds/shape-6.toml --seed 3 --by-scene --html";
    open(
        "run_page.mjs",
        "run-pages",
        &[
            (
                "right",
                "simulate worlds/shape-6.toml --seed 3 --size 640x480 --fault dropped@30 --html",
            ),
            ("blind", &format!("simulate {by_scene}")),
            ("wrong", "simulate worlds/shape-8.toml --by-scene --fault carried@80 --html"),
            ("large", "simulate worlds/building-25.toml --by-scene --html"),
        ],
    );
}

/// Explorers on a chain of five edges: each goes in by three doors. One then returns a chain of two edges, one that of
/// five, and one takes a door that does not exist.
#[test]
#[ignore = "it takes long: `.ci/run`"]
fn the_page_of_an_explorer_steps_through_its_run() {
    let folder = output::folder("explorers");
    let ends = [
        ("wrong", r#"{"map":[[[1,0]],[[0,0],[2,0]],[[1,1]]],"pose":[2,0]}"#),
        (
            "guessed",
            r#"{"map":[[[1,0]],[[0,0],[2,0]],[[1,1],[3,0]],[[2,1],[4,0]],[[3,1],[5,0]],[[4,1]]],"pose":[3,0]}"#,
        ),
        ("alone", r#"{"door":7}"#),
    ];
    let pages = ends.map(|(kind, answer)| {
        let script = folder.join(format!("{kind}.sh"));
        let doors = [0, 1, 1].map(|door| format!("read line; echo '{{\"door\":{door}}}'\n"));
        fs::write(&script, format!("{}read line; echo '{answer}'; read line\n", doors.concat()))
            .unwrap();
        let page = folder.join(format!("{kind}.html"));
        let output = program()
            .args(["check", "--from", "worlds/chain-5.toml", "--start", "v0:v1", "--explorer"])
            .arg(format!("sh {}", script.display()))
            .arg("--failed")
            .arg(&page)
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(1), "{output:?}");
        format!("{kind}={}", page.display())
    });
    browser::open("explorer_page.mjs", &pages);
}

#[test]
#[ignore = "it takes long: `.ci/run`"]
fn the_page_of_a_report_opens_and_leads_to_its_events() {
    let folder = output::folder("conform-logs");
    let path = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let [right, wrong, cut] = ["monday.mcap", "tuesday.jsonl", "wednesday-<b>of-it.mcap"].map(path);
    let run = format!("simulate worlds/shape-6.toml --by-scene --log {right}");
    crate::printed(program().args(run.split(' ')));
    let log = fs::read(&right).unwrap();
    fs::write(&cut, &log[..log.len() / 2]).unwrap();
    // From the marker around the loop again and again. Once its T has four doors.
    let visits = (0..5000).map(|visit| {
        let (degree, marker, door) = match visit {
            0 => (2, 0, 0),
            1 => (3, -1, 1),
            3501 => (4, -1, 2),
            _ if visit % 4 == 1 => (3, -1, 2),
            _ => (2, -1, 1),
        };
        format!("{{\"degree\":{degree},\"marker\":{marker},\"door\":{door}}}\n")
    });
    fs::write(&wrong, visits.collect::<String>()).unwrap();
    let options = "--world worlds/shape-6.toml --start any --driver anyone";
    open(
        "conform_page.mjs",
        "conform-pages",
        &[
            ("conforms", &format!("conform {right} {options} --html")),
            ("diverged", &format!("conform {wrong} {options} --minimise OUT/short.mcap --html")),
            ("open", &format!("conform {cut} {options} --html")),
            ("several", &format!("conform {right} {wrong} {cut} {options} --html")),
        ],
    );
}

/// A place with two loops, at the end of an edge from the marker.
const LOOPS: &str = "[doors]\ns = [\"e\"]\na = [\"e\", \"l\", \"l\", \"m\", \"m\"]\n\n\
                     [start]\nat = \"s\"\nfacing = \"e\"\n";

#[test]
#[ignore = "it takes long: `.ci/run`"]
fn a_game_with_true_claims_is_won_and_other_maps_are_judged() {
    let loops = output::folder("game-worlds").join("loops.toml");
    fs::write(&loops, LOOPS).unwrap();
    open(
        "play_page.mjs",
        "game-pages",
        &[
            ("right", "play worlds/shape-8.toml --out"),
            ("right", "play worlds/figure-1b.toml --out"),
            ("right", "play worlds/building-12.toml --start west:north-west --out"),
            ("right", "play worlds/two-loops-torus.toml --out"),
            ("right", "play worlds/k4-plane.toml --out"),
            ("right", "play worlds/k4-torus.toml --out"),
            ("right", "play --edges 8 --seed 3 --out"),
            ("right", "play --class multigraph --edges 6 --out"),
            ("loops", &format!("play {} --out", loops.display())),
            ("guessed", "play worlds/figure-1a.toml --marker undirected --out"),
            ("proved", "play worlds/figure-1a.toml --marker two-distinct --out"),
            ("proved", "play worlds/k4-torus.toml --marker directed-edge --out"),
            ("movable", "play worlds/shape-8.toml --marker movable --out"),
        ],
    );
}

/// In Figure 1(b), on the torus, and in a corridor: every other aid that moves.
#[test]
#[ignore = "it takes long: `.ci/run`"]
fn a_game_can_be_won_with_each_aid_that_moves() {
    let games = AIDS.into_iter().filter(|aid| aid.moves() && *aid != MOVABLE.into());
    let worlds = ["shape-8", "figure-1b"].into_iter().cycle();
    let commands: Vec<_> = games
        .zip(worlds)
        .map(|(aid, world)| format!("play worlds/{world}.toml --aid {} --out", aid.name()))
        .collect();
    let commands: Vec<_> = commands.iter().map(|line| ("aid", &**line)).collect();
    open("play_page.mjs", "aid-pages", &commands);
}
