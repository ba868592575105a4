//! Bad input: one message, exit code 2, no panic. Files that are no worlds are in `tests/facts/worlds.txt`.

use super::Scratch;

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
            facts! { scratch;
                format!("check --from {name}") => 2 "";
                format!("explore {name}") => 2 "";
            }
        }
    }
    scratch.write("w.json", format!("{{\"name\":{deep}"));
    facts! { scratch; "explore w.json" => 2 ""; }
}

#[test]
fn the_error_of_a_build_without_a_feature_has_the_command_that_adds_it() {
    let scratch = Scratch::new("no_features");
    let ros = "--ros http://127.0.0.1:11311";
    let hosts = "--hosts hosts.txt --process 0";
    for (is_built, feature, line) in [
        (cfg!(feature = "ros1"), "ros1", format!("drive --calibration c --colours d {ros}")),
        (cfg!(feature = "ros1"), "ros1", format!("simulate worlds/shape-6.toml {ros}")),
        (cfg!(feature = "cluster"), "cluster", format!("check {hosts}")),
        (cfg!(feature = "cluster"), "cluster", format!("counterexample {hosts}")),
    ] {
        let build = format!("cargo build --release --features {feature}");
        assert!(is_built || scratch.error(&line).contains(&build), "{line}");
    }
}
