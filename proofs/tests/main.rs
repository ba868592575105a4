//! Tests of the lemmas, of the Coq development and of the harnesses for Kani.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

mod argument;
mod coq;
mod harnesses;

use std::ops::{ControlFlow, RangeInclusive};

use toposlam_model::{
    embedded_graph::EmbeddedGraph,
    enumerate::{Class, Each, Enumeration},
};

/// Every start of these sizes; its facing dart is dart 0.
fn starts(class: Class, sizes: RangeInclusive<usize>) -> Vec<EmbeddedGraph> {
    let mut starts = Vec::new();
    for edges in sizes {
        let _ = Enumeration::new(Each::Start, class, edges).unwrap().for_each(&mut |found| {
            starts.push(found.graph.clone());
            ControlFlow::Continue(())
        });
    }
    starts
}
