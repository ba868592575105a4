//! Bad usage and bad input: one message that names file and place, exit code 2, nothing written.

use std::{fs, path::Path};

use super::{folder, names_in, run, stderr};

const WORLD: &str = "worlds/shape-6.toml";

/// Runs it and answers its one message.
fn refusal(arguments: &[&str]) -> String {
    let output = run(arguments);
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
    assert!(output.stdout.is_empty(), "{arguments:?}");
    assert!(message.starts_with("error: "), "{arguments:?}: {message}");
    assert_eq!(message.matches("error:").count(), 1, "{arguments:?}: {message}");
    assert!(!message.contains("panicked"), "{arguments:?}: {message}");
    message
}

fn write(folder: &Path, name: &str, bytes: &[u8]) -> String {
    let file = folder.join(name);
    fs::write(&file, bytes).unwrap();
    file.to_str().unwrap().to_owned()
}

#[test]
fn a_file_that_is_no_world_is_refused_with_its_place() {
    let folder = folder("bad_worlds");
    let files: [(&str, &[u8], &str); 11] = [
        ("empty.toml", b"", ": the file is empty"),
        ("broken.toml", b"name = \"x", ": line 1, column 10: invalid basic string"),
        ("broken.json", b"{\"name\": ", ": line 1, column 9: EOF"),
        ("binary.toml", b"\xff\xfe", ": line 1, column 1: this is not UTF-8 text"),
        (
            "key.toml",
            b"colour = 1\n[clockwise]\na = [\"b\"]\nb = [\"a\"]\n",
            ": line 1, column 1: colour: unknown key; expected one of: name, about, clockwise, doors",
        ),
        (
            "one-sided.toml",
            b"[clockwise]\na = [\"b\", \"c\"]\nb = [\"a\"]\nc = [\"b\"]\n",
            ": line 2, column 1: clockwise.a: vertex `a` lists the neighbour `c`, which does not list `a` back",
        ),
        (
            "three.toml",
            b"[doors]\na = [\"e\", \"e\"]\nb = [\"e\"]\n",
            ": line 1, column 2: doors: edge `e` stands 3 times (a, a, b); an edge has two ends",
        ),
        (
            "pieces.toml",
            b"[clockwise]\na = [\"b\"]\nb = [\"a\"]\nc = [\"d\"]\nd = [\"c\"]\n",
            ": line 1, column 2: clockwise: the world is not connected: vertex `c` cannot be reached from `a`",
        ),
        (
            "facing.toml",
            b"[clockwise]\na = [\"b\"]\nb = [\"a\"]\n[start]\nat = \"a\"\nfacing = \"z\"\n",
            ": line 6, column 10: start.facing: vertex `a` has no neighbour `z`; it has b",
        ),
        (
            "nothing.toml",
            b"name = \"x\"\n",
            ": there is no world; the file needs one of [clockwise], [doors]",
        ),
        ("caf\u{e9} \u{2603}.toml", b" ", ": the file is empty"),
    ];
    let worst = folder.join("worst.toml");
    for (name, bytes, place_and_cause) in files {
        let file = write(&folder, name, bytes);
        let message = format!("error: {file}{place_and_cause}");
        let (file, worst) = (file.as_str(), worst.to_str().unwrap());
        let runs: [&[&str]; 5] = [
            &["explore", file, "--map", worst, "--svg", worst],
            &["explore", file, "--json"],
            &["check", "--from", file, "--worst", worst],
            &["compare", WORLD, file],
            &["draw", file],
        ];
        for arguments in runs {
            let refusal = refusal(arguments);
            assert!(refusal.starts_with(&message), "{refusal}");
            assert_eq!(refusal.lines().count(), 1, "{refusal}");
        }
        fs::remove_file(file).unwrap();
        assert_eq!(names_in(&folder), [""; 0]);
    }
    let missing = folder.join("missing.toml");
    let refusal = refusal(&["explore", missing.to_str().unwrap()]);
    assert!(refusal.contains("missing.toml: cannot be read: "), "{refusal}");
}

#[test]
fn truncated_codes_are_refused_with_their_byte() {
    let folder = folder("bad_codes");
    let codes: [(&str, &[u8], &str); 3] = [
        (
            "short.pc",
            b">>planar_code<<\x04\x02\x03",
            ": byte 18, world 1: the file ends in the middle of a world",
        ),
        (
            "short.ec",
            b">>edge_code<<\x04\x00",
            ": byte 15, world 1: the file ends in the middle of a world",
        ),
        ("none.pc", b">>planar_code<<", ": byte 15, world 1: there is no world"),
    ];
    for (name, bytes, cause) in codes {
        let file = write(&folder, name, bytes);
        assert_eq!(refusal(&["check", "--from", &file]), format!("error: {file}{cause}\n"));
        let world = refusal(&["explore", &file]);
        assert_eq!(world, format!("error: {file}{cause}\n"));
    }
}

#[test]
fn bad_arguments_are_refused_with_what_is_wanted() {
    let cases: [(&[&str], &str); 50] = [
        (&["check", "--edges", "0"], "a world has at least one edge"),
        (&["check", "--edges", "0..=3"], "a world has at least one edge"),
        (&["check", "--edges", "5..=3"], "the range is empty"),
        (&["check", "--edges", "x"], "write a number as in 6, or several as in 1..=6, not `x`"),
        (&["check", "--edges", "1.."], "not `1..`"),
        (&["check", "--edges", "99"], "--edges: worlds with 99 edges are too many to enumerate"),
        (&["check", "--edges", "1..=99"], "too many to enumerate; the limit is 32"),
        (&["check", "--shard", "3/2"], "`3/2` is no shard; write i/n with i from 1 to n"),
        (&["check", "--shard", "0/2"], "`0/2` is no shard; write i/n with i from 1 to n"),
        (&["check", "--class", "tree"], "there are multigraph, simple, corridor and planar"),
        (
            &["check", "--marker", "chalk"],
            "`chalk` is no marker to map with; there are directional and movable",
        ),
        (&["check", "--marker", "undirected"], "there are directional and movable"),
        (
            &["check", "--marker", "movable", "--choices", "all"],
            "--choices: all choices are those of Algorithm 1, which maps with the directional marker",
        ),
        (
            &["check", "--marker", "movable", "--class", "multigraph"],
            "--class: class multigraph has loops or parallel edges, and with these one movable \
             marker does not suffice: no walk tells [v0 = e0 e0 e1 e1] from [v0 = e0 e1 e0 e1]",
        ),
        (
            &["check", "--marker", "movable", "--class", "multigraph"],
            "(toposlam counterexample --marker movable --class multigraph)",
        ),
        (
            &["check", "--marker", "movable", "--from", "worlds/theta-plane.toml"],
            "worlds/theta-plane.toml: world 1 has loops or parallel edges",
        ),
        (&["check", "--choices", "some"], "[possible values: default, all]"),
        (&["check", "--threads", "0"], "0 is not in 1..=1024"),
        (&["check", "--max-states", "5"], "--max-states: this goes with --choices all"),
        (&["explore", WORLD, "--max-states", "5"], "--max-states: this goes with --choices all"),
        (&["check", "--edges", "6", "--from", WORLD], "cannot be used with"),
        (&["explore", WORLD, "--start", "corner"], "--start: `corner` is not a start"),
        (&["explore", WORLD, "--start", "hall:tee"], "--start: there is no vertex `hall`"),
        (
            &["explore", WORLD, "--start", "corner:sw"],
            "--start: vertex `corner` has no neighbour `sw`; it has end, tee",
        ),
        (&["draw", WORLD, "--start", "corner:sw"], "--start: vertex `corner` has no neighbour"),
        (&["draw", WORLD, "--out", "w.jpg"], "w.jpg: the name must end in .svg or .png or .dot"),
        (&["compare", WORLD, WORLD, "--marker", "chalk"], "[possible values: none, undirected,"),
        (&["draw", WORLD, "--marker", "chalk"], "invalid value 'chalk' for '--marker <KIND>'"),
        (&["counterexample", "--marker", "chalk"], "two-identical, two-distinct, movable]"),
        (&["compare", WORLD, WORLD, "--start", "corner"], "--start: `corner` is not a start"),
        (
            &["compare", WORLD, WORLD, "--start", "corner:sw"],
            "`corner` has no neighbour `sw`; it has",
        ),
        (
            &["compare", WORLD, WORLD, "--start", "sw:se", "--start", "sw:se", "--start", "sw:se"],
            "--start: there are two worlds; give it twice at most",
        ),
        (&["compare", WORLD, WORLD, "--walk", "0,left"], "`left` is nothing that a robot can do"),
        (&["compare", WORLD, WORLD, "--walk", "0,9"], "--walk: action 2: door 9 was taken at a"),
        (&["compare", WORLD, WORLD, "--walk", "pick-up"], "action 1: there is no marker here that"),
        (&["counterexample", "--edges", "0"], "--edges: a world has at least one edge"),
        (&["counterexample", "--edges", "33"], "--edges: worlds with 33 edges are too many"),
        (&["counterexample", "--expect", "some"], "[possible values: none]"),
        (
            &["counterexample", "--html", "page.html"],
            "--html: a page shows one marker; name it with",
        ),
        (&["counterexample", "--atlas", "x", "--json"], "cannot be used with"),
        (&["proofs", "--choices", "1"], "--run <NAME>"),
        (
            &["proofs", "--run", "all", "--choices", "1"],
            "--choices: these make a case of one lemma",
        ),
        (
            &["proofs", "--run", "a", "--run", "b", "--choices", "1"],
            "--choices: these make a case of one lemma; name it with one --run",
        ),
        (&["proofs", "--run", "all", "--choices", "0,300"], "`300` is no choice; write numbers"),
        (&["proofs", "--run", "all", "--choices", "-1"], "`-1` is no choice; write numbers from 0"),
        (&["proofs", "--run", "all", "--choices", "0,,1"], "`` is no choice; write numbers from 0"),
        (&["proofs", "--run", "all", "--engine", "sampled"], "--choices <NUMBERS>"),
        (&["proofs", "--run", "all", "--choices", "1", "--engine", "kani"], "[possible values: "),
        (&["chekc"], "a similar subcommand exists: 'check'"),
        (&["fly"], "unrecognized subcommand 'fly'"),
    ];
    for (arguments, cause) in cases {
        let refusal = refusal(arguments);
        assert!(refusal.contains(cause), "{arguments:?}: {refusal}");
    }
}

#[test]
fn with_a_movable_marker_explore_refuses_what_check_refuses() {
    const TORUS: &str = "worlds/theta-torus.toml";
    let refused = |verb: &[&str]| refusal(&[verb, &["--marker", "movable"]].concat());
    let message = refused(&["explore", TORUS]);
    assert!(message.starts_with(&format!("error: {TORUS}: world 1 has loops or parallel edges")));
    assert_eq!(message, refused(&["check", "--from", TORUS]));
    let message = refused(&["explore", WORLD, "--choices", "all"]);
    assert_eq!(message, refused(&["check", "--choices", "all"]));
    let message = refusal(&["explore", WORLD, "--marker", "chalk"]);
    assert!(
        message.contains("`chalk` is no marker to map with; there are directional and movable")
    );
}

#[test]
fn a_place_that_cannot_become_a_file_is_refused_before_the_work() {
    let folder = folder("bad_places");
    let (missing, itself) = (folder.join("no/such.svg"), folder.to_str().unwrap());
    let missing = missing.to_str().unwrap();
    let verbs: [&[&str]; 6] = [
        &["check", "--edges", "1..=12", "--worst"],
        &["compare", WORLD, WORLD, "--html"],
        &["counterexample", "--marker", "none", "--edges", "12", "--html"],
        &["explore", WORLD, "--map"],
        &["explore", WORLD, "--svg"],
        &["draw", WORLD, "--out"],
    ];
    for verb in verbs {
        let refused = refusal(&[verb, &[missing]].concat());
        assert!(refused.starts_with(&format!("error: {missing}: ")), "{refused}");
        let refused = refusal(&[verb, &[itself]].concat());
        assert!(refused.starts_with(&format!("error: {itself}: ")), "{refused}");
        assert_eq!(names_in(&folder), [""; 0]);
    }
}

#[test]
fn no_bytes_make_it_panic() {
    let folder = folder("nasty");
    let deep = "[".repeat(100_000);
    let nasty: [&[u8]; 12] = [
        b"\0",
        b"\xef\xbb\xbf",
        b"{",
        b"{}",
        b"[]",
        b"null",
        b"[clockwise]",
        b"[doors]\na = []",
        b"clockwise = { a = [\"a\", \"a\"] }",
        b">>edge_code<<\x00\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff",
        b">>planar_code le<<\x00\xff\xff\x01\x00",
        deep.as_bytes(),
    ];
    for bytes in nasty {
        for name in ["w.toml", "w.json", "w.pc", "w.ec"] {
            let file = write(&folder, name, bytes);
            refusal(&["check", "--from", &file]);
            refusal(&["explore", &file]);
        }
    }
    let file = write(&folder, "w.json", format!("{{\"name\":{deep}").as_bytes());
    refusal(&["explore", &file]);
}

#[test]
fn a_marker_that_needs_a_start_is_refused_in_a_world_without_one() {
    let folder = folder("no_start");
    let file = write(&folder, "path.toml", b"[clockwise]\na = [\"b\"]\nb = [\"a\"]\n");
    let page = folder.join("page.html");
    let page = page.to_str().unwrap();
    for arguments in [[WORLD, &file], [&file, WORLD]] {
        let compared = [&["compare", "--html", page, "--marker", "undirected"], &arguments[..]];
        let refused = refusal(&compared.concat());
        let cause = "there is no [start], by which the undirected marker is placed; give --start";
        assert!(refused.starts_with(&format!("error: {file}: {cause}")), "{refused}");
    }
    let refused = refusal(&["compare", "--html", page, &file, WORLD]);
    assert!(refused.starts_with("error: --html: there is no start to walk from"), "{refused}");
    let refused = refusal(&["compare", "--walk", "0", &file, WORLD]);
    assert!(refused.starts_with("error: --walk: there is no start to walk from"), "{refused}");
    assert_eq!(names_in(&folder), ["path.toml"]);
}

#[test]
fn a_folder_that_cannot_be_made_is_refused_before_the_work() {
    let folder = folder("no_folder");
    let file = write(&folder, "file", b"");
    let inside = format!("{file}/inside");
    for place in [&file, &inside] {
        for verb in [["--out", place], ["--atlas", place]] {
            let refused = refusal(&[&["counterexample", "--edges", "12"], &verb[..]].concat());
            assert!(refused.starts_with(&format!("error: {place}: cannot be made")), "{refused}");
        }
    }
}

#[cfg(not(feature = "ros1"))]
#[test]
fn without_ros_the_program_says_how_it_is_built_with_it() {
    let master = "http://127.0.0.1:11311";
    let drive = ["drive", "--ros", master, "--calibration", "c.toml", "--colours", "d.toml"];
    for arguments in [&drive[..], &["simulate", WORLD, "--ros", master]] {
        let message = refusal(arguments);
        assert!(message.contains("cargo build --release --features ros1"), "{message}");
    }
}

#[test]
fn a_robot_that_is_driven_by_somebody_else_makes_no_map() {
    let message = refusal(&["simulate", WORLD, "--ros", "http://127.0.0.1:1", "--map", "x.toml"]);
    assert!(message.contains("cannot be used with"), "{message}");
}
