//! Marking aids that move: what a robot can do with each, what it then sees, and in which worlds each suffices.

use std::collections::BTreeMap;

use toposlam_model::{
    aid::{AIDS, Action, Aid, AidAction, AidKind, RefusedAction, State, named, string::LaidString},
    ambiguity::{AmbiguitySearch, Comparison, shortest_certificate},
    embedded_graph::{Dart, EmbeddedGraph, Vertex},
    enumerate::Class,
    mapping::{MapWalk, MappingAlgorithm, MappingEvent, Observer},
    marker::{Directional, Marker},
    percept::{Door, OtherRobot, Percept, Sighting, TeamView},
    world::GraphWorld,
};

use crate::{markers::junction, starts, text_of};

type AidWorld<'g> = GraphWorld<'g, AidKind>;

fn begin<'g>(aid: &str, graph: &'g EmbeddedGraph, facing: u32) -> AidWorld<'g> {
    GraphWorld::with_aid(graph, named(aid).unwrap(), Dart(facing))
}

/// Does some actions, as on the command line, and returns what the robot perceives of the aid after each, in words.
fn done(world: &mut AidWorld<'_>, actions: &str) -> Vec<String> {
    let done = actions.split(' ').map(|action| {
        let action: Action = action.parse().unwrap();
        assert!(world.actions().contains(&action), "{action}");
        world.act(action).unwrap();
        world.sensed().sighting.to_string()
    });
    done.collect()
}

fn refused(world: &mut AidWorld<'_>, action: &str) -> RefusedAction {
    let action: Action = action.parse().unwrap();
    assert!(!world.actions().contains(&action), "{action}");
    let before = (world.state(), world.moves());
    let refused = world.act(action).unwrap_err();
    assert_eq!((world.state(), world.moves()), before);
    refused
}

#[test]
fn a_movable_marker_is_picked_up_where_it_lies_and_dropped_where_the_robot_is() {
    let graph = junction();
    let mut world = begin("movable", &graph, 2);
    assert_eq!(refused(&mut world, "drop"), RefusedAction::NothingToDrop);
    assert_eq!(done(&mut world, "pick-up"), ["no marker"]);
    assert_eq!(world.held(), 1);
    assert_eq!(refused(&mut world, "pick-up"), RefusedAction::NothingToPickUp);
    assert_eq!(done(&mut world, "0 drop 0 0"), ["no marker", "marker", "no marker", "marker"]);
    let action = AidAction::PickUpMarker(1);
    assert_eq!(refused(&mut world, "pick-up-1"), RefusedAction::NotOfThisAid { action });
    assert_eq!(world.moves(), 3);
}

#[test]
fn of_markers_that_look_alike_a_robot_sees_how_many_lie_here_and_of_others_which() {
    let ring = EmbeddedGraph::cycle(3);
    let mut world = begin("movable-3", &ring, 0);
    assert_eq!(
        done(&mut world, "pick-up pick-up 1 drop 1 drop 1 1 1"),
        [
            "2 markers",
            "marker",
            "no marker",
            "marker",
            "no marker",
            "marker",
            "marker",
            "marker",
            "marker"
        ]
    );
    let mut world = begin("movable-3-distinct", &ring, 0);
    assert_eq!(world.sensed().sighting.to_string(), "first, second and third marker");
    assert_eq!(
        done(&mut world, "pick-up-2 1 drop-2 0"),
        ["first and third marker", "no marker", "second marker", "first and third marker"]
    );
    assert_eq!(refused(&mut world, "drop-2"), RefusedAction::NothingToDrop);
    assert_eq!(refused(&mut world, "pick-up-2"), RefusedAction::NothingToPickUp);
}

#[test]
fn a_directional_marker_that_is_dropped_points_along_the_door_behind_the_robot() {
    let graph = junction();
    let mut world = begin("movable-directional", &graph, 2);
    let along = |door: u32| format!("marker along door {door}");
    // To the bend, where it points back; on to the dead end and back to it.
    assert_eq!(
        done(&mut world, "pick-up 0 drop 1 0"),
        ["no marker", "no marker", &along(0), "no marker", &along(1)]
    );
    assert_eq!(refused(&mut world, "drop"), RefusedAction::NothingToDrop);
}

/// The directional marker stays, and it is seen beside the other one.
#[test]
fn of_two_markers_a_robot_carries_one_and_leaves_the_other() {
    let graph = junction();
    let aid = MappingAlgorithm::DirectionalAndMovable.aid();
    let mut world = GraphWorld::with_aid(&graph, aid, Dart(2));
    let both = "directional marker along door 0, movable marker";
    assert_eq!(world.sensed().sighting.to_string(), both);
    assert_eq!(refused(&mut world, "drop"), RefusedAction::NothingToDrop);
    assert_eq!(
        done(&mut world, "pick-up 0 drop 1 0 pick-up 0"),
        [
            "directional marker along door 0",
            "no marker",
            "movable marker",
            "no marker",
            "movable marker",
            "no marker",
            "no marker",
        ]
    );
    // At the start, from the bend and round the loop.
    assert_eq!(
        done(&mut world, "0 1 drop 1 2"),
        [
            "no marker",
            "directional marker along door 0",
            both,
            "directional marker along door 2, movable marker",
            "no marker",
        ]
    );
    for sighting in ["movable marker", "directional marker along door 1", both] {
        assert!(aid.shows(sighting.parse().unwrap()));
    }
    for sighting in ["marker", "marker along door 1"] {
        assert!(!aid.shows(sighting.parse().unwrap()));
    }
}

/// Without moving the marker, the robot sees what a directional marker shows.
#[test]
fn beside_a_movable_marker_the_directional_one_shows_the_same() {
    let aid = MappingAlgorithm::DirectionalAndMovable.aid();
    for graph in (1..=3).flat_map(|edges| starts(Class::Multigraph, edges)) {
        let world = GraphWorld::with_aid(&graph, aid, Dart(0));
        for pose in graph.darts() {
            let there = world.clone().at(State { pose, ..world.state() });
            let along = match there.sensed().sighting {
                Sighting::TwoMarkers(view) => view.along,
                _ => None,
            };
            let shown = along.map_or(Sighting::Nothing, Sighting::Pointing);
            assert_eq!(shown, Marker::sighting(&Directional, &graph, Dart(0), pose));
        }
    }
}

/// The robot knows where it has left its marker.
#[test]
fn a_movable_marker_that_was_moved_by_somebody_else_is_a_contradiction() {
    let algorithm = MappingAlgorithm::DirectionalAndMovable;
    let ring = EmbeddedGraph::cycle(9);
    let mut world = GraphWorld::with_aid(&ring, algorithm.aid(), Dart(0));
    // The marker is taken away from the start before the run.
    world.act("pick-up".parse().unwrap()).unwrap();
    let ended = algorithm.map_world(&mut world, 50, &mut ()).1.unwrap_err().to_string();
    assert_eq!(
        ended,
        "the world contradicts itself: at the known vertex v0, entered by its dart 0: expected degree 2 with the \
         directional marker along door 0, movable marker, found degree 2 with the directional marker along door 0"
    );
}

/// Round a ring of three edges.
#[test]
fn a_string_is_paid_out_along_edges_and_wound_in_on_the_way_back() {
    let ring = EmbeddedGraph::cycle(3);
    let mut world = begin("string-2", &ring, 0);
    assert_eq!(world.sensed().sighting.to_string(), "fixed end");
    assert_eq!(
        done(&mut world, "1 1"),
        [
            "string through door 0, from the hand through door 0",
            "string through door 0, from the hand through door 0",
        ]
    );
    // It is laid out, and only the way back is left.
    assert_eq!(refused(&mut world, "1"), RefusedAction::StringTooShort);
    assert_eq!(
        done(&mut world, "drop 1 1 1"),
        [
            "string through door 0, free end",
            // At the start, from the other side: it leaves by the other door.
            "string through door 1, fixed end",
            "string through doors 0 and 1",
            "string through door 0, free end",
        ]
    );
    assert_eq!(
        done(&mut world, "pick-up 0 1"),
        [
            "string through door 0, from the hand through door 0",
            "string through door 1, from the hand through door 1",
            "fixed end",
        ]
    );
    let action = AidAction::Send { robot: 2, door: Door(0) };
    assert_eq!(refused(&mut world, "send-2:0"), RefusedAction::NotOfThisAid { action });
}

/// A string that lies over a loop runs through two doors of its vertex.
#[test]
fn a_string_over_a_loop_is_seen_at_both_of_its_ends() {
    let graph = junction();
    let mut world = begin("string-1", &graph, 1);
    assert_eq!(
        done(&mut world, "2 drop 0"),
        [
            "string through doors 0 and 3, from the hand through door 0, fixed end",
            "string through doors 0 and 3, fixed end, free end",
            // It came in by the other end of the loop.
            "string through doors 0 and 1, fixed end, free end",
        ]
    );
}

#[test]
fn a_string_cannot_be_seen_at_a_vertex_with_too_many_doors() {
    let spokes: Vec<String> = (0..33).map(|spoke| format!("e{spoke}")).collect();
    let mut lists = vec![("hub".to_owned(), spokes.clone())];
    lists.extend(spokes.into_iter().map(|spoke| (format!("rim-{spoke}"), vec![spoke])));
    let star = EmbeddedGraph::from_edge_lists(&lists).unwrap();
    let mut world = begin("string-1", &star, 0);
    assert_eq!(refused(&mut world, "0"), RefusedAction::TooManyDoors { most: 32 });
    // So nothing is claimed about such a world.
    let comparison = Comparison::new(*world.aid(), (&star, Dart(0)), (&star, Dart(0)));
    let [one, other] = comparison.starts([Dart(0); 2]);
    for most in [0, usize::MAX] {
        let found = comparison.bisimulation([Dart(0); 2], most, &()).unwrap().unwrap();
        assert!(!found.verify(&one, &other));
    }
    // Without the string it goes there.
    assert_eq!(done(&mut world, "drop 0 0").last().unwrap(), "fixed end, free end");
}

#[test]
fn robots_of_a_team_see_each_other_at_a_vertex_and_learn_by_radio_where_others_are() {
    let graph = junction();
    let mut world = begin("team-2", &graph, 2);
    assert_eq!(world.sensed().sighting.to_string(), "robot 2 here along door 0");
    // Through the other end of the loop: doors are counted clockwise.
    assert_eq!(done(&mut world.clone(), "send-2:2"), ["robot 2 here along door 1"]);
    assert_eq!(
        done(&mut world, "send-2:1 send-2:1 1 1"),
        [
            // Through one end of the loop: it comes in by the other one.
            "robot 2 here along door 2",
            "robot 2 elsewhere at 1 door",
            "robot 2 elsewhere at 1 door",
            "robot 2 here along door 0",
        ]
    );
    assert_eq!(world.moves(), 4);
    let door = Door(4);
    assert_eq!(refused(&mut world, "send-2:4"), RefusedAction::NoSuchDoor { door, degree: 1 });
    let mut round = begin("team-3-round", &graph, 2);
    assert_eq!(
        done(&mut round, "send-3:0 send-2:0 0"),
        [
            "robot 2 here, robot 3 elsewhere at 2 doors",
            "robot 2 elsewhere at 2 doors, robot 3 with robot 2",
            "robot 2 here, robot 3 here",
        ]
    );
    let nobody = TeamView([OtherRobot::Here; 2]);
    assert_eq!(round.sensed(), Percept { degree: 2, sighting: Sighting::Team(nobody) });
}

/// Each aid that has a front suffices, because it need not move: what it shows where it is at first determines what a
/// directional marker shows there. The string is first laid over the edge behind the robot; over a loop, the robot takes
/// its end again to see which is which.
#[test]
fn what_an_aid_with_a_front_shows_determines_what_a_directional_marker_does() {
    for aid in ["movable-directional", "team-2", "team-3", "string-1", "string-3"] {
        let mut known: BTreeMap<Percept, Sighting> = BTreeMap::new();
        for edges in 1..=4 {
            for graph in starts(Class::Multigraph, edges) {
                let mut world = begin(aid, &graph, 0);
                let is_loop = graph.vertex(graph.opposite(Dart(0))) == graph.vertex(Dart(0));
                if aid.starts_with("string") {
                    if is_loop {
                        continue;
                    }
                    done(&mut world, "0 drop");
                }
                for pose in graph.darts() {
                    let there = world.clone().at(State { pose, ..world.state() });
                    let directional = Marker::sighting(&Directional, &graph, Dart(0), pose);
                    let shown = *known.entry(there.sensed()).or_insert(directional);
                    assert_eq!(shown, directional, "{aid}: {}", there.sensed());
                }
            }
        }
    }
}

/// In a bouquet there is one vertex: what a marker or a robot without a front shows is the same everywhere.
#[test]
fn markers_and_robots_without_a_front_do_not_tell_two_bouquets_apart_however_many_they_are() {
    let bouquets = [["a", "a", "b", "b"], ["a", "b", "a", "b"]]
        .map(|edges| EmbeddedGraph::from_edge_lists(&[("v", edges.to_vec())]).unwrap());
    let [one, other] = &bouquets;
    let mut told_apart = Vec::new();
    for aid in AIDS.into_iter().filter(Aid::moves) {
        let comparison = Comparison::new(aid, (one, Dart(0)), (other, Dart(0)));
        let starts = aid.starts(other, Dart(0));
        if starts.iter().all(|&start| comparison.walk([Dart(0), start]).is_some()) {
            told_apart.push(aid.name());
        }
    }
    let with_a_front = [
        "movable-directional",
        "movable+directional",
        "string-1",
        "string-2",
        "string-3",
        "team-2",
        "team-3",
    ];
    assert_eq!(told_apart, with_a_front);
}

/// The sizes of the smallest pair of each aid that moves, by exhaustive search.
#[test]
fn the_smallest_pairs_of_aids_that_move() {
    let smallest = |class, edges, aid| {
        let findings = AmbiguitySearch::new(class, edges, aid).unwrap().run(&()).unwrap();
        findings.smallest().map(|pair| pair.map(|world| world.graph.edge_count()))
    };
    for aid in AIDS.into_iter().filter(Aid::moves) {
        let has_front = ["directional", "string", "team-2", "team-3"]
            .iter()
            .any(|front| aid.name().contains(front) && !aid.name().ends_with("round"));
        let pair = if has_front { None } else { Some([2, 2]) };
        assert_eq!(smallest(Class::Multigraph, 3, aid), pair, "{}", aid.name());
        assert_eq!(smallest(Class::Simple, 5, aid), None, "{}", aid.name());
    }
}

#[test]
fn what_a_robot_sees_is_of_its_aid_and_is_read_as_it_is_written() {
    for aid in AIDS {
        for graph in [EmbeddedGraph::cycle(3), junction(), dipole()] {
            let mut worlds = vec![GraphWorld::with_aid(&graph, aid, Dart(0))];
            for _ in 0..3 {
                for world in &worlds {
                    let seen = world.sensed().sighting;
                    assert!(aid.shows(seen), "{}: {seen}", aid.name());
                    assert!(!aid.marks() || seen.to_string().parse() == Ok(seen), "{seen}");
                }
                worlds = worlds.iter().flat_map(after_each_action).collect();
            }
        }
    }
    for (aid, sighting) in [
        ("directional", "marker"),
        ("undirected", "marker along door 0"),
        ("movable-2", "first marker"),
        ("movable-2-distinct", "2 markers"),
        ("undirected-edge", "past the mark, along its arrow"),
        ("string-1", "robot 2 here"),
        ("team-2", "fixed end"),
        ("undirected", "2 markers"),
        ("movable", "2 markers"),
        ("two-distinct", "third marker"),
        ("movable-3-distinct", "fourth marker"),
        ("team-3", "robot 2 here along door 0"),
        ("team-2", "robot 2 elsewhere at 2 doors, robot 3 elsewhere at 2 doors"),
        ("team-2", "robot 2 here"),
        ("team-2-round", "robot 2 here along door 0"),
    ] {
        assert!(!named(aid).unwrap().shows(sighting.parse().unwrap()), "{aid}: {sighting}");
    }
}

fn after_each_action<'g>(world: &AidWorld<'g>) -> Vec<AidWorld<'g>> {
    let acted = |action| {
        let mut world = world.clone();
        world.act(action).map(|()| world).unwrap()
    };
    world.actions().into_iter().map(acted).collect()
}

/// Two edges between two vertices.
fn dipole() -> EmbeddedGraph {
    EmbeddedGraph::from_edge_lists(&[("a", vec!["e", "f"]), ("b", vec!["e", "f"])]).unwrap()
}

/// With a string as long as it takes, a directional marker adds nothing: at the start vertex the robot has come back along the
/// string, or sees the fixed end and the one dart along which the string runs.
#[test]
fn with_a_string_a_directional_marker_adds_nothing() {
    struct AtStart {
        start: Vertex,
        others: u32,
    }
    impl Observer<AidWorld<'_>> for AtStart {
        fn event(&mut self, world: &mut AidWorld<'_>, _: &MapWalk, event: MappingEvent) {
            let is_here = world.graph().vertex(world.pose()) == self.start;
            if !is_here || !matches!(event, MappingEvent::Moved { .. }) {
                return;
            }
            let Sighting::String(view) = world.sensed().sighting else { panic!("no string") };
            assert!(view.fixed_end);
            let laid: Vec<_> = view.doors.doors().filter(|door| Some(*door) != view.hand).collect();
            assert!(laid.len() <= 1, "{view}");
            // Otherwise it has wound the string in, all of it, and so knows where it is.
            let has_wound_in = view.hand.is_none() && laid.is_empty();
            self.others += u32::from(!has_wound_in);
        }
    }
    let string = MappingAlgorithm::String(LaidString::of_any_length());
    let mut others = 0;
    for graph in (1..=4).flat_map(|edges| starts(Class::Multigraph, edges)) {
        let mut world = GraphWorld::with_aid(&graph, string.aid(), Dart(0));
        let mut observer = AtStart { start: graph.vertex(Dart(0)), others: 0 };
        string.map_world(&mut world, 20, &mut observer).1.unwrap();
        others += observer.others;
    }
    assert!(others > 100, "{others}");
}

/// The table of the page on marking aids, up to 4 edges.
#[test]
fn the_certificates_and_the_moves_of_simple_worlds_are_those_that_are_published() {
    let page = text_of("docs/aids.md");
    let (_, table) = page.split_once("## Certificates with each aid").unwrap();
    for algorithm in MappingAlgorithm::all() {
        let aid = algorithm.aid();
        let name = match algorithm {
            MappingAlgorithm::Algorithm1 => "Algorithm 1".to_owned(),
            MappingAlgorithm::Folding => "folding".to_owned(),
            _ => format!("`{}`", aid.name()),
        };
        let is_its =
            |line: &&str| line.split(" | ").next().is_some_and(|cell| cell.contains(&name));
        let row = table.lines().filter(|line| line.starts_with("| ")).find(is_its).unwrap();
        let cells: Vec<_> = row.split(" | ").skip(1).map(str::to_owned).collect();
        let sums = [3, 4].map(|edges| {
            let (mut least, mut explored) = (0, 0);
            for graph in starts(Class::Simple, edges) {
                let found = shortest_certificate(aid, (&graph, Dart(0)), 200_000).unwrap();
                least += found.into_iter().map(Action::moves).sum::<u64>();
                let mut world = GraphWorld::with_aid(&graph, aid, Dart(0));
                let (run, map) = algorithm.map_world(&mut world, 20, &mut ());
                map.unwrap();
                explored += run.moves();
            }
            format!("{least} / {explored}")
        });
        assert_eq!(cells[..2], sums, "{name}");
    }
}
