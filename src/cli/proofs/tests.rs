use std::{thread, time::Duration};

use clap::{Args, FromArgMatches};
use serde_json::{Value, json};
use toposlam_model::{
    embedded_graph::Dart,
    enumerate::Watch,
    format::world_file,
    marker::{Marker, Undirected},
    percept::{Door, Sighting},
};
use toposlam_proofs::{
    CaseReplay, CaseResult, ChoiceOdometer, Choose, Exhibit,
    choose::{claim, given},
    draw,
    lemma::Exhaustive,
};

use super::*;

/// Runs the verb on these lemmas.
fn run(lemmas: &[Lemma], line: &str) -> (Result<Outcome, CliError>, String) {
    let command = ProofsArguments::augment_args(clap::Command::new("proofs").no_binary_name(true));
    let matches = command.try_get_matches_from(line.split_whitespace()).unwrap();
    let arguments = ProofsArguments::from_arg_matches(&matches).unwrap();
    let mut out = Vec::new();
    let theorems = [Theorem { name: "round", sentence: "It turns.".into(), paper: "2.2".into() }];
    let outcome = arguments.run_with(&lemmas.iter().collect::<Vec<_>>(), &theorems, &mut out);
    (outcome, String::from_utf8(out).unwrap())
}

/// The objects that the verb prints, which ends with this outcome.
fn objects(lemmas: &[Lemma], line: &str, expected: Outcome) -> Vec<Value> {
    let (outcome, text) = run(lemmas, &format!("{line} --json"));
    assert_eq!(outcome.unwrap(), expected, "{text}");
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn lemma(
    name: &'static str,
    cases: u64,
    body: fn(&mut ChoiceOdometer) -> CaseResult,
    replay: fn(&mut CaseReplay) -> CaseResult,
) -> Lemma {
    let exhaustive = Exhaustive { bound: "a few", cases, body, replay };
    let (sentence, paper, file) = ("It is so.", "2.1", "here.rs");
    Lemma { name, sentence, paper, file, exhaustive, sampled: None, kani: None }
}

/// False: at a vertex with an undirected marker the robot may have entered by any dart.
fn a_marker_shows_the_entry<C: Choose>(choose: &mut C) -> CaseResult {
    let graph = draw::start_of::<1, 2>(choose)?;
    let pose = draw::dart(choose, &graph);
    let door = draw::door(choose, &graph, pose);
    choose.show(|| Exhibit::walk(pose, &[door]));
    let pose = graph.after(pose, door);
    let sighting = Undirected.sighting(&graph, Dart(0), pose);
    choose.show(|| Exhibit::Value { name: "undirected", value: sighting.to_string() });
    given(choose, sighting != Sighting::Nothing)?;
    claim("the robot has come in by the facing dart", pose == Dart(0))
}

fn numbers_are_low<C: Choose>(choose: &mut C) -> CaseResult {
    let number = choose.below(6);
    given(choose, number < 4)?;
    claim("it is below 4", number < 4)
}

fn false_lemma() -> Lemma {
    lemma("entry", 1, a_marker_shows_the_entry, a_marker_shows_the_entry)
}

fn true_lemma(name: &'static str, pinned: u64) -> Lemma {
    lemma(name, pinned, numbers_are_low, numbers_are_low)
}

const FAILED: &str = "
entry
  It is so.
  fails: it is not true that the robot has come in by the facing dart
  again: toposlam proofs --run entry --choices 0,1,0,0,0

The world, as a file for `toposlam draw` and `toposlam explore`:

name = \"case\"
about = \"A case of entry\"

[doors]
v0 = [\"e0\", \"e0\"]

[start]
at = \"v0\"
facing = \"e0:1\"

A walk in the world, marker directional:

  door   robot at  perceives
  start  v0:0      2 doors, marker along door 0
  0      v0:1      2 doors, marker along door 1

undirected: marker

violated: the lemma fails in this case
";

#[test]
fn a_lemma_that_fails_prints_the_case_and_the_command_that_repeats_it() {
    let lemmas = [false_lemma(), true_lemma("low", 4)];
    let (outcome, text) = run(&lemmas, "--run all");
    assert_eq!(outcome.unwrap(), Outcome::Violated);
    let rows: Vec<_> = text.lines().take(2).collect();
    assert!(rows[0].starts_with("entry   1 case  ") && rows[0].ends_with(" s  fails"), "{text}");
    assert!(rows[1].starts_with("low    4 cases  ") && rows[1].ends_with(" s  holds"), "{text}");
    let (_, failed) = text.split_at(rows[0].len() + rows[1].len() + 2);
    assert_eq!(failed, format!("{FAILED}\nviolated: 1 of 2 lemmas held, 4 cases\n"));
    let again = text.lines().find_map(|line| line.strip_prefix("  again: toposlam proofs "));
    let (outcome, text) = run(&lemmas, again.unwrap());
    assert_eq!((outcome.unwrap(), text.as_str()), (Outcome::Violated, &FAILED[1..]));

    let lines = objects(&lemmas, "--run all", Outcome::Violated);
    let [failed, held, case, totals] = lines.as_slice() else { panic!("{lines:?}") };
    for (line, fields) in [
        (
            failed,
            json!({ "lemma": "entry", "holds": false, "cases": 1, "choices": [0, 1, 0, 0, 0] }),
        ),
        (held, json!({ "lemma": "low", "holds": true, "cases": 4, "choices": null })),
        (totals, json!({ "lemmas": 2, "held": 1, "cases": 4, "not_checked": 0, "holds": false })),
        (
            case,
            json!({ "lemma": "entry", "holds": false, "engine": "exhaustive", "verdict": "fails" }),
        ),
        (case, json!({ "claim": failed["claim"], "choices": failed["choices"] })),
    ] {
        for (key, value) in fields.as_object().unwrap() {
            assert_eq!(&line[key], value, "{key}: {line}");
        }
    }
    let world = world_file::read(case["worlds"][0].to_string().as_bytes()).unwrap();
    assert_eq!((world.graph.edge_count(), world.start), (1, Some(Dart(0))));
    let seen = |door: u32| json!({ "degree": 2, "sighting": format!("marker along door {door}") });
    let walk = json!([{
        "world": 0, "marker": "directional", "doors": [0], "poses": ["v0:0", "v0:1"],
        "percepts": [seen(0), seen(1)], "stopped": null,
    }]);
    assert_eq!(case["walks"], walk);
    assert_eq!(case["values"], json!([{ "name": "undirected", "value": "marker" }]));
}

#[test]
fn a_case_holds_or_is_excluded() {
    for (choices, expected, verdict) in [
        ("3", Outcome::Holds, "holds: the lemma holds in this case"),
        ("4", Outcome::Incomplete, "incomplete: the lemma excludes this case"),
    ] {
        let line = format!("--run low --choices {choices}");
        let (outcome, text) = run(&[true_lemma("low", 4)], &line);
        assert_eq!(outcome.unwrap(), expected);
        assert!(text.ends_with(&format!("\n\n{verdict}\n")), "{text}");
    }
}

#[test]
fn a_lemma_with_another_number_of_cases_than_expected_fails() {
    fn excluded<C>(_: &mut C) -> CaseResult {
        Err(Stop::Excluded)
    }
    for (pinned, cause) in
        [(5, "expected 5 cases within its bound, found 4 cases"), (1, "found 4 cases")]
    {
        let (outcome, text) = run(&[true_lemma("low", pinned)], "--run low");
        assert_eq!(outcome.unwrap(), Outcome::Violated);
        assert!(text.contains(" s  fails\n\nlow\n  It is so.\n  fails: expected "), "{text}");
        assert!(text.contains(cause), "{text}");
        assert!(text.ends_with("\n\nviolated: 0 of 1 lemma held, 0 cases\n"), "{text}");
        let line = &objects(&[true_lemma("low", pinned)], "--run low", Outcome::Violated)[0];
        assert_eq!((&line["cases"], &line["pinned"]), (&4.into(), &pinned.into()));
        assert_eq!((&line["holds"], &line["choices"]), (&false.into(), &Value::Null));
    }
    let (outcome, text) = run(&[lemma("none", 0, excluded, excluded)], "--run none");
    assert_eq!(outcome.unwrap(), Outcome::Violated, "{text}");
}

/// Each walk goes as far as possible, if its world exists.
#[test]
fn several_worlds_are_numbered() {
    fn two_worlds<C: Choose>(choose: &mut C) -> CaseResult {
        let walk = |world, dart, door| {
            let (marker, pose) = (&Undirected, Dart(dart));
            move || Exhibit::Walk { world, marker, pose, doors: vec![Door(door)] }
        };
        choose.show(walk(0, 0, 7));
        draw::start::<2>(choose, 1)?;
        choose.show(walk(0, 0, 0));
        choose.show(walk(0, 9, 0));
        draw::start::<2>(choose, 2)?;
        choose.show(walk(1, 2, 2));
        Ok(())
    }
    let lemmas = [lemma("two", 20, two_worlds, two_worlds)];
    let (outcome, text) = run(&lemmas, "--run two --choices 0,0,0,0,0");
    assert_eq!(outcome.unwrap(), Outcome::Holds);
    let heads: Vec<_> =
        text.lines().filter(|line| line.contains("orld ") && line.ends_with(':')).collect();
    let world = |n| format!("World {n}, as a file for `toposlam draw` and `toposlam explore`:");
    let walk = |n| format!("A walk in world {n}, marker undirected:");
    assert_eq!(heads, [world(1), walk(1), world(2), walk(2)]);
    for part in [
        "\nwalk: from dart 0 by the doors 7\n",
        "\nwalk: from dart 9 by the doors 0\n",
        "name = \"case-1\"",
        "name = \"case-2\"",
        "  stopped: door 2 was taken at a vertex with 2 doors\n",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
}

#[test]
fn a_case_may_have_no_choices_and_a_lemma_that_panics_fails() {
    fn never<C>(_: &mut C) -> CaseResult {
        claim("one is two", false)
    }
    fn panics<C: Choose>(choose: &mut C) -> CaseResult {
        let number = choose.below(4);
        assert!(number < 2, "a lemma of a test does this");
        claim("it is below 2", number < 2)
    }
    let lemmas = [lemma("never", 1, never, never), lemma("wild", 1, panics, panics)];
    for (name, claim, choices) in
        [("never", "one is two", ""), ("wild", "the code does not panic", " 2")]
    {
        let (outcome, text) = run(&lemmas, &format!("--run {name}"));
        assert_eq!(outcome.unwrap(), Outcome::Violated);
        let again = format!("--run {name} --choices{choices}");
        let fails =
            format!("  fails: it is not true that {claim}\n  again: toposlam proofs {again}\n");
        assert!(text.contains(&fails), "{text}");
        assert_eq!(run(&lemmas, &again).0.unwrap(), Outcome::Violated);
    }
}

#[test]
fn a_unique_part_of_a_name_is_enough() {
    let lemmas = ["low", "lowest", "high"].map(|name| true_lemma(name, 4));
    for (part, name) in [("low", "low"), ("lowe", "lowest"), ("hi", "high")] {
        let lines = objects(&lemmas, &format!("--run {part} --run {name}"), Outcome::Holds);
        assert_eq!((lines.len(), &lines[0]["lemma"]), (2, &name.into()));
    }
    let proved = "round is proved in Coq, for every world; run proofs/coq/check to check it";
    for (line, cause) in [
        ("--run lo", "--run: `lo` is part of several names:\n  low\n  lowest"),
        ("--run law", "--run: there is no lemma `law`; there are:\n  low\n  lowest\n  high"),
        ("--run high --choices 0 --engine sampled", "--engine: high is not sampled"),
        ("--run all --run round", &format!("--run: {proved}")),
    ] {
        let (Err(CliError::Input(message)), text) = run(&lemmas, line) else { panic!() };
        assert_eq!((message.as_str(), text), (cause, String::new()));
    }
}

#[test]
fn an_interrupt_does_not_wait_for_the_case() {
    struct AtOnce;
    impl Watch for AtOnce {
        fn stop(&self) -> bool {
            true
        }
    }
    fn endless<C>(_: &mut C) -> CaseResult {
        loop {
            thread::sleep(Duration::from_secs(60));
        }
    }
    let endless = lemma("endless", 9, endless, endless);
    for (json, end) in [
        (false, "\nincomplete, interrupted: 0 of 2 lemmas held, 0 cases; 1 not checked\n"),
        (true, "\"interrupted\":true,\"verdict\":\"not-known\",\"holds\":false}\n"),
    ] {
        let checked = [(&endless, CheckedLemma::new(&endless, &AtOnce).unwrap())];
        assert!(checked[0].1.interrupted);
        let arguments = ProofsArguments {
            run: Vec::new(),
            choices: None,
            engine: Engine::Exhaustive,
            json,
            ci: CiOptions::default(),
        };
        let mut out = Vec::new();
        assert_eq!(arguments.print_end(2, &checked, &mut out).unwrap(), Outcome::Incomplete);
        let text = String::from_utf8(out).unwrap();
        assert!(text.ends_with(end), "{text}");
    }
}

#[test]
fn a_theorem_is_listed() {
    let (outcome, text) = run(&[true_lemma("low", 4)], "");
    assert_eq!(outcome.unwrap(), Outcome::Holds);
    let entry = "\nround\n  It turns.\n  paper       2.2\n  file        proofs/coq/Theorems.v\n  \
                 Coq         every world\n\n";
    assert!(text.contains(entry), "{text}");
    let last = "\n1 lemma, 4 cases within bounds; 1 theorem for every world\n";
    assert!(text.ends_with(last), "{text}");
}
