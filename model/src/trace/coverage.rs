//! The cases of Algorithm 1 that a run covers. Sections 2.1 and 2.3.

use std::collections::BTreeMap;

use crate::{
    embedded_graph::EmbeddedGraph,
    mapping::{Algorithm1Run, MapWalk, MappingEvent, Observed, Observer, explore},
    percept::Sighting,
    world::GraphWorld,
};

crate::words! {
    /// Something that can happen in a run.
    AlgorithmCase {
        /// Lines 21 to 23: an unexplored edge led to a new vertex.
        NewVertex = "new-vertex",
        /// Lines 16 to 20: a hypothesis was confirmed, and a loop closed.
        Confirmed = "confirmed",
        /// Line 7: the percept on arrival contradicted a hypothesis at once.
        RejectedAtOnce = "rejected-at-once",
        /// Lines 13 to 15: a hypothesis was rejected on the way to the marker.
        RejectedOnTheWay = "rejected-on-the-way",
        /// Lines 13 to 15: a hypothesis was rejected where the marker should have been.
        RejectedAtTheEnd = "rejected-at-the-end",
        /// The marker was perceived, after the start.
        MarkerSeen = "marker-seen",
        /// The marker was expected and not perceived.
        MarkerMissed = "marker-missed",
    }
}

/// How often each case happened.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct AlgorithmCoverage {
    counts: BTreeMap<AlgorithmCase, u64>,
}

impl AlgorithmCoverage {
    pub fn count(&self, case: AlgorithmCase) -> u64 {
        self.counts.get(&case).copied().unwrap_or(0)
    }

    fn add(&mut self, case: AlgorithmCase, count: u64) {
        if count > 0 {
            *self.counts.entry(case).or_default() += count;
        }
    }
}

impl<W: ?Sized> Observer<W> for AlgorithmCoverage {
    fn event(&mut self, _: &mut W, _: &MapWalk, event: MappingEvent) {
        match event {
            MappingEvent::Moved { percept, .. } => {
                self.add(
                    AlgorithmCase::MarkerSeen,
                    u64::from(percept.sighting != Sighting::Nothing),
                );
            }
            MappingEvent::Arrived { contradicted, .. } => {
                self.add(AlgorithmCase::RejectedAtOnce, contradicted as u64);
            }
            MappingEvent::Rejected { expected, perceived, .. } => {
                // The marker is expected at the end of the path, and nowhere else on it.
                let at_the_end = expected.sighting != Sighting::Nothing;
                let missed = at_the_end && perceived.sighting == Sighting::Nothing;
                let case = if at_the_end {
                    AlgorithmCase::RejectedAtTheEnd
                } else {
                    AlgorithmCase::RejectedOnTheWay
                };
                self.add(case, 1);
                self.add(AlgorithmCase::MarkerMissed, u64::from(missed));
            }
            MappingEvent::LoopClosed { .. } => self.add(AlgorithmCase::Confirmed, 1),
            MappingEvent::VertexAdded { .. } => self.add(AlgorithmCase::NewVertex, 1),
            _ => {}
        }
    }
}

/// How often each case happens when a world is mapped from each of its starts, with the default
/// choices.
pub fn reachable(graph: &EmbeddedGraph) -> AlgorithmCoverage {
    let mut coverage = AlgorithmCoverage::default();
    let mut exploration = Algorithm1Run::default();
    for facing in graph.darts() {
        // A world beyond the bound has been covered as far as a run goes.
        let mut world = GraphWorld::new(graph, facing);
        let _ = explore(&mut exploration, &mut Observed::new(&mut world, &mut coverage));
    }
    coverage
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        embedded_graph::Dart,
        percept::{Door, Percept},
        trace::tests::lollipop,
    };

    #[test]
    fn cases_are_counted() {
        let graph = lollipop();
        let mut coverage = AlgorithmCoverage::default();
        let mut world = GraphWorld::new(&graph, Dart(0));
        let world = &mut Observed::new(&mut world, &mut coverage);
        explore(&mut Algorithm1Run::new(8), world).unwrap();
        // The tail leads to the fork, one way round to two corners; the last edge closes the loop, which
        // is found by going the rest of it and back along the tail. What did not happen is not counted.
        let counts = AlgorithmCase::ALL.map(|case| coverage.count(case));
        assert_eq!(counts, [3, 1, 2, 0, 0, 1, 0], "{coverage:?}");
        assert_eq!(coverage.counts.len(), 4);
    }

    #[test]
    fn a_marker_that_points_elsewhere_is_not_missed() {
        let percept = |sighting| Percept { degree: 2, sighting };
        let [along, aside] = [0, 1].map(|door| percept(Sighting::Pointing(Door(door))));
        let none = percept(Sighting::Nothing);
        for (expected, perceived, counts) in [
            (along, aside, [0, 1, 0]),
            (along, none, [0, 1, 1]),
            (none, percept(Sighting::Lying(1)), [1, 0, 0]),
        ] {
            let mut coverage = AlgorithmCoverage::default();
            let event =
                MappingEvent::Rejected { hypothesis: Dart(1), followed: 1, expected, perceived };
            coverage.event(&mut (), Algorithm1Run::new(0).walk(), event);
            let cases = [
                AlgorithmCase::RejectedOnTheWay,
                AlgorithmCase::RejectedAtTheEnd,
                AlgorithmCase::MarkerMissed,
            ];
            assert_eq!(cases.map(|case| coverage.count(case)), counts);
        }
    }

    #[test]
    fn a_chain_never_rejects_on_the_way() {
        let reachable = reachable(&EmbeddedGraph::chain(2));
        assert_eq!(reachable.count(AlgorithmCase::RejectedOnTheWay), 0);
        assert_eq!(reachable.count(AlgorithmCase::Confirmed), 0);
        assert_eq!(reachable.count(AlgorithmCase::NewVertex), 2 * 4);
    }
}
