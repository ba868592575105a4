//! A directional marker that the robot can pick up, carry and drop. It points along the robot's entry dart when it is
//! dropped, as the marker of Algorithm 1 does at the start (Section 2.3).

use super::{Aid, AidAction, PlaceNames, Places, RefusedAction, State, are_in, handled};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    marker::{Directional, Marker, MarkerPart},
    percept::Sighting,
};

/// The directional marker that can be carried. Its place is the dart along which it points, or none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct MovablePointer;

impl MovablePointer {
    fn place(state: &State<Places>) -> Option<Dart> {
        state.placed.first().copied().flatten()
    }
}

impl Aid for MovablePointer {
    type Placed = Places;

    fn name(&self) -> &'static str {
        "movable-directional"
    }

    fn about(&self) -> &'static str {
        "one directional marker, at the start vertex at first, that the robot can pick up, carry and drop; then it points \
         along the door by which the robot came in: is it here, and which door does it point along?"
    }

    fn placed(&self, _graph: &EmbeddedGraph, facing: Dart) -> Places {
        Places::from_elem(Some(facing), 1)
    }

    fn exists(&self, graph: &EmbeddedGraph, placed: &Places) -> bool {
        are_in(placed, graph, 1..=1)
    }

    fn sighting(&self, graph: &EmbeddedGraph, state: &State<Places>) -> Sighting {
        Self::place(state).map_or(Sighting::Nothing, |along| {
            Marker::sighting(&Directional, graph, along, state.pose)
        })
    }

    fn first_alike(&self, _graph: &EmbeddedGraph, facing: Dart) -> Dart {
        facing
    }

    fn starts(&self, _graph: &EmbeddedGraph, facing: Dart) -> Vec<Dart> {
        vec![facing]
    }

    fn parts(&self, _graph: &EmbeddedGraph, facing: Dart) -> Vec<MarkerPart> {
        vec![MarkerPart::Pointing(facing)]
    }

    fn is_local(&self) -> bool {
        true
    }

    /// `@vertex:door`, or `+marker` while the robot carries it.
    fn placed_text(&self, placed: &Places, names: &dyn PlaceNames) -> String {
        let place = placed.first().copied().flatten();
        place.map_or_else(|| "+marker".to_owned(), |along| format!("@{}", names.dart(along)))
    }

    fn moves(&self) -> bool {
        true
    }

    fn held(&self, state: &State<Places>) -> u32 {
        u32::from(Self::place(state).is_none())
    }

    fn actions(&self, graph: &EmbeddedGraph, state: &State<Places>) -> Vec<AidAction> {
        match Self::place(state) {
            None => vec![AidAction::Drop],
            Some(along) if graph.vertex(along) == graph.vertex(state.pose) => {
                vec![AidAction::PickUp]
            }
            Some(_) => Vec::new(),
        }
    }

    fn act(
        &self,
        graph: &EmbeddedGraph,
        state: &mut State<Places>,
        action: AidAction,
    ) -> Result<(), RefusedAction> {
        state.placed[0] = handled(&self.actions(graph, state), action, state.pose)?;
        Ok(())
    }
}
