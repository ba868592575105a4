//! Makes one case again, to show it to a person.

use thiserror::Error;

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
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum ChoicesError {
    #[error("choice number {place} is {choice}; it is at most {}", of - 1)]
    TooHigh {
        /// Its place in the list, from 1.
        place: usize,
        choice: u8,
        /// The number of possibilities at this place.
        of: u8,
    },
    #[error("a case that begins so has at least {needed} choices, not {choices}")]
    TooShort { choices: usize, needed: usize },
    #[error("the case that begins so has {needed} choices, not {choices}")]
    TooLong { choices: usize, needed: usize },
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
            None if choices < needed => Err(ChoicesError::TooShort { choices, needed }),
            None if choices > needed => Err(ChoicesError::TooLong { choices, needed }),
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
