//! What each kind of marker adds to a percept, and what a robot can do with it.

use toposlam_model::{
    aid::{AidAction, RefusedAction},
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::{Class, Each, Enumeration},
    marker::{MARKERS, Marker, named},
    percept::Sighting,
    world::{AidHandler, GraphWorld},
};

/// A junction `j` with, clockwise, a way `p` to a dead end `a`, a way `q` to a bend `b`, and a loop.
/// Darts: 0 is that of `a`; 1 to 4 are those of `j`: to `a`, to `b`, and the ends of the loop; 5 and
/// 6 are those of `b`: to `j`, and to the dead end `c`, whose dart is 7.
pub(crate) fn junction() -> EmbeddedGraph {
    let lists = [
        ("a", vec!["p"]),
        ("j", vec!["p", "q", "l", "l"]),
        ("b", vec!["q", "r"]),
        ("c", vec!["r"]),
    ];
    EmbeddedGraph::from_edge_lists(&lists).unwrap()
}

/// What a marker placed by this facing dart shows to a robot that came in by each dart in turn.
fn shown(marker: &str, facing: u32) -> String {
    let graph = junction();
    let marker = named(marker).unwrap();
    let sightings = graph.darts().map(|pose| match marker.sighting(&graph, Dart(facing), pose) {
        Sighting::Nothing => ".".to_owned(),
        Sighting::Pointing(door) => door.0.to_string(),
        Sighting::Lying(count) => "x".repeat(count as usize),
        Sighting::These(markers) => markers.numbers().map(|at| ["f", "s"][at]).collect(),
        Sighting::Passed => "-".to_owned(),
        Sighting::PassedAlong => ">".to_owned(),
        Sighting::PassedAgainst => "<".to_owned(),
        other => panic!("{other} is seen of no fixed marker"),
    });
    sightings.collect::<Vec<_>>().join(" ")
}

/// And the robot may begin where it is noticed as at the start.
#[test]
fn each_marker_is_noticed_where_it_lies() {
    let cases: [(_, _, _, &[u32]); 7] = [
        ("none", ". . . . . . . .", ". . . . . . . .", &[0, 1, 2, 3, 4, 5, 6, 7]),
        ("undirected", ". x x x x . . .", ". x x x x . . .", &[1, 2, 3, 4]),
        ("directional", ". 1 0 3 2 . . .", ". 2 1 0 3 . . .", &[2]),
        ("undirected-edge", ". . - . . - . .", ". . . - - . . .", &[2, 5]),
        ("directed-edge", ". . < . . > . .", ". . . < > . . .", &[2, 5]),
        ("two-identical", ". x x x x x x .", ". xx xx xx xx . . .", &[1, 2, 3, 4, 5, 6]),
        ("two-distinct", ". f f f f s s .", ". fs fs fs fs . . .", &[1, 2, 3, 4]),
    ];
    for (marker, by_the_way_to_the_bend, by_the_loop, starts) in cases {
        assert_eq!(shown(marker, 2), by_the_way_to_the_bend, "{marker}");
        assert_eq!(shown(marker, 3), by_the_loop, "{marker}");
        let found = named(marker).unwrap().starts(&junction(), Dart(2));
        assert!(found.into_iter().eq(starts.iter().copied().map(Dart)), "{marker}");
    }
}

/// Two facing darts place a marker alike exactly when every pose sees the same: so the least of them
/// stands for the place.
#[test]
fn the_first_facing_dart_alike_stands_for_the_place() {
    let mut count = 0;
    for edges in 1..=4 {
        for graph in Enumeration::new(Each::World, Class::Multigraph, edges).unwrap().graphs() {
            count += 1;
            for marker in MARKERS {
                let shown = |facing| {
                    let sightings = graph.darts().map(|pose| marker.sighting(&graph, facing, pose));
                    sightings.collect::<Vec<_>>()
                };
                for facing in graph.darts() {
                    let alike = graph.darts().find(|&other| shown(other) == shown(facing));
                    assert_eq!(Some(marker.first_alike(&graph, facing)), alike, "{marker:?}");
                    let starts = marker.starts(&graph, facing);
                    assert!(starts.contains(&facing) && starts.is_sorted(), "{marker:?}");
                }
            }
        }
    }
    assert_eq!(count, 2 + 5 + 20 + 107, "all worlds with 1 to 4 edges");
}

#[test]
fn a_marker_that_stays_where_it_is_cannot_be_picked_up() {
    let graph = junction();
    for marker in MARKERS {
        let mut world = GraphWorld::with_aid(&graph, marker, Dart(2));
        let refused = world.handle(AidAction::PickUp);
        assert_eq!(refused, Err(RefusedAction::NothingToPickUp), "{marker:?}");
        assert_eq!(world.actions().len(), 4);
    }
}

#[test]
fn an_unknown_marker_is_refused_with_the_names_of_all_markers() {
    for marker in MARKERS {
        assert_eq!(named(marker.name()), Ok(marker));
        assert_eq!(MARKERS.into_iter().filter(|&other| other == marker).count(), 1);
        assert!(!marker.about().is_empty());
    }
    assert_eq!(
        named("chalk").unwrap_err().to_string(),
        "`chalk` is not a marker; the markers are none, undirected, directional, undirected-edge, \
         directed-edge, two-identical, two-distinct"
    );
}
