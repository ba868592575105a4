//! A scene, the result of sensing one image: a hallway, a junction or neither, and the marker.
//! Section 3.
//!
//! Floor coordinates have the robot's centre as origin, x ahead and y to the left, in metres. Angles
//! are radians counter-clockwise seen from above, relative to the robot's heading, in (-pi, pi].

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::percept::Door;

#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    pub place: Place,
    pub marker: Option<MarkerView>,
}

/// The place of the robot, as sensed in one image.
// paper: sense.place
// paper: alg2.6
#[derive(Clone, Debug, PartialEq)]
pub enum Place {
    Hallway(HallwayView),
    Junction(JunctionView),
    Unknown(Reason),
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HallwayView {
    /// The hallway's direction, in (-pi/2, pi/2].
    pub heading: f64,
    /// From the robot's centre to the wall plane on its left, perpendicular, in metres.
    pub left: f64,
    /// The same on its right.
    pub right: f64,
    pub status: HallwayStatus,
    /// How well the view fits, from 0 to 1.
    pub confidence: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HallwayStatus {
    /// Nothing but two walls, or more only behind.
    Clear,
    /// Go on with care.
    Unclear(Unclear),
}

crate::words! {
    Unclear {
        ClustersAhead = "clusters-ahead",
        SizesDiffer = "sizes-differ",
        ClusterBehind = "cluster-behind",
    }
}

// paper: drive.junction
#[derive(Clone, Debug, PartialEq)]
pub struct JunctionView {
    /// The doors, clockwise from the entry door, and their centre lines; never empty.
    pub doors: Vec<CentreLine>,
    pub turning_point: [f64; 2],
    /// How well the view fits, from 0 to 1, in the direction in which it fits least.
    pub confidence: f64,
}

/// With less confidence a junction is only possible: furniture in a hallway looks like one. Views: of 11,200 views under
/// dense clutter, no junction that is not there had more than 0.51.
pub const CERTAIN: f64 = 0.55;

/// The middle of a hallway that ends at a junction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CentreLine {
    /// A point of it: the turning point.
    pub through: [f64; 2],
    /// Out of the junction.
    pub direction: f64,
}

crate::words! {
    /// Where the robot is along the entry centre line.
    Turning {
        Before = "before",
        /// Within [`AT`] of it.
        At = "at",
        Past = "past",
    }
}

/// How near the turning point counts as being at it, in metres along the entry centre line.
pub const AT: f64 = 0.10;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MarkerView {
    pub position: [f64; 2],
    /// The direction of its longer side, in (-pi/2, pi/2].
    pub axis: f64,
    /// At an L, the door that it points along; clockwise from the entry door.
    pub door: Option<Door>,
}

crate::words! {
    Reason {
        NoFloor = "no-floor",
        TooDark = "too-dark",
        Overexposed = "overexposed",
        /// The floor beside the robot has no common colour.
        MixedFloor = "mixed-floor",
        FewWalls = "few-walls",
        NothingFits = "nothing-fits",
        Ambiguous = "ambiguous",
    }
}

/// An angle brought into (-pi, pi].
pub fn wrapped(angle: f64) -> f64 {
    let angle = angle.rem_euclid(TAU);
    if angle > PI { angle - TAU } else { angle }
}

/// The direction of a line, for which opposite angles are the same, in (-pi/2, pi/2].
pub fn undirected(angle: f64) -> f64 {
    let angle = angle.rem_euclid(PI);
    if angle > FRAC_PI_2 { angle - PI } else { angle }
}

impl JunctionView {
    /// Whether this is a junction with these doors. Otherwise it may be another junction, or none.
    pub fn is_certain(&self) -> bool {
        self.confidence >= CERTAIN
    }

    /// How far the turning point is along the entry centre line, in metres: positive before it.
    pub fn distance(&self) -> f64 {
        let [x, y] = self.turning_point;
        let inwards = self.doors.first().map_or(0.0, |entry| entry.direction + PI);
        x * inwards.cos() + y * inwards.sin()
    }

    /// Where the robot is along the entry centre line.
    pub fn turning(&self) -> Turning {
        let distance = self.distance();
        if distance > AT {
            Turning::Before
        } else if distance < -AT {
            Turning::Past
        } else {
            Turning::At
        }
    }

    /// The same junction, entered by the door that lies nearest to a direction: the entry door as
    /// odometry carries it while the robot turns.
    #[must_use]
    pub fn entered_from(mut self, direction: f64) -> Self {
        let away = |door: &CentreLine| wrapped(door.direction - direction).abs();
        let nearest = (0..self.doors.len())
            .min_by(|&one, &other| away(&self.doors[one]).total_cmp(&away(&self.doors[other])));
        self.doors.rotate_left(nearest.unwrap_or(0));
        self
    }
}
