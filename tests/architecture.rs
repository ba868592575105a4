//! Rules on the sources that neither Cargo nor clippy enforces.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::Path,
};

use crate::{read, repository};

/// The folders with the modules of each crate. Python's extension module is a workspace of its own.
const CRATES: &str = "model/src vision/src logs/src robot/src conform/src simulator/src draw/src terminal/src \
                      proofs/src cluster/src src/cli python/src";

/// A source file: the names of its module below the folder of its crate, and its text without comments and without
/// items for tests.
struct Source {
    file: String,
    module: Vec<String>,
    text: String,
}

/// The sources in a folder of a crate, without those for tests.
fn sources(folder: &str, module: &[String]) -> Vec<Source> {
    let mut found = Vec::new();
    for entry in fs::read_dir(repository(folder)).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        let (stem, file) = (name.trim_end_matches(".rs"), format!("{folder}/{name}"));
        let module = match stem {
            "tests" => continue,
            "mod" | "lib" | "main" => module.to_vec(),
            _ => [module, &[stem.to_owned()]].concat(),
        };
        if repository(&file).is_dir() {
            found.extend(sources(&file, &module));
        } else if stem != name {
            found.push(Source { text: without_tests(&read(&file)), file, module });
        }
    }
    found
}

/// The lines of formatted code, without comments and without items for tests.
fn without_tests(source: &str) -> String {
    let mut kept = String::new();
    let mut lines = source.lines();
    while let Some(line) = lines.next() {
        if line == "#[cfg(test)]" {
            let item = lines.find(|line| !line.starts_with("#[")).unwrap_or_default();
            if item.ends_with('{') {
                lines.find(|line| line.starts_with('}'));
            }
        } else if !line.trim_start().starts_with("//") {
            kept.extend([line, "\n"]);
        }
    }
    kept
}

/// The name with which a text begins.
fn name(text: &str) -> &str {
    text.split(|letter: char| !letter.is_alphanumeric() && letter != '_').next().unwrap()
}

/// The names behind each place where paths begin: of `b::c` it is `b`, and of `{b::c, d}` they are `b` and `d`.
fn names_behind<'t>(text: &'t str, beginning: &str) -> BTreeSet<&'t str> {
    let mut names = BTreeSet::new();
    for path in text.split(beginning).skip(1) {
        let Some(list) = path.strip_prefix('{') else {
            names.insert(name(path));
            continue;
        };
        let mut depth = 0;
        for part in list.split_inclusive(['{', '}', ',']) {
            if depth == 0 {
                names.insert(name(part.trim_start()));
            }
            depth += i32::from(part.ends_with('{')) - i32::from(part.ends_with('}'));
            if depth < 0 {
                break;
            }
        }
    }
    names
}

/// The modules of a crate on which each of them depends, its own name aside.
fn dependencies(folder: &str) -> BTreeMap<String, BTreeSet<String>> {
    let beginning = if folder == "src/cli" { "crate::cli::" } else { "crate::" };
    let mut modules: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    let sources = sources(folder, &[]);
    for Source { module, text, .. } in &sources {
        let Some(top) = module.first() else { continue };
        let up = "super::".repeat(module.len());
        let names = names_behind(text, beginning).into_iter().chain(names_behind(text, &up));
        let others = names.filter(|name| name != top).map(str::to_owned);
        modules.entry(top.clone()).or_default().extend(others);
    }
    let known: BTreeSet<_> = modules.keys().cloned().collect();
    for names in modules.values_mut() {
        names.retain(|name| known.contains(name));
    }
    modules
}

#[test]
fn no_modules_of_a_crate_depend_on_each_other() {
    for folder in CRATES.split(' ') {
        let mut left = dependencies(folder);
        assert!(left.values().any(|below| !below.is_empty()), "{folder}: no imports were found");
        while let Some(name) =
            left.iter().find(|(_, below)| below.is_empty()).map(|(name, _)| name.clone())
        {
            left.remove(&name);
            for below in left.values_mut() {
                below.retain(|other| *other != name);
            }
        }
        assert!(left.is_empty(), "{folder}: circles of imports: {left:?}");
    }
}

#[test]
fn the_modules_of_the_model_import_only_from_those_that_are_listed_before_them() {
    let text = read("CONTRIBUTING.md");
    let (_, list) = text.split_once("The modules of `model/src`, bottom up:").unwrap();
    let order: Vec<_> = list.split('.').next().unwrap().split('`').skip(1).step_by(2).collect();
    let root = read("model/src/lib.rs");
    let listed = root.lines().filter_map(|line| line.strip_prefix("//! * [`")?.split('`').next());
    assert_eq!(listed.collect::<Vec<_>>(), order, "model/src/lib.rs");
    let public = root.lines().filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';'));
    assert_eq!(public.collect::<BTreeSet<_>>(), order.iter().copied().collect());
    // What is not listed is private, and below all others.
    let place = |name: &str| order.iter().position(|listed| *listed == name);
    for (name, below) in dependencies("model/src") {
        let later =
            below.iter().find(|other| place(&name).is_some() && place(other) > place(&name));
        assert_eq!(later, None, "{name}");
    }
}

/// One way to do a thing has one name. The classes of Python have the names of what they wrap.
#[test]
fn no_public_type_name_is_used_twice() {
    let mut files: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for folder in CRATES.split(' ').filter(|folder| *folder != "python/src") {
        for Source { file, text, .. } in sources(folder, &[]) {
            for line in text.lines().filter_map(|line| line.trim_start().strip_prefix("pub")) {
                let item = line.split_once(") ").filter(|_| line.starts_with('('));
                let item = item.map_or(line, |(_, item)| item).trim_start();
                let Some((kind, rest)) = item.split_once(' ') else { continue };
                // In a macro, a type has no name.
                let is_named = !name(rest).is_empty();
                if is_named && ["struct", "enum", "trait", "type", "union"].contains(&kind) {
                    files.entry(name(rest).to_owned()).or_default().push(file.clone());
                }
            }
        }
    }
    assert!(files.len() > 300, "types were not found");
    files.retain(|_, files| files.len() > 1);
    assert!(files.is_empty(), "one name for several types: {files:#?}");
}

/// The commands read and write files only where no output can replace an input.
#[test]
fn the_commands_open_no_files_past_the_check_of_names() {
    const PAST_THE_CHECK: [&str; 9] = [
        "fs::read(",
        "fs::read_to_string(",
        "fs::write(",
        "fs::copy(",
        "fs::rename(",
        "File::open(",
        "File::create(",
        "OpenOptions",
        "Log::open(",
    ];
    let sources = sources("src/cli", &[]);
    assert!(sources.len() > 40);
    for Source { file, module, text } in sources {
        let is_check =
            module.last().is_some_and(|name| ["files", "input", "output"].contains(&&**name));
        // This one opens bytes.
        let text = text.replace("ImageFile::open(", "");
        let found = PAST_THE_CHECK.iter().find(|call| text.contains(*call));
        assert!(is_check || found.is_none(), "{file}: {found:?}");
    }
}

#[test]
fn every_test_file_belongs_to_a_test_program() {
    for package in ["logs", "model", "proofs", "simulator", "vision", "."] {
        let folder = repository(package).join("tests");
        let manifest = read(&format!("{package}/Cargo.toml"));
        let modules = read(&format!("{package}/tests/main.rs"));
        for entry in fs::read_dir(folder).unwrap() {
            let file = entry.unwrap().path();
            let name = file.file_stem().unwrap().to_str().unwrap();
            let has = |inside: &str| Path::exists(&file.join(inside));
            let is_test = file.extension().is_some_and(|kind| kind == "rs")
                || has("mod.rs")
                || has("main.rs");
            let is_listed = modules.contains(&format!("mod {name};\n"))
                || manifest.contains(&format!("name = \"{name}\"\n"));
            assert!(!is_test || name == "main" || is_listed, "{}", file.display());
        }
    }
}

/// The profile of a release build in a manifest: its settings, and those of each package.
fn release_profile(manifest: &str) -> [toml::Table; 2] {
    let mut manifest: toml::Table = read(manifest).parse().unwrap();
    let profile = manifest["profile"].as_table_mut().unwrap().remove("release").unwrap();
    let toml::Value::Table(mut profile) = profile else { panic!("not a table") };
    let Some(toml::Value::Table(packages)) = profile.remove("package") else { panic!("no table") };
    [profile, packages]
}

/// So it is as fast, and what both need is compiled once.
#[test]
fn the_python_package_is_optimised_as_the_program_is() {
    let [[python, its_packages], [program, packages]] =
        ["python/Cargo.toml", "Cargo.toml"].map(release_profile);
    assert_eq!(python, program);
    // What is between Python and the crates is in no program.
    for (name, settings) in its_packages.into_iter().filter(|(name, _)| name != "toposlam-python") {
        assert_eq!(Some(&settings), packages.get(&name), "{name}");
    }
}

/// Whether the documentation in a folder of sources has a block of Rust.
fn has_documented_code(folder: &Path) -> bool {
    fs::read_dir(folder).unwrap().any(|entry| {
        let path = entry.unwrap().path();
        if path.is_dir() {
            return has_documented_code(&path);
        }
        let text = fs::read_to_string(&path).unwrap_or_default();
        let fences = text.lines().filter_map(|line| {
            let line = line.trim_start();
            line.strip_prefix("//! ```").or(line.strip_prefix("/// ```"))
        });
        fences.step_by(2).any(|language| !["text", "sh", "toml", "json"].contains(&language))
    })
}

/// Running the documentation of a crate takes seconds, so it is off where there is no code to run.
#[test]
fn code_in_documentation_is_run() {
    for folder in CRATES.split_whitespace() {
        let sources = repository(folder.strip_suffix("/cli").unwrap_or(folder));
        let manifest = fs::read_to_string(sources.parent().unwrap().join("Cargo.toml")).unwrap();
        let is_run = !manifest.contains("doctest = false");
        assert!(is_run || !has_documented_code(&sources), "{folder}: remove `doctest = false`");
    }
}
