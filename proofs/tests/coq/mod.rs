//! The Coq development, where Coq is installed: that it holds, that it would not if it were broken, and
//! that its algorithms do the same as those of `toposlam-model` on the tested starts.
//!
//! `cargo test` ignores these tests: `.ci/run` runs them after a change of what they depend on, and `.ci/run --all`.

mod aids;
mod broken;
mod comparison;
mod figures;
mod folding;

use std::{
    fs::{self, File},
    ops::{ControlFlow, RangeInclusive},
    path::{Path, PathBuf},
    process::{Command, Output},
    sync::LazyLock,
};

use toposlam_model::{
    embedded_graph::EmbeddedGraph,
    enumerate::{Class, Each, Enumeration},
};

const OCAMLOPT: &str = "ocamlopt";

/// A file of the development.
fn source(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("coq").join(name)
}

/// A folder of ours under the target directory; what stood there is gone.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("coq").join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// What the script prints for a development that is compiled in a folder.
fn check(development: &Path, compiled: &Path) -> Output {
    let mut script = Command::new("bash");
    script.arg(source("check")).arg("--out").args([compiled, development]).output().unwrap()
}

/// The development as it stands, compiled; and the output of the script.
struct Compiled {
    folder: PathBuf,
    said: Output,
}

impl Compiled {
    /// A copy of it in a folder of ours, in which something may be changed.
    fn copy(&self, name: &str) -> PathBuf {
        let folder = folder(name);
        // With the times of the files, by which make sees what must be compiled again.
        printed(Command::new("cp").args(["-a", "."]).arg(&folder).current_dir(&self.folder));
        folder
    }
}

/// Where a program that is needed is missing: what, and how to install it.
static COMPILED: LazyLock<Result<Compiled, String>> = LazyLock::new(|| {
    let folder = folder("compiled");
    let said = check(&source(""), &folder);
    if said.status.code() == Some(2) {
        return Err(text(&said.stderr).trim_start_matches("error: ").to_owned());
    }
    match Command::new(OCAMLOPT).arg("-version").output() {
        Ok(_) => Ok(Compiled { folder, said }),
        Err(_) => Err(format!("there is no {OCAMLOPT}; on Debian: apt-get install ocaml-nox")),
    }
});

/// Extracts a program in a folder with the makefile of the development, builds it with the source that runs it, and
/// returns what it prints for these lines. An extraction is its target, its module and that source.
fn run_extracted(folder: &Path, extraction: [&str; 3], lines: &str) -> String {
    let [target, module, main] = extraction;
    printed(Command::new("make").arg(target).current_dir(folder));
    fs::copy(source(main), folder.join("main.ml")).unwrap();
    let program = folder.join("compare");
    let mut ocamlopt = Command::new(OCAMLOPT);
    ocamlopt.current_dir(folder).arg("-o").arg(&program);
    printed(ocamlopt.args([&format!("{module}.mli"), &format!("{module}.ml"), "main.ml"]));
    let input = folder.join("lines");
    fs::write(&input, lines).unwrap();
    printed(Command::new(program).stdin(File::open(input).unwrap()))
}

/// Panics where Coq, MathComp or OCaml is missing.
fn compiled() -> &'static Compiled {
    COMPILED.as_ref().unwrap_or_else(|missing| panic!("nothing was checked in Coq: {missing}"))
}

/// Every start of these sizes; its facing dart is dart 0.
fn starts(class: Class, sizes: RangeInclusive<usize>) -> Vec<EmbeddedGraph> {
    let mut starts = Vec::new();
    for edges in sizes {
        let _ = Enumeration::new(Each::Start, class, edges).unwrap().for_each(&mut |found| {
            starts.push(found.graph.clone());
            ControlFlow::Continue(())
        });
    }
    starts
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).trim_end().to_owned()
}

/// What a program printed; panics if it failed.
fn printed(command: &mut Command) -> String {
    let output = command.output().unwrap();
    assert!(output.status.success(), "{command:?}\n{}", text(&output.stderr));
    text(&output.stdout)
}

#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn the_theorems_hold_and_rest_on_no_axiom() {
    let Compiled { said, .. } = compiled();
    let (stdout, stderr) = (text(&said.stdout), text(&said.stderr));
    assert!(said.status.success(), "{stderr}\n{stdout}");
    let closed: Vec<_> =
        stdout.lines().filter_map(|line| line.strip_suffix(" closed")).map(str::trim).collect();
    let theorems: Vec<_> = toposlam_proofs::theorems::all().map(|theorem| theorem.name).collect();
    assert_eq!(closed, theorems);
}
