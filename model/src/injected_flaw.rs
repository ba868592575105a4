//! Flaws that a test puts into folding and into explorers, to see that the check reports them.
//!
//! Outside of this crate's tests none is present, and the compiler removes the conditions.

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum InjectedFlaw {
    SightingNotUnited,
    ForcedNotUnited,
    /// A hypothesis that contradicts itself is alive.
    ContradictionIgnored,
    SightingsNotCompared,
    /// Edges of different lengths can be one.
    LengthsNotCompared,
    /// After a hypothesis, an edge keeps the length that it had under it.
    LengthNotRestored,
    /// A place joins the map although a hypothesis about it is alive.
    PlaceAddedTooEarly,
    OneHypothesisExamined,
    NotTested,
    /// A walk that does not confirm a hypothesis is made, and its success is taken as proof.
    ProofByOtherWalk,
    /// The vertex at which the movable marker is seen is taken for the pose that a test expects there.
    VertexTakenForPose,
    /// There is no place validation: every place is new.
    EveryPlaceIsNew,
    /// The search ends at the first candidate.
    OneCandidateSearched,
    /// After a search in vain, the robot takes itself to be at the new place.
    LeftBehind,
    /// After a search in vain, the marker is left at the new place.
    MarkerLeftBehind,
    /// There is no back-link validation: the first unexplored dart is taken.
    FirstDartIsIt,
    /// The marker is dropped where it was found, and not carried to the known end.
    NotCarried,
    /// The first dart tried that does not lead to the marker is taken.
    RejectedIsConfirmed,
}

impl InjectedFlaw {
    /// Whether a test of this thread has injected the flaw.
    #[cfg(not(test))]
    #[inline]
    #[expect(clippy::unused_self, reason = "tests use it")]
    pub(crate) const fn is_present(self) -> bool {
        false
    }
}

#[cfg(test)]
pub(crate) use injection::inject;

#[cfg(test)]
mod injection {
    use std::cell::Cell;

    use super::InjectedFlaw;

    thread_local! {
        static PRESENT: Cell<Option<InjectedFlaw>> = const { Cell::new(None) };
    }

    impl InjectedFlaw {
        pub(crate) fn is_present(self) -> bool {
            PRESENT.get() == Some(self)
        }
    }

    /// Runs something with a flaw. Only this thread has it.
    pub(crate) fn inject<T>(flaw: Option<InjectedFlaw>, run: impl FnOnce() -> T) -> T {
        PRESENT.set(flaw);
        let result = run();
        PRESENT.set(None);
        result
    }
}
