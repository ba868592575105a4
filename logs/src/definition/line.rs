//! One line of a definition.

use super::{
    Count, Dialect,
    error::{DefinitionErrorKind, quoted},
};

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum DefinitionLine<'t> {
    Empty,
    Separator,
    Field { type_name: &'t str, count: Count, name: &'t str },
    Constant { type_name: &'t str },
}

pub(super) fn line(
    dialect: Dialect,
    text: &str,
) -> Result<DefinitionLine<'_>, DefinitionErrorKind> {
    let trimmed = text.trim();
    if trimmed.len() >= 3 && trimmed.bytes().all(|byte| byte == b'=') {
        return Ok(DefinitionLine::Separator);
    }
    let bare = trimmed.split('#').next().unwrap_or_default().trim_end();
    if bare.is_empty() {
        return Ok(DefinitionLine::Empty);
    }
    let malformed = || DefinitionErrorKind::Malformed(quoted(trimmed));
    let (written, rest) = bare.split_once(char::is_whitespace).ok_or_else(malformed)?;
    let rest = rest.trim_start();
    let (type_name, count) = type_of(written).ok_or_else(malformed)?;
    let end = rest.find(|letter: char| letter.is_whitespace() || letter == '=');
    let (name, after) = rest.split_at(end.unwrap_or(rest.len()));
    if !is_name(name) {
        return Err(DefinitionErrorKind::NotAName(quoted(name)));
    }
    let after = after.trim_start();
    if after.starts_with('=') {
        return match count {
            Count::One => Ok(DefinitionLine::Constant { type_name }),
            _ => Err(DefinitionErrorKind::ConstantType(quoted(written))),
        };
    }
    match dialect {
        Dialect::Ros1 if !after.is_empty() => Err(malformed()),
        // In ROS 2 a default may follow the name; recorded messages do not need it.
        _ => Ok(DefinitionLine::Field { type_name, count, name }),
    }
}

/// A type as it is written, such as `uint8[<=5]` or `string<=10`, without its bounds.
fn type_of(written: &str) -> Option<(&str, Count)> {
    let (base, count) = match written.split_once('[') {
        None => (written, Count::One),
        Some((base, list)) => {
            let length = list.strip_suffix(']')?;
            let count = match length.strip_prefix("<=") {
                _ if length.is_empty() => Count::Any,
                Some(most) => Count::AtMost(most.parse().ok()?),
                None => Count::Fixed(length.parse().ok()?),
            };
            (base, count)
        }
    };
    let base = match base.split_once("<=") {
        None => base,
        Some((base @ ("string" | "wstring"), most)) if most.parse::<u32>().is_ok() => base,
        Some(_) => return None,
    };
    base.split('/').all(is_name).then_some((base, count))
}

fn is_name(text: &str) -> bool {
    text.starts_with(|letter: char| letter.is_ascii_alphabetic() || letter == '_')
        && text.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_')
}
