//! When two worlds are the same: codes of starts, canonical forms, automorphisms, bijections.
//! Section 2.1 ("isomorphic" in the sense of the paper's reference 8).

mod bijection;
mod canonical;
mod code;
mod compare;

pub use bijection::{Bijection, Candidate};
pub use canonical::{Canonical, canonical};
pub use code::{StartCode, as_discovered, code, discovery_order};
pub use compare::{Difference, isomorphism, mirror_isomorphism};

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::{
        any_graph::{Class, any_graph, by_edges},
        embedded_graph::{Dart, EmbeddedGraph},
    };

    fn relabelled() -> impl Strategy<Value = (EmbeddedGraph, EmbeddedGraph, Vec<Dart>)> {
        any_graph(Class::Multigraph, 11).prop_flat_map(|graph| {
            let order = Just(graph.vertices().collect::<Vec<_>>()).prop_shuffle();
            let turns = proptest::collection::vec(0..64u32, graph.vertex_count());
            (order, turns).prop_map(move |(order, turns)| {
                let firsts: Vec<_> = order
                    .iter()
                    .zip(turns)
                    .map(|(&v, turn)| graph.dart(v, turn % graph.degree(v)).unwrap())
                    .collect();
                let (copy, number) = graph.relabelled(&firsts).unwrap();
                (graph.clone(), copy, number)
            })
        })
    }

    /// The number of automorphisms, one candidate after the other.
    fn automorphisms_by_trial(graph: &EmbeddedGraph) -> usize {
        graph
            .darts()
            .filter(|&dart| {
                Bijection::of_starts((graph, Dart(0)), (graph, dart)).verify(graph, graph)
            })
            .count()
    }

    proptest! {
        // paper: world.isomorphic
        #[test]
        fn a_relabelled_copy_is_recognised((graph, copy, number) in relabelled()) {
            prop_assert!(isomorphism(&graph, &copy).unwrap().verify(&graph, &copy));
            for dart in graph.darts() {
                prop_assert_eq!(code(&graph, dart), code(&copy, number[dart.at()]));
            }
        }

        #[test]
        fn worlds_are_isomorphic_exactly_when_they_have_the_same_canonical_code(
            graph in any_graph(Class::Multigraph, 4),
            other in any_graph(Class::Multigraph, 4),
        ) {
            let same = canonical(&graph).code == canonical(&other).code;
            match isomorphism(&graph, &other) {
                Ok(bijection) => prop_assert!(same && bijection.verify(&graph, &other)),
                Err(_) => prop_assert!(!same),
            }
        }

        #[test]
        fn the_least_start_is_the_least_and_its_orbit_counts_the_automorphisms(
            graph in any_graph(Class::Multigraph, 8),
        ) {
            let form = canonical(&graph);
            let codes: Vec<_> = graph.darts().map(|dart| code(&graph, dart)).collect();
            prop_assert_eq!(&form.code, codes.iter().min().unwrap());
            prop_assert_eq!(form.automorphisms, automorphisms_by_trial(&graph));
            for one in graph.darts() {
                let least = graph.darts().find(|other| codes[other.at()] == codes[one.at()]);
                prop_assert_eq!(Some(form.orbit[one.at()]), least);
                for other in graph.darts() {
                    prop_assert_eq!(
                        form.orbit[one.at()] == form.orbit[other.at()],
                        codes[one.at()] == codes[other.at()]
                    );
                }
            }
        }

        #[test]
        fn the_mirror_image_is_named(graph in any_graph(Class::Multigraph, 11)) {
            let bijection = mirror_isomorphism(&graph, &graph.mirror_image()).unwrap();
            prop_assert!(bijection.verify(&graph, &graph));
        }
    }

    #[test]
    fn the_verifier_rejects_an_altered_bijection() {
        let graph = by_edges("u: a b c | v: c b a");
        let right = isomorphism(&graph, &graph).unwrap();
        assert!(right.clone().verify(&graph, &graph));
        for place in 0..6 {
            for wrong in (0..8).map(Dart).filter(|&dart| dart != right.images()[place]) {
                let mut images = right.images().to_vec();
                images[place] = wrong;
                assert!(!Bijection::claimed(images).verify(&graph, &graph));
            }
        }
        assert!(!Bijection::claimed(Vec::new()).verify(&graph, &graph));
    }

    #[test]
    fn each_difference_is_named() {
        let (path, pan) = (EmbeddedGraph::chain(2), by_edges("u: a a b | v: b"));
        let two = EmbeddedGraph::cycle(2);
        let left = by_edges("u: a b c | v: a | w: b d | x: d | y: c e | z: e f | t: f");
        for (one, other, difference) in [
            (&path, &two, "3 vertices against 2"),
            (&pan, &two, "1 vertex of degree 3 against 0"),
            (&left, &left.mirror_image(), "the orders around the vertices differ"),
        ] {
            assert_eq!(isomorphism(one, other).unwrap_err().to_string(), difference);
        }
    }
}
