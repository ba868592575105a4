//! The lemmas fail on broken variants of Algorithm 2.

use toposlam_model::driving::algorithm2::{Lost, LostReason};

use super::*;
use crate::ChoiceOdometer;

/// Algorithm 2 with something broken.
#[derive(Clone)]
struct Broken<const FLAW: u8> {
    path: Algorithm2,
    /// The given path, and the number of its doors that it has ignored.
    queue: &'static [Door],
    skipped: usize,
}

/// A unit is 60 cm.
const FARTHER: u8 = 0;
/// One image decides a visit.
const ONE_IMAGE: u8 = 1;
/// The first door is not removed from the queue.
const KEPT: u8 = 2;
/// The first door is left out.
const LEFT_OUT: u8 = 3;
/// It leaves a junction without an image of the doors turned.
const AT_ONCE: u8 = 4;
/// Images that show nothing are not counted.
const UNKNOWN_FOR_EVER: u8 = 5;
/// Commands that are not carried out are repeated for ever.
const STALLED_FOR_EVER: u8 = 6;
/// Images from the same place are not counted.
const IDLE_FOR_EVER: u8 = 7;
/// Junctions without a door left are driven through.
const NO_STOP: u8 = 8;

impl<const FLAW: u8> PathDriver for Broken<FLAW> {
    fn begin(queue: &'static [Door], from: &JunctionState, leg: f64) -> Self {
        let (driven, skipped): (&'static [Door], usize) = match (FLAW, queue) {
            (KEPT, [first, _]) => (TWO_DOORS[first.0 as usize][first.0 as usize], 0),
            (LEFT_OUT, [_, second]) => (ONE_DOOR[second.0 as usize], 1),
            _ => (queue, 0),
        };
        Self { path: Algorithm2::begin(driven, from, leg), queue, skipped }
    }

    fn round(&mut self, scene: &Scene, odometry: Odometry) -> Result<Step, Lost> {
        let before = self.path.clone();
        let step = self.path.round(scene, odometry);
        match (FLAW, step) {
            (FARTHER, Ok(Step::Go(Command { turn, forward }))) => {
                Ok(Step::Go(Command { turn, forward: 1.2 * forward }))
            }
            (ONE_IMAGE, Ok(Step::Go(command))) if command == Command::default() => {
                self.path.round(scene, odometry)
            }
            (AT_ONCE, Ok(Step::Go(Command { turn, .. })))
                if self.path.queue().len() < before.queue().len() =>
            {
                Ok(Step::Go(Command { turn, forward: UNIT }))
            }
            (UNKNOWN_FOR_EVER, Err(Lost { why: LostReason::Unknown { .. }, .. }))
            | (STALLED_FOR_EVER, Err(Lost { why: LostReason::Stalled { .. }, .. }))
            | (IDLE_FOR_EVER, Err(Lost { why: LostReason::Idle { .. }, .. })) => {
                self.path = before;
                Ok(Step::Go(Command { turn: 0.2, forward: 0.0 }))
            }
            (NO_STOP, Ok(Step::Arrived(_))) => Ok(Step::Go(Command { turn: 0.0, forward: UNIT })),
            (_, step) => step,
        }
    }

    fn queue(&self) -> &[Door] {
        let left = self.path.queue().len() + self.skipped;
        &self.queue[self.queue.len() - left.min(self.queue.len())..]
    }
}

/// A lemma on a broken variant.
type BrokenLemma = fn(&mut ChoiceOdometer) -> CaseResult;

/// What is broken, in a lemma, and the claim that then does not hold.
const NOTICED: [(BrokenLemma, &str); 11] = [
    (no_command_exceeds_a_unit::<_, Broken<FARTHER>, 1>, "it goes ahead by at most a unit"),
    (arrives::<_, Broken<FARTHER>, 0>, "it goes ahead by at most a unit"),
    (no_false_arrival::<_, Broken<ONE_IMAGE>, 1, 1>, "two images agree"),
    (doors_in_order::<_, Broken<KEPT>, 0, 0>, "it leaves when it looks to the door"),
    (doors_in_order::<_, Broken<LEFT_OUT>, 0, 0>, "every door was taken"),
    (the_first_door::<_, Broken<AT_ONCE>, 4>, "it leaves only if it looks there"),
    (doors_in_order::<_, Broken<AT_ONCE>, 0, 0>, "it leaves when it looks to the door"),
    (always_ends::<_, Broken<UNKNOWN_FOR_EVER>, 0, 1>, "it gives up at the seventh unknown"),
    (always_ends::<_, Broken<STALLED_FOR_EVER>, 0, 1>, "it gives up when nothing is carried out"),
    (always_ends::<_, Broken<IDLE_FOR_EVER>, 0, 1>, "it makes progress"),
    (arrives::<_, Broken<NO_STOP>, 0>, "it ends"),
];

#[test]
fn each_flaw_is_noticed() {
    for (lemma, claim) in NOTICED {
        let failure = ChoiceOdometer::exhaust(lemma, &()).expect_err(claim);
        assert_eq!(failure.claim, claim);
    }
}
