//! One case again, for a person to look at.

use std::fmt;

use crate::choose::{CaseResult, Choose, Exhibit, unless_it_panics};

/// Makes one case again, from a list of choices, and keeps what it shows.
#[derive(Clone, Debug, Default)]
pub struct CaseReplay {
    choices: Vec<u8>,
    /// How many of them have been made, or would have been.
    made: usize,
    misfit: Option<ChoicesError>,
    exhibits: Vec<Exhibit>,
}

/// A list of choices that is not one of the lemma's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChoicesError {
    /// There is no so high choice.
    TooHigh {
        /// The place in the list, from 1.
        place: usize,
        /// The choice there.
        choice: u8,
        /// How many choices there are at this place.
        of: u8,
    },
    /// The list is too short.
    TooFew {
        /// How many choices it has.
        choices: usize,
        /// How many the case that begins so has at least.
        needed: usize,
    },
    /// The list is too long.
    TooMany {
        /// How many choices it has.
        choices: usize,
        /// How many the case has.
        needed: usize,
    },
}

impl fmt::Display for ChoicesError {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::TooHigh { place, choice, of } => {
                write!(out, "choice number {place} is {choice}; it is at most {}", of - 1)
            }
            Self::TooFew { choices, needed } => {
                write!(out, "a case that begins so has at least {needed} choices, not {choices}")
            }
            Self::TooMany { choices, needed } => {
                write!(out, "the case that begins so has {needed} choices, not {choices}")
            }
        }
    }
}

/// A case that was made again.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CaseView {
    /// What the lemma comes to in it.
    pub case: CaseResult,
    /// What was chosen, as the lemma shows it.
    pub exhibits: Vec<Exhibit>,
}

impl CaseReplay {
    /// Makes a case again.
    ///
    /// # Errors
    /// Where the choices are not those of a case.
    pub fn show(
        lemma: impl FnOnce(&mut Self) -> CaseResult,
        choices: &[u8],
    ) -> Result<CaseView, ChoicesError> {
        let mut replay = Self { choices: choices.to_vec(), ..Self::default() };
        let case = unless_it_panics(|| lemma(&mut replay));
        let (choices, needed) = (replay.choices.len(), replay.made);
        match replay.misfit {
            Some(misfit) => Err(misfit),
            None if needed > choices => Err(ChoicesError::TooFew { choices, needed }),
            None if needed < choices => Err(ChoicesError::TooMany { choices, needed }),
            None => Ok(CaseView { case, exhibits: replay.exhibits }),
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

    fn assume(&mut self, condition: bool) -> bool {
        condition
    }

    fn show(&mut self, exhibit: impl FnOnce() -> Exhibit) {
        self.exhibits.push(exhibit());
    }
}
