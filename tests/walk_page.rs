//! The walk page in a browser. Section 2.2, Figure 1: a random walk in its two worlds shows the same
//! percepts in both as long as the marker does not point. With a directional marker a walk distinguishes
//! them.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::{
    path::{Path, PathBuf},
    process::Command,
};

use crate::browser;

/// Writes the page of Figure 1 with this marker.
fn write_page(marker: &str) -> PathBuf {
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("figure-1-{marker}.html"));
    let output = Command::new(env!("CARGO_BIN_EXE_toposlam"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(["compare", "worlds/figure-1a.toml", "worlds/figure-1b.toml", "--marker", marker])
        .arg("--html")
        .arg(&file)
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    file
}

#[test]
fn the_percepts_of_figure_1_are_equal_until_the_marker_points() {
    let pages = [
        ("undirected", "alike"),
        ("undirected-edge", "apart"),
        ("directed-edge", "apart"),
        ("directional", "apart"),
        ("two-distinct", "apart"),
        ("movable", "apart"),
    ]
    .map(|(marker, result)| format!("{result}={}", write_page(marker).display()));
    browser::open("walk_page.mjs", &pages);
}
