use super::*;

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

fn shape_6() -> FloorPlan {
    plan(
        &[
            ("end", [4.0, 8.0]),
            ("corner", [0.0, 8.0]),
            ("tee", [0.0, 4.0]),
            ("sw", [0.0, 0.0]),
            ("se", [4.0, 0.0]),
            ("ne", [4.0, 4.0]),
        ],
        &[
            ("end", "corner"),
            ("corner", "tee"),
            ("tee", "sw"),
            ("sw", "se"),
            ("se", "ne"),
            ("ne", "tee"),
        ],
    )
    .unwrap()
}

#[test]
fn doors_stand_clockwise_from_north() {
    let plan = shape_6();
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
fn junctions_are_dead_ends_ls_and_ts() {
    use JunctionKind::{DeadEnd, L, T};
    let kinds: Vec<_> = shape_6().junctions().iter().map(|j| j.kind).collect();
    assert_eq!(kinds, [DeadEnd, L, T, L, L, L]);
}

#[test]
fn the_floor_reaches_half_a_width_beyond_the_junctions() {
    let first = shape_6().floor().next().unwrap();
    assert_eq!((first.least, first.greatest), ([-0.8, 7.2], [4.8, 8.8]));
}

#[test]
fn numbers_must_be_finite_and_the_width_positive() {
    for (width, shown) in [(0.0, "0"), (-1.0, "-1"), (f64::NAN, "NaN"), (f64::INFINITY, "inf")] {
        assert_eq!(
            message(wide(width, &[], &[])),
            format!("the hallway width is {shown}; it must be a positive number of metres")
        );
    }
    assert_eq!(
        message(plan(&[("a", [f64::NAN, 1.0])], &[])),
        "junction `a` is at (NaN, 1); both must be finite numbers of metres"
    );
}

#[test]
fn names_must_be_known_and_stand_once() {
    let (a, b) = (("a", [0.0, 0.0]), ("b", [4.0, 0.0]));
    assert_eq!(message(plan(&[a, a], &[])), "junction `a` is listed twice");
    assert_eq!(message(plan(&[a, b], &[("a", "b"), ("b", "q")])), "there is no junction `q`");
    assert_eq!(
        message(plan(&[a, b], &[("a", "b"), ("b", "a")])),
        "hallway `b` - `a` is listed twice"
    );
}

// paper: env.right-angles
#[test]
fn hallways_have_a_length_along_an_axis() {
    let askew = [("a", [0.0, 0.0]), ("b", [4.0, 0.01])];
    assert_eq!(
        message(plan(&askew, &[("a", "b")])),
        "hallway `a` - `b` runs neither north-south nor east-west"
    );
    assert_eq!(message(plan(&askew, &[("a", "a")])), "the hallway from `a` to `a` has no length");
    let rounded = [("a", [0.0, 0.1 + 0.2]), ("b", [4.0, 0.3])];
    assert!(plan(&rounded, &[("a", "b")]).is_ok());
}

// paper: env.junction-types
#[test]
fn other_junctions_than_the_three_kinds_are_named() {
    let cross = [
        ("x", [0.0, 0.0]),
        ("n", [0.0, 4.0]),
        ("e", [4.0, 0.0]),
        ("s", [0.0, -4.0]),
        ("w", [-4.0, 0.0]),
    ];
    let kinds = "it must be a dead end, an L or a T";
    assert_eq!(
        message(plan(&cross, &[("x", "n"), ("x", "e"), ("x", "s"), ("x", "w")])),
        format!("junction `x` has four doors; {kinds}")
    );
    for straight in [[("n", "x"), ("x", "s")], [("e", "x"), ("x", "w")]] {
        assert_eq!(
            message(plan(&cross, &straight)),
            format!("junction `x` has two doors opposite each other; {kinds}")
        );
    }
    assert_eq!(
        message(plan(&cross[..3], &[("x", "n")])),
        format!("junction `e` has no door; {kinds}")
    );
}

#[test]
fn hallways_neither_cross_nor_overlap() {
    let cross = [
        ("n", [0.0, 4.0]),
        ("s", [0.0, -4.0]),
        ("e", [4.0, 0.0]),
        ("w", [-4.0, 0.0]),
        ("sw", [-4.0, -4.0]),
    ];
    assert_eq!(
        message(plan(&cross, &[("n", "s"), ("s", "sw"), ("sw", "w"), ("w", "e")])),
        "hallways `n` - `s` and `w` - `e` cross"
    );
    let line = [("a", [0.0, 0.0]), ("b", [4.0, 0.0]), ("c", [8.0, 0.0])];
    assert_eq!(
        message(plan(&line, &[("a", "b"), ("a", "c")])),
        "hallways `a` - `b` and `a` - `c` overlap"
    );
    // A U whose arms are so close that their floors touch, or just do not.
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

#[test]
fn junctions_are_two_widths_apart() {
    let at = |x| plan(&[("a", [0.0, 0.0]), ("b", [x, 0.0])], &[("a", "b")]);
    assert_eq!(
        message(at(3.0)),
        "junctions `a` and `b` are 3.00 m apart; it must be two hallway widths, 3.20 m"
    );
    assert!(at(3.2).is_ok());
}

#[test]
fn no_junction_lies_on_a_foreign_hallway() {
    let junctions = [
        ("a", [0.0, 0.0]),
        ("b", [8.0, 0.0]),
        ("c", [8.0, 4.0]),
        ("d", [4.0, 4.0]),
        ("e", [4.0, 0.5]),
    ];
    assert_eq!(
        message(plan(&junctions, &[("a", "b"), ("b", "c"), ("c", "d"), ("d", "e")])),
        "junction `e` lies on hallway `a` - `b`, which does not end there"
    );
}

#[test]
fn a_plan_is_connected_and_not_empty() {
    let junctions = [("a", [0.0, 0.0]), ("b", [8.0, 0.0]), ("c", [8.0, 4.0]), ("d", [4.0, 4.0])];
    assert_eq!(
        message(plan(&junctions, &[("a", "b"), ("c", "d")])),
        "the world is not connected: vertex `c` cannot be reached from `a`"
    );
    assert_eq!(message(plan(&[], &[])), "there is no edge; a world has at least one");
}
