use super::*;
use crate::any_graph::world;

type Plan = Result<FloorPlan, FloorPlanError>;

fn plan(junctions: &[(&str, [f64; 2])], hallways: &[(&str, &str)]) -> Plan {
    wide(1.6, junctions, hallways)
}

fn wide(width: f64, junctions: &[(&str, [f64; 2])], hallways: &[(&str, &str)]) -> Plan {
    let junctions: Vec<_> =
        junctions.iter().map(|&(name, position)| (name.to_owned(), position)).collect();
    let hallways: Vec<_> =
        hallways.iter().map(|&(from, to)| (from.to_owned(), to.to_owned())).collect();
    FloorPlan::new(width, &junctions, &hallways)
}

fn message(plan: Plan) -> String {
    plan.unwrap_err().to_string()
}

#[test]
fn doors_stand_clockwise_from_north() {
    let plan = world("shape-6").plan.unwrap();
    let graph = plan.graph();
    assert_eq!((graph.vertex_count(), graph.edge_count()), (6, 6));
    assert_eq!(graph.genus(), 0);
    let tee = Vertex(2);
    let doors: Vec<_> = graph
        .darts_of(tee)
        .map(|dart| {
            let neighbour = graph.vertex(graph.opposite(dart));
            (plan.direction(dart), plan.junction(neighbour).name.as_str())
        })
        .collect();
    assert_eq!(
        doors,
        [(Direction::North, "corner"), (Direction::East, "ne"), (Direction::South, "sw")]
    );
    for dart in graph.darts() {
        let back = plan.direction(graph.opposite(dart));
        assert_eq!(plan.direction(dart).reversed(), back);
    }
}

#[test]
fn junctions_have_kinds_and_the_floor_reaches_half_a_width_beyond_them() {
    use JunctionKind::{DeadEnd, L, T};
    let plan = world("shape-6").plan.unwrap();
    let kinds: Vec<_> = plan.junctions().iter().map(|j| j.kind).collect();
    assert_eq!(kinds, [DeadEnd, L, T, L, L, L]);
    let first = plan.floor().next().unwrap();
    assert_eq!((first.least, first.greatest), ([-0.8, 7.2], [4.8, 8.8]));
}

#[test]
fn the_hallway_width_is_positive_and_finite() {
    for (width, shown) in [(0.0, "0"), (-1.0, "-1"), (f64::NAN, "NaN"), (f64::INFINITY, "inf")] {
        assert_eq!(
            message(wide(width, &[], &[])),
            format!("the hallway width is {shown}; it must be a positive number of metres")
        );
    }
}

// paper: env.right-angles, env.junction-types
#[test]
fn each_fault_that_is_not_tested_with_its_place_in_a_file_is_named() {
    let (a, b) = (("a", [0.0, 0.0]), ("b", [4.0, 0.0]));
    let line = [a, b, ("c", [8.0, 0.0])];
    let cross = [
        ("x", [0.0, 0.0]),
        ("n", [0.0, 4.0]),
        ("e", [4.0, 0.0]),
        ("s", [0.0, -4.0]),
        ("w", [-4.0, 0.0]),
    ];
    let ring = [cross[1], cross[3], cross[2], cross[4], ("sw", [-4.0, -4.0])];
    let on = [a, ("b", [8.0, 0.0]), ("c", [8.0, 4.0]), ("d", [4.0, 4.0]), ("e", [4.0, 0.5])];
    let cases: [(&[_], &[_], _); 9] = [
        (&[a, a], &[], "junction `a` is listed twice"),
        (
            &[a, ("b", [4.0, 0.01])],
            &[("a", "b")],
            "hallway `a` - `b` runs neither north-south nor east-west",
        ),
        (
            &cross,
            &[("x", "n"), ("x", "e"), ("x", "s"), ("x", "w")],
            "junction `x` has four doors; it must be a dead end, an L or a T",
        ),
        (
            &cross,
            &[("e", "x"), ("x", "w")],
            "junction `x` has two doors opposite each other; it must be a dead end, an L or a T",
        ),
        (
            &cross[..3],
            &[("x", "n")],
            "junction `e` has no door; it must be a dead end, an L or a T",
        ),
        (
            &ring,
            &[("n", "s"), ("s", "sw"), ("sw", "w"), ("w", "e")],
            "hallways `n` - `s` and `w` - `e` cross",
        ),
        (&line, &[("a", "b"), ("a", "c")], "hallways `a` - `b` and `a` - `c` overlap"),
        (
            &on,
            &[("a", "b"), ("b", "c"), ("c", "d"), ("d", "e")],
            "junction `e` lies on hallway `a` - `b`, which does not end there",
        ),
        (
            &on[..4],
            &[("a", "b"), ("c", "d")],
            "the world is not connected: vertex `c` cannot be reached from `a`",
        ),
    ];
    for (junctions, hallways, expected) in cases {
        assert_eq!(message(plan(junctions, hallways)), expected);
    }
    assert_eq!(message(plan(&[], &[])), "there is no edge; a world has at least one");
    // Rounding makes no fault.
    let rounded = [("a", [0.0, 0.1 + 0.2]), ("b", [3.2, 0.3])];
    assert!(plan(&rounded, &[("a", "b")]).is_ok());
}

/// A U whose arms are so close that their floors touch, or just do not.
#[test]
fn floors_of_hallways_do_not_touch() {
    let arms = |gap: f64| {
        let u = [
            ("a", [0.0, 0.0]),
            ("b", [8.0, 0.0]),
            ("c", [8.0, 8.0]),
            ("d", [4.0, 8.0]),
            ("e", [4.0, gap]),
        ];
        plan(&u, &[("a", "b"), ("b", "c"), ("c", "d"), ("d", "e")])
    };
    for touching in [1.4, 1.6, 1.6 + 1e-9] {
        assert_eq!(
            message(arms(touching)),
            "the floors of hallways `a` - `b` and `d` - `e` overlap or touch"
        );
    }
    assert!(arms(1.7).is_ok());
}
