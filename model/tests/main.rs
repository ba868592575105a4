//! Tests of the specification through its public interface.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

mod ambiguity;
mod broken;
mod broken_folding;
mod broken_movable;
mod check;
mod contradictions;
mod contradictions_movable;
mod costs;
mod counts;
mod explorers;
mod false_each_time;
mod figure_1;
mod folding;
mod folding_explorer;
mod lazy;
mod markers;
mod movable;
mod optimum;
mod perception;
mod random_buildings;
mod scripted_world;
mod smallest_failure;
mod verdicts;
mod worlds;
