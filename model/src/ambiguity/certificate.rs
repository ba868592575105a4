//! Certificates of any marking aid, by search: the fewest moves after which one world is left that explains all that was
//! perceived. For a directional marker [`certificate_walk`](crate::folding::certificate_walk) is that without a search.
//!
//! A robot knows the places that it discovered, and which of their darts it has gone through. The other end of
//! each dart that nobody went through may be new, or any of the others that are open. So the worlds that explain a run are
//! finitely many beginnings of worlds, each with open darts at which it may go on in any way; and the run determines its
//! world when one beginning without open darts is left.

use std::collections::{HashSet, VecDeque};

use crate::{
    aid::{Action, Aid, AidAction, AidKind, Places, State},
    embedded_graph::{Dart, EmbeddedGraph},
    marker::{TwoDistinct, TwoIdentical},
    percept::Percept,
    world::GraphWorld,
};

/// A dart through which nobody went.
const OPEN: u32 = u32::MAX;

/// What may be known of a world: places in the order of their discovery, and the robot with its aid.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
struct Beginning {
    /// The place of each dart. Those of one place are in clockwise order, from the one by which it was discovered.
    places: Vec<u32>,
    opposite: Vec<u32>,
    state: State<Places>,
}

impl Beginning {
    /// At the start, with its open darts.
    fn of_start(aid: AidKind, degree: u32) -> Option<Self> {
        let [places, opposite] = [0, OPEN].map(|value| vec![value; degree as usize]);
        let placed = Places::from_slice(&[]);
        let mut start = Self { places, opposite, state: State { pose: Dart(0), placed } };
        start.state.placed = aid.placed(&start.graph()?, Dart(0));
        Some(start)
    }

    fn is_complete(&self) -> bool {
        !self.opposite.contains(&OPEN)
    }

    /// A graph of these places, with a dead end behind each open dart. Darts have the same numbers.
    fn graph(&self) -> Option<EmbeddedGraph> {
        let count = self.places.len() as u32;
        let next = |dart: u32| {
            let place = self.places.get(dart as usize);
            if self.places.get(dart as usize + 1) == place {
                dart + 1
            } else {
                self.places.iter().position(|one| Some(one) == place).unwrap_or_default() as u32
            }
        };
        let mut opposite = self.opposite.clone();
        let mut clockwise: Vec<u32> = (0..count).map(next).collect();
        for dart in 0..count {
            if opposite[dart as usize] == OPEN {
                let end = opposite.len() as u32;
                opposite[dart as usize] = end;
                opposite.push(dart);
                clockwise.push(end);
            }
        }
        EmbeddedGraph::from_permutations(&opposite, &clockwise).ok().map(|(graph, _)| graph)
    }

    /// Every end of an open dart: at a new place of this degree, or at another open dart of one.
    fn ends(&self, dart: u32, degree: u32) -> Vec<Self> {
        let mut ends = Vec::new();
        let place_of = |dart: u32| self.places[dart as usize];
        for other in (0..self.opposite.len() as u32).filter(|other| *other != dart) {
            let is_open = self.opposite[other as usize] == OPEN;
            let fits = || self.places.iter().filter(|place| **place == place_of(other)).count();
            if is_open && fits() == degree as usize {
                let mut end = self.clone();
                (end.opposite[dart as usize], end.opposite[other as usize]) = (other, dart);
                ends.push(end);
            }
        }
        let mut new = self.clone();
        let place = self.places.last().map_or(0, |last| last + 1);
        new.opposite[dart as usize] = new.opposite.len() as u32;
        new.places.resize(new.places.len() + degree as usize, place);
        new.opposite.push(dart);
        new.opposite.resize(new.places.len(), OPEN);
        ends.push(new);
        ends
    }

    /// Every way in which an action can lead to a place of this degree.
    fn explanations(&self, action: Action, degree: Option<u32>) -> Vec<Self> {
        let by = self.graph().and_then(|graph| moved_by(action, &graph, &self.state));
        match (by, degree) {
            (Some(by), Some(degree)) if self.opposite[by.at()] == OPEN => self.ends(by.0, degree),
            _ => vec![self.clone()],
        }
    }

    /// The same after an action, if that is possible there and the robot then perceives this.
    fn after(self, aid: AidKind, action: Action, seen: Percept) -> Option<Self> {
        let graph = self.graph()?;
        let mut world = GraphWorld::in_state(&graph, aid, self.state.clone());
        world.act(action).ok()?;
        let state = world.state();
        (world.sensed() == seen).then_some(Self { state, ..self })
    }
}

/// The dart by which an action moves a robot.
fn moved_by(action: Action, graph: &EmbeddedGraph, state: &State<Places>) -> Option<Dart> {
    match action {
        Action::Take(door) => Some(graph.behind(state.pose, door)),
        Action::Do(AidAction::Send { robot, door }) => {
            let pose = state.placed.get(usize::from(robot).checked_sub(2)?).copied().flatten()?;
            Some(graph.behind(pose, door))
        }
        Action::Do(_) => None,
    }
}

/// A robot in its world, and the beginnings that explain what it perceived.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct Knowledge {
    state: State<Places>,
    /// Whether a robot has gone through the edge of each dart of the world.
    explored: Vec<bool>,
    beginnings: Vec<Beginning>,
}

impl Knowledge {
    fn determines_world(&self) -> bool {
        matches!(&*self.beginnings, [only] if only.is_complete())
    }

    /// After an action that is possible in the world.
    fn after(&self, aid: AidKind, graph: &EmbeddedGraph, action: Action) -> Option<Self> {
        let mut world = GraphWorld::in_state(graph, aid, self.state.clone());
        let by = moved_by(action, graph, &self.state);
        let degree = by.map(|by| graph.degree_around(graph.opposite(by)));
        world.act(action).ok()?;
        let seen = world.sensed();
        let mut beginnings: Vec<_> = self
            .beginnings
            .iter()
            .flat_map(|beginning| beginning.explanations(action, degree))
            .filter_map(|beginning| beginning.after(aid, action, seen))
            .collect();
        beginnings.sort_unstable();
        beginnings.dedup();
        let mut explored = self.explored.clone();
        if let Some(by) = by {
            for dart in [by, graph.opposite(by)] {
                explored[dart.at()] = true;
            }
        }
        Some(Self { state: world.state(), explored, beginnings })
    }
}

/// Actions with the fewest moves after which a robot with this aid knows its world, among all worlds of any size; `None` if
/// `most` states of knowledge do not suffice to find them. It is not known, and `None`, too, for what shows more than the
/// places where robots were: markers at both ends of an edge, and binoculars.
pub fn shortest_certificate(
    aid: AidKind,
    (graph, facing): (&EmbeddedGraph, Dart),
    most: usize,
) -> Option<Vec<Action>> {
    if matches!(aid, AidKind::Fixed(TwoIdentical | TwoDistinct) | AidKind::Binoculars(_)) {
        return None;
    }
    let start = Beginning::of_start(aid, graph.degree_around(facing))?;
    let state = State { pose: facing, placed: aid.placed(graph, facing) };
    let explored = vec![false; graph.dart_count()];
    let start = Knowledge { state, explored, beginnings: vec![start] };
    let mut known = HashSet::new();
    // With the actions that led there. Each edge needs a move, so those come first whose moves and edges that are left are the
    // fewest: a move through a new edge leaves the sum as it is, and any other move adds one.
    let mut waiting = VecDeque::from([(start, Vec::new())]);
    while let Some((knowledge, actions)) = waiting.pop_front() {
        if known.contains(&knowledge) {
            continue;
        }
        if knowledge.determines_world() {
            return Some(actions);
        }
        if known.len() == most {
            return None;
        }
        known.insert(knowledge.clone());
        let world = GraphWorld::in_state(graph, aid, knowledge.state.clone());
        for action in world.actions() {
            let Some(next) = knowledge.after(aid, graph, action) else { continue };
            if known.contains(&next) {
                continue;
            }
            let actions = [&actions[..], &[action]].concat();
            if action.moves() == 0 || next.explored != knowledge.explored {
                waiting.push_front((next, actions));
            } else {
                waiting.push_back((next, actions));
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        aid::{AIDS, named, string::LaidString},
        enumerate::{Class, Each, Enumeration},
        folding::certificate_length,
        mapping::MappingAlgorithm,
        marker::Directional,
    };

    fn starts(class: Class, edges: usize) -> Vec<EmbeddedGraph> {
        Enumeration::new(Each::Start, class, edges).unwrap().graphs().collect()
    }

    fn moves(aid: AidKind, graph: &EmbeddedGraph) -> Option<u64> {
        let found = shortest_certificate(aid, (graph, Dart(0)), 50_000)?;
        Some(found.into_iter().map(Action::moves).sum())
    }

    #[test]
    fn with_a_directional_marker_the_search_finds_the_certificates_of_folding() {
        let multigraphs = (1..=3).flat_map(|edges| starts(Class::Multigraph, edges));
        let simple = (4..=5).flat_map(|edges| starts(Class::Simple, edges));
        for graph in multigraphs.chain(simple) {
            let found = moves(Directional.into(), &graph);
            assert_eq!(found, Some(certificate_length(&graph, Dart(0)) as u64), "{graph:?}");
        }
    }

    /// Otherwise it would know what the worlds that explain its run do not say.
    #[test]
    fn no_explorer_maps_a_world_in_fewer_moves_than_a_certificate_has() {
        let all: Vec<_> = (1..=4).flat_map(|edges| starts(Class::Simple, edges)).collect();
        for algorithm in MappingAlgorithm::all() {
            let aid = algorithm.aid();
            for graph in &all {
                let mut world = GraphWorld::with_aid(graph, aid, Dart(0));
                let (run, map) = algorithm.map_world(&mut world, 20, &mut ());
                map.unwrap();
                let least = moves(aid, graph).expect("few states");
                assert!(least <= run.moves(), "{} in {graph:?}", aid.name());
                // Two copies of the world that cross at an edge which nobody goes through look the same.
                assert!(least >= graph.edge_count() as u64, "{} in {graph:?}", aid.name());
            }
        }
    }

    #[test]
    fn of_what_shows_unknown_places_no_certificate_is_known() {
        for aid in AIDS {
            let shows_more = ["two-identical", "two-distinct"].contains(&aid.name())
                || matches!(aid, AidKind::Binoculars(_));
            let found = moves(aid, &EmbeddedGraph::cycle(3));
            assert_eq!(found.is_some(), !shows_more && aid != named("none").unwrap(), "{aid:?}");
        }
    }

    #[test]
    fn a_ring_is_certain_after_one_round_and_without_a_marker_no_ring_is() {
        for edges in 3..=6 {
            let ring = EmbeddedGraph::cycle(edges);
            for aid in [Directional.into(), AidKind::String(LaidString::of_any_length())] {
                assert_eq!(moves(aid, &ring), Some(edges as u64), "{}", aid.name());
            }
            // Two robots go both ways round, until one of them comes to the other.
            assert_eq!(moves(named("team-2").unwrap(), &ring), Some(edges as u64));
        }
        assert_eq!(moves(named("none").unwrap(), &EmbeddedGraph::cycle(3)), None);
    }
}
