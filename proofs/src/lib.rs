//! The lemmas on which the correctness of the mapping rests, each one body with three drivers.
//!
//! A lemma is a plain function over [`Choose`]: it chooses a case, and answers whether what it
//! claims holds there. An [`ChoiceOdometer`] makes it choose in every way within a bound, so that the
//! lemma is proved for all of these cases; property tests let it choose from [`Bytes`] at larger
//! bounds, and shrink what fails; under [Kani](https://github.com/model-checking/kani) each choice
//! is symbolic. A [`CaseReplay`] makes one case again and shows it to a person.
//!
//! From the ground up:
//!
//! * [`choose`]: the trait, and what a case can come to;
//! * [`odometer`], [`bytes`], [`replay`], and `symbolic` for Kani: who chooses;
//! * [`draw`]: starts, permutations and numbers, made of choices, so that none is in vain;
//! * [`definition`]: what is meant by a graph, an isomorphism, a bisimulation;
//! * [`hallways`]: where a robot drives, what it sees there, rightly or not, and where it gets;
//! * [`lemma`]: what there is to know about a lemma, and how it is declared;
//! * [`lemmas`]: the lemmas, a file for each theme;
//! * [`theorems`]: what is proved in Coq, in `coq/`;
//! * [`fuzz`]: what fuzzers try to break, on bytes of their own.
//!
//! How they make up the theorem is told in the README beside this crate.

pub mod bytes;
pub mod choose;
pub mod definition;
pub mod draw;
pub mod fuzz;
pub mod hallways;
pub mod lemma;
pub mod lemmas;
pub mod odometer;
pub mod replay;
#[cfg(kani)]
pub mod symbolic;
pub mod theorems;

pub use bytes::Bytes;
pub use choose::{CaseResult, Choose, Exhibit, Stop};
pub use lemma::Lemma;
pub use odometer::{ChoiceOdometer, Counterexample};
pub use replay::CaseReplay;
pub use theorems::Theorem;
