//! The table of the paper's requirements, `tests/paper.toml`.

use std::collections::HashSet;

use serde::Deserialize;
use toposlam_model::format::document::{self, DocumentError};

/// Something that the paper defines, claims, prescribes or reports.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Requirement {
    /// Its id in citations: lower-case words separated by dots.
    pub id: String,
    /// The section of the paper, such as `2.3`.
    pub section: String,
    /// The line of Algorithm 1 or 2, for a requirement that is one.
    pub line: Option<u32>,
    /// The requirement, in our own words.
    pub text: String,
    /// An error of the print, and its correction.
    pub erratum: Option<String>,
    /// Its status.
    pub status: Status,
}

/// The status of a requirement.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Status {
    /// Implemented and tested: code and a test cite it.
    Done,
    /// Not done yet.
    Open {
        /// The prerequisites: ids of other requirements, or a few words. Never empty.
        after: Vec<String>,
    },
}

impl Requirement {
    /// Whether the requirement is in the given section, or in a part of it.
    #[must_use]
    pub fn is_in(&self, section: &str) -> bool {
        self.section
            .strip_prefix(section)
            .is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    }
}

/// The reason why a table of requirements cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum TableError {
    /// It is not TOML, or not of this form.
    #[error(transparent)]
    Toml(#[from] DocumentError),
    /// It has no requirement.
    #[error("the table has no requirement")]
    Empty,
    /// An id is not lower-case words separated by dots.
    #[error("`{0}` is not an id: an id is two or more words of [a-z0-9-]+ separated by dots")]
    MalformedId(String),
    /// Two requirements have the same id.
    #[error("the id `{0}` is repeated")]
    RepeatedId(String),
    /// A section is not numbers separated by dots.
    #[error("{id}: `{section}` is not a section")]
    MalformedSection {
        /// The requirement.
        id: String,
        /// The text of its section.
        section: String,
    },
    /// A done requirement has a prerequisite.
    #[error("{0}: done, but it has an `after`")]
    DoneAfter(String),
    /// An open requirement has no prerequisite.
    #[error("{0}: open, but it has no `after`")]
    OpenAfterNothing(String),
    /// A prerequisite looks like an id and is unknown.
    #[error("{id}: comes after `{after}`, which is not in the table")]
    UnknownAfter {
        /// The requirement.
        id: String,
        /// The unknown id.
        after: String,
    },
}

/// Reads a table of requirements; they keep their order.
///
/// # Errors
///
/// Returns an error if the text is not such a table, or contradicts itself: see [`TableError`].
pub fn requirements(text: &str) -> Result<Vec<Requirement>, TableError> {
    let table: Table = document::from_toml(text.as_bytes())?;
    let requirements = table
        .requirement
        .into_iter()
        .map(Entry::into_requirement)
        .collect::<Result<Vec<_>, _>>()?;
    if requirements.is_empty() {
        return Err(TableError::Empty);
    }
    let mut ids = HashSet::new();
    if let Some(twin) = requirements.iter().find(|r| !ids.insert(r.id.as_str())) {
        return Err(TableError::RepeatedId(twin.id.clone()));
    }
    for Requirement { id, status, .. } in &requirements {
        let Status::Open { after } = status else {
            continue;
        };
        if let Some(after) =
            after.iter().find(|after| is_id(after) && !ids.contains(after.as_str()))
        {
            return Err(TableError::UnknownAfter { id: id.clone(), after: after.clone() });
        }
    }
    Ok(requirements)
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    #[serde(default)]
    requirement: Vec<Entry>,
}

/// A requirement, as written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    id: String,
    section: String,
    line: Option<u32>,
    text: String,
    erratum: Option<String>,
    status: Word,
    #[serde(default)]
    after: Vec<String>,
}

#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
enum Word {
    Done,
    Open,
}

impl Entry {
    fn into_requirement(self) -> Result<Requirement, TableError> {
        let Self { id, section, line, text, erratum, status, after } = self;
        if !is_id(&id) {
            return Err(TableError::MalformedId(id));
        }
        if section.split('.').any(|part| part.parse::<u8>().is_err()) {
            return Err(TableError::MalformedSection { id, section });
        }
        let status = match status {
            Word::Done if !after.is_empty() => return Err(TableError::DoneAfter(id)),
            Word::Open if after.is_empty() => return Err(TableError::OpenAfterNothing(id)),
            Word::Done => Status::Done,
            Word::Open => Status::Open { after },
        };
        Ok(Requirement { id, section, line, text, erratum, status })
    }
}

/// Whether this is two or more lower-case words separated by dots.
fn is_id(text: &str) -> bool {
    let of_a_word = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    text.contains('.')
        && text.split('.').all(|word| !word.is_empty() && word.chars().all(of_a_word))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(id: &str, rest: &str) -> String {
        format!("[[requirement]]\nid = \"{id}\"\nsection = \"2.3\"\ntext = \"t\"\n{rest}\n")
    }

    fn rejection(text: &str) -> String {
        requirements(text).unwrap_err().to_string()
    }

    #[test]
    fn a_requirement_is_done_or_open_after_something() {
        let text = entry("alg1.4", "line = 4\nstatus = \"done\"")
            + &entry("a.b", "status = \"open\"\nafter = [\"alg1.4\", \"logs\"]");
        let read = requirements(&text).unwrap();
        assert_eq!((read[0].line, &read[0].status), (Some(4), &Status::Done));
        let after = vec!["alg1.4".to_owned(), "logs".to_owned()];
        assert_eq!(read[1].status, Status::Open { after });
    }

    #[test]
    fn contradictions_are_rejected_by_name() {
        let done = "status = \"done\"";
        assert!(rejection("").contains("no requirement"));
        assert!(
            rejection(&entry("alg1.4", "status = \"nearly\"")).ends_with(
                "requirement[0].status: expected \"done\" or \"open\", found another text"
            )
        );
        assert!(rejection(&entry("alg1.4", "status = \"done\"\nwhy = 1")).contains("why"));
        assert!(rejection(&entry("Alg1.4", done)).contains("`Alg1.4` is not an id"));
        assert!(
            rejection(&(entry("a.b", done) + &entry("a.b", done)))
                .contains("the id `a.b` is repeated")
        );
        assert!(rejection(&entry("a.b", "status = \"open\"")).starts_with("a.b: open"));
        let waits = |status| entry("a.b", &format!("status = \"{status}\"\nafter = [\"c.d\"]"));
        assert!(rejection(&waits("done")).starts_with("a.b: done"));
        assert!(rejection(&waits("open")).contains("`c.d`, which is not in the table"));
        let section = entry("a.b", done).replace("2.3", "two");
        assert!(rejection(&section).contains("`two` is not a section"));
    }

    #[test]
    fn a_section_contains_its_parts_and_not_its_namesakes() {
        let read = requirements(&entry("a.b", "status = \"done\"")).unwrap();
        assert!(read[0].is_in("2.3") && read[0].is_in("2"));
        assert!(!read[0].is_in("2.") && !read[0].is_in("2.31") && !read[0].is_in("3"));
    }
}
