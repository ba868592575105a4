//! Another world that explains a log as well, because the marker does not distinguish it from the first one.
//! Section 2.2, Figure 1.

use serde::Serialize;
use serde_json::Value;
use toposlam_conform::Judgement;
use toposlam_model::{
    ambiguity::{Twin, Twins, twins},
    embedded_graph::{Dart, EmbeddedGraph},
    folding::SmallestWorld,
    format::{named_world::NamedWorld, world_file},
    isomorphism::isomorphism,
    marker::{Marker, NoMarker},
    trace::poses,
    world::State,
};

use super::known_world::Known;
use crate::{
    cli::text::{counted, vertices},
    picture::{self, WorldPicture},
};

/// Another world that explains a log, and that no walk distinguishes from the first one.
pub(super) struct OtherWorld {
    world: NamedWorld,
    marker: &'static dyn Marker,
    /// The dart that places the marker in the first world.
    first_marker: Dart,
    /// What the first world is in the paper, and what this one is.
    figures: [Option<&'static str>; 2],
    /// The number of such worlds that were found.
    count: usize,
    /// Whether there may be more.
    may_be_more: bool,
}

/// The other world, in JSON.
#[derive(Serialize)]
pub(super) struct OtherWorldFields {
    vertices: usize,
    edges: usize,
    genus: usize,
    /// What it is in the paper.
    figure: Option<&'static str>,
    /// The number of such worlds that were found.
    worlds: usize,
    world: Value,
}

/// Worlds that the paper draws.
const FIGURES: [(&str, &str); 2] = [
    ("Figure 1(a)", include_str!("../../../worlds/figure-1a.toml")),
    ("Figure 1(b)", include_str!("../../../worlds/figure-1b.toml")),
];

impl OtherWorld {
    /// A world that no walk distinguishes from the known world of a log, or from the smallest one that explains
    /// it; the log is judged in it again. A robot without a marker has too many.
    pub(super) fn of(
        judgement: &Judgement,
        known: Option<&Known>,
        marker: &'static dyn Marker,
    ) -> Option<Self> {
        if judgement.divergence.is_some() || marker.name() == NoMarker.name() {
            return None;
        }
        let (graph, start) = match (known, &judgement.smallest) {
            (Some(known), _) => {
                let graph = &known.world.graph;
                let states = known.question().states;
                let start =
                    states.into_iter().find(|&start| fits(judgement, graph, marker, start))?;
                (graph, start)
            }
            (None, Some(SmallestWorld::World { graph, marker: placed, .. })) => {
                (graph, State { pose: Dart(0), placed: Some((*placed)?) })
            }
            _ => return None,
        };
        let Twins { worlds, may_be_more } = twins(graph, marker, start.placed?, start.pose, &());
        let explains = |twin: &&Twin| {
            let placed = Some(marker.first_alike(&twin.graph, twin.facing));
            fits(judgement, &twin.graph, marker, State { pose: twin.pose, placed })
        };
        let explaining: Vec<_> = worlds.iter().filter(explains).collect();
        let count = explaining.len();
        // One that the paper draws is preferred.
        let known = explaining.iter().find(|twin| figure(&twin.graph).is_some());
        let Twin { graph: other, facing, .. } = known.or(explaining.first())?;
        let world = NamedWorld::discovered("another-world", "", other, *facing);
        let figures = [graph, other].map(figure);
        let first_marker = start.placed?;
        Some(Self { world, marker, first_marker, figures, count, may_be_more })
    }

    /// The sentence of the report.
    pub(super) fn in_words(&self) -> String {
        let Self { world, marker, figures: [first, other], count, may_be_more, .. } = self;
        let graph = &world.graph;
        let first = first.map_or(String::new(), |figure| format!(", {figure} of the paper,"));
        let other = other.map_or(String::new(), |figure| format!(": {figure} of the paper"));
        let size = format!(
            "{}, {} and genus {}",
            vertices(graph.vertex_count()),
            counted(graph.edge_count(), "edge"),
            graph.genus()
        );
        let more = match (count, may_be_more) {
            (1, false) => String::new(),
            (count, false) => format!(" There are {count} such worlds with as many edges."),
            (count, true) => format!(" There are at least {count} such worlds with as many edges."),
        };
        format!(
            "Another world explains this log as well, with {size}{other}. With an {} marker no walk \
             distinguishes it from the world above{first}.{more}",
            marker.name()
        )
        .replace(",.", ".")
    }

    /// The dart that places the marker in the first world.
    pub(super) fn first_marker(&self) -> Dart {
        self.first_marker
    }

    /// The drawing.
    pub(super) fn svg(&self) -> String {
        let caption =
            self.figures[1].map_or(String::new(), |figure| format!("{figure} of the paper"));
        let picture = WorldPicture { marker: self.marker, ..WorldPicture::from(&self.world) };
        picture::svg(&WorldPicture { title: "another world", caption: &caption, ..picture })
    }

    pub(super) fn fields(&self) -> OtherWorldFields {
        let graph = &self.world.graph;
        OtherWorldFields {
            vertices: graph.vertex_count(),
            edges: graph.edge_count(),
            genus: graph.genus(),
            figure: self.figures[1],
            worlds: self.count,
            world: world_file::to_json(&self.world),
        }
    }
}

/// Whether the log fits a world from a start.
fn fits(
    judgement: &Judgement,
    graph: &EmbeddedGraph,
    marker: &'static dyn Marker,
    start: State,
) -> bool {
    poses(graph, &marker, &[start], &judgement.trace).misfit.is_none()
}

/// What a world is in the paper, up to isomorphism.
fn figure(graph: &EmbeddedGraph) -> Option<&'static str> {
    let is = |(_, text): &&(&str, &str)| {
        let figure = world_file::read(text.as_bytes());
        figure.is_ok_and(|figure| isomorphism(&figure.graph, graph).is_ok())
    };
    FIGURES.iter().find(is).map(|(name, _)| *name)
}
