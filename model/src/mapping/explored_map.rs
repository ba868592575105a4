//! The map that an explorer returns. Section 2.1.

use std::borrow::Cow;

use super::Flaw;
use crate::embedded_graph::{Dart, EmbeddedGraph};

/// What an explorer returns: a map, and the robot's pose in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExploredMap<'a> {
    pub graph: Cow<'a, EmbeddedGraph>,
    pub facing: Dart,
    pub pose: Dart,
}

impl ExploredMap<'_> {
    /// A map from its two permutations of the darts `0 .. 2m`: the other end of each dart's edge, and
    /// the next dart clockwise around its vertex. `facing` and `pose` are darts in that numbering.
    ///
    /// # Errors
    /// Returns an error if they are not the permutations of a connected graph, or a dart is missing.
    pub fn from_permutations(
        opposite: &[u32],
        clockwise: &[u32],
        facing: u32,
        pose: u32,
    ) -> Result<Self, Flaw> {
        let (graph, number) = EmbeddedGraph::from_permutations(opposite, clockwise)?;
        let dart = |dart: u32| number.get(dart as usize).copied().ok_or(Flaw::NoSuchDart { dart });
        let (facing, pose) = (dart(facing)?, dart(pose)?);
        Ok(Self { graph: Cow::Owned(graph), facing, pose })
    }

    /// A map from what is at the other end of each dart: for each vertex, and for each of its darts clockwise, a
    /// vertex and the index of a dart there. The facing dart is the first one of the first vertex. `pose` is the dart
    /// by which the robot has come in.
    ///
    /// # Errors
    /// Returns an error if an end is not known, if they are not those of a connected graph, or if there is no dart
    /// `pose`.
    pub fn from_far_ends(
        far: &[Vec<Option<(usize, u32)>>],
        pose: (usize, u32),
    ) -> Result<Self, Flaw> {
        let unexplored = far.iter().flatten().filter(|end| end.is_none()).count() as u32;
        if unexplored > 0 {
            return Err(Flaw::Unfinished { unexplored });
        }
        let mut first = Vec::with_capacity(far.len());
        let (mut dart_count, mut clockwise) = (0, Vec::new());
        for ends in far {
            let degree = ends.len() as u32;
            first.push(dart_count);
            clockwise.extend((0..degree).map(|index| dart_count + (index + 1) % degree));
            dart_count += degree;
        }
        // The number of a dart; no dart has the largest number.
        let number = |(vertex, index): (usize, u32)| match (first.get(vertex), far.get(vertex)) {
            (Some(first), Some(ends)) if (index as usize) < ends.len() => first + index,
            _ => u32::MAX,
        };
        let opposite: Vec<_> = far.iter().flatten().flatten().map(|&end| number(end)).collect();
        Self::from_permutations(&opposite, &clockwise, 0, number(pose))
    }
}
