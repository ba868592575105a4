//! What Algorithm 1 leaves open: which unexplored edge next (line 5), which hypothesis next
//! (line 9).

use super::{partial_map::PartialMap, tree::Tree};
use crate::embedded_graph::Dart;

/// Resolves what Algorithm 1 leaves open.
pub trait Choices {
    /// Line 5: one of the unexplored darts of the map, of which there is at least one. `paths` is
    /// the tree that grows from the robot's vertex.
    fn next_edge(&mut self, map: &PartialMap, paths: &mut Tree) -> Option<Dart>;

    /// Line 9: the place in `hypotheses` (never empty) of the one to follow next. They stand from
    /// the farthest to the nearest, so that the default is the last.
    fn next_hypothesis(&mut self, map: &PartialMap, hypotheses: &[Dart]) -> usize {
        let _ = map;
        hypotheses.len() - 1
    }
}

/// The default: everything by the fewest hops; then the vertex discovered first; then the lowest
/// index. So every run of everyone is the same run.
// paper: cost.cycle, cost.chain
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Nearest;

impl Choices for Nearest {
    #[inline]
    fn next_edge(&mut self, map: &PartialMap, paths: &mut Tree) -> Option<Dart> {
        paths.nearest_unexplored(map)
    }
}
