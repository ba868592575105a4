//! Shortest ways from the robot through the folded trail.

use crate::clone_in_place::clone_in_place;
use crate::{embedded_graph::Dart, folding::FoldedTrail};

/// Shortest ways from the robot to each vertex of the folded trail. Of ways with equally many moves it
/// is the one that a breadth-first search finds first, with the darts of a vertex clockwise from the
/// first of its root.
#[derive(Debug, Default)]
pub(super) struct Ways {
    /// For each trail vertex that is a root.
    way: Vec<Way>,
    /// The moves after which the ways were found.
    found_after: Option<usize>,
    /// Scratch: the vertices that are reached, with the darts by which.
    queue: Vec<(Dart, usize)>,
}

clone_in_place!(Ways { way, found_after; scratch queue });

#[derive(Clone, Copy, Debug)]
struct Way {
    moves: u32,
    entry: Dart,
}

const UNREACHED: u32 = u32::MAX;

impl Ways {
    pub(super) fn clear(&mut self) {
        self.found_after = None;
    }

    /// Finds the ways from the robot's present vertex, unless they are known.
    pub(super) fn find(&mut self, trail: &FoldedTrail) {
        if self.found_after.replace(trail.moves()) != Some(trail.moves()) {
            self.find_from(trail, trail.pose());
        }
    }

    pub(super) fn find_from(&mut self, trail: &FoldedTrail, start: Dart) {
        let Self { way, queue, .. } = self;
        way.clear();
        way.resize(trail.trail_vertex_count(), Way { moves: UNREACHED, entry: start });
        let here = trail.vertex(start);
        way[here].moves = 0;
        queue.clear();
        queue.push((start, here));
        let mut next = 0;
        while let Some(&(pose, vertex)) = queue.get(next) {
            next += 1;
            let moves = way[vertex].moves + 1;
            trail.for_each_neighbour(pose, |entry, vertex| {
                let way = &mut way[vertex];
                if way.moves == UNREACHED {
                    *way = Way { moves, entry };
                    queue.push((entry, vertex));
                }
            });
        }
    }

    #[inline]
    pub(super) fn moves_to(&self, trail: &FoldedTrail, dart: Dart) -> usize {
        self.moves_to_vertex(trail.vertex(dart))
    }

    /// The moves to a vertex, with the number of its root.
    #[inline]
    pub(super) fn moves_to_vertex(&self, root: usize) -> usize {
        self.way[root].moves as usize
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
