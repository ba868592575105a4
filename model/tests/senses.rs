//! Other senses than a marker: what binoculars, a compass and lengths identify, and what not.

use toposlam_model::{
    aid::{
        Aid, AidKind,
        compass::{Compass, Directions, DirectionsError},
        named,
    },
    ambiguity::{AmbiguitySearch, Comparison, Findings},
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::Class,
    floor_plan::Direction,
    marker::{Marker, MarkerPart},
    percept::Sighting,
    world::GraphWorld,
};

use crate::starts;

/// The binoculars that reach one edge far, two, and three.
fn binoculars() -> [(AidKind, usize); 3] {
    [1, 2, 3].map(|radius| (named(&format!("binoculars-{radius}")).unwrap(), radius))
}

fn search(class: Class, edges: usize, aid: AidKind) -> Findings {
    AmbiguitySearch::new(class, edges, aid).unwrap().run(&()).unwrap()
}

/// Whether a verified bisimulation shows that a robot cannot distinguish two worlds.
fn are_alike(aid: AidKind, one: &EmbeddedGraph, other: &EmbeddedGraph) -> bool {
    let comparison = Comparison::new(aid, (one, Dart(0)), (other, Dart(0)));
    comparison.start_like(Dart(0)).is_some_and(|start| {
        let poses = [Dart(0), start];
        let [here, there] = comparison.starts(poses);
        let found = comparison.bisimulation(poses, usize::MAX, &()).unwrap().unwrap();
        found.verify(&here, &there)
    })
}

/// A grid on the torus. The doors of each vertex are north, east, south and west.
fn torus(width: usize, height: usize) -> EmbeddedGraph {
    let mut lists = Vec::new();
    for x in 0..width {
        for y in 0..height {
            let (west, south) = ((x + width - 1) % width, (y + height - 1) % height);
            let doors = [
                format!("to-north-{x}-{y}"),
                format!("to-east-{x}-{y}"),
                format!("to-north-{x}-{south}"),
                format!("to-east-{west}-{y}"),
            ];
            lists.push((format!("at-{x}-{y}"), doors.to_vec()));
        }
    }
    EmbeddedGraph::from_edge_lists(&lists).unwrap()
}

#[test]
fn a_robot_with_binoculars_sees_the_ball_around_it() {
    let seen = |graph: &EmbeddedGraph, (aid, _): (AidKind, usize)| {
        let comparison = Comparison::new(aid, (graph, Dart(0)), (graph, Dart(0)));
        comparison.starts([Dart(0); 2])[0].sensed().to_string()
    };
    let [near, far, farther] = binoculars();
    let ring = EmbeddedGraph::cycle(5);
    assert_eq!(seen(&ring, near), "2 doors, sees 3 junctions: 1 2, 0 -, 0 -");
    let whole = "2 doors, sees 5 junctions: 1 2, 0 3, 0 4, 1 4, 2 3";
    assert_eq!([far, farther].map(|aid| seen(&ring, aid)), [whole; 2]);
}

/// The smallest pairs up to these sizes, by exhaustive search: rings of 2r + 2 and 2r + 3 edges.
#[test]
fn the_smallest_worlds_that_binoculars_do_not_distinguish_are_rings() {
    let [near, far, _] = binoculars();
    let searched = [
        (Class::Multigraph, 5, near),
        (Class::Simple, 7, near),
        (Class::Simple, 7, far),
        (Class::Planar, 7, near),
        (Class::Planar, 7, far),
        (Class::Corridor, 8, near),
        (Class::Corridor, 8, far),
    ];
    for (class, edges, (aid, radius)) in searched {
        are_smallest_rings(&search(class, edges, aid), radius);
    }
}

#[test]
#[ignore = "a long sweep, for `.ci/run --all`"]
fn the_smallest_larger_worlds_that_binoculars_do_not_distinguish_are_rings() {
    let [near, far, farther] = binoculars();
    for (aid, radius) in [near, far] {
        are_smallest_rings(&search(Class::Multigraph, 7, aid), radius);
    }
    for class in [Class::Simple, Class::Planar, Class::Corridor] {
        are_smallest_rings(&search(class, 9, farther.0), farther.1);
    }
    // Of all worlds with up to 7 edges, none looks like another one.
    assert!(search(Class::Multigraph, 7, farther.0).smallest().is_none());
}

fn are_smallest_rings(findings: &Findings, radius: usize) {
    let pair = findings.smallest().unwrap().map(|world| &world.graph);
    assert_eq!(pair.map(EmbeddedGraph::edge_count), [2 * radius + 2, 2 * radius + 3]);
    assert!(pair.iter().all(|graph| graph.vertices().all(|vertex| graph.degree(vertex) == 2)));
}

/// A ball around a vertex of a ring of 2r + 2 or more is a path. It is the whole of a smaller ring.
#[test]
fn binoculars_distinguish_the_rings_that_fit_into_them() {
    for (aid, radius) in binoculars() {
        let rings: Vec<_> = (3..=2 * radius + 6).map(EmbeddedGraph::cycle).collect();
        for one in &rings {
            for other in rings.iter().filter(|other| other.edge_count() > one.edge_count()) {
                let fits = one.edge_count() < 2 * radius + 2;
                assert_eq!(are_alike(aid, one, other), !fits, "{aid:?}");
            }
        }
    }
}

/// A ball in a grid on a torus of 2r + 2 vertices or more each way is that in the endless grid.
#[test]
fn binoculars_do_not_distinguish_large_grids_on_a_torus() {
    let [near, far, farther] = binoculars();
    // Such a ball of radius 3 takes more than 128 bits.
    assert!(!farther.0.is_seen_everywhere(&torus(8, 8)));
    for (aid, radius) in [near, far] {
        let least = 2 * radius + 2;
        let sizes = [(least, least), (least, least + 1), (least + 2, least)];
        let [one, others @ ..] = sizes.map(|(width, height)| torus(width, height));
        assert!(others.iter().all(|other| are_alike(aid, &one, other)));
        // In a smaller one, a row that closes is seen.
        assert!(!are_alike(aid, &one, &torus(least - 1, least)));
    }
}

/// The numbers of edges of the faces.
fn faces(graph: &EmbeddedGraph) -> Vec<usize> {
    let mut seen = vec![false; graph.dart_count()];
    let mut faces = Vec::new();
    for first in graph.darts() {
        let next = |dart: &Dart| Some(graph.clockwise(graph.opposite(*dart)));
        let face = std::iter::successors(Some(first), next);
        let face = face.take_while(|dart| !std::mem::replace(&mut seen[dart.at()], true)).count();
        faces.extend((face > 0).then_some(face));
    }
    assert_eq!(faces.len(), graph.face_count());
    faces
}

/// Whether a world is planar, and all faces but one have at most 2r + 1 edges.
fn is_filled(graph: &EmbeddedGraph, radius: usize) -> bool {
    let large = faces(graph).into_iter().filter(|&edges| edges > 2 * radius + 1).count();
    graph.genus() == 0 && large <= 1
}

/// Such a world is distinguished from all worlds, of any genus.
#[test]
fn binoculars_identify_planar_worlds_all_of_whose_faces_but_one_are_small() {
    let [near, far, _] = binoculars();
    for (class, edges, (aid, radius)) in
        [(Class::Multigraph, 5, near), (Class::Simple, 8, near), (Class::Simple, 7, far)]
    {
        let findings = search(class, edges, aid);
        let ambiguous: Vec<_> = findings.groups.iter().flat_map(|group| &group.worlds).collect();
        assert!(!ambiguous.is_empty());
        assert!(!ambiguous.iter().any(|world| is_filled(&world.graph, radius)));
        // The smallest pair just does not fulfil the condition.
        let [ring, _] = findings.smallest().unwrap();
        assert_eq!(faces(&ring.graph), [2 * radius + 2; 2]);
    }
    let filled = starts(Class::Simple, 6).iter().filter(|graph| is_filled(graph, 1)).count();
    assert!(filled > 100, "{filled}");
}

/// A ball that takes too much memory is not recorded, and nothing is claimed about its world.
#[test]
fn a_ball_that_is_too_large_proves_nothing() {
    let spokes: Vec<_> = (0..130).map(|spoke| format!("spoke-{spoke}")).collect();
    let mut lists = vec![("hub".to_owned(), spokes.clone())];
    lists.extend(spokes.into_iter().map(|spoke| (format!("end-of-{spoke}"), vec![spoke])));
    let star = EmbeddedGraph::from_edge_lists(&lists).unwrap();
    for (aid, _) in binoculars() {
        assert!(!aid.is_seen_everywhere(&star));
        assert!(!are_alike(aid, &star, &star));
        let comparison = Comparison::new(aid, (&star, Dart(0)), (&star, Dart(0)));
        let Sighting::Ball(ball) = comparison.starts([Dart(0); 2])[0].sensed().sighting else {
            panic!("no ball");
        };
        assert_eq!((ball.behind(), ball.to_string().as_str()), (None, "sees too much"));
    }
}

/// A grid on a torus with the directions of its corridors.
fn with_directions(graph: &EmbeddedGraph) -> Directions {
    let directions = graph.darts().map(|dart| Direction::ALL[graph.index(dart) as usize]);
    Directions::new(graph, directions.collect()).unwrap()
}

/// Whether a verified relation shows that two worlds look alike with marks of their own.
fn look_alike(
    [(one, mark), (other, other_mark)]: [(&EmbeddedGraph, &dyn Marker); 2],
    poses: [Dart; 2],
) -> bool {
    let worlds = [
        GraphWorld::with_aid(one, mark.into(), Dart(0)),
        GraphWorld::with_aid(other, other_mark.into(), Dart(0)),
    ];
    let comparison = Comparison::between(worlds);
    let [here, there] = comparison.starts(poses);
    comparison.relation(poses).is_some_and(|relation| relation.verify(&here, &there))
}

/// In a grid on a torus of any size, each vertex has a door each way.
#[test]
fn a_compass_does_not_distinguish_grids_on_a_torus() {
    let sizes = [(1, 1), (1, 2), (2, 1), (3, 3), (3, 5), (6, 7)];
    let grids: Vec<_> = sizes.iter().map(|&(width, height)| torus(width, height)).collect();
    for (one, other) in grids.iter().zip(grids.iter().skip(1)) {
        let directions = [one, other].map(with_directions);
        let [here, there] = directions.each_ref().map(Compass);
        assert!(!directions[0].is_drawn_in_plane(one));
        assert!(look_alike([(one, &here), (other, &there)], [Dart(0); 2]));
        // The robots must look the same way.
        assert!(!look_alike([(one, &here), (other, &there)], [Dart(0), Dart(1)]));
    }
}

#[test]
fn directions_that_no_straight_corridors_have_are_refused() {
    use Direction::{East, North, South, West};
    let refused = |graph: &EmbeddedGraph, directions: &[Direction]| {
        Directions::new(graph, directions.to_vec()).unwrap_err()
    };
    let edge = EmbeddedGraph::chain(1);
    let wrong = DirectionsError::Number { directions: 1, darts: 2 };
    assert_eq!(refused(&edge, &[North]), wrong);
    assert_eq!(refused(&edge, &[North, East]), DirectionsError::Bend(Dart(0)));
    assert!(Directions::new(&edge, vec![North, South]).is_ok());
    let grid = torus(1, 1);
    assert_eq!(refused(&grid, &[North, West, South, East]), DirectionsError::Order(Dart(0)));
    assert_eq!(Directions::every(&grid).len(), 4);
    // A square, drawn in each of two ways round, and its rings on a cylinder.
    let square = EmbeddedGraph::cycle(4);
    let drawn = Directions::every(&square);
    let in_plane = drawn.iter().filter(|way| way.is_drawn_in_plane(&square)).count();
    assert_eq!(in_plane, 8);
}

/// The double cover of a world: two copies, in which one edge of a cycle leads from each copy to the other; and the dart
/// below each of its darts. `None` if the edge is in no cycle.
fn double_cover(graph: &EmbeddedGraph, edge: Dart) -> Option<(EmbeddedGraph, Vec<Dart>)> {
    let darts = graph.dart_count() as u32;
    let copy = |dart: Dart, copy: u32| dart.0 + copy * darts;
    let crosses = |dart: Dart| u32::from(dart == edge || graph.opposite(dart) == edge);
    let (mut opposite, mut clockwise, mut below) = (Vec::new(), Vec::new(), Vec::new());
    for number in 0..2 {
        for dart in graph.darts() {
            opposite.push(copy(graph.opposite(dart), number ^ crosses(dart)));
            clockwise.push(copy(graph.clockwise(dart), number));
            below.push(dart);
        }
    }
    let (cover, number) = EmbeddedGraph::from_permutations(&opposite, &clockwise).ok()?;
    let mut to_graph = vec![Dart(0); below.len()];
    for (dart, new) in below.into_iter().zip(number) {
        to_graph[new.at()] = dart;
    }
    Some((cover, to_graph))
}

/// A number on each edge that a robot reads when it has traversed it: its length.
struct Lengths(Vec<u32>);

impl Marker for Lengths {
    fn name(&self) -> &'static str {
        "lengths"
    }

    fn about(&self) -> &'static str {
        "the length of the corridor just traversed"
    }

    fn sighting(&self, _graph: &EmbeddedGraph, _facing: Dart, pose: Dart) -> Sighting {
        Sighting::Lying(self.0[pose.at()])
    }

    fn first_alike(&self, _graph: &EmbeddedGraph, _facing: Dart) -> Dart {
        Dart(0)
    }

    fn starts(&self, graph: &EmbeddedGraph, _facing: Dart) -> Vec<Dart> {
        graph.darts().collect()
    }

    fn parts(&self, _graph: &EmbeddedGraph, _facing: Dart) -> Vec<MarkerPart> {
        Vec::new()
    }
}

/// Even if all lengths are different: the lengths of the double cover are those of the world below.
#[test]
fn lengths_identify_no_world_with_a_cycle() {
    let mut covered = 0;
    for edges in 1..=4 {
        for graph in starts(Class::Multigraph, edges) {
            let lengths = |dart: Dart| dart.0.min(graph.opposite(dart).0) + 1;
            let below = Lengths(graph.darts().map(lengths).collect());
            for edge in graph.darts() {
                let Some((cover, to_graph)) = double_cover(&graph, edge) else { continue };
                let above = Lengths(to_graph.iter().map(|&dart| below.0[dart.at()]).collect());
                let pose = cover.darts().find(|dart| to_graph[dart.at()] == Dart(0)).unwrap();
                assert!(look_alike([(&graph, &below), (&cover, &above)], [Dart(0), pose]));
                covered += 1;
            }
        }
    }
    assert!(covered > 1000, "{covered}");
}
