//! The table of the paper's requirements, `tests/paper.toml`.

use std::collections::HashSet;

use serde::Deserialize;

/// Something that the paper defines, claims, prescribes or reports, in our own words.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Requirement {
    /// Lower-case words separated by dots.
    pub(super) id: String,
    /// The section of the paper, such as `2.3`.
    pub(super) section: String,
    /// The line of Algorithm 1 or 2, for a requirement that is one.
    pub(super) line: Option<u32>,
    pub(super) text: String,
    /// An error of the print, and its correction.
    pub(super) erratum: Option<String>,
    pub(super) status: Status,
    /// The prerequisites of an open requirement: ids of others, or a few words.
    #[serde(default)]
    pub(super) after: Vec<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Status {
    /// Implemented and tested: code and a test cite it.
    Done,
    Open,
}

/// Reads a table of requirements; they keep their order.
pub(super) fn requirements(text: &str) -> Result<Vec<Requirement>, String> {
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Table {
        requirement: Vec<Requirement>,
    }
    let Table { requirement: rows } = toml::from_str(text).map_err(|error| error.to_string())?;
    let mut ids = HashSet::new();
    for Requirement { id, section, status, after, .. } in &rows {
        let is_section = section.split('.').all(|part| part.parse::<u8>().is_ok());
        let fault = match status {
            _ if !is_id(id) => "an id is two or more words of [a-z0-9-]+ separated by dots",
            _ if !ids.insert(id.as_str()) => "the id is repeated",
            _ if !is_section => "the section is not numbers separated by dots",
            Status::Done if !after.is_empty() => "done, but it has an `after`",
            Status::Open if after.is_empty() => "open, but it has no `after`",
            _ => continue,
        };
        return Err(format!("{id}: {fault}"));
    }
    let after = rows.iter().flat_map(|row| &row.after);
    let unknown = after.into_iter().find(|after| is_id(after) && !ids.contains(after.as_str()));
    unknown.map_or(Ok(()), |id| Err(format!("after {id}, which is not in the table")))?;
    Ok(rows)
}

fn is_id(text: &str) -> bool {
    let is_of_a_word = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    let is_word = |word: &str| !word.is_empty() && word.chars().all(is_of_a_word);
    text.contains('.') && text.split('.').all(is_word)
}

#[test]
fn contradictions_are_rejected_by_name() {
    let entry = |id: &str, rest: &str| {
        format!("[[requirement]]\nid = \"{id}\"\nsection = \"2.3\"\ntext = \"t\"\n{rest}\n")
    };
    let done = "status = \"done\"";
    let open = entry("a.b", "status = \"open\"\nafter = [\"alg1.4\", \"logs\"]");
    assert_eq!(requirements(&(entry("alg1.4", done) + &open)).unwrap().len(), 2);
    for (text, cause) in [
        (entry("alg1.4", "status = \"nearly\""), "nearly"),
        (entry("alg1.4", "status = \"done\"\nwhy = 1"), "why"),
        (entry("Alg1.4", done), "Alg1.4: an id is"),
        (entry("a.b", done) + &entry("a.b", done), "a.b: the id is repeated"),
        (entry("a.b", "status = \"open\""), "a.b: open"),
        (entry("a.b", "status = \"done\"\nafter = [\"logs\"]"), "a.b: done"),
        (open, "after alg1.4, which is not in the table"),
        (entry("a.b", done).replace("2.3", "two"), "a.b: the section"),
    ] {
        let error = requirements(&text).unwrap_err();
        assert!(error.contains(cause), "{error}");
    }
}
