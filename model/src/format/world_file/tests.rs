use proptest::{collection::vec, prelude::*};

use super::*;
use crate::{
    aid::AIDS,
    any_graph::{Class, any_graph},
    embedded_graph::{Dart, EmbeddedGraph},
    floor_plan::FloorPlan,
    format::named_world::NamedWorld,
};

fn message(text: &str) -> String {
    read(text.as_bytes()).unwrap_err().to_string()
}

const TRIANGLE: &str = r#"name = "triangle"
about = "Three corners"

[clockwise]
z = ["a", "m"]
a = ["m", "z"]
m = ["z", "a"]

[start]
at = "a"
facing = "z"
"#;

const TRIANGLE_IN_JSON: &str = r#"{
  "name": "triangle",
  "about": "Three corners",
  "clockwise": {
    "z": ["a", "m"],
    "a": ["m", "z"],
    "m": ["z", "a"]
  },
  "start": {
    "at": "a",
    "facing": "z"
  }
}
"#;

const DOORS: &str = r#"[doors]
u = ["a", "b", "a", "c"]
v = ["b", "c"]

[start]
at = "u"
facing = "a:2"
"#;

const PLAN: &str = r#"name = "bend"

[floor]
hallway_width = 1.6

[junctions]
south = [0.0, -4.5]
corner = [0.0, 0.0]
east = [4.0, 0.0]

[[hallways]]
from = "south"
to = "corner"

[[hallways]]
from = "east"
to = "corner"

[start]
at = "corner"
facing = "east"
"#;

#[test]
fn vertices_are_in_the_order_of_the_file() {
    let world = read(TRIANGLE.as_bytes()).unwrap();
    assert_eq!(world.vertex_names, ["z", "a", "m"]);
    assert_eq!(world.start, Some(Dart(3)));
    assert_eq!((world.name.as_str(), world.about.as_str()), ("triangle", "Three corners"));
    assert_eq!(world.edge_names, None);
    assert_eq!(read(TRIANGLE_IN_JSON.as_bytes()).unwrap(), world);
    assert_eq!(to_toml(&world), TRIANGLE);
    assert_eq!(to_json_text(&world), TRIANGLE_IN_JSON);
}

#[test]
fn a_file_with_doors_names_its_edges() {
    let world = read(DOORS.as_bytes()).unwrap();
    assert_eq!(world.edge_names.as_deref().unwrap(), ["a", "b", "a", "c", "b", "c"]);
    assert_eq!(world.start, Some(Dart(2)));
    assert_eq!(world.name, "");
    assert_eq!(to_toml(&world), DOORS);
}

#[test]
fn a_floor_plan_gives_its_graph_and_keeps_its_geometry() {
    let world = read(PLAN.as_bytes()).unwrap();
    assert_eq!(world.vertex_names, ["south", "corner", "east"]);
    assert_eq!(world.positions.as_deref(), Some(&[[0.0, -4.5], [0.0, 0.0], [4.0, 0.0]][..]));
    assert_eq!(world.start_text(world.start.unwrap()), "corner:east");
    assert_eq!(to_toml(&world), PLAN);
    assert_eq!(
        to_json_text(&world),
        r#"{
  "name": "bend",
  "floor": {
    "hallway_width": 1.6
  },
  "junctions": {
    "south": [0.0, -4.5],
    "corner": [0.0, 0.0],
    "east": [4.0, 0.0]
  },
  "hallways": [
    {"from": "south", "to": "corner"},
    {"from": "east", "to": "corner"}
  ],
  "start": {
    "at": "corner",
    "facing": "east"
  }
}
"#
    );
    assert_eq!(read(to_json_text(&world).as_bytes()).unwrap(), world);
    let whole_numbers = PLAN.replace(".0", "");
    assert_eq!(read(whole_numbers.as_bytes()).unwrap(), world);
}

const NOT_A_NAME: &str = "is not a name; a name is printable, without quotes, / and \\, and without a \
                          space at its ends";

/// Texts that are not world files, each with the place and the cause. More of them are in the snapshots of the
/// command line, with their files.
#[test]
fn each_fault_has_its_place() {
    let no_name = |place, name| format!("{place}: `{name}` {NOT_A_NAME}");
    let cases = [
        ("name = \"a/b\"", no_name("line 1, column 8: name", "a/b")),
        ("[clockwise]\n\"a \" = []", no_name("line 2, column 1: clockwise.a ", "a ")),
        ("[clockwise]\na = [\"\"]", no_name("line 2, column 6: clockwise.a[0]", "")),
        ("[doors]\na = [\"\\u00e9\\n\"]", no_name("line 2, column 6: doors.a[0]", "é\\n")),
    ];
    for (text, expected) in cases {
        assert_eq!(message(text), expected);
    }
    for (text, expected) in [
        // No text, or none of the syntax.
        ("", "the file is empty"),
        (" \n", "the file is empty"),
        ("{\n \"name\": }", "line 2, column 10: expected value"),
        ("{} x", "line 1, column 4: trailing characters"),
        // Keys.
        (
            "[clockwise]\na = [\"b\"]\nb = [\"a\"]\n[start]\nfrom = \"a\"",
            "line 5, column 1: start.from: unknown key; expected one of: at, facing, marker",
        ),
        (
            "[clockwise]\na = [\"b\"]\nb = [\"a\"]\n[start]\nat = \"a\"",
            "line 4, column 2: start: the key `facing` is missing",
        ),
        ("[floor]\nhallway_width = 1", "the key `junctions` is missing"),
        // Values of the wrong kind.
        ("name = 3", "line 1, column 8: name: expected a name, found a whole number"),
        ("about = []\n[doors]", "line 1, column 9: about: expected a text, found a list"),
        ("clockwise = []", "line 1, column 13: clockwise: expected a table, found a list"),
        (
            "[clockwise]\na = \"b\"",
            "line 2, column 5: clockwise.a: expected a list of names, found a text",
        ),
        (
            "[clockwise]\na = [true]",
            "line 2, column 6: clockwise.a[0]: expected a name, found true or false",
        ),
        // Not one world.
        (
            "name = \"a\"",
            "there is no world; the file needs one of [clockwise], [doors] and [floor]",
        ),
        (
            "[doors]\n[junctions]",
            "there are both [doors] and [floor]; a world needs only one of them",
        ),
        // Lists.
        (
            "[clockwise]\na = [\"q\"]",
            "line 2, column 6: clockwise.a[0]: vertex `a` lists the neighbour `q`, which is not a vertex",
        ),
        (
            "[clockwise]\na = [\"b\", \"b\"]\nb = [\"a\", \"a\"]",
            "line 2, column 11: clockwise.a[1]: vertex `a` lists the neighbour `b` twice; \
             parallel edges need edge names, in [doors]",
        ),
        (
            "[clockwise]\na = [\"a\"]",
            "line 2, column 6: clockwise.a[0]: vertex `a` lists itself; loops need edge names, in [doors]",
        ),
        ("[clockwise]", "line 1, column 2: clockwise: there is no edge; a world has at least one"),
        ("[doors]\na = []", "line 1, column 2: doors: there is no edge; a world has at least one"),
    ] {
        assert_eq!(message(text), expected);
    }
}

/// [`PLAN`] with a part replaced, with the place and the cause.
#[test]
fn each_fault_of_a_floor_plan_has_its_place() {
    for (text, instead, expected) in [
        (
            "to = \"corner\"\n\n[start]",
            "[start]",
            "line 15, column 1: hallways[1]: the key `to` is missing",
        ),
        (
            "[4.0, 0.0]",
            "[4.0]",
            "line 9, column 8: junctions.east: expected a list of two numbers, x and y, found a list of another length",
        ),
        (
            "[4.0, 0.0]",
            "[4.0, \"0\"]",
            "line 9, column 14: junctions.east[1]: expected a number, found a text",
        ),
        (
            "1.6",
            "nan",
            "line 4, column 1: floor.hallway_width: the hallway width is NaN; it must be a positive number of metres",
        ),
        (
            "[4.0, 0.0]",
            "[inf, 0.0]",
            "line 9, column 1: junctions.east: junction `east` is at (inf, 0); both must be finite numbers of metres",
        ),
        (
            "[4.0, 0.0]",
            "[3.0, 0.0]",
            "line 6, column 2: junctions: junctions `corner` and `east` are 3.00 m apart; \
             it must be two hallway widths, 3.20 m",
        ),
        (
            "from = \"east\"",
            "from = \"q\"",
            "line 15, column 1: hallways[1]: there is no junction `q`",
        ),
        (
            "[start]",
            "[[hallways]]\nfrom = \"corner\"\nto = \"east\"\n\n[start]",
            "line 19, column 1: hallways[2]: hallway `corner` - `east` is listed twice",
        ),
        (
            "[4.0, 0.0]",
            "[0.0, 4.0]",
            "line 8, column 1: junctions.corner: junction `corner` has two doors opposite each other; \
             it must be a dead end, an L or a T",
        ),
        (
            "from = \"east\"",
            "from = \"corner\"",
            "line 15, column 1: hallways[1]: the hallway from `corner` to `corner` has no length",
        ),
    ] {
        assert_eq!(message(&PLAN.replace(text, instead)), expected);
    }
}

#[test]
fn about_can_have_any_character() {
    let graph = EmbeddedGraph::cycle(1);
    let all: String = ('\0'..='\u{ff}').chain("\u{feff}\u{2028}\u{1f600}".chars()).collect();
    reads_back(&NamedWorld::numbered("", &all, graph, None));
}

fn reads_back(world: &NamedWorld) {
    for text in [to_toml(world), to_json_text(world), to_json(world).to_string()] {
        assert_eq!(&read(text.as_bytes()).unwrap(), world, "{text}");
    }
}

fn any_name() -> impl Strategy<Value = String> {
    let letters =
        |text: String| text.chars().filter(|letter| is_name(&letter.to_string())).collect();
    "\\PC{0,9}".prop_map(letters)
}

#[test]
fn names_are_printable_without_quotes_and_separators() {
    for name in ["a", "Küche", "東口", "<b>&", "a b", "x:y", "e\u{301}", "🦀", "§ 3.1 (a), {b}"]
    {
        assert!(is_name(name), "{name}");
    }
    let wrong = [
        "", " ", " a", "a ", "a/b", "a\\b", "'", "\"", "`", "\0", "\t", "\u{7f}", "\u{202e}",
        "\u{301}",
    ];
    for name in wrong {
        assert!(!is_name(name), "{name:?}");
    }
}

/// A triangle with positions, in TOML and in JSON.
#[test]
fn the_vertices_of_lists_may_have_positions() {
    let text =
        "[clockwise]\na = [\"b\", \"c\"]\nb = [\"a\", \"c\"]\nc = [\"a\", \"b\"]\n\n[positions]\n";
    let whole = format!("{text}a = [0.0, -1.5]\nb = [2.0, 0.0]\nc = [1.0, 4.0]\n");
    let world = read(whole.as_bytes()).unwrap();
    assert_eq!(world.positions, Some(vec![[0.0, -1.5], [2.0, 0.0], [1.0, 4.0]]));
    assert_eq!(to_toml(&world), whole);
    assert_eq!(read(to_json_text(&world).as_bytes()), Ok(world));
    for (positions, message) in [
        ("a = [0, 0]\nb = [2, 0]\n", "line 6, column 2: positions: the vertex `c` has no position"),
        ("a = [0, 0]\nd = [2, 0]\n", "line 8, column 1: positions.d: there is no vertex `d`"),
        ("a = [0]\n", "line 7, column 5: positions.a: expected a list of two numbers, x and y"),
    ] {
        let error = read(format!("{text}{positions}").as_bytes()).unwrap_err().to_string();
        assert!(error.starts_with(message), "{error}");
    }
    let plan = "[floor]\nhallway_width = 1.0\n[junctions]\na = [0, 0]\nb = [4, 0]\n[[hallways]]\n\
        from = \"a\"\nto = \"b\"\n[positions]\na = [0, 0]\nb = [4, 0]\n";
    let error = read(plan.as_bytes()).unwrap_err().to_string();
    assert!(error.ends_with("a floor plan has its positions in [junctions]"), "{error}");
}

proptest! {
    #[test]
    fn what_was_written_reads_back(
        graph in any_graph(Class::Multigraph, 30),
        start in proptest::option::of(any::<u32>()),
        name in any_name(),
        vertex in any_name(),
        about in any::<String>(),
    ) {
        let darts = graph.dart_count() as u32;
        let start = start.map(|start| Dart(start % darts));
        let world = NamedWorld::numbered(&name, &about, graph, start);
        let vertex_names = world.vertex_names.iter().map(|number| format!("{vertex}{number}"));
        reads_back(&NamedWorld { vertex_names: vertex_names.collect(), ..world });
    }

    #[test]
    fn positions_read_back_to_the_bit(x in -1e9..1e9_f64, y in any::<f64>(), width in 1e-3..1e3_f64) {
        let junctions = [("a".to_owned(), [x, y]), ("b".to_owned(), [x + 4e3, y])];
        let hallways = [("a".to_owned(), "b".to_owned())];
        if let Ok(plan) = FloorPlan::new(width, &junctions, &hallways) {
            reads_back(&NamedWorld {
                vertex_names: vec!["a".to_owned(), "b".to_owned()],
                positions: Some(junctions.iter().map(|(_, position)| *position).collect()),
                plan: Some(plan.clone()),
                ..NamedWorld::numbered("", "", plan.graph().clone(), None)
            });
        }
    }

    #[test]
    fn no_bytes_make_the_reader_panic(bytes in vec(any::<u8>(), 0..200)) {
        let _ = read(&bytes);
    }

    #[test]
    fn no_edit_of_a_file_makes_the_reader_panic(
        file in 0..4_usize, at in any::<usize>(), cut in 0..9_usize, insert in "[ -~\n]{0,4}"
    ) {
        let text = [TRIANGLE, TRIANGLE_IN_JSON, DOORS, PLAN][file];
        let at = at % text.len();
        let end = (at + cut).min(text.len());
        let edited = [&text[..at], &insert, &text[end..]].concat();
        if let Ok(world) = read(edited.as_bytes()) {
            reads_back(&world);
        }
    }
}

#[test]
fn deep_nesting_is_rejected() {
    for open in ["[", "{\"a\":"] {
        let deep = open.repeat(100_000);
        assert!(read(deep.as_bytes()).is_err());
        assert!(read(format!("a = {deep}").as_bytes()).is_err());
    }
    assert!(read("a.".repeat(100_000).as_bytes()).is_err());
}

#[test]
fn a_start_may_name_its_marker() {
    let graph = EmbeddedGraph::chain(1);
    for marker in AIDS {
        let world = NamedWorld {
            marker: Some(marker),
            ..NamedWorld::numbered("", "", graph.clone(), Some(Dart(0)))
        };
        assert!(to_toml(&world).ends_with(&format!("\nmarker = \"{}\"\n", marker.name())));
        reads_back(&world);
    }
    let file = "[clockwise]\na = [\"b\"]\nb = [\"a\"]\n[start]\nat = \"a\"\nfacing = \"b\"\n";
    assert_eq!(read(file.as_bytes()).unwrap().marker, None);
    let wrong = read(format!("{file}marker = \"two\"\n").as_bytes()).unwrap_err().to_string();
    assert!(wrong.contains("two-identical"), "{wrong}");
}
