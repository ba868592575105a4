//! That the harnesses have the right types, against a stand-in that proves nothing.

use std::{
    collections::BTreeSet,
    env, fs,
    path::{Path, PathBuf},
    process::{Command, Output},
    sync::LazyLock,
};

use super::{here, scratch, table, within};

fn rustc() -> Command {
    let mut rustc = Command::new(env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()));
    rustc.args(["--edition", "2024", "-D", "warnings"]);
    rustc
}

/// Runs the compiler, and answers what it says if it refuses.
fn run(rustc: &mut Command) -> Result<(), String> {
    let Output { status, stderr, .. } = rustc.output().unwrap();
    if status.success() { Ok(()) } else { Err(String::from_utf8(stderr).unwrap()) }
}

/// The folder of the stand-in, and what cargo made of the crates that the library uses, with their names.
static DEPENDENCIES: LazyLock<(PathBuf, [(&str, PathBuf); 3])> = LazyLock::new(|| {
    let folder = scratch("stand_in");
    let crates = [
        ("kani_macros", "macros.rs", "proc-macro", "proc_macro"),
        ("kani", "kani.rs", "lib", "kani_macros"),
    ];
    for (name, source, kind, dependency) in crates {
        let made = run(rustc()
            .args(["--crate-name", name, "--crate-type", kind, "--extern", dependency])
            .args(["--out-dir".as_ref(), folder.as_os_str(), "-L".as_ref(), folder.as_os_str()])
            .arg(here("kani").join(source)));
        made.unwrap_or_else(|said| panic!("{said}"));
    }
    // Only the last crate is compiled for Kani: others have `cfg(kani)` of their own.
    let cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| env!("CARGO").into()))
        .args(["check", "--lib", "-p", "toposlam-model", "--locked", "--offline"])
        .args(["--message-format", "json", "--target-dir"])
        .arg(scratch("model"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    assert!(cargo.status.success(), "{}", String::from_utf8(cargo.stderr).unwrap());
    let messages = String::from_utf8(cargo.stdout).unwrap();
    let crates = ["toposlam_model", "serde", "thiserror"].map(|name| {
        let file = format!("/lib{name}-");
        let made = |word: &&str| word.contains(&file) && word.contains(".rmeta");
        (name, PathBuf::from(messages.split('"').find(made).expect("cargo says what it made")))
    });
    (folder, crates)
});

/// Checks the types of the library in this folder as Kani would have it compiled, and returns its harnesses.
fn compile(library: &Path, output: &Path) -> Result<BTreeSet<String>, String> {
    let (stand_in, crates) = &*DEPENDENCIES;
    let others = crates[0].1.parent().unwrap();
    let externs = crates
        .iter()
        .flat_map(|(name, file)| ["--extern".to_owned(), format!("{name}={}", file.display())]);
    run(rustc()
        .args(["--crate-name", "toposlam_proofs", "--crate-type", "lib", "-F", "unsafe_code"])
        .args(["--cfg", "kani", "--check-cfg", "cfg(kani, test)", "--extern", "kani"])
        .args(["--check-cfg", "cfg(feature, values(\"symbolic\"))"])
        .arg("-L")
        .arg(stand_in)
        .args(externs)
        .arg("-L")
        .arg(format!("dependency={}", others.display()))
        .args(["--emit", "dep-info,metadata", "--out-dir"])
        .arg(output)
        .arg(library.join("lib.rs")))?;
    let noted = fs::read_to_string(output.join("toposlam_proofs.d")).unwrap();
    let marked = noted.lines().filter_map(|line| line.strip_prefix("# env-dep:kani::proof "));
    Ok(marked.map(|path| within(path).to_owned()).collect())
}

/// Where the sources of a copy of the library are.
fn sources(name: &str) -> PathBuf {
    scratch(&format!("{name}/src"))
}

/// Compiles a copy of the library in which one file is otherwise.
fn compile_with(
    name: &str,
    file: &str,
    change: impl FnOnce(&str) -> String,
) -> Result<BTreeSet<String>, String> {
    let copy = sources(name);
    let source = here("src");
    for folder in ["", "lemmas"] {
        fs::create_dir_all(copy.join(folder)).unwrap();
        for entry in fs::read_dir(source.join(folder)).unwrap() {
            let entry = entry.unwrap();
            if entry.file_type().unwrap().is_file() {
                fs::copy(entry.path(), copy.join(folder).join(entry.file_name())).unwrap();
            }
        }
    }
    let text = fs::read_to_string(source.join(file)).unwrap();
    let changed = change(&text);
    assert_ne!(changed, text, "there is something to change");
    fs::write(copy.join(file), changed).unwrap();
    // The library includes it, and finds it beside its sources.
    let theorems = scratch(&format!("{name}/coq")).join("Theorems.v");
    fs::copy(here("coq/Theorems.v"), theorems).unwrap();
    compile(&copy, &copy)
}

/// Sees that the library with this change is refused, for this reason, in this file.
fn refused(name: &str, file: &str, old: &str, new: &str, reason: &str) {
    let said = compile_with(name, file, |text| text.replacen(old, new, 1)).unwrap_err();
    let place = format!("--> {}:", sources(name).join(file).display());
    let lines: Vec<_> = said.lines().collect();
    let there = |pair: &[&str]| pair[0] == reason && pair[1].trim().starts_with(&place);
    assert!(lines.windows(2).any(there), "{said}");
}

#[test]
#[ignore = "it compiles the model again: `.ci/run`"]
fn the_harnesses_of_the_table_compile_and_there_are_no_others() {
    let compiled = compile(&here("src"), &scratch("library"));
    let compiled = compiled.unwrap_or_else(|said| panic!("{said}"));
    assert!(compiled.iter().eq(table().keys()), "{compiled:?}");
}

#[test]
#[ignore = "it compiles the model again: `.ci/run`"]
fn a_lemma_that_does_not_fit_its_harness_is_noticed() {
    let (file, harness) = ("lemmas/decoders.rs", "only_read::<_, 5, 0>");
    let unfit = |text: &str| text.replace(harness, "crate::draw::byte");
    let said = compile_with("unfit_lemma", file, unfit).unwrap_err();
    assert!(said.starts_with("error[E0308]: mismatched types\n"), "{said}");
    let place = format!("::: {}:", sources("unfit_lemma").join(file).display());
    assert!(said.contains(&place), "{said}");
}

#[test]
#[ignore = "it compiles the model again: `.ci/run`"]
fn a_harness_that_does_not_come_up_is_missed() {
    let without = |text: &str| text.replace("#[kani::proof]", "#[cfg(any())]");
    assert_eq!(compile_with("lost", "lemma.rs", without), Ok(BTreeSet::new()));
}

#[test]
#[ignore = "it compiles the model again: `.ci/run`"]
fn a_cover_without_a_condition_is_refused() {
    refused("cover", "lemma.rs", "cover!(holds,", "cover!(1,", "error[E0308]: mismatched types");
}

#[test]
#[ignore = "it compiles the model again: `.ci/run`"]
fn a_symbol_of_a_type_that_kani_has_no_symbols_of_is_refused() {
    let reason = "error[E0277]: the trait bound `f64: Arbitrary` is not satisfied";
    refused("arbitrary", "symbolic.rs", "kani::any()", "kani::any::<f64>() as u8", reason);
}

#[test]
#[ignore = "it compiles the model again: `.ci/run`"]
fn a_warning_in_a_harness_is_refused() {
    let reason = "error: unused variable: `unused`";
    let driver = "let unused = 0; kani::assume(";
    refused("warning", "symbolic.rs", "kani::assume(", driver, reason);
}
