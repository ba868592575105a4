//! Lemmas and their declaration.

use std::time::Instant;

use serde::Serialize;
use thiserror::Error;
use toposlam_model::{counts::counted, enumerate::Watch};

use crate::{
    bytes::Bytes,
    choose::CaseResult,
    odometer::{ChoiceOdometer, Counterexample, PROGRESS, listed},
    replay::{CaseReplay, ChoicesError, ReplayedCase},
};

/// A lemma: a statement, and the engines that check it. `toposlam proofs --json` prints it.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Lemma {
    #[serde(rename = "lemma")]
    pub name: &'static str,
    /// Its statement, a sentence.
    pub sentence: &'static str,
    /// Its place in the paper.
    pub paper: &'static str,
    /// Its file, relative to the root of the workspace.
    pub file: &'static str,
    /// Its check on every case within a bound; every lemma has one.
    pub exhaustive: Exhaustive,
    /// Its check on random cases within a larger bound.
    pub sampled: Option<Sampled>,
    /// Its check by Kani, if that is installed.
    pub kani: Option<Kani>,
}

/// The check of a lemma on every case within a bound.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Exhaustive {
    /// The bound, in words.
    pub bound: &'static str,
    /// The number of cases within it. A check that finds another number fails.
    pub cases: u64,
    /// The lemma, for the driver that goes through all cases.
    #[serde(skip)]
    pub body: fn(&mut ChoiceOdometer) -> CaseResult,
    /// The lemma, for making one case again.
    #[serde(skip)]
    pub replay: fn(&mut CaseReplay) -> CaseResult,
}

/// The check of a lemma on random cases.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Sampled {
    /// The bound, in words.
    pub bound: &'static str,
    /// The lemma, for the driver that reads bytes.
    #[serde(skip)]
    pub body: fn(&mut Bytes) -> CaseResult,
    /// The lemma, for making one case again.
    #[serde(skip)]
    pub replay: fn(&mut CaseReplay) -> CaseResult,
}

/// The check of a lemma by Kani.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Kani {
    /// The bound, in words.
    pub bound: &'static str,
    /// The number of times that a loop is unwound.
    pub unwind: u32,
    pub harness: &'static str,
}

/// The check of a lemma by symbolic execution of the compiled harness.
#[cfg(feature = "symbolic")]
#[derive(Clone, Copy, Debug)]
pub struct CompiledHarness {
    /// The name of the lemma.
    pub name: &'static str,
    /// The bound, in words.
    pub bound: &'static str,
    /// The lemma, for the driver whose choices are bytes of the input.
    pub body: fn(&mut crate::input::Input) -> CaseResult,
}

/// The result of the exhaustive check of a lemma.
#[derive(Clone, Debug)]
pub struct LemmaCheck<'l> {
    pub lemma: &'l Lemma,
    /// The number of cases in which it holds, before the first one in which it fails.
    pub cases: u64,
    pub seconds: f64,
    pub failure: Option<LemmaFailure>,
}

/// The reason why the exhaustive check of a lemma fails.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum LemmaFailure {
    /// The lemma fails in a case.
    #[error("it is not true that {}", _0.claim)]
    Case(Counterexample),
    /// The number of cases is wrong; it must be the pinned one, and at least 1.
    #[error("expected {} within its bound, found {}", in_cases(*pinned), in_cases(*found))]
    Cases { pinned: u64, found: u64 },
    #[error("the check was stopped")]
    Stopped,
}

impl LemmaFailure {
    /// The choices of the case in which the lemma fails.
    pub fn choices(&self) -> Option<&[u8]> {
        if let Self::Case(case) = self { Some(&case.choices) } else { None }
    }
}

/// The engines, and how to run each.
pub const ENGINES: [(&str, &str); 4] = [
    ("exhaustive", "every case within the bound: toposlam proofs --run NAME, or --run all"),
    ("sampled", "random cases within the bound: cargo test -p toposlam-proofs"),
    (
        "Kani",
        "every case within the bound, symbolically: proofs/kani/verify, if Kani is installed; \
         neither this program nor cargo test runs it, and this list does not contain its results",
    ),
    (
        "Coq",
        "every world, without a bound: proofs/coq/check, if Coq is installed; cargo test -p \
         toposlam-proofs runs it too, this program does not",
    ),
];

/// The totals of a check of lemmas. `toposlam proofs --json` prints them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CheckTotals {
    pub lemmas: usize,
    pub held: usize,
    #[serde(skip)]
    pub failed: usize,
    pub not_checked: usize,
    /// The cases of the lemmas that did not fail.
    pub cases: u64,
    pub seconds: f64,
    /// Whether the check of a lemma was stopped, and none failed.
    pub interrupted: bool,
}

impl CheckTotals {
    /// The totals of a check of this many lemmas, as far as it went.
    pub fn new(lemmas: usize, checked: &[LemmaCheck]) -> Self {
        let mut totals = Self {
            lemmas,
            held: 0,
            failed: 0,
            not_checked: lemmas - checked.len(),
            cases: 0,
            seconds: checked.iter().map(|check| check.seconds).sum(),
            interrupted: false,
        };
        for check in checked {
            match check.failure {
                None => totals.held += 1,
                Some(LemmaFailure::Stopped) => totals.interrupted = true,
                Some(_) => {
                    totals.failed += 1;
                    continue;
                }
            }
            totals.cases += check.cases;
        }
        totals.interrupted &= totals.failed == 0;
        totals
    }
}

/// A number of cases in words.
pub fn in_cases(number: u64) -> String {
    counted(number as usize, "case")
}

impl Lemma {
    /// The place in the paper, the file, and the bound of each engine, each after its label.
    pub fn details(&self) -> Vec<(&'static str, String)> {
        let Self { paper, file, exhaustive, sampled, kani, .. } = self;
        let every = format!("{}: {}", exhaustive.bound, in_cases(exhaustive.cases));
        let mut details =
            vec![("paper", paper.to_string()), ("file", file.to_string()), ("exhaustive", every)];
        details.extend(sampled.map(|sampled| ("sampled", sampled.bound.to_owned())));
        details
            .extend(kani.map(|kani| ("Kani", format!("{}; unwind {}", kani.bound, kani.unwind))));
        details
    }

    /// Checks the lemma on every case within its bound.
    pub fn check(&self, watch: &dyn Watch) -> LemmaCheck<'_> {
        let start = Instant::now();
        let Exhaustive { body, cases: pinned, .. } = self.exhaustive;
        watch.parts((pinned / PROGRESS) as usize);
        let (cases, failure) = match ChoiceOdometer::exhaust(body, watch) {
            Err(case) => (case.cases, Some(LemmaFailure::Case(case))),
            Ok(found) if found == pinned && found > 0 => (found, None),
            Ok(found) if watch.stop() => (found, Some(LemmaFailure::Stopped)),
            Ok(found) => (found, Some(LemmaFailure::Cases { pinned, found })),
        };
        LemmaCheck { lemma: self, cases, seconds: start.elapsed().as_secs_f64(), failure }
    }

    /// The command that prints the case of these choices.
    pub fn command(&self, choices: &[u8]) -> String {
        let command = format!("toposlam proofs --run {} --choices {}", self.name, listed(choices));
        command.trim_end().to_owned()
    }

    /// Makes a case again, and returns it after the name of the engine within whose bound it is. Of two engines it is
    /// the one in which the lemma fails, or else the exhaustive one.
    ///
    /// # Errors
    /// Returns an error if the choices are not those of a case.
    pub fn replay(&self, choices: &[u8]) -> Result<(&'static str, ReplayedCase), ChoicesError> {
        let exhaustive = CaseReplay::show(self.exhaustive.replay, choices);
        let sampled = self.sampled.map(|sampled| CaseReplay::show(sampled.replay, choices));
        match sampled {
            Some(Ok(made)) if exhaustive.is_err() || made.claim().is_some() => {
                Ok(("sampled", made))
            }
            _ => exhaustive.map(|made| ("exhaustive", made)),
        }
    }
}

/// Declares lemmas: each with its statement, its place in the paper, and its engines, which are the same
/// generic function with different bounds. The macro expands to the list `LEMMAS` of the file; for each
/// lemma to a module of its name with the tests `exhaustively` and `sampled`; and with `--cfg kani` to
/// its harness `kani` there. With the feature `symbolic` there is also the
/// list `COMPILED`, for `symbolic/harness`.
macro_rules! declare {
    ($(
        $name:ident {
        $sentence:literal,
        paper $paper:literal,
        exhaustive $bound:tt, $cases:tt cases: $exhaustive:expr;
        $(sampled $sampled_bound:tt: $sampled:expr;)?
        $(kani $kani_bound:literal, unwind $unwind:tt: $kani:expr;)?
        $(symbolic $symbolic_bound:literal: $symbolic:expr;)?
        }
    )*) => {
        /// The lemmas of this file.
        pub(crate) const LEMMAS: &[$crate::lemma::Lemma] = &[$($crate::lemma::Lemma {
            name: stringify!($name),
            sentence: $sentence,
            paper: $paper,
            file: file!(),
            exhaustive: $crate::lemma::Exhaustive {
                bound: $bound,
                cases: $cases,
                body: $exhaustive,
                replay: $exhaustive,
            },
            sampled: $crate::lemma::optional!($($crate::lemma::Sampled {
                bound: $sampled_bound,
                body: $sampled,
                replay: $sampled,
            })?),
            kani: $crate::lemma::optional!($($crate::lemma::Kani {
                bound: $kani_bound,
                unwind: $unwind,
                harness: concat!(module_path!(), "::", stringify!($name), "::kani"),
            })?),
        }),*];

        /// The lemmas of this file that are executed symbolically.
        #[cfg(feature = "symbolic")]
        pub(crate) const COMPILED: &[$crate::lemma::CompiledHarness] =
            &[$($($crate::lemma::CompiledHarness {
                name: stringify!($name),
                bound: $symbolic_bound,
                body: $symbolic,
            },)?)*];

        $(
            #[cfg(any(test, kani))]
            mod $name {
                #[allow(unused_imports, reason = "a lemma of fixed bounds names nothing more")]
                use super::*;

                #[cfg(test)]
                #[test]
                fn exhaustively() {
                    $crate::lemma::tests::exhaustively(LEMMAS, stringify!($name));
                }

                $(
                    #[cfg(test)]
                    #[test]
                    fn sampled() {
                        let _ = $sampled_bound;
                        $crate::lemma::tests::sampled(LEMMAS, stringify!($name));
                    }
                )?

                $(
                    #[cfg(kani)]
                    #[kani::proof]
                    #[kani::unwind($unwind)]
                    fn kani() {
                        let case: $crate::CaseResult = $kani(&mut $crate::symbolic::Symbolic);
                        let holds = case.is_ok();
                        assert!(holds);
                        kani::cover!(holds, "there is a case");
                    }
                )?
            }
        )*
    };
}

/// What is written, or nothing.
macro_rules! optional {
    () => {
        None
    };
    ($value:expr) => {
        Some($value)
    };
}

pub(crate) use {declare, optional};

#[cfg(test)]
pub(crate) mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::choose::Stop;

    fn named<'l>(lemmas: &'l [Lemma], name: &str) -> &'l Lemma {
        lemmas.iter().find(|lemma| lemma.name == name).expect("it is listed")
    }

    pub(crate) fn exhaustively(lemmas: &[Lemma], name: &str) {
        let lemma = named(lemmas, name);
        match lemma.check(&()).failure {
            None | Some(LemmaFailure::Stopped) => {}
            Some(failure) => {
                let again = failure.choices().map(|choices| lemma.command(choices));
                panic!("{failure}\n  {}", again.unwrap_or_default())
            }
        }
    }

    pub(crate) fn sampled(lemmas: &[Lemma], name: &str) {
        let lemma = named(lemmas, name);
        let sampled = lemma.sampled.expect("it is sampled");
        // Where few cases are those of which the lemma speaks, more are drawn.
        let config = ProptestConfig { max_global_rejects: 1 << 16, ..ProptestConfig::default() };
        proptest!(config, |(bytes in proptest::collection::vec(any::<u8>(), 0..=1024))| {
            let mut choose = Bytes::new(bytes);
            match (sampled.body)(&mut choose) {
                Ok(()) => {}
                Err(Stop::Excluded) => return Err(TestCaseError::reject("excluded")),
                Err(Stop::Fails(claim)) => return Err(TestCaseError::fail(format!(
                    "it does not hold that {claim}:\n  {}",
                    lemma.command(choose.choices())
                ))),
            }
        });
    }
}
