//! Undirected markers that a robot picks up, carries and drops: Dudek, Jenkin, Milios and Wilkes, "Using multiple markers
//! in graph exploration" (1989), with several; "Robotic exploration as graph construction" (1991), with one.
//!
//! They lie at vertices, and a robot sees how many do, or which. At its start they all lie at the start vertex.

use super::{Aid, AidAction, PlaceNames, Places, RefusedAction, State, are_in};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    marker::{MarkerLook, MarkerPart},
    percept::{MarkerSet, Sighting},
};

/// So many markers. The place of each is the first dart of its vertex, or none while the robot carries it; the places of
/// markers that look alike are in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct MovableMarkers {
    /// Their number, from 1 to 4.
    count: u8,
    are_alike: bool,
}

/// One undirected marker.
pub const MOVABLE: MovableMarkers = MovableMarkers::alike(1);

impl MovableMarkers {
    pub(super) const fn alike(count: u8) -> Self {
        Self { count, are_alike: true }
    }

    pub(super) const fn distinct(count: u8) -> Self {
        Self { count, are_alike: false }
    }

    pub fn count(self) -> u8 {
        self.count
    }

    pub fn are_alike(self) -> bool {
        self.are_alike
    }

    const fn texts(self) -> [&'static str; 2] {
        match (self.are_alike, self.count) {
            (true, 1) => [
                "movable",
                "one undirected marker, at the start vertex at first, that the robot can pick up, \
                 carry and drop: is it here?",
            ],
            (true, 2) => [
                "movable-2",
                "two undirected markers that look alike, at the start vertex at first, that the robot can \
                 pick up, carry and drop: how many are here?",
            ],
            (true, 3) => [
                "movable-3",
                "three undirected markers that look alike, at the start vertex at first, that the robot can \
                 pick up, carry and drop: how many are here?",
            ],
            (true, _) => [
                "movable-4",
                "four undirected markers that look alike, at the start vertex at first, that the robot can \
                 pick up, carry and drop: how many are here?",
            ],
            (false, 0..=2) => [
                "movable-2-distinct",
                "two undirected markers that look different, at the start vertex at first, that the robot can \
                 pick up, carry and drop: which of them are here?",
            ],
            (false, 3) => [
                "movable-3-distinct",
                "three undirected markers that look different, at the start vertex at first, that the robot \
                 can pick up, carry and drop: which of them are here?",
            ],
            (false, _) => [
                "movable-4-distinct",
                "four undirected markers that look different, at the start vertex at first, that the robot \
                 can pick up, carry and drop: which of them are here?",
            ],
        }
    }

    /// The markers that lie at the robot's vertex.
    fn here(graph: &EmbeddedGraph, state: &State<Places>) -> impl Iterator<Item = usize> {
        let vertex = graph.vertex(state.pose);
        let lies_here =
            move |place: &Option<Dart>| place.is_some_and(|dart| graph.vertex(dart) == vertex);
        (0..).zip(state.placed.iter()).filter(move |(_, place)| lies_here(place)).map(|(at, _)| at)
    }

    /// Puts a marker in another place.
    fn put(self, placed: &mut Places, at: usize, place: Option<Dart>) {
        placed[at] = place;
        if self.are_alike {
            placed.sort_unstable();
        }
    }
}

impl Aid for MovableMarkers {
    type Placed = Places;

    fn name(&self) -> &'static str {
        self.texts()[0]
    }

    fn about(&self) -> &'static str {
        self.texts()[1]
    }

    fn placed(&self, graph: &EmbeddedGraph, facing: Dart) -> Places {
        Places::from_elem(Some(self.first_alike(graph, facing)), self.count.into())
    }

    fn exists(&self, graph: &EmbeddedGraph, placed: &Places) -> bool {
        let parts = usize::from(self.count);
        are_in(placed, graph, parts..=parts)
    }

    fn sighting(&self, graph: &EmbeddedGraph, state: &State<Places>) -> Sighting {
        let here = Self::here(graph, state);
        if self.are_alike {
            let count = here.count() as u32;
            if count == 0 { Sighting::Nothing } else { Sighting::Lying(count) }
        } else {
            MarkerSet::from_numbers(here).map_or(Sighting::Nothing, Sighting::These)
        }
    }

    fn first_alike(&self, graph: &EmbeddedGraph, facing: Dart) -> Dart {
        graph.first_dart(graph.vertex(facing))
    }

    fn starts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<Dart> {
        graph.darts_of(graph.vertex(facing)).collect()
    }

    fn parts(&self, graph: &EmbeddedGraph, facing: Dart) -> Vec<MarkerPart> {
        let looks = MarkerLook::ALL.into_iter().cycle();
        let look = |look| if self.are_alike { MarkerLook::ALL[0] } else { look };
        let at = |number| MarkerPart::At { vertex: graph.vertex(facing), look: look(number) };
        looks.take(self.count.into()).map(at).collect()
    }

    fn is_local(&self) -> bool {
        true
    }

    /// `@vertex` for each marker, or `+marker` while the robot carries it.
    fn placed_text(&self, placed: &Places, names: &dyn PlaceNames) -> String {
        let place = |place: &Option<Dart>| {
            place.map_or_else(|| "+marker".to_owned(), |at| format!("@{}", names.vertex(at)))
        };
        placed.iter().map(place).collect()
    }

    fn moves(&self) -> bool {
        true
    }

    /// Which markers it carries; of those that look alike, how many.
    fn held(&self, state: &State<Places>) -> u32 {
        let carried = (0..).zip(state.placed.iter()).filter(|(_, place)| place.is_none());
        if self.are_alike {
            carried.count() as u32
        } else {
            carried.map(|(at, _)| 1_u32 << at).sum()
        }
    }

    fn actions(&self, graph: &EmbeddedGraph, state: &State<Places>) -> Vec<AidAction> {
        let number = |at: usize| at as u8 + 1;
        let carried = |at: &usize| state.placed[*at].is_none();
        if self.are_alike {
            let pick_up = Self::here(graph, state).next().map(|_| AidAction::PickUp);
            let drop = (0..state.placed.len()).any(|at| carried(&at)).then_some(AidAction::Drop);
            pick_up.into_iter().chain(drop).collect()
        } else {
            let pick_up = Self::here(graph, state).map(|at| AidAction::PickUpMarker(number(at)));
            let dropped = (0..state.placed.len()).filter(carried);
            pick_up.chain(dropped.map(|at| AidAction::DropMarker(number(at)))).collect()
        }
    }

    fn act(
        &self,
        graph: &EmbeddedGraph,
        state: &mut State<Places>,
        action: AidAction,
    ) -> Result<(), RefusedAction> {
        let number = |number: u8| usize::from(number).wrapping_sub(1);
        let (found, place) = match (action, self.are_alike) {
            (AidAction::PickUp, true) => (Self::here(graph, state).next(), None),
            (AidAction::PickUpMarker(which), false) => {
                (Self::here(graph, state).find(|&at| at == number(which)), None)
            }
            (AidAction::Drop, true) | (AidAction::DropMarker(_), false) => {
                let is_carried = |at: &usize| match action {
                    AidAction::DropMarker(which) => *at == number(which),
                    _ => true,
                };
                let carried = (0..).zip(state.placed.iter()).filter(|(_, place)| place.is_none());
                let found = carried.map(|(at, _)| at).find(is_carried);
                (found, Some(self.first_alike(graph, state.pose)))
            }
            _ => return Err(action.refused()),
        };
        let refused = if place.is_none() {
            RefusedAction::NothingToPickUp
        } else {
            RefusedAction::NothingToDrop
        };
        let at = found.ok_or(refused)?;
        self.put(&mut state.placed, at, place);
        Ok(())
    }
}
