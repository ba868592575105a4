//! Events as lines: JSON objects, or CSV with a header. Each is a junction that the robot visited: its degree,
//! the door by which the robot left, and the marker.
//!
//! ```text
//! {"kind":"event","index":3,"stamp":41.2,"degree":3,"door":1,"marker":null}
//! ```

use serde::{Deserialize, Deserializer};

/// The columns of a CSV file, in their order. Others are ignored.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Columns(Vec<Option<usize>>);

const NAMES: [&str; 6] = ["index", "stamp", "degree", "door", "marker", "turned_back"];

/// A line.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub(super) struct VisitLine {
    /// Which visit it is.
    pub(super) index: Option<u32>,
    /// When it was, in seconds.
    pub(super) stamp: Option<f64>,
    /// The number of doors.
    #[serde(default, deserialize_with = "given")]
    degree: LineDegree,
    /// The door by which the robot left, clockwise from the way back; `None` if the log ends there.
    pub(super) door: Option<u32>,
    /// The door along which the marker points; -1: no marker is there. `None`: not recorded.
    pub(super) marker: Option<i64>,
    /// Whether the robot turned back on its way there.
    #[serde(default)]
    pub(super) turned_back: Option<bool>,
}

/// The number of doors in a line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum LineDegree {
    /// The line has no such field.
    #[default]
    Missing,
    /// It has; `None` if the junction was not recognised.
    Given(Option<u32>),
}

/// A field that is there, even if it is `null`.
fn given<'d, D: Deserializer<'d>>(deserializer: D) -> Result<LineDegree, D::Error> {
    Deserialize::deserialize(deserializer).map(LineDegree::Given)
}

/// What a line is, without its other fields.
#[derive(Deserialize)]
struct AnyLine {
    kind: Option<String>,
}

/// What a line is.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Parsed {
    /// An event with its degree; `None` if the junction was not recognised.
    Event(VisitLine, Option<u32>),
    /// A line of another kind.
    Other(String),
}

/// Whether a file begins with lines of events.
pub(super) fn is_events(head: &[u8]) -> bool {
    let mut lines = head.split(|&byte| byte == b'\n').filter(|line| !line.trim_ascii().is_empty());
    match lines.next() {
        Some(line) if line.trim_ascii_start().starts_with(b"{") => {
            let names = [&b"\"degree\""[..], b"\"kind\""];
            names.iter().any(|name| line.windows(name.len()).any(|part| part == *name))
        }
        Some(line) => Columns::read(line).is_some(),
        None => false,
    }
}

impl Columns {
    /// The columns of a header; `None` if it is not the header of a list of events.
    pub(super) fn read(line: &[u8]) -> Option<Self> {
        let line = std::str::from_utf8(line).ok()?;
        let line = line.trim_start_matches('\u{feff}');
        let name = |cell: &str| {
            let cell = cell.trim().trim_matches('"');
            NAMES.iter().position(|name| cell.eq_ignore_ascii_case(name))
        };
        let columns = Self(line.split(',').map(name).collect());
        let has = |wanted: &str| {
            columns.0.iter().flatten().any(|&index| NAMES.get(index) == Some(&wanted))
        };
        (has("degree") && has("door")).then_some(columns)
    }

    fn event(&self, line: &str) -> Result<VisitLine, String> {
        let mut event = VisitLine::default();
        let cells: Vec<_> = line.split(',').collect();
        if cells.len() != self.0.len() {
            return Err(format!("it has {} cells, and the header {}", cells.len(), self.0.len()));
        }
        for (cell, column) in cells.into_iter().zip(&self.0) {
            let Some(name) = column.and_then(|column| NAMES.get(column)) else { continue };
            let cell = cell.trim();
            if cell.is_empty() || cell == "null" {
                if *name == "degree" {
                    event.degree = LineDegree::Given(None);
                }
                continue;
            }
            let wrong = || format!("its {name} is {:?}", cell.chars().take(20).collect::<String>());
            match *name {
                "index" => event.index = Some(cell.parse().map_err(|_| wrong())?),
                "stamp" => event.stamp = Some(cell.parse().map_err(|_| wrong())?),
                "degree" => {
                    event.degree = LineDegree::Given(Some(cell.parse().map_err(|_| wrong())?));
                }
                "door" => event.door = Some(cell.parse().map_err(|_| wrong())?),
                "marker" => event.marker = Some(cell.parse().map_err(|_| wrong())?),
                _ => event.turned_back = Some(cell.parse().map_err(|_| wrong())?),
            }
        }
        Ok(event)
    }
}

/// The message of an error, whose line is always 1.
fn cause(error: &serde_json::Error) -> String {
    let message = error.to_string();
    message.split(" at line ").next().unwrap_or_default().replace(char::is_control, " ")
}

/// Reads a line.
///
/// Takes at most 64 bytes of memory for each byte of the line, and 4096 besides.
///
/// # Errors
/// Returns an error if it is not an event, and not another JSON object with a `kind`.
pub(super) fn parse(line: &[u8], columns: Option<&Columns>) -> Result<Parsed, String> {
    let event = match columns {
        None => {
            let any: AnyLine = serde_json::from_slice(line).map_err(|error| cause(&error))?;
            if let Some(kind) = any.kind.filter(|kind| kind != "event") {
                return Ok(Parsed::Other(kind));
            }
            serde_json::from_slice(line).map_err(|error| cause(&error))?
        }
        Some(columns) => {
            let line = std::str::from_utf8(line).map_err(|_| "it is not UTF-8 text".to_owned())?;
            columns.event(line)?
        }
    };
    if event.stamp.is_some_and(|stamp| !stamp.is_finite() || stamp < 0.0) {
        return Err(format!("its stamp is {:?}", event.stamp.unwrap_or_default()));
    }
    let LineDegree::Given(degree) = event.degree else { return Err("it has no degree".to_owned()) };
    Ok(Parsed::Event(event, degree))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_and_csv_are_the_same_events() {
        let columns = Columns::read(b"index, stamp,degree,DOOR,marker,turned_back,note").unwrap();
        for (json, csv) in [
            (
                r#"{"kind":"event","index":3,"stamp":41.2,"degree":3,"door":1,"marker":null}"#,
                "3,41.2,3,1,,,a note",
            ),
            (r#"{"degree":1,"door":null,"marker":-1,"more":[]}"#, ",,1,null,-1,,"),
            // Not recognised, after turning back.
            (r#"{"degree":null,"turned_back":true}"#, ",,,,,true,"),
        ] {
            let Parsed::Event(event, degree) = parse(json.as_bytes(), None).unwrap() else {
                panic!("{json}")
            };
            assert_eq!(parse(csv.as_bytes(), Some(&columns)), Ok(Parsed::Event(event, degree)));
        }
        let other = parse(br#"{"kind":"conform","marker":"none"}"#, None);
        assert_eq!(other, Ok(Parsed::Other("conform".into())));
    }

    #[test]
    fn a_wrong_line_is_an_error() {
        let columns = Columns::read(b"degree,door").unwrap();
        for (line, columns, error) in [
            ("{\"door\":1}", None, "it has no degree"),
            ("{\"degree\":", None, "EOF while parsing a value"),
            ("{\"degree\":-1}", None, "invalid value: integer `-1`, expected u32"),
            ("{\"degree\":2,\"stamp\":-1}", None, "its stamp is -1.0"),
            ("2", Some(&columns), "it has 1 cells, and the header 2"),
            ("2,x", Some(&columns), "its door is \"x\""),
            (
                "{\"degree\":2,\"turned_back\":1}",
                None,
                "invalid type: integer `1`, expected a boolean",
            ),
        ] {
            assert_eq!(parse(line.as_bytes(), columns), Err(error.to_owned()), "{line}");
        }
        assert_eq!(Columns::read(b"degree,exit"), None);
    }
}
