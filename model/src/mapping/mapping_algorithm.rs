//! The explorers of this crate, to choose from at run time.

use std::{fmt, str::FromStr};

use super::{Explorer, ExplorerInfo, MapWalk, Mapped, Observed, Observer, explore};
use crate::{aid::AidKind, world::World};

/// Declares the algorithms: for each its name here and its explorer.
macro_rules! algorithms {
    ($dollar:tt $($(#[$doc:meta])* $name:ident: $explorer:ident,)*) => {
        /// A mapping algorithm of this crate. Any other algorithm implements [`Explorer`].
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum MappingAlgorithm {
            $($(#[$doc])* $name,)*
        }

        impl MappingAlgorithm {
            pub const ALL: &[Self] = &[$(Self::$name,)*];
        }

        /// An expression in which a name is the type of the explorer of an algorithm.
        macro_rules! with_explorer {
            ($dollar algorithm:expr, $dollar alias:ident => $dollar body:expr) => {
                match $dollar algorithm {
                    $($crate::mapping::MappingAlgorithm::$name => {
                        type $dollar alias = $crate::mapping::$explorer;
                        $dollar body
                    })*
                }
            };
        }
    };
}

algorithms! { $
    /// The paper's Algorithm 1. It is that of a log that names none.
    #[default]
    Algorithm1: Algorithm1Run,
    /// The movable marker algorithm, for worlds without loops and parallel edges.
    MovableMarker: MovableMarkerRun,
    Folding: FoldingRun,
}

pub(crate) use with_explorer;

impl MappingAlgorithm {
    pub fn info(self) -> ExplorerInfo {
        with_explorer!(self, E => E::INFO)
    }

    pub fn name(self) -> &'static str {
        self.info().option
    }

    pub fn in_words(self) -> &'static str {
        self.info().in_words
    }

    /// The marking aid with which it maps.
    pub fn aid(self) -> AidKind {
        with_explorer!(self, E => E::default().aid().into())
    }

    /// The algorithms of a robot that cannot carry its marker.
    pub fn with_fixed_marker() -> impl Iterator<Item = Self> {
        Self::ALL.iter().copied().filter(|algorithm| !algorithm.aid().moves())
    }

    /// The most moves that it may make in a world of this size.
    pub fn move_bound(self, edges: usize, vertices: usize) -> u64 {
        with_explorer!(self, E => E::default().move_bound(edges, vertices))
    }

    /// Maps a world, as [`explore`], with a map of at most `max_darts` darts. Returns the robot's walk, too.
    ///
    /// # Errors
    /// See [`Explorer::step`]. The walk then holds what is known so far.
    pub fn map_world<W: World>(
        self,
        world: &mut W,
        max_darts: usize,
        observer: &mut impl Observer<W>,
    ) -> (MapWalk, Mapped<W>) {
        with_explorer!(self, E => {
            let mut explorer = E::default();
            explorer.limit_darts(max_darts);
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

/// From the name of an algorithm of a robot that cannot carry its marker.
impl FromStr for MappingAlgorithm {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        Self::with_fixed_marker().find(|algorithm| algorithm.name() == name).ok_or_else(|| {
            let names: Vec<_> = Self::with_fixed_marker().map(Self::name).collect();
            format!("`{name}` is not {}", names.join(" or "))
        })
    }
}
