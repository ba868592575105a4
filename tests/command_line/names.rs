//! Names in worlds are any printable text without quotes and path separators, and every output shows them.

use serde_json::json;
use toposlam_model::format::world_file;

use super::{Scratch, read_world};

/// A floor plan with names that some format could misread.
const PLAN: &str = r#"name = "Gebäude <i>&東"

[floor]
hallway_width = 1.6

[junctions]
"Küche" = [0.0, 0.0]
"東口" = [6.0, 0.0]
"<b>&" = [0.0, 6.0]
"a b" = [6.0, 6.0]
"x:y" = [12.0, 6.0]

[[hallways]]
from = "Küche"
to = "東口"

[[hallways]]
from = "Küche"
to = "<b>&"

[[hallways]]
from = "東口"
to = "a b"

[[hallways]]
from = "<b>&"
to = "a b"

[[hallways]]
from = "a b"
to = "x:y"

[start]
at = "Küche"
facing = "<b>&"
"#;

const NAMES: [&str; 5] = ["Küche", "東口", "<b>&", "a b", "x:y"];

const FILE: &str = "東 plan.toml";

fn scratch(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    scratch.write(FILE, PLAN);
    scratch
}

#[test]
fn a_world_keeps_its_names_in_every_format() {
    let scratch = scratch("names_in_formats");
    let world = read_world(&scratch.path(FILE));
    assert_eq!(world.vertex_names, NAMES);
    scratch.write("w.json", world_file::to_json_text(&world));
    assert_eq!(read_world(&scratch.path("w.json")), world);
    assert_eq!(world_file::read(world_file::to_toml(&world).as_bytes()).unwrap(), world);
    let dot = scratch.out("draw '東 plan.toml' --format dot", 0);
    assert!(dot.contains("\"Küche\"") && dot.contains("\"<b>&amp;\"") && dot.contains("\"x:y\""));
    let svg = scratch.out("draw '東 plan.toml'", 0);
    assert!(svg.contains("Küche") && svg.contains("&lt;b&gt;&amp;") && !svg.contains("<b>"));
    scratch.out("draw '東 plan.toml' -o w.png", 0);
}

#[test]
fn a_start_is_given_by_any_names() {
    let scratch = scratch("names_of_starts");
    for start in ["Küche:東口", "東口:a b", "<b>&:Küche", "a b:x:y", "x:y:a b"] {
        let explore = format!("explore '東 plan.toml' --start '{start}'");
        scratch.facts(&[(&explore, 0, json!({ "isomorphic": true }))]);
    }
    let wrong = scratch.error("explore '東 plan.toml' --start 'Kuche:東口'");
    assert!(wrong.contains("there is no vertex `Kuche`; did you mean `Küche`?"), "{wrong}");
}

#[test]
fn the_pages_and_reports_of_a_run_escape_names() {
    let scratch = scratch("names_on_pages");
    scratch.out(
        "simulate '東 plan.toml' --by-scene --start '東口:a b' --log 東.mcap --html run.html --svg run.svg",
        0,
    );
    scratch.out("compare '東 plan.toml' worlds/shape-6.toml --html walk.html", 0);
    // The log's own start is read again.
    let reports = "--html conform.html --junit j.xml --sarif s.sarif";
    let conform = format!("conform 東.mcap --world '東 plan.toml' {reports}");
    scratch.facts(&[(&conform, 0, json!({ "verdict": "conforms", "world.start": "東口:a b" }))]);
    for page in ["run.html", "run.svg", "walk.html", "conform.html"] {
        let text = scratch.text(page);
        assert!(!text.contains("<b>&") && !text.contains("<i>&"), "{page}");
        assert!(text.contains("東"), "{page}");
    }
    for report in ["j.xml", "s.sarif"] {
        assert!(!scratch.text(report).contains("<b>&"), "{report}");
    }
}

#[test]
fn what_is_no_name_is_an_error_with_its_place() {
    let scratch = scratch("no_names");
    let escaped = r#"["", "a/b", "a\\b", "it's", "say \"a\"", "`a`", "a\u0007", "a\n", " a", "a ", "\u202e"]"#;
    let wrong: Vec<String> = serde_json::from_str(escaped).unwrap();
    for name in &wrong {
        let quoted = serde_json::to_string(name).unwrap();
        scratch.write("w.toml", format!("[clockwise]\n{quoted} = [\"b\"]\nb = [{quoted}]\n"));
        let json = format!("{{\n \"clockwise\": {{\"b\": [{quoted}], {quoted}: [\"b\"]}}}}");
        scratch.write("w.json", json);
        for (file, place) in [
            ("w.toml", "line 2, column 1: clockwise."),
            ("w.json", "line 2, column 22: clockwise.b[0]: "),
        ] {
            let message = scratch.error(&format!("explore {file}"));
            assert!(message.starts_with(&format!("error: {file}: {place}")), "{message}");
            assert!(message.contains("is not a name; a name is printable"), "{message}");
            assert_eq!(message.lines().count(), 1, "{message}");
            assert!(!message.trim_end().contains(char::is_control), "{message}");
        }
    }
}

#[test]
fn an_error_in_a_json_world_has_line_and_column() {
    let scratch = scratch("json_places");
    for (text, place) in [
        (
            "{\"clockwise\": {\n  \"a\": [\"b\", \"c\"],\n  \"b\": [\"a\"],\n  \"c\": [\"b\"]}}",
            "line 2, column 14: clockwise.a[1]: vertex `a` lists the neighbour `c`",
        ),
        (
            "{\"clockwise\": {\"ä\": [\"b\"], \"b\": [\"ä\"]},\n \"start\": {\"at\": \"ö\", \"facing\": \"b\"}}",
            "line 2, column 18: start.at: there is no vertex `ö`",
        ),
        (
            "{\"doors\": {\"a\": [\"e\", \"e\"],\n\"b\": [\"e\"]}}",
            "line 1, column 18: doors.a[0]: edge `e` occurs 3 times",
        ),
        ("{\"colour\": 1}", "line 1, column 2: colour: unknown key"),
        (
            "{\"floor\": {\"hallway_width\": 1},\n\"junctions\": {\"a\": [0]}, \"hallways\": []}",
            "line 2, column 20: junctions.a: expected a list of two numbers",
        ),
    ] {
        scratch.write("w.json", text);
        let message = scratch.error("explore w.json");
        assert!(message.starts_with(&format!("error: w.json: {place}")), "{message}");
    }
}

#[test]
fn a_world_without_a_name_has_that_of_its_file() {
    let scratch = scratch("names_of_files");
    for (file, name) in [("東 口", "東 口"), ("it's", "it_s"), ("a_b-1", "a_b-1")] {
        scratch.write(&format!("{file}.toml"), "[clockwise]\na = [\"b\"]\nb = [\"a\"]\n");
        let dot = scratch.out(&format!("draw \"{file}.toml\" --format dot"), 0);
        assert!(dot.starts_with(&format!("graph \"{name}\"")), "{dot}");
    }
}
