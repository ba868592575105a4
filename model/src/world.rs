//! The seam of the whole system: all that a robot can sense of its world and do in it. Section 2.1.

use thiserror::Error;

use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    marker::{Directional, Marker},
    percept::{Door, Percept},
};

/// All that a robot can sense of its world, and all that it can do in it.
// paper: world.interface, percept.no-metric
pub trait World {
    /// What can go wrong with sensing or moving.
    type Error;

    /// What the robot senses where it is. At the very start, this is the marked vertex, with the
    /// facing dart as entry dart.
    ///
    /// # Errors
    /// Where the world cannot be sensed.
    fn percept(&mut self) -> Result<Percept, Self::Error>;

    /// Leaves by a door and goes to the other end of the edge.
    ///
    /// # Errors
    /// Where the robot cannot go.
    // paper: motion.door, motion.arrival
    fn traverse(&mut self, door: Door) -> Result<(), Self::Error>;
}

/// The robot chose a door that its vertex does not have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("door {} was taken at a vertex with {degree} doors", door.0)]
pub struct NoSuchDoor {
    /// The door.
    pub door: Door,
    /// The degree of the vertex.
    pub degree: u32,
}

/// An embedded graph with a marker and a robot in it, as a [`World`].
#[derive(Clone, Debug)]
pub struct GraphWorld<'g, M = Directional> {
    graph: &'g EmbeddedGraph,
    marker: M,
    pose: Dart,
}

impl<'g> GraphWorld<'g> {
    /// The world of a start: the directional marker lies at the start vertex and points along the
    /// facing dart, which is one of the graph's, and the robot's entry dart.
    #[must_use]
    pub fn new(graph: &'g EmbeddedGraph, facing: Dart) -> Self {
        Self::with_marker(graph, Directional { along: facing }, facing)
    }
}

impl<'g, M> GraphWorld<'g, M> {
    /// A world with any marker that stays where it is, and a robot that has come in by a dart of it.
    #[must_use]
    pub fn with_marker(graph: &'g EmbeddedGraph, marker: M, facing: Dart) -> Self {
        Self { graph, marker, pose: facing }
    }

    /// The embedded graph.
    #[must_use]
    pub fn graph(&self) -> &'g EmbeddedGraph {
        self.graph
    }

    /// Where the robot truly is.
    #[must_use]
    pub fn pose(&self) -> Dart {
        self.pose
    }
}

impl<M: Marker> World for GraphWorld<'_, M> {
    type Error = NoSuchDoor;

    #[inline]
    fn percept(&mut self) -> Result<Percept, NoSuchDoor> {
        Ok(Percept {
            degree: self.graph.degree_around(self.pose),
            sighting: self.marker.sighting(self.graph, self.pose),
        })
    }

    #[inline]
    fn traverse(&mut self, door: Door) -> Result<(), NoSuchDoor> {
        let degree = self.graph.degree_around(self.pose);
        if door.0 >= degree {
            return Err(NoSuchDoor { door, degree });
        }
        self.pose = self.graph.after(self.pose, door);
        Ok(())
    }
}
