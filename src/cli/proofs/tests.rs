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
    CaseReplay, CaseResult, ChoiceOdometer, Choose, Exhibit, Stop,
    choose::{claim, given},
    draw,
    lemma::Exhaustive,
};

use super::*;

/// Runs the verb on these lemmas.
fn run(lemmas: &[Lemma], arguments: &[&str]) -> (Result<Outcome, CliError>, String) {
    let command = ProofsArguments::augment_args(clap::Command::new("proofs").no_binary_name(true));
    let matches = command.try_get_matches_from(arguments).unwrap();
    let arguments = ProofsArguments::from_arg_matches(&matches).unwrap();
    let mut out = Vec::new();
    let theorems = [Theorem { name: "round", sentence: "It turns.".into(), paper: "2.2".into() }];
    let outcome = arguments.run_with(&lemmas.iter().collect::<Vec<_>>(), &theorems, &mut out);
    (outcome, String::from_utf8(out).unwrap())
}

fn objects(text: &str) -> Vec<Value> {
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

fn true_lemma() -> Lemma {
    lemma("low", 4, numbers_are_low, numbers_are_low)
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

violated: ";

#[test]
fn a_lemma_that_fails_prints_the_case_and_the_command_that_repeats_it() {
    let lemmas = [true_lemma(), false_lemma()];
    let (outcome, text) = run(&lemmas, &["--run", "all"]);
    assert_eq!(outcome.unwrap(), Outcome::Violated);
    let rows: Vec<_> = text.lines().take(2).collect();
    assert!(rows[0].starts_with("low    4 cases  ") && rows[0].ends_with(" s  holds"), "{text}");
    assert!(rows[1].starts_with("entry   1 case  ") && rows[1].ends_with(" s  fails"), "{text}");
    let (_, failed) = text.split_at(rows[0].len() + rows[1].len() + 2);
    assert_eq!(failed, format!("{FAILED}1 of 2 lemmas hold, 4 cases\n"));
    // The printed command.
    let again = text.lines().find_map(|line| line.strip_prefix("  again: toposlam proofs "));
    let (outcome, text) = run(&lemmas, &again.unwrap().split(' ').collect::<Vec<_>>());
    assert_eq!(outcome.unwrap(), Outcome::Violated);
    assert_eq!(text, format!("{}the lemma fails in this case\n", &FAILED[1..]));
}

#[test]
fn the_json_contains_the_same() {
    let lemmas = [false_lemma(), true_lemma()];
    let (outcome, text) = run(&lemmas, &["--run", "all", "--json", "--keep-going"]);
    assert_eq!(outcome.unwrap(), Outcome::Violated);
    let lines = objects(&text);
    let [failed, held, totals] = lines.as_slice() else { panic!("{text}") };
    assert_eq!((&failed["lemma"], &failed["holds"]), (&json!("entry"), &json!(false)));
    assert_eq!((&failed["cases"], &failed["choices"]), (&json!(1), &json!([0, 1, 0, 0, 0])));
    assert_eq!(failed["claim"], "the robot has come in by the facing dart");
    let world = world_file::read(failed["worlds"][0].to_string().as_bytes()).unwrap();
    assert_eq!((world.graph.edge_count(), world.start), (1, Some(Dart(0))));
    let seen = |door: u32| json!({ "degree": 2, "sighting": format!("marker along door {door}") });
    let walk = json!([{
        "world": 0,
            "marker": "directional", "doors": [0], "poses": ["v0:0", "v0:1"], "percepts": [seen(0), seen(1)],
        "stopped": null,
    }]);
    assert_eq!(failed["walks"], walk);
    assert_eq!(failed["values"], json!([{ "name": "undirected", "value": "marker" }]));
    assert_eq!(
        (&held["cases"], &held["holds"], &held["choices"]),
        (&4.into(), &true.into(), &Value::Null)
    );
    assert!(held["seconds"].is_f64() && held.get("worlds").is_none(), "{held}");
    assert_eq!(
        (&totals["lemmas"], &totals["held"], &totals["cases"]),
        (&2.into(), &1.into(), &4.into())
    );
    assert_eq!((&totals["schema"], &totals["holds"]), (&1.into(), &false.into()));

    let choices = ["--run", "entry", "--choices", "0,1,0,0,0", "--json"];
    let (outcome, text) = run(&lemmas, &choices);
    assert_eq!(outcome.unwrap(), Outcome::Violated);
    let [again] = objects(&text).try_into().unwrap();
    for key in ["lemma", "holds", "choices", "claim", "worlds", "walks", "values"] {
        assert_eq!(again[key], failed[key], "{key}");
    }
    assert_eq!((&again["engine"], &again["verdict"]), (&"exhaustive".into(), &"fails".into()));
}

#[test]
fn the_lemmas_after_one_that_fails_are_checked_if_the_check_is_to_keep_going() {
    let lemmas = [false_lemma(), true_lemma()];
    let (outcome, text) = run(&lemmas, &["--run", "all"]);
    assert_eq!(outcome.unwrap(), Outcome::Violated);
    assert!(!text.contains("low"), "{text}");
    let verdict =
        "violated: 0 of 2 lemmas hold, 0 cases; 1 not checked (--keep-going checks them)\n";
    assert!(text.ends_with(verdict), "{text}");
    let (_, text) = run(&lemmas, &["--run", "all", "--json"]);
    assert_eq!(objects(&text).last().unwrap()["not_checked"], 1);
    let (outcome, text) = run(&lemmas, &["--run", "all", "--keep-going"]);
    assert_eq!(outcome.unwrap(), Outcome::Violated);
    assert!(text.ends_with("violated: 1 of 2 lemmas hold, 4 cases\n"), "{text}");
}

#[test]
fn a_case_holds_or_fails_or_is_excluded() {
    let lemmas = [true_lemma()];
    for (choices, expected, verdict) in [
        ("3", Outcome::Holds, "holds: the lemma holds in this case"),
        ("4", Outcome::Incomplete, "incomplete: the lemma excludes this case"),
    ] {
        let (outcome, text) = run(&lemmas, &["--run", "low", "--choices", choices]);
        assert_eq!(outcome.unwrap(), expected);
        assert!(text.ends_with(&format!("\n\n{verdict}\n")), "{text}");
        let json = ["--run", "low", "--choices", choices, "--json"];
        let [line] = objects(&run(&lemmas, &json).1).try_into().unwrap();
        assert_eq!((&line["worlds"], &line["claim"]), (&json!([]), &Value::Null));
        assert_eq!(line["holds"], expected == Outcome::Holds);
    }
}

#[test]
fn a_lemma_with_another_number_of_cases_than_expected_fails() {
    for (pinned, cause) in
        [(5, "expected 5 cases within its bound, found 4 cases"), (1, "found 4 cases")]
    {
        let lemmas = [lemma("low", pinned, numbers_are_low, numbers_are_low)];
        let (outcome, text) = run(&lemmas, &["--run", "low"]);
        assert_eq!(outcome.unwrap(), Outcome::Violated);
        assert!(text.contains(" s  fails\n\nlow\n  It is so.\n  fails: expected "), "{text}");
        assert!(text.contains(cause), "{text}");
        assert!(text.ends_with("\n\nviolated: 0 of 1 lemma holds, 0 cases\n"), "{text}");
        let (_, text) = run(&lemmas, &["--run", "low", "--json"]);
        let line = &objects(&text)[0];
        assert_eq!((&line["cases"], &line["pinned"]), (&4.into(), &pinned.into()));
        assert_eq!((&line["holds"], &line["choices"]), (&false.into(), &Value::Null));
    }
}

#[test]
fn a_lemma_without_a_case_does_not_hold_nor_does_a_check_without_a_lemma() {
    fn excluded<C>(_: &mut C) -> CaseResult {
        Err(Stop::Excluded)
    }
    let (outcome, text) = run(&[lemma("none", 0, excluded, excluded)], &["--run", "none"]);
    assert_eq!(outcome.unwrap(), Outcome::Violated, "{text}");
    let (outcome, text) = run(&[], &["--run", "all"]);
    assert_eq!(outcome.unwrap(), Outcome::Incomplete);
    assert_eq!(text, "\nincomplete: there is nothing to check\n");
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
    let (outcome, text) = run(&lemmas, &["--run", "two", "--choices", "0,0,0,0,0"]);
    assert_eq!(outcome.unwrap(), Outcome::Holds);
    let heads: Vec<_> =
        text.lines().filter(|line| line.contains("orld ") && line.ends_with(':')).collect();
    let world = |n| format!("World {n}, as a file for `toposlam draw` and `toposlam explore`:");
    let walk = |n| format!("A walk in world {n}, marker undirected:");
    assert_eq!(heads, [world(1), walk(1), world(2), walk(2)]);
    assert!(text.contains("\nwalk: from dart 0 by the doors 7\n"), "{text}");
    assert!(text.contains("\nwalk: from dart 9 by the doors 0\n"), "{text}");
    assert!(text.contains("name = \"case-1\"") && text.contains("name = \"case-2\""), "{text}");
    let stopped = "  stopped: door 2 was taken at a vertex with 2 doors\n";
    assert!(text.contains(stopped), "{text}");
}

#[test]
fn the_command_of_a_case_without_choices_works_in_a_shell() {
    fn never<C>(_: &mut C) -> CaseResult {
        claim("one is two", false)
    }
    let lemmas = [lemma("never", 1, never, never)];
    let (_, text) = run(&lemmas, &["--run", "never"]);
    assert!(text.contains("\n  again: toposlam proofs --run never --choices ''\n"), "{text}");
    let (outcome, _) = run(&lemmas, &["--run", "never", "--choices", ""]);
    assert_eq!(outcome.unwrap(), Outcome::Violated);
}

#[test]
fn a_failure_that_is_not_repeatable_is_reported() {
    fn fails<C>(_: &mut C) -> CaseResult {
        claim("one is two", false)
    }
    fn holds<C>(_: &mut C) -> CaseResult {
        claim("one is one", true)
    }
    let (outcome, text) = run(&[lemma("moody", 1, fails, holds)], &["--run", "moody"]);
    assert_eq!(outcome.unwrap(), Outcome::Violated);
    assert!(
        text.contains("\nThe failure is not repeatable: the same choices give another result.\n"),
        "{text}"
    );
}

#[test]
fn a_unique_part_of_a_name_is_enough() {
    let named = |name| lemma(name, 4, numbers_are_low, numbers_are_low);
    let lemmas = ["low", "lowest", "high"].map(named);
    for (part, name) in [("low", "low"), ("lowe", "lowest"), ("hi", "high")] {
        let (outcome, text) = run(&lemmas, &["--run", part, "--run", name, "--json"]);
        assert_eq!(outcome.unwrap(), Outcome::Holds);
        let lines = objects(&text);
        assert_eq!((lines.len(), &lines[0]["lemma"]), (2, &name.into()));
    }
    for (part, cause) in [
        ("lo", "`lo` is part of several names:\n  low\n  lowest"),
        ("law", "there is no lemma `law`; there are:\n  low\n  lowest\n  high"),
    ] {
        let (Err(CliError::Input(message)), text) = run(&lemmas, &["--run", part]) else {
            panic!()
        };
        assert_eq!((message, text), (format!("--run: {cause}"), String::new()));
    }
    let sampled = ["--run", "high", "--choices", "0", "--engine", "sampled"];
    let (Err(CliError::Input(message)), _) = run(&lemmas, &sampled) else { panic!() };
    assert_eq!(message, "--engine: high is not sampled");
}

#[test]
fn a_lemma_that_panics_fails_in_that_case() {
    fn panics<C: Choose>(choose: &mut C) -> CaseResult {
        let number = choose.below(4);
        assert!(number < 2, "a lemma of a test does this");
        claim("it is below 2", number < 2)
    }
    let (outcome, text) = run(&[lemma("wild", 1, panics, panics)], &["--run", "wild"]);
    assert_eq!(outcome.unwrap(), Outcome::Violated);
    let fails = "  fails: it is not true that the code does not panic\n  \
                 again: toposlam proofs --run wild --choices 2\n";
    assert!(text.contains(fails), "{text}");
}

#[test]
fn an_interrupt_does_not_wait_for_the_case() {
    struct QuestionLimit;
    impl Watch for QuestionLimit {
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
    let interrupted = check_lemma(&endless, &QuestionLimit).unwrap();
    assert!(matches!(interrupted.end, CheckEnd::Interrupted { cases: 0 }));
    for (json, end) in [
        (false, "\nincomplete, interrupted: 0 of 1 lemma holds, 0 cases\n"),
        (true, "\"interrupted\":true,\"verdict\":\"not-known\",\"holds\":false}\n"),
    ] {
        let mut out = Vec::new();
        let mut report = ProofsReport::new(&mut out, json, &[&endless]);
        report.lemma(&endless, check_lemma(&endless, &QuestionLimit).unwrap()).unwrap();
        assert_eq!(report.verdict().unwrap(), Outcome::Incomplete);
        let text = String::from_utf8(out).unwrap();
        assert!(text.ends_with(end) && text.contains("interrupted"), "{text}");
    }
}

#[test]
fn a_theorem_is_listed_but_not_checked() {
    let (outcome, text) = run(&[true_lemma()], &[]);
    assert_eq!(outcome.unwrap(), Outcome::Holds);
    let entry = "\nround\n  It turns.\n  paper       2.2\n  file        proofs/coq/Theorems.v\n  \
                 Coq         every world\n\n";
    assert!(text.contains(entry), "{text}");
    let last = "\n1 lemma, 4 cases within bounds; 1 theorem for every world\n";
    assert!(text.ends_with(last), "{text}");
    for also in [&["--run", "round"][..], &["--run", "all", "--run", "round"]] {
        let (Err(CliError::Input(message)), text) = run(&[true_lemma()], also) else { panic!() };
        let how = "is proved in Coq, for every world; run proofs/coq/check to check it";
        assert_eq!((message, text), (format!("--run: round {how}"), String::new()));
    }
    let (outcome, text) = run(&[true_lemma()], &["--run", "all", "--json"]);
    assert_eq!(outcome.unwrap(), Outcome::Holds);
    assert_eq!(objects(&text).len(), 2);
}
