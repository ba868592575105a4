//! The parameters of the inference of events, in one place: one struct for laser scans, one for the scenes of a camera.
//!
//! Lengths are in metres and angles in radians. They are the same for all buildings; those of sensing, which a file sets,
//! are [`LaserParams`](toposlam_vision::laser::params::LaserParams). The values are for robots that are smaller than their
//! corridors are wide. Change those that are compared with the width of a corridor, 2 m, for another building.

use std::f64::consts::{FRAC_PI_6, PI};

use toposlam_vision::params;

params! {
    /// Events from laser scans.
    LaserEventParams {
        /// A robot within this distance of where it was before goes back. Less than half of a corridor.
        retraced: f64 = 0.6,
        /// A robot that has not driven farther than this since the log began was always there.
        beginning: f64 = 2.0,
        /// A robot has turned back once it has gone back for half of this length. Less is manoeuvring.
        turned_back: f64 = 4.0,
        /// A place that is a junction if arms in doubt count, in fewer views than this, is no doubt.
        doubted_views: usize = 2,
        /// A robot is inside of a junction up to its walls, and at least this near to its centre.
        inside: f64 = 1.0,
        /// The entry and the exit of a visit are arms if they are as near to one that is seen.
        same_arm: f64 = 0.8,
        /// An arm by which the robot came or left counts if it is seen in this part of the views.
        traversed: f64 = 0.25,
        /// A junction that was not seen on this length of the way is forgotten.
        junction_memory: f64 = 30.0,
        /// A robot whose way bends by more than this turns back, and passes no corner.
        sharpest_bend: f64 = 2.2,
        /// For bends, the way is remembered for this many times the length of an arm
        /// ([`CornerParams::arm`](toposlam_vision::laser::params::CornerParams::arm)).
        bend_memory: f64 = 8.0,
        /// The direction of a robot's way is compared with the field of view over this length.
        unseen_step: f64 = 0.5,
        /// If a scanner looks within this angle of the robot's way, it sees the hallway there.
        unseen_angle: f64 = PI / 24.0,
        /// A way of this length on which the scanner does not look ahead may pass a junction. A shorter one is
        /// manoeuvring.
        unseen_way: f64 = 2.0,
        /// A junction contains a marked place that is at most this much farther from its centre than its walls: half of
        /// the shortest way between two junctions.
        marked_beside: f64 = 1.5,
    }

    /// Events from the scenes of a camera.
    SceneEventParams {
        /// A junction is visited if its turning point comes this near.
        near: f64 = 0.3,
        /// A robot that leaves by more than this off every door takes none.
        aside: f64 = FRAC_PI_6,
        /// A turning point this far from the last one is of another junction.
        another: f64 = 1.5,
        /// A robot this far from the turning point has left the junction. Nearer, a hallway is ignored.
        away: f64 = 0.6,
    }
}

/// The parameters of events from laser scans.
pub(crate) const LASER: LaserEventParams = LaserEventParams::DEFAULT;
/// The parameters of events from scenes.
pub(crate) const SCENES: SceneEventParams = SceneEventParams::DEFAULT;
