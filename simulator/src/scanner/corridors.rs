//! Plans of corridors at any angle and of any width, with round lobbies.

use nalgebra::{Point2, Vector2};
use toposlam_model::floor_plan::FloorPlan;
use toposlam_vision::geometry::{direction, unit};

use super::polygon::{ConvexPolygon, Segment, length};

/// The corridors of a building. A floor plan is one in which they run along the axes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CorridorPlan {
    pub corridors: Vec<Corridor>,
    pub lobbies: Vec<Lobby>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corridor {
    /// The ends of its middle line, in metres; its floor goes on for half of its width behind them.
    pub ends: Segment,
    /// From wall to wall, in metres.
    pub width: f64,
}

/// A round lobby, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lobby {
    pub middle: Point2<f64>,
    pub radius: f64,
}

/// The number of corners of a lobby: with 5 m across, its wall is at most 3 mm off the circle.
const ROUND: u32 = 64;

impl Corridor {
    pub fn length(&self) -> f64 {
        length(self.ends)
    }

    /// The point at a distance from its first end, and to the left of its middle line, in metres.
    pub fn point(&self, along: f64, left: f64) -> Point2<f64> {
        let onwards = unit(self.direction());
        self.ends[0] + along * onwards + left * Vector2::new(-onwards.y, onwards.x)
    }

    /// The direction from its first end to the other, in radians.
    pub fn direction(&self) -> f64 {
        let [from, to] = self.ends;
        direction(from, to)
    }

    pub fn floor(&self) -> ConvexPolygon {
        ConvexPolygon::along(self.ends, self.width, self.width / 2.0)
    }
}

impl CorridorPlan {
    /// The floor: its corridors, then its lobbies.
    pub fn floor(&self) -> Vec<ConvexPolygon> {
        let lobby = |lobby: &Lobby| ConvexPolygon::round(lobby.middle, lobby.radius, ROUND);
        let corridors = self.corridors.iter().map(Corridor::floor);
        corridors.chain(self.lobbies.iter().map(lobby)).collect()
    }
}

impl From<&FloorPlan> for CorridorPlan {
    fn from(plan: &FloorPlan) -> Self {
        let corridors = plan.hallways().iter().map(|hallway| Corridor {
            ends: [hallway.from, hallway.to].map(|vertex| plan.junction(vertex).position.into()),
            width: plan.hallway_width(),
        });
        Self { corridors: corridors.collect(), lobbies: Vec::new() }
    }
}
