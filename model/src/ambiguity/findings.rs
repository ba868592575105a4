//! What a search finds: the worlds that a marker does not distinguish.

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    isomorphism::StartCode,
};

/// An embedded graph with a marker, up to isomorphism that keeps the marker.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(into = "Vec<u32>", try_from = "Vec<u32>")]
pub struct PlacedWorld {
    /// The graph; the marker was placed by its dart 0. Of all starts that place it so, this is the
    /// one with the least code, and darts are numbered as met from it.
    pub graph: EmbeddedGraph,
    pub(super) code: StartCode,
}

impl PlacedWorld {
    /// The facing dart by which the marker was placed.
    pub const FACING: Dart = Dart(0);
}

/// A placed world is sent as the words of its code.
impl From<PlacedWorld> for Vec<u32> {
    fn from(world: PlacedWorld) -> Self {
        world.code.words().to_vec()
    }
}

impl TryFrom<Vec<u32>> for PlacedWorld {
    type Error = Unfinished;

    fn try_from(words: Vec<u32>) -> Result<Self, Unfinished> {
        let graph = StartCode::start_of(&words).ok_or(Unfinished::Unreadable)?;
        Ok(Self { graph, code: StartCode::of_words(words) })
    }
}

/// Placed worlds that are indistinguishable from each other, in the order of their sizes and codes. There are
/// at least two.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct AmbiguousGroup {
    pub worlds: Vec<PlacedWorld>,
}

impl AmbiguousGroup {
    pub(super) fn smallest(&self) -> Option<[&PlacedWorld; 2]> {
        match self.worlds.as_slice() {
            [one, other, ..] => Some([one, other]),
            _ => None,
        }
    }
}

/// The findings among the worlds with one number of edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SizeFindings {
    pub edges: usize,
    pub placed_worlds: u64,
    /// The placed worlds that are indistinguishable from another of the sizes searched.
    pub ambiguous: u64,
}

/// The findings of a search.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Findings {
    /// For each number of edges from 1.
    pub sizes: Vec<SizeFindings>,
    /// All ambiguous worlds, the group with the smallest pair first; or that pair, if only it is
    /// [kept](KeptPairs).
    pub groups: Vec<AmbiguousGroup>,
}

/// Which pairs a search keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeptPairs {
    All,
    /// Only the smallest one, whose memory does not grow with the number of pairs.
    Smallest,
}

/// Why a search has no findings.
#[derive(Clone, Debug, PartialEq, Eq, Error, Serialize, Deserialize)]
pub enum Unfinished {
    #[error("the search was interrupted")]
    Interrupted,
    /// Two worlds have the same quotient, but no relation that can be verified. This is a bug in the
    /// search.
    #[error(
        "two worlds with {} and {} edges have the same quotient and are not confirmed to be \
         indistinguishable: the search is at fault",
        .0[0].graph.edge_count(), .0[1].graph.edge_count()
    )]
    Unconfirmed(Box<[PlacedWorld; 2]>),
    /// A candidate that was stored and read again is not that of a placed world.
    #[error("what was stored of a world cannot be read: the storage is at fault")]
    Unreadable,
}

impl Findings {
    pub fn count_placed(&mut self, edges: usize, placed_worlds: u64) {
        if let Some(size) = self.sizes.iter_mut().find(|size| size.edges == edges) {
            size.placed_worlds += placed_worlds;
        }
    }

    /// These findings and those of the same search among other quotients.
    #[must_use]
    pub fn merged(mut self, other: Self, kept: KeptPairs) -> Self {
        for (size, more) in self.sizes.iter_mut().zip(other.sizes) {
            size.placed_worlds += more.placed_worlds;
            size.ambiguous += more.ambiguous;
        }
        self.groups.extend(other.groups);
        self.groups.sort_by(|one, other| one.smallest().map(rank).cmp(&other.smallest().map(rank)));
        match kept {
            KeptPairs::All => self,
            KeptPairs::Smallest => self.into_smallest(),
        }
    }

    #[must_use]
    pub fn into_smallest(mut self) -> Self {
        self.groups.truncate(1);
        for group in &mut self.groups {
            group.worlds.truncate(2);
        }
        self
    }

    /// The smallest pair: the one with the fewest edges in its larger world; then in its smaller
    /// world; then with the least codes.
    pub fn smallest(&self) -> Option<[&PlacedWorld; 2]> {
        self.groups.first()?.smallest()
    }

    /// All pairs, the smallest first. A group of `k` worlds has `k (k - 1) / 2` of them.
    pub fn pairs(&self) -> Vec<[&PlacedWorld; 2]> {
        let mut pairs = Vec::new();
        for AmbiguousGroup { worlds } in &self.groups {
            for (place, other) in worlds.iter().enumerate() {
                pairs.extend(worlds[..place].iter().map(|one| [one, other]));
            }
        }
        pairs.sort_by_key(|pair| rank(*pair));
        pairs
    }
}

pub(super) fn rank([one, other]: [&PlacedWorld; 2]) -> (usize, usize, &StartCode, &StartCode) {
    (other.graph.edge_count(), one.graph.edge_count(), &one.code, &other.code)
}
