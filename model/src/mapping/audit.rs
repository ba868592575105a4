//! The audit of a map: a walk that finds every mistake of a map, if the percepts on it are right.
//!
//! The robot goes to the marker and walks a [certificate](crate::folding::certificate) of the map. It
//! compares each percept with the map. If it is already where it believes the marker to be, it first leaves
//! and returns, because the percept that it has of the place is one of those with which the map was made.
//! If all agree, the folded trail of the walk is the map. It is complete, so it is the world, however the
//! map was made. No shorter walk from the marker can show that.
//!
//! A map is wrong only if a percept was false while it was made. So if at most k percepts of a run are
//! false, at most k - 1 of them are in audits of a wrong map, and k audits find it.

use thiserror::Error;

use super::{Contradiction, MappingError};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph, Vertex},
    folding::{MarkerTree, certificate_darts},
    percept::{Door, Percept},
    world::{GraphWorld, State, World},
};

/// An audit in which every percept agreed with the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Audit {
    /// The moves of the audit.
    pub moves: u64,
    /// The robot's pose in the map at its end.
    pub pose: Dart,
}

impl Audit {
    /// The number of percepts: one before each move, and the last.
    #[must_use]
    pub fn percepts(&self) -> u64 {
        self.moves + 1
    }
}

/// A move of an audit after which the percept agreed with the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AuditMove {
    /// The door taken.
    pub door: Door,
    /// The percept behind it.
    pub percept: Percept,
    /// The robot's pose in the map.
    pub pose: Dart,
}

/// Why an audit ended early.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum AuditError<E> {
    /// Sensing or moving failed.
    #[error(transparent)]
    World(E),
    /// The map, the robot's pose in it, or a percept is wrong.
    #[error(
        "after {moves} moves of the audit, the map predicts {expected}; perceived: {perceived}"
    )]
    Mismatch {
        /// The moves of the audit until then.
        moves: u64,
        /// The percept by the map.
        expected: Percept,
        /// The percept.
        perceived: Percept,
    },
}

/// Walks through a world and compares it with a map.
struct AuditWalk<'m, 'w, W, V> {
    /// The world as the map has it.
    believed: GraphWorld<'m>,
    world: &'w mut W,
    visit: V,
}

/// A mismatch is a contradiction of the percepts.
impl<E> From<AuditError<E>> for MappingError<E> {
    fn from(error: AuditError<E>) -> Self {
        match error {
            AuditError::World(error) => Self::World(error),
            AuditError::Mismatch { expected, perceived, .. } => {
                Contradiction::Audit { expected, perceived }.into()
            }
        }
    }
}

impl<W: World, V: FnMut(&mut W, AuditMove)> AuditWalk<'_, '_, W, V> {
    fn compare(&mut self) -> Result<Percept, AuditError<W::Error>> {
        let perceived = self.world.percept().map_err(AuditError::World)?;
        let (moves, expected) = (self.believed.moves(), self.believed.sensed());
        if perceived == expected {
            Ok(perceived)
        } else {
            Err(AuditError::Mismatch { moves, expected, perceived })
        }
    }

    /// Leaves by a dart of the map at the robot's vertex.
    fn leave_by(&mut self, dart: Dart) -> Result<(), AuditError<W::Error>> {
        let (map, pose) = (self.believed.graph(), self.believed.pose());
        let door = Door::between(map.index(pose), map.index(dart), map.degree_around(pose));
        self.world.traverse(door).map_err(AuditError::World)?;
        // The map has each of its doors.
        let _ = self.believed.traverse(door);
        let percept = self.compare()?;
        (self.visit)(self.world, AuditMove { door, percept, pose: self.believed.pose() });
        Ok(())
    }

    /// Goes to a vertex of the map by a shortest way.
    fn go_up(&mut self, tree: &mut MarkerTree, to: Vertex) -> Result<(), AuditError<W::Error>> {
        let map = self.believed.graph();
        tree.grow(map, to);
        let mut at = map.vertex(self.believed.pose());
        while at != to {
            self.leave_by(tree.up(at))?;
            at = map.vertex(self.believed.pose());
        }
        Ok(())
    }
}

/// Audits a map that the robot has made of a world, with a directional marker. `visit` gets each move that
/// agrees.
///
/// # Errors
/// Returns an error if the world does, or at the first percept that is not as the map predicts.
pub fn audit<W: World>(
    world: &mut W,
    map: &EmbeddedGraph,
    facing: Dart,
    pose: Dart,
    visit: impl FnMut(&mut W, AuditMove),
) -> Result<Audit, AuditError<W::Error>> {
    let believed = GraphWorld::new(map, facing);
    let placed = believed.state().placed;
    let mut walk = AuditWalk { believed: believed.at(State { pose, placed }), world, visit };
    walk.compare()?;
    let marked = map.vertex(facing);
    if map.vertex(pose) == marked {
        walk.leave_by(facing)?;
    }
    walk.go_up(&mut MarkerTree::default(), marked)?;
    for dart in certificate_darts(map, marked) {
        walk.leave_by(dart)?;
    }
    Ok(Audit { moves: walk.believed.moves(), pose: walk.believed.pose() })
}

/// Goes to some darts of a map, one after the other, and takes each. Returns the robot's pose in the map.
///
/// # Errors
/// Returns an error if the world does, or at the first percept that is not as the map predicts.
pub(super) fn try_doors<W: World>(
    world: &mut W,
    map: &EmbeddedGraph,
    facing: Dart,
    pose: Dart,
    doors: &[Dart],
) -> Result<Dart, AuditError<W::Error>> {
    let believed = GraphWorld::new(map, facing);
    let placed = believed.state().placed;
    let believed = believed.at(State { pose, placed });
    let mut walk = AuditWalk { believed, world, visit: |_: &mut W, _| {} };
    let mut tree = MarkerTree::default();
    for &dart in doors {
        walk.go_up(&mut tree, map.vertex(dart))?;
        walk.leave_by(dart)?;
    }
    Ok(walk.believed.pose())
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use super::*;
    use crate::{
        enumerate::{Class, Each, EnumeratedGraph, Enumeration},
        folding::certificate_length,
    };

    fn starts(edges: usize) -> Vec<EmbeddedGraph> {
        let mut starts = Vec::new();
        let all = Enumeration::new(Each::Start, Class::Multigraph, edges).unwrap();
        let _: ControlFlow<()> = all.for_each(&mut |found: EnumeratedGraph| {
            starts.push(found.graph.clone());
            ControlFlow::Continue(())
        });
        starts
    }

    /// Of different starts, each is enumerated once, so no two of them are isomorphic.
    #[test]
    fn an_audit_accepts_the_map_of_the_world_and_no_other() {
        let starts: Vec<_> = (1..=3).flat_map(starts).collect();
        assert_eq!(starts.len(), 86);
        for (number, graph) in starts.iter().enumerate() {
            for (other, map) in starts.iter().enumerate() {
                let mut world = GraphWorld::new(graph, Dart(0));
                let audited = audit(&mut world, map, Dart(0), Dart(0), |_, _| {});
                assert_eq!(audited.is_ok(), number == other, "{graph:?} {map:?}");
                if let Ok(audited) = audited {
                    assert_eq!(audited.pose, world.pose());
                    let certificate = certificate_length(map, Dart(0)) as u64;
                    assert!((certificate + 1..=certificate + 2).contains(&audited.moves));
                }
            }
        }
    }
}
