//! Another world that explains a log as well, because the marker does not distinguish it from the first one.
//! Section 2.2, Figure 1.

use serde::{Serialize, Serializer};
use toposlam_model::{
    aid::State,
    ambiguity::{self, Twins, twins},
    embedded_graph::{Dart, EmbeddedGraph},
    folding::SmallestWorld,
    format::{named_world::NamedWorld, world_file},
    isomorphism::isomorphism,
    marker::{Marker, MarkerKind, NoMarker},
    trace::poses,
};

use super::{
    config::ConformConfig,
    judgement::Judgement,
    known_world::{KnownWorld, state_of_fixed},
};

/// Another world that explains a log, and that no walk distinguishes from the first one.
#[derive(Clone, Debug, Serialize)]
pub struct TwinWorld {
    pub vertices: usize,
    pub edges: usize,
    pub genus: usize,
    /// What it is in the paper.
    pub figure: Option<&'static str>,
    /// The number of such worlds that were found.
    pub worlds: usize,
    #[serde(serialize_with = "world_json")]
    pub world: NamedWorld,
    #[serde(skip)]
    pub marker: MarkerKind,
    /// The dart that places the marker in the first world.
    #[serde(skip)]
    pub first_marker: Dart,
    /// What the first world is in the paper.
    #[serde(skip)]
    pub first_figure: Option<&'static str>,
    /// Whether there may be more such worlds.
    #[serde(skip)]
    pub may_be_more: bool,
}

/// Worlds that the paper draws.
const FIGURES: [(&str, &str); 2] = [
    ("Figure 1(a)", include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../worlds/figure-1a.toml"))),
    ("Figure 1(b)", include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../worlds/figure-1b.toml"))),
];

impl TwinWorld {
    /// A world that no walk distinguishes from the known world of a log, or from the smallest one that explains
    /// it; the log is judged in it again. A robot without a marker has too many.
    pub(super) fn find(judgement: &Judgement, config: &ConformConfig) -> Option<Self> {
        let marker = config.aid.fixed()?;
        let diverges = judgement.divergence.is_some() || judgement.contradiction.is_some();
        if diverges || marker == NoMarker {
            return None;
        }
        let fits = |graph: &EmbeddedGraph, start: State| {
            poses(graph, &marker, &[start], &judgement.trace).misfit.is_none()
        };
        let (graph, start) = match (&config.world, &judgement.smallest) {
            (Some(KnownWorld { graph, states }), _) => {
                (graph, states.iter().filter_map(state_of_fixed).find(|&start| fits(graph, start))?)
            }
            (None, Some(SmallestWorld::World { graph, marker: placed, .. })) => {
                (graph, State { pose: Dart(0), placed: (*placed)? })
            }
            _ => return None,
        };
        let first_marker = start.placed;
        let Twins { worlds, may_be_more } = twins(graph, &marker, first_marker, start.pose, &());
        let explains = |twin: &&ambiguity::Twin| {
            let placed = Marker::first_alike(&marker, &twin.graph, twin.facing);
            fits(&twin.graph, State { pose: twin.pose, placed })
        };
        let explaining: Vec<_> = worlds.iter().filter(explains).collect();
        // One that the paper draws is preferred.
        let drawn = explaining.iter().find(|twin| figure(&twin.graph).is_some());
        let ambiguity::Twin { graph: other, facing, .. } = drawn.or(explaining.first())?;
        let world = NamedWorld::discovered("another-world", "", other, *facing);
        Some(Self {
            vertices: other.vertex_count(),
            edges: other.edge_count(),
            genus: other.genus(),
            figure: figure(other),
            worlds: explaining.len(),
            world,
            marker,
            first_marker,
            first_figure: figure(graph),
            may_be_more,
        })
    }
}

fn world_json<S: Serializer>(world: &NamedWorld, serializer: S) -> Result<S::Ok, S::Error> {
    world_file::to_json(world).serialize(serializer)
}

/// What a world is in the paper, up to isomorphism.
fn figure(graph: &EmbeddedGraph) -> Option<&'static str> {
    let is = |(_, text): &&(&str, &str)| {
        let figure = world_file::read(text.as_bytes());
        figure.is_ok_and(|figure| isomorphism(&figure.graph, graph).is_ok())
    };
    FIGURES.iter().find(is).map(|(name, _)| *name)
}
