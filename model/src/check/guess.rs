//! Is a right map a guess? A walk determines its world exactly if its folded trail is complete: see
//! [`folding`](crate::folding). After any other walk there is another world in which a deterministic explorer
//! makes the same walk, and returns the same map.

use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    folding::fold,
    marker::{Directional, Marker, NoMarker},
    percept::Door,
    world::{Action, GraphWorld},
};

/// Whether a walk from a start determines its world: no other world, of any size, gives the same percepts.
///
/// `None` if that is not known: with a marker whose sightings folding does not identify, that is, with all but
/// [`Directional`] and [`NoMarker`]; or if a door does not exist, or the walk is too long to be folded.
pub fn determines_world(
    (graph, facing): (&EmbeddedGraph, Dart),
    marker: &dyn Marker,
    doors: &[Door],
) -> Option<bool> {
    let known: [&dyn Marker; 2] = [&Directional, &NoMarker];
    if known.iter().all(|known| known.name() != marker.name()) {
        return None;
    }
    let mut world = GraphWorld::with_marker(graph, marker, facing);
    let mut percepts = vec![world.sensed()];
    for &door in doors {
        world.act(Action::Take(door)).ok()?;
        percepts.push(world.sensed());
    }
    // Without a marker the folded trail is a tree, which is the world if no dart is open.
    Some(fold(&percepts, doors).ok()?.open_count() == 0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{any_graph::by_edges, folding::certificate, marker::Undirected};

    /// An edge with a loop at its end. The start is the other end.
    fn edge_and_loop() -> EmbeddedGraph {
        by_edges("a: e | b: e l l")
    }

    fn doors(numbers: &[u32]) -> Vec<Door> {
        numbers.iter().copied().map(Door).collect()
    }

    #[test]
    fn a_certificate_determines_its_world_and_no_part_of_it_does_nor_may_a_longer_walk() {
        let graph = edge_and_loop();
        let determined = |walk: &[Door]| determines_world((&graph, Dart(0)), &Directional, walk);
        let walk = certificate(&graph, Dart(0));
        for moves in 0..=walk.len() {
            assert_eq!(determined(&walk[..moves]), Some(moves == walk.len()), "{moves} moves");
        }
        assert!(walk.len() < 7);
        assert_eq!(determined(&doors(&[0; 7])), Some(false));
        assert_eq!(determined(&doors(&[7])), None);
        // Of other markers nothing is known.
        assert_eq!(determines_world((&graph, Dart(0)), &Undirected, &walk), None);
    }

    #[test]
    fn without_a_marker_only_a_tree_can_be_determined() {
        let edge = EmbeddedGraph::chain(1);
        let determined = |graph, walk| determines_world((graph, Dart(0)), &NoMarker, &doors(walk));
        assert_eq!(determined(&edge, &[]), Some(false));
        assert_eq!(determined(&edge, &[0]), Some(true));
        assert_eq!(determined(&edge_and_loop(), &[0, 1, 1, 0, 1, 1]), Some(false));
    }
}
