//! `toposlam proofs`: the list, a check, a single case. Nothing here depends on the lemmas and theorems
//! that exist. The report on a lemma that fails is tested beside the verb.

use std::fs;

use serde_json::json;
use toposlam_model::format::world_file;
use toposlam_proofs::{Exhibit, Lemma, lemmas, replay::ChoicesError, theorems};

use super::{Scratch, has, stderr, stdout};

/// The first case of a lemma that shows a world and a walk in it.
fn case_with_a_walk() -> (&'static Lemma, Vec<u8>) {
    let first_case = |lemma: &'static Lemma| {
        let mut choices = Vec::new();
        loop {
            match lemma.replay(&choices) {
                Err(ChoicesError::TooFew { needed, .. }) => choices.resize(needed, 0),
                shown => return (lemma, choices, shown.unwrap()),
            }
        }
    };
    let (lemma, choices, _) = lemmas::all()
        .map(first_case)
        .find(|(_, _, shown)| {
            let is_walk = |exhibit: &Exhibit| matches!(exhibit, Exhibit::Walk { .. });
            let is_world = |exhibit: &Exhibit| matches!(exhibit, Exhibit::World { .. });
            shown.case.is_ok()
                && shown.exhibits.first().is_some_and(is_world)
                && shown.exhibits.iter().any(is_walk)
        })
        .unwrap();
    (lemma, choices)
}

fn choices_text(choices: &[u8]) -> String {
    choices.iter().map(u8::to_string).collect::<Vec<_>>().join(",")
}

#[test]
fn every_lemma_is_listed_with_its_place_and_its_engines() {
    let scratch = Scratch::new("proofs_list");
    let mut lines = scratch.lines("proofs", 0);
    let totals = lines.pop().unwrap();
    let (lines, proved): (Vec<_>, Vec<_>) =
        lines.into_iter().partition(|line| line.get("lemma").is_some());
    // Without line breaks.
    let text = scratch.out("proofs", 0).split_whitespace().collect::<Vec<_>>().join(" ");
    for (line, lemma) in lines.iter().zip(lemmas::all()) {
        has(
            line,
            &json!({
                "lemma": lemma.name,
                "exhaustive.cases": lemma.exhaustive.cases,
                "sampled.bound": lemma.sampled.map(|sampled| sampled.bound),
                "kani.harness": lemma.kani.map(|kani| kani.harness),
            }),
            lemma.name,
        );
        for part in ["lemma", "sentence", "paper", "file"].map(|key| line[key].as_str().unwrap()) {
            assert!(text.contains(part), "{part}");
        }
        assert!(fs::exists(line["file"].as_str().unwrap()).unwrap(), "{line}");
    }
    for (line, theorem) in proved.iter().zip(theorems::all()) {
        let (name, sentence, paper) = (theorem.name, theorem.sentence, theorem.paper);
        has(
            line,
            &json!({
                "theorem": name, "sentence": sentence, "paper": paper, "coq.bound": "every world",
            }),
            name,
        );
        let file = theorems::FILE;
        let entry = format!("{name} {sentence} paper {paper} file {file} Coq every world ");
        assert!(text.contains(&entry), "{entry}");
        assert!(fs::exists(line["file"].as_str().unwrap()).unwrap(), "{line}");
    }
    let cases: u64 = lines.iter().map(|line| line["exhaustive"]["cases"].as_u64().unwrap()).sum();
    assert_eq!((lines.len(), proved.len()), (lemmas::all().count(), theorems::all().count()));
    has(
        &totals,
        &json!({
            "lemmas": lines.len(), "theorems": proved.len(), "cases": cases,
        }),
        "proofs",
    );
}

#[test]
fn a_lemma_is_checked_in_every_case() {
    let scratch = Scratch::new("proofs_check");
    // The two lemmas with the fewest cases.
    let mut quick: Vec<_> = lemmas::all().collect();
    quick.sort_by_key(|lemma| lemma.exhaustive.cases);
    let [one, two] = [quick[0], quick[1]].map(|lemma| (lemma.name, lemma.exhaustive.cases));
    let run = format!("proofs --run {} --run {}", one.0, two.0);
    let [one, two] = [one, two].map(
        |(name, cases)| json!({ "lemma": name, "holds": true, "cases": cases, "choices": null }),
    );
    scratch.facts(&[(&run, 0, json!([one, two, { "lemmas": 2, "held": 2, "holds": true }]))]);
    let text = scratch.out(&format!("proofs --run {}", quick[0].name), 0);
    let row = text.lines().next().unwrap();
    assert!(row.starts_with(quick[0].name) && row.ends_with(" s  holds"), "{text}");
    let names: Vec<_> = lemmas::all().map(|lemma| lemma.name).collect();
    let cause = "--run: there is no lemma `the_moon_is_round`; there are:";
    let message = format!("error: {cause}\n  {}\n", names.join("\n  "));
    assert_eq!(scratch.error("proofs --run the_moon_is_round"), message);
}

#[test]
fn the_other_verbs_read_the_world_of_a_case() {
    let scratch = Scratch::new("proofs_case");
    let (lemma, choices) = case_with_a_walk();
    let case = format!("proofs --run {} --choices {}", lemma.name, choices_text(&choices));
    let text = scratch.out(&case, 0);
    let joined = text.replace(" \\\n", " ").split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(joined.contains(&format!(" again: toposlam {case} ")), "{text}");
    assert!(text.contains("\n  door   robot at  perceives\n  start  v"), "{text}");
    assert_eq!(text, scratch.out(&case, 0));

    let (_, below) = text.split_once(" `toposlam explore`:\n\n").unwrap();
    let length = below.lines().position(|line| line.starts_with("facing = ")).unwrap() + 1;
    let world: String = below.split_inclusive('\n').take(length).collect();
    scratch.write("case.toml", &world);
    scratch.facts(&[("explore case.toml", 0, json!({ "isomorphic": true }))]);
    assert!(scratch.out("draw case.toml", 0).starts_with("<svg"));

    let line = scratch.last(&case, 0);
    has(
        &line,
        &json!({
            "lemma": lemma.name, "holds": true, "choices": choices, "verdict": "holds",
        }),
        &case,
    );
    let from_json = world_file::read(line["worlds"][0].to_string().as_bytes()).unwrap();
    assert_eq!(from_json, world_file::read(world.as_bytes()).unwrap());
    let walk = &line["walks"][0];
    let [poses, percepts] = ["poses", "percepts"].map(|key| walk[key].as_array().unwrap().len());
    assert!(poses == percepts && walk["doors"].is_array(), "{walk}");
}

#[test]
fn choices_that_make_no_case_are_an_error() {
    let scratch = Scratch::new("proofs_choices");
    let (lemma, choices) = case_with_a_walk();
    let length = choices.len();
    for (choices, cause) in [
        (
            choices[1..].to_vec(),
            format!("a case that begins so has at least {length} choices, not {}\n", length - 1),
        ),
        (
            [&choices[..], &[0]].concat(),
            format!("the case that begins so has {length} choices, not {}\n", length + 1),
        ),
        ([&[255], &choices[1..]].concat(), "choice number 1 is 255; it is at most ".to_owned()),
    ] {
        let name = lemma.name;
        let message =
            scratch.error(&format!("proofs --run {name} --choices {}", choices_text(&choices)));
        assert!(message.starts_with(&format!("error: --choices: {name}: {cause}")), "{message}");
    }
}

#[test]
fn a_sampled_case_has_its_own_bound() {
    let scratch = Scratch::new("proofs_sampled");
    let sampled = |choices: &str, lemma: &Lemma| {
        let choices = format!("--choices {choices}");
        scratch.run(&format!("proofs --run {} --engine sampled {choices}", lemma.name))
    };
    for lemma in lemmas::all() {
        let message = stderr(&sampled("", lemma));
        match lemma.sampled {
            None => assert!(message.ends_with(&format!("{} is not sampled\n", lemma.name))),
            Some(_) => assert!(message.contains("begins so has at least") || message.is_empty()),
        }
    }
    let lemma = lemmas::all().find(|lemma| lemma.sampled.is_some()).unwrap();
    let mut choices = Vec::new();
    let text = loop {
        let output = sampled(&choices_text(&choices), lemma);
        if output.status.code() != Some(2) {
            break stdout(&output);
        }
        choices.push(0);
    };
    let again = format!(" again: toposlam proofs --run {} --engine sampled --choices ", lemma.name);
    let joined = text.replace(" \\\n", " ").split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(joined.contains(&format!("{again}{} ", choices_text(&choices))), "{text}");
}
