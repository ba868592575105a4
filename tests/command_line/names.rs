//! What is not a name. Names are in `tests/facts/names.txt`.

use super::Scratch;

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
