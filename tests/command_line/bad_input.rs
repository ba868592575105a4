//! Commands that need another build. Files that are no worlds are in `tests/facts/worlds.txt`.

use super::Scratch;

#[test]
fn the_error_of_a_build_without_a_feature_has_the_command_that_adds_it() {
    let scratch = Scratch::new("no_features");
    let ros = "--ros http://127.0.0.1:11311";
    let hosts = "--hosts hosts.txt --process 0";
    for (is_built, feature, line) in [
        (cfg!(feature = "ros1"), "ros1", format!("drive --calibration c --colours d {ros}")),
        (cfg!(feature = "ros1"), "ros1", format!("simulate worlds/shape-6.toml {ros}")),
        (cfg!(feature = "ros2"), "ros2", "drive --sensor laser --ros2".to_owned()),
        (cfg!(feature = "ros2"), "ros2", "simulate worlds/shape-6.toml --ros2".to_owned()),
        (cfg!(feature = "cluster"), "cluster", format!("check {hosts}")),
        (cfg!(feature = "cluster"), "cluster", format!("counterexample {hosts}")),
    ] {
        let build = format!("cargo build --release --features {feature}");
        assert!(is_built || scratch.error(&line).contains(&build), "{line}");
    }
}
