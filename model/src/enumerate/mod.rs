//! Every start and every embedded graph of a size, once, in a fixed order, in constant memory.
//!
//! Darts are numbered in the order in which a robot meets them (see [`code`](crate::isomorphism)):
//! the lowest dart with a free end is joined to a later free dart, or to the first dart of a new
//! vertex. Each start has exactly one such history, so nothing is made twice or discarded. An embedded
//! graph is enumerated at its least start; a history that cannot become least is abandoned early.

mod answers;
mod class;
mod draft;
mod rivals;
mod watch;

use std::ops::ControlFlow;

use thiserror::Error;

pub(crate) use answers::{Answer, Answers};
pub use class::{Class, UnknownClass};
pub(crate) use draft::Draft;
pub use draft::SearchEnd;
pub(crate) use watch::in_parts;
pub use watch::{Interrupted, MOST_THREADS, Watch, threads};

use crate::embedded_graph::EmbeddedGraph;
use draft::{Decisions, MAX_EDGES, PREFIX_EDGES, Prefix};

/// The objects that are enumerated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Each {
    /// Every start, once; its facing dart is dart 0.
    Start,
    /// Every embedded graph up to isomorphism, once; dart 0 is the facing dart of its least start.
    World,
}

/// All starts, or all embedded graphs up to isomorphism, of a class and a number of edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Enumeration {
    class: Class,
    edges: usize,
    each: Each,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum SizeError {
    #[error("a world has at least one edge")]
    NoEdge,
    #[error("worlds with {0} edges are too many to enumerate; the limit is {MAX_EDGES}")]
    TooManyEdges(usize),
}

#[derive(Clone, Copy, Debug)]
pub struct EnumeratedGraph<'g> {
    /// The embedded graph; darts are numbered as met from the start, which faces dart 0.
    pub graph: &'g EmbeddedGraph,
    /// The number of its automorphisms, when worlds are enumerated; 1 when starts are.
    pub automorphisms: u32,
}

/// A part of an enumeration: all histories with the same first steps. The parts are disjoint, and
/// together they are complete.
#[derive(Clone, Copy, Debug)]
pub struct EnumerationPart {
    whole: Enumeration,
    prefix: Prefix,
}

impl Enumeration {
    /// An enumeration of a class.
    ///
    /// # Errors
    /// Returns an error if the number of edges is 0 or more than 32.
    pub fn new(each: Each, class: Class, edges: usize) -> Result<Self, SizeError> {
        check_size(edges)?;
        Ok(Self { class, edges, each })
    }

    pub fn class(&self) -> Class {
        self.class
    }

    /// The parts of the enumeration, in its order. They do not depend on the number of threads.
    pub fn parts(&self) -> Vec<EnumerationPart> {
        let mut parts = Vec::new();
        let prefix = PREFIX_EDGES.min(self.edges);
        let _ = Draft::empty(self.each, self.class, self.edges).grow_to(prefix, &mut |draft| {
            parts.push(EnumerationPart { whole: *self, prefix: draft.prefix() });
            ControlFlow::Continue(())
        });
        parts
    }

    /// Visits everything, in order, until `visit` breaks.
    pub fn for_each(
        &self,
        visit: &mut impl FnMut(EnumeratedGraph) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let mut whole = Draft::empty(self.each, self.class, self.edges);
        whole.grow_to(self.edges, &mut |draft| draft.show(visit))
    }

    /// All graphs, one after the other, in order.
    pub fn graphs(&self) -> EnumeratedGraphs {
        let draft = Draft::empty(self.each, self.class, self.edges);
        EnumeratedGraphs { draft, decisions: Decisions::default(), edges: self.edges }
    }
}

/// The graphs of an enumeration. The next one is made when it is asked for.
#[derive(Clone, Debug)]
pub struct EnumeratedGraphs {
    draft: Draft,
    decisions: Decisions,
    edges: usize,
}

impl EnumeratedGraphs {
    /// Goes to the next graph. In the classes of simple graphs that may take long, so it makes at most this many
    /// steps.
    pub fn search(&mut self, steps: u64) -> SearchEnd {
        self.decisions.search(&mut self.draft, self.edges, steps)
    }

    /// The graph that was [found](SearchEnd::Found) last.
    pub fn graph(&self) -> &EmbeddedGraph {
        self.draft.graph()
    }
}

impl Iterator for EnumeratedGraphs {
    type Item = EmbeddedGraph;

    fn next(&mut self) -> Option<EmbeddedGraph> {
        (self.search(u64::MAX) == SearchEnd::Found).then(|| self.graph().clone())
    }
}

fn check_size(edges: usize) -> Result<(), SizeError> {
    match edges {
        0 => Err(SizeError::NoEdge),
        _ if edges > MAX_EDGES => Err(SizeError::TooManyEdges(edges)),
        _ => Ok(()),
    }
}

impl EnumerationPart {
    pub fn for_each(
        &self,
        visit: &mut impl FnMut(EnumeratedGraph) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let Enumeration { class, edges, each } = self.whole;
        let mut draft = Draft::empty(each, class, edges);
        draft.resume(self.prefix);
        draft.grow_to(edges, &mut |draft| draft.show(visit))
    }
}
