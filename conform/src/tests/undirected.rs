//! Robots with an undirected marker: all sightings are of one vertex, and how it was entered each time is not known.

use std::sync::atomic::{AtomicUsize, Ordering};

use toposlam_model::{
    aid::AidKind,
    enumerate::Watch,
    folding::SmallestWorld,
    format::{named_world::NamedWorld, world_file},
    marker::{NoMarker, Undirected},
};

use super::*;
use crate::impossible::Impossibility;

const SEEN: Sighting = Sighting::Lying(1);
const NOT_SEEN: Sighting = Sighting::Nothing;

/// A walk through junctions with these degrees, which leaves the last one by no door.
fn walk(visits: &[(u32, Sighting, u32)]) -> RunEvents {
    let mut kinds: Vec<CheckedKind> = visits
        .iter()
        .flat_map(|&(degree, sighting, door)| [bare_arrival(degree, sighting), bare_door(door)])
        .collect();
    kinds.pop();
    bare_events(kinds)
}

fn config() -> ConformConfig {
    ConformConfig { aid: Undirected.into(), ..by_anyone() }
}

/// The number of ways in which the marked visits can be of one vertex, and whether they determine the world.
fn ways(visits: &[(u32, Sighting, u32)]) -> (usize, Option<bool>) {
    let found = judged(&walk(visits), &config());
    assert_eq!(found.divergence, None);
    (found.ways, found.determines_world())
}

#[test]
fn sightings_can_be_of_one_vertex_in_as_many_ways_as_it_can_be_entered() {
    // There and back again: the walk itself identifies the two visits.
    assert_eq!(ways(&[(1, SEEN, 0), (1, NOT_SEEN, 0), (1, SEEN, 0)]), (1, Some(true)));
    assert_eq!(ways(&[(2, SEEN, 1), (1, NOT_SEEN, 0), (2, SEEN, 0)]), (1, Some(false)));
    // Onwards through a corner: by the door that it took before a robot cannot come back over another edge.
    let ring = [(2, SEEN, 1), (2, NOT_SEEN, 1), (2, SEEN, 0)];
    assert_eq!(ways(&ring), (1, Some(true)));
    let fork = [(3, SEEN, 1), (2, NOT_SEEN, 1), (3, SEEN, 0)];
    assert_eq!(ways(&fork), (2, Some(false)));
    // Without a marker in between nothing is united.
    assert_eq!(ways(&[(3, SEEN, 1), (3, NOT_SEEN, 1), (3, NOT_SEEN, 0)]), (1, Some(false)));
}

#[test]
fn the_world_of_a_walk_that_one_way_explains_is_found() {
    let found = judged(&walk(&[(2, SEEN, 1), (2, NOT_SEEN, 1), (2, SEEN, 1)]), &config());
    let Some(SmallestWorld::World { graph, limit: None, .. }) = found.smallest else {
        panic!("{:?}", found.smallest)
    };
    assert_eq!((graph.vertex_count(), graph.edge_count()), (2, 2));
    assert_eq!(found.trail.unwrap().open_count(), 0);
}

#[test]
fn a_marker_that_is_seen_at_two_different_junctions_fits_no_world() {
    let visits = [
        (3, SEEN, 1),
        (2, NOT_SEEN, 1),
        (3, SEEN, 1),
        (2, NOT_SEEN, 1),
        (4, SEEN, 1),
        (2, NOT_SEEN, 0),
    ];
    let found = divergence(&walk(&visits), &config());
    let DivergenceCause::NoWorld { why, .. } = found.cause else { panic!("{found:?}") };
    assert_eq!((found.event, why), (8, Impossibility::OnePlace));
}

/// Figure 1: with an undirected marker no walk distinguishes these worlds.
#[test]
fn another_world_explains_a_walk_in_figure_1_unless_it_diverges() {
    let text = include_bytes!("../../../worlds/figure-1a.toml");
    let world = world_file::read(text).unwrap();
    let (graph, start) = (&world.graph, world.start.unwrap());
    let mut robot = GraphWorld::with_aid(graph, AidKind::from(Undirected), start);
    let states = vec![robot.state()];
    let mut kinds = vec![CheckedKind::from(robot.sensed())];
    for door in [1, 1, 1, 0, 1, 1, 2, 1, 1, 1, 2, 2, 1, 1, 2, 1, 0, 1, 1, 1] {
        let door = door % robot.sensed().degree;
        robot.traverse(Door(door)).unwrap();
        kinds.extend([bare_door(door), CheckedKind::from(robot.sensed())]);
    }
    let known = Some(KnownWorld { graph: graph.clone(), states });
    let in_world = ConformConfig { world: known, ..config() };
    let judgement = judged(&bare_events(kinds.clone()), &in_world);
    let twin = TwinWorld::find(&judgement, &in_world).unwrap();
    let figures = (twin.first_figure, twin.figure);
    assert_eq!(figures, (Some("Figure 1(a)"), Some("Figure 1(b)")));
    let mut diverged = judgement.clone();
    let cause = DivergenceCause::TurnedBack;
    let found = Divergence { event: 2, fault: cause.fault(), cause };
    diverged.contradiction = Some((found.clone(), Unproved::Scans));
    assert!(TwinWorld::find(&diverged, &in_world).is_none());
    diverged.contradiction = None;
    diverged.divergence = Some(found);
    assert!(TwinWorld::find(&diverged, &in_world).is_none());
    // A robot without a marker has too many.
    let unmarked = ConformConfig { aid: NoMarker.into(), ..in_world };
    assert!(TwinWorld::find(&judgement, &unmarked).is_none());
    // So has a smallest world that is found to be this one.
    let mut found = judged(&bare_events(kinds), &config());
    let graph = NamedWorld::discovered("", "", graph, start).graph;
    found.smallest = Some(SmallestWorld::World { graph, marker: Some(Dart(0)), limit: None });
    let twin = TwinWorld::find(&found, &config()).unwrap();
    assert_eq!((twin.first_figure, twin.figure), figures);
}

/// Stops the work when it has been asked so often.
struct StopAfter(AtomicUsize);

impl Watch for StopAfter {
    fn stop(&self) -> bool {
        self.0
            .fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| left.checked_sub(1))
            .is_err()
    }
}

/// A search that was stopped proves nothing, however many ways it has found.
#[test]
fn what_a_search_has_not_tried_may_explain_the_walk() {
    let other = [(3, SEEN, 1), (2, NOT_SEEN, 1), (4, SEEN, 0)];
    let fork = [(3, SEEN, 1), (2, NOT_SEEN, 1), (3, SEEN, 0)];
    for (visits, questions, ways) in [(&other, 0, 0), (&fork, 0, 0), (&fork, 2, 1), (&fork, 3, 2)] {
        let watch = StopAfter(AtomicUsize::new(questions));
        let found = judge(walk(visits), &config(), &Quirks::default(), &watch).unwrap();
        assert_eq!((found.ways, &found.divergence), (ways, &None), "{questions}");
        let determined = (ways > 1).then_some(false);
        assert_eq!(found.determines_world(), determined, "{questions}");
        // It stays that of the walk alone.
        assert_eq!(found.trail.unwrap().vertex_count(), 3);
    }
}
