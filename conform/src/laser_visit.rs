//! A visit by laser: where the robot came in and left, and what several views of the place show.

use std::f64::consts::PI;

use nalgebra::{Isometry2, Point2};
use toposlam_model::driving::scene::wrapped;
use toposlam_vision::laser::params::{CornerParams, LaserParams};

use super::{
    events::{EventSource, UndecidedCause},
    params::LASER,
    seen_junctions::SeenArm,
};

/// A visit.
#[derive(Clone, Debug)]
pub(super) struct Visit {
    pub kind: VisitKind,
    pub source: EventSource,
    pub centre: Point2<f64>,
    pub clearance: f64,
    /// The direction from the centre to where the robot came in; `None` if the log begins there.
    pub entry: Option<f64>,
    /// The direction to where it left, and the length of its way then.
    pub exit: Option<(f64, f64)>,
    /// Where and when it left.
    pub left: EventSource,
    /// Whether the robot turned back on its way to the junction.
    pub turned_back: bool,
    /// To the frame of odometry, in which events are reported, from that of the local map.
    pub odometry_from_map: Isometry2<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum VisitKind {
    /// Of a junction, or of a corner in which the log begins, ends, or the robot turns back.
    Junction,
    /// Of a place that is a junction only if arms in doubt count.
    PossibleJunction,
    DeadEnd,
    /// Of a corner that the robot passed: the length of its way to there, and whether it is in doubt.
    Bend {
        way: f64,
        in_doubt: bool,
    },
    /// Of no place: the robot drove in a direction in which the scanner does not look.
    UnseenWay,
}

/// What the views of a visited place show.
pub(super) enum PlaceEstimate {
    /// No vertex.
    NoVertex,
    /// They do not decide what it is.
    Undecided(UndecidedCause),
    /// The directions of its doors.
    Doors(Vec<f64>),
}

impl Visit {
    /// What the views of the place show.
    pub(super) fn estimate(&self, arms: &[SeenArm], params: &LaserParams) -> PlaceEstimate {
        let CornerParams { corners, min_turn, .. } = params.corner;
        let params = &params.visit;
        let exit = self.exit.map(|(exit, _)| exit);
        // Where the robot went on, its own way shows whether there is a corner.
        let went_on = self.entry.zip(exit).is_some_and(|(entry, exit)| !is_same_arm(entry, exit));
        let is_corner = |one: f64, other: f64| {
            corners && !went_on && PI - wrapped(one - other).abs() >= min_turn
        };
        let is_traversed = |arm: &SeenArm| {
            let mut ways = [self.entry, exit].into_iter().flatten();
            ways.any(|way| is_same_arm(way, arm.direction))
        };
        let counts = |arm: &&SeenArm| {
            arm.part >= params.agree || is_traversed(arm) && arm.part >= LASER.traversed
        };
        let is_doubtful =
            |arm: &SeenArm| (arm.part - params.agree).abs() < params.doubt && !is_traversed(arm);
        let doors: Vec<f64> = arms.iter().filter(counts).map(|arm| arm.direction).collect();
        let is_vertex = match (self.kind, &doors[..]) {
            (VisitKind::DeadEnd, [_])
            | (VisitKind::Junction | VisitKind::PossibleJunction, [_, _, _, ..]) => true,
            // A corridor goes straight on where no arm of a junction is left.
            (VisitKind::Junction, &[one, other]) => is_corner(one, other),
            _ => false,
        };
        if !is_vertex {
            PlaceEstimate::NoVertex
        } else if arms.iter().any(is_doubtful) {
            PlaceEstimate::Undecided(UndecidedCause::Unclear)
        } else {
            PlaceEstimate::Doors(doors)
        }
    }
}

/// Whether two directions are of one arm.
pub(super) fn is_same_arm(one: f64, other: f64) -> bool {
    wrapped(one - other).abs() < LASER.same_arm
}
