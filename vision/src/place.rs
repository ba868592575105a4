//! What a robot sees of the places around it, by a camera or a laser scanner.
//!
//! A [`PlaceSensor`] turns a frame, and the odometry at its time, into a [`PlaceView`]. Robots that drive and checks of
//! logs use the same views; [`visits`](crate::visits) makes visits of them. Points and directions of a view are those of
//! its map: the local map of a laser scanner, and for a camera the frame of odometry.

use std::f64::consts::TAU;

use nalgebra::{Isometry2, Point2};
use toposlam_model::driving::{
    odometry::Odometry,
    scene::{Scene, wrapped},
};

pub trait PlaceSensor {
    /// What is sensed at once: a scan, or the scene in an image.
    type Frame;

    /// The view in a frame, and the odometry at its time; `None` if it shows nothing new, or has no place.
    fn view(&mut self, frame: &Self::Frame, odometry: &Odometry) -> Option<PlaceView>;

    /// How far one sees on the map of the last view, from a point in a direction and up to a limit, in metres. A camera sees
    /// no farther than its place.
    fn sight(&self, _from: Point2<f64>, _direction: f64, _limit: f64) -> f64 {
        0.0
    }
}

/// What is seen from one place.
#[derive(Clone, Debug)]
pub struct PlaceView {
    /// Where the robot is on the map.
    pub robot: Odometry,
    /// The motion from the frame of the map to that of odometry. It is right near the robot.
    pub odometry_from_map: Isometry2<f64>,
    /// Junctions, corners and dead ends. A possible arm counts: what is seen of it only suggests that it goes on.
    pub places: Vec<SeenPlace>,
    /// The same if the arms in doubt are arms, too: those that the sensor did not look into.
    pub possible_places: Vec<SeenPlace>,
    /// What was driven of the places and what is seen to end, if a whole log is viewed with it.
    pub facts: Option<PlaceFacts>,
    pub sector: ViewSector,
    /// The width of the way in which the robot is, between its walls, in metres; `None` by a camera, or if it is in no way.
    pub width: Option<f64>,
    /// What the places are read from, by a camera.
    pub scene: Option<Scene>,
}

/// What was driven of places, and what is seen to end.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlaceFacts {
    /// The places whose arms were driven.
    pub driven: Vec<SeenPlace>,
    /// The same if each way that is not seen to end is an arm.
    pub not_ended: Vec<SeenPlace>,
}

/// A place where ways meet: a junction with at least three arms, a corner with two, or a dead end with one.
#[derive(Clone, Debug, PartialEq)]
pub struct SeenPlace {
    pub centre: Point2<f64>,
    /// The distance from the centre to the nearest wall, in metres; 0 by a camera.
    pub clearance: f64,
    /// Clockwise.
    pub arms: Vec<PlaceArm>,
}

/// A way that may leave a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaceArm {
    pub direction: f64,
    pub certainty: Certainty,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Certainty {
    /// It was driven, or is seen beyond doubt.
    Certain,
    /// It can neither be shown nor excluded.
    Possible,
    /// Too little is seen of it, or its end.
    Excluded,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewSector {
    /// The first one, in radians counter-clockwise from the robot's heading.
    pub first: f64,
    /// The angle from the first one to the last, in radians.
    pub angle: f64,
}

impl ViewSector {
    /// The sector of a sensor that looks all around.
    pub const ALL_AROUND: Self = Self { first: 0.0, angle: TAU };

    /// The angle between a direction and the nearest one in which the sensor looks, in radians; 0 if it looks there.
    pub fn angle_off(&self, bearing: f64) -> f64 {
        let from_first = (bearing - self.first).rem_euclid(TAU);
        (from_first - self.angle).max(0.0).min(TAU - from_first)
    }
}

impl SeenPlace {
    /// The same place in another frame.
    #[must_use]
    pub fn moved(mut self, motion: &Isometry2<f64>) -> Self {
        self.centre = motion * self.centre;
        for arm in &mut self.arms {
            arm.direction = wrapped(arm.direction + motion.rotation.angle());
        }
        self
    }

    /// The directions of its arms, without those that are excluded.
    pub fn directions(&self) -> impl Iterator<Item = f64> + '_ {
        self.arms.iter().filter(|arm| arm.certainty != Certainty::Excluded).map(|arm| arm.direction)
    }
}

impl PlaceArm {
    pub fn certain(direction: f64) -> Self {
        Self { direction, certainty: Certainty::Certain }
    }

    pub fn is_certain(&self) -> bool {
        self.certainty == Certainty::Certain
    }
}

/// The index of the direction that is nearest to another one; the first one of several.
pub fn nearest_direction(directions: &[f64], to: f64) -> Option<usize> {
    let off = |index: &usize| wrapped(directions[*index] - to).abs();
    (0..directions.len()).min_by(|one, other| off(one).total_cmp(&off(other)))
}
