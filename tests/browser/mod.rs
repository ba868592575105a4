//! Opens pages in a browser, by scripts that drive a headless Chromium.
//!
//! Needs Node, a Chromium and playwright-core. Without them a test prints a message and is skipped, unless
//! `TOPOSLAM_BROWSER=required`.

use std::{
    env,
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

/// Node and a Chromium, or what is missing and how to install it.
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

/// Runs a script of this folder on pages, each with its kind, as in `alike=FILE`. Panics with the output of
/// the script if it fails.
pub(crate) fn open(script: &str, pages: &[String]) {
    let (node, chromium) = match browser() {
        Ok(found) => found,
        Err(missing) => {
            let required = env::var("TOPOSLAM_BROWSER").is_ok_and(|wish| wish == "required");
            assert!(!required, "{missing}");
            eprintln!("skipped, {script} opened no page in a browser: {missing}");
            return;
        }
    };
    let output = Command::new(node)
        .arg(Path::new(ROOT).join("tests/browser").join(script))
        .arg(chromium)
        .args(pages)
        .output()
        .unwrap();
    let said = [output.stdout, output.stderr].concat();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&said));
}
