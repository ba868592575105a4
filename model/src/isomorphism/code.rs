//! The code of a start: equal for two starts exactly when they are isomorphic. Linear time.
//!
//! The darts are numbered as a robot meets them: those of the start vertex clockwise from the
//! facing dart; then, dart by dart, the other end of its edge, and if that is at a vertex not met
//! before, the darts there, clockwise from it. The code has a word for each edge in that order.

use crate::embedded_graph::{Dart, EmbeddedGraph};

/// The code of a start: the degree of the start vertex and then, for each edge in the order in
/// which it is met, a word for where it leads.
///
/// The order of codes is lexicographic. A lead to a dart already met (the lower its number the
/// less) is less than a lead to a new vertex, and a vertex of higher degree is less than one of
/// lower degree.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct StartCode(pub(super) Vec<u32>);

impl StartCode {
    /// The words of the code: `u32::MAX - degree` for the start vertex; then for each edge the
    /// number of its second dart, or `u32::MAX - degree` where that is at a new vertex.
    pub fn words(&self) -> &[u32] {
        &self.0
    }

    /// The code with these words, which may be of no start.
    pub(crate) fn of_words(words: Vec<u32>) -> Self {
        Self(words)
    }

    /// The start with these words, as [`as_discovered`] numbers its darts: the facing dart is dart 0. `None`
    /// if they are not the code of a start.
    pub fn start_of(words: &[u32]) -> Option<EmbeddedGraph> {
        let (&first, words) = words.split_first()?;
        let edges = words.len();
        let degree_of =
            |word: u32| Some(u32::MAX - word).filter(|&d| (1..=2 * edges as u32).contains(&d));
        let mut graph = EmbeddedGraph::unfinished();
        graph.add_vertex(degree_of(first)?);
        let mut next = 0;
        for &word in words {
            let free = (next..graph.dart_count() as u32).map(Dart);
            let dart = free.into_iter().find(|&dart| graph.joined(dart).is_none())?;
            next = dart.0 + 1;
            let known = graph.dart_count() as u32;
            let far = if word < known {
                Dart(word)
            } else {
                graph.add_vertex(degree_of(word)?);
                Dart(known)
            };
            if far <= dart || graph.joined(far).is_some() || graph.dart_count() > 2 * edges {
                return None;
            }
            graph.join(dart, far);
        }
        (graph.dart_count() == 2 * edges).then_some(graph)
    }
}

fn new_vertex(degree: u32) -> u32 {
    u32::MAX - degree
}

/// The code of a start. Linear time.
// paper: world.unlabelled
pub fn code(graph: &EmbeddedGraph, facing: Dart) -> StartCode {
    StartCode(Numbering::new(graph).words(graph, facing).collect())
}

/// The same embedded graph with its darts numbered as a robot meets them from a start, the facing
/// dart first. Isomorphic starts become equal graphs.
pub fn as_discovered(graph: &EmbeddedGraph, facing: Dart) -> EmbeddedGraph {
    graph.renumbered(&discovery_order(graph, facing))
}

/// The darts in the order in which a robot meets them from a start, the facing dart first.
pub fn discovery_order(graph: &EmbeddedGraph, facing: Dart) -> Vec<Dart> {
    let mut numbering = Numbering::new(graph);
    numbering.words(graph, facing).for_each(drop);
    numbering.order
}

/// The numbering of a graph's darts from a start, made one edge at a time. Can be begun again
/// without clearing.
pub(super) struct Numbering {
    pub(super) order: Vec<Dart>,
    /// The number of each dart, valid where `stamp` is current.
    number: Vec<u32>,
    stamp: Vec<u32>,
    current: u32,
    /// The number of darts of `order` with a known other end.
    done: usize,
}

impl Numbering {
    pub(super) fn new(graph: &EmbeddedGraph) -> Self {
        Self {
            order: Vec::with_capacity(graph.dart_count()),
            number: vec![0; graph.dart_count()],
            stamp: vec![0; graph.dart_count()],
            current: 0,
            done: 0,
        }
    }

    /// The words of the code of a start, each made when it is taken.
    pub(super) fn words(
        &mut self,
        graph: &EmbeddedGraph,
        facing: Dart,
    ) -> impl Iterator<Item = u32> {
        let first = self.begin(graph, facing);
        std::iter::once(first).chain(std::iter::from_fn(|| self.next_word(graph)))
    }

    /// Starts again, and returns the first word.
    pub(super) fn begin(&mut self, graph: &EmbeddedGraph, facing: Dart) -> u32 {
        // One numbering is begun at most once for each of fewer than 2^32 darts.
        self.current += 1;
        self.order.clear();
        self.done = 0;
        self.meet(graph, facing)
    }

    fn meet(&mut self, graph: &EmbeddedGraph, entry: Dart) -> u32 {
        let mut dart = entry;
        let degree = graph.degree(graph.vertex(entry));
        for _ in 0..degree {
            self.number[dart.at()] = self.order.len() as u32;
            self.stamp[dart.at()] = self.current;
            self.order.push(dart);
            dart = graph.clockwise(dart);
        }
        new_vertex(degree)
    }

    /// The word of the next edge; `None` after the last.
    pub(super) fn next_word(&mut self, graph: &EmbeddedGraph) -> Option<u32> {
        while self.done < self.order.len() {
            let this = self.done;
            self.done += 1;
            let other = graph.opposite(self.order[this]);
            if self.stamp[other.at()] != self.current {
                return Some(self.meet(graph, other));
            }
            let number = self.number[other.at()];
            if number as usize > this {
                return Some(number);
            }
        }
        None
    }
}
