//! The folding explorer with the directional marker whose robot also measures lengths, or has a compass.

use std::borrow::Cow;

use proptest::prelude::*;
use toposlam_model::{
    aid::{AidKind, RefusedAction, compass::Directions},
    check::{judge, judge_map, judge_start},
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::Class,
    floor_plan::Direction,
    folding::{ArrivalSenses, LengthInterval, certificate_length},
    isomorphism::Candidate,
    mapping::{
        DEFAULT_DART_BOUND, ExploredMap, Explorer, FACING, FoldingRun, MappingAlgorithm,
        MappingError, explore,
    },
    percept::CompassView,
    world::{GraphWorld, SensingWorld},
};

use crate::starts;

/// The moves of a run with senses. Its map is judged.
fn moves(
    graph: &EmbeddedGraph,
    mut sense: impl FnMut(Dart) -> ArrivalSenses,
) -> Result<u64, MappingError<RefusedAction>> {
    let mut explorer = FoldingRun::default();
    let bound = explorer.move_bound(graph.edge_count(), graph.vertex_count());
    let world = GraphWorld::new(graph, Dart(0)).with_bound(bound);
    let mut world = SensingWorld::new(world, |world: &GraphWorld<'_>| sense(world.pose()));
    explore(&mut explorer, &mut world)?;
    judge(&explorer, Dart(0), world.world(), &mut Candidate::default()).unwrap();
    assert!(explorer.moves() >= certificate_length(graph, Dart(0)) as u64, "{graph:?}");
    Ok(explorer.moves())
}

fn moves_without_senses(graph: &EmbeddedGraph) -> u64 {
    let mut explorer = FoldingRun::default();
    let (moves, judged) = judge_start(&mut explorer, graph, Dart(0), &mut Candidate::default());
    assert_eq!(judged, Ok(()));
    moves
}

/// The number of a dart's edge.
fn edge(graph: &EmbeddedGraph, dart: Dart) -> u32 {
    let edges = graph.edges();
    edges.into_iter().position(|(one, other)| [one, other].contains(&dart)).unwrap() as u32
}

fn measured(length: LengthInterval) -> ArrivalSenses {
    ArrivalSenses { length: Some(length), compass: None }
}

/// The largest worlds whose starts are all tried.
const SWEPT: [(Class, usize); 2] = [(Class::Multigraph, 5), (Class::Simple, 7)];

/// The moves on all starts of a class without lengths and with lengths by the number of the edge, which must be right.
fn swept(
    (class, most): (Class, usize),
    sense: impl Fn(u32, u64) -> ArrivalSenses,
) -> (Vec<u64>, Vec<u64>) {
    let graphs = (1..=most).flat_map(|edges| starts(class, edges));
    let moves_of = |graph: EmbeddedGraph| {
        let mut traversals = 0;
        let with = moves(&graph, |dart| {
            traversals += 1;
            sense(edge(&graph, dart), traversals)
        });
        (moves_without_senses(&graph), with.unwrap())
    };
    graphs.map(moves_of).unzip()
}

#[test]
fn equal_lengths_cost_what_no_lengths_cost() {
    for class in SWEPT {
        let (without, with) = swept(class, |_, _| measured(LengthInterval::exact(5000)));
        assert_eq!(without, with);
        // Lengths that are as far apart as the measurements may be wrong.
        let (without, with) =
            swept(class, |edge, _| measured(LengthInterval::measured(5000 + 100 * edge, 100)));
        assert_eq!(without, with);
    }
}

/// Not in every run: what the robot knows changes its choices.
#[test]
fn different_lengths_save_moves() {
    let exact = |edge: u32, _| measured(LengthInterval::exact(1000 * (edge + 1)));
    for (class, savings) in
        SWEPT.into_iter().zip([[68_224, 66_564, 508, 60], [48_266, 47_963, 167, 33]])
    {
        let (without, with) = swept(class, exact);
        let compared = || without.iter().zip(&with);
        let fewer = compared().filter(|(without, with)| with < without).count() as u64;
        let more = compared().filter(|(without, with)| with > without).count() as u64;
        assert_eq!([without.iter().sum(), with.iter().sum(), fewer, more], savings);
    }
}

#[test]
fn lengths_that_are_not_exact_or_not_different_save_moves() {
    // Each measurement is another one, wrong by up to 10 %.
    let within_tenth = |edge: u32, traversals: u64| {
        let share = 90 + (7 * traversals % 21) as u32;
        measured(LengthInterval::measured(1000 * (edge + 1) * share / 100, 100))
    };
    let of_two = |edge: u32, _| measured(LengthInterval::exact(1000 * (edge % 2 + 1)));
    let totals = SWEPT.map(|class| {
        let moves = [swept(class, within_tenth).1, swept(class, of_two).1];
        moves.map(|moves| moves.into_iter().sum::<u64>())
    });
    assert_eq!(totals, [[66_649, 66_687], [48_001, 47_982]]);
}

/// With a short string, and with a movable marker besides, the folding explorer maps. No other explorer uses lengths.
#[test]
fn lengths_save_moves_where_the_folding_explorer_maps_and_none_with_other_explorers() {
    let moves = |algorithm: MappingAlgorithm, graph: &EmbeddedGraph, is_measured: bool| {
        let length = |dart| LengthInterval::exact(1000 * (edge(graph, dart) + 1));
        let world = GraphWorld::with_aid(graph, algorithm.aid(), Dart(0));
        let mut world = SensingWorld::new(world, |world: &GraphWorld<'_, AidKind>| {
            let length = is_measured.then(|| length(world.pose()));
            ArrivalSenses { length, compass: None }
        });
        let (walk, mapped) = algorithm.map_world(&mut world, DEFAULT_DART_BOUND, &mut ());
        mapped.unwrap();
        let map = Cow::Borrowed(walk.map().complete().unwrap());
        let map = ExploredMap { graph: map, facing: FACING, pose: walk.robot() };
        let pose = world.world().pose();
        judge_map(&map, (graph, Dart(0)), pose, &mut Candidate::default()).unwrap();
        walk.moves()
    };
    let graphs: Vec<_> = (1..=6).flat_map(|edges| starts(Class::Simple, edges)).collect();
    for algorithm in MappingAlgorithm::all() {
        let [without, with] = [false, true].map(|is_measured| -> u64 {
            graphs.iter().map(|graph| moves(algorithm, graph, is_measured)).sum()
        });
        let aid = algorithm.aid().name();
        if algorithm.uses_senses() {
            assert!(with < without, "{aid}: {with} {without}");
        } else {
            assert_eq!(with, without, "{aid}");
        }
    }
}

/// Every world with directions up to these sizes.
#[test]
fn a_compass_saves_moves() {
    let totals = [(Class::Multigraph, 4), (Class::Simple, 6)].map(|(class, most)| {
        let (mut worlds, mut without, mut with) = (0, 0, 0);
        for graph in (1..=most).flat_map(|edges| starts(class, edges)) {
            let plain = moves_without_senses(&graph);
            for directions in Directions::every(&graph) {
                let sense = |pose| ArrivalSenses {
                    length: None,
                    compass: Some(directions.view(&graph, pose)),
                };
                worlds += 1;
                without += plain;
                with += moves(&graph, sense).unwrap();
            }
        }
        [worlds, without, with]
    });
    assert_eq!(totals, [[2768, 14_908, 14_652], [55_492, 465_820, 464_532]]);
}

fn any_senses() -> impl Strategy<Value = ArrivalSenses> {
    let length = (0_u32..4000, 0_u32..1200);
    let length = length.prop_map(|(length, error)| LengthInterval::measured(length, error));
    let direction = prop::sample::select(&Direction::ALL[..]);
    let view = prop::collection::vec(direction, 0..5).prop_map(CompassView::new);
    (prop::option::of(length), prop::option::of(view))
        .prop_map(|(length, compass)| ArrivalSenses { length, compass })
}

proptest! {
    /// A map is right even then: a complete trail is the world by its percepts alone. A robot whose senses always
    /// differ may go on until it reaches its limit.
    #[test]
    fn a_robot_whose_senses_are_wrong_makes_no_wrong_map(
        class in prop::sample::select(&SWEPT[..]),
        start in any::<prop::sample::Index>(),
        sensed in prop::collection::vec(any_senses(), 1..40),
    ) {
        let (class, most) = class;
        let graphs = starts(class, most);
        let mut sensed = sensed.into_iter().cycle();
        match moves(start.get(&graphs), |_| sensed.next().unwrap()) {
            Ok(_)
            | Err(
                MappingError::Contradiction(_)
                | MappingError::World(RefusedAction::OutOfMoves { .. }),
            ) => {}
            Err(other) => prop_assert!(false, "{}", other),
        }
    }
}

/// A robot with a compass that shows something only now and then also compares what it has seen of two places that turn out to
/// be one.
#[test]
fn every_start_is_mapped_with_a_compass_that_works_now_and_then() {
    for graph in (1..=4).flat_map(|edges| starts(Class::Multigraph, edges)) {
        for directions in Directions::every(&graph) {
            for cycle in [2, 3, 5] {
                let mut arrivals = 0;
                let sense = |pose| {
                    arrivals += 1;
                    let works = arrivals % cycle == 0;
                    let compass = works.then(|| directions.view(&graph, pose));
                    ArrivalSenses { length: None, compass }
                };
                moves(&graph, sense).unwrap();
            }
        }
    }
}

/// The robot goes to one end of a chain, and back over the same edge.
#[test]
fn an_edge_with_two_lengths_is_a_contradiction() {
    let chain =
        [("middle", vec!["one", "other"]), ("one", vec!["middle"]), ("other", vec!["middle"])];
    let chain = EmbeddedGraph::from_neighbour_lists(&chain).unwrap();
    let with = |lengths: [u32; 3]| {
        // At the start, no edge was traversed.
        let mut lengths = [7000].into_iter().chain(lengths).map(LengthInterval::exact);
        moves(&chain, |_| measured(lengths.next().unwrap()))
    };
    assert_eq!(with([3000, 3000, 4000]), Ok(3));
    let text = "the world contradicts itself: an edge at the junctions after 0 and 2 moves is the same one, \
                with a length of 3.000 m and of 4.000 m";
    assert_eq!(with([3000, 4000, 4000]).unwrap_err().to_string(), text);
}

#[test]
fn a_vertex_whose_doors_lead_elsewhere_is_a_contradiction() {
    use Direction::{East, North, South, West};
    let cycle = EmbeddedGraph::cycle(4);
    let with = |views: [[Direction; 2]; 5]| {
        let mut views = views.into_iter().map(CompassView::new);
        moves(&cycle, |_| ArrivalSenses { length: None, compass: views.next() })
    };
    let round = [[North, East], [South, East], [West, South], [North, West]];
    let [a, b, c, d] = round;
    assert_eq!(with([a, b, c, d, [East, North]]), Ok(4));
    let text = "the world contradicts itself: the junctions after 0 and 4 moves are the same one, with doors to the east \
                and the north and with doors to the west and the north";
    assert_eq!(with([a, b, c, d, [West, North]]).unwrap_err().to_string(), text);
}
