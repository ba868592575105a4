//! The first event of a trace that no world of any size explains. Section 2.1.

use thiserror::Error;
use toposlam_model::{
    enumerate::Class,
    folding::{ContradictionReason, FoldError, TrailContradiction, fold},
    marker::{Directional, Marker, NoMarker},
    percept::{Percept, Sighting},
    trace::Trace,
};

/// Why no world of any size explains an event together with all before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum Impossibility {
    /// The walk contradicts itself.
    #[error(transparent)]
    Walk(#[from] ContradictionReason),
    /// A marker was perceived by a robot without one.
    #[error("the robot has no marker, and perceived one")]
    Marker,
    /// The vertex has more doors than a vertex of the class.
    #[error("in a world of class {class} a vertex has at most {} doors", .class.max_degree())]
    Degree {
        /// The class.
        class: Class,
    },
}

impl Impossibility {
    /// Whether two events are impossible for the same reason, wherever they are.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        self.without_visits() == other.without_visits()
    }

    fn without_visits(&self) -> Self {
        use ContradictionReason::{Degree, Marker, OwnOpposite, Rotation};
        match *self {
            Self::Walk(Degree { degrees, .. }) => Self::Walk(Degree { visits: [0; 2], degrees }),
            Self::Walk(Marker { sightings, .. }) => {
                Self::Walk(Marker { visits: [0; 2], sightings })
            }
            Self::Walk(Rotation { .. }) => Self::Walk(Rotation { visit: 0 }),
            Self::Walk(OwnOpposite { .. }) => Self::Walk(OwnOpposite { visit: 0 }),
            other => other,
        }
    }
}

/// The index of the first event of a trace that no world of any size explains together with all before
/// it, and why. `None` if some world explains the trace, or if this is not known: it is decided for the
/// directional marker and for none, in the class of all worlds.
#[must_use]
pub fn first_impossible(
    trace: &Trace,
    marker: &dyn Marker,
    class: Class,
) -> Option<(usize, Impossibility)> {
    let directional = marker.name() == Directional.name();
    if !directional && marker.name() != NoMarker.name() {
        return None;
    }
    let first = |is: &dyn Fn(&Percept) -> bool| Some(2 * trace.percepts().iter().position(is)?);
    let walk = match fold(trace.percepts(), trace.doors()) {
        Err(FoldError::Contradiction(TrailContradiction { event, reason })) => {
            Some((event, Impossibility::Walk(reason)))
        }
        Ok(_) | Err(FoldError::TooManyDarts { .. }) => None,
    };
    let marked = first(&|percept| !directional && percept.sighting != Sighting::Nothing);
    let crowded = first(&|percept| percept.degree > class.max_degree());
    let marked = marked.map(|event| (event, Impossibility::Marker));
    let crowded = crowded.map(|event| (event, Impossibility::Degree { class }));
    [walk, marked, crowded].into_iter().flatten().min_by_key(|(event, _)| *event)
}
