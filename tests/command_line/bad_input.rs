//! Bad input: one message that names the file and the place, exit code 2, no panic, nothing written.

use super::{Scratch, names_in, stderr};

/// Runs the program and returns its error message, which is one line.
fn error_of(scratch: &Scratch, line: &str) -> String {
    let output = scratch.run(line);
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{line}: {message}");
    assert!(output.stdout.is_empty() && message.starts_with("error: "), "{line}: {message}");
    assert_eq!(message.matches("error:").count(), 1, "{line}: {message}");
    assert!(!message.contains("panicked"), "{line}: {message}");
    message
}

/// The messages themselves are in `tests/snapshots/world_files`.
#[test]
fn each_verb_has_the_same_message_for_a_file_that_is_not_a_world() {
    let scratch = Scratch::new("bad_worlds");
    scratch.write("caf\u{e9} \u{2603}.toml", " ");
    scratch.write("short.pc", b">>planar_code<<\x04\x02\x03");
    scratch.write("short.ec", b">>edge_code<<\x04\x00");
    scratch.write("none.pc", b">>planar_code<<");
    let before = scratch.written();
    let mut files = names_in(&scratch.path("fuzz/corpus/world_file"));
    files.retain(|name| name.starts_with("error-"));
    assert!(files.len() >= 16);
    let files = files.into_iter().map(|name| format!("fuzz/corpus/world_file/{name}"));
    for file in files.chain(before.clone()) {
        let message = error_of(&scratch, &format!("explore '{file}'"));
        assert!(message.starts_with(&format!("error: {file}: ")), "{message}");
        assert_eq!(message.lines().count(), 1, "{message}");
        for line in [
            format!("explore '{file}' --map worst.toml --svg worst.svg --json"),
            format!("check --from '{file}' --worst worst.toml"),
            format!("compare worlds/shape-6.toml '{file}'"),
            format!("draw '{file}'"),
        ] {
            assert_eq!(error_of(&scratch, &line), message, "{line}");
        }
        assert_eq!(scratch.written(), before, "{file}");
    }
}

#[test]
fn with_a_movable_marker_explore_and_check_reject_the_same_worlds() {
    let scratch = Scratch::new("bad_movable");
    for (explore, check) in [
        ("worlds/theta-torus.toml", "--from worlds/theta-torus.toml"),
        ("worlds/shape-6.toml --choices all", "--choices all"),
    ] {
        let message = error_of(&scratch, &format!("explore --marker movable {explore}"));
        assert_eq!(message, error_of(&scratch, &format!("check --marker movable {check}")));
    }
}

#[test]
fn no_input_causes_a_panic() {
    let scratch = Scratch::new("nasty");
    let deep = "[".repeat(100_000);
    let nasty: [&[u8]; 12] = [
        b"\0",
        b"\xef\xbb\xbf",
        b"{",
        b"{}",
        b"[]",
        b"null",
        b"[clockwise]",
        b"[doors]\na = []",
        b"clockwise = { a = [\"a\", \"a\"] }",
        b">>edge_code<<\x00\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff",
        b">>planar_code le<<\x00\xff\xff\x01\x00",
        deep.as_bytes(),
    ];
    for bytes in nasty {
        for name in ["w.toml", "w.json", "w.pc", "w.ec"] {
            scratch.write(name, bytes);
            error_of(&scratch, &format!("check --from {name}"));
            error_of(&scratch, &format!("explore {name}"));
        }
    }
    scratch.write("w.json", format!("{{\"name\":{deep}"));
    error_of(&scratch, "explore w.json");
}

#[cfg(not(feature = "ros1"))]
#[test]
fn without_ros_the_error_names_the_build_command() {
    let scratch = Scratch::new("no_ros");
    let master = "--ros http://127.0.0.1:11311";
    for verb in ["drive --calibration c.toml --colours d.toml", "simulate worlds/shape-6.toml"] {
        let message = error_of(&scratch, &format!("{verb} {master}"));
        assert!(message.contains("cargo build --release --features ros1"), "{message}");
    }
}
