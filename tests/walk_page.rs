//! The walk page in a browser. Section 2.2, Figure 1: a random walk in its two worlds shows the same
//! percepts in both as long as the marker does not point; with a directional marker a walk tells
//! them apart.
//!
//! Needs Node, a Chromium and playwright-core; without them the test says so and is skipped, unless
//! `TOPOSLAM_BROWSER=required`.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::{
    env,
    path::{Path, PathBuf},
    process::Command,
};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// Writes the page of Figure 1 with this marker.
fn write_page(marker: &str) -> PathBuf {
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("figure-1-{marker}.html"));
    let output = Command::new(env!("CARGO_BIN_EXE_toposlam"))
        .current_dir(ROOT)
        .args(["compare", "worlds/figure-1a.toml", "worlds/figure-1b.toml", "--marker", marker])
        .arg("--html")
        .arg(&file)
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    file
}

/// The first of these programs that there is.
fn program(names: &[&str]) -> Option<PathBuf> {
    let folders: Vec<_> = env::split_paths(&env::var_os("PATH")?).collect();
    let places = names.iter().flat_map(|name| folders.iter().map(move |folder| folder.join(name)));
    places.into_iter().find(|place| place.is_file())
}

/// Node and a Chromium; or what is missing and how to install it.
fn browser() -> Result<(PathBuf, PathBuf), String> {
    let node = program(&["node", "nodejs"])
        .ok_or("there is no node; on Debian: apt-get install nodejs npm")?;
    let chromium = program(&["chromium", "chromium-browser", "google-chrome"])
        .ok_or("there is no Chromium; on Debian: apt-get install chromium")?;
    let client = Path::new(ROOT).join("tests/browser/node_modules/playwright-core");
    if !client.is_dir() {
        return Err("there is no playwright-core; run: npm install --prefix tests/browser".into());
    }
    Ok((node, chromium))
}

#[test]
fn the_percepts_of_figure_1_stay_equal_until_the_marker_points() {
    let pages = [
        ("undirected", "alike"),
        ("undirected-edge", "apart"),
        ("directed-edge", "apart"),
        ("directional", "apart"),
        ("two-distinct", "apart"),
        ("movable", "apart"),
    ]
    .map(|(marker, told)| format!("{told}={}", write_page(marker).display()));
    let (node, chromium) = match browser() {
        Ok(found) => found,
        Err(missing) => {
            let required = env::var("TOPOSLAM_BROWSER").is_ok_and(|wish| wish == "required");
            assert!(!required, "{missing}");
            eprintln!("skipped, the walk page was not opened in a browser: {missing}");
            return;
        }
    };
    let output = Command::new(node)
        .arg(Path::new(ROOT).join("tests/browser/walk_page.mjs"))
        .arg(chromium)
        .args(pages)
        .output()
        .unwrap();
    let said = [output.stdout, output.stderr].concat();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&said));
}
