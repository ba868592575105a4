//! `toposlam proofs`: the list, a check, a single case. Nothing here depends on the lemmas and theorems
//! that exist. The report on a lemma that fails is tested beside the verb.

use serde_json::{Value, json};
use toposlam_model::format::world_file;
use toposlam_proofs::{Exhibit, Lemma, lemmas, replay::ChoicesError, theorems};

use super::{Scratch, flat, has, stderr};
use crate::repository;

/// The first case of a lemma that shows a world and a walk in it.
fn case_with_a_walk() -> (&'static Lemma, Vec<u8>) {
    let first_case = |lemma: &'static Lemma| {
        let mut choices = Vec::new();
        loop {
            match lemma.replay(&choices) {
                Err(ChoicesError::Length { needed, .. }) => choices.resize(needed, 0),
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
fn every_lemma_is_listed_with_its_place_and_its_engines_and_can_be_checked() {
    let scratch = Scratch::new("proofs_list");
    let lines = scratch.lines("proofs", 0);
    let lemmas = lemmas::all().map(|lemma| {
        json!({
            "lemma": lemma.name, "sentence": lemma.sentence, "exhaustive.cases": lemma.exhaustive.cases,
            "sampled.bound": lemma.sampled.map(|sampled| sampled.bound),
            "kani.harness": lemma.kani.map(|kani| kani.harness),
        })
    });
    let theorems = theorems::all().map(|theorem| {
        json!({
            "theorem": theorem.name, "sentence": theorem.sentence, "paper": theorem.paper,
            "coq.bound": "every world",
        })
    });
    let cases: u64 = lemmas::all().map(|lemma| lemma.exhaustive.cases).sum();
    let totals = json!({
        "lemmas": lemmas::all().count(), "theorems": theorems::all().count(), "cases": cases,
    });
    let expected: Vec<_> = lemmas.chain(theorems).chain([totals]).collect();
    has(&lines.clone().into(), &expected.into(), "proofs");
    let text = flat(&scratch.out("proofs", 0));
    for line in &lines[..lines.len() - 1] {
        assert!(repository(line["file"].as_str().unwrap()).exists(), "{line}");
        let name = line.get("lemma").or(line.get("theorem"));
        for part in [name, line.get("sentence"), line.get("paper"), line.get("file")] {
            assert!(text.contains(part.unwrap().as_str().unwrap()), "{line}");
        }
    }
    // The two lemmas with the fewest cases.
    let mut quick: Vec<_> = lemmas::all().collect();
    quick.sort_by_key(|lemma| lemma.exhaustive.cases);
    let run = format!("proofs --run {} --run {}", quick[0].name, quick[1].name);
    let [one, two] = [0, 1].map(|place: usize| {
        let Lemma { name, exhaustive, .. } = quick[place];
        json!({ "lemma": name, "holds": true, "cases": exhaustive.cases, "choices": null })
    });
    scratch.fact(&run, 0, &json!([one, two, { "lemmas": 2, "held": 2, "holds": true }]));
    facts! { scratch; "proofs --run the_moon_is_round" => 2 "--run: there is no lemma `the_moon_is_round`"; }
}

#[test]
fn the_other_verbs_read_the_world_of_a_case() {
    let scratch = Scratch::new("proofs_case");
    let (lemma, choices) = case_with_a_walk();
    let case = format!("proofs --run {} --choices {}", lemma.name, choices_text(&choices));
    let text = scratch.out(&case, 0);
    let (_, below) = text.split_once(" `toposlam explore`:\n\n").unwrap();
    let length = below.lines().position(|line| line.starts_with("facing = ")).unwrap() + 1;
    let world: String = below.split_inclusive('\n').take(length).collect();
    scratch.write("case.toml", &world);
    let fields =
        json!({ "lemma": lemma.name, "holds": true, "choices": choices, "verdict": "holds" });
    facts! { scratch; "explore case.toml" => 0 { "isomorphic": true }; case => 0 (fields); }
    let line = scratch.last(&case, 0);
    let from_json = world_file::read(line["worlds"][0].to_string().as_bytes()).unwrap();
    assert_eq!(from_json, world_file::read(world.as_bytes()).unwrap());
    let walk = &line["walks"][0];
    let [poses, percepts] = ["poses", "percepts"].map(|key| walk[key].as_array().unwrap().len());
    assert!(poses == percepts && walk["doors"].is_array(), "{walk}");
    // The case in the help exists.
    let help = scratch.out("proofs --help", 0);
    let mut examples = help.lines().filter_map(|line| line.strip_prefix("  toposlam "));
    let case = examples.find(|line| line.contains("--choices")).unwrap();
    scratch.fact(case, 0, &json!({ "holds": true }));
}

#[test]
fn choices_that_make_no_case_are_an_error_and_a_sampled_case_has_its_own_bound() {
    let scratch = Scratch::new("proofs_choices");
    let (Lemma { name, .. }, choices) = case_with_a_walk();
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
        let line = format!("proofs --run {name} --choices {}", choices_text(&choices));
        scratch.fact(&line, 2, &Value::from(format!("--choices: {name}: {cause}")));
    }
    let sampled = |lemma: &Lemma, choices: &[u8]| {
        let choices = format!("--engine sampled --choices {}", choices_text(choices));
        scratch.run(&format!("proofs --run {} {choices}", lemma.name))
    };
    for lemma in lemmas::all() {
        let message = stderr(&sampled(lemma, &[]));
        match lemma.sampled {
            None => assert!(message.ends_with(&format!("{} is not sampled\n", lemma.name))),
            Some(_) => assert!(message.contains("begins so has at least") || message.is_empty()),
        }
    }
    let lemma = lemmas::all().find(|lemma| lemma.sampled.is_some()).unwrap();
    let mut choices = Vec::new();
    while sampled(lemma, &choices).status.code() == Some(2) {
        choices.push(0);
        assert!(choices.len() < 1000);
    }
}
