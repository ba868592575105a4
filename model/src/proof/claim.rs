//! What a proof claims.

use thiserror::Error;

use super::{
    ChoiceLine, FoldedWalk, PerceivedWalk, UnionStep, WalkContradiction, WalkEnd, fold_walk,
};
use crate::{
    aid::AidAction,
    ambiguity::{self, Comparison},
    counts::{counted, grouped},
    embedded_graph::{Dart, EmbeddedGraph},
    folding::MAX_DARTS,
    isomorphism::isomorphism,
    marker::{Directional, MarkerKind},
    percept::{Door, Sighting},
    visits::ChosenAlternative,
};

/// A claim, and what shows that it is true.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Claim {
    /// The walk is one in the world from this pose, and in no other world.
    Determined { from: Dart, steps: Vec<UnionStep> },
    /// The walk is one in no world.
    Unexplained { steps: Vec<UnionStep>, contradiction: WalkContradiction },
    /// The walk is one in the world from this pose.
    Conforms { from: Dart },
    /// The walk is one in the world from none of these poses; `None`: from no pose.
    Diverges { from: Option<Vec<Dart>> },
    /// The visits fit the world from this pose, with these alternatives.
    Fits { from: Dart, choice: Vec<ChosenAlternative> },
    /// The visits fit the world from none of these poses, whatever is chosen; `None`: from no pose.
    Misfits { from: Option<Vec<Dart>> },
    /// The visits fit no world, whatever is chosen.
    Impossible { lines: Vec<ChoiceLine> },
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

impl WalkPair {
    /// A walk of a robot with a fixed marker, which takes nothing but doors.
    pub fn new(from: [Dart; 2], walk: &ambiguity::Walk) -> Self {
        Self { from, doors: walk.actions.iter().filter_map(|action| action.door()).collect() }
    }
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
    #[error("the junctions on the walk have more than {} doors together", grouped(MAX_DARTS as u128))]
    TooManyDarts,
    #[error("only a directional marker shows that a walk determines its world")]
    OtherMarker,
    #[error("the walk does not determine its world: {} never followed", counted_doors(*.0))]
    Open(usize),
    #[error("proofs are about fixed markers and about one that is carried, and not about `{0}`")]
    Aid(&'static str),
    #[error("proofs about `{0}` need a known world")]
    AidWithoutWorld(&'static str),
    #[error(
        "several percepts are possible at some visits, and for this marker no world is searched"
    )]
    Possible,
    #[error(
        "several percepts are possible at some visits, and the search for a world that explains them ended early"
    )]
    SearchEnded,
    #[error("the proof that no percepts of these visits are possible has too many lines")]
    TooManyChoices,
    #[error("some world explains these visits")]
    PossibleInSomeWorld,
    #[error("the robot drove where its scanner did not look")]
    UnseenWay,
    #[error("the map is not complete")]
    NoMap,
    #[error("the map does not give this walk")]
    NotInMap,
    #[error("no world was found that gives this walk")]
    NoWorldFound,
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
            Self::Fits { .. } => "fits",
            Self::Misfits { .. } => "misfits",
            Self::Impossible { .. } => "impossible",
            Self::Indistinguishable { .. } => "indistinguishable",
            Self::Distinguishable { .. } => "distinguishable",
            Self::Isomorphic { .. } => "isomorphic",
            Self::NotIsomorphic { .. } => "not-isomorphic",
        }
    }

    /// That a walk from this pose determines its world, which needs a directional marker.
    ///
    /// # Errors
    /// Returns an error if it does not.
    pub fn determined(
        walk: &PerceivedWalk,
        marker: MarkerKind,
        from: Dart,
    ) -> Result<Self, NotProved> {
        let FoldedWalk { steps, end } = fold_walk(walk, marker);
        match end {
            WalkEnd::Complete if marker == Directional => Ok(Self::Determined { from, steps }),
            WalkEnd::Complete => Err(NotProved::OtherMarker),
            WalkEnd::Open(doors) => Err(NotProved::Open(doors)),
            WalkEnd::Contradiction { .. } => Err(NotProved::Impossible),
        }
    }

    /// That no walk from these poses distinguishes two worlds, which have fixed markers.
    pub fn indistinguishable(comparison: &Comparison<'_>, poses: [Dart; 2]) -> Self {
        let relation = comparison.relation(poses).map_or_else(Vec::new, |relation| relation.0);
        let pairs = relation.into_iter().map(|(one, other)| [one.pose, other.pose]).collect();
        Self::Indistinguishable { pairs }
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
            walk.map(|walk| WalkPair::new([first, dart], &walk))
        };
        Self::NotIsomorphic { walks: other.darts().filter_map(walk_to).collect() }
    }
}

/// Whether a walk with this marker has a contradiction in each world, as far as its folding shows: the claim, and the
/// walk up to there.
pub fn unexplained(walk: &PerceivedWalk, marker: MarkerKind) -> Option<(PerceivedWalk, Claim)> {
    let FoldedWalk { steps, end } = fold_walk(walk, marker);
    match end {
        WalkEnd::Contradiction { visit, contradiction } => {
            Some((walk.clone().up_to(visit), Claim::Unexplained { steps, contradiction }))
        }
        WalkEnd::Complete | WalkEnd::Open(_) => None,
    }
}
