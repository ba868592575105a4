//! Verdicts on the samples of a measurement, and their numbers.

use std::iter::Sum;

/// How a sample compares with the truth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum SampleVerdict {
    Right,
    /// Sensing does not know, or the robot gave up.
    Undecided,
    Wrong,
}

impl SampleVerdict {
    pub fn right_if(is_right: bool) -> Self {
        if is_right { Self::Right } else { Self::Wrong }
    }
}

/// The numbers of samples with each verdict.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SampleTally {
    pub right: usize,
    pub undecided: usize,
    pub wrong: usize,
}

impl SampleTally {
    pub fn add(&mut self, verdict: SampleVerdict) {
        *match verdict {
            SampleVerdict::Right => &mut self.right,
            SampleVerdict::Undecided => &mut self.undecided,
            SampleVerdict::Wrong => &mut self.wrong,
        } += 1;
    }

    pub fn all(&self) -> usize {
        self.right + self.failed()
    }

    /// The number of samples that are not right.
    pub fn failed(&self) -> usize {
        self.undecided + self.wrong
    }
}

impl Sum for SampleTally {
    fn sum<I: Iterator<Item = Self>>(tallies: I) -> Self {
        tallies.fold(Self::default(), |one, other| Self {
            right: one.right + other.right,
            undecided: one.undecided + other.undecided,
            wrong: one.wrong + other.wrong,
        })
    }
}

impl FromIterator<SampleVerdict> for SampleTally {
    fn from_iter<I: IntoIterator<Item = SampleVerdict>>(verdicts: I) -> Self {
        let mut tally = Self::default();
        verdicts.into_iter().for_each(|verdict| tally.add(verdict));
        tally
    }
}
