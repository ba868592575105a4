//! A compass: the robot sees in which direction each door leads. The corridors of such a world are straight and run along
//! two axes.
//!
//! [`Directions::is_drawn_in_plane`] is the condition of R. Tamassia, "On embedding a graph in the grid with the minimum number
//! of bends" (1987), for edges without bends: the turns around each face are those of a polygon.

use thiserror::Error;

use crate::{
    direction::Direction,
    embedded_graph::{Dart, EmbeddedGraph},
    marker::{Marker, MarkerPart},
    percept::{CompassView, Door, Sighting},
};

/// The direction in which each dart of a graph leaves its vertex. The darts of a vertex have different directions, in
/// clockwise order; the two ends of an edge have opposite ones.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Directions(Vec<Direction>);

#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum DirectionsError {
    #[error("there are {directions} directions for {darts} darts")]
    Number { directions: usize, darts: usize },
    #[error("the directions of the darts around the vertex of dart {} are not in clockwise order", .0.0)]
    Order(Dart),
    #[error("the edge of dart {} is not straight", .0.0)]
    Bend(Dart),
}

impl Directions {
    /// # Errors
    /// Returns an error if these are not directions of straight corridors in this graph.
    pub fn new(graph: &EmbeddedGraph, directions: Vec<Direction>) -> Result<Self, DirectionsError> {
        let (number, darts) = (directions.len(), graph.dart_count());
        if number != darts {
            return Err(DirectionsError::Number { directions: number, darts });
        }
        let directions = Self(directions);
        for vertex in graph.vertices() {
            let corners = graph.darts_of(vertex).map(|dart| directions.corner(graph, dart));
            if corners.sum::<u32>() != 4 {
                return Err(DirectionsError::Order(graph.first_dart(vertex)));
            }
        }
        let is_straight = |&(one, other): &(Dart, Dart)| {
            directions.of(one).map(Direction::reversed) == directions.of(other)
        };
        match graph.edges().find(|edge| !is_straight(edge)) {
            Some((dart, _)) => Err(DirectionsError::Bend(dart)),
            None => Ok(directions),
        }
    }

    /// Every way to give directions to the corridors of a graph.
    pub fn every(graph: &EmbeddedGraph) -> Vec<Self> {
        let mut search = Search {
            graph,
            entries: entries(graph),
            direction: vec![None; graph.dart_count()],
            found: Vec::new(),
        };
        if graph.vertices().all(|vertex| graph.degree(vertex) <= 4) {
            search.extend(0);
        }
        search.found
    }

    /// `None` if the graph has no such dart.
    pub fn of(&self, dart: Dart) -> Option<Direction> {
        self.0.get(dart.at()).copied()
    }

    /// What a robot with a compass sees from a pose.
    pub fn view(&self, graph: &EmbeddedGraph, pose: Dart) -> CompassView {
        let doors = (0..graph.degree_around(pose)).map(|door| graph.behind(pose, Door(door)));
        CompassView::new(doors.filter_map(|dart| self.of(dart)))
    }

    /// The right angles between a dart and the next one clockwise, from 1 to 4.
    fn corner(&self, graph: &EmbeddedGraph, dart: Dart) -> u32 {
        let [here, next] = [dart, graph.clockwise(dart)].map(|dart| self.of(dart));
        let angles = here.zip(next).map_or(0, |(here, next)| here.right_angles_to(next));
        if angles == 0 { 4 } else { angles }
    }

    /// Whether the corridors can be drawn in the plane with these directions. Then the turns along each face add up to
    /// 360 degrees, but along the outer one to -360.
    pub fn is_drawn_in_plane(&self, graph: &EmbeddedGraph) -> bool {
        let mut seen = vec![false; graph.dart_count()];
        let mut outer_faces = 0;
        for first in graph.darts() {
            let (mut dart, mut turns) = (first, 0);
            if seen.get(first.at()) != Some(&false) {
                continue;
            }
            while let Some(seen) = seen.get_mut(dart.at()).filter(|seen| !**seen) {
                *seen = true;
                turns += 2 - i64::from(self.corner(graph, dart));
                dart = graph.opposite(graph.clockwise(dart));
            }
            match turns {
                4 => {}
                -4 => outer_faces += 1,
                _ => return false,
            }
        }
        outer_faces == 1
    }
}

/// For each vertex, breadth first, the dart by which it is discovered.
fn entries(graph: &EmbeddedGraph) -> Vec<Dart> {
    let mut met = vec![false; graph.vertex_count()];
    let mut entries: Vec<Dart> = Vec::new();
    let mut meet = |dart: Dart, entries: &mut Vec<Dart>| {
        if let Some(met) = met.get_mut(graph.vertex(dart).at()).filter(|met| !**met) {
            *met = true;
            entries.push(dart);
        }
    };
    meet(Dart(0), &mut entries);
    let mut next = 0;
    while let Some(&entry) = entries.get(next) {
        for dart in graph.darts_of(graph.vertex(entry)) {
            meet(graph.opposite(dart), &mut entries);
        }
        next += 1;
    }
    entries
}

struct Search<'g> {
    graph: &'g EmbeddedGraph,
    entries: Vec<Dart>,
    direction: Vec<Option<Direction>>,
    found: Vec<Directions>,
}

impl Search<'_> {
    /// Gives directions to the darts of the vertex with this place among the entries, in every way.
    fn extend(&mut self, place: usize) {
        let Some(&entry) = self.entries.get(place) else {
            let directions: Vec<_> = self.direction.iter().copied().flatten().collect();
            self.found.extend(Directions::new(self.graph, directions).ok());
            return;
        };
        let first: Vec<Direction> = match self.direction_behind(entry) {
            Some(direction) => vec![direction.reversed()],
            None => Direction::ALL.to_vec(),
        };
        let degree = self.graph.degree_around(entry);
        for direction in first {
            // Of the three other directions, those that have a door.
            for doors in (0..8_u32).filter(|doors| doors.count_ones() + 1 == degree) {
                let others = (1..4).filter(|turn| doors >> (turn - 1) & 1 == 1);
                let turns: Vec<u32> = std::iter::once(0).chain(others).collect();
                let darts = (0..degree).map(|door| self.graph.behind(entry, Door(door)));
                let darts: Vec<_> = darts.zip(turns).collect();
                for &(dart, turn) in &darts {
                    self.set(dart, Some(direction.turned(turn)));
                }
                let is_straight = |&(dart, turn): &(Dart, u32)| {
                    let behind = self.direction_behind(dart);
                    behind.is_none_or(|behind| behind.reversed() == direction.turned(turn))
                };
                if darts.iter().all(is_straight) {
                    self.extend(place + 1);
                }
                for &(dart, _) in &darts {
                    self.set(dart, None);
                }
            }
        }
    }

    fn direction_behind(&self, dart: Dart) -> Option<Direction> {
        self.direction.get(self.graph.opposite(dart).at()).copied().flatten()
    }

    fn set(&mut self, dart: Dart, direction: Option<Direction>) {
        if let Some(place) = self.direction.get_mut(dart.at()) {
            *place = direction;
        }
    }
}

/// The compass in a world with these directions. It lies nowhere.
#[derive(Clone, Copy, Debug)]
pub struct Compass<'d>(pub &'d Directions);

impl Marker for Compass<'_> {
    fn name(&self) -> &'static str {
        "compass"
    }

    fn about(&self) -> &'static str {
        "no marker, but a compass: in which direction does each door lead?"
    }

    fn sighting(&self, graph: &EmbeddedGraph, _facing: Dart, pose: Dart) -> Sighting {
        Sighting::Compass(self.0.view(graph, pose))
    }

    fn first_alike(&self, _graph: &EmbeddedGraph, _facing: Dart) -> Dart {
        Dart(0)
    }

    fn starts(&self, graph: &EmbeddedGraph, _facing: Dart) -> Vec<Dart> {
        graph.darts().collect()
    }

    fn parts(&self, _graph: &EmbeddedGraph, _facing: Dart) -> Vec<MarkerPart> {
        Vec::new()
    }
}
