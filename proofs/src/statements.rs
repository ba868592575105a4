//! All lemmas and theorems: found by name, and counted.

use std::collections::BTreeSet;

use serde::Serialize;
use thiserror::Error;

use crate::{Lemma, Theorem, lemmas, theorems};

/// The name for every lemma.
pub const ALL: &str = "all";

#[derive(Clone, Debug)]
pub struct Statements<'l> {
    pub lemmas: Vec<&'l Lemma>,
    pub theorems: Vec<Theorem>,
}

/// The numbers of statements. `toposlam proofs --json` prints them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct StatementCounts {
    pub lemmas: usize,
    pub theorems: usize,
    /// The cases of all lemmas within their bounds.
    pub cases: u64,
    /// The lemmas that are sampled.
    pub sampled: usize,
    /// The lemmas with a harness for Kani.
    pub kani: usize,
}

/// A name that is not one of a lemma.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum LemmaNameError {
    #[error("there is no lemma `{name}`; there are:\n  {}", lemmas.join("\n  "))]
    Unknown { name: String, lemmas: Vec<&'static str> },
    #[error("`{name}` is part of several names:\n  {}", lemmas.join("\n  "))]
    Ambiguous { name: String, lemmas: Vec<&'static str> },
    #[error("{name} is proved in Coq, for every world; run proofs/coq/check to check it")]
    Theorem { name: String },
}

impl Statements<'static> {
    pub fn all() -> Self {
        Self { lemmas: lemmas::all().collect(), theorems: theorems::all().collect() }
    }
}

impl<'l> Statements<'l> {
    /// The lemmas of these names, each once, in the order of the names. [`ALL`] is the name of every lemma. A part of
    /// a name is enough if no other lemma has it.
    ///
    /// # Errors
    /// Returns an error if there is no such lemma, or if there are several.
    pub fn named(&self, names: &[String]) -> Result<Vec<&'l Lemma>, LemmaNameError> {
        let mut lemmas = Vec::new();
        for name in names {
            if name == ALL {
                lemmas.extend(&self.lemmas);
            } else {
                lemmas.push(self.lemma(name)?);
            }
        }
        let mut found = BTreeSet::new();
        lemmas.retain(|lemma| found.insert(lemma.name));
        Ok(lemmas)
    }

    fn lemma(&self, name: &str) -> Result<&'l Lemma, LemmaNameError> {
        if let Some(exact) = self.lemmas.iter().find(|lemma| lemma.name == name) {
            return Ok(exact);
        }
        if self.theorems.iter().any(|theorem| theorem.name == name) {
            return Err(LemmaNameError::Theorem { name: name.to_owned() });
        }
        let fitting = self.lemmas.iter().copied().filter(|lemma| lemma.name.contains(name));
        let names = |lemmas: &[&Lemma]| lemmas.iter().map(|lemma| lemma.name).collect();
        let name = name.to_owned();
        match fitting.collect::<Vec<_>>().as_slice() {
            [only] => Ok(only),
            [] => Err(LemmaNameError::Unknown { name, lemmas: names(&self.lemmas) }),
            several => Err(LemmaNameError::Ambiguous { name, lemmas: names(several) }),
        }
    }

    pub fn counts(&self) -> StatementCounts {
        StatementCounts {
            lemmas: self.lemmas.len(),
            theorems: self.theorems.len(),
            cases: self.lemmas.iter().map(|lemma| lemma.exhaustive.cases).sum(),
            sampled: self.lemmas.iter().filter(|lemma| lemma.sampled.is_some()).count(),
            kani: self.lemmas.iter().filter(|lemma| lemma.kani.is_some()).count(),
        }
    }
}
