//! The fast tier: all tests of this folder in one program, for mutation testing, which links and runs
//! it once for each mutant. `cargo test` leaves it out, and runs each file as a program of its own.

mod ambiguity;
mod broken;
mod broken_movable;
mod check;
mod contradictions;
mod contradictions_movable;
mod costs;
mod counts;
mod figure_1;
mod markers;
mod movable;
mod perception;
mod verdicts;
mod worlds;
