//! Scans of a log without odometry: each is placed by the walls of those before it.

use serde::Serialize;
use thiserror::Error;
use toposlam_logs::record::EventId;
use toposlam_vision::laser::{params::MatchingParams, scan_motion::ScanMotion};

use super::scan_odometry::{PlacedScan, ScanOrder};

/// Places the scans of a log by themselves.
#[derive(Clone, Debug)]
pub(super) struct ScanTrack {
    motion: ScanMotion,
    order: ScanOrder,
    counts: MatchedScans,
    /// The first of the last scans, all of which match nothing, and their number.
    unmatched: Option<(UnmatchedScan, u64)>,
}

/// How the scans of a log without odometry were placed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct MatchedScans {
    /// The number of scans that were placed.
    pub placed: u64,
    /// The number of scans that were skipped: they match no walls of earlier ones.
    pub unmatched: u64,
}

/// So many scans in turn match nothing. The first one, at a time in nanoseconds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error(
    "the log has no odometry, and from message {} on, at {:.3} s, its scans do not match the walls of earlier ones, so \
     where the robot was is not known; record odometry as well",
    .message.0, *.time as f64 / 1e9
)]
pub struct UnmatchedScan {
    pub message: EventId,
    pub time: u64,
}

/// So many scans may match nothing in turn: people may stand around the robot.
const MOST_UNMATCHED: u64 = 10;

impl ScanTrack {
    pub(super) fn new(params: &MatchingParams) -> Self {
        Self {
            motion: ScanMotion::new(params),
            order: ScanOrder::default(),
            counts: MatchedScans::default(),
            unmatched: None,
        }
    }

    /// Takes the next scan in the log. Returns scans in the order of their stamps, each with the pose at which it was
    /// taken.
    ///
    /// # Errors
    /// Returns the first of many scans in turn that match nothing.
    pub(super) fn scan(&mut self, scan: PlacedScan) -> Result<Vec<PlacedScan>, UnmatchedScan> {
        let released = self.order.add(vec![scan]);
        self.placed(released)
    }

    /// The scans that still wait, and how all were placed.
    ///
    /// # Errors
    /// Returns the first of many scans in turn that match nothing; all of them may.
    pub(super) fn finish(mut self) -> Result<(Vec<PlacedScan>, MatchedScans), UnmatchedScan> {
        let rest = std::mem::take(&mut self.order).finish();
        let rest = self.placed(rest)?;
        Ok((rest, self.counts))
    }

    fn placed(&mut self, scans: Vec<PlacedScan>) -> Result<Vec<PlacedScan>, UnmatchedScan> {
        let mut placed = Vec::new();
        for scan in scans {
            if let Some(odometry) = self.motion.add_scan(&scan.scan) {
                self.unmatched = None;
                self.counts.placed += 1;
                placed.push(PlacedScan { odometry, ..scan });
                continue;
            }
            self.counts.unmatched += 1;
            let here = UnmatchedScan { message: scan.source.id, time: scan.stamp };
            let (first, count) = self.unmatched.unwrap_or((here, 0));
            if count + 1 >= MOST_UNMATCHED {
                return Err(first);
            }
            self.unmatched = Some((first, count + 1));
        }
        Ok(placed)
    }
}
