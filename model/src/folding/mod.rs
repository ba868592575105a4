//! Folding: what a walk proves about its world.
//!
//! A *trail* has one vertex for each percept of a walk, joined by the edges that were traversed. All
//! sightings of the directional marker are one pose, and so are those of an arrow on an edge in one
//! sense; identified poses have identified neighbours behind the same doors; and so on, until nothing changes. This is
//! Stallings folding ("Topology of finite graphs", 1983), and it is congruence closure. If it contradicts itself, no
//! world of any size explains the walk. Otherwise the folded trail maps, locally one to one, into every world that
//! explains the walk. An *open* dart is the end of an edge that was never traversed: a walk determines its world exactly
//! if no dart is open.
//!
//! That is exact for the markers [`Directional`](crate::marker::Directional), [`DirectedEdge`](crate::marker::DirectedEdge)
//! and [`NoMarker`](crate::marker::NoMarker). A sighting of another marker that
//! lies at a vertex is compared where vertices are identified for another reason; a mark on an edge without a sense is
//! not. With these markers a contradiction is still a proof, and its absence proves nothing. An undirected marker lies at
//! one vertex, so that its sightings can be identified in [several ways](MarkedTrails).
//!
//! A robot may [sense](FoldedTrail::sense) more than its percepts: the lengths of edges, and the directions of doors. Vertices
//! and edges that differ in these are distinct. A complete trail is still the world; there are more contradictions.

mod arrow;
mod certificate;
mod classes;
mod closed;
mod contradiction;
mod leaf;
mod marked_vertex;
mod marker_tree;
mod senses;
mod smallest;
mod trail;

pub(crate) use certificate::certificate_darts;
pub use certificate::{certificate, certificate_length};
pub use closed::ClosedTrail;
pub use contradiction::{ContradictionReason, FoldError, MAX_DARTS, TrailError};
pub use marked_vertex::MarkedTrails;
pub(crate) use marker_tree::MarkerTree;
pub use senses::{ArrivalSenses, LengthInterval};
pub use smallest::{SearchLimit, SmallestWorld, WorldSearch, smallest_other_world, smallest_world};
pub use trail::FoldedTrail;

use crate::percept::{Door, Percept, WalkEvent};

/// The folded trail of a walk: the percept at the start, and after each door the next percept. A last
/// door may have no percept.
///
/// # Errors
/// Returns the first event that no world of any size explains together with those before it, or at
/// which the trail is too large.
pub fn fold(percepts: &[Percept], doors: &[Door]) -> Result<FoldedTrail, FoldError> {
    let Some((&first, later)) = percepts.split_first() else { return Ok(FoldedTrail::default()) };
    let at = |event| move |error| FoldError { event, error };
    let mut trail = FoldedTrail::new(first).map_err(at(WalkEvent::Percept(0)))?;
    for (index, &door) in doors.iter().enumerate() {
        let door_error = at(WalkEvent::Door(index));
        trail.check_door(door).map_err(TrailError::from).map_err(door_error)?;
        if let Some(&percept) = later.get(index) {
            trail.step(door, percept).map_err(at(WalkEvent::Percept(index + 1)))?;
        }
    }
    Ok(trail)
}

#[cfg(test)]
mod tests;
