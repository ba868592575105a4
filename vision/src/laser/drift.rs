//! How much the heading of the odometry drifts: measured by the walls that successive scans show.

use toposlam_model::driving::{odometry::Odometry, scene::wrapped};

use super::{matching::ScanMatcher, params::LaserParams, scan::Scan};
use crate::least_squares::median;

/// The rounds of matching with which drift is measured and corrected. Geometry: 8 are enough.
pub const ROUNDS: usize = 8;
/// Drift is measured on stretches of the way of this length. Geometry: drift is given in 10 m.
const STRETCH: f64 = 10.0;
/// Fewer stretches do not show a drift. Geometry: their median is used.
const LEAST: usize = 3;

#[derive(Clone, Debug, Default)]
pub struct DriftMeter {
    params: LaserParams,
    matcher: ScanMatcher,
    /// The length of the robot's way, in metres.
    way: f64,
    /// Where the last scan was taken that was used.
    last: Option<Odometry>,
    /// Where the present stretch of the way began, and the correction of the heading there, in radians.
    begun: Option<(f64, f64)>,
    /// By how much the correction has changed on each stretch of the way, in radians.
    changes: Vec<f64>,
}

impl DriftMeter {
    pub fn new(mut params: LaserParams) -> Self {
        params.matching.rounds = ROUNDS;
        let matcher = ScanMatcher::new(params.matching);
        Self { params, matcher, ..Self::default() }
    }

    pub fn add_scan(&mut self, scan: &Scan, odometry: &Odometry) {
        let params = self.params.map;
        let Some(driven) = params.driven(&mut self.last, odometry) else { return };
        self.way += driven;
        self.matcher.add_scan(scan, odometry, self.way, self.way - params.memory);
        let correction = self.matcher.correction().rotation.angle();
        let (begun, before) = *self.begun.get_or_insert((self.way, correction));
        if self.way - begun >= STRETCH {
            self.changes.push(wrapped(correction - before).abs() * STRETCH / (self.way - begun));
            self.begun = Some((self.way, correction));
        }
    }

    /// The median drift in 10 m of the way, in radians; `None` if the way is too short.
    #[must_use]
    pub fn finish(mut self) -> Option<f64> {
        self.changes.retain(|change| change.is_finite());
        if self.changes.len() < LEAST { None } else { median(self.changes) }
    }
}
