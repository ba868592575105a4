//! Bad usage and bad input: one message that names the file and the place, exit code 2, nothing written.

use std::{fs, path::Path};

use super::{folder, names_in, run, stderr};

const WORLD: &str = "worlds/shape-6.toml";

/// Runs the program and returns its error message.
fn error_of(arguments: &[&str]) -> String {
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
fn a_file_that_is_not_a_world_is_an_error_with_its_place() {
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
            ": line 2, column 11: clockwise.a[1]: vertex `a` lists the neighbour `c`, which does not list `a` back",
        ),
        (
            "three.toml",
            b"[doors]\na = [\"e\", \"e\"]\nb = [\"e\"]\n",
            ": line 2, column 6: doors.a[0]: edge `e` occurs 3 times (a, a, b); an edge has two ends",
        ),
        (
            "pieces.toml",
            b"[clockwise]\na = [\"b\"]\nb = [\"a\"]\nc = [\"d\"]\nd = [\"c\"]\n",
            ": line 4, column 1: clockwise.c: the world is not connected: vertex `c` cannot be reached from `a`",
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
            let error = error_of(arguments);
            assert!(error.starts_with(&message), "{error}");
            assert_eq!(error.lines().count(), 1, "{error}");
        }
        fs::remove_file(file).unwrap();
        assert_eq!(names_in(&folder), [""; 0]);
    }
    let missing = folder.join("missing.toml");
    let error = error_of(&["explore", missing.to_str().unwrap()]);
    assert!(error.contains("missing.toml: cannot be read: "), "{error}");
}

#[test]
fn a_truncated_plantri_code_is_an_error_with_its_byte() {
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
        assert_eq!(error_of(&["check", "--from", &file]), format!("error: {file}{cause}\n"));
        let world = error_of(&["explore", &file]);
        assert_eq!(world, format!("error: {file}{cause}\n"));
    }
}

/// Arguments, and what their error names.
const BAD_ARGUMENTS: &[(&[&str], &str)] = &[
    (&["check", "--edges", "0"], "a world has at least one edge"),
    (&["check", "--edges", "0..=3"], "a world has at least one edge"),
    (&["check", "--edges", "5..=3"], "the range is empty"),
    (&["check", "--edges", "x"], "write a number as in 6, or several as in 1..=6, not `x`"),
    (&["check", "--edges", "1.."], "not `1..`"),
    (&["check", "--edges", "1..3"], "write 1..=3 for all sizes from 1 to 3"),
    (&["check", "--edges", "..3"], "not `..3`"),
    (&["check", "--edges", "99"], "--edges: worlds with 99 edges are too many to enumerate"),
    (&["check", "--edges", "1..=99"], "too many to enumerate; the limit is 32"),
    (&["check", "--shard", "3/2"], "`3/2` is not a shard; write i/n with i from 1 to n"),
    (&["check", "--shard", "0/2"], "`0/2` is not a shard; write i/n with i from 1 to n"),
    (&["check", "--class", "tree"], "the classes are multigraph, simple, corridor and planar"),
    (
        &["check", "--marker", "chalk"],
        "no algorithm maps with `chalk`; choose directional or movable",
    ),
    (&["check", "--marker", "undirected"], "choose directional or movable"),
    (
        &["check", "--marker", "movable", "--choices", "all"],
        "--choices: `all` needs --marker directional",
    ),
    (
        &["check", "--marker", "movable", "--class", "multigraph"],
        "--class: class multigraph has loops or parallel edges, and one movable marker does not \
             suffice for them: no walk distinguishes [v0 = e0 e0 e1 e1] and [v0 = e0 e1 e0 e1]",
    ),
    (
        &["check", "--marker", "movable", "--class", "multigraph"],
        "(see toposlam counterexample --marker movable --class multigraph)",
    ),
    (
        &["check", "--marker", "movable", "--from", "worlds/theta-plane.toml"],
        "worlds/theta-plane.toml: world 1 has loops or parallel edges",
    ),
    (&["check", "--choices", "some"], "[possible values: default, all]"),
    (&["check", "--threads", "0"], "0 is not in 1..=1024"),
    (&["check", "--max-states", "5"], "--max-states: this needs --choices all"),
    (&["explore", WORLD, "--max-states", "5"], "--max-states: this needs --choices all"),
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
    (&["compare", WORLD, WORLD, "--start", "corner:sw"], "`corner` has no neighbour `sw`; it has"),
    (
        &["compare", WORLD, WORLD, "--start", "sw:se", "--start", "sw:se", "--start", "sw:se"],
        "--start: there are two worlds; give it at most twice",
    ),
    (&["compare", WORLD, WORLD, "--walk", "0,left"], "`left` is not an action"),
    (&["compare", WORLD, WORLD, "--walk", "0,9"], "--walk: action 2: door 9 was taken at a"),
    (&["compare", WORLD, WORLD, "--walk", "pick-up"], "action 1: there is no marker here that"),
    (&["counterexample", "--max-edges", "0"], "--max-edges: a world has at least one edge"),
    (&["counterexample", "--max-edges", "33"], "--max-edges: worlds with 33 edges are too many"),
    (&["counterexample", "--expect", "some"], "[possible values: none]"),
    (&["counterexample", "--html", "page.html"], "--html: a page shows one marker; choose it with"),
    (&["counterexample", "--atlas", "x", "--json"], "cannot be used with"),
    (&["proofs", "--choices", "1"], "--run <NAME>"),
    (&["proofs", "--run", "all", "--choices", "1"], "--choices: choices make a case of one lemma"),
    (
        &["proofs", "--run", "a", "--run", "b", "--choices", "1"],
        "--choices: choices make a case of one lemma; choose it with one",
    ),
    (&["proofs", "--run", "all", "--choices", "0,300"], "`300` is not a choice; write numbers"),
    (&["proofs", "--run", "all", "--choices", "-1"], "`-1` is not a choice; write numbers from 0"),
    (&["proofs", "--run", "all", "--choices", "0,,1"], "`` is not a choice; write numbers from 0"),
    (&["proofs", "--run", "all", "--engine", "sampled"], "--choices <NUMBERS>"),
    (&["proofs", "--run", "all", "--choices", "1", "--engine", "kani"], "[possible values: "),
    (&["chekc"], "a similar subcommand exists: 'check'"),
    (&["fly"], "unrecognized subcommand 'fly'"),
];

#[test]
fn a_bad_argument_is_an_error_that_names_what_is_expected() {
    for (arguments, cause) in BAD_ARGUMENTS {
        let error = error_of(arguments);
        assert!(error.contains(cause), "{arguments:?}: {error}");
    }
}

#[test]
fn an_option_without_effect_is_an_error() {
    const LOG: &str = "fuzz/corpus/bag/bz2";
    let cases: [(&[&str], &str); 12] = [
        (&["simulate", WORLD, "--by-scene", "--look", "vinyl"], "cannot be used with"),
        (&["simulate", WORLD, "--by-scene", "--effects", "none"], "cannot be used with"),
        (&["simulate", WORLD, "--by-scene", "--effect", "blur=1"], "cannot be used with"),
        (&["simulate", WORLD, "--by-scene", "--size", "640x480"], "cannot be used with"),
        (&["simulate", WORLD, "--speed", "2"], "not provided:\n  --ros <URI>"),
        (&["simulate", WORLD, "--by-scene", "--speed", "2"], "not provided:\n  --ros <URI>"),
        (
            &[
                "draw", WORLD, "--pose", "start", "--effect", "blur=1", "--effect", "blur=2",
                "--out", "x.png",
            ],
            "--effect: blur is given twice",
        ),
        (&["simulate", WORLD, "--ros", "http://x", "--max-darts", "9"], "cannot be used with"),
        (&["draw", WORLD, "--format", "dot", "--marker", "none"], "--marker: a DOT file does not"),
        (&["draw", WORLD, "--out", "x.dot", "--marker", "none"], "--marker: a DOT file does not"),
        (
            &["conform", "--rerun", LOG, "--calibration", "x.toml"],
            "--calibration: this is for images, and ",
        ),
        (
            &["conform", "--rerun", LOG, "--colours", "x.toml"],
            "--colours: this is for images, and ",
        ),
    ];
    for (arguments, cause) in cases {
        let error = error_of(arguments);
        assert!(error.contains(cause), "{arguments:?}: {error}");
    }
}

#[test]
fn with_a_movable_marker_explore_and_check_reject_the_same_worlds() {
    const TORUS: &str = "worlds/theta-torus.toml";
    let rejected = |verb: &[&str]| error_of(&[verb, &["--marker", "movable"]].concat());
    let message = rejected(&["explore", TORUS]);
    assert!(message.starts_with(&format!("error: {TORUS}: world 1 has loops or parallel edges")));
    assert_eq!(message, rejected(&["check", "--from", TORUS]));
    let message = rejected(&["explore", WORLD, "--choices", "all"]);
    assert_eq!(message, rejected(&["check", "--choices", "all"]));
    let message = error_of(&["explore", WORLD, "--marker", "chalk"]);
    assert!(message.contains("no algorithm maps with `chalk`; choose directional or movable"));
}

#[test]
fn an_output_path_is_checked_before_the_work() {
    let folder = folder("bad_places");
    let (missing, itself) = (folder.join("no/such.svg"), folder.to_str().unwrap());
    let missing = missing.to_str().unwrap();
    let verbs: [&[&str]; 6] = [
        &["check", "--edges", "1..=12", "--worst"],
        &["compare", WORLD, WORLD, "--html"],
        &["counterexample", "--marker", "none", "--max-edges", "12", "--html"],
        &["explore", WORLD, "--map"],
        &["explore", WORLD, "--svg"],
        &["draw", WORLD, "--out"],
    ];
    for verb in verbs {
        let rejected = error_of(&[verb, &[missing]].concat());
        assert!(rejected.starts_with(&format!("error: {missing}: ")), "{rejected}");
        let rejected = error_of(&[verb, &[itself]].concat());
        assert!(rejected.starts_with(&format!("error: {itself}: ")), "{rejected}");
        assert_eq!(names_in(&folder), [""; 0]);
    }
}

#[test]
fn no_input_causes_a_panic() {
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
            error_of(&["check", "--from", &file]);
            error_of(&["explore", &file]);
        }
    }
    let file = write(&folder, "w.json", format!("{{\"name\":{deep}").as_bytes());
    error_of(&["explore", &file]);
}

#[test]
fn a_marker_needs_a_start_in_each_world() {
    let folder = folder("no_start");
    let file = write(&folder, "path.toml", b"[clockwise]\na = [\"b\"]\nb = [\"a\"]\n");
    let page = folder.join("page.html");
    let page = page.to_str().unwrap();
    for arguments in [[WORLD, &file], [&file, WORLD]] {
        let compared = [&["compare", "--html", page, "--marker", "undirected"], &arguments[..]];
        let rejected = error_of(&compared.concat());
        let cause = "there is no [start] that places the undirected marker; give --start";
        assert!(rejected.starts_with(&format!("error: {file}: {cause}")), "{rejected}");
    }
    let rejected = error_of(&["compare", "--html", page, &file, WORLD]);
    assert!(rejected.starts_with("error: --html: a world has no start"), "{rejected}");
    let rejected = error_of(&["compare", "--walk", "0", &file, WORLD]);
    assert!(rejected.starts_with("error: --walk: a world has no start"), "{rejected}");
    assert_eq!(names_in(&folder), ["path.toml"]);
}

#[test]
fn an_output_folder_is_checked_before_the_work() {
    let folder = folder("no_folder");
    let file = write(&folder, "file", b"");
    let inside = format!("{file}/inside");
    for place in [&file, &inside] {
        for verb in [["--out-dir", place], ["--atlas", place]] {
            let rejected =
                error_of(&[&["counterexample", "--max-edges", "12"], &verb[..]].concat());
            assert!(
                rejected.starts_with(&format!("error: {place}: the folder cannot be created")),
                "{rejected}"
            );
        }
    }
}

#[cfg(not(feature = "ros1"))]
#[test]
fn without_ros_the_error_names_the_build_command() {
    let master = "http://127.0.0.1:11311";
    let drive = ["drive", "--ros", master, "--calibration", "c.toml", "--colours", "d.toml"];
    for arguments in [&drive[..], &["simulate", WORLD, "--ros", master]] {
        let message = error_of(arguments);
        assert!(message.contains("cargo build --release --features ros1"), "{message}");
    }
}

#[test]
fn a_robot_that_another_program_drives_makes_no_map() {
    let message = error_of(&["simulate", WORLD, "--ros", "http://127.0.0.1:1", "--map", "x.toml"]);
    assert!(message.contains("cannot be used with"), "{message}");
}
