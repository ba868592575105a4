//! What a proof claims.

use thiserror::Error;

use super::{Contradiction, FoldedWalk, Step, Walk, WalkEnd, fold_walk};
use crate::{
    aid::{Action, AidAction},
    ambiguity::Comparison,
    counts::counted,
    embedded_graph::{Dart, EmbeddedGraph},
    isomorphism::isomorphism,
    marker::{Directional, MarkerKind},
    percept::{Door, Sighting},
};

/// A claim, and what shows that it is true.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Claim {
    /// The walk is one in the world from this pose, and in no other world.
    Determined { from: Dart, steps: Vec<Step> },
    /// The walk is one in no world.
    Unexplained { steps: Vec<Step>, contradiction: Contradiction },
    /// The walk is one in the world from this pose.
    Conforms { from: Dart },
    /// The walk is one in the world from none of these poses; `None`: from no pose.
    Diverges { from: Option<Vec<Dart>> },
    /// From the first pair of poses no walk distinguishes the two worlds: these pairs are a bisimulation.
    Indistinguishable { pairs: Vec<[Dart; 2]> },
    /// Each of these walks distinguishes the two worlds.
    Distinguishable { walks: Vec<WalkPair> },
    /// These are the images of the darts of the first world in the second.
    Isomorphic { images: Vec<Dart> },
    /// Each dart of the second world differs from the first one of the first world by such a walk.
    NotIsomorphic { walks: Vec<WalkPair> },
}

/// One walk from a pose in each of two worlds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WalkPair {
    pub from: [Dart; 2],
    pub doors: Vec<Door>,
}

/// Why there is no proof.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum NotProved {
    #[error("proofs are about fixed markers, and `{0}` is not what a robot sees of one")]
    Sighting(Sighting),
    #[error("proofs are about fixed markers, and the robot did `{0}`")]
    Action(AidAction),
    #[error("the robot got lost, so that its run is not one walk")]
    Lost,
    #[error("nothing was perceived")]
    NoPercept,
    #[error("the walk does not determine its world: {} never followed", counted_doors(*.0))]
    Open(usize),
    #[error("no world gives this walk")]
    Impossible,
}

fn counted_doors(doors: usize) -> String {
    format!("{} {}", counted(doors, "door"), if doors == 1 { "was" } else { "were" })
}

impl Claim {
    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::Determined { .. } => "determined",
            Self::Unexplained { .. } => "unexplained",
            Self::Conforms { .. } => "conforms",
            Self::Diverges { .. } => "diverges",
            Self::Indistinguishable { .. } => "indistinguishable",
            Self::Distinguishable { .. } => "distinguishable",
            Self::Isomorphic { .. } => "isomorphic",
            Self::NotIsomorphic { .. } => "not-isomorphic",
        }
    }

    /// That a walk from this pose determines its world, with a directional marker.
    ///
    /// # Errors
    /// Returns an error if it does not.
    pub fn determined(walk: &Walk, from: Dart) -> Result<Self, NotProved> {
        let FoldedWalk { steps, end } = fold_walk(walk, Directional);
        match end {
            WalkEnd::Complete => Ok(Self::Determined { from, steps }),
            WalkEnd::Open(doors) => Err(NotProved::Open(doors)),
            WalkEnd::Contradiction { .. } => Err(NotProved::Impossible),
        }
    }

    /// Whether two worlds are isomorphic.
    pub fn isomorphism(one: &EmbeddedGraph, other: &EmbeddedGraph) -> Self {
        if let Ok(bijection) = isomorphism(one, other) {
            return Self::Isomorphic { images: bijection.images().to_vec() };
        }
        let first = Dart(0);
        let walk_to = |dart| {
            let comparison = Comparison::new(Directional, (one, first), (other, dart));
            let walk = comparison.walk([first, dart]);
            let doors = walk.map(|walk| doors_of(&walk.actions)).unwrap_or_default();
            WalkPair { from: [first, dart], doors }
        };
        Self::NotIsomorphic { walks: other.darts().map(walk_to).collect() }
    }
}

/// The doors of a walk with a fixed marker, which takes nothing but doors.
fn doors_of(actions: &[Action]) -> Vec<Door> {
    let door = |action: &Action| match action {
        Action::Take(door) => Some(*door),
        Action::Do(_) => None,
    };
    actions.iter().filter_map(door).collect()
}

/// Whether a walk with this marker has a contradiction in each world, as far as its folding shows: the claim, and the
/// walk up to there.
pub fn unexplained(walk: Walk, marker: MarkerKind) -> Option<(Walk, Claim)> {
    let FoldedWalk { steps, end } = fold_walk(&walk, marker);
    match end {
        WalkEnd::Contradiction { visit, contradiction } => {
            Some((walk.up_to(visit), Claim::Unexplained { steps, contradiction }))
        }
        WalkEnd::Complete | WalkEnd::Open(_) => None,
    }
}
