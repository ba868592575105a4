//! Opens pages in a browser, by scripts that drive a headless Chromium.
//!
//! Needs Node, a Chromium and playwright-core. Without them a test prints a message and is skipped, unless
//! `TOPOSLAM_BROWSER=required`.

use std::{
    env,
    ffi::OsStr,
    path::{Path, PathBuf},
    process::Command,
};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// The first of these programs that is installed.
fn program(names: &[&str]) -> Option<PathBuf> {
    let folders: Vec<_> = env::split_paths(&env::var_os("PATH")?).collect();
    let places = names.iter().flat_map(|name| folders.iter().map(move |folder| folder.join(name)));
    places.into_iter().find(|place| place.is_file())
}

const NO_NODE: &str = "there is no node; on Debian: apt-get install nodejs npm";

fn node() -> Option<PathBuf> {
    program(&["node", "nodejs"])
}

/// Node and a Chromium, or what is missing and how to install it.
fn browser() -> Result<(PathBuf, PathBuf), String> {
    let node = node().ok_or(NO_NODE)?;
    let chromium = program(&["chromium", "chromium-browser", "google-chrome"])
        .ok_or("there is no Chromium; on Debian: apt-get install chromium")?;
    let client = Path::new(ROOT).join("tests/browser/node_modules/playwright-core");
    if !client.is_dir() {
        return Err("there is no playwright-core; run: npm install --prefix tests/browser".into());
    }
    Ok((node, chromium))
}

/// Runs a script of this folder on pages, each with its kind, as in `alike=FILE`. Panics with the output of
/// the script if it fails.
pub(crate) fn open(script: &str, pages: &[String]) {
    let (node, chromium) = match browser() {
        Ok(found) => found,
        Err(missing) => {
            fail_if_required(&missing);
            return eprintln!("skipped, {script} opened no page in a browser: {missing}");
        }
    };
    let mut arguments = vec![chromium.as_os_str()];
    arguments.extend(pages.iter().map(OsStr::new));
    run(&node, script, &arguments);
}

/// Runs a script of this folder without a browser, and returns what it prints; `None` if there is no Node.
pub(crate) fn run_in_node(script: &str, arguments: &[&OsStr]) -> Option<String> {
    let Some(node) = node() else {
        fail_if_required(NO_NODE);
        eprintln!("skipped, {script} was not run: {NO_NODE}");
        return None;
    };
    Some(run(&node, script, arguments))
}

/// Panics if no test may be skipped.
fn fail_if_required(missing: &str) {
    let required = env::var("TOPOSLAM_BROWSER").is_ok_and(|value| value == "required");
    assert!(!required, "{missing}");
}

fn run(node: &Path, script: &str, arguments: &[&OsStr]) -> String {
    let script = Path::new(ROOT).join("tests/browser").join(script);
    let output = Command::new(node).arg(script).args(arguments).output().unwrap();
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{printed}{}", String::from_utf8_lossy(&output.stderr));
    printed
}
