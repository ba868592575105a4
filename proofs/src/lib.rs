//! The lemmas behind the correctness of the mapping: each is one function with three drivers.
//!
//! A lemma is a plain function over [`Choose`]: it chooses a case, and returns whether its claims hold
//! there. A [`ChoiceOdometer`] makes every choice within a bound, which proves the lemma for
//! all of these cases; property tests choose from [`Bytes`] at larger bounds, and shrink failures; under [Kani](https://github.com/model-checking/kani) each choice
//! is symbolic. A [`CaseReplay`] makes one case again and shows it to a person.
//!
//! Bottom up:
//!
//! * [`choose`]: the trait, and the results of a case;
//! * [`odometer`], [`bytes`], [`replay`], `symbolic` for Kani, and `input` for symbolic execution: the drivers;
//! * [`draw`]: starts, permutations and numbers, made from choices;
//! * [`definition`]: the definitions of a graph, an isomorphism, a bisimulation;
//! * [`hallways`]: a robot in hallways: what it sees there, correctly or not, and where it arrives;
//! * [`lemma`]: lemmas and their declaration;
//! * [`lemmas`]: the lemmas, a file for each theme;
//! * [`shown_case`]: what a lemma shows of a case, as data;
//! * [`theorems`]: the theorems proved in Coq, in `coq/`;
//! * [`statements`]: all lemmas and theorems, by name and by number;
//! * [`fuzz`]: the bodies for fuzzers.
//!
//! The README of this crate combines them to the theorem.

pub mod bytes;
pub mod choose;
pub mod definition;
pub mod draw;
pub mod fuzz;
pub mod hallways;
#[cfg(feature = "symbolic")]
pub mod input;
pub mod lemma;
pub mod lemmas;
pub mod marker_theorems;
pub mod odometer;
pub mod replay;
pub mod shown_case;
pub mod statements;
#[cfg(kani)]
pub mod symbolic;
pub mod theorems;

pub use bytes::Bytes;
pub use choose::{CaseResult, Choose, Exhibit, Stop};
pub use lemma::{CheckTotals, ENGINES, Lemma, LemmaCheck, LemmaFailure};
pub use marker_theorems::MarkerTheorem;
pub use odometer::{ChoiceOdometer, Counterexample};
pub use replay::CaseReplay;
pub use shown_case::{ShownExhibit, ShownWalk};
pub use statements::{LemmaNameError, Statements};
pub use theorems::Theorem;
