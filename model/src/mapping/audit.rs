//! The audit of a map: a walk that finds every mistake of a map, if the percepts on it are right.
//!
//! The robot goes to the marker, walks a [certificate](crate::folding::certificate) of the map, and compares each
//! percept with the map. If it is already where it believes the marker to be, it first leaves and returns. If all agree,
//! the folded trail of the walk is the map. It is complete, so it is the world, however the map was made. If at most k
//! percepts of a run are false, k audits find a wrong map.

use super::{
    Contradiction, FACING, InvalidStep, MapWalk, Mapped, MappingError, MappingEvent, ObservedWorld,
    SafeguardEvent,
};
use crate::{
    aid::State,
    embedded_graph::{Dart, EmbeddedGraph, Vertex},
    folding::{MarkerTree, certificate_darts},
    percept::{Door, Percept},
    world::{GraphWorld, World},
};

/// A move of an audit after which the percept agreed with the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct AuditMove {
    /// Its number in the audit, from 1.
    pub number: u64,
    pub door: Door,
    pub percept: Percept,
    /// The robot's pose in the map.
    pub pose: Dart,
}

struct AuditWalk<'m, 'w, W, V> {
    believed: GraphWorld<'m>,
    world: &'w mut W,
    visit: V,
}

impl<'m, 'w, W: World, V: FnMut(&mut W, AuditMove)> AuditWalk<'m, 'w, W, V> {
    fn new(world: &'w mut W, map: &'m EmbeddedGraph, pose: Dart, visit: V) -> Self {
        let believed = GraphWorld::new(map, FACING);
        let placed = believed.state().placed;
        Self { believed: believed.at(State { pose, placed }), world, visit }
    }

    fn compare(&mut self) -> Mapped<W, Percept> {
        let perceived = self.world.percept().map_err(MappingError::World)?;
        let expected = self.believed.sensed();
        if perceived == expected {
            Ok(perceived)
        } else {
            Err(Contradiction::Audit { expected, perceived }.into())
        }
    }

    fn leave_by(&mut self, dart: Dart) -> Mapped<W> {
        let (map, pose) = (self.believed.graph(), self.believed.pose());
        let door = Door::between(map.index(pose), map.index(dart), map.degree_around(pose));
        self.world.traverse(door).map_err(MappingError::World)?;
        // The map has each of its doors.
        let _ = self.believed.traverse(door);
        let percept = self.compare()?;
        let (number, pose) = (self.believed.moves(), self.believed.pose());
        (self.visit)(self.world, AuditMove { number, door, percept, pose });
        Ok(())
    }

    fn go_up(&mut self, tree: &mut MarkerTree, to: Vertex) -> Mapped<W> {
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
/// agrees. Returns the moves, and the robot's pose in the map. It is an error if a percept is not as the map
/// predicts.
fn audit<W: World>(
    world: &mut W,
    map: &EmbeddedGraph,
    pose: Dart,
    visit: impl FnMut(&mut W, AuditMove),
) -> Mapped<W, (u64, Dart)> {
    let mut walk = AuditWalk::new(world, map, pose, visit);
    walk.compare()?;
    let marked = map.vertex(FACING);
    if map.vertex(pose) == marked {
        walk.leave_by(FACING)?;
    }
    walk.go_up(&mut MarkerTree::default(), marked)?;
    for dart in certificate_darts(map, marked) {
        walk.leave_by(dart)?;
    }
    Ok((walk.believed.moves(), walk.believed.pose()))
}

/// Audits a complete map some times. `visit` gets each move that agrees. Returns the robot's pose in the map, and
/// the number of percepts in each audit.
pub(crate) fn audit_times<W: ObservedWorld>(
    times: u32,
    world: &mut W,
    walk: &MapWalk,
    mut visit: impl FnMut(&mut W, AuditMove),
) -> Mapped<W, (Dart, Vec<u64>)> {
    let map = walk.map().complete().ok_or(InvalidStep::NoPlan)?;
    let (mut pose, mut percepts) = (walk.robot(), Vec::new());
    for _ in 0..times {
        world.event(walk, MappingEvent::Safeguard(SafeguardEvent::AuditBegun));
        let moves;
        (moves, pose) = audit(world, map, pose, &mut visit)?;
        // One before each move, and the last.
        percepts.push(moves + 1);
        world.event(walk, MappingEvent::Safeguard(SafeguardEvent::AuditPassed { moves }));
    }
    Ok((pose, percepts))
}

/// Goes to some darts of a map, one after the other, and takes each. Returns the robot's pose in the map. It is an
/// error if a percept is not as the map predicts.
pub(super) fn try_doors<W: World>(
    world: &mut W,
    map: &EmbeddedGraph,
    pose: Dart,
    doors: &[Dart],
) -> Mapped<W, Dart> {
    let mut walk = AuditWalk::new(world, map, pose, |_: &mut W, _| {});
    let mut tree = MarkerTree::default();
    for &dart in doors {
        walk.go_up(&mut tree, map.vertex(dart))?;
        walk.leave_by(dart)?;
    }
    Ok(walk.believed.pose())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        any_graph::{Class, starts},
        folding::certificate_length,
    };

    /// Of different starts, each is enumerated once, so no two of them are isomorphic.
    #[test]
    fn an_audit_accepts_the_map_of_the_world_and_no_other() {
        let starts: Vec<_> = (1..=3).flat_map(|edges| starts(Class::Multigraph, edges)).collect();
        assert_eq!(starts.len(), 86);
        for (number, graph) in starts.iter().enumerate() {
            for (other, map) in starts.iter().enumerate() {
                let mut world = GraphWorld::new(graph, FACING);
                let audited = audit(&mut world, map, FACING, |_, _| {});
                assert_eq!(audited.is_ok(), number == other, "{graph:?} {map:?}");
                if let Ok((moves, pose)) = audited {
                    assert_eq!(pose, world.pose());
                    let certificate = certificate_length(map, FACING) as u64;
                    assert!((certificate + 1..=certificate + 2).contains(&moves));
                }
            }
        }
    }
}
