//! What a lemma stands on: it chooses a case, may assume something of it, and claims something.

use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    percept::Door,
};

/// Who makes the choices of a lemma.
pub trait Choose {
    /// A number below `n`, which is at least 1.
    fn below(&mut self, n: u8) -> u8;

    /// Whether this is a case to go on with; the lemma says nothing about the others.
    fn assume(&mut self, condition: bool) -> bool;

    /// Shows a person what was chosen. Only a [`Replay`](crate::Replay) looks.
    fn show(&mut self, exhibit: impl FnOnce() -> Exhibit) {
        let _ = exhibit;
    }
}

/// What a lemma comes to in one case.
pub type Case = Result<(), Stop>;

/// Why a lemma does not hold in a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// The case is none of those of which the lemma speaks.
    Excluded,
    /// What should hold, and does not.
    Fails(&'static str),
}

/// Goes on only with cases in which the condition holds.
///
/// # Errors
/// [`Stop::Excluded`].
#[inline]
pub fn given(choose: &mut impl Choose, condition: bool) -> Case {
    if choose.assume(condition) { Ok(()) } else { Err(Stop::Excluded) }
}

/// Claims that something holds in this case.
///
/// # Errors
/// [`Stop::Fails`].
#[inline]
pub fn claim(what: &'static str, holds: bool) -> Case {
    if holds { Ok(()) } else { Err(Stop::Fails(what)) }
}

/// Something that was chosen, for a person to look at.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Exhibit {
    /// A start.
    World {
        /// The embedded graph.
        graph: EmbeddedGraph,
        /// The facing dart.
        facing: Dart,
    },
    /// The robot's entry dart in the latest world, and the doors that it takes from there.
    Walk {
        /// The entry dart.
        pose: Dart,
        /// The doors.
        doors: Vec<Door>,
    },
    /// Anything else: what it is, and what it was.
    Value {
        /// What it is.
        name: &'static str,
        /// What it was.
        value: String,
    },
}
