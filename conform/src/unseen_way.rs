//! Where a robot drives in a direction in which its laser scanner does not look: backwards, with a scanner that
//! sees half of a circle. It may pass junctions there that no scan shows.

use nalgebra::Point2;
use toposlam_model::driving::odometry::Odometry;
use toposlam_vision::{
    geometry::{direction, distance},
    laser::scan::Scan,
};

use super::params::LASER;

/// Notices where a robot drives unseen.
#[derive(Clone, Debug, Default)]
pub(super) struct UnseenWay {
    /// Where the last step ended.
    last: Option<Point2<f64>>,
    /// The length of the way since the scanner last looked ahead, in metres.
    length: f64,
}

impl UnseenWay {
    /// Takes the next scan, and the robot's pose. Returns whether the way has become too long; of one way only once.
    pub(super) fn go(&mut self, scan: &Scan, robot: &Odometry) -> bool {
        let position = Point2::from(robot.position);
        let last = *self.last.get_or_insert(position);
        let step = distance(last, position);
        if step < LASER.unseen_step {
            return false;
        }
        self.last = Some(position);
        let ahead = direction(last, position) - robot.heading;
        let before = self.length;
        self.length = if scan.angle_off(ahead) > LASER.unseen_angle { before + step } else { 0.0 };
        before < LASER.unseen_way && self.length >= LASER.unseen_way
    }
}
