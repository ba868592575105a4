//! The exhaustive driver: every case within a bound.

use toposlam_model::enumerate::Watch;

use crate::choose::{CaseResult, Choose, Stop, unless_it_panics};

/// Makes every combination of choices, one case after the other; the latest choice changes fastest.
#[derive(Clone, Debug, Default)]
pub struct ChoiceOdometer {
    /// The choices of this case, each with its number of possibilities.
    digits: Vec<(u8, u8)>,
    /// The number of choices made so far.
    made: usize,
    /// Whether the lemma once had other possibilities after the same choices.
    wavered: bool,
}

impl ChoiceOdometer {
    /// Makes every case, and returns the number of those to which the lemma applies; if `watch` stops it, the
    /// number so far. A part is [`PROGRESS`] of them.
    ///
    /// # Errors
    /// Returns the first case in which the lemma fails.
    pub fn exhaust(
        mut lemma: impl FnMut(&mut Self) -> CaseResult,
        watch: &dyn Watch,
    ) -> Result<u64, Counterexample> {
        let mut odometer = Self::default();
        let mut accepted = 0_u64;
        loop {
            odometer.made = 0;
            let case = unless_it_panics(|| lemma(&mut odometer));
            let fails = match case {
                _ if odometer.wavered || odometer.made < odometer.digits.len() => {
                    Some("the lemma has the same choices after the same choices")
                }
                Err(Stop::Fails(what)) => Some(what),
                Ok(()) => {
                    accepted += 1;
                    if accepted.is_multiple_of(PROGRESS) {
                        watch.part_done(PROGRESS);
                        if watch.stop() {
                            return Ok(accepted);
                        }
                    }
                    None
                }
                Err(Stop::Excluded) => None,
            };
            if let Some(claim) = fails {
                let choices = odometer.digits.iter().map(|&(choice, _)| choice).collect();
                return Err(Counterexample { choices, claim, cases: accepted });
            }
            if !odometer.turn() {
                return Ok(accepted);
            }
        }
    }

    /// Goes on to the next case; `false` after the last.
    fn turn(&mut self) -> bool {
        while let Some((choice, n)) = self.digits.pop() {
            if choice + 1 < n {
                self.digits.push((choice + 1, n));
                return true;
            }
        }
        false
    }
}

/// The number of cases between two reports of progress.
pub const PROGRESS: u64 = 1 << 16;

impl Choose for ChoiceOdometer {
    #[inline]
    fn below(&mut self, n: u8) -> u8 {
        assert!(n > 0, "there is something to choose from");
        let choice = if let Some(&(choice, of)) = self.digits.get(self.made) {
            self.wavered |= of != n;
            choice
        } else {
            self.digits.push((0, n));
            0
        };
        self.made += 1;
        choice
    }
}

/// A case in which a lemma fails.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Counterexample {
    /// The choices, from which a [`CaseReplay`](crate::CaseReplay) makes it again.
    pub choices: Vec<u8>,
    /// The claim that does not hold.
    pub claim: &'static str,
    /// The number of cases before it, in which the lemma holds.
    pub cases: u64,
}

/// Choices, separated by commas, in the format of `--choices`.
pub fn listed(choices: &[u8]) -> String {
    choices.iter().map(u8::to_string).collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::choose::{claim, given};

    fn exhaust(
        lemma: impl FnMut(&mut ChoiceOdometer) -> CaseResult,
    ) -> Result<u64, Counterexample> {
        ChoiceOdometer::exhaust(lemma, &())
    }

    #[test]
    fn later_choices_may_depend_on_earlier_ones() {
        let mut cases = Vec::new();
        let count = exhaust(|choose| {
            let first = choose.below(3);
            let second = if first == 1 { choose.below(2) } else { 0 };
            given(choose, first < 2)?;
            cases.push((first, second));
            Ok(())
        });
        assert_eq!((count, cases), (Ok(3), vec![(0, 0), (1, 0), (1, 1)]));
    }

    #[test]
    fn the_first_case_that_fails_is_returned_with_its_choices() {
        let failed = exhaust(|choose| {
            let (one, other) = (choose.below(3), choose.below(3));
            claim("they are not both 1", one != 1 || other != 1)
        });
        let claim = "they are not both 1";
        assert_eq!(failed, Err(Counterexample { choices: vec![1, 1], claim, cases: 4 }));
    }

    #[test]
    fn a_lemma_that_chooses_otherwise_the_next_time_fails() {
        let claim = "the lemma has the same choices after the same choices";
        for (then, choices) in [(vec![3, 2], vec![0, 1]), (vec![2], vec![0, 1])] {
            let mut made = 0;
            let wavering = exhaust(|choose| {
                made += 1;
                let ways: &[u8] = if made == 1 { &[2, 2] } else { &then };
                for &n in ways {
                    choose.below(n);
                }
                Ok(())
            });
            assert_eq!(wavering, Err(Counterexample { choices, claim, cases: 1 }));
        }
    }
}
