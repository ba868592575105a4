//! A trace, folded: what it proves about its world, and the first event that no world of any size explains.
//! Section 2.1.

use thiserror::Error;
use toposlam_model::{
    aid::AidKind,
    enumerate::Class,
    folding::{ContradictionReason, FoldError, FoldedTrail, TrailError, fold},
    marker::{Directional, NoMarker, Undirected},
    percept::{Percept, Sighting, WalkEvent},
    trace::Trace,
};

/// Why no world of any size explains an event together with all before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum Impossibility {
    /// The walk contradicts itself.
    #[error(transparent)]
    Walk(#[from] ContradictionReason),
    #[error("the robot has no marker, and perceived one")]
    Marker,
    #[error("in a world of class {class} a vertex has at most {} doors", .class.max_degree())]
    Degree { class: Class },
    #[error(
        "in a world of class {class} no hallway leads back to its own junction, and no two hallways join the \
         same two"
    )]
    NotSimple { class: Class },
    #[error("the marker lies at one junction, and was seen at another one")]
    OnePlace,
    #[error("every hallway was followed to its other end, and the marker was not seen")]
    NoPlaceForMarker,
    /// All worlds with these percepts are outside of the class.
    #[error("no world of class {class} explains it")]
    Class { class: Class },
}

impl Impossibility {
    /// The same for events at any place.
    pub(super) fn without_visits(&self) -> Self {
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

/// A trace, folded as far as some world explains it, and until the robot got lost.
#[derive(Clone, Debug)]
pub(crate) struct FoldedTrace {
    /// The folded trail up to the first impossible event or relocation; `None` if there is no event before it, or if the
    /// trail is too large.
    pub(crate) trail: Option<FoldedTrail>,
    /// The index of the first event of the trace that no world of any size explains together with all
    /// before it, and why.
    pub(crate) impossible: Option<(usize, Impossibility)>,
}

impl FoldedTrace {
    /// Folds the trace of a robot with the directional or an undirected marker or without one; for other aids
    /// nothing is decided. That an undirected marker lies at one vertex is not compared here.
    ///
    /// Whether some world of the class explains the trace is exact, except that of a planar world only the
    /// degrees and the edges are compared here.
    pub(crate) fn new(trace: &Trace, aid: AidKind, class: Class) -> Self {
        let folds = [Directional, Undirected, NoMarker].map(AidKind::Fixed);
        if !folds.contains(&aid) {
            return Self { trail: None, impossible: None };
        }
        let folded = trace.before_relocation();
        let (mut trail, walk) = match fold(folded.percepts(), folded.doors()) {
            Ok(trail) => (Some(trail), None),
            Err(FoldError { event, error: TrailError::Contradiction(reason) }) => {
                (None, Some((event.index(), Impossibility::Walk(reason))))
            }
            Err(FoldError { error: TrailError::TooManyDarts, .. }) => (None, None),
        };
        let first = |is: &dyn Fn(&Percept) -> bool, why| {
            let moves = trace.percepts().iter().position(is)?;
            Some((WalkEvent::Percept(moves).index(), why))
        };
        let is_unmarked = aid == AidKind::Fixed(NoMarker);
        let marked = |percept: &Percept| is_unmarked && percept.sighting != Sighting::Nothing;
        let crowded = |percept: &Percept| percept.degree > class.max_degree();
        let marked = first(&marked, Impossibility::Marker);
        let crowded = first(&crowded, Impossibility::Degree { class });
        let mut impossible =
            [walk, marked, crowded].into_iter().flatten().min_by_key(|(event, _)| *event);
        if let Some((event, _)) = impossible {
            trail = folded_before(trace, event);
        }
        if let Some(before) = trail.as_ref().filter(|it| class.is_simple() && !it.is_simple()) {
            let event =
                first_percept(trace, before.moves(), |trail: &FoldedTrail| !trail.is_simple());
            impossible = Some((event, Impossibility::NotSimple { class }));
            trail = folded_before(trace, event);
        }
        if let Some(before) = trail.as_ref().filter(|it| !is_unmarked && !it.may_hold_marker()) {
            let holds = |trail: &FoldedTrail| !trail.may_hold_marker();
            let event = first_percept(trace, before.moves(), holds);
            impossible = Some((event, Impossibility::NoPlaceForMarker));
            trail = folded_before(trace, event);
        }
        Self { trail, impossible }
    }
}

/// The folded trail of the events before an event; `None` if there are none, or if it is too large.
pub(super) fn folded_before(trace: &Trace, event: usize) -> Option<FoldedTrail> {
    let before = trace.up_to(event.checked_sub(1)?).before_relocation();
    fold(before.percepts(), before.doors()).ok()
}

/// The index of the first percept after which something holds for the folded trail. It holds after the last
/// of these moves, and after each percept that follows the first one.
pub(super) fn first_percept(
    trace: &Trace,
    moves: usize,
    holds: impl Fn(&FoldedTrail) -> bool,
) -> usize {
    let (mut low, mut high) = (0, moves);
    while low < high {
        let middle = usize::midpoint(low, high);
        if folded_before(trace, WalkEvent::Door(middle).index()).is_some_and(|trail| holds(&trail))
        {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    WalkEvent::Percept(low).index()
}
