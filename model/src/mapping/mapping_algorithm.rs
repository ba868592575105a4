//! The explorers of this crate, to choose from at run time.

use std::{fmt, str::FromStr};

use super::{ExplorerInfo, MapWalk, Mapped, Observed, Observer, explore};
use crate::{
    aid::{
        AIDS, AidKind, directional_and_movable::DirectionalAndMovable, markers::MovableMarkers,
        pointer::MovablePointer, string::LaidString, team::Team,
    },
    marker::Directional,
    world::World,
};

/// A mapping algorithm of this crate. Any other algorithm implements [`Explorer`](super::Explorer).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum MappingAlgorithm {
    /// The paper's Algorithm 1. It is that of a log that names none.
    #[default]
    Algorithm1,
    Folding,
    /// The movable marker algorithm, for worlds without loops and parallel edges.
    MovableMarkers(MovableMarkers),
    MovablePointer(MovablePointer),
    /// The folding explorer, which also carries a marker.
    DirectionalAndMovable,
    String(LaidString),
    /// With scouts; without headings, for worlds without loops and parallel edges.
    Team(Team),
}

/// An expression in which a name makes explorers of an algorithm.
macro_rules! with_explorer {
    ($algorithm:expr, $new:ident => $body:expr) => {{
        use $crate::mapping::{
            Algorithm1Run, FoldingRun, MappingAlgorithm, MovableMarkerRun, ShortStringRun, TeamRun,
            ThreadRun, WithMovableRun,
        };
        let algorithm: MappingAlgorithm = $algorithm;
        match algorithm {
            MappingAlgorithm::Algorithm1 => {
                let $new = Algorithm1Run::default;
                $body
            }
            MappingAlgorithm::Folding => {
                let $new = FoldingRun::default;
                $body
            }
            MappingAlgorithm::MovableMarkers(_) | MappingAlgorithm::MovablePointer(_) => {
                let $new = move || MovableMarkerRun::with(algorithm.aid());
                $body
            }
            MappingAlgorithm::DirectionalAndMovable => {
                let $new = WithMovableRun::default;
                $body
            }
            MappingAlgorithm::String(string) if string.length().is_some() => {
                let $new = move || ShortStringRun::with(string);
                $body
            }
            MappingAlgorithm::String(_) => {
                let $new = ThreadRun::default;
                $body
            }
            MappingAlgorithm::Team(team) => {
                let $new = move || TeamRun::with(team);
                $body
            }
        }
    }};
}

pub(crate) use with_explorer;

impl MappingAlgorithm {
    /// All of them: those that map with the directional marker, and one for each aid that moves.
    pub fn all() -> impl Iterator<Item = Self> {
        let string = AidKind::String(LaidString::of_any_length());
        let moving = AIDS.into_iter().chain([string]).filter_map(|aid| match aid {
            AidKind::Fixed(_) | AidKind::Binoculars(_) => None,
            AidKind::Markers(markers) => Some(Self::MovableMarkers(markers)),
            AidKind::Pointer(pointer) => Some(Self::MovablePointer(pointer)),
            AidKind::DirectionalAndMovable(_) => Some(Self::DirectionalAndMovable),
            AidKind::String(string) => Some(Self::String(string)),
            AidKind::Team(team) => Some(Self::Team(team)),
        });
        Self::with_fixed_marker().chain(moving)
    }

    /// The algorithms of a robot that cannot carry its marker.
    pub fn with_fixed_marker() -> impl Iterator<Item = Self> {
        [Self::Algorithm1, Self::Folding].into_iter()
    }

    pub fn info(self) -> ExplorerInfo {
        with_explorer!(self, new => super::Explorer::info(&new()))
    }

    pub fn name(self) -> &'static str {
        self.info().option
    }

    pub fn in_words(self) -> &'static str {
        self.info().in_words
    }

    /// The marking aid with which it maps.
    pub fn aid(self) -> AidKind {
        match self {
            Self::Algorithm1 | Self::Folding => AidKind::Fixed(Directional),
            Self::MovableMarkers(markers) => AidKind::Markers(markers),
            Self::MovablePointer(pointer) => AidKind::Pointer(pointer),
            Self::DirectionalAndMovable => AidKind::DirectionalAndMovable(DirectionalAndMovable),
            Self::String(string) => AidKind::String(string),
            Self::Team(team) => AidKind::Team(team),
        }
    }

    /// Whether it maps only worlds without loops and parallel edges, as its aid suffices for no others.
    pub fn needs_simple(self) -> bool {
        match self {
            Self::MovableMarkers(_) => true,
            Self::Team(team) => !team.shows_heading(),
            _ => false,
        }
    }

    /// Whether it uses lengths and directions, if its world has [senses](World::senses).
    pub fn uses_senses(self) -> bool {
        match self {
            Self::Folding | Self::DirectionalAndMovable => true,
            Self::String(string) => string.length().is_some(),
            _ => false,
        }
    }

    /// The most moves that it may make in a world of this size.
    pub fn move_bound(self, edges: usize, vertices: usize) -> u64 {
        with_explorer!(self, new => super::Explorer::move_bound(&new(), edges, vertices))
    }

    /// Maps a world, as [`explore`], with a map of at most `max_darts` darts. Returns the robot's walk, too.
    ///
    /// # Errors
    /// See [`Explorer::step`](super::Explorer::step). The walk then holds what is known so far.
    pub fn map_world<W: World>(
        self,
        world: &mut W,
        max_darts: usize,
        observer: &mut impl Observer<W>,
    ) -> (MapWalk, Mapped<W>) {
        with_explorer!(self, new => {
            let mut explorer = new();
            super::Explorer::limit_darts(&mut explorer, max_darts);
            let mapped = explore(&mut explorer, &mut Observed::new(world, observer));
            (explorer.into(), mapped)
        })
    }
}

impl fmt::Display for MappingAlgorithm {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        out.pad(self.name())
    }
}

impl FromStr for MappingAlgorithm {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        Self::all().find(|algorithm| algorithm.name() == name).ok_or_else(|| {
            let names: Vec<_> = Self::all().map(Self::name).collect();
            format!("`{name}` is no algorithm; they are {}", names.join(", "))
        })
    }
}
