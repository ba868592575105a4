//! Tests of the lemmas, of the Coq development and of the harnesses for Kani.

mod argument;
mod coq;
mod harnesses;
mod stateright;
