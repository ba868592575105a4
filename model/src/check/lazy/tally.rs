//! The counts of a part of a lazy check. They do not depend on the order in which starts are counted.

use std::{
    cmp::Reverse,
    sync::atomic::{AtomicU64, Ordering},
};

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

/// The counts of a part of a lazy check: of some units of its tree.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct LazyTally {
    /// Starts run.
    pub starts: u64,
    /// Starts mapped correctly.
    pub mapped: u64,
    /// The total of moves of the runs that ended with a right map.
    pub moves_total: u64,
    /// The moves that were made for all runs together.
    pub moves_made: u64,
    /// The total of the certificates of the starts; 0 if the marker is not directional.
    pub certificate_total: u64,
    /// The longest certificate of a start.
    pub certificate_max: u64,
    /// Starts that were mapped correctly in fewer moves than their certificate has.
    pub below_certificate: u64,
    /// The most moves of a right run, and the first start that took them; none if another part of the
    /// check is known to have a run with more.
    pub worst: Option<(u64, EnumeratedStart)>,
    /// The moves and the vertices of the run with the most moves per vertex.
    pub dearest: Option<(u64, u64)>,
    /// The first start on which the explorer failed.
    pub failure: Option<EnumeratedStart>,
    /// Whether the part was interrupted.
    pub interrupted: bool,
}

impl LazyTally {
    /// Counts a right run. The most moves of any run of the check so far are updated; a start with fewer
    /// moves cannot be the worst one.
    pub(super) fn count_run(
        &mut self,
        (graph, facing): (&EmbeddedGraph, Dart),
        moves: u64,
        most: &AtomicU64,
    ) {
        self.mapped += 1;
        self.moves_total += moves;
        self.count_dearest((moves, graph.vertex_count() as u64));
        if moves >= most.load(Ordering::Relaxed) {
            most.fetch_max(moves, Ordering::Relaxed);
            self.count_worst((moves, EnumeratedStart::new(graph, facing)));
        }
    }

    fn count_worst(&mut self, other: (u64, EnumeratedStart)) {
        let rank = |(moves, start): &(u64, EnumeratedStart)| (Reverse(*moves), start.clone());
        if self.worst.as_ref().is_none_or(|worst| rank(&other) < rank(worst)) {
            self.worst = Some(other);
        }
    }

    /// Of equal ratios that with the fewest vertices.
    fn count_dearest(&mut self, (moves, vertices): (u64, u64)) {
        let dearer = self.dearest.is_none_or(|(most, of)| {
            (moves * of, Reverse(vertices)) > (most * vertices, Reverse(of))
        });
        if dearer {
            self.dearest = Some((moves, vertices));
        }
    }

    /// Counts a start on which the explorer failed.
    pub(super) fn count_failure(&mut self, start: EnumeratedStart) {
        if self.failure.as_ref().is_none_or(|first| start < *first) {
            self.failure = Some(start);
        }
    }

    /// Adds the counts of another part of the same check.
    pub fn merge(&mut self, other: Self) {
        self.starts += other.starts;
        self.mapped += other.mapped;
        self.moves_total += other.moves_total;
        self.moves_made += other.moves_made;
        self.certificate_total += other.certificate_total;
        self.certificate_max = self.certificate_max.max(other.certificate_max);
        self.below_certificate += other.below_certificate;
        self.interrupted |= other.interrupted;
        if let Some(worst) = other.worst {
            self.count_worst(worst);
        }
        if let Some(dearest) = other.dearest {
            self.count_dearest(dearest);
        }
        if let Some(failure) = other.failure {
            self.count_failure(failure);
        }
    }
}
