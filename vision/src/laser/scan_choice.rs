//! Which scans of a log are used: none as near to another one as [`LocalMapParams::logged_every`] along the way, and each
//! other scan that near to one.
//!
//! They are chosen in the order of a hash of their readings, so which ones are used at a place depends on the scans around
//! it alone, and not on where the log begins: a maximal independent set by random priorities (Luby, 1986). A scan is decided
//! as soon as all scans beside it are known, and given up if it is not used.

use std::sync::Arc;

use toposlam_model::driving::{odometry::Odometry, scene::wrapped};

use super::{local_map::is_near_origin, params::LocalMapParams, scan::Scan};

#[derive(Clone, Debug)]
pub(super) struct ScanChoice {
    params: LocalMapParams,
    scans: Vec<Candidate>,
    /// All scans before this one are decided.
    decided: usize,
}

#[derive(Clone, Debug)]
struct Candidate {
    odometry: Odometry,
    hash: u64,
    state: State,
}

#[derive(Clone, Debug)]
enum State {
    Open(Arc<Scan>),
    Used(Arc<Scan>),
    Unused,
}

/// A scan that is used.
#[derive(Clone, Debug)]
pub(super) struct ChosenScan {
    /// Its number among all scans.
    pub number: usize,
    pub scan: Arc<Scan>,
    pub odometry: Odometry,
    pub hash: u64,
}

/// More scans beside each other are not compared: a robot that stands still takes many.
const MOST_BESIDE: usize = 500;
/// Scans are decided when so many have come.
const TOGETHER: usize = 1000;

impl ScanChoice {
    pub(super) fn new(params: &LocalMapParams) -> Self {
        Self { params: *params, scans: Vec::new(), decided: 0 }
    }

    pub(super) fn add(&mut self, scan: Arc<Scan>, odometry: Odometry) {
        let hash = hash(&scan);
        let state = if is_near_origin(&odometry) { State::Open(scan) } else { State::Unused };
        self.scans.push(Candidate { odometry, hash, state });
        if self.scans.len().is_multiple_of(TOGETHER) {
            self.decide(false);
        }
    }

    /// The scans that are used, in their order.
    pub(super) fn finish(mut self) -> Vec<ChosenScan> {
        self.decide(true);
        let chosen = |(number, Candidate { odometry, hash, state }): (usize, Candidate)| {
            let State::Used(scan) = state else { return None };
            Some(ChosenScan { number, scan, odometry, hash })
        };
        self.scans.into_iter().enumerate().filter_map(chosen).collect()
    }

    /// Decides what can be decided: everything if no more scans come.
    fn decide(&mut self, is_end: bool) {
        let is_open = |scan: &Candidate| matches!(scan.state, State::Open(_));
        let mut open: Vec<usize> =
            (self.decided..self.scans.len()).filter(|&index| is_open(&self.scans[index])).collect();
        open.sort_by_key(|&index| self.priority(index));
        for index in open {
            if let Some(is_used) = self.is_used(index, is_end) {
                let state = &mut self.scans[index].state;
                *state = match std::mem::replace(state, State::Unused) {
                    State::Open(scan) if is_used => State::Used(scan),
                    _ => State::Unused,
                };
            }
        }
        let left = self.scans[self.decided..].iter().position(is_open);
        self.decided = left.map_or(self.scans.len(), |left| self.decided + left);
    }

    fn priority(&self, index: usize) -> (u64, usize) {
        (self.scans[index].hash, index)
    }

    /// Whether a scan is used: if none of those beside it that come before it in the order of hashes is; `None` if this is
    /// not known yet.
    fn is_used(&self, index: usize, is_end: bool) -> Option<bool> {
        let here = &self.scans[index].odometry;
        let is_beside = |other: &usize| {
            let other = &self.scans[*other].odometry;
            let turned = wrapped(other.heading - here.heading).abs();
            other.distance(here) < self.params.logged_every && turned < self.params.every_turn
        };
        let before = (0..index).rev().take(MOST_BESIDE).take_while(is_beside);
        let after = (index + 1..self.scans.len()).take(MOST_BESIDE).take_while(is_beside);
        let last = after.clone().last().unwrap_or(index);
        if !is_end && last + 1 == self.scans.len() && last < index + MOST_BESIDE {
            return None;
        }
        let mut earlier =
            before.chain(after).filter(|&other| self.priority(other) < self.priority(index));
        let mut is_used = Some(true);
        for other in earlier.by_ref() {
            match self.scans[other].state {
                State::Used(_) => return Some(false),
                State::Open(_) => is_used = None,
                State::Unused => {}
            }
        }
        is_used
    }
}

/// The 64-bit FNV-1a hash of the readings of a scan.
fn hash(scan: &Scan) -> u64 {
    scan.ranges().iter().fold(0xcbf2_9ce4_8422_2325, |hash, range| {
        (hash ^ u64::from(range.to_bits())).wrapping_mul(0x0100_0000_01b3)
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// A scan each 10 cm, or none where the robot stands, and the numbers of those that are used.
    fn chosen(scans: &[(Arc<Scan>, Odometry)]) -> Vec<usize> {
        let mut choice = ScanChoice::new(&LocalMapParams::DEFAULT);
        for (scan, odometry) in scans {
            choice.add(Arc::clone(scan), *odometry);
        }
        choice.finish().into_iter().map(|chosen| chosen.number).collect()
    }

    fn scans(steps: &[f64]) -> Vec<(Arc<Scan>, Odometry)> {
        let mut x = 0.0;
        let scan = |(number, step): (usize, &f64)| {
            x += step;
            let range = 1.0 + (number as f64 * 0.618).fract();
            let odometry = Odometry { position: [x, 0.0], heading: 0.0 };
            (Arc::new(Scan::each_degree(0, 4, |_| range)), odometry)
        };
        steps.iter().enumerate().map(scan).collect()
    }

    proptest! {
        #[test]
        fn no_two_scans_that_are_used_are_near_and_each_other_one_is_near_to_one(
            steps in prop::collection::vec(prop_oneof![0.0..0.1, 0.3..1.5], 1..200),
        ) {
            let scans = scans(&steps);
            let used = chosen(&scans);
            let x = |number: usize| scans[number].1.position[0];
            let every = LocalMapParams::DEFAULT.logged_every;
            prop_assert!(used.windows(2).all(|two| x(two[1]) - x(two[0]) >= every));
            for number in 0..scans.len() {
                prop_assert!(used.iter().any(|&used| (x(used) - x(number)).abs() < every));
            }
        }
    }

    #[test]
    fn scans_that_come_first_matter_nearby_alone_and_what_is_decided_early_is_what_is_decided_late()
    {
        let all = scans(&vec![0.05; 4321]);
        let whole = chosen(&all);
        for dropped in [1, 7, 50, 1003] {
            let rest: Vec<_> = chosen(&all[dropped..]).into_iter().map(|at| at + dropped).collect();
            let far = |numbers: &[usize]| {
                numbers.iter().copied().filter(|&at| at > dropped + 400).collect::<Vec<_>>()
            };
            assert_eq!(far(&rest), far(&whole), "without {dropped}");
        }
    }

    #[test]
    fn what_is_not_used_is_given_up_long_before_the_end() {
        let all = scans(&vec![0.01; 10_000]);
        let mut choice = ScanChoice::new(&LocalMapParams::DEFAULT);
        for (scan, odometry) in &all {
            choice.add(Arc::clone(scan), *odometry);
        }
        let held = all.iter().filter(|(scan, _)| Arc::strong_count(scan) > 1).count();
        assert!(held < 2 * TOGETHER, "{held}");
    }
}
