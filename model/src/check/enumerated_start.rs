//! A start by its place in the enumeration.

use serde::{Deserialize, Serialize};

use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    isomorphism::{StartCode, canonical},
};

/// A start by its place in the [enumeration](crate::enumerate::Enumeration): its world as discovered from its
/// least start, and the first dart of that which faces as the start does. Starts are ordered as the
/// enumeration finds them.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct EnumeratedStart {
    /// The [code](crate::isomorphism::StartCode) of the least start.
    code: Vec<u32>,
    facing: u32,
}

impl EnumeratedStart {
    /// The place of a start.
    #[must_use]
    pub fn new(graph: &EmbeddedGraph, facing: Dart) -> Self {
        let least = canonical(graph);
        let orbit = least.orbit[facing.at()];
        let mut numbered = (0..).zip(&least.order);
        let facing = numbered.find(|(_, dart)| least.orbit[dart.at()] == orbit);
        Self { code: least.code.words().to_vec(), facing: facing.map_or(0, |(number, _)| number) }
    }

    /// The start; `None` if the code is not that of a start.
    #[must_use]
    pub fn start(&self) -> Option<(EmbeddedGraph, Dart)> {
        let graph = StartCode::start_of(&self.code)?;
        let facing = Dart(self.facing);
        (facing.at() < graph.dart_count()).then_some((graph, facing))
    }
}
