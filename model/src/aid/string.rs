//! A string that the robot pays out along edges, as the paper's introduction names it among marking aids (Wang, Jenkin and
//! Dymond); the thread of Ariadne.
//!
//! One end is fixed at the start vertex. The robot holds the other end at first. While it holds it, each edge that it
//! traverses takes an edge's length of string, but one over which the string runs last, which it winds in. Where it drops
//! the end, it lies, and can be picked up again. At a vertex the robot sees the doors through which string runs, and
//! which end is there. String is not cut: dropping the end for ever does what cutting it off does.

use super::{Aid, AidAction, PlaceNames, Places, RefusedAction, State, are_in, handled};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    marker::MarkerPart,
    percept::{Door, DoorSet, Sighting, StringView},
};

/// A string of some length. Its places are: the fixed end, as the first dart of the start vertex; the darts by which
/// the string leaves each vertex on its way; and the vertex of its free end, as its first dart, or none while the robot
/// holds it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LaidString {
    /// In edges, from 1 to 3; none if it is as long as it takes.
    length: Option<u8>,
}

impl LaidString {
    pub(super) const fn of(length: u8) -> Self {
        Self { length: Some(length) }
    }

    /// A string as long as it takes.
    pub const fn of_any_length() -> Self {
        Self { length: None }
    }

    /// Its length in edges; none if it is as long as it takes.
    pub fn length(self) -> Option<usize> {
        self.length.map(usize::from)
    }

    /// The darts by which it leaves each vertex on its way.
    fn way(placed: &Places) -> impl DoubleEndedIterator<Item = Dart> {
        let end = placed.len().saturating_sub(1);
        placed.get(1..end).unwrap_or_default().iter().filter_map(|place| *place)
    }

    fn free_end(placed: &Places) -> Option<Dart> {
        placed.last().copied().flatten()
    }

    /// The last dart behind which string runs from the robot's hand.
    fn behind(graph: &EmbeddedGraph, placed: &Places) -> Option<Dart> {
        Self::way(placed).next_back().and_then(|dart| graph.joined(dart))
    }

    fn end_is_here(graph: &EmbeddedGraph, state: &State<Places>) -> bool {
        Self::free_end(&state.placed)
            .is_some_and(|end| graph.vertex(end) == graph.vertex(state.pose))
    }
}

impl Aid for LaidString {
    type Placed = Places;

    fn name(&self) -> &'static str {
        match self.length {
            None => "string",
            Some(1) => "string-1",
            Some(2) => "string-2",
            Some(_) => "string-3",
        }
    }

    fn about(&self) -> &'static str {
        match self.length {
            None => {
                "a string as long as it takes, fixed at the start vertex, that the robot pays out, winds in, drops and \
                 picks up: through which doors does it run, and which end is here?"
            }
            Some(1) => {
                "a string as long as one edge, fixed at the start vertex, that the robot pays out, winds in, drops and \
                 picks up: through which doors does it run, and which end is here?"
            }
            Some(2) => {
                "a string as long as two edges, fixed at the start vertex, that the robot pays out, winds in, drops and \
                 picks up: through which doors does it run, and which end is here?"
            }
            Some(_) => {
                "a string as long as three edges, fixed at the start vertex, that the robot pays out, winds in, drops \
                 and picks up: through which doors does it run, and which end is here?"
            }
        }
    }

    fn placed(&self, graph: &EmbeddedGraph, facing: Dart) -> Places {
        Places::from_slice(&[Some(self.first_alike(graph, facing)), None])
    }

    fn exists(&self, graph: &EmbeddedGraph, placed: &Places) -> bool {
        are_in(placed, graph, 2..=self.length().map_or(usize::MAX, |length| 2 + length))
    }

    fn sighting(&self, graph: &EmbeddedGraph, state: &State<Places>) -> Sighting {
        let State { pose, placed } = state;
        let (degree, entry) = (graph.degree_around(*pose), graph.index(*pose));
        let vertex = graph.vertex(*pose);
        let door = |dart: Dart| Door::between(entry, graph.index(dart), degree);
        let mut doors = DoorSet::default();
        for dart in Self::way(placed).flat_map(|dart| [Some(dart), graph.joined(dart)]).flatten() {
            if graph.vertex(dart) == vertex {
                doors.insert(door(dart));
            }
        }
        let is_held = Self::free_end(placed).is_none();
        let hand = if is_held { Self::behind(graph, placed).map(door) } else { None };
        let is_fixed_here = placed.first().copied().flatten().map(|dart| graph.vertex(dart));
        let view = StringView {
            doors,
            fixed_end: is_fixed_here == Some(vertex),
            free_end: Self::end_is_here(graph, state),
            hand,
        };
        if view == StringView::default() { Sighting::Nothing } else { Sighting::String(view) }
    }

    fn first_alike(&self, graph: &EmbeddedGraph, facing: Dart) -> Dart {
        graph.first_dart(graph.vertex(facing))
    }

    fn starts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<Dart> {
        graph.darts_of(graph.vertex(facing)).collect()
    }

    fn parts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<MarkerPart> {
        vec![MarkerPart::StringEnd(graph.vertex(facing))]
    }

    /// `~vertex:door` for each edge over which it runs, and `@vertex` for its free end, or `+string` while the robot holds it.
    fn placed_text(&self, placed: &Places, names: &dyn PlaceNames) -> String {
        let way: Vec<_> = Self::way(placed).map(|dart| format!("~{}", names.dart(dart))).collect();
        let end = Self::free_end(placed);
        way.concat()
            + &end.map_or_else(|| "+string".to_owned(), |end| format!("@{}", names.vertex(end)))
    }

    fn is_seen_everywhere(&self, graph: &EmbeddedGraph) -> bool {
        graph.vertices().all(|vertex| graph.degree(vertex) <= DoorSet::MOST)
    }

    fn unseen_place(&self) -> String {
        format!("a vertex with more than {} doors", DoorSet::MOST)
    }

    fn moves(&self) -> bool {
        true
    }

    /// Whether it holds the free end, and how much string is left.
    fn held(&self, state: &State<Places>) -> u32 {
        if Self::free_end(&state.placed).is_some() {
            return 0;
        }
        let laid = Self::way(&state.placed).count() as u32;
        1 + self.length.map_or(0, |length| u32::from(length).saturating_sub(laid))
    }

    fn actions(&self, graph: &EmbeddedGraph, state: &State<Places>) -> Vec<AidAction> {
        match Self::free_end(&state.placed) {
            None => vec![AidAction::Drop],
            Some(_) if Self::end_is_here(graph, state) => vec![AidAction::PickUp],
            Some(_) => Vec::new(),
        }
    }

    fn act(
        &self,
        graph: &EmbeddedGraph,
        state: &mut State<Places>,
        action: AidAction,
    ) -> Result<(), RefusedAction> {
        let here = self.first_alike(graph, state.pose);
        let end = handled(&self.actions(graph, state), action, here)?;
        if let Some(last) = state.placed.last_mut() {
            *last = end;
        }
        Ok(())
    }

    /// Pays string out, or winds it in.
    fn leave(
        &self,
        graph: &EmbeddedGraph,
        state: &mut State<Places>,
        by: Dart,
    ) -> Result<(), RefusedAction> {
        let placed = &mut state.placed;
        if Self::free_end(placed).is_some() {
            return Ok(());
        }
        if Self::behind(graph, placed) == Some(by) {
            let last = placed.len() - 2;
            placed.remove(last);
            return Ok(());
        }
        let ends = [Some(by), graph.joined(by)].into_iter().flatten();
        if ends.map(|end| graph.degree_around(end)).any(|degree| degree > DoorSet::MOST) {
            return Err(RefusedAction::TooManyDoors { most: DoorSet::MOST });
        }
        let laid = Self::way(placed).count();
        if self.length().is_some_and(|length| laid >= length) {
            return Err(RefusedAction::StringTooShort);
        }
        let end = placed.len() - 1;
        placed.insert(end, Some(by));
        Ok(())
    }
}
