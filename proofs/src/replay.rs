//! Makes one case again, to show it to a person.

use std::fmt;

use crate::choose::{CaseResult, Choose, Exhibit, Stop, unless_it_panics};

/// Makes one case again, from a list of choices, and keeps its exhibits.
#[derive(Clone, Debug, Default)]
pub struct CaseReplay {
    choices: Vec<u8>,
    /// The number of choices made, or needed.
    made: usize,
    misfit: Option<ChoicesError>,
    exhibits: Vec<Exhibit>,
}

/// A list of choices that is not a case of the lemma.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChoicesError {
    /// A choice is too high.
    TooHigh {
        /// Its place in the list, from 1.
        place: usize,
        choice: u8,
        /// The number of possibilities at this place.
        of: u8,
    },
    /// The list is too short or too long.
    Length {
        /// The number of choices in the list.
        choices: usize,
        /// The number of choices of a case that begins so; the least one, if the list is too short.
        needed: usize,
    },
}

impl fmt::Display for ChoicesError {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::TooHigh { place, choice, of } => {
                write!(out, "choice number {place} is {choice}; it is at most {}", of - 1)
            }
            Self::Length { choices, needed } if choices < needed => {
                write!(out, "a case that begins so has at least {needed} choices, not {choices}")
            }
            Self::Length { choices, needed } => {
                write!(out, "the case that begins so has {needed} choices, not {choices}")
            }
        }
    }
}

/// A case, made again.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReplayedCase {
    pub case: CaseResult,
    /// What was chosen, as the lemma shows it.
    pub exhibits: Vec<Exhibit>,
}

impl ReplayedCase {
    /// The claim that does not hold.
    pub fn claim(&self) -> Option<&'static str> {
        match self.case {
            Err(Stop::Fails(claim)) => Some(claim),
            Ok(()) | Err(Stop::Excluded) => None,
        }
    }
}

impl CaseReplay {
    /// Makes a case again.
    ///
    /// # Errors
    /// Returns an error if the choices are not those of a case.
    pub fn show(
        lemma: impl FnOnce(&mut Self) -> CaseResult,
        choices: &[u8],
    ) -> Result<ReplayedCase, ChoicesError> {
        let mut replay = Self { choices: choices.to_vec(), ..Self::default() };
        let case = unless_it_panics(|| lemma(&mut replay));
        let (choices, needed) = (replay.choices.len(), replay.made);
        match replay.misfit {
            Some(misfit) => Err(misfit),
            None if needed != choices => Err(ChoicesError::Length { choices, needed }),
            None => Ok(ReplayedCase { case, exhibits: replay.exhibits }),
        }
    }
}

impl Choose for CaseReplay {
    fn below(&mut self, n: u8) -> u8 {
        assert!(n > 0, "there is something to choose from");
        self.made += 1;
        match self.choices.get(self.made - 1) {
            Some(&choice) if choice < n => choice,
            Some(&choice) => {
                let misfit = ChoicesError::TooHigh { place: self.made, choice, of: n };
                self.misfit.get_or_insert(misfit);
                0
            }
            None => 0,
        }
    }

    fn show(&mut self, exhibit: impl FnOnce() -> Exhibit) {
        self.exhibits.push(exhibit());
    }
}
