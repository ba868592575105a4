//! The interface of lemmas: a lemma chooses a case, may assume something about it, and claims something.

use std::panic::{self, AssertUnwindSafe};

use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    marker::{Directional, MarkerKind},
    percept::Door,
};

/// Makes the choices of a lemma.
pub trait Choose {
    /// A number below `n`.
    ///
    /// # Panics
    /// Panics if `n` is 0: the lemma has nothing to choose from.
    fn below(&mut self, n: u8) -> u8;

    /// Whether to go on with this case; the lemma says nothing about the others.
    #[inline]
    fn assume(&mut self, condition: bool) -> bool {
        condition
    }

    /// Shows a person what was chosen. Only a [`CaseReplay`](crate::CaseReplay) keeps it.
    fn show(&mut self, exhibit: impl FnOnce() -> Exhibit) {
        let _ = exhibit;
    }
}

/// The result of a lemma in one case.
pub type CaseResult = Result<(), Stop>;

/// The reason why a lemma does not hold in a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// The lemma says nothing about this case.
    Excluded,
    /// The claim that does not hold.
    Fails(&'static str),
}

/// Goes on only with cases in which the condition holds.
///
/// # Errors
/// [`Stop::Excluded`].
#[inline]
pub fn given(choose: &mut impl Choose, condition: bool) -> CaseResult {
    if choose.assume(condition) { Ok(()) } else { Err(Stop::Excluded) }
}

/// Claims that something holds in this case.
///
/// # Errors
/// [`Stop::Fails`].
#[inline]
pub fn claim(what: &'static str, holds: bool) -> CaseResult {
    if holds { Ok(()) } else { Err(Stop::Fails(what)) }
}

/// The result of a lemma; a panic is a failure.
pub(crate) fn unless_it_panics(lemma: impl FnOnce() -> CaseResult) -> CaseResult {
    let ended = panic::catch_unwind(AssertUnwindSafe(lemma));
    ended.unwrap_or(Err(Stop::Fails("the code does not panic")))
}

/// Something that was chosen, shown to a person.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Exhibit {
    World {
        graph: EmbeddedGraph,
        facing: Dart,
    },
    Walk {
        /// The place of the world among those shown, from 0.
        world: usize,
        /// The marker, placed by the world's facing dart.
        marker: MarkerKind,
        /// The robot's entry dart at the beginning.
        pose: Dart,
        doors: Vec<Door>,
    },
    /// Any other value, with its name.
    Value {
        name: &'static str,
        value: String,
    },
}

impl Exhibit {
    /// A walk in the first world, with the directional marker.
    #[must_use]
    pub fn walk(pose: Dart, doors: &[Door]) -> Self {
        Self::Walk { world: 0, marker: Directional, pose, doors: doors.to_vec() }
    }
}
