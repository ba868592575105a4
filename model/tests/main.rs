//! Tests of the specification through its public interface.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

use std::ops::ControlFlow;

use toposlam_model::{
    embedded_graph::EmbeddedGraph,
    enumerate::{Class, Each, Enumeration},
};

/// Every start of a class with a number of edges. Its facing dart is dart 0.
fn starts(class: Class, edges: usize) -> Vec<EmbeddedGraph> {
    let mut starts = Vec::new();
    let _ = Enumeration::new(Each::Start, class, edges).unwrap().for_each(&mut |found| {
        starts.push(found.graph.clone());
        ControlFlow::Continue(())
    });
    starts
}

mod ambiguity;
mod check;
mod contradictions;
mod costs;
mod counts;
mod explorers;
mod false_each_time;
mod figure_1;
mod folding;
mod lazy;
mod markers;
mod movable;
mod optimum;
mod perception;
mod random_buildings;
mod stories;
mod verdicts;
mod worlds;
