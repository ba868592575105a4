//! The trace of the paper, `docs/paper.md`: where each requirement of `tests/paper.toml` is implemented and where
//! it is tested. Every citation names a requirement, and code and a test cite everything that is done.

use std::{
    collections::{BTreeMap, BTreeSet},
    env,
    fmt::Write as _,
    fs,
    path::Path,
};

use serde::Deserialize;

use crate::{output::names_in, read, repository};

/// Something that the paper defines, claims, prescribes or reports, in our own words.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Requirement {
    /// Lower-case words separated by dots.
    id: String,
    /// The section of the paper, such as `2.3`.
    section: String,
    /// The line of Algorithm 1 or 2, for a requirement that is one.
    line: Option<u32>,
    text: String,
    /// An error of the print, and its correction.
    erratum: Option<String>,
    status: Status,
    /// The prerequisites of an open requirement: ids of others, or a few words.
    #[serde(default)]
    after: Vec<String>,
}

#[derive(Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Status {
    /// Implemented and tested: code and a test cite it.
    Done,
    Open,
}

fn table() -> Vec<Requirement> {
    let mut table: BTreeMap<String, Vec<Requirement>> =
        toml::from_str(include_str!("paper.toml")).unwrap();
    table.remove("requirement").unwrap()
}

/// The Rust and Coq files of the workspace's members and the files of facts, by their paths, with their texts.
fn sources() -> BTreeMap<String, String> {
    let members =
        names_in(&repository("")).into_iter().map(|name| name + "/").chain([String::new()]);
    let is_member = |folder: &String| {
        let manifest = fs::read_to_string(repository(folder).join("Cargo.toml"));
        let is_workspace = |text: &str| text.lines().any(|line| line == "[workspace]");
        manifest.is_ok_and(|text| folder.is_empty() || !is_workspace(&text))
    };
    let mut found = BTreeMap::new();
    for member in members.filter(is_member) {
        for part in ["src", "tests", "coq"] {
            add_sources(&format!("{member}{part}"), &mut found);
        }
    }
    found
}

fn add_sources(path: &str, found: &mut BTreeMap<String, String>) {
    if repository(path).is_dir() {
        for name in names_in(&repository(path)) {
            add_sources(&format!("{path}/{name}"), found);
        }
    } else if Path::new(path)
        .extension()
        .is_some_and(|kind| kind == "rs" || kind == "v" || kind == "txt")
    {
        found.insert(path.to_owned(), read(path));
    }
}

/// Whether a requirement is implemented or tested at the place that cites it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum CitationKind {
    Code,
    /// In a file `tests.rs`, under a folder `tests`, in a lemma under a folder `lemmas`, below the line
    /// `#[cfg(test)]` of a file, or in a Coq file, at a theorem.
    Test,
}

/// The citations in a file: id, kind, and line. A citation is a comment of its own or at the end of a line:
/// `// paper: id`, or several ids separated by commas; in a Coq file, `(* paper: id *)`, among facts, `# paper: id`.
fn citations<'a>(file: &str, text: &'a str) -> Vec<(&'a str, CitationKind, usize)> {
    let begin = match file.rsplit('.').next() {
        Some("v") => "(* paper:",
        Some("txt") => "# paper:",
        _ => "// paper:",
    };
    let in_coq = begin.starts_with('(');
    let tested = file.split('/').any(|part| ["tests", "tests.rs", "lemmas"].contains(&part));
    let mut kind = if tested || in_coq { CitationKind::Test } else { CitationKind::Code };
    let mut found = Vec::new();
    for (line, number) in text.lines().zip(1..) {
        if line.starts_with("#[cfg(test)]") {
            kind = CitationKind::Test;
        }
        let Some((before, ids)) = line.split_once(begin) else { continue };
        // Not in a string, nor in the documentation of an item.
        if !in_coq && before.contains(['"', '/']) {
            continue;
        }
        let ids = if in_coq { ids.strip_suffix("*)").unwrap_or("?") } else { ids };
        found.extend(ids.split(',').map(|id| (id.trim(), kind, number)));
    }
    found
}

/// The files that cite a requirement, for each id and kind.
type Cited<'a> = BTreeMap<(&'a str, CitationKind), BTreeSet<&'a str>>;

/// The page: a table for each section.
fn page(table: &[Requirement], cited: &Cited) -> String {
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
                let files = cited.get(&(id.as_str(), kind)).into_iter().flatten();
                let names: Vec<_> = files.map(|file| format!("`{file}`")).collect();
                let _ = write!(page, " | {}", names.join(" "));
            }
            page += " |\n";
        }
    }
    page
}

#[test]
fn citations_are_known_and_everything_that_is_done_is_cited_and_on_the_page() {
    let (table, sources) = (table(), sources());
    let mut cited = Cited::new();
    for (file, text) in &sources {
        for (id, kind, line) in citations(file, text) {
            assert!(table.iter().any(|row| row.id == id), "{file}:{line}: `{id}` is unknown");
            cited.entry((id, kind)).or_default().insert(file);
        }
    }
    for Requirement { id, .. } in table.iter().filter(|row| row.status == Status::Done) {
        for kind in [CitationKind::Code, CitationKind::Test] {
            let is_cited = cited.contains_key(&(id.as_str(), kind));
            assert!(is_cited, "{id}: done, but nothing of kind {kind:?} cites it");
        }
    }
    let page = page(&table, &cited);
    if env::var_os("TOPOSLAM_ACCEPT").is_some_and(|value| value == "1") {
        return fs::write(repository("docs/paper.md"), &page).unwrap();
    }
    let found = read("docs/paper.md").replace("\r\n", "\n");
    let differ = found.lines().zip(page.lines()).find(|(one, other)| one != other);
    assert!(found == page, "docs/paper.md is out of date; set TOPOSLAM_ACCEPT=1: {differ:#?}");
}

#[test]
fn the_requirements_are_in_order_and_do_not_contradict_themselves() {
    let table = table();
    let ids: BTreeSet<_> = table.iter().map(|row| &*row.id).collect();
    assert_eq!(ids.len(), table.len(), "an id is repeated");
    let is_id = |text: &str| {
        let is_of_a_word = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
        let is_word = |word: &str| !word.is_empty() && word.chars().all(is_of_a_word);
        text.contains('.') && text.split('.').all(is_word)
    };
    for Requirement { id, status, after, .. } in &table {
        assert!(is_id(id), "{id}");
        assert_eq!(*status == Status::Done, after.is_empty(), "{id}");
        assert!(after.iter().all(|after| !is_id(after) || ids.contains(&**after)), "{id}");
    }
    let numbers = |section: &str| -> Vec<u8> {
        section.split('.').map(|part| part.parse().unwrap()).collect()
    };
    assert!(table.is_sorted_by_key(|requirement| numbers(&requirement.section)));
    // Every line of both algorithms is a requirement.
    let printed = |algorithm: &'static str, last: u32| {
        (1..=last).map(move |line| (format!("{algorithm}.{line}"), line))
    };
    let with_a_line = table.into_iter().filter_map(|row| row.line.map(|line| (row.id, line)));
    assert!(with_a_line.eq(printed("alg1", 23).chain(printed("alg2", 32))));
}

#[test]
fn a_citation_is_a_comment_of_code_or_of_a_test() {
    use CitationKind::{Code, Test};
    let text = "// paper: a.b, c.d\nf(); // paper: e.f\n/// // paper: no.1\nlet s = \"// paper: no.2\";\n\
                //! paper: no.3\n// the paper: no.4\n#[cfg(test)]\n// paper: g.h\n";
    let found = |file| citations(file, text).into_iter().map(|(id, kind, _)| (id, kind));
    let kinds = [("a.b", Code), ("c.d", Code), ("e.f", Code), ("g.h", Test)];
    assert!(found("model/src/latests.rs").eq(kinds));
    for file in ["model/tests/a.rs", "model/src/a/tests.rs", "proofs/src/lemmas/a.rs"] {
        assert!(found(file).all(|(_, kind)| kind == Test), "{file}");
    }
    let coq = "Theorem t : True. (* paper: a.b, c.d *)\n(** Paper: 2.1. *)\n(* the paper: no.1 *)";
    assert_eq!(citations("proofs/coq/T.v", coq), [("a.b", Test, 1), ("c.d", Test, 1)]);
}
