//! Known divergences that are tolerated. Each has a name and a reason, and is counted.

use serde::Deserialize;
use thiserror::Error;

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
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum QuirkError {
    /// The file has another form.
    #[error("{}", .0.trim_end())]
    Form(String),
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

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    quirk: Vec<Quirk>,
}

impl Quirks {
    /// Reads quirks from a file of TOML.
    ///
    /// # Errors
    /// Returns an error if it is not a quirk file, or a quirk in it is invalid.
    pub fn read(text: &str) -> Result<Self, QuirkError> {
        let file: File =
            toml::from_str(text).map_err(|error| QuirkError::Form(error.to_string()))?;
        for Quirk { name, reason, cause, .. } in &file.quirk {
            let (name, cause) = (name.clone(), cause.clone());
            if reason.trim().is_empty() {
                return Err(QuirkError::NoReason { name });
            }
            if INTOLERABLE.contains(&&*cause) {
                return Err(QuirkError::Intolerable { name, cause });
            }
            if !NAMES.contains(&&*cause) {
                return Err(QuirkError::Cause { name, cause });
            }
        }
        Ok(Self { quirks: file.quirk })
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
        assert_eq!(quirk("percept", " ").unwrap_err(), "quirk `x` has no reason");
        assert!(quirk("door", "why").unwrap_err().contains("cannot be tolerated"));
        assert!(quirk("glare", "why").unwrap_err().contains("the causes are number, form, aside"));
        let unknown = Quirks::read("[[quirk]]\nname = \"x\"\ncuase = \"percept\"").unwrap_err();
        assert!(unknown.to_string().contains("line 3"), "{unknown}");
        assert_eq!(Quirks::read("").unwrap(), Quirks::default());
    }
}
