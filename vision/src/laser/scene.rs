//! From a laser scan to the place of a robot in a building with right angles, as Algorithm 2 needs it. Section 3.
//!
//! The hits of the scan take the place of the boundary points of an image; all later steps are the same. A
//! scanner that does not see behind is helped by the hits of the last scans.

use std::{
    collections::VecDeque,
    f64::consts::{PI, TAU},
};

use toposlam_model::driving::{
    odometry::Odometry,
    scene::{JunctionView, Place, Reason, wrapped},
};

use super::scan::{Reading, Scan};
use crate::{
    boundary::{BEARINGS, Boundary, Sight},
    params::SensingParams,
    sensing::place_within,
};

/// Senses places with a laser scanner.
#[derive(Clone, Debug, Default)]
pub struct ScanPlaceSensor {
    params: SensingParams,
    /// Where the last scans were taken, with their hits in the frame of odometry.
    last: VecDeque<(Odometry, Vec<[f64; 2]>)>,
}

/// A scan is remembered if the robot has driven this far since the last one that is, in metres, or has
/// turned this far, in radians.
const EVERY: f64 = 0.2;
const EVERY_TURN: f64 = 0.2;
/// The number of scans that are remembered: the robot has driven a few metres since.
const REMEMBERED: usize = 24;
/// The hits of two successive readings are on one wall if their ranges differ by less than this, in metres,
/// and by less than this part. Half a degree before a gap there is no wall.
const STEP: f64 = 0.15;
const STEP_PART: f64 = 0.1;
/// A robot is at most this far past the turning point of a dead end, in metres: half of a hallway's width
/// less its radius.
const PAST_DEAD_END: f64 = 0.45;
/// Successive readings are neighbours if their bearings differ by less than this, in radians.
const NEXT: f64 = 0.06;

impl ScanPlaceSensor {
    /// Sensing with other parameters than the defaults.
    #[must_use]
    pub fn with_params(params: &SensingParams) -> Self {
        Self { params: *params, last: VecDeque::new() }
    }

    /// The place in a scan, and the odometry when it was taken.
    pub fn sense(&mut self, scan: &Scan, odometry: &Odometry) -> Place {
        let boundary = self.boundary(scan, odometry);
        self.remember(scan, odometry);
        let (place, trace) = place_within(boundary, 0.0, &self.params);
        match &place {
            Place::Junction(junction) if is_behind_its_wall(junction) => {
                trace.hallway.map_or(Place::Unknown(Reason::NothingFits), |hallway| {
                    Place::Hallway(hallway.view(0.0, &self.params.outline))
                })
            }
            _ => place,
        }
    }

    /// What the scan shows on each bearing, and behind its field of view the last scans.
    fn boundary(&self, scan: &Scan, odometry: &Odometry) -> Boundary {
        let mut sights = vec![None; BEARINGS];
        for (_, points) in &self.last {
            for &point in points {
                let (bearing, range) = polar(seen(odometry, point));
                let at = (bearing.rem_euclid(TAU) / TAU * BEARINGS as f64).round() as usize;
                let known: &mut Option<f64> = &mut sights[at % BEARINGS];
                *known = Some(known.map_or(range, |known| known.min(range)));
            }
        }
        let mut sights: Vec<Sight> = sights
            .into_iter()
            .map(|range| range.map_or_else(Sight::default, Sight::measured))
            .collect();
        let readings: Vec<(f64, Option<f64>)> = scan
            .readings()
            .map(|(bearing, reading)| match reading {
                Reading::Hit(range) => {
                    let (bearing, range) = polar(scan.point(bearing, range));
                    (bearing, Some(range))
                }
                Reading::NoReturn | Reading::Invalid => (bearing, None),
            })
            .collect();
        let next = readings.iter().cycle().skip(1);
        for (&(from, near), &(to, far)) in readings.iter().zip(next) {
            let turn = wrapped(to - from);
            if !(0.0..NEXT).contains(&turn) {
                continue;
            }
            let first = (from.rem_euclid(TAU) / TAU * BEARINGS as f64).ceil() as usize;
            let count = (turn / TAU * BEARINGS as f64).ceil() as usize;
            for bearing in first..=first + count {
                let share = wrapped(bearing as f64 * TAU / BEARINGS as f64 - from) / turn.max(1e-9);
                if share <= 1.0 + 1e-9 {
                    sights[bearing % BEARINGS] = between(near, far, share);
                }
            }
        }
        Boundary { sights }
    }

    fn remember(&mut self, scan: &Scan, odometry: &Odometry) {
        // What is seen all around needs no memory.
        let covered = scan.geometry().angle_increment * scan.ranges().len() as f64;
        let moved = self.last.back().is_none_or(|(last, _)| {
            last.distance(odometry) > EVERY
                || wrapped(last.heading - odometry.heading).abs() > EVERY_TURN
        });
        if !moved || covered > 2.0 * PI - NEXT {
            return;
        }
        let (sine, cosine) = odometry.heading.sin_cos();
        let [east, north] = odometry.position;
        let place =
            |[x, y]: [f64; 2]| [east + x * cosine - y * sine, north + x * sine + y * cosine];
        self.last.push_back((*odometry, scan.hits().map(place).collect()));
        while self.last.len() > REMEMBERED {
            self.last.pop_front();
        }
    }
}

/// Whether a robot at a junction would stand behind its wall: furniture along a corridor looks like the end of a
/// narrow one.
fn is_behind_its_wall(junction: &JunctionView) -> bool {
    junction.doors.len() == 1 && junction.distance() < -PAST_DEAD_END
}

/// What is seen between two readings. A reading without a return shows nothing.
fn between(near: Option<f64>, far: Option<f64>, share: f64) -> Sight {
    let nearest = if share < 0.5 { near } else { far };
    let range = match (near, far) {
        (Some(one), Some(other)) if (one - other).abs() < STEP + STEP_PART * one.min(other) => {
            // The inverse of the range of a straight wall hardly bends in such an angle.
            Some(1.0 / (1.0 / one + share * (1.0 / other - 1.0 / one)))
        }
        _ => nearest,
    };
    range.map_or_else(Sight::default, Sight::measured)
}

/// A point of the frame of odometry, in the robot's frame.
fn seen(odometry: &Odometry, [x, y]: [f64; 2]) -> [f64; 2] {
    let (sine, cosine) = odometry.heading.sin_cos();
    let off = [x - odometry.position[0], y - odometry.position[1]];
    [off[0] * cosine + off[1] * sine, off[1] * cosine - off[0] * sine]
}

/// The bearing and the range of a point.
fn polar([x, y]: [f64; 2]) -> (f64, f64) {
    (y.atan2(x), x.hypot(y))
}
