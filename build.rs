//! Collects what the installed program prints about its sources: the citations of the paper in all
//! workspace members, for `toposlam paper`, and the git revision, for `toposlam --version`.

#[path = "src/paper/citation.rs"]
#[expect(unreachable_pub, reason = "the library makes it public")]
mod citation;

use std::{
    env, fs, io,
    path::{Path, PathBuf},
    process::{Command, ExitCode},
};

use citation::Citation;

fn main() -> ExitCode {
    match embed_citations().and_then(|()| embed_version()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("cannot collect what the program prints about its sources: {message}");
            ExitCode::FAILURE
        }
    }
}

/// The files and folders from which the program is built, besides the members.
const WATCHED: [&str; 4] = ["Cargo.toml", "build.rs", "src", "tests"];

/// Sets the environment variable of the library's version: the version of the package, and the git
/// revision as build metadata. Without git, or in a package outside of its repository, the version alone.
fn embed_version() -> Result<(), String> {
    let root = PathBuf::from(variable("CARGO_MANIFEST_DIR")?);
    let version = variable("CARGO_PKG_VERSION")?;
    let revision = revision(&root).map(|revision| format!("+{revision}")).unwrap_or_default();
    println!("cargo:rustc-env=TOPOSLAM_VERSION={version}{revision}");
    Ok(())
}

/// The revision of a git checkout. If a file of the program differs from it, `.modified` follows.
fn revision(root: &Path) -> Option<String> {
    // An unpacked package may lie in the checkout of something else.
    let top = PathBuf::from(git(root, &["rev-parse", "--show-toplevel"])?);
    if top.canonicalize().ok()? != root.canonicalize().ok()? {
        return None;
    }
    // The log of HEAD grows with every commit and checkout.
    let reference = git(root, &["symbolic-ref", "--quiet", "HEAD"]).unwrap_or_default();
    for changed in ["HEAD", "logs/HEAD", "packed-refs", &reference] {
        let path = git(root, &["rev-parse", "--git-path", changed]).map(|path| root.join(path));
        // Cargo would run this again and again for a file that does not exist.
        if let Some(path) = path.filter(|path| path.is_file()) {
            println!("cargo:rerun-if-changed={}", path.display());
        }
    }
    let revision = git(root, &["rev-parse", "--short=12", "HEAD"])?;
    let members = folder(root, "").ok()?.into_iter().filter(|name| is_member(root, name));
    let files: Vec<_> = WATCHED.into_iter().map(str::to_owned).chain(members).collect();
    let files: Vec<_> = files.iter().map(String::as_str).collect();
    let changes = git(root, &[&["status", "--porcelain", "--"], &files[..]].concat())?;
    Some(if changes.is_empty() { revision } else { revision + ".modified" })
}

/// What a git command prints, without the newline at its end. `None` if it fails.
fn git(root: &Path, arguments: &[&str]) -> Option<String> {
    let mut git = Command::new("git");
    let output = git.arg("--no-optional-locks").args(arguments).current_dir(root).output().ok()?;
    let text = String::from_utf8(output.stdout).ok().filter(|_| output.status.success())?;
    Some(text.trim_end().to_owned())
}

/// Whether a folder of the workspace is a member. Some are workspaces of their own.
fn is_member(root: &Path, name: &str) -> bool {
    let manifest = fs::read_to_string(root.join(name).join("Cargo.toml"));
    manifest.is_ok_and(|text| text.lines().all(|line| line != "[workspace]"))
}

/// Writes the value of the library's `CITATIONS`.
fn embed_citations() -> Result<(), String> {
    let root = PathBuf::from(variable("CARGO_MANIFEST_DIR")?);
    for watched in WATCHED {
        println!("cargo:rerun-if-changed={watched}");
    }
    let mut sources = Vec::new();
    find_sources(&root, "src", &mut sources)?;
    find_sources(&root, "tests", &mut sources)?;
    for member in folder(&root, "")? {
        if is_member(&root, &member) {
            println!("cargo:rerun-if-changed={member}");
            for part in ["src", "tests", "coq"].map(|part| format!("{member}/{part}")) {
                if root.join(&part).is_dir() {
                    find_sources(&root, &part, &mut sources)?;
                }
            }
        }
    }
    sources.sort();
    let mut constant = String::from("&[\n");
    for file in sources {
        let text = fs::read_to_string(root.join(&file)).map_err(|error| at(&file, &error))?;
        for citation in citation::citations(&file, &text) {
            constant += &literal(&citation);
        }
    }
    constant += "]\n";
    let out = Path::new(&variable("OUT_DIR")?).join("citations.rs");
    fs::write(&out, constant).map_err(|error| at(&out.display().to_string(), &error))
}

/// The citation as a Rust expression.
fn literal(citation: &Citation) -> String {
    let Citation { id, file, line, kind } = citation;
    format!(
        "Citation {{ id: {id:?}, file: {file:?}, line: {line}, kind: CitationKind::{kind:?} }},\n"
    )
}

/// Adds the Rust and Coq files in a folder of the workspace, recursively.
fn find_sources(root: &Path, folder_name: &str, sources: &mut Vec<String>) -> Result<(), String> {
    for name in folder(root, folder_name)? {
        let path = format!("{folder_name}/{name}");
        if root.join(&path).is_dir() {
            find_sources(root, &path, sources)?;
        } else if Path::new(&name).extension().is_some_and(|kind| kind == "rs" || kind == "v") {
            sources.push(path);
        }
    }
    Ok(())
}

/// The names in a folder of the workspace.
fn folder(root: &Path, folder_name: &str) -> Result<Vec<String>, String> {
    fs::read_dir(root.join(folder_name))
        .and_then(Iterator::collect::<io::Result<Vec<_>>>)
        .map(|entries| {
            entries.iter().map(|entry| entry.file_name().to_string_lossy().into_owned()).collect()
        })
        .map_err(|error| at(folder_name, &error))
}

fn variable(name: &str) -> Result<String, String> {
    env::var(name).map_err(|error| format!("{name}: {error}"))
}

fn at(place: &str, error: &io::Error) -> String {
    format!("{place}: {error}")
}
