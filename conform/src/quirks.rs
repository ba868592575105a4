//! Known divergences that are tolerated. Each has a name and a reason, and is counted.

use serde::Deserialize;
use toposlam_model::format::document::{Document, DocumentError, DocumentErrorKind};

use super::divergence::{Divergence, NAMES};

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Quirks {
    /// In the order of their file.
    pub(super) quirks: Vec<Quirk>,
}

#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Quirk {
    pub(super) name: String,
    pub(super) reason: String,
    cause: String,
    /// The only event at which it is tolerated, counted from 1; everywhere without one.
    event: Option<usize>,
}

/// It is not known how a run continues after these.
const INTOLERABLE: [&str; 4] = ["not-in-turn", "no-such-door", "no-world", "door"];

impl Quirk {
    /// The key with a wrong value, and what is wrong with it.
    fn wrong_key(&self) -> Option<(&'static str, String)> {
        let Self { name, reason, cause, .. } = self;
        if reason.trim().is_empty() {
            Some(("reason", format!("quirk `{name}` has no reason")))
        } else if INTOLERABLE.contains(&&**cause) {
            let why = "cannot be tolerated: it is not known how the run continues";
            Some(("cause", format!("quirk `{name}`: the cause `{cause}` {why}")))
        } else if !NAMES.contains(&&**cause) {
            let known = NAMES.into_iter().filter(|name| !INTOLERABLE.contains(name));
            let known = known.collect::<Vec<_>>().join(", ");
            let why = format!("quirk `{name}`: unknown cause `{cause}`; the causes are {known}");
            Some(("cause", why))
        } else {
            None
        }
    }
}

impl Quirks {
    /// Reads quirks from a file of TOML.
    ///
    /// # Errors
    /// Returns an error if it is not a quirk file, or a quirk in it is invalid.
    pub fn read(text: &str) -> Result<Self, DocumentError> {
        let document = Document::parse_settings(text.as_bytes())?;
        let table = document.root().table(&["quirk"])?;
        let Some(list) = table.get("quirk") else { return Ok(Self::default()) };
        let mut quirks = Vec::new();
        for value in list.list("a list of quirks")? {
            let quirk: Quirk = value.read()?;
            if let Some((key, why)) = quirk.wrong_key() {
                let position = value.any_table()?.need(key)?.position();
                return Err(DocumentError { position, kind: DocumentErrorKind::Invalid(why) });
            }
            quirks.push(quirk);
        }
        Ok(Self { quirks })
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
    fn a_quirk_has_a_name_a_tolerable_cause_and_a_reason() {
        let quirk = |cause: &str, reason: &str| {
            format!("[[quirk]]\nname = \"x\"\ncause = \"{cause}\"\nreason = \"{reason}\"")
        };
        assert_eq!(Quirks::read("").unwrap(), Quirks::default());
        assert_eq!(Quirks::read(&quirk("percept", "glare")).unwrap().quirks.len(), 1);
        for (text, expected) in [
            (quirk("percept", " "), "line 4, column 10: quirk[0].reason: quirk `x` has no reason"),
            (
                quirk("glare", "why"),
                "line 3, column 9: quirk[0].cause: quirk `x`: unknown cause `glare`; the causes are number, \
                 form, aside",
            ),
            (
                "[[quirks]]".to_owned(),
                "line 1, column 3: quirks: unknown key; expected one of: quirk",
            ),
        ] {
            let message = Quirks::read(&text).unwrap_err().to_string();
            assert!(message.starts_with(expected), "{message}");
        }
    }
}
