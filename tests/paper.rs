//! The trace of the paper: every citation names a requirement, code and a test cite everything that is
//! done, and `toposlam paper` reports it.

#![allow(clippy::unwrap_used, reason = "these are tests")]

use std::{
    fs,
    path::Path,
    process::{Command, Output},
};

use toposlam::paper::{
    CITATIONS, Citation, CitationKind, PaperTrace, Requirement, Status, TABLE, citations,
    requirements,
};

fn table() -> Vec<Requirement> {
    requirements(TABLE).unwrap()
}

fn toposlam_paper(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_toposlam")).arg("paper").args(arguments).output().unwrap()
}

fn lines_of(output: &Output) -> Vec<&str> {
    str::from_utf8(&output.stdout).unwrap().lines().collect()
}

#[test]
fn every_citation_names_a_requirement() {
    let requirements = table();
    let unknown: Vec<_> = PaperTrace::new(&requirements, CITATIONS)
        .unknown
        .iter()
        .map(|Citation { id, file, line, .. }| format!("{file}:{line}: `{id}`"))
        .collect();
    assert!(unknown.is_empty(), "these ids are not in tests/paper.toml:\n{}", unknown.join("\n"));
}

#[test]
fn code_and_a_test_cite_everything_that_is_done() {
    let requirements = table();
    let trace = PaperTrace::new(&requirements, CITATIONS);
    let code = trace.rows.iter().filter(|row| row.lacks_code());
    let tests = trace.rows.iter().filter(|row| row.lacks_tests());
    let lacking: Vec<_> = code
        .map(|row| format!("code lacks  // paper: {}", row.requirement.id))
        .chain(tests.map(|row| format!("tests lack  // paper: {}", row.requirement.id)))
        .collect();
    assert!(lacking.is_empty(), "marked as done in tests/paper.toml, but\n{}", lacking.join("\n"));
}

#[test]
fn every_line_of_both_algorithms_is_a_requirement() {
    let printed = |algorithm: &str, last: u32| {
        (1..=last).map(|line| (format!("{algorithm}.{line}"), line)).collect::<Vec<_>>()
    };
    let with_a_line: Vec<_> = table()
        .into_iter()
        .filter_map(|requirement| requirement.line.map(|line| (requirement.id, line)))
        .collect();
    assert_eq!(with_a_line, [printed("alg1", 23), printed("alg2", 32)].concat());
}

#[test]
fn the_requirements_are_in_the_order_of_the_sections() {
    let numbers = |section: &str| -> Vec<u8> {
        let parts = section.split('.');
        parts.map(|part| part.parse().unwrap()).collect()
    };
    assert!(table().is_sorted_by_key(|requirement| numbers(&requirement.section)));
}

#[test]
fn the_embedded_citations_are_at_their_lines() {
    assert!(!CITATIONS.is_empty());
    for citation in CITATIONS {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(citation.file);
        let source = fs::read_to_string(file).unwrap();
        let line = source.lines().nth(citation.line - 1).unwrap();
        let (_, ids) = line.split_once(" paper: ").unwrap();
        assert!(
            ids.trim_end_matches(" *)").split(", ").any(|id| id == citation.id),
            "{citation:?} in {line}"
        );
    }
    assert!(CITATIONS.is_sorted_by_key(|citation| (citation.file, citation.line)));
}

#[test]
fn an_unknown_id_and_a_missing_citation_are_faults() {
    let done: Vec<_> = table()
        .into_iter()
        .filter(|requirement| requirement.id == "alg1.4" || requirement.id == "alg2.4")
        .map(|requirement| Requirement { status: Status::Done, ..requirement })
        .collect();
    let code = "// paper: alg1.4\n// paper: alg2.4";
    let test = "// paper: alg1.4, alg9.9";
    let both: Vec<_> = citations("src/a.rs", code).chain(citations("tests/a.rs", test)).collect();
    let faults = |cited: &[Citation]| PaperTrace::new(&done, cited).faults().collect::<Vec<_>>();
    assert_eq!(
        faults(&both),
        [
            "tests/a.rs:1: `alg9.9` is not a requirement of the paper",
            "alg2.4: done, but no test cites it",
        ]
    );
    let tests_only: Vec<_> = citations("tests/a.rs", "// paper: alg1.4").collect();
    assert_eq!(
        faults(&tests_only),
        ["alg1.4: done, but no code cites it", "alg2.4: done, but no code and no test cites it",]
    );
    let complete = ["alg1.4", "alg2.4"].map(|id| {
        [CitationKind::Code, CitationKind::Test].map(|kind| Citation {
            id,
            file: "src/a.rs",
            line: 1,
            kind,
        })
    });
    assert!(PaperTrace::new(&done, complete.as_flattened()).holds());
}

#[test]
fn an_open_requirement_need_not_be_cited() {
    let open: Vec<_> =
        table().into_iter().filter(|requirement| requirement.status != Status::Done).collect();
    assert!(!open.is_empty());
    assert!(PaperTrace::new(&open, &[]).holds());
}

#[test]
fn the_exit_code_is_1_exactly_if_something_is_missing() {
    let requirements = table();
    let holds = PaperTrace::new(&requirements, CITATIONS).holds();
    for arguments in [&[][..], &["--json"], &["--open"], &["--section", "4"]] {
        let code = toposlam_paper(arguments).status.code();
        assert_eq!(code, Some(i32::from(!holds)), "{arguments:?}");
    }
}

#[test]
fn the_table_lists_every_requirement_within_80_columns() {
    let output = toposlam_paper(&[]);
    let lines = lines_of(&output);
    for line in &lines {
        assert!(line.chars().count() <= 80, "{line}");
        assert_eq!(line.trim_end(), *line);
    }
    for requirement in table() {
        let is_head = |line: &&&str| line.split_whitespace().next() == Some(&requirement.id);
        assert_eq!(lines.iter().filter(is_head).count(), 1, "{}", requirement.id);
    }
}

#[test]
fn the_json_is_one_object_a_line_with_the_totals_last() {
    let output = toposlam_paper(&["--json", "--section", "2"]);
    let objects: Vec<serde_json::Value> =
        lines_of(&output).iter().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert!(objects.iter().all(|object| object["schema"] == 1));
    let (totals, rows) = objects.split_last().unwrap();
    assert_eq!(totals["requirements"], rows.len());
    let open = rows.iter().filter(|row| row["status"] == "open").count();
    assert_eq!(totals["open"], open);
    let degree = rows.iter().find(|row| row["id"] == "percept.degree");
    let code = &degree.unwrap()["code"];
    assert!(code[0].as_str().unwrap().starts_with("model/src/percept.rs:"));
}

#[test]
fn an_unknown_section_is_bad_usage() {
    let output = toposlam_paper(&["--section", "9"]);
    assert_eq!(output.status.code(), Some(2));
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(message.contains("`9`") && message.contains("2.3"), "{message}");
}

/// An error in the printed paper is listed with its correction.
#[test]
fn an_erratum_is_listed() {
    let errata: Vec<_> = table().into_iter().filter(|it| it.erratum.is_some()).collect();
    assert_eq!(errata.iter().map(|it| it.id.as_str()).collect::<Vec<_>>(), ["fig1.step"]);
    let output = toposlam_paper(&["--section", "2.2"]);
    assert!(lines_of(&output).iter().any(|line| line.contains("erratum  The print gives")));
}
