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
#[must_use]
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
    use crate::{
        folding::certificate,
        mapping::{Algorithm1Run, MapWalk, MappingEvent, explore},
        marker::Undirected,
    };

    /// An edge with a loop at its end. The start is the other end.
    fn edge_and_loop() -> EmbeddedGraph {
        EmbeddedGraph::from_edge_lists(&[("a", vec!["e"]), ("b", vec!["e", "l", "l"])]).unwrap()
    }

    fn doors(numbers: &[u32]) -> Vec<Door> {
        numbers.iter().copied().map(Door).collect()
    }

    #[test]
    fn a_certificate_determines_its_world_and_no_part_of_it_does() {
        let graph = edge_and_loop();
        let walk = certificate(&graph, Dart(0));
        for moves in 0..=walk.len() {
            let determined = determines_world((&graph, Dart(0)), &Directional, &walk[..moves]);
            assert_eq!(determined, Some(moves == walk.len()), "{moves} moves");
        }
    }

    #[test]
    fn a_walk_longer_than_the_certificate_may_determine_nothing() {
        let graph = edge_and_loop();
        let walk = doors(&[0, 0, 0, 0, 0, 0, 0]);
        assert!(walk.len() > certificate(&graph, Dart(0)).len());
        assert_eq!(determines_world((&graph, Dart(0)), &Directional, &walk), Some(false));
    }

    #[test]
    fn without_a_marker_only_a_tree_can_be_determined() {
        let edge = EmbeddedGraph::from_edge_lists(&[("a", vec!["e"]), ("b", vec!["e"])]).unwrap();
        let determined = |graph, walk| determines_world((graph, Dart(0)), &NoMarker, &doors(walk));
        assert_eq!(determined(&edge, &[]), Some(false));
        assert_eq!(determined(&edge, &[0]), Some(true));
        assert_eq!(determined(&edge_and_loop(), &[0, 1, 1, 0, 1, 1]), Some(false));
    }

    #[test]
    fn of_other_markers_and_of_impossible_walks_nothing_is_known() {
        let graph = edge_and_loop();
        let walk = certificate(&graph, Dart(0));
        assert_eq!(determines_world((&graph, Dart(0)), &Undirected, &walk), None);
        assert_eq!(determines_world((&graph, Dart(0)), &Directional, &doors(&[7])), None);
    }

    #[test]
    fn the_runs_of_algorithm_1_determine_their_worlds() {
        let graph = edge_and_loop();
        for facing in graph.darts() {
            let mut taken = Vec::new();
            let mut watch = |_: &mut GraphWorld<'_>, _: &MapWalk, event: MappingEvent| {
                if let MappingEvent::Moved { door, .. } = event {
                    taken.push(door);
                }
            };
            let mut run = Algorithm1Run::new(graph.dart_count());
            explore(&mut run, &mut GraphWorld::new(&graph, facing), &mut watch).unwrap();
            assert_eq!(determines_world((&graph, facing), &Directional, &taken), Some(true));
        }
    }
}
