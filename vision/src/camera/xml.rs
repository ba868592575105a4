//! Values of the XML files that OpenCV writes, as far as calibrations need them.

use roxmltree::{Document, Node};

use super::{
    optics_file::{OpticsFileError, shown},
    yaml::Values,
};

/// Reads the values of known keys below the root, each a list of words.
pub(super) fn values<'k>(
    text: &str,
    known: &'k [&'static str],
) -> Result<Values<'k>, OpticsFileError> {
    let document = Document::parse(text).map_err(|error| OpticsFileError::Syntax {
        line: error.pos().row as usize,
        message: shown(&error.to_string()),
    })?;
    let mut values = Values::empty(known);
    for node in document.root_element().children().filter(Node::is_element) {
        let below = node.children().filter(Node::is_element);
        let nested = below.map(|child| (format!("{}.{}", key(node), key(child)), child));
        for (key, node) in [(key(node).to_owned(), node)].into_iter().chain(nested) {
            let words = node.text().unwrap_or_default().split_whitespace();
            let line = document.text_pos_at(node.range().start).row as usize;
            values.add(&key, line, words.map(|word| word.trim_matches('"').to_owned()))?;
        }
    }
    Ok(values)
}

fn key<'a>(node: Node<'a, '_>) -> &'a str {
    node.tag_name().name()
}
