//! Collects the citations of the paper from the sources of all workspace members, so that the installed
//! `toposlam paper` can list them.

#[path = "src/paper/citation.rs"]
#[expect(unreachable_pub, reason = "the library makes it public")]
mod citation;

use std::{
    env, fs, io,
    path::{Path, PathBuf},
    process::ExitCode,
};

use citation::Citation;

fn main() -> ExitCode {
    match embed_citations() {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("cannot collect the citations of the paper: {message}");
            ExitCode::FAILURE
        }
    }
}

/// Writes the value of the library's `CITATIONS`.
fn embed_citations() -> Result<(), String> {
    let root = PathBuf::from(variable("CARGO_MANIFEST_DIR")?);
    for watched in ["Cargo.toml", "build.rs", "src", "tests"] {
        println!("cargo:rerun-if-changed={watched}");
    }
    let mut sources = Vec::new();
    find_sources(&root, "src", &mut sources)?;
    find_sources(&root, "tests", &mut sources)?;
    for member in folder(&root, "")? {
        if root.join(&member).join("Cargo.toml").is_file() {
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
