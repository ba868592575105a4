//! Places in files that people write, to say where something is wrong.

use std::fmt;

/// A place in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// The file as a whole.
    File,
    /// Where the text breaks; both count from 1, the column in characters.
    Text {
        /// The line.
        line: usize,
        /// The column.
        column: usize,
    },
    /// The path of a key, such as `clockwise.a` or `hallways[0].from`.
    Key(String),
}

impl Place {
    /// Where a byte of a text is. Bytes that are not UTF-8 count as a character each run.
    #[must_use]
    pub fn at_byte(text: &[u8], byte: usize) -> Self {
        let before = String::from_utf8_lossy(&text[..byte.min(text.len())]);
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        Self::Text {
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File => Ok(()),
            Self::Text { line, column } => write!(formatter, "line {line}, column {column}: "),
            Self::Key(path) => write!(formatter, "{path}: "),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_columns_count_from_one_in_characters() {
        let at = |byte| Place::at_byte("é = 1\nä = 2\n".as_bytes(), byte).to_string();
        assert_eq!(at(0), "line 1, column 1: ");
        assert_eq!(at(2), "line 1, column 2: ");
        assert_eq!(at(7), "line 2, column 1: ");
        assert_eq!(at(9), "line 2, column 2: ");
        assert_eq!(at(99), "line 3, column 1: ");
    }
}
