//! TOML as a document: its values, with the place of each.

use toml::de::{DeTable, DeValue};

use super::{Content, DocumentError, DocumentErrorKind, Key, Node, TextPosition};

pub(super) fn parse(text: &str) -> Result<Node<'_>, DocumentError> {
    let wrong = |at, message| {
        DocumentErrorKind::Syntax(message).at(TextPosition::at_byte(text.as_bytes(), at))
    };
    let table = DeTable::parse(text).map_err(|error| {
        wrong(error.span().map_or(0, |span| span.start), error.message().replace('\n', ", "))
    })?;
    let content =
        table_content(table.into_inner()).map_err(|(at, message)| wrong(at, message.to_owned()))?;
    Ok(Node { at: None, content })
}

/// The keys of a table in the order of the document.
fn table_content(table: DeTable<'_>) -> Result<Content<'_>, (usize, &'static str)> {
    let mut entries = Vec::with_capacity(table.len());
    for (key, value) in table {
        let at = key.span().start;
        let mut node = node(value)?;
        if matches!(node.content, Content::Table(_)) {
            node.at = Some(at);
        }
        entries.push((Key { at: Some(at), name: key.into_inner() }, node));
    }
    entries.sort_by_key(|(key, _)| key.at);
    Ok(Content::Table(entries))
}

#[expect(clippy::cast_precision_loss, reason = "no key takes a whole number as large")]
fn node(value: toml::Spanned<DeValue<'_>>) -> Result<Node<'_>, (usize, &'static str)> {
    let at = value.span().start;
    let content = match value.into_inner() {
        DeValue::Table(table) => table_content(table)?,
        DeValue::Array(items) => {
            Content::List(items.into_iter().map(node).collect::<Result<_, _>>()?)
        }
        DeValue::String(text) => Content::Text(text),
        DeValue::Integer(digits) => {
            let (text, radix) = (digits.as_str(), digits.radix());
            let whole = i64::from_str_radix(text, radix).map(Content::Whole);
            let large = |_| u64::from_str_radix(text, radix).map(|it| Content::Number(it as f64));
            whole.or_else(large).map_err(|_| (at, "this number is too large"))?
        }
        DeValue::Float(digits) => match digits.as_str().parse::<f64>() {
            Ok(number) if number.is_finite() || digits.as_str().contains(['n', 'f']) => {
                Content::Number(number)
            }
            _ => return Err((at, "this number is too large")),
        },
        DeValue::Boolean(truth) => Content::Truth(truth),
        DeValue::Datetime(_) => Content::Date,
    };
    Ok(Node { at: Some(at), content })
}
