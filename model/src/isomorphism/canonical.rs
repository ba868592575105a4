//! The canonical form of an embedded graph: its least start; and its automorphisms, found on the
//! way.

use std::cmp::Ordering;

use petgraph::unionfind::UnionFind;

use super::code::{Numbering, StartCode};
use crate::embedded_graph::{Dart, EmbeddedGraph};

/// The canonical form of an embedded graph: equal for isomorphic graphs, with its place in this one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Canonical {
    /// The least of the codes of the graph's starts: equal for two embedded graphs exactly when
    /// they are isomorphic.
    pub code: StartCode,
    /// The darts in the order in which the least start meets them.
    pub order: Vec<Dart>,
    /// The number of automorphisms. The graph has `2m / automorphisms` starts.
    pub automorphisms: usize,
    /// For each dart, the least dart of its orbit under automorphisms.
    pub orbit: Vec<Dart>,
}

/// The canonical form of an embedded graph.
///
/// All starts compete, word by word, and drop out at the first greater word. Two starts with the
/// same code are an automorphism, which then spares the rest of its orbits; so a graph with many
/// automorphisms is no slower. Close to linear time, except for graphs that are almost symmetric.
pub fn canonical(graph: &EmbeddedGraph) -> Canonical {
    let mut best = Numbering::new(graph);
    let mut rival = Numbering::new(graph);
    let mut code: Vec<u32> = best.words(graph, Dart(0)).collect();
    let mut orbits = UnionFind::<u32>::new(graph.dart_count());
    let mut tried = vec![false; graph.dart_count()];
    tried[0] = true;
    for dart in graph.darts().skip(1) {
        // An automorphism maps it to a dart that has competed already.
        if std::mem::replace(&mut tried[orbits.find_mut(dart.0) as usize], true) {
            continue;
        }
        let mut place = 0;
        let mut word = rival.begin(graph, dart);
        let outcome = loop {
            match word.cmp(&code[place]) {
                Ordering::Equal => place += 1,
                unequal => break unequal,
            }
            match rival.next_word(graph) {
                Some(next) => word = next,
                None => break Ordering::Equal,
            }
        };
        match outcome {
            Ordering::Greater => {}
            Ordering::Less => {
                code.truncate(place);
                code.push(word);
                code.extend(std::iter::from_fn(|| rival.next_word(graph)));
                std::mem::swap(&mut best, &mut rival);
            }
            Ordering::Equal => {
                for (one, other) in best.order.iter().zip(&rival.order) {
                    let trod = tried[orbits.find_mut(one.0) as usize]
                        || tried[orbits.find_mut(other.0) as usize];
                    orbits.union(one.0, other.0);
                    tried[orbits.find_mut(one.0) as usize] = trod;
                }
            }
        }
    }
    let root = orbits.find_mut(best.order[0].0);
    let automorphisms = graph.darts().filter(|dart| orbits.find_mut(dart.0) == root).count();
    let mut least = vec![None; graph.dart_count()];
    let orbit = graph
        .darts()
        .map(|dart| *least[orbits.find_mut(dart.0) as usize].get_or_insert(dart))
        .collect();
    Canonical { code: StartCode(code), order: best.order, automorphisms, orbit }
}
