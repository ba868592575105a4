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

use crate::{printed, repository};

/// The first of these programs that is installed. Without one, a message names the script that is skipped.
fn program(names: &[&str], script: &str, install: &str) -> Option<PathBuf> {
    let folders: Vec<_> = env::split_paths(&env::var_os("PATH")?).collect();
    let places = names.iter().flat_map(|name| folders.iter().map(move |folder| folder.join(name)));
    let found = places.into_iter().find(|place| place.exists());
    let required = env::var("TOPOSLAM_BROWSER").is_ok_and(|value| value == "required");
    assert!(found.is_some() || !required, "there is no {}; {install}", names[0]);
    if found.is_none() {
        eprintln!("skipped, {script} was not run: there is no {}; {install}", names[0]);
    }
    found
}

/// Runs a script of this folder on pages, each with its kind, as in `alike=FILE`. Panics with the output of
/// the script if it fails.
pub(crate) fn open(script: &str, pages: &[String]) {
    let chromium = ["chromium", "chromium-browser", "google-chrome"];
    let client = repository("tests/browser/node_modules/playwright-core");
    let install = "run: npm install --prefix tests/browser";
    let found = program(&[client.to_str().unwrap()], script, install)
        .and_then(|_| program(&chromium, script, "on Debian: apt-get install chromium"));
    if let Some(chromium) = found {
        let pages = pages.iter().map(OsStr::new);
        run_in_node(script, &[chromium.as_os_str()].into_iter().chain(pages).collect::<Vec<_>>());
    }
}

/// Runs a script of this folder, and returns what it prints; `None` if there is no Node.
pub(crate) fn run_in_node(script: &str, arguments: &[&OsStr]) -> Option<String> {
    let node = program(&["node", "nodejs"], script, "on Debian: apt-get install nodejs npm")?;
    let script = Path::new("tests/browser").join(script);
    Some(printed(Command::new(node).current_dir(repository("")).arg(script).args(arguments)))
}
