//! Floor plans: hallways with geometry, and their embedded graph. Section 2.4.
//!
//! Hallways run along the axes, x to the east and y to the north, and meet at junctions that are
//! dead ends, Ls or Ts. Clockwise is clockwise seen from above.

mod error;
mod floor;
mod walls;

use std::collections::HashMap;

pub use crate::direction::Direction;
pub use error::FloorPlanError;
pub use floor::Rectangle;
pub use walls::{BuildingWall, walls};

use crate::{
    direction::TOLERANCE,
    driving::visit::JunctionShape,
    embedded_graph::{Dart, EmbeddedGraph, Vertex},
    similar::similar_name,
};

// paper: env.junction-types
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum JunctionKind {
    DeadEnd,
    /// Two doors at a right angle.
    L,
    T,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Junction {
    pub name: String,
    /// Where its turning point is, in metres, x to the east and y to the north.
    pub position: [f64; 2],
    pub kind: JunctionKind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hallway {
    pub from: Vertex,
    pub to: Vertex,
}

#[derive(Clone, Debug, PartialEq)]
pub struct FloorPlan {
    hallway_width: f64,
    junctions: Vec<Junction>,
    hallways: Vec<Hallway>,
    graph: EmbeddedGraph,
    directions: Vec<Direction>,
}

impl FloorPlan {
    /// A floor plan from the width of its hallways, its junctions, each with a name and a position,
    /// and its hallways, each with the names of its two junctions; all in metres.
    ///
    /// The junctions are the vertices of the embedded graph, in the order given; the darts of each
    /// stand clockwise from north. Checking the floors is quadratic in the size of the plan.
    ///
    /// # Errors
    /// Returns the first error, with the names of its junctions and hallways.
    pub fn new(
        hallway_width: f64,
        junctions: &[(String, [f64; 2])],
        hallways: &[(String, String)],
    ) -> Result<Self, FloorPlanError> {
        if !(hallway_width.is_finite() && hallway_width > 0.0) {
            return Err(FloorPlanError::HallwayWidth { width: hallway_width });
        }
        let hallways = between_known_junctions(junctions, hallways)?;
        let doors = doors(junctions, &hallways)?;
        let junctions = junctions
            .iter()
            .zip(&doors)
            .map(|((name, position), doors)| {
                Ok(Junction { kind: kind(name, doors)?, name: name.clone(), position: *position })
            })
            .collect::<Result<Vec<_>, FloorPlanError>>()?;
        let lists: Vec<(&str, Vec<&str>)> = junctions
            .iter()
            .zip(&doors)
            .map(|(junction, doors)| {
                let neighbours = doors.iter().flatten();
                let names = neighbours.map(|&vertex| junctions[vertex.at()].name.as_str());
                (junction.name.as_str(), names.collect())
            })
            .collect();
        let graph = EmbeddedGraph::from_neighbour_lists(&lists)?;
        let directions = doors
            .iter()
            .flat_map(|doors| Direction::ALL.into_iter().zip(doors))
            .filter_map(|(direction, door)| door.map(|_| direction))
            .collect();
        let plan = Self { hallway_width, junctions, hallways, graph, directions };
        floor::check(&plan)?;
        Ok(plan)
    }

    /// The width of every hallway, from wall to wall, in metres.
    pub fn hallway_width(&self) -> f64 {
        self.hallway_width
    }

    /// The junctions; the one at index `i` is vertex `i`.
    pub fn junctions(&self) -> &[Junction] {
        &self.junctions
    }

    pub fn junction(&self, vertex: Vertex) -> &Junction {
        &self.junctions[vertex.at()]
    }

    pub fn hallways(&self) -> &[Hallway] {
        &self.hallways
    }

    /// The embedded graph of the plan. It is planar.
    // paper: env.hallways
    pub fn graph(&self) -> &EmbeddedGraph {
        &self.graph
    }

    /// Where the dart's hallway leads, seen from the dart's junction.
    pub fn direction(&self, dart: Dart) -> Direction {
        self.directions[dart.at()]
    }

    /// The shape of a junction, seen from the entry by a dart.
    pub fn shape(&self, entry: Dart) -> JunctionShape {
        let first = self.direction(entry) as usize;
        let mut doors = [false; 4];
        for door in self.graph.darts_of(self.graph.vertex(entry)) {
            doors[(self.direction(door) as usize + 4 - first) % 4] = true;
        }
        JunctionShape(doors)
    }
}

/// The hallways as pairs of vertices. Rejects junctions and hallways that are invalid by themselves.
fn between_known_junctions(
    junctions: &[(String, [f64; 2])],
    hallways: &[(String, String)],
) -> Result<Vec<Hallway>, FloorPlanError> {
    let mut vertices = HashMap::new();
    for (number, (name, position)) in junctions.iter().enumerate() {
        let junction = name.clone();
        if !position.iter().all(|coordinate| coordinate.is_finite()) {
            return Err(FloorPlanError::Position { junction, position: *position });
        }
        if vertices.insert(name, Vertex(number as u32)).is_some() {
            return Err(FloorPlanError::JunctionTwice { junction });
        }
    }
    let known = |number, name| {
        let vertex = vertices.get(name).copied();
        vertex.ok_or_else(|| FloorPlanError::UnknownJunction {
            number,
            junction: String::clone(name),
            similar: similar_name(name, junctions.iter().map(|(known, _)| known.as_str())),
        })
    };
    let ends = hallways.iter().enumerate();
    ends.map(|(number, (from, to))| {
        Ok(Hallway { from: known(number, from)?, to: known(number, to)? })
    })
    .collect()
}

/// For each junction, the junction behind its door in each direction.
fn doors(
    junctions: &[(String, [f64; 2])],
    hallways: &[Hallway],
) -> Result<Vec<[Option<Vertex>; 4]>, FloorPlanError> {
    let name = |vertex: Vertex| junctions[vertex.at()].0.clone();
    let mut doors = vec![[None; 4]; junctions.len()];
    for &Hallway { from, to } in hallways {
        if from == to {
            return Err(FloorPlanError::NoLength { junction: name(from) });
        }
        let Some(direction) = Direction::between(junctions[from.at()].1, junctions[to.at()].1)
        else {
            return Err(FloorPlanError::NotAlongAxis { from: name(from), to: name(to) });
        };
        let ends = [(from, to, direction), (to, from, direction.reversed())];
        for (here, there, direction) in ends {
            match doors[here.at()][direction as usize].replace(there) {
                None => {}
                Some(earlier) if earlier == there => {
                    return Err(FloorPlanError::HallwayTwice { from: name(from), to: name(to) });
                }
                Some(earlier) => {
                    let [junction, one, other] = [here, earlier, there].map(name);
                    return Err(FloorPlanError::SameDirection { junction, one, other });
                }
            }
        }
    }
    Ok(doors)
}

fn kind(name: &str, doors: &[Option<Vertex>; 4]) -> Result<JunctionKind, FloorPlanError> {
    let doors = match doors.iter().flatten().count() {
        1 => return Ok(JunctionKind::DeadEnd),
        2 if doors[0].is_some() != doors[2].is_some() => return Ok(JunctionKind::L),
        3 => return Ok(JunctionKind::T),
        0 => "no door",
        2 => "two doors opposite each other",
        _ => "four doors",
    };
    Err(FloorPlanError::NotAKind { junction: name.to_owned(), doors })
}

#[cfg(test)]
mod tests;
