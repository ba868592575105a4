//! Marking aids: what a robot may use to mark places, as small transition systems on a world.
//!
//! An aid adds a sighting to each percept. A [fixed marker](crate::marker) does no more: it lies where the facing dart of
//! the start placed it. Other aids have a state, and actions beside doors:
//!
//! * [`markers`]: markers that are picked up, carried and dropped (Dudek, Jenkin, Milios and Wilkes, 1989 and 1991);
//! * [`pointer`](mod@pointer): a directional marker that is carried;
//! * [`directional_and_movable`](mod@directional_and_movable): a directional marker that stays, and an undirected one
//!   that is carried;
//! * [`string`]: a string that is paid out along edges (Wang, Jenkin and Dymond);
//! * [`team`]: other robots (Bender and Slonim, 1994).
//!
//! Other senses are aids, too, that neither move nor lie anywhere:
//!
//! * [`binoculars`](mod@binoculars): the robot sees what is near (Chalopin, Godard and Naudin, 2015);
//! * [`compass`](mod@compass): it sees in which direction each door leads, in a world whose corridors have directions.

mod action;
pub mod binoculars;
pub mod compass;
pub mod directional_and_movable;
pub mod markers;
pub mod pointer;
pub mod string;
pub mod team;

use std::{
    fmt,
    hash::Hash,
    ops::{Deref, DerefMut, RangeInclusive},
};

use smallvec::SmallVec;
use thiserror::Error;

use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    marker::{Marker, MarkerKind, MarkerPart},
    percept::Sighting,
};

pub use action::{Action, AidAction, RefusedAction, UnknownAction};
use binoculars::Binoculars;
use directional_and_movable::DirectionalAndMovable;
use markers::MovableMarkers;
use pointer::MovablePointer;
use string::LaidString;
use team::Team;

/// Where the robot is, and where its aid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct State<P = Dart> {
    pub pose: Dart,
    /// The state of the aid; of a fixed marker, the first of the facing darts that place it so.
    pub placed: P,
}

/// The names of places of a world.
pub trait PlaceNames {
    /// The name of the vertex of a dart.
    fn vertex(&self, dart: Dart) -> String;

    /// The name of a dart, with that of its vertex.
    fn dart(&self, dart: Dart) -> String;
}

/// A marking aid.
///
/// The robot knows what it did, so it knows what it holds: states in which it perceives the same and
/// [holds](Self::held) the same have the same actions.
pub trait Aid: Sync {
    /// Where markers lie, where the string runs, where the other robots stand.
    type Placed: Clone + fmt::Debug + Hash + Ord + Send + Sync;

    /// Its name on the command line.
    fn name(&self) -> &'static str;

    /// A sentence about what it is and when it is noticed.
    fn about(&self) -> &'static str;

    /// Its state at a start with this facing dart.
    fn placed(&self, graph: &EmbeddedGraph, facing: Dart) -> Self::Placed;

    /// Whether a state that somebody claims has the form of one of its own in this graph.
    fn exists(&self, graph: &EmbeddedGraph, placed: &Self::Placed) -> bool;

    /// What it adds to the percept of the robot.
    fn sighting(&self, graph: &EmbeddedGraph, state: &State<Self::Placed>) -> Sighting;

    /// The first of the facing darts that place it as this one does.
    fn first_alike(&self, graph: &EmbeddedGraph, facing: Dart) -> Dart;

    /// The poses in which the robot may begin, given the aid: all poses at which it is noticed as
    /// at the start, in the order of their numbers.
    fn starts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<Dart>;

    /// What a picture of the start shows.
    fn parts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<MarkerPart>;

    /// A state in words, after the robot's pose; nothing for a fixed marker.
    fn placed_text(&self, _placed: &Self::Placed, _names: &dyn PlaceNames) -> String {
        String::new()
    }

    /// Whether it can be seen at every vertex of a graph. Otherwise nothing that is found there is a proof.
    fn is_seen_everywhere(&self, _graph: &EmbeddedGraph) -> bool {
        true
    }

    /// In words, a place where it [cannot be seen](Self::is_seen_everywhere).
    fn unseen_place(&self) -> String {
        "a vertex".to_owned()
    }

    /// Whether what it adds to a percept depends on the vertices of its darts and of the pose, and on the
    /// indices there, and on nothing else. What is behind their doors may then be undecided.
    fn is_local(&self) -> bool {
        false
    }

    /// Whether it has a state that changes.
    fn moves(&self) -> bool {
        false
    }

    /// What the robot knows of it without a sighting, as a number: what it carries.
    fn held(&self, _state: &State<Self::Placed>) -> u32 {
        0
    }

    /// The actions beside doors.
    fn actions(&self, _graph: &EmbeddedGraph, _state: &State<Self::Placed>) -> Vec<AidAction> {
        Vec::new()
    }

    /// Does one of the [actions](Self::actions).
    ///
    /// # Errors
    /// Returns an error if it is not possible. The state is then as it was.
    fn act(
        &self,
        _graph: &EmbeddedGraph,
        _state: &mut State<Self::Placed>,
        action: AidAction,
    ) -> Result<(), RefusedAction> {
        Err(action.refused())
    }

    /// What happens when the robot leaves its vertex by a dart. The pose is still the one before.
    ///
    /// # Errors
    /// Returns an error if the robot cannot leave so. The state is then as it was.
    #[inline]
    fn leave(
        &self,
        _graph: &EmbeddedGraph,
        _state: &mut State<Self::Placed>,
        _by: Dart,
    ) -> Result<(), RefusedAction> {
        Ok(())
    }
}

/// A fixed marker is an aid without actions.
impl<M: Marker> Aid for M {
    type Placed = Dart;

    fn name(&self) -> &'static str {
        Marker::name(self)
    }

    fn about(&self) -> &'static str {
        Marker::about(self)
    }

    #[inline]
    fn placed(&self, graph: &EmbeddedGraph, facing: Dart) -> Dart {
        Marker::first_alike(self, graph, facing)
    }

    fn exists(&self, graph: &EmbeddedGraph, placed: &Dart) -> bool {
        placed.at() < graph.dart_count()
    }

    #[inline]
    fn sighting(&self, graph: &EmbeddedGraph, state: &State) -> Sighting {
        Marker::sighting(self, graph, state.placed, state.pose)
    }

    fn first_alike(&self, graph: &EmbeddedGraph, facing: Dart) -> Dart {
        Marker::first_alike(self, graph, facing)
    }

    fn starts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<Dart> {
        Marker::starts(self, graph, facing)
    }

    fn parts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<MarkerPart> {
        Marker::parts(self, graph, facing)
    }

    fn is_local(&self) -> bool {
        Marker::is_local(self)
    }
}

/// Where the parts of an aid are, as darts; none for a part that the robot holds.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Places(SmallVec<[Option<Dart>; 4]>);

impl Places {
    pub fn from_elem(place: Option<Dart>, parts: usize) -> Self {
        Self(SmallVec::from_elem(place, parts))
    }

    pub fn from_slice(places: &[Option<Dart>]) -> Self {
        Self(SmallVec::from_slice(places))
    }
}

/// A slice is copied at once, where the clone of a `SmallVec` takes its elements one by one.
impl Clone for Places {
    #[inline]
    fn clone(&self) -> Self {
        Self::from_slice(&self.0)
    }
}

impl Deref for Places {
    type Target = SmallVec<[Option<Dart>; 4]>;

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl DerefMut for Places {
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.0
    }
}

/// The place of a part that the robot picks up, or drops at a dart, by one of the actions that are possible.
fn handled(
    possible: &[AidAction],
    action: AidAction,
    here: Dart,
) -> Result<Option<Dart>, RefusedAction> {
    if possible.contains(&action) {
        Ok((action == AidAction::Drop).then_some(here))
    } else {
        Err(action.refused())
    }
}

/// Whether places are darts of a graph, and so many.
fn are_in(placed: &Places, graph: &EmbeddedGraph, number: RangeInclusive<usize>) -> bool {
    let is_in = |dart: &Option<Dart>| dart.is_none_or(|dart| dart.at() < graph.dart_count());
    number.contains(&placed.len()) && placed.iter().all(is_in)
}

/// A marking aid of this crate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AidKind {
    Fixed(MarkerKind),
    Markers(MovableMarkers),
    Pointer(MovablePointer),
    DirectionalAndMovable(DirectionalAndMovable),
    String(LaidString),
    Team(Team),
    Binoculars(Binoculars),
}

/// An expression with an aid of another kind, or with a fixed marker.
macro_rules! with_aid {
    ($kind:expr, $marker:ident => $fixed:expr, $aid:ident => $other:expr) => {
        match $kind {
            AidKind::Fixed(marker) => {
                let $marker: &dyn Marker = marker;
                $fixed
            }
            AidKind::Markers($aid) => $other,
            AidKind::Pointer($aid) => $other,
            AidKind::DirectionalAndMovable($aid) => $other,
            AidKind::String($aid) => $other,
            AidKind::Team($aid) => $other,
            AidKind::Binoculars($aid) => $other,
        }
    };
}

/// The same with an aid of this crate, or with a marker of your own.
macro_rules! with_any_aid {
    ($any:expr, $marker:ident => $fixed:expr, $aid:ident => $kind:expr) => {
        match $any {
            AnyAid::Kind($aid) => $kind,
            AnyAid::Own($marker) => $fixed,
        }
    };
}

/// The fixed markers, then the aids that move, and then other senses. Each has finitely many states in a graph, so all of them can be
/// searched; [a string as long as it takes](LaidString::of_any_length) has not, and is not among them.
pub const AIDS: [AidKind; 26] = [
    AidKind::Fixed(MarkerKind::NoMarker),
    AidKind::Fixed(MarkerKind::Undirected),
    AidKind::Fixed(MarkerKind::Directional),
    AidKind::Fixed(MarkerKind::UndirectedEdge),
    AidKind::Fixed(MarkerKind::DirectedEdge),
    AidKind::Fixed(MarkerKind::TwoIdentical),
    AidKind::Fixed(MarkerKind::TwoDistinct),
    AidKind::Markers(markers::MOVABLE),
    AidKind::Markers(MovableMarkers::alike(2)),
    AidKind::Markers(MovableMarkers::alike(3)),
    AidKind::Markers(MovableMarkers::alike(4)),
    AidKind::Markers(MovableMarkers::distinct(2)),
    AidKind::Markers(MovableMarkers::distinct(3)),
    AidKind::Markers(MovableMarkers::distinct(4)),
    AidKind::Pointer(MovablePointer),
    AidKind::DirectionalAndMovable(DirectionalAndMovable),
    AidKind::String(LaidString::of(1)),
    AidKind::String(LaidString::of(2)),
    AidKind::String(LaidString::of(3)),
    AidKind::Team(Team::of(2, true)),
    AidKind::Team(Team::of(2, false)),
    AidKind::Team(Team::of(3, true)),
    AidKind::Team(Team::of(3, false)),
    AidKind::Binoculars(Binoculars::of(1)),
    AidKind::Binoculars(Binoculars::of(2)),
    AidKind::Binoculars(Binoculars::of(3)),
];

/// The aids with few states: the fixed markers, and the one that can be carried.
pub const FEW_STATES: &[AidKind] = AIDS.split_at(8).0;

impl AidKind {
    pub fn name(self) -> &'static str {
        Aid::name(&self)
    }

    pub fn about(self) -> &'static str {
        Aid::about(&self)
    }

    /// Whether it has a state that changes.
    pub fn moves(self) -> bool {
        Aid::moves(&self)
    }

    /// Whether it is for marking places; other senses are not.
    pub fn marks(self) -> bool {
        !matches!(self, Self::Binoculars(_))
    }

    /// Whether a robot with it sees such things of it. Everybody may see nothing.
    pub fn shows(self, sighting: Sighting) -> bool {
        use MarkerKind::{
            DirectedEdge, Directional, TwoDistinct, TwoIdentical, Undirected, UndirectedEdge,
        };
        match sighting {
            Sighting::Nothing => true,
            Sighting::Pointing(_) => matches!(self, Self::Fixed(Directional) | Self::Pointer(_)),
            Sighting::TwoMarkers(_) => matches!(self, Self::DirectionalAndMovable(_)),
            Sighting::Lying(count) => match self {
                Self::Fixed(Undirected) => count == 1,
                Self::Fixed(TwoIdentical) => count <= 2,
                Self::Markers(markers) => markers.are_alike() && count <= markers.count().into(),
                _ => false,
            },
            Sighting::These(set) => {
                let count = match self {
                    Self::Fixed(TwoDistinct) => 2,
                    Self::Markers(markers) if !markers.are_alike() => markers.count(),
                    _ => 0,
                };
                set.numbers().all(|number| number < count.into())
            }
            Sighting::Passed => self == Self::Fixed(UndirectedEdge),
            Sighting::PassedAlong | Sighting::PassedAgainst => self == Self::Fixed(DirectedEdge),
            Sighting::String(_) => matches!(self, Self::String(_)),
            Sighting::Team(view) => matches!(self, Self::Team(team) if team.shows(view)),
            Sighting::Ball(_) => matches!(self, Self::Binoculars(_)),
            Sighting::Compass(_) => false,
        }
    }

    /// The fixed marker that it is.
    pub fn fixed(self) -> Option<MarkerKind> {
        if let Self::Fixed(marker) = self { Some(marker) } else { None }
    }
}

impl From<MarkerKind> for AidKind {
    fn from(marker: MarkerKind) -> Self {
        Self::Fixed(marker)
    }
}

impl From<MovableMarkers> for AidKind {
    fn from(markers: MovableMarkers) -> Self {
        Self::Markers(markers)
    }
}

/// A marking aid of this crate, or a marker of your own.
#[derive(Clone, Copy, Debug)]
pub enum AnyAid<'m> {
    Kind(AidKind),
    Own(&'m dyn Marker),
}

impl<A: Into<AidKind>> From<A> for AnyAid<'_> {
    fn from(aid: A) -> Self {
        Self::Kind(aid.into())
    }
}

impl<'m> From<&'m dyn Marker> for AnyAid<'m> {
    fn from(marker: &'m dyn Marker) -> Self {
        Self::Own(marker)
    }
}

/// Implements [`Aid`] by dispatch. The place of a fixed marker is its only one.
macro_rules! dispatched {
    ($type:ty, $with:ident) => {
        impl Aid for $type {
            type Placed = Places;

            fn name(&self) -> &'static str {
                $with!(self, marker => Marker::name(marker), aid => aid.name())
            }

            fn about(&self) -> &'static str {
                $with!(self, marker => Marker::about(marker), aid => aid.about())
            }

            fn placed(&self, graph: &EmbeddedGraph, facing: Dart) -> Places {
                $with!(
                    self,
                    marker => Places::from_elem(Some(Marker::first_alike(marker, graph, facing)), 1),
                    aid => aid.placed(graph, facing)
                )
            }

            fn exists(&self, graph: &EmbeddedGraph, placed: &Places) -> bool {
                $with!(
                    self,
                    _marker => are_in(placed, graph, 1..=1) && placed.iter().all(Option::is_some),
                    aid => aid.exists(graph, placed)
                )
            }

            fn sighting(&self, graph: &EmbeddedGraph, state: &State<Places>) -> Sighting {
                $with!(
                    self,
                    marker => {
                        let facing = state.placed.first().copied().flatten();
                        Marker::sighting(marker, graph, facing.unwrap_or(state.pose), state.pose)
                    },
                    aid => aid.sighting(graph, state)
                )
            }

            fn first_alike(&self, graph: &EmbeddedGraph, facing: Dart) -> Dart {
                $with!(
                    self,
                    marker => Marker::first_alike(marker, graph, facing),
                    aid => aid.first_alike(graph, facing)
                )
            }

            fn starts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<Dart> {
                $with!(
                    self,
                    marker => Marker::starts(marker, graph, facing),
                    aid => aid.starts(graph, facing)
                )
            }

            fn parts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<MarkerPart> {
                $with!(
                    self,
                    marker => Marker::parts(marker, graph, facing),
                    aid => aid.parts(graph, facing)
                )
            }

            fn is_seen_everywhere(&self, graph: &EmbeddedGraph) -> bool {
                $with!(self, _marker => true, aid => aid.is_seen_everywhere(graph))
            }

            fn unseen_place(&self) -> String {
                $with!(self, marker => Aid::unseen_place(&marker), aid => aid.unseen_place())
            }

            fn is_local(&self) -> bool {
                $with!(self, marker => Marker::is_local(marker), aid => aid.is_local())
            }

            fn moves(&self) -> bool {
                $with!(self, _marker => false, aid => Aid::moves(aid))
            }

            fn placed_text(&self, placed: &Places, names: &dyn PlaceNames) -> String {
                $with!(self, _marker => String::new(), aid => aid.placed_text(placed, names))
            }

            fn held(&self, state: &State<Places>) -> u32 {
                $with!(self, _marker => 0, aid => aid.held(state))
            }

            fn actions(&self, graph: &EmbeddedGraph, state: &State<Places>) -> Vec<AidAction> {
                $with!(self, _marker => Vec::new(), aid => aid.actions(graph, state))
            }

            fn act(
                &self,
                graph: &EmbeddedGraph,
                state: &mut State<Places>,
                action: AidAction,
            ) -> Result<(), RefusedAction> {
                $with!(
                    self,
                    _marker => Err(action.refused()),
                    aid => aid.act(graph, state, action)
                )
            }

            fn leave(
                &self,
                graph: &EmbeddedGraph,
                state: &mut State<Places>,
                by: Dart,
            ) -> Result<(), RefusedAction> {
                $with!(self, _marker => Ok(()), aid => aid.leave(graph, state, by))
            }
        }
    };
}

dispatched!(AidKind, with_aid);
dispatched!(AnyAid<'_>, with_any_aid);

#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("`{name}` is not a marking aid; they are {names}", name = .0.escape_debug(), names = AIDS.map(AidKind::name).join(", "))]
pub struct UnknownAid(String);

/// The marking aid with this name.
///
/// # Errors
/// Returns an error if there is none. The message lists the names of all.
pub fn named(name: &str) -> Result<AidKind, UnknownAid> {
    AIDS.into_iter().find(|aid| aid.name() == name).ok_or_else(|| UnknownAid(name.to_owned()))
}
