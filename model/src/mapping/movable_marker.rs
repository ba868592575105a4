//! Mapping with a single movable marker, in worlds without loops and parallel edges. Section 2.3,
//! after the paper's reference 8: Dudek, Jenkin, Milios and Wilkes, "Robotic exploration as graph
//! construction" (1991).
//!
//! Place validation finds out whether the place just reached is new. If it is not, back-link
//! validation finds the edge by which it was entered. The state and the small steps are those of
//! [`MovableMarkerRun`].

use super::{
    Choices, Contradiction, CostOrder, Explorer, ExplorerInfo, InvalidStep, MapDart, MapWalk,
    MappingError, MovableMarkerRun, Nearest, Observer, StepPurpose, ValidationResult,
};
use crate::{
    embedded_graph::{Dart, Vertex},
    marker::{MarkerKind, Movable},
    world::World,
};

/// The place just reached.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReachedPlace {
    /// A new place. The robot is there and carries the marker.
    New,
    /// A known vertex. The robot is there, and the marker lies there.
    Known(Vertex),
}

/// Maps a world without loops and parallel edges. At its start the robot stands where the marker
/// lies, with its back to the facing door. Afterwards `search` holds the map, the robot's pose in it
/// and the number of moves, and the robot carries the marker; [`MovableMarkerRun::map`] is then
/// [complete](super::PartialMap::complete).
///
/// With loops or parallel edges one movable marker does not suffice: the map is then wrong, or the
/// run ends with an error.
///
/// # Errors
/// Returns an error if the world does, if it contradicts itself, if a choice is not open, or if more
/// darts become known than the search's bound. The search then holds what is known so far.
pub fn map_with_movable_marker<W: World>(
    world: &mut W,
    choices: &mut impl Choices,
    search: &mut MovableMarkerRun,
    observer: &mut impl Observer<W>,
) -> Result<(), MappingError<W::Error>> {
    // The robot picks the marker up at v0; S is v0; U is its edges.
    search.begin(world, observer)?;
    // While U is not empty, remove an unexplored edge e = (vk, vu) from it.
    while let Some(edge) = search.choose_with(choices) {
        explore_edge(edge, search, world, observer)?;
    }
    // S is the map.
    Ok(())
}

/// From one choice to the next: the step machine of the movable marker algorithm. The run waits for
/// an edge.
///
/// # Errors
/// See [`map_with_movable_marker`].
pub fn explore_edge<W: World>(
    edge: Dart,
    search: &mut MovableMarkerRun,
    world: &mut W,
    observer: &mut impl Observer<W>,
) -> Result<(), MappingError<W::Error>> {
    // Carry the marker through S to the known end vk, and over e to the unknown end vu.
    search.carry_over(edge, world, observer)?;
    match validate_place(search, world, observer)? {
        // vu is a known vertex: a loop was closed.
        ReachedPlace::Known(vertex) => {
            let back_link = validate_back_link(edge, vertex, search, world, observer)?;
            search.close_loop(back_link, world, observer)?;
        }
        // vu is a new place.
        ReachedPlace::New => search.add_place(world, observer)?,
    }
    Ok(())
}

/// Place validation: is the unknown end of the edge a new place, or which known vertex is it?
///
/// # Errors
/// Returns an error if the world does, or if it contradicts itself.
// paper: movable.place, movable.new, movable.known
pub fn validate_place<W: World>(
    search: &mut MovableMarkerRun,
    world: &mut W,
    observer: &mut impl Observer<W>,
) -> Result<ReachedPlace, MappingError<W::Error>> {
    // No known vertex can be vu: it is new.
    if search.candidates().is_empty() {
        return Ok(ReachedPlace::New);
    }
    // Drop the marker at vu, and go back over e to vk.
    search.drop_marker(world, observer)?;
    search.go_back(world, observer)?;
    // Search S for it: every known vertex that can be vu.
    while let Some(candidate) = search.next_candidate() {
        // Found at a vertex of S: this is vu.
        if let Some(vertex) = search.look_for_marker(candidate, world, observer)? {
            return Ok(ReachedPlace::Known(vertex));
        }
    }
    // Not found: vu is new. Go there again, for the marker.
    search.return_to_marker(world, observer)?;
    search.pick_up(world, observer)?;
    Ok(ReachedPlace::New)
}

/// Back-link validation: which unexplored dart of the known vertex is the other end of `edge`?
/// The robot is at the vertex where the marker lies. Afterwards it carries the marker.
///
/// # Errors
/// Returns an error if the world does, or if it contradicts itself.
// paper: movable.back-link
pub fn validate_back_link<W: World>(
    edge: Dart,
    vertex: Vertex,
    search: &mut MovableMarkerRun,
    world: &mut W,
    observer: &mut impl Observer<W>,
) -> Result<Dart, MappingError<W::Error>> {
    search.pick_up(world, observer)?;
    // An only unexplored dart of the vertex needs no validation.
    if let Some(only) = search.list_back_links(vertex) {
        return Ok(only);
    }
    // Carry the marker to vk, drop it there, and return without it.
    let marked = search.map().vertex(edge);
    search.travel_to(marked, world, observer)?;
    search.drop_marker(world, observer)?;
    search.travel_to(vertex, world, observer)?;
    // Try the unexplored darts one by one, until the marker lies behind one.
    while let Some(dart) = search.next_back_link() {
        if search.try_back_link(dart, world, observer)? == ValidationResult::Confirmed {
            search.pick_up(world, observer)?;
            return Ok(dart);
        }
    }
    Err(Contradiction::NoBackLink { vertex, marked }.into())
}

/// The movable marker algorithm, for worlds without loops and parallel edges. The default choices are those of
/// [`Nearest`].
impl Explorer for MovableMarkerRun {
    type Marker = MarkerKind;
    type Choice = Dart;

    const INFO: ExplorerInfo = ExplorerInfo {
        option: "movable",
        title: "Place and back-link validation",
        in_words: "place and back-link validation",
        order: CostOrder::EdgesVertices,
    };

    fn marker(&self) -> MarkerKind {
        Movable
    }

    fn limit_darts(&mut self, max_darts: usize) {
        self.set_bound(max_darts);
    }

    fn begin<W: World>(
        &mut self,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        self.find_start(world, observer)
    }

    fn choose(&mut self) -> Result<Option<Dart>, InvalidStep> {
        Ok(self.choose_with(&mut Nearest))
    }

    fn choices(&mut self) -> Result<Vec<Dart>, InvalidStep> {
        Ok(self.map().unexplored().collect())
    }

    fn approach<W: World>(
        &mut self,
        edge: Dart,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        self.travel_to(self.map().vertex(edge), world, observer)
    }

    fn step<W: World>(
        &mut self,
        edge: Dart,
        world: &mut W,
        observer: &mut impl Observer<W>,
    ) -> Result<(), MappingError<W::Error>> {
        explore_edge(edge, self, world, observer)
    }

    fn map_walk(&self) -> Option<&MapWalk> {
        Some(self.walk())
    }

    fn purpose(&self, edge: Option<Dart>) -> StepPurpose {
        edge.map_or(StepPurpose::Done, |edge| StepPurpose::Explore(MapDart::new(self.map(), edge)))
    }

    /// `3 n (n - 1) / 2 + (m - n + 1) (6 n - 7)`, which is less than `6 m n`.
    ///
    /// Each of the m edges is explored once, and the world is simple. Let `k` vertices be known. The
    /// robot goes to the known end and over the edge: at most `k` moves. A search goes back over the
    /// edge, along no more than a closed depth-first walk of a tree of the `k` vertices, and so takes
    /// at most `1 + 2 (k - 1)` moves until the robot is at the known end again, whether the marker
    /// was found on the way or not.
    ///
    /// * The place is new: once more over the edge. That is at most `3 k` moves, and happens once for
    ///   each `k` from 1 to `n - 1`: `3 n (n - 1) / 2`.
    /// * It is known, `m - n + 1` times: the robot carries the marker to the known end, which ends
    ///   the closed walk, and returns to the place in at most `n - 1` moves. The place has at least
    ///   one explored dart, and is neither the known end nor joined to it by another edge; so the
    ///   darts to try lead to at most `n - 2` vertices, one of them the known end. The last costs a
    ///   move, each before it two: at most `2 (n - 2) - 1`. That is
    ///   `n + 1 + 2 (n - 1) + (n - 1) + 2 (n - 2) - 1 = 6 n - 7` together.
    fn move_bound(&self, edges: usize, vertices: usize) -> u64 {
        let (m, n) = (edges as u64, vertices as u64);
        let new = n.saturating_mul(n.saturating_sub(1)).saturating_mul(3) / 2;
        let loops = (m + 1).saturating_sub(n);
        new.saturating_add(loops.saturating_mul(n.saturating_mul(6).saturating_sub(7)))
    }
}
