//! A copy of the repository with all mutants of a package, and the test programs of this copy.

use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::Package;
use crate::site::{self, Site};
use crate::switched::{self, Placed};

/// One change of one place.
#[derive(Clone)]
pub struct Mutant {
    pub file: String,
    pub line: usize,
    /// `FUNCTION: CHANGE`.
    pub change: String,
    /// Whether the compiler accepts it.
    pub compiles: bool,
}

impl Mutant {
    /// What the list of equivalent mutants names.
    pub fn name(&self) -> String {
        format!("{}: {}", self.file, self.change)
    }
}

pub struct TestProgram {
    pub path: PathBuf,
    pub folder: PathBuf,
    /// Whether it tests the whole program, and not one crate.
    pub is_of_program: bool,
}

pub struct Build {
    pub mutants: Vec<Mutant>,
    pub programs: Vec<TestProgram>,
}

struct File {
    path: String,
    source: String,
    sites: Vec<Site>,
    /// The number of the first mutant of each site.
    first: Vec<usize>,
    placed: Vec<Placed>,
}

/// Compiles mutants of a package, by their indices, and its tests.
///
/// # Errors
///
/// Returns an error if the copy cannot be written, or does not compile without mutants.
pub fn build(package: &Package, selected: &[usize]) -> Result<Build, Box<dyn Error>> {
    let Package { name, folder, tests, .. } = package;
    let copy = PathBuf::from(format!("target/mutants/{name}"));
    copy_repository(folder, &copy)?;
    let (mut files, mut mutants) = find_mutants(package)?;
    let mut is_selected = vec![false; mutants.len()];
    selected.iter().for_each(|&mutant| is_selected[mutant] = true);
    let module = include_str!("switch.rs")
        .replace("[AtomicBool; COUNT]", &format!("[AtomicBool; {}]", mutants.len()));
    let module = module.replace("; COUNT]", &format!("; {}]", mutants.len()));
    write(&copy.join(folder).join("src/mutant_switch.rs"), &module)?;
    loop {
        for file in &mut files {
            let number = |site: usize, change: usize| {
                let number = file.first[site] + change;
                (is_selected[number] && mutants[number].compiles).then_some(number as u32)
            };
            let (mut text, placed) = switched::switched(&file.source, &file.sites, number);
            if file.path == format!("{folder}/src/lib.rs") {
                text.push_str("\n#[rustfmt::skip]\nmod mutant_switch;\n");
            }
            file.placed = placed;
            write(&copy.join(&file.path), &text)?;
        }
        let errors = match cargo(&copy, &["check", "-p", &format!("toposlam-{folder}"), "--lib"])? {
            Ok(_) => match cargo(&copy, &[&["test", "--no-run"], *tests].concat())? {
                Ok(programs) => return Ok(Build { mutants, programs }),
                Err(errors) => errors,
            },
            Err(errors) => errors,
        };
        let rejected = rejected(&files, &errors);
        if rejected.is_empty() {
            let texts: Vec<_> = errors.into_iter().map(|error| error.text).collect();
            return Err(texts.join("\n").into());
        }
        eprintln!("{} mutants do not compile; again without them", rejected.len());
        for mutant in rejected {
            mutants[mutant].compiles = false;
        }
    }
}

/// Copies the files under version control, without the files that are written with mutants.
fn copy_repository(folder: &str, to: &Path) -> Result<(), Box<dyn Error>> {
    let listed = Command::new("git")
        .args(["ls-files", "-z", "--cached", "--others", "--exclude-standard"])
        .output()?;
    for path in String::from_utf8(listed.stdout)?.split_terminator('\0') {
        let is_switched = path.ends_with(".rs") && path.starts_with(&format!("{folder}/src/"));
        // A file that was removed may still be listed.
        if !is_switched && let Ok(content) = fs::read(path) {
            write_bytes(&to.join(path), &content)?;
        }
    }
    Ok(())
}

fn write(path: &Path, text: &str) -> std::io::Result<()> {
    write_bytes(path, text.as_bytes())
}

/// Files that stay the same keep their time, so that Cargo does not compile them again.
fn write_bytes(path: &Path, content: &[u8]) -> std::io::Result<()> {
    if fs::read(path).is_ok_and(|old| old == content) {
        return Ok(());
    }
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)?;
    }
    fs::write(path, content)
}

/// The mutants of a package, whether they compile or not.
///
/// # Errors
///
/// Returns an error if a file cannot be read, or is not Rust.
pub fn mutants(package: &Package) -> Result<Vec<Mutant>, Box<dyn Error>> {
    find_mutants(package).map(|(_, mutants)| mutants)
}

/// The files of a package and their mutants. Those that only tests contain have none.
fn find_mutants(package: &Package) -> Result<(Vec<File>, Vec<Mutant>), Box<dyn Error>> {
    let mut sources = BTreeMap::new();
    read_sources(Path::new(&format!("{}/src", package.folder)), &mut sources)?;
    let mut of_tests = BTreeSet::new();
    for (path, source) in &sources {
        let folder = match path.file_stem().and_then(|stem| stem.to_str()) {
            Some("lib" | "mod") | None => path.with_file_name(""),
            _ => path.with_extension(""),
        };
        of_tests.extend(site::test_modules(source).into_iter().map(|name| folder.join(name)));
    }
    let (mut files, mut mutants) = (Vec::new(), Vec::new());
    for (path, source) in sources {
        let is_of_tests = of_tests
            .iter()
            .any(|module| path.starts_with(module) || path == module.with_extension("rs"));
        let name =
            path.to_str().ok_or_else(|| format!("{}: its name is not UTF-8", path.display()));
        let path = name?.to_owned();
        let is_examined = !is_of_tests && (package.has)(&path);
        let sites = if is_examined { site::sites(&source)? } else { Vec::new() };
        let mut first = Vec::new();
        for site in &sites {
            first.push(mutants.len());
            mutants.extend(site.changes.iter().map(|change| Mutant {
                file: path.clone(),
                line: site.line,
                change: format!("{}: {}", site.function, change.name),
                compiles: true,
            }));
        }
        files.push(File { path, source, sites, first, placed: Vec::new() });
    }
    Ok((files, mutants))
}

fn read_sources(folder: &Path, sources: &mut BTreeMap<PathBuf, String>) -> std::io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            read_sources(&path, sources)?;
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            sources.insert(path.clone(), fs::read_to_string(&path)?);
        }
    }
    Ok(())
}

struct CompilerError {
    /// Files and ranges, the most important ones first.
    places: Vec<(String, Range<usize>)>,
    text: String,
}

/// Runs Cargo in the copy, and returns the test programs or the errors.
fn cargo(
    copy: &Path,
    arguments: &[&str],
) -> Result<Result<Vec<TestProgram>, Vec<CompilerError>>, Box<dyn Error>> {
    let target = std::env::current_dir()?.join("target/mutants/build");
    let output = Command::new("cargo")
        .args(arguments)
        .args(["--profile", "once", "--message-format", "json", "--locked"])
        .env("CARGO_TARGET_DIR", target)
        // A lint does not catch a mutant.
        .env("RUSTFLAGS", "--cap-lints=warn")
        .current_dir(copy)
        .output()?;
    let (mut programs, mut errors) = (Vec::new(), Vec::new());
    for line in String::from_utf8(output.stdout)?.lines() {
        let line: serde_json::Value = serde_json::from_str(line)?;
        let message = &line["message"];
        if line["reason"] == "compiler-artifact" && line["profile"]["test"] == true {
            if let Some(path) = line["executable"].as_str() {
                let folder =
                    line["manifest_path"].as_str().and_then(|path| Path::new(path).parent());
                let folder = folder.ok_or("Cargo does not name the manifest of a test program")?;
                let (path, folder) = (path.into(), folder.to_owned());
                let is_of_program = folder == fs::canonicalize(copy)?;
                programs.push(TestProgram { path, folder, is_of_program });
            }
        } else if line["reason"] == "compiler-message" && message["level"] == "error" {
            errors.push(compiler_error(message));
        }
    }
    if output.status.success() {
        return Ok(Ok(programs));
    }
    if errors.is_empty() {
        return Err(String::from_utf8_lossy(&output.stderr).into());
    }
    Ok(Err(errors))
}

fn compiler_error(message: &serde_json::Value) -> CompilerError {
    let mut places = Vec::new();
    let mut messages = vec![message];
    while let Some(message) = messages.pop() {
        let mut spans: Vec<_> = message["spans"].as_array().into_iter().flatten().collect();
        spans.sort_by_key(|span| span["is_primary"] != true);
        for span in spans {
            let byte = |key: &str| span[key].as_u64().unwrap_or_default() as usize;
            let file = span["file_name"].as_str().unwrap_or_default().to_owned();
            places.push((file, byte("byte_start")..byte("byte_end")));
        }
        messages.extend(message["children"].as_array().into_iter().flatten());
    }
    CompilerError { places, text: message["rendered"].as_str().unwrap_or_default().to_owned() }
}

/// The mutants that the errors are about: for each error the change in which it is, or else all of the smallest switch
/// around it.
fn rejected(files: &[File], errors: &[CompilerError]) -> BTreeSet<usize> {
    let mut rejected = BTreeSet::new();
    for error in errors {
        let found = error.places.iter().find_map(|(name, range)| {
            let file = files.iter().find(|file| file.path == *name)?;
            let around = |placed: &&Placed| {
                placed.range.start <= range.start && range.end <= placed.range.end
            };
            let within = |placed: &&Placed| {
                placed.change.is_some()
                    && range.start <= placed.range.start
                    && placed.range.end <= range.end
            };
            let smallest =
                file.placed.iter().filter(around).min_by_key(|placed| placed.range.len());
            let placed = smallest.or_else(|| file.placed.iter().find(within))?;
            let first = file.first[placed.site];
            Some(match placed.change {
                Some(change) => first + change..first + change + 1,
                None => first..first + file.sites[placed.site].changes.len(),
            })
        });
        rejected.extend(found.into_iter().flatten());
    }
    rejected
}
