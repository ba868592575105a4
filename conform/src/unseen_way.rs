//! Where a robot drives in a direction in which its laser scanner does not look: backwards, with a scanner that
//! sees half of a circle. It may pass junctions there that no scan shows.

use std::f64::consts::PI;

use toposlam_model::driving::odometry::Odometry;
use toposlam_vision::laser::{
    plane::{direction, distance},
    scan::Scan,
};

/// The direction of a robot's way is measured over this length, in metres.
const STEP: f64 = 0.5;
/// A shorter way is manoeuvring, in metres.
const WAY: f64 = 2.0;
/// If a scanner looks within this angle of the robot's way, it sees the hallway there, in radians.
const BESIDE: f64 = PI / 24.0;

/// Notices where a robot drives unseen.
#[derive(Clone, Debug, Default)]
pub(super) struct UnseenWay {
    /// Where the last step ended.
    last: Option<[f64; 2]>,
    /// The length of the way since the scanner last looked ahead, in metres.
    length: f64,
}

impl UnseenWay {
    /// Takes the next scan, and the robot's pose. Returns whether the way has become too long; of one way only once.
    pub(super) fn go(&mut self, scan: &Scan, robot: &Odometry) -> bool {
        let last = *self.last.get_or_insert(robot.position);
        let step = distance(last, robot.position);
        if step < STEP {
            return false;
        }
        self.last = Some(robot.position);
        let ahead = direction(last, robot.position) - robot.heading;
        let before = self.length;
        self.length = if scan.angle_off(ahead) > BESIDE { before + step } else { 0.0 };
        before < WAY && self.length >= WAY
    }
}
