//! An embedded graph with open darts: ends of edges that lead to nowhere known.

use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    folding::FoldedTrail,
    mapping::{FACING, PartialMap},
    percept::Door,
};

/// An embedded graph with open darts. The darts of a vertex have successive numbers, clockwise.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OpenGraph {
    /// The first dart of each vertex, and the number of darts.
    firsts: Vec<usize>,
    /// The opposite of each dart; `None` if it is open.
    opposite: Vec<Option<Dart>>,
    marker: Option<Dart>,
}

impl OpenGraph {
    /// A folded trail. Its vertices are in the order of these darts, one for each vertex; the darts of each
    /// vertex begin with it.
    #[must_use]
    pub fn of_trail(trail: &FoldedTrail, entries: &[Dart]) -> Self {
        let degree = |entry: &Dart| trail.degree(*entry) as usize;
        let mut number = vec![None; trail.dart_count()];
        let doors = |&entry: &Dart| (0..trail.degree(entry)).map(move |door| (entry, Door(door)));
        let darts: Vec<Dart> =
            entries.iter().flat_map(doors).map(|(entry, door)| trail.behind(entry, door)).collect();
        for (place, dart) in darts.iter().enumerate() {
            number[dart.at()] = Some(Dart(place as u32));
        }
        let numbered = |dart: Dart| number[dart.at()];
        Self {
            firsts: sums(entries.iter().map(degree)),
            opposite: darts.iter().map(|&dart| trail.opposite(dart).and_then(numbered)).collect(),
            marker: trail.marker().and_then(numbered),
        }
    }

    /// The number of a dart: that of a vertex's first dart and of the door, counted from it.
    pub(crate) fn dart(&self, vertex: usize, door: Door) -> Dart {
        Dart(self.firsts[vertex] as u32 + door.0)
    }

    pub(super) fn vertex_count(&self) -> usize {
        self.firsts.len() - 1
    }

    pub(super) fn dart_count(&self) -> usize {
        self.opposite.len()
    }

    /// The same graph without the marker, which may be elsewhere now.
    #[must_use]
    pub(crate) fn without_marker(self) -> Self {
        Self { marker: None, ..self }
    }

    pub(super) fn marker(&self) -> Option<Dart> {
        self.marker
    }

    /// Whether it is an earlier stage of another one.
    pub(super) fn grew_into(&self, other: &Self) -> bool {
        let mut pairs = self.opposite.iter().zip(&other.opposite);
        other.firsts.starts_with(&self.firsts)
            && pairs.all(|(one, other)| one.is_none() || one == other)
    }

    /// The graph with a vertex behind each open dart. Its own vertices and darts keep their numbers, the others
    /// follow in the order of the open darts. `None` if it has no vertex.
    pub(super) fn with_ends(&self) -> Option<EmbeddedGraph> {
        let count = self.dart_count();
        let mut clockwise = Vec::new();
        for around in self.firsts.windows(2) {
            clockwise.extend((around[0] + 1..around[1]).chain([around[0]]));
        }
        let open: Vec<usize> = (0..count).filter(|&dart| self.opposite[dart].is_none()).collect();
        let mut ends = count..;
        let mut joined: Vec<u32> = self
            .opposite
            .iter()
            .map(|other| other.map_or_else(|| ends.next().unwrap_or(count) as u32, |other| other.0))
            .collect();
        clockwise.extend(count..count + open.len());
        joined.extend(open.iter().map(|&dart| dart as u32));
        let clockwise: Vec<u32> = clockwise.into_iter().map(|dart| dart as u32).collect();
        EmbeddedGraph::from_permutations(&joined, &clockwise).ok().map(|(graph, _)| graph)
    }
}

impl From<&PartialMap> for OpenGraph {
    fn from(map: &PartialMap) -> Self {
        let darts = map.vertices().flat_map(|vertex| map.darts_of(vertex));
        Self {
            firsts: sums(map.vertices().map(|vertex| map.degree(vertex) as usize)),
            opposite: darts.map(|dart| map.opposite(dart)).collect(),
            marker: Some(FACING),
        }
    }
}

/// The sums of the numbers before each, and of all.
fn sums(numbers: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut sum = 0;
    let before = numbers.map(|number| {
        sum += number;
        sum
    });
    std::iter::once(0).chain(before).collect()
}
