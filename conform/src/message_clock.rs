//! The clock of a log from which events are inferred: a few messages that are far from all others in time are skipped.
//!
//! The messages of a bag, an MCAP file or a database come in the order of their times. One with a wrong time
//! comes first or last, far from where the robot was when it was recorded. (Lines come in the order of their
//! file; `container::clock` of `toposlam-logs` gives each a time.)

/// Messages with a longer time between them, in nanoseconds, do not stand together. A robot may pause.
pub(super) const PAUSE: u64 = 3_600_000_000_000;
/// So many messages that stand together are not skipped.
pub(super) const MANY: usize = 10;
/// The largest number of messages that wait until it is known whether they stand alone.
const WAITING: usize = 1000;

/// Skips messages that are far from all others in time.
#[derive(Clone, Debug)]
pub(super) struct MessageClock<T> {
    last: u64,
    /// The last messages that stand together, as long as they are few.
    together: Vec<T>,
    /// Those before them that are few, too, until many have stood together.
    apart: Vec<T>,
    /// Whether many have stood together, and whether the last ones are many.
    is_set: bool,
    are_many: bool,
    skipped: u64,
}

impl<T> Default for MessageClock<T> {
    fn default() -> Self {
        let [together, apart] = [Vec::new(), Vec::new()];
        Self { last: 0, together, apart, is_set: false, are_many: false, skipped: 0 }
    }
}

impl<T> MessageClock<T> {
    /// Takes the next message in the order of time. Returns those that are no longer in doubt, in order.
    pub(super) fn next(&mut self, time: u64, message: T) -> Vec<T> {
        if time.abs_diff(std::mem::replace(&mut self.last, time)) > PAUSE {
            self.part();
        }
        self.together.push(message);
        if self.apart.len() >= WAITING {
            // This log has pauses everywhere.
            let mut all = std::mem::take(&mut self.apart);
            all.append(&mut self.together);
            return all;
        }
        if !self.are_many && self.together.len() < MANY {
            return Vec::new();
        }
        (self.is_set, self.are_many) = (true, true);
        self.skip_apart();
        std::mem::take(&mut self.together)
    }

    /// Ends the messages that stand together.
    fn part(&mut self) {
        self.are_many = false;
        self.apart.append(&mut self.together);
        if self.is_set {
            self.skip_apart();
        }
    }

    fn skip_apart(&mut self) {
        self.skipped += self.apart.drain(..).count() as u64;
    }

    /// The messages that are still in doubt, and how many are skipped. If many never stood together, none are.
    pub(super) fn finish(mut self) -> (Vec<T>, u64) {
        self.part();
        (self.apart, self.skipped)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The times in seconds that are not skipped, and the number of those that are.
    fn kept(times: &[u64]) -> (Vec<u64>, u64) {
        let mut clock = MessageClock::default();
        let next = |&time: &u64| clock.next(time * 1_000_000_000, time);
        let mut kept: Vec<u64> = times.iter().flat_map(next).collect();
        let (rest, skipped) = clock.finish();
        kept.extend(rest);
        (kept, skipped)
    }

    #[test]
    fn a_message_far_from_all_others_is_skipped() {
        let steady: Vec<u64> = (5000..5100).collect();
        let with = |before: &[u64], after: &[u64]| [before, &steady, after].concat();
        let many: Vec<u64> = (9_000_000..9_000_000 + MANY as u64).collect();
        let hours: Vec<u64> = (0..2 * WAITING as u64).map(|hour| hour * 7200).collect();
        let few = vec![0, 5000, 5001, 4_294_970_000];
        for (times, expected) in [
            (steady.clone(), &steady),
            (with(&[], &[4_294_970_000]), &steady),
            (with(&[0, 1], &[]), &steady),
            // An hour is a pause.
            (with(&[], &[5099 + 3600]), &with(&[], &[5099 + 3600])),
            (with(&[], &[5099 + 3601]), &steady),
            // More messages than a few are not wrong, ...
            (with(&[], &many), &with(&[], &many)),
            // ... nor are all of a log: a few, or many, each far from the next.
            (few.clone(), &few),
            (hours.clone(), &hours),
        ] {
            let skipped = times.len() - expected.len();
            assert_eq!(kept(&times), (expected.clone(), skipped as u64), "{times:?}");
        }
    }
}
