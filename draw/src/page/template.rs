//! Templates of pages: `{{places}}` in a document that content is put into.

use serde_json::Value;

/// The template with each `{{place}}` replaced by its content. The inserted text is not searched for places.
pub(super) fn filled(template: &str, contents: &[(&str, &str)]) -> String {
    let mut parts = template.split("{{");
    let mut filled = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (place, rest) = part.split_once("}}").unwrap_or((part, ""));
        let content = contents.iter().find(|(known, _)| *known == place);
        debug_assert!(content.is_some(), "the place {place} is not filled");
        filled.push_str(content.map_or("", |(_, content)| content));
        filled.push_str(rest);
    }
    filled
}

/// JSON for the inside of a `script` element: nothing in it ends the element or begins a comment.
pub(super) fn in_script(data: &Value) -> String {
    data.to_string().replace('<', "\\u003c")
}

/// What the tests of all pages share.
#[cfg(test)]
pub(super) mod checks {
    use super::*;

    /// A name that would break a page if it were inserted as it is.
    pub(crate) const NASTY: &str = "</script><!--<i>&\"{{data}}";

    pub(crate) fn data_of(document: &str) -> Value {
        let (_, from) =
            document.split_once("<script type=\"application/json\" id=\"data\">").unwrap();
        serde_json::from_str(from.split_once("</script>").unwrap().0).unwrap()
    }

    /// A page with two scripts, the data and the code, in which the name [`NASTY`] breaks nothing.
    pub(crate) fn assert_escaped(document: &str) {
        assert!(!document.contains("<i>"));
        assert!(!document.contains("</script><"));
        assert_eq!(document.matches("</script>").count(), 2);
        assert_eq!(document.matches("<!--").count(), 1, "the template's own");
        // The inserted text is not searched for places.
        assert!(document.contains("{{data}}"));
    }
}
