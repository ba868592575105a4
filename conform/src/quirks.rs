//! Known divergences that are tolerated. Each has a name and a reason, and is counted.

use serde::Deserialize;
use thiserror::Error;
use toposlam_model::format::document::{Document, DocumentError, DocumentErrorKind, TextPosition};

use super::divergence::{Divergence, NAMES};

/// The tolerated divergences.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Quirks {
    quirks: Vec<Quirk>,
}

/// A divergence that is tolerated.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Quirk {
    /// Its name.
    pub name: String,
    /// Why it is tolerated.
    pub reason: String,
    /// The cause of the divergence: `percept`, `contradiction`, `entry`, `aside`, `turned-back`, `moved`, `shape`, `return`,
    /// `undecided`, `number`, `form`, `moves`, `map`, `wrong-map` or `unfinished`.
    pub cause: String,
    /// The only event at which it is tolerated, counted from 1; everywhere without one.
    pub event: Option<usize>,
}

/// Why quirks cannot be read.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{position}{kind}")]
pub struct QuirkError {
    /// Where.
    pub position: TextPosition,
    /// What is wrong there.
    #[source]
    pub kind: QuirkErrorKind,
}

/// What is wrong at a place of a file of quirks.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum QuirkErrorKind {
    /// A key or a value of the file is not as it should be.
    #[error(transparent)]
    Document(DocumentErrorKind),
    /// The cause is unknown.
    #[error("quirk `{name}`: unknown cause `{cause}`; the causes are {}", tolerable().join(", "))]
    Cause {
        /// The quirk's name.
        name: String,
        /// The cause in the file.
        cause: String,
    },
    /// It is not known how a run continues after this cause.
    #[error(
        "quirk `{name}`: the cause `{cause}` cannot be tolerated: it is not known how the run continues"
    )]
    Intolerable {
        /// The quirk's name.
        name: String,
        /// The cause in the file.
        cause: String,
    },
    /// A quirk without a reason.
    #[error("quirk `{name}` has no reason")]
    NoReason {
        /// The quirk's name.
        name: String,
    },
}

/// It is not known how a run continues after these.
const INTOLERABLE: [&str; 4] = ["not-in-turn", "no-such-door", "no-world", "door"];

/// The causes that a quirk may have.
fn tolerable() -> Vec<&'static str> {
    NAMES.into_iter().filter(|name| !INTOLERABLE.contains(name)).collect()
}

impl From<DocumentError> for QuirkError {
    fn from(DocumentError { position, kind }: DocumentError) -> Self {
        Self { position, kind: QuirkErrorKind::Document(kind) }
    }
}

impl Quirk {
    /// Checks what it says. An error names the key with the wrong value.
    fn check(&self) -> Result<(), (&'static str, QuirkErrorKind)> {
        let (name, cause) = (self.name.clone(), self.cause.clone());
        if self.reason.trim().is_empty() {
            Err(("reason", QuirkErrorKind::NoReason { name }))
        } else if INTOLERABLE.contains(&&*cause) {
            Err(("cause", QuirkErrorKind::Intolerable { name, cause }))
        } else if !NAMES.contains(&&*cause) {
            Err(("cause", QuirkErrorKind::Cause { name, cause }))
        } else {
            Ok(())
        }
    }
}

impl Quirks {
    /// Reads quirks from a file of TOML.
    ///
    /// # Errors
    /// Returns an error if it is not a quirk file, or a quirk in it is invalid.
    pub fn read(text: &str) -> Result<Self, QuirkError> {
        let document = Document::parse_settings(text.as_bytes())?;
        let table = document.root().table(&["quirk"])?;
        let Some(list) = table.get("quirk") else { return Ok(Self::default()) };
        let mut quirks = Vec::new();
        for value in list.list("a list of quirks")? {
            let quirk: Quirk = value.read()?;
            if let Err((key, kind)) = quirk.check() {
                let position = value.any_table()?.need(key)?.position();
                return Err(QuirkError { position, kind });
            }
            quirks.push(quirk);
        }
        Ok(Self { quirks })
    }

    /// All of them, in the order of their file.
    #[must_use]
    pub fn all(&self) -> &[Quirk] {
        &self.quirks
    }

    /// The first quirk that a divergence is.
    pub(super) fn tolerating(&self, divergence: &Divergence) -> Option<usize> {
        self.quirks.iter().position(|quirk| {
            quirk.cause == divergence.cause.name()
                && quirk.event.is_none_or(|event| event == divergence.event + 1)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quirks_have_a_name_a_cause_and_a_reason() {
        let quirk = |cause: &str, reason: &str| {
            let text =
                format!("[[quirk]]\nname = \"x\"\ncause = \"{cause}\"\nreason = \"{reason}\"");
            Quirks::read(&text).map(|quirks| quirks.all().len()).map_err(|error| error.to_string())
        };
        assert_eq!(quirk("percept", "glare"), Ok(1));
        assert_eq!(
            quirk("percept", " ").unwrap_err(),
            "line 4, column 10: quirk[0].reason: quirk `x` has no reason"
        );
        assert!(quirk("door", "why").unwrap_err().contains("cannot be tolerated"));
        let unknown = quirk("glare", "why").unwrap_err();
        assert!(
            unknown
                .starts_with("line 3, column 9: quirk[0].cause: quirk `x`: unknown cause `glare`")
        );
        assert!(unknown.contains("the causes are number, form, aside"));
        assert_eq!(Quirks::read("").unwrap(), Quirks::default());
    }

    #[test]
    fn the_error_of_a_file_of_another_form_is_one_line_with_its_place() {
        let message = |text: &str| Quirks::read(text).unwrap_err().to_string();
        assert_eq!(
            message("[[quirk]]\nname = \"x\"\ncuase = \"percept\""),
            "line 3, column 1: quirk[0].cuase: unknown key; expected one of: name, reason, cause, event"
        );
        assert_eq!(
            message("[[quirk]]\nname = 1"),
            "line 2, column 8: quirk[0].name: expected a text, found a whole number"
        );
        assert_eq!(
            message("[[quirks]]"),
            "line 1, column 3: quirks: unknown key; expected one of: quirk"
        );
    }
}
