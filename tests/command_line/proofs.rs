//! `toposlam proofs`: the list, a check, a single case. Nothing here depends on the lemmas and theorems
//! that exist. The report on a lemma that fails is tested beside the verb.

use std::{fs, process::Output};

use serde_json::Value;
use toposlam_model::format::world_file;
use toposlam_proofs::{Exhibit, Lemma, Theorem, lemmas, replay::ChoicesError, theorems};

use super::{folder, objects, run, stderr, stdout, stdout_of};

/// The lemmas, the theorems and the totals.
fn listed() -> (Vec<Value>, Vec<Value>, Value) {
    let mut lines = objects(&stdout_of(["proofs", "--json"]));
    let totals = lines.pop().unwrap();
    let (lemmas, theorems) = lines.into_iter().partition(|line| line.get("lemma").is_some());
    (lemmas, theorems, totals)
}

/// The two lemmas with the fewest cases, or the only one.
fn quick() -> Vec<&'static Lemma> {
    let mut lemmas: Vec<_> = lemmas::all().collect();
    lemmas.sort_by_key(|lemma| lemma.exhaustive.cases);
    lemmas.truncate(2);
    lemmas
}

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

/// The message of an error.
fn error_message(output: &Output) -> String {
    let message = stderr(output);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(output.stdout.is_empty() && message.starts_with("error: "), "{message}");
    message
}

#[test]
fn every_lemma_is_listed_with_its_place_and_its_engines() {
    let (lines, proved, totals) = listed();
    let text = stdout_of(["proofs"]);
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    // Without line breaks.
    let flowing = text.split_whitespace().collect::<Vec<_>>().join(" ");
    for (line, lemma) in lines.iter().zip(lemmas::all()) {
        assert_eq!(line["lemma"], lemma.name);
        assert!(text.contains(&format!("{}\n  ", lemma.name)), "{text}");
        for part in ["sentence", "paper", "file"].map(|key| line[key].as_str().unwrap()) {
            assert!(flowing.contains(part), "{part}");
        }
        assert!(fs::exists(line["file"].as_str().unwrap()).unwrap(), "{line}");
        assert_eq!(line["exhaustive"]["cases"], lemma.exhaustive.cases);
        assert!(flowing.contains(&format!("exhaustive {}: ", lemma.exhaustive.bound)));
        assert_eq!(line["sampled"]["bound"].as_str(), lemma.sampled.map(|sampled| sampled.bound));
        assert_eq!(line["kani"]["harness"].as_str(), lemma.kani.map(|kani| kani.harness));
    }
    let cases: u64 = lines.iter().map(|line| line["exhaustive"]["cases"].as_u64().unwrap()).sum();
    assert_eq!((&totals["lemmas"], &totals["cases"]), (&lines.len().into(), &cases.into()));
    assert_eq!(lines.len(), lemmas::all().count());
    for (line, Theorem { name, sentence, paper }) in proved.iter().zip(theorems::all()) {
        assert_eq!(
            (&line["theorem"], &line["coq"]["bound"]),
            (&name.into(), &"every world".into())
        );
        assert_eq!((&line["sentence"], &line["paper"]), (&(&*sentence).into(), &(&*paper).into()));
        assert!(fs::exists(line["file"].as_str().unwrap()).unwrap(), "{line}");
        let entry =
            format!("{name} {sentence} paper {paper} file {} Coq every world ", theorems::FILE);
        assert!(flowing.contains(&entry), "{entry}");
    }
    assert_eq!(proved.len(), theorems::all().count());
    assert_eq!(totals["theorems"], proved.len());
    assert!(flowing.contains("neither this program nor cargo test runs it"), "{text}");
    let last = text.lines().last().unwrap();
    assert!(last.starts_with(&format!("{} lemma", lines.len())), "{last}");
    assert!(last.contains(&format!("; {} theorem", proved.len())), "{last}");
}

#[test]
fn a_lemma_is_checked_in_every_case() {
    let lemmas = quick();
    let names = lemmas.iter().flat_map(|lemma| ["--run", lemma.name]);
    let lines = objects(&stdout_of(["proofs", "--json"].into_iter().chain(names)));
    for (line, lemma) in lines.iter().zip(&lemmas) {
        assert_eq!((&line["lemma"], &line["holds"]), (&lemma.name.into(), &true.into()));
        assert_eq!(
            (&line["cases"], &line["choices"]),
            (&lemma.exhaustive.cases.into(), &Value::Null)
        );
        assert!(line["seconds"].is_f64());
    }
    let totals = lines.last().unwrap();
    assert_eq!((&totals["lemmas"], &totals["held"]), (&lemmas.len().into(), &lemmas.len().into()));
    assert_eq!(totals["holds"], true);
    let text = stdout_of(["proofs", "--run", lemmas[0].name]);
    let row = text.lines().next().unwrap();
    assert!(row.starts_with(lemmas[0].name) && row.ends_with(" s  holds"), "{text}");
    assert!(text.lines().last().unwrap().starts_with("holds: 1 of 1 lemma, "), "{text}");
}

#[test]
fn an_unknown_name_lists_those_that_exist() {
    let message = error_message(&run(["proofs", "--run", "the_moon_is_round"]));
    let names: Vec<_> = lemmas::all().map(|lemma| lemma.name).collect();
    let cause = "--run: there is no lemma `the_moon_is_round`; there are:";
    assert_eq!(message, format!("error: {cause}\n  {}\n", names.join("\n  ")));
}

#[test]
fn the_other_verbs_read_the_world_of_a_case() {
    let folder = folder("proofs_case");
    let (lemma, choices) = case_with_a_walk();
    let case = ["proofs", "--run", lemma.name, "--choices", &choices_text(&choices)];
    let text = stdout_of(case);
    assert!(text.starts_with(&format!("{}\n  ", lemma.name)), "{text}");
    let joined = text.replace(" \\\n", " ").split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(joined.contains(&format!(" again: toposlam {} ", case.join(" "))), "{text}");
    assert!(text.contains("\n  door   robot at  perceives\n  start  v"), "{text}");
    assert!(text.ends_with("\n\nholds: the lemma holds in this case\n"), "{text}");
    assert_eq!(text, stdout_of(case));

    let (_, below) = text.split_once(" `toposlam explore`:\n\n").unwrap();
    let length = below.lines().position(|line| line.starts_with("facing = ")).unwrap() + 1;
    let world: String = below.split_inclusive('\n').take(length).collect();
    let file = folder.join("case.toml");
    fs::write(&file, &world).unwrap();
    let file = file.to_str().unwrap();
    assert!(stdout_of(["explore", file]).contains("It is isomorphic to the world"));
    assert!(stdout_of(["draw", file]).starts_with("<svg"));

    let [line] = objects(&stdout_of(case.into_iter().chain(["--json"]))).try_into().unwrap();
    assert_eq!((&line["lemma"], &line["holds"]), (&lemma.name.into(), &true.into()));
    assert_eq!((&line["choices"], &line["verdict"]), (&choices.into(), &"holds".into()));
    let from_json = world_file::read(line["worlds"][0].to_string().as_bytes()).unwrap();
    assert_eq!(from_json, world_file::read(world.as_bytes()).unwrap());
    let walk = &line["walks"][0];
    let [poses, percepts] = ["poses", "percepts"].map(|key| walk[key].as_array().unwrap().len());
    assert!(poses == percepts && walk["doors"].is_array(), "{walk}");
}

#[test]
fn choices_that_make_no_case_are_an_error() {
    let (lemma, choices) = case_with_a_walk();
    let rejected = |choices: &[u8]| {
        let choices = choices_text(choices);
        error_message(&run(["proofs", "--run", lemma.name, "--choices", &choices]))
    };
    let length = choices.len();
    let place = format!("error: --choices: {}: ", lemma.name);
    let message = rejected(&choices[1..]);
    let few = format!("a case that begins so has at least {length} choices, not {}", length - 1);
    assert_eq!(message, format!("{place}{few}\n"));
    let message = rejected(&[&choices[..], &[0]].concat());
    let many = format!("the case that begins so has {length} choices, not {}", length + 1);
    assert_eq!(message, format!("{place}{many}\n"));
    let message = rejected(&[&[255], &choices[1..]].concat());
    assert!(message.starts_with(&format!("{place}choice number 1 is 255; it is at most ")));
}

#[test]
fn a_sampled_case_has_its_own_bound() {
    let sampled = |choices: &str, lemma: &Lemma| {
        run(["proofs", "--run", lemma.name, "--engine", "sampled", "--choices", choices])
    };
    for lemma in lemmas::all() {
        let output = sampled("", lemma);
        let message = stderr(&output);
        match lemma.sampled {
            None => assert!(message.ends_with(&format!("{} is not sampled\n", lemma.name))),
            Some(_) => assert!(message.contains("begins so has at least") || message.is_empty()),
        }
    }
    let Some(lemma) = lemmas::all().find(|lemma| lemma.sampled.is_some()) else { return };
    let mut choices = Vec::new();
    let text = loop {
        let output = sampled(&choices_text(&choices), lemma);
        if output.status.code() != Some(2) {
            break stdout(&output);
        }
        assert!(stderr(&output).contains("begins so has at least"), "{}", stderr(&output));
        choices.push(0);
    };
    let again = format!(" again: toposlam proofs --run {} --engine sampled --choices ", lemma.name);
    let joined = text.replace(" \\\n", " ").split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(joined.contains(&format!("{again}{} ", choices_text(&choices))), "{text}");
}

#[test]
fn the_case_in_the_help_exists() {
    let help = stdout_of(["proofs", "--help"]);
    let mut examples = help.lines().filter_map(|line| line.strip_prefix("  toposlam "));
    let case = examples.find(|line| line.contains("--choices")).unwrap();
    assert!(stdout_of(case.split(' ')).contains("as a file for `toposlam draw`"));
}
