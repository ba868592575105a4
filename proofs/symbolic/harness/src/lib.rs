//! The harnesses for symbolic execution: lemmas, and decoders of any bytes.

mod logs;

use toposlam_proofs::{CaseResult, Stop, input::Input, lemma::CompiledHarness, lemmas};

/// How a run of a harness may end; otherwise it panics. Each must be reachable, except [`EXCLUDED`].
pub type Outcome = u8;

/// There is a case, and the claims hold.
pub const HOLDS: Outcome = 0;
/// The lemma says nothing about this case.
pub const EXCLUDED: Outcome = 1;
/// The bytes were decoded.
pub const VALUE: Outcome = 2;
/// The bytes were rejected.
pub const ERROR: Outcome = 3;

pub struct Harness {
    pub name: &'static str,
    pub input: &'static str,
    pub body: Body,
    /// The outcomes that some input must reach.
    pub covers: &'static [Outcome],
}

#[derive(Clone, Copy)]
pub enum Body {
    Lemma(fn(&mut Input) -> CaseResult),
    Decoder(fn() -> Outcome),
}

/// All harnesses.
pub fn all() -> Vec<Harness> {
    let lemmas = lemmas::compiled().map(|&CompiledHarness { name, bound, body }| Harness {
        name,
        input: bound,
        body: Body::Lemma(body),
        covers: &[HOLDS],
    });
    lemmas.chain(logs::all()).collect()
}

/// Runs a harness.
///
/// # Panics
/// If a claim does not hold.
#[inline(never)]
pub fn run(number: usize) -> Outcome {
    let case = match all().swap_remove(number).body {
        Body::Decoder(body) => return body(),
        Body::Lemma(body) => body(&mut Input),
    };
    match case {
        Ok(()) => HOLDS,
        Err(Stop::Excluded) => EXCLUDED,
        Err(Stop::Fails(claim)) => panic!("it is not true that {claim}"),
    }
}
