//! `toposlam proofs`: the list, a check, a single case. Nothing here depends on the lemmas and theorems
//! that exist. The report on a lemma that fails is tested beside the verb.

use serde_json::json;
use toposlam_model::format::world_file;
use toposlam_proofs::{Lemma, lemmas, theorems};

use super::{Scratch, flat, has};
use crate::repository;

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

/// The case in the help.
#[test]
fn the_other_verbs_read_the_world_of_a_case_and_choices_that_make_none_are_an_error() {
    let scratch = Scratch::new("proofs_case");
    let help = scratch.out("proofs --help", 0);
    let mut examples = help.lines().filter_map(|line| line.strip_prefix("  toposlam "));
    let case = examples.find(|line| line.contains("--choices")).unwrap();
    let text = scratch.out(case, 0);
    let (_, below) = text.split_once(" `toposlam explore`:\n\n").unwrap();
    let length = below.lines().position(|line| line.starts_with("facing = ")).unwrap() + 1;
    let world: String = below.split_inclusive('\n').take(length).collect();
    scratch.write("case.toml", &world);
    facts! { scratch;
        "explore case.toml" => 0 { "isomorphic": true };
        case => 0 { "holds": true, "verdict": "holds", "walks.0.poses.#": 4, "walks.0.percepts.#": 4 };
    }
    let line = scratch.last(case, 0);
    let from_json = world_file::read(line["worlds"][0].to_string().as_bytes()).unwrap();
    assert_eq!(from_json, world_file::read(world.as_bytes()).unwrap());
    let (lemma, choices) = case.split_once(" --choices ").unwrap();
    let name = line["lemma"].as_str().unwrap();
    for (choices, cause) in [
        (
            choices.rsplit_once(',').unwrap().0,
            "a case that begins so has at least 12 choices, not 11\n",
        ),
        (&*format!("{choices},0"), "the case that begins so has 12 choices, not 13\n"),
        (&*format!("255{}", &choices[1..]), "choice number 1 is 255; it is at most "),
    ] {
        let message = format!("--choices: {name}: {cause}");
        scratch.fact(&format!("{lemma} --choices {choices}"), 2, &message.into());
    }
}
