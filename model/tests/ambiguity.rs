//! Worlds that a marker does not distinguish: the witnesses, and the search.

use std::sync::atomic::{AtomicBool, Ordering};

use toposlam_model::{
    aid::{AIDS, Action, Aid, AidAction, AidKind, Places, State, named},
    ambiguity::{
        AmbiguitySearch, Comparison, Findings, KeptPairs, PlacedRobot, PlacedWorld, Relation,
        Unfinished, Walk, has_more_states, replay,
    },
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::{Class, Each, Enumeration, Watch},
    isomorphism::{Bijection, code},
    percept::{Door, Percept},
    world::World,
};

use crate::starts;

fn search(class: Class, edges: usize, marker: &str) -> Findings {
    AmbiguitySearch::new(class, edges, named(marker).unwrap()).unwrap().run(&()).unwrap()
}

/// For each number of edges: placed worlds, and those that are ambiguous.
fn counts(findings: &Findings) -> (Vec<u64>, Vec<u64>) {
    let sizes = findings.sizes.iter();
    sizes.map(|size| (size.placed_worlds, size.ambiguous)).unzip()
}

/// The sizes of the smallest pair.
fn smallest(findings: &Findings) -> Option<[usize; 2]> {
    findings.smallest().map(|pair| pair.map(|world| world.graph.edge_count()))
}

/// As processes on several machines search: each looks at some parts, and groups the worlds of some quotients.
#[test]
fn the_groups_of_some_quotients_and_those_of_the_others_are_all() {
    for (class, marker) in
        [(Class::Multigraph, "undirected"), (Class::Corridor, "none"), (Class::Simple, "movable")]
    {
        let search = AmbiguitySearch::new(class, 4, named(marker).unwrap()).unwrap();
        let whole = search.run(&()).unwrap();
        for kept in [KeptPairs::All, KeptPairs::Smallest] {
            let mut all = search.grouped(Vec::new(), kept, &()).unwrap();
            let mut machines = [Vec::new(), Vec::new(), Vec::new()];
            for part in search.parts().iter().rev() {
                let (placed_worlds, candidates) = search.look_at_part(part);
                all.count_placed(part.edges(), placed_worlds);
                for candidate in candidates {
                    let key: usize =
                        candidate.quotient().iter().map(|&byte| usize::from(byte)).sum();
                    machines[key % 3].push(candidate);
                }
            }
            assert!(machines.iter().all(|candidates| !candidates.is_empty()), "{class}");
            for candidates in machines {
                all = all.merged(search.grouped(candidates, kept, &()).unwrap(), kept);
            }
            match kept {
                KeptPairs::All => assert_eq!(all, whole, "{class}"),
                KeptPairs::Smallest => assert_eq!(all, whole.clone().into_smallest(), "{class}"),
            }
        }
    }
}

/// All numbers are those of the independent implementation in `tests/oracle/ambiguity.py` of the
/// workspace.
// paper: marker.none-insufficient, marker.undirected-insufficient, marker.directional-sufficient
#[test]
fn simple_worlds_with_up_to_eight_edges() {
    let directional = [1, 2, 6, 23, 108, 596, 3790, 27339];
    let edges = [1, 1, 4, 12, 58, 304, 1920, 13733];
    let vertices = [1, 2, 5, 15, 61, 306, 1787, 12117];
    let graphs = [1, 1, 3, 5, 16, 63, 296, 1773];
    for (marker, placed, ambiguous, pair) in [
        ("none", graphs, [0, 0, 1, 2, 1, 9, 7, 35], Some([3, 4])),
        ("undirected", vertices, [0, 0, 0, 0, 0, 6, 4, 29], Some([6, 6])),
        ("directional", directional, [0; 8], None),
        ("undirected-edge", edges, [0, 0, 0, 0, 0, 0, 6, 16], Some([7, 7])),
        ("directed-edge", directional, [0; 8], None),
        ("two-identical", edges, [0, 0, 0, 0, 0, 0, 6, 16], Some([7, 7])),
        ("two-distinct", directional, [0; 8], None),
        ("movable", vertices, [0; 8], None),
    ] {
        let findings = search(Class::Simple, 8, marker);
        assert_eq!(counts(&findings), (placed.to_vec(), ambiguous.to_vec()), "{marker}");
        assert_eq!(smallest(&findings), pair, "{marker}");
    }
}

/// As above.
#[test]
fn multigraphs_with_up_to_five_edges() {
    let directional = [2, 10, 74, 706, 8162];
    for (marker, placed, ambiguous, pair) in [
        ("none", [2, 5, 20, 107, 870], [1, 4, 9, 35, 175], Some([1, 2])),
        ("undirected", [2, 7, 34, 239, 2286], [0, 2, 7, 31, 153], Some([2, 2])),
        ("directional", directional, [0; 5], None),
        ("undirected-edge", [2, 6, 42, 366, 4146], [0, 0, 4, 12, 88], Some([3, 3])),
        ("directed-edge", directional, [0; 5], None),
        ("two-identical", [2, 6, 33, 241, 2435], [0, 2, 8, 31, 188], Some([2, 2])),
        ("two-distinct", [2, 8, 47, 375, 3905], [0, 2, 7, 29, 157], Some([2, 2])),
        ("movable", [2, 7, 34, 239, 2286], [0, 2, 7, 25, 133], Some([2, 2])),
    ] {
        let findings = search(Class::Multigraph, 5, marker);
        assert_eq!(counts(&findings), (placed.to_vec(), ambiguous.to_vec()), "{marker}");
        assert_eq!(smallest(&findings), pair, "{marker}");
    }
}

/// As above. What is ambiguous depends on how far the search goes: a cover of a world has at least twice its edges.
#[test]
fn corridors_and_planar_worlds() {
    let corridors = search(Class::Corridor, 10, "undirected");
    assert_eq!(counts(&corridors).1, [0, 0, 0, 0, 0, 4, 0, 2, 22, 32]);
    let planar = search(Class::Planar, 8, "undirected");
    assert_eq!(counts(&planar).1, [0, 0, 0, 0, 0, 0, 0, 8]);
    assert_eq!(counts(&search(Class::Corridor, 8, "none")).1, [0, 0, 1, 2, 1, 7, 3, 12]);
    assert_eq!(counts(&search(Class::Corridor, 10, "none")).1, [0, 0, 1, 2, 8, 8, 3, 12, 41, 67]);
}

#[test]
fn each_pair_is_listed_once_and_the_smallest_first() {
    for marker in ["none", "undirected"] {
        let findings = search(Class::Multigraph, 4, marker);
        let pairs = findings.pairs();
        // The larger world's size counts first, then the smaller one's, then the codes, the first
        // world's before the other's.
        let code = |world: &PlacedWorld| code(&world.graph, PlacedWorld::FACING);
        let key = |[one, other]: [&PlacedWorld; 2]| {
            (other.graph.edge_count(), one.graph.edge_count(), code(one), code(other))
        };
        assert!(pairs.is_sorted_by(|one, other| key(*one) < key(*other)));
        assert!(
            pairs.iter().all(|[one, other]| one.graph.edge_count() <= other.graph.edge_count())
        );
        assert_eq!(pairs.first().copied(), findings.smallest());
        let of_groups = findings.groups.iter().map(|group| group.worlds.len());
        let count: usize = of_groups.map(|worlds| worlds * (worlds - 1) / 2).sum();
        assert_eq!(pairs.len(), count);
    }
}

/// What two robots perceive differs, for the first time, at the end of some walk of this length.
fn tells_apart(one: &PlacedRobot, other: &PlacedRobot, length: usize) -> Option<Vec<Action>> {
    let mut open = vec![(one.clone(), other.clone(), Vec::new())];
    for step in 0..=length {
        let mut next = Vec::new();
        for (one, other, walk) in open {
            let percepts = [one.clone().percept().unwrap(), other.clone().percept().unwrap()];
            if percepts[0] != percepts[1] {
                return (step == length).then_some(walk);
            }
            for action in one.actions() {
                let (mut one, mut other) = (one.clone(), other.clone());
                one.act(action).unwrap();
                other.act(action).unwrap();
                next.push((one, other, [walk.as_slice(), &[action]].concat()));
            }
        }
        open = next;
    }
    None
}

/// The reported walk is the first that distinguishes the worlds, among all walks in order of length and
/// then of their actions.
#[test]
fn the_walk_is_the_shortest_and_the_least() {
    let mut walks = 0;
    let graphs = starts(Class::Multigraph, 3);
    for marker in AIDS {
        for (one, other) in graphs.iter().zip(graphs.iter().cycle().skip(5)) {
            let comparison = Comparison::new(marker, (one, Dart(0)), (other, Dart(0)));
            let Some(walk) = comparison.walk([Dart(0), Dart(0)]) else { continue };
            let [here, there] = comparison.starts([Dart(0), Dart(0)]);
            assert!(walk.verify(&here, &there));
            if walk.actions.len() <= 4 {
                walks += 1;
                let first = (0..=4).find_map(|length| tells_apart(&here, &there, length));
                assert_eq!(first.as_ref(), Some(&walk.actions), "{marker:?}");
            }
        }
    }
    assert!(walks > 400, "{walks}");
}

/// A triangle and a square.
fn cycles() -> [EmbeddedGraph; 2] {
    [3, 4].map(EmbeddedGraph::cycle)
}

#[test]
fn a_relation_that_is_not_kept_proves_nothing() {
    let [three, four] = cycles();
    let none = named("none").unwrap();
    let comparison = Comparison::new(none, (&three, Dart(0)), (&four, Dart(0)));
    let [one, other] = comparison.starts([Dart(0), Dart(0)]);
    let Relation(pairs) = comparison.relation([Dart(0), Dart(0)]).unwrap();
    assert!(Relation(pairs.clone()).verify(&one, &other));
    // Without any one of its pairs it is not closed.
    for place in 0..pairs.len() {
        let mut fewer = pairs.clone();
        fewer.remove(place);
        assert!(!Relation(fewer).verify(&one, &other), "{place}");
    }
    assert!(!Relation(Vec::new()).verify(&one, &other));
    // Nor does one that names states that do not exist.
    for nowhere in [
        // A triangle has the darts 0 to 5.
        State { pose: Dart(6), ..one.state() },
        State { placed: Places::from_elem(Some(Dart(6)), 1), ..one.state() },
        State { placed: Places::from_slice(&[]), ..one.state() },
    ] {
        let more = [&pairs[..], &[(nowhere.clone(), other.state())]].concat();
        assert!(!Relation(more).verify(&one, &other), "{nowhere:?}");
    }
    // With an undirected marker, the same pairs show different percepts.
    let undirected = named("undirected").unwrap();
    let comparison = Comparison::new(undirected, (&three, Dart(0)), (&four, Dart(0)));
    let [one, other] = comparison.starts([Dart(0), Dart(0)]);
    let [here, there] = [one.state().placed, other.state().placed];
    let marked = |(one, other): (State<_>, State<_>)| {
        (State { placed: here.clone(), ..one }, State { placed: there.clone(), ..other })
    };
    assert!(!Relation(pairs.into_iter().map(marked).collect()).verify(&one, &other));
}

#[test]
fn a_walk_that_shows_no_difference_proves_nothing() {
    let [three, four] = cycles();
    let undirected = named("undirected").unwrap();
    let comparison = Comparison::new(undirected, (&three, Dart(0)), (&four, Dart(0)));
    let [one, other] = comparison.starts([Dart(0), Dart(0)]);
    let walk = comparison.walk([Dart(0), Dart(0)]).unwrap();
    assert!(walk.verify(&one, &other));
    let wrong = [
        Walk { actions: walk.actions[..2].to_vec(), ..walk.clone() },
        Walk { actions: [&walk.actions[..], &walk.actions[..1]].concat(), ..walk.clone() },
        Walk { percepts: [walk.percepts[1], walk.percepts[0]], ..walk.clone() },
        Walk { actions: vec![Action::Do(AidAction::Drop)], ..walk.clone() },
    ];
    for wrong in wrong {
        assert!(!wrong.verify(&one, &other), "{wrong:?}");
    }
    // A walk whose percepts differ before its end is not the shortest, and no proof.
    let late = [&walk.actions[..], &[Action::Take(Door(1)); 1]].concat();
    let ends = [one.clone(), other.clone()].map(|it| *replay(it, &late).unwrap().last().unwrap());
    assert_ne!(ends[0], ends[1], "or this tests nothing");
    assert!(!Walk { actions: late, percepts: ends }.verify(&one, &other));
    let percepts: Vec<Percept> = replay(one, &walk.actions).unwrap();
    assert_eq!((percepts.len(), percepts.last()), (4, Some(&walk.percepts[0])));
}

/// A search that is stopped returns no findings.
#[test]
fn an_interrupted_search_says_so() {
    /// Stops the search, or one part of it and no other.
    struct Stop(AtomicBool, bool);
    impl Watch for Stop {
        fn stop(&self) -> bool {
            self.0.swap(self.1, Ordering::Relaxed)
        }
    }
    let search = AmbiguitySearch::new(Class::Simple, 5, named("none").unwrap()).unwrap();
    for each_time in [true, false] {
        let stop = Stop(AtomicBool::new(true), each_time);
        assert_eq!(search.run(&stop), Err(Unfinished::Interrupted));
    }
}

/// A chain of three edges, seen from an end and from a vertex beside it.
#[test]
fn the_start_that_is_like_another_is_found_among_those_that_the_marker_allows() {
    let graph = EmbeddedGraph::chain(3);
    let like = |marker, [one, other]: [u32; 2]| {
        let marker = named(marker).unwrap();
        let comparison = Comparison::new(marker, (&graph, Dart(one)), (&graph, Dart(other)));
        comparison.start_like(Dart(one)).map(|dart| dart.0)
    };
    for (marker, facing, expected) in [
        // Without a marker it may begin anywhere: at an end, or turned round, at the other one.
        ("none", [0, 2], Some(0)),
        ("none", [5, 2], Some(0)),
        ("none", [1, 0], Some(1)),
        // With one beside an end, it begins there; one beside the other end is the same, turned round.
        ("undirected", [2, 1], Some(2)),
        ("undirected", [2, 3], Some(3)),
        ("undirected", [0, 1], None),
    ] {
        assert_eq!(like(marker, facing), expected, "{marker} {facing:?}");
    }
}

/// Where the robot is, and, with a marker that it can carry, where that lies, or that it is carried.
#[test]
fn the_states_of_a_triangle_are_its_poses_times_the_places_of_the_marker() {
    let [triangle, _] = cycles();
    for (aid, count) in [
        ("undirected", 6),
        ("directional", 6),
        ("movable", 6 * (3 + 1)),
        ("movable-2", 6 * (6 + 3 + 1)),
        ("movable-2-distinct", 6 * (3 + 1) * (3 + 1)),
        ("movable-directional", 6 * (6 + 1)),
        // It lies at the start vertex, or over one of the two edges there; or the robot holds it, with its back to the
        // edge over which it runs, or not.
        ("string-1", 6 * (1 + 2) + 2 + 2 * 2),
        ("team-2", 6 * 6),
        ("team-3-round", 6 * 6 * 6),
    ] {
        let has_more = |most| has_more_states(&triangle, named(aid).unwrap(), Dart(0), most);
        assert!(!has_more(count) && has_more(count - 1), "{aid}");
    }
}

/// All placed worlds of a class and its sizes, each by a graph and a facing dart.
fn placed_worlds(class: Class, edges: usize, marker: AidKind) -> Vec<(EmbeddedGraph, Dart)> {
    let mut placed: Vec<(EmbeddedGraph, Dart)> = Vec::new();
    for edges in 1..=edges {
        for graph in Enumeration::new(Each::World, class, edges).unwrap().graphs() {
            let automorphisms: Vec<_> = graph
                .darts()
                .map(|to| Bijection::of_starts((&graph, Dart(0)), (&graph, to)))
                .filter(|bijection| bijection.verify(&graph, &graph))
                .collect();
            for facing in graph.darts() {
                // The least of all that an automorphism, or the marker, makes the same.
                let alike = |bijection: &Bijection| {
                    marker.first_alike(&graph, bijection.image(facing).unwrap())
                };
                if automorphisms.iter().map(alike).min() == Some(facing) {
                    placed.push((graph.clone(), facing));
                }
            }
        }
    }
    placed
}

/// Each placed world against each, by walks and relations, without quotients.
#[test]
fn the_search_finds_what_comparing_all_with_all_finds() {
    for (class, edges) in [(Class::Multigraph, 3), (Class::Simple, 5), (Class::Planar, 5)] {
        for marker in AIDS {
            let worlds = placed_worlds(class, edges, marker);
            let mut ambiguous = vec![0; edges];
            for (place, (one, facing)) in worlds.iter().enumerate() {
                let is_like = |(other_place, (other, to)): (usize, &(EmbeddedGraph, Dart))| {
                    let comparison = Comparison::new(marker, (one, *facing), (other, *to));
                    other_place != place
                        && marker.starts(other, *to).into_iter().any(|pose| {
                            let found = comparison.walk([*facing, pose]);
                            let [here, there] = comparison.starts([*facing, pose]);
                            assert!(found.iter().all(|walk| walk.verify(&here, &there)));
                            found.is_none()
                        })
                };
                ambiguous[one.edge_count() - 1] +=
                    u64::from(worlds.iter().enumerate().any(is_like));
            }
            let findings = search(class, edges, marker.name());
            let placed = |edges| worlds.iter().filter(|(g, _)| g.edge_count() == edges).count();
            let placed: Vec<_> = (1..=edges).map(|edges| placed(edges) as u64).collect();
            assert_eq!(counts(&findings), (placed, ambiguous), "{class} {marker:?}");
        }
    }
}

/// Every pair that the search finds is a pair, whichever way the robot in the one world begins, and
/// the worlds are different ones.
#[test]
fn every_pair_is_confirmed_by_a_relation_from_every_start() {
    for marker in AIDS {
        for [one, other] in search(Class::Multigraph, 3, marker.name()).pairs() {
            assert_ne!(one, other);
            let facing = PlacedWorld::FACING;
            let comparison = Comparison::new(marker, (&one.graph, facing), (&other.graph, facing));
            for start in marker.starts(&one.graph, facing) {
                let relations = marker.starts(&other.graph, facing).into_iter().filter(|&pose| {
                    let [here, there] = comparison.starts([start, pose]);
                    let relation = comparison.relation([start, pose]);
                    relation.is_some_and(|relation| relation.verify(&here, &there))
                });
                assert!(relations.count() > 0, "{marker:?}: {one:?} {other:?} {start:?}");
            }
        }
    }
}
