//! The trace of the paper, `docs/paper.md`: where each requirement of `tests/paper.toml` is implemented and where
//! it is tested. Every citation names a requirement, and code and a test cite everything that is done.

#![allow(clippy::unwrap_used, reason = "these are tests")]

mod citation;
mod requirement;

use std::{
    collections::BTreeSet,
    fmt::Write as _,
    fs,
    path::{Path, PathBuf},
};

use citation::{Citation, CitationKind, citations};
use requirement::{Requirement, Status, requirements};

use crate::accepted::compare_or_accept;

fn table() -> Vec<Requirement> {
    requirements(include_str!("paper.toml")).unwrap()
}

/// The Rust and Coq files of the workspace's members, by their paths, with their texts.
fn sources() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let is_member = |folder: &PathBuf| {
        let manifest = fs::read_to_string(folder.join("Cargo.toml"));
        manifest.is_ok_and(|text| folder == root || text.lines().all(|line| line != "[workspace]"))
    };
    let folders = names_in(root).into_iter().map(|name| root.join(name));
    let members = folders.chain([root.to_owned()]).filter(is_member);
    let mut found = Vec::new();
    for member in members {
        for part in ["src", "tests", "coq"].map(|part| member.join(part)) {
            if part.is_dir() {
                add_sources(root, &part, &mut found);
            }
        }
    }
    found.sort();
    found
}

fn add_sources(root: &Path, folder: &Path, found: &mut Vec<(String, String)>) {
    for path in names_in(folder).into_iter().map(|name| folder.join(name)) {
        if path.is_dir() {
            add_sources(root, &path, found);
        } else if path.extension().is_some_and(|kind| kind == "rs" || kind == "v") {
            let name = path.strip_prefix(root).unwrap().to_str().unwrap().replace('\\', "/");
            found.push((name, fs::read_to_string(&path).unwrap()));
        }
    }
}

fn names_in(folder: &Path) -> Vec<std::ffi::OsString> {
    fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name()).collect()
}

fn cited_in(sources: &[(String, String)]) -> Vec<Citation<'_>> {
    sources.iter().flat_map(|(file, text)| citations(file, text)).collect()
}

/// The files that cite a requirement.
fn files<'a>(id: &str, kind: CitationKind, cited: &[Citation<'a>]) -> BTreeSet<&'a str> {
    let of_it = cited.iter().filter(|citation| citation.id == id && citation.kind == kind);
    of_it.map(|citation| citation.file).collect()
}

/// Unknown ids, and requirements that are marked as done and not cited.
fn faults(table: &[Requirement], cited: &[Citation<'_>]) -> Vec<String> {
    let is_known = |citation: &Citation<'_>| table.iter().any(|row| row.id == citation.id);
    let unknown = cited.iter().filter(|citation| !is_known(citation));
    let mut faults: Vec<_> = unknown
        .map(|Citation { id, file, line, .. }| format!("{file}:{line}: `{id}` is unknown"))
        .collect();
    for Requirement { id, .. } in table.iter().filter(|row| row.status == Status::Done) {
        for kind in [CitationKind::Code, CitationKind::Test] {
            if files(id, kind, cited).is_empty() {
                faults.push(format!("{id}: done, but nothing of kind {kind:?} cites it"));
            }
        }
    }
    faults
}

/// The page: a table for each section.
fn page(table: &[Requirement], cited: &[Citation<'_>]) -> String {
    let open = table.iter().filter(|row| row.status == Status::Open).count();
    let mut page = format!(
        "# The paper and this program\n\n\
         What the paper requires, in our own words, where it is implemented, and where it is tested or proved.\n\
         {} requirements, {open} of them open. `cargo test --test all paper::` checks this page, and writes it if\n\
         `TOPOSLAM_ACCEPT=1` is set.\n",
        table.len(),
    );
    for section in table.chunk_by(|one, other| one.section == other.section) {
        let _ = write!(page, "\n## Section {}\n\n", section[0].section);
        page += "| requirement | code | tests and proofs |\n| --- | --- | --- |\n";
        for Requirement { id, line, text, erratum, status, after, .. } in section {
            let _ = write!(page, "| **{id}** {text}");
            page += &line.map(|line| format!(" Line {line}.")).unwrap_or_default();
            let erratum = erratum.as_ref().map(|erratum| format!(" Erratum: {erratum}"));
            page += &erratum.unwrap_or_default();
            if *status == Status::Open {
                let _ = write!(page, " *Open, after {}.*", after.join(", "));
            }
            for kind in [CitationKind::Code, CitationKind::Test] {
                let names = files(id, kind, cited).into_iter().map(|file| format!("`{file}`"));
                let _ = write!(page, " | {}", names.collect::<Vec<_>>().join(" "));
            }
            page += " |\n";
        }
    }
    page
}

#[test]
fn the_page_lists_every_requirement_with_its_citations() {
    let sources = sources();
    let cited = cited_in(&sources);
    compare_or_accept("docs/paper.md", &page(&table(), &cited));
}

#[test]
fn citations_are_known_and_everything_that_is_done_is_cited() {
    let sources = sources();
    let faults = faults(&table(), &cited_in(&sources));
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn an_unknown_id_and_a_missing_citation_are_faults() {
    let mut table = table();
    table.retain(|row| row.id == "alg1.4");
    let code = || citations("src/a.rs", "// paper: alg1.4");
    let both = || code().chain(citations("tests/a.rs", "// paper: alg1.4"));
    assert_eq!(faults(&table, &both().collect::<Vec<_>>()), [""; 0]);
    assert_eq!(faults(&table, &code().collect::<Vec<_>>()).len(), 1);
    let unknown: Vec<_> = both().chain(citations("src/b.rs", "\n// paper: alg9.9")).collect();
    assert_eq!(faults(&table, &unknown), ["src/b.rs:2: `alg9.9` is unknown"]);
    table[0].status = Status::Open;
    assert_eq!(faults(&table, &[]), [""; 0]);
}

#[test]
fn every_line_of_both_algorithms_is_a_requirement() {
    let printed = |algorithm: &str, last: u32| {
        (1..=last).map(|line| (format!("{algorithm}.{line}"), line)).collect::<Vec<_>>()
    };
    let with_a_line: Vec<_> =
        table().into_iter().filter_map(|row| row.line.map(|line| (row.id, line))).collect();
    assert_eq!(with_a_line, [printed("alg1", 23), printed("alg2", 32)].concat());
}

#[test]
fn the_requirements_are_in_the_order_of_the_sections() {
    let numbers = |section: &str| -> Vec<u8> {
        section.split('.').map(|part| part.parse().unwrap()).collect()
    };
    assert!(table().is_sorted_by_key(|requirement| numbers(&requirement.section)));
}
