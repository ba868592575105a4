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
    CaseReplay, CaseResult, ChoiceOdometer, Choose, Exhibit, Stop, Theorem,
    choose::{claim, given},
    draw,
    lemma::{Exhaustive, Sampled},
};

use super::*;

fn arguments(line: &str) -> ProofsArguments {
    let command = ProofsArguments::augment_args(clap::Command::new("proofs").no_binary_name(true));
    let matches = command.try_get_matches_from(line.split_whitespace()).unwrap();
    ProofsArguments::from_arg_matches(&matches).unwrap()
}

/// Runs the verb on these lemmas.
fn run(lemmas: &[Lemma], line: &str) -> (Result<Outcome, CliError>, String) {
    let mut out = Vec::new();
    let theorems = [Theorem::new("round", "It turns.".into(), "2.2".into())];
    let all = Statements { lemmas: lemmas.iter().collect(), theorems: theorems.to_vec() };
    let outcome = arguments(line).run_with(&all, &mut out);
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
    let (_, case) = text.split_once("\n\n").unwrap();
    assert_eq!(case, format!("{}\nviolated: 1 of 2 lemmas held, 4 cases\n", &FAILED[1..]));
    let again = text.lines().find_map(|line| line.strip_prefix("  again: toposlam proofs "));
    let (outcome, text) = run(&lemmas, again.unwrap());
    assert_eq!((outcome.unwrap(), text.as_str()), (Outcome::Violated, &FAILED[1..]));

    let seen = |door: u32| json!({ "degree": 2, "sighting": format!("marker along door {door}") });
    let claim = "the robot has come in by the facing dart";
    let mut lines = objects(&lemmas, "--run all", Outcome::Violated);
    for line in &mut lines {
        line.as_object_mut().unwrap().remove("seconds");
    }
    let world = lines[2]["worlds"][0].take();
    let world = world_file::read(world.to_string().as_bytes()).unwrap();
    assert_eq!((world.graph.edge_count(), world.start), (1, Some(Dart(0))));
    let expected = json!([
        {
            "schema": 1, "kind": "check", "lemma": "entry", "cases": 1, "verdict": "violated",
            "holds": false, "choices": [0, 1, 0, 0, 0], "claim": claim, "interrupted": false,
        },
        {
            "schema": 1, "kind": "check", "lemma": "low", "cases": 4, "verdict": "holds", "holds": true,
            "choices": null, "interrupted": false,
        },
        {
            "schema": 1, "kind": "case", "lemma": "entry", "engine": "exhaustive",
            "choices": [0, 1, 0, 0, 0], "verdict": "fails", "holds": false, "claim": claim,
            "worlds": [null],
            "walks": [{
                "world": 0, "marker": "directional", "doors": [0], "poses": ["v0:0", "v0:1"],
                "percepts": [seen(0), seen(1)], "stopped": null,
            }],
            "values": [{ "name": "undirected", "value": "marker" }],
        },
        {
            "schema": 1, "kind": "checks", "lemmas": 2, "held": 1, "not_checked": 0, "cases": 4,
            "interrupted": false, "verdict": "violated", "holds": false,
        },
    ]);
    assert_eq!(Value::from(lines), expected);
}

/// What a lemma has of a verdict: the outcome of a run, and parts of what it prints.
#[test]
fn lemmas_and_cases_have_verdicts() {
    fn excluded<C>(_: &mut C) -> CaseResult {
        Err(Stop::Excluded)
    }
    fn never<C>(_: &mut C) -> CaseResult {
        claim("one is two", false)
    }
    fn panics<C: Choose>(choose: &mut C) -> CaseResult {
        let number = choose.below(4);
        assert!(number < 2, "a lemma of a test does this");
        claim("it is below 2", number < 2)
    }
    let again = "  again: toposlam proofs --run";
    let lemmas = [
        true_lemma("low", 4),
        true_lemma("more", 1),
        true_lemma("fewer", 5),
        lemma("none", 0, excluded, excluded),
        lemma("never", 1, never, never),
        lemma("wild", 1, panics, panics),
    ];
    for (line, expected, parts) in [
        ("low --choices 3", Outcome::Holds, ["holds: the lemma holds in this case\n", ""]),
        (
            "low --choices 4",
            Outcome::Incomplete,
            ["\n\nincomplete: the lemma excludes this case\n", ""],
        ),
        // Another number of cases than expected, also none.
        (
            "more",
            Outcome::Violated,
            [
                " s  fails\n\nmore\n  It is so.\n  fails: expected 1 case ",
                " bound, found 4 cases\n",
            ],
        ),
        (
            "fewer",
            Outcome::Violated,
            [
                "  fails: expected 5 cases within its bound, found 4 cases\n",
                "\n\nviolated: 0 of 1 lemma held, 0 cases\n",
            ],
        ),
        ("none", Outcome::Violated, ["  fails: expected 0 cases within its bound", ""]),
        // A case without choices, and one in which the lemma panics.
        (
            "never",
            Outcome::Violated,
            ["  fails: it is not true that one is two\n", &format!("{again} never --choices\n")],
        ),
        (
            "wild",
            Outcome::Violated,
            [
                "  fails: it is not true that the code does not panic\n",
                &format!("{again} wild --choices 2\n"),
            ],
        ),
        ("never --choices", Outcome::Violated, ["violated: the lemma fails in this case\n", ""]),
        ("wild --choices 2", Outcome::Violated, ["violated: the lemma fails in this case\n", ""]),
    ] {
        let (outcome, text) = run(&lemmas, &format!("--run {line}"));
        assert_eq!(outcome.unwrap(), expected, "{line}: {text}");
        assert!(parts.iter().all(|part| text.contains(part)), "{line}: {text}");
    }
    let line = &objects(&lemmas, "--run fewer", Outcome::Violated)[0];
    assert_eq!((&line["cases"], &line["pinned"]), (&4.into(), &5.into()));
    assert_eq!((&line["holds"], &line["choices"]), (&false.into(), &Value::Null));
}

/// Each walk goes as far as possible.
#[test]
fn several_worlds_are_numbered() {
    fn two_worlds<C: Choose>(choose: &mut C) -> CaseResult {
        for (world, edges) in [(0, 1), (1, 2)] {
            draw::start::<2>(choose, edges)?;
            let (marker, pose, doors) = (&Undirected, Dart(0), vec![Door(2)]);
            choose.show(|| Exhibit::Walk { world, marker: *marker, pose, doors });
        }
        Ok(())
    }
    let lemmas = [lemma("two", 20, two_worlds, two_worlds)];
    let (outcome, text) = run(&lemmas, "--run two --choices 0,0,0,0,0");
    assert_eq!(outcome.unwrap(), Outcome::Holds);
    for part in [
        "\nWorld 1, as a file for `toposlam draw` and `toposlam explore`:\n\nname = \"case-1\"\n",
        "\nA walk in world 1, marker undirected:\n",
        "\nWorld 2, as a file for `toposlam draw` and `toposlam explore`:\n\nname = \"case-2\"\n",
        "\nA walk in world 2, marker undirected:\n",
        "  stopped: door 2 was taken at a vertex with 1 door\n",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
}

/// Of two engines with these choices it is the one in which the lemma fails.
#[test]
fn a_case_is_of_the_engine_whose_bound_has_it() {
    fn above<C: Choose>(choose: &mut C) -> CaseResult {
        let number = choose.below(9);
        claim("it is not 1 or 7", number != 1 && number != 7)
    }
    let mut low = true_lemma("low", 4);
    low.sampled = Some(Sampled { bound: "up to 8", body: above, replay: above });
    for (choice, engine, outcome) in [
        (1, "sampled", Outcome::Violated),
        (2, "exhaustive", Outcome::Holds),
        (7, "sampled", Outcome::Violated),
        (8, "sampled", Outcome::Holds),
    ] {
        let line = &objects(&[low], &format!("--run low --choices {choice}"), outcome)[0];
        assert_eq!(line["engine"], engine, "{choice}");
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
        ("--run all --run round", &format!("--run: {proved}")),
    ] {
        let (Err(CliError::Input(message)), text) = run(&lemmas, line) else { panic!() };
        assert_eq!((message.as_str(), text), (cause, String::new()));
    }
}

#[test]
fn a_check_can_be_stopped() {
    struct AtOnce;
    impl Watch for AtOnce {
        fn stop(&self) -> bool {
            true
        }
    }
    #[expect(clippy::unnecessary_wraps, reason = "the type of a lemma")]
    fn many<C: Choose>(choose: &mut C) -> CaseResult {
        let _ = [255, 255, 2].map(|number| choose.below(number));
        Ok(())
    }
    let many = lemma("many", 130_050, many, many);
    for (options, end) in [
        ("", "\nincomplete, interrupted: 0 of 2 lemmas held, 65,536 cases; 1 not checked\n"),
        ("--json", "\"interrupted\":true,\"verdict\":\"not-known\",\"holds\":false}\n"),
    ] {
        let mut out = Vec::new();
        let mut report = Report { text: &mut out, json: &mut io::sink() };
        if options == "--json" {
            mem::swap(&mut report.text, &mut report.json);
        }
        let outcome = report.totals(&CheckTotals::new(2, &[many.check(&AtOnce)]));
        assert_eq!(outcome.unwrap(), Outcome::Incomplete);
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
