//! `toposlam paper`: the requirements of the paper.

use std::{
    collections::BTreeSet,
    io::{self, Write},
};

use serde::Serialize;

use super::{
    CliError, Outcome,
    exit_codes::help_end,
    json::print_line,
    text::{counted, print_hanging, print_indented},
};
use crate::paper::{
    CITATIONS, Citation, PaperTrace, Status, TABLE, TracedRequirement, requirements,
};

/// List every requirement of the paper: where it is implemented and tested, and what is open
#[derive(clap::Args)]
#[command(after_help = help_end(
    "Example:\n  toposlam paper --section 2.3",
    &[
        (0, "the citations fit the requirements"),
        (1, "a requirement is marked as done but no code or no test cites it, or a citation names \
             an unknown requirement"),
        (2, "bad usage"),
    ],
))]
pub(super) struct PaperArguments {
    /// List only this section of the paper and its subsections
    #[arg(long, value_name = "N")]
    section: Option<String>,
    /// List only open requirements
    #[arg(long)]
    open: bool,
    /// Print one JSON object a line, the totals last
    #[arg(long)]
    json: bool,
}

impl PaperArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        let requirements =
            requirements(TABLE).map_err(|error| CliError::at("tests/paper.toml", error))?;
        let trace = PaperTrace::new(&requirements, CITATIONS);
        let mut rows: Vec<_> = trace.rows.iter().collect();
        if let Some(section) = &self.section {
            rows.retain(|row| row.requirement.is_in(section));
            if rows.is_empty() {
                let known: BTreeSet<_> = requirements.iter().map(|r| r.section.as_str()).collect();
                let known = known.into_iter().collect::<Vec<_>>().join(", ");
                let cause = format!("section `{section}` has no requirements; sections: {known}");
                return Err(CliError::at("--section", cause));
            }
        }
        if self.open {
            rows.retain(|row| row.requirement.status != Status::Done);
        }
        if self.json {
            print_json(out, &rows, &trace)?;
        } else {
            print_table(out, &rows, &trace)?;
        }
        Ok(outcome(&trace))
    }
}

fn outcome(trace: &PaperTrace) -> Outcome {
    if trace.holds() { Outcome::Holds } else { Outcome::Violated }
}

/// A line of `--json`.
#[derive(Serialize)]
struct RowLine<'a> {
    id: &'a str,
    section: &'a str,
    line: Option<u32>,
    text: &'a str,
    erratum: Option<&'a str>,
    status: &'static str,
    after: Option<&'a [String]>,
    code: Vec<String>,
    tests: Vec<String>,
}

/// The last line of `--json`.
#[derive(Serialize)]
struct TotalsLine {
    requirements: usize,
    done: usize,
    open: usize,
    faults: Vec<String>,
    verdict: &'static str,
    holds: bool,
}

/// Prints the rows and then the totals, one JSON object a line.
fn print_json(
    out: &mut dyn Write,
    rows: &[&TracedRequirement],
    trace: &PaperTrace,
) -> Result<(), CliError> {
    let place = |citation: &Citation| format!("{}:{}", citation.file, citation.line);
    for row in rows {
        let requirement = row.requirement;
        let (status, after) = match &requirement.status {
            Status::Done => ("done", None),
            Status::Open { after } => ("open", Some(after.as_slice())),
        };
        let line = RowLine {
            id: &requirement.id,
            section: &requirement.section,
            line: requirement.line,
            text: &requirement.text,
            erratum: requirement.erratum.as_deref(),
            status,
            after,
            code: row.code.iter().map(place).collect(),
            tests: row.tests.iter().map(place).collect(),
        };
        print_line(out, "requirement", &line)?;
    }
    let done = done(rows);
    let totals = TotalsLine {
        requirements: rows.len(),
        done,
        open: rows.len() - done,
        faults: trace.faults().collect(),
        verdict: outcome(trace).verdict(),
        holds: trace.holds(),
    };
    print_line(out, "requirements", &totals)
}

/// Prints the rows by section and then the totals.
fn print_table(
    out: &mut dyn Write,
    rows: &[&TracedRequirement],
    trace: &PaperTrace,
) -> io::Result<()> {
    let id_width = rows.iter().map(|row| row.requirement.id.len()).max();
    let id_width = id_width.unwrap_or_default();
    for section in rows.chunk_by(|a, b| a.requirement.section == b.requirement.section) {
        writeln!(out, "Section {}", section[0].requirement.section)?;
        for row in section {
            print_row(out, row, id_width)?;
        }
        writeln!(out)?;
    }
    let done = done(rows);
    let (all, open) = (rows.len(), rows.len() - done);
    writeln!(out, "{}: {done} done, {open} open", counted(all, "requirement"))?;
    let faults: Vec<_> = trace.faults().collect();
    if !faults.is_empty() {
        writeln!(out, "\nThe table and the sources disagree:")?;
        for fault in faults {
            print_indented(out, "  ", 4, &fault)?;
        }
    }
    Ok(())
}

fn print_row(out: &mut dyn Write, row: &TracedRequirement, id_width: usize) -> io::Result<()> {
    let requirement = row.requirement;
    let line = requirement.line.map(|line| line.to_string());
    let line = line.unwrap_or_default();
    let head = format!("  {:id_width$}  {line:>2}  ", requirement.id);
    print_hanging(out, &head, &requirement.text)?;
    if let Some(erratum) = &requirement.erratum {
        print_hanging(out, "      erratum  ", erratum)?;
    }
    if let Status::Open { after } = &requirement.status {
        print_hanging(out, "      open     after ", &after.join(", "))?;
    }
    let is_done = requirement.status == Status::Done;
    for (what, citations) in [("code ", &row.code), ("tests", &row.tests)] {
        if is_done || !citations.is_empty() {
            print_hanging(out, &format!("      {what}    "), &places(citations))?;
        }
    }
    Ok(())
}

/// The places of citations: each file once with its lines.
fn places(citations: &[Citation]) -> String {
    if citations.is_empty() {
        return "none".to_owned();
    }
    citations
        .chunk_by(|a, b| a.file == b.file)
        .map(|of_file| {
            let lines: Vec<_> = of_file.iter().map(|c| c.line.to_string()).collect();
            format!("{}:{}", of_file[0].file, lines.join(", "))
        })
        .collect::<Vec<_>>()
        .join("; ")
}

fn done(rows: &[&TracedRequirement]) -> usize {
    let is_done = |row: &&&TracedRequirement| row.requirement.status == Status::Done;
    rows.iter().filter(is_done).count()
}
