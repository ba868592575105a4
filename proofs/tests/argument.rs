//! The written argument and the lemmas belong together.

use std::collections::BTreeSet;

use toposlam_proofs::{lemmas, theorems};

const ARGUMENT: &str = include_str!("../README.md");

#[test]
fn the_argument_names_every_lemma_and_beside_them_only_theorems() {
    // Names in backquotes that read like a lemma's: words with more than one line between them.
    let named: BTreeSet<_> = ARGUMENT
        .split('`')
        .skip(1)
        .step_by(2)
        .filter(|word| word.bytes().all(|b| b.is_ascii_lowercase() || b"_1".contains(&b)))
        .filter(|word| word.matches('_').count() > 1)
        .collect();
    let lemmas: BTreeSet<_> = lemmas::all().map(|lemma| lemma.name).collect();
    let theorems = theorems::all().map(|theorem| theorem.name).collect();
    assert_eq!(&named - &theorems, lemmas);
}

/// A table of sentences and theorems, and what `check` prints.
#[test]
fn the_page_on_the_theorems_names_each_of_them() {
    let page = include_str!("../coq/README.md");
    let sentences: Vec<_> = page.lines().filter_map(|line| line.strip_suffix("` |")).collect();
    let named: Vec<_> = sentences
        .iter()
        .filter_map(|line| line.rsplit_once(". | `"))
        .map(|(_, name)| name)
        .collect();
    let closed: Vec<_> = page.lines().filter_map(|line| line.strip_suffix(" closed")).collect();
    let theorems: Vec<_> = theorems::all().map(|theorem| theorem.name).collect();
    assert_eq!(named, theorems);
    assert_eq!(closed.iter().map(|name| name.trim_end()).collect::<Vec<_>>(), theorems);
}
