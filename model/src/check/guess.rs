//! Is a right map a guess? A walk determines its world exactly if its folded trail is complete: see
//! [`folding`](crate::folding). After any other walk there is another world in which a deterministic explorer
//! makes the same walk, and returns the same map. The smallest one shows what the walk leaves open.

use crate::{
    aid::{Action, AidKind},
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::{Class, Watch},
    folding::{FoldedTrail, SmallestWorld, WorldSearch, fold, smallest_other_world},
    marker::{Directional, NoMarker},
    percept::Door,
    world::GraphWorld,
};

/// Whether a walk from a start determines its world: no other world, of any size, gives the same percepts.
///
/// `None` if that is not known: with a marker whose sightings folding does not identify, that is, with all but
/// [`Directional`] and [`NoMarker`]; or if a door does not exist, or the walk is too long to be folded.
pub fn determines_world(
    start: (&EmbeddedGraph, Dart),
    aid: AidKind,
    doors: &[Door],
) -> Option<bool> {
    // Without a marker the folded trail is a tree, which is the world if no dart is open.
    Some(folded_walk(start, aid, doors)?.open_count() == 0)
}

/// The smallest other world that gives the same percepts on a walk from a start: in it, a deterministic explorer makes
/// the same walk. There is one unless the walk determines its world. `None` if it is not known whether it does.
pub fn other_world(
    start: (&EmbeddedGraph, Dart),
    aid: AidKind,
    doors: &[Door],
    watch: &dyn Watch,
) -> Option<SmallestWorld> {
    let search =
        WorldSearch { class: Class::Multigraph, max_edges: None, steps: WorldSearch::STEPS };
    Some(smallest_other_world(&folded_walk(start, aid, doors)?, start, search, watch))
}

/// The folded trail of a walk from a start; `None` if folding is not exact for the marker, a door does not exist, or
/// the walk is too long.
fn folded_walk(
    (graph, facing): (&EmbeddedGraph, Dart),
    aid: AidKind,
    doors: &[Door],
) -> Option<FoldedTrail> {
    let marker = aid.fixed().filter(|marker| [Directional, NoMarker].contains(marker))?;
    let mut world = GraphWorld::with_aid(graph, marker, facing);
    let mut percepts = vec![world.sensed()];
    for &door in doors {
        world.act(Action::Take(door)).ok()?;
        percepts.push(world.sensed());
    }
    fold(&percepts, doors).ok()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::{
        any_graph::{any_graph, by_edges, starts, walk},
        folding::certificate,
        isomorphism::code,
        marker::Undirected,
    };

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
        let determined =
            |walk: &[Door]| determines_world((&graph, Dart(0)), Directional.into(), walk);
        let walk = certificate(&graph, Dart(0));
        for moves in 0..=walk.len() {
            assert_eq!(determined(&walk[..moves]), Some(moves == walk.len()), "{moves} moves");
        }
        assert!(walk.len() < 7);
        assert_eq!(determined(&doors(&[0; 7])), Some(false));
        assert_eq!(determined(&doors(&[7])), None);
        // Of other markers nothing is known.
        assert_eq!(determines_world((&graph, Dart(0)), Undirected.into(), &walk), None);
    }

    #[test]
    fn without_a_marker_only_a_tree_can_be_determined() {
        let edge = EmbeddedGraph::chain(1);
        let determined =
            |graph, walk| determines_world((graph, Dart(0)), NoMarker.into(), &doors(walk));
        assert_eq!(determined(&edge, &[]), Some(false));
        assert_eq!(determined(&edge, &[0]), Some(true));
        assert_eq!(determined(&edge_and_loop(), &[0, 1, 1, 0, 1, 1]), Some(false));
    }

    /// The other world after a walk from dart 0, and whether it is the smallest; the walk does not determine its world.
    fn other(graph: &EmbeddedGraph, marker: AidKind, walk: &[Door]) -> (EmbeddedGraph, bool) {
        match other_world((graph, Dart(0)), marker, walk, &()) {
            Some(SmallestWorld::World { graph, limit, .. }) => (graph, limit.is_none()),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn after_no_move_an_edge_may_be_a_longer_chain_and_after_one_it_is_an_edge() {
        let edge = EmbeddedGraph::chain(1);
        let start = (&edge, Dart(0));
        let (longer, is_smallest) = other(&edge, Directional.into(), &[]);
        assert_eq!(code(&longer, Dart(0)), code(&EmbeddedGraph::chain(2), Dart(0)));
        assert!(is_smallest);
        let after = other_world(start, Directional.into(), &doors(&[0]), &());
        assert_eq!(after, Some(SmallestWorld::NoWorld));
        assert_eq!(other_world(start, Undirected.into(), &[], &()), None);
    }

    #[test]
    fn a_walk_round_a_ring_of_three_without_a_marker_may_be_a_loop() {
        let ring = EmbeddedGraph::cycle(3);
        let (smallest, is_smallest) = other(&ring, NoMarker.into(), &doors(&[1; 7]));
        assert_eq!((smallest.edge_count(), smallest.vertex_count()), (1, 1));
        assert!(is_smallest);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        /// By trying all worlds with up to 6 edges.
        #[test]
        fn the_other_world_is_the_smallest_that_explains_the_walk(
            graph in any_graph(Class::Multigraph, 5),
            turns in prop::collection::vec(any::<u8>(), 0..12),
            marker in prop::sample::select(vec![AidKind::from(Directional), NoMarker.into()]),
        ) {
            let world = GraphWorld::with_aid(&graph, marker, Dart(0));
            let (percepts, doors) = walk(world, turns.iter().copied().map(u32::from));
            prop_assume!(determines_world((&graph, Dart(0)), marker, &doors) == Some(false));
            let explains = |other: &EmbeddedGraph| {
                let mut world = GraphWorld::with_aid(other, marker, Dart(0));
                world.sensed() == percepts[0]
                    && doors.iter().zip(&percepts[1..]).all(|(&door, &percept)| {
                        world.act(Action::Take(door)).is_ok() && world.sensed() == percept
                    })
            };
            let (found, is_smallest) = other(&graph, marker, &doors);
            prop_assert!(explains(&found) && code(&found, Dart(0)) != code(&graph, Dart(0)));
            prop_assume!(is_smallest);
            let smallest = (1..=6).find(|&edges| {
                let others = starts(Class::Multigraph, edges);
                others.iter().any(|other| {
                    explains(other) && code(other, Dart(0)) != code(&graph, Dart(0))
                })
            });
            prop_assert_eq!(Some(found.edge_count()).filter(|&edges| edges <= 6), smallest);
        }
    }
}
