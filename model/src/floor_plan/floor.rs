//! The floor of a plan: the rectangles of its hallways, and where they may meet. Section 2.4.

use super::{FloorPlan, FloorPlanError, Hallway, TOLERANCE};
use crate::embedded_graph::Vertex;

/// A rectangle along the axes, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    pub least: [f64; 2],
    pub greatest: [f64; 2],
}

impl Rectangle {
    /// The least rectangle with both positions.
    pub fn around(one: [f64; 2], other: [f64; 2]) -> Self {
        Self {
            least: [one[0].min(other[0]), one[1].min(other[1])],
            greatest: [one[0].max(other[0]), one[1].max(other[1])],
        }
    }

    /// The rectangle with this middle, and half of its extent along each axis.
    pub fn centred(middle: [f64; 2], half: [f64; 2]) -> Self {
        let corner = |side: f64| [0, 1].map(|axis| middle[axis] + side * half[axis]);
        Self { least: corner(-1.0), greatest: corner(1.0) }
    }

    #[must_use]
    pub fn widened(self, margin: f64) -> Self {
        Self {
            least: self.least.map(|coordinate| coordinate - margin),
            greatest: self.greatest.map(|coordinate| coordinate + margin),
        }
    }

    /// Whether the position is in the rectangle or on its border.
    pub fn holds(&self, position: [f64; 2]) -> bool {
        let point = Self { least: position, greatest: position };
        self.meets(&point)
    }

    /// Whether the rectangles have a point in common; touching counts.
    pub fn meets(&self, other: &Self) -> bool {
        (0..2).all(|axis| {
            self.least[axis] <= other.greatest[axis] && other.least[axis] <= self.greatest[axis]
        })
    }
}

impl FloorPlan {
    /// The floor: for each hallway, in their order, its rectangle from junction to junction,
    /// widened by half the hallway width on all sides. Walls stand on the border of their union.
    pub fn floor(&self) -> impl ExactSizeIterator<Item = Rectangle> + '_ {
        self.hallways.iter().map(|&hallway| self.middle(hallway).widened(self.hallway_width / 2.0))
    }

    fn middle(&self, hallway: Hallway) -> Rectangle {
        Rectangle::around(self.position(hallway.from), self.position(hallway.to))
    }

    fn position(&self, vertex: Vertex) -> [f64; 2] {
        self.junctions[vertex.at()].position
    }

    fn ends(&self, hallway: Hallway) -> [String; 2] {
        [hallway.from, hallway.to].map(|vertex| self.junction(vertex).name.clone())
    }
}

/// Rejects junctions that are too close, and floors that meet outside a shared junction.
pub(super) fn check(plan: &FloorPlan) -> Result<(), FloorPlanError> {
    junctions_off_foreign_hallways(plan)?;
    floors_apart(plan)?;
    junctions_apart(plan)
}

fn junctions_off_foreign_hallways(plan: &FloorPlan) -> Result<(), FloorPlanError> {
    for (&hallway, floor) in plan.hallways.iter().zip(plan.floor()) {
        for (vertex, junction) in plan.graph.vertices().zip(&plan.junctions) {
            let ends_there = vertex == hallway.from || vertex == hallway.to;
            if !ends_there && floor.holds(junction.position) {
                let ([from, to], junction) = (plan.ends(hallway), junction.name.clone());
                return Err(FloorPlanError::OnHallway { junction, from, to });
            }
        }
    }
    Ok(())
}

fn floors_apart(plan: &FloorPlan) -> Result<(), FloorPlanError> {
    let floors: Vec<_> = plan.hallways.iter().copied().zip(plan.floor()).collect();
    for (number, &(hallway, floor)) in floors.iter().enumerate() {
        // A gap caused by rounding does not count.
        let floor = floor.widened(TOLERANCE);
        for &(earlier, earlier_floor) in &floors[..number] {
            // Hallways that share a junction leave it in different directions, so that their
            // floors share just the junction's square.
            let ends = [earlier.from, earlier.to];
            let shared = ends.contains(&hallway.from) || ends.contains(&hallway.to);
            if !shared && floor.meets(&earlier_floor) {
                let (one, other) = (plan.ends(earlier), plan.ends(hallway));
                let cross = plan.middle(hallway).meets(&plan.middle(earlier));
                return Err(if cross {
                    FloorPlanError::Cross { one, other }
                } else {
                    FloorPlanError::FloorsMeet { one, other }
                });
            }
        }
    }
    Ok(())
}

fn junctions_apart(plan: &FloorPlan) -> Result<(), FloorPlanError> {
    let least = 2.0 * plan.hallway_width;
    for (number, junction) in plan.junctions.iter().enumerate() {
        for earlier in &plan.junctions[..number] {
            let [x, y] = [0, 1].map(|axis| junction.position[axis] - earlier.position[axis]);
            let distance = x.hypot(y);
            if distance < least - TOLERANCE {
                let (one, other) = (earlier.name.clone(), junction.name.clone());
                return Err(FloorPlanError::TooClose { one, other, distance, least });
            }
        }
    }
    Ok(())
}
