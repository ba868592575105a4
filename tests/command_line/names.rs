//! Names in worlds are any printable text without quotes and path separators, and every output shows them.

use toposlam_model::format::world_file;

use super::{Scratch, read_world};

/// A floor plan with names that some format could misread.
const PLAN: &str = r#"name = "Gebäude <i>&東"
floor.hallway_width = 1.6
junctions = { "Küche" = [0, 0], "東口" = [6, 0], "<b>&" = [0, 6], "a b" = [6, 6], "x:y" = [12, 6] }
hallways = [
    { from = "Küche", to = "東口" }, { from = "Küche", to = "<b>&" }, { from = "東口", to = "a b" },
    { from = "<b>&", to = "a b" }, { from = "a b", to = "x:y" },
]
start = { at = "Küche", facing = "<b>&" }
"#;

#[test]
fn a_world_keeps_its_names_in_every_format_page_and_report() {
    let scratch = Scratch::new("names_in_formats");
    scratch.write("東 plan.toml", PLAN);
    let world = read_world(&scratch.path("東 plan.toml"));
    assert_eq!(world.vertex_names, ["Küche", "東口", "<b>&", "a b", "x:y"]);
    scratch.write("w.json", world_file::to_json_text(&world));
    assert_eq!(read_world(&scratch.path("w.json")), world);
    assert_eq!(world_file::read(world_file::to_toml(&world).as_bytes()).unwrap(), world);
    let dot = scratch.out("draw '東 plan.toml' --format dot", 0);
    assert!(dot.contains("\"Küche\"") && dot.contains("\"<b>&amp;\"") && dot.contains("\"x:y\""));
    let svg = scratch.out("draw '東 plan.toml'", 0);
    assert!(svg.contains("Küche") && svg.contains("&lt;b&gt;&amp;") && !svg.contains("<b>"));
    for start in ["Küche:東口", "東口:a b", "<b>&:Küche", "a b:x:y", "x:y:a b"] {
        let explore = format!("explore '東 plan.toml' --start '{start}'");
        facts! { scratch; explore => 0 { "isomorphic": true }; }
    }
    let run = "--log 東.mcap --html run.html --svg run.svg";
    let reports = "--html conform.html --junit j.xml --sarif s.sarif";
    facts! { scratch;
        "draw '東 plan.toml' -o w.png" => 0;
        "explore '東 plan.toml' --start 'Kuche:東口'" => 2
            "--start: there is no vertex `Kuche`; did you mean `Küche`?";
        format!("simulate '東 plan.toml' --by-scene --start '東口:a b' {run}") => 0;
        "compare '東 plan.toml' worlds/shape-6.toml --html walk.html" => 0;
        // The log's own start is read again.
        format!("conform 東.mcap --world '東 plan.toml' {reports}") => 0
            { "verdict": "conforms", "world.start": "東口:a b" };
    }
    for page in ["run.html", "run.svg", "walk.html", "conform.html"] {
        let text = scratch.text(page);
        assert!(!text.contains("<b>&") && !text.contains("<i>&"), "{page}");
        assert!(text.contains("東"), "{page}");
    }
    assert!(["j.xml", "s.sarif"].iter().all(|report| !scratch.text(report).contains("<b>&")));
}

/// `model` has each kind of these errors.
#[test]
fn an_error_in_a_world_has_line_and_column_and_is_one_line() {
    let scratch = Scratch::new("names_refused");
    for name in ["", "a/b", "a\\b", "it's", "\"a\"", "`a`", "a\u{7}", "a\n", " a", "a ", "\u{202e}"]
    {
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
