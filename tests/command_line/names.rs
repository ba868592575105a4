//! Names in worlds are any printable text without quotes and path separators, and every output shows them.

use std::{fs, path::Path};

use toposlam_model::format::{named_world::NamedWorld, world_file};

use super::{folder, objects, run, stderr, stdout, stdout_of};

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

fn written(folder: &Path) -> String {
    let file = folder.join("東 plan.toml");
    fs::write(&file, PLAN).unwrap();
    file.to_str().unwrap().to_owned()
}

#[test]
fn a_world_keeps_its_names_in_every_format() {
    let folder = folder("names_in_formats");
    let plan = written(&folder);
    let world = super::read_world(Path::new(&plan));
    assert_eq!(world.vertex_names, NAMES);
    let json = folder.join("w.json");
    fs::write(&json, world_file::to_json_text(&world)).unwrap();
    assert_eq!(super::read_world(&json), world);
    assert_eq!(world_file::read(world_file::to_toml(&world).as_bytes()).unwrap(), world);
    let dot = stdout_of(["draw", &plan, "--format", "dot"]);
    assert!(dot.contains("\"Küche\"") && dot.contains("\"<b>&amp;\"") && dot.contains("\"x:y\""));
    let svg = stdout_of(["draw", &plan]);
    assert!(svg.contains("Küche") && svg.contains("&lt;b&gt;&amp;") && !svg.contains("<b>"));
    let png = folder.join("w.png");
    stdout_of(["draw", &plan, "-o", png.to_str().unwrap()]);
}

#[test]
fn a_start_is_given_by_any_names() {
    let folder = folder("names_of_starts");
    let plan = written(&folder);
    for start in ["Küche:東口", "東口:a b", "<b>&:Küche", "a b:x:y", "x:y:a b"] {
        let line = &objects(&stdout_of(["explore", &plan, "--json", "--start", start]))[0];
        assert_eq!(line["isomorphic"], true, "{start}");
    }
    let wrong = run(["explore", &plan, "--start", "Kuche:東口"]);
    assert!(stderr(&wrong).contains("there is no vertex `Kuche`; did you mean `Küche`?"));
    assert!(stdout_of(["compare", &plan, &plan, "--walk", "0,1"]).contains("東口"));
}

#[test]
fn the_pages_and_reports_of_a_run_escape_names() {
    let folder = folder("names_on_pages");
    let plan = written(&folder);
    let file = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let [log, page, svg, walk, report] =
        ["東.mcap", "run.html", "run.svg", "walk.html", "conform.html"].map(file);
    let files = ["--log", &log, "--html", &page, "--svg", &svg];
    stdout_of([&["simulate", &plan, "--by-scene", "--start", "東口:a b"], &files[..]].concat());
    stdout_of(["compare", &plan, "worlds/shape-6.toml", "--html", &walk]);
    let [junit, sarif] = ["j.xml", "s.sarif"].map(file);
    let reports = ["--html", &report, "--junit", &junit, "--sarif", &sarif];
    let text = stdout_of([&["conform", &log, "--world", &plan], &reports[..]].concat());
    assert!(text.contains("from 東口:a b"), "{text}");
    for page in [&page, &walk, &report, &svg] {
        let text = fs::read_to_string(page).unwrap();
        assert!(!text.contains("<b>&") && !text.contains("<i>&"), "{page}");
        assert!(text.contains("東"), "{page}");
    }
    for report in [&junit, &sarif] {
        assert!(!fs::read_to_string(report).unwrap().contains("<b>&"), "{report}");
    }
    // The log's own start is read again.
    let line = &objects(&stdout_of(["conform", &log, "--world", &plan, "--json"]))[0];
    assert_eq!(line["verdict"], "conforms");
}

#[test]
fn what_is_no_name_is_an_error_with_its_place() {
    let folder = folder("no_names");
    let escaped = r#"["", "a/b", "a\\b", "it's", "say \"a\"", "`a`", "a\u0007", "a\n", " a", "a ", "\u202e"]"#;
    let wrong: Vec<String> = serde_json::from_str(escaped).unwrap();
    for name in &wrong {
        let quoted = serde_json::to_string(name).unwrap();
        let places = [
            (
                "w.toml",
                format!("[clockwise]\n{quoted} = [\"b\"]\nb = [{quoted}]\n"),
                "line 2, column 1: clockwise.",
            ),
            (
                "w.json",
                format!("{{\n \"clockwise\": {{\"b\": [{quoted}], {quoted}: [\"b\"]}}}}"),
                "line 2, column 22: clockwise.b[0]: ",
            ),
        ];
        for (file, text, place) in places {
            let file = folder.join(file);
            fs::write(&file, text).unwrap();
            let output = run(["explore".as_ref(), file.as_os_str()]);
            let message = stderr(&output);
            assert_eq!(output.status.code(), Some(2), "{message}");
            assert!(message.contains(&format!("{}: {place}", file.display())), "{message}");
            assert!(message.contains("is not a name; a name is printable"), "{message}");
            assert_eq!(message.lines().count(), 1, "{message}");
            assert!(!message.trim_end().contains(char::is_control), "{message}");
        }
    }
}

#[test]
fn an_error_in_a_json_world_has_line_and_column() {
    let folder = folder("json_places");
    let cases = [
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
    ];
    for (text, place) in cases {
        let file = folder.join("w.json");
        fs::write(&file, text).unwrap();
        let output = run(["explore".as_ref(), file.as_os_str()]);
        let message = stderr(&output);
        assert!(message.starts_with(&format!("error: {}: {place}", file.display())), "{message}");
        assert_eq!(stdout(&output), "");
    }
}

#[test]
fn a_world_without_a_name_has_that_of_its_file() {
    let folder = folder("names_of_files");
    for (file, name) in [("東 口.toml", "東 口"), ("it's.toml", "it_s"), ("a_b-1.toml", "a_b-1")]
    {
        let file = folder.join(file);
        fs::write(&file, "[clockwise]\na = [\"b\"]\nb = [\"a\"]\n").unwrap();
        let dot = stdout_of(["draw", file.to_str().unwrap(), "--format", "dot"]);
        assert!(dot.starts_with(&format!("graph \"{name}\"")), "{dot}");
    }
    let named =
        NamedWorld { name: "x".to_owned(), ..super::read_world(&folder.join("a_b-1.toml")) };
    assert!(world_file::to_toml(&named).starts_with("name = \"x\"\n"));
}
