//! The classes of worlds that can be enumerated.

use std::str::FromStr;

use thiserror::Error;

use crate::embedded_graph::EmbeddedGraph;

crate::words! {
    Class {
        /// All embedded graphs: loops and parallel edges allowed, any genus.
        Multigraph = "multigraph",
        /// No loops and no parallel edges; any genus.
        Simple = "simple",
        /// Simple, and no vertex of degree more than 3: dead ends, bends and T junctions.
        Corridor = "corridor",
        Planar = "planar",
    }
}

#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("`{0}` is not a class of worlds; the classes are multigraph, simple, corridor and planar")]
pub struct UnknownClass(String);

impl Class {
    pub fn is_simple(self) -> bool {
        self != Self::Multigraph
    }

    pub fn max_degree(self) -> u32 {
        if self == Self::Corridor { 3 } else { u32::MAX }
    }

    pub fn contains(self, graph: &EmbeddedGraph) -> bool {
        let fits = |vertex| graph.degree(vertex) <= self.max_degree();
        (!self.is_simple() || graph.is_simple())
            && graph.vertices().all(fits)
            && (self != Self::Planar || graph.genus() == 0)
    }
}

impl FromStr for Class {
    type Err = UnknownClass;

    fn from_str(name: &str) -> Result<Self, UnknownClass> {
        let class = Self::ALL.into_iter().find(|class| class.name() == name);
        class.ok_or_else(|| UnknownClass(name.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_class_is_printed_and_parsed_by_its_name() {
        let names = ["multigraph", "simple", "corridor", "planar"];
        assert_eq!(Class::ALL.map(|class| class.to_string()), names);
        assert_eq!(names.map(str::parse), Class::ALL.map(Ok));
    }
}
