//! Shortest ways from the robot through the folded trail.

use crate::{embedded_graph::Dart, folding::FoldedTrail};

/// Shortest ways from the robot to each vertex of the folded trail. Of ways with equally many moves it
/// is the one that a breadth-first search finds first, with the darts of a vertex clockwise from the
/// first of its root.
#[derive(Clone, Debug, Default)]
pub(super) struct Ways {
    /// For each trail vertex that is a root.
    way: Vec<Way>,
    queue: Vec<Dart>,
}

/// A shortest way to a vertex.
#[derive(Clone, Copy, Debug)]
struct Way {
    moves: u32,
    /// The dart by which it comes in.
    entry: Dart,
}

/// The moves to a vertex that is not reached.
const UNREACHED: u32 = u32::MAX;

impl Ways {
    /// Finds the ways from the robot's present vertex.
    pub(super) fn find(&mut self, trail: &FoldedTrail) {
        let Self { way, queue } = self;
        let pose = trail.pose();
        way.clear();
        way.resize(trail.trail_vertex_count(), Way { moves: UNREACHED, entry: pose });
        way[trail.vertex(pose)].moves = 0;
        queue.clear();
        queue.push(pose);
        let mut next = 0;
        while let Some(&pose) = queue.get(next) {
            next += 1;
            let moves = way[trail.vertex(pose)].moves + 1;
            for dart in trail.darts_around(pose) {
                let Some(entry) = trail.opposite(dart) else { continue };
                let way = &mut way[trail.vertex(entry)];
                if way.moves == UNREACHED {
                    *way = Way { moves, entry };
                    queue.push(entry);
                }
            }
        }
    }

    /// The moves to a dart's vertex.
    #[inline]
    pub(super) fn moves_to(&self, trail: &FoldedTrail, dart: Dart) -> usize {
        self.way[trail.vertex(dart)].moves as usize
    }

    /// Writes the darts by which the robot leaves on its way to a dart's vertex.
    pub(super) fn darts_to(&self, trail: &FoldedTrail, dart: Dart, darts: &mut Vec<Dart>) {
        darts.clear();
        let mut at = dart;
        while let Way { moves: 1.., entry } = self.way[trail.vertex(at)]
            && let Some(before) = trail.opposite(entry)
        {
            darts.push(before);
            at = before;
        }
        darts.reverse();
    }
}
