//! Two markers together: a directional one that stays at the start, as in Algorithm 1 (Section 2.3), and an undirected
//! one that the robot picks up, carries and drops.

use super::{
    Aid, AidAction, PlaceNames, Places, RefusedAction, State, are_in,
    markers::{self, MovableMarkers},
};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    marker::{Directional, Marker, MarkerPart},
    percept::{Sighting, TwoMarkersView},
};

/// A directional marker that stays, and an undirected one that can be carried. Its places are the dart along which the
/// directional marker points, and that of the other marker, as of [`MOVABLE`](markers::MOVABLE).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct DirectionalAndMovable;

const MOVABLE: MovableMarkers = markers::MOVABLE;

/// The state without the directional marker.
fn movable(state: &State<Places>) -> State<Places> {
    State {
        pose: state.pose,
        placed: Places::from_slice(state.placed.get(1..).unwrap_or_default()),
    }
}

fn along(placed: &Places) -> Option<Dart> {
    placed.first().copied().flatten()
}

impl Aid for DirectionalAndMovable {
    type Placed = Places;

    fn name(&self) -> &'static str {
        "movable+directional"
    }

    fn about(&self) -> &'static str {
        "two markers at the start vertex: a directional one that stays, and an undirected one that the robot can pick \
         up, carry and drop: which of them are here, and which door does the directional one point along?"
    }

    fn placed(&self, graph: &EmbeddedGraph, facing: Dart) -> Places {
        Places::from_slice(&[Some(facing), Some(graph.first_dart(graph.vertex(facing)))])
    }

    fn exists(&self, graph: &EmbeddedGraph, placed: &Places) -> bool {
        are_in(placed, graph, 2..=2) && along(placed).is_some()
    }

    fn sighting(&self, graph: &EmbeddedGraph, state: &State<Places>) -> Sighting {
        let along = along(&state.placed).and_then(|along| {
            match Marker::sighting(&Directional, graph, along, state.pose) {
                Sighting::Pointing(door) => Some(door),
                _ => None,
            }
        });
        let is_here = MOVABLE.sighting(graph, &movable(state)) != Sighting::Nothing;
        TwoMarkersView { along, movable: is_here }.sighting()
    }

    fn first_alike(&self, _graph: &EmbeddedGraph, facing: Dart) -> Dart {
        facing
    }

    fn starts(&self, _graph: &EmbeddedGraph, facing: Dart) -> Vec<Dart> {
        vec![facing]
    }

    fn parts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<MarkerPart> {
        let mut parts = vec![MarkerPart::Pointing(facing)];
        parts.extend(MOVABLE.parts(graph, facing));
        parts
    }

    fn is_local(&self) -> bool {
        true
    }

    /// That of the movable marker; the other one stays.
    fn placed_text(&self, placed: &Places, names: &dyn PlaceNames) -> String {
        MOVABLE.placed_text(&Places::from_slice(placed.get(1..).unwrap_or_default()), names)
    }

    fn moves(&self) -> bool {
        true
    }

    fn held(&self, state: &State<Places>) -> u32 {
        MOVABLE.held(&movable(state))
    }

    fn actions(&self, graph: &EmbeddedGraph, state: &State<Places>) -> Vec<AidAction> {
        MOVABLE.actions(graph, &movable(state))
    }

    fn act(
        &self,
        graph: &EmbeddedGraph,
        state: &mut State<Places>,
        action: AidAction,
    ) -> Result<(), RefusedAction> {
        let mut moved = movable(state);
        MOVABLE.act(graph, &mut moved, action)?;
        state.placed = Places::from_slice(&[along(&state.placed), moved.placed[0]]);
        Ok(())
    }
}
