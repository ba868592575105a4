//! Events as lines: JSON objects, or CSV with a header. Each is a junction that the robot visited: its degree,
//! the door by which the robot left, the marker, and what the robot did with it.
//!
//! ```text
//! {"kind":"event","index":3,"stamp":41.2,"degree":3,"door":1,"marker":null}
//! ```

use std::{borrow::Cow, fmt};

use serde::{
    Deserialize, Deserializer,
    de::{Error, Unexpected, Visitor},
};
use toposlam_model::{
    aid::{AidAction, UnknownAction},
    percept::Sighting,
};

use super::encode;

/// The columns of a CSV file, in their order. Others are ignored.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Columns(Vec<Option<usize>>);

/// The end of the range of stamps, in seconds: 64 bits of nanoseconds, to the year 2540.
const LATEST: f64 = 1.8e10;

const NAMES: [&str; 7] = ["index", "stamp", "degree", "door", "marker", "actions", "turned_back"];

#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub(super) struct VisitLine {
    #[serde(default, deserialize_with = "whole")]
    pub(super) index: Option<u32>,
    /// When it was, in seconds.
    pub(super) stamp: Option<f64>,
    #[serde(default, deserialize_with = "given")]
    degree: LineDegree,
    /// The door by which the robot left, clockwise from the way back; `None` if the log ends there.
    #[serde(default, deserialize_with = "whole")]
    pub(super) door: Option<u32>,
    /// The marker; `None`: not recorded.
    marker: Option<LineMarker>,
    /// What the robot did with its marking aid before it left, in words with spaces between them.
    actions: Option<String>,
    #[serde(default)]
    pub(super) turned_back: Option<bool>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum LineMarker {
    /// The door along which it points; -1: no marker is there.
    Door(i64),
    Seen(bool),
    /// In words.
    Words(Sighting),
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum LineDegree {
    #[default]
    Missing,
    /// It has; `None` if the junction was not recognised.
    Given(Option<u32>),
}

/// A field that is there, even if it is `null`.
fn given<'d, D: Deserializer<'d>>(deserializer: D) -> Result<LineDegree, D::Error> {
    whole(deserializer).map(LineDegree::Given)
}

/// A whole number, also as `1.0`, which tables of numbers that may be missing write.
fn whole<'d, D: Deserializer<'d>>(deserializer: D) -> Result<Option<u32>, D::Error> {
    let number: Option<Whole> = Deserialize::deserialize(deserializer)?;
    Ok(number.map(|Whole(number)| number))
}

/// The whole number that a decimal one is.
fn whole_of(number: f64) -> Option<i64> {
    (number.fract() == 0.0 && number.abs() < 1e15).then_some(number as i64)
}

struct Whole(u32);

impl<'d> Deserialize<'d> for Whole {
    fn deserialize<D: Deserializer<'d>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(WholeVisitor)
    }
}

struct WholeVisitor;

impl Visitor<'_> for WholeVisitor {
    type Value = Whole;

    fn expecting(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str("u32")
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<Whole, E> {
        let whole = u32::try_from(number).map(Whole);
        whole.map_err(|_| E::invalid_value(Unexpected::Signed(number), &self))
    }

    fn visit_u64<E: Error>(self, number: u64) -> Result<Whole, E> {
        let whole = u32::try_from(number).map(Whole);
        whole.map_err(|_| E::invalid_value(Unexpected::Unsigned(number), &self))
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<Whole, E> {
        let whole = whole_of(number).and_then(|number| u32::try_from(number).ok());
        whole.map(Whole).ok_or_else(|| E::invalid_type(Unexpected::Float(number), &self))
    }
}

impl<'d> Deserialize<'d> for LineMarker {
    fn deserialize<D: Deserializer<'d>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(MarkerVisitor)
    }
}

struct MarkerVisitor;

impl Visitor<'_> for MarkerVisitor {
    type Value = LineMarker;

    fn expecting(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str("the marker: a door, -1, true, false, words or null")
    }

    fn visit_bool<E: Error>(self, is_seen: bool) -> Result<LineMarker, E> {
        Ok(LineMarker::Seen(is_seen))
    }

    fn visit_str<E: Error>(self, words: &str) -> Result<LineMarker, E> {
        encode::sighting_in(words).map(LineMarker::Words).map_err(E::custom)
    }

    fn visit_i64<E: Error>(self, door: i64) -> Result<LineMarker, E> {
        Ok(LineMarker::Door(door))
    }

    fn visit_u64<E: Error>(self, door: u64) -> Result<LineMarker, E> {
        Ok(LineMarker::Door(i64::try_from(door).unwrap_or(i64::MAX)))
    }

    fn visit_f64<E: Error>(self, door: f64) -> Result<LineMarker, E> {
        let whole = whole_of(door).map(LineMarker::Door);
        whole.ok_or_else(|| E::invalid_value(Unexpected::Float(door), &self))
    }
}

/// What programs write in the cell of a table without a value.
const EMPTY: [&str; 7] = ["", "null", "nan", "na", "<na>", "none", "n/a"];

fn is_empty(cell: &str) -> bool {
    EMPTY.iter().any(|empty| cell.eq_ignore_ascii_case(empty))
}

/// A whole number in a cell.
fn whole_cell(cell: &str) -> Option<i64> {
    cell.parse().ok().or_else(|| whole_of(cell.parse().ok()?))
}

/// A truth in a cell.
fn bool_cell(cell: &str) -> Option<bool> {
    match cell {
        _ if cell.eq_ignore_ascii_case("true") => Some(true),
        _ if cell.eq_ignore_ascii_case("false") => Some(false),
        _ => None,
    }
}

impl VisitLine {
    /// What the robot saw of its marker; `None`: not recorded. An error if there is no door with the number of the
    /// marker's.
    pub(super) fn sighting(&self) -> Result<Option<Sighting>, String> {
        let sighting = |marker| match marker {
            LineMarker::Door(door) => encode::sighting_of(door),
            LineMarker::Seen(is_seen) => Ok(encode::seen(is_seen)),
            LineMarker::Words(sighting) => Ok(sighting),
        };
        self.marker.map(sighting).transpose()
    }

    /// What the robot did with its marking aid before it left.
    pub(super) fn actions(&self) -> Result<Vec<AidAction>, String> {
        let words = self.actions.iter().flat_map(|words| words.split_whitespace());
        words.map(|word| word.parse().map_err(|error: UnknownAction| error.to_string())).collect()
    }
}

#[derive(Deserialize)]
struct AnyLine {
    kind: Option<String>,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Parsed {
    /// An event with its degree; `None` if the junction was not recognised.
    Event(VisitLine, Option<u32>),
    Other(String),
}

pub(super) fn is_events(head: &[u8]) -> bool {
    let mut lines = head
        .split(|&byte| byte == b'\n')
        .map(<[u8]>::trim_ascii)
        .filter(|line| !line.is_empty() && !line.starts_with(b"#"));
    match lines.next() {
        Some(line) if line.starts_with(b"{") => {
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
        if line.trim_start().starts_with('#') {
            return None;
        }
        let name = |cell: Cow<str>| NAMES.iter().position(|name| cell.eq_ignore_ascii_case(name));
        let columns = Self(cells(line).into_iter().map(name).collect());
        let has = |wanted: &str| {
            columns.0.iter().flatten().any(|&index| NAMES.get(index) == Some(&wanted))
        };
        (has("degree") && has("door")).then_some(columns)
    }

    pub(super) fn repeated(&self) -> Option<&'static str> {
        let known = || self.0.iter().flatten();
        let names = NAMES.iter().enumerate();
        let mut twice = names.filter(|(name, _)| known().filter(|one| *one == name).count() > 1);
        twice.next().map(|(_, name)| *name)
    }

    fn event(&self, line: &str) -> Result<VisitLine, String> {
        let mut event = VisitLine::default();
        let cells = cells(line);
        if cells.len() != self.0.len() {
            return Err(format!("it has {} cells, and the header {}", cells.len(), self.0.len()));
        }
        for (cell, column) in cells.into_iter().zip(&self.0) {
            let Some(name) = column.and_then(|column| NAMES.get(column)) else { continue };
            if is_empty(&cell) {
                if *name == "degree" {
                    event.degree = LineDegree::Given(None);
                }
                continue;
            }
            let wrong = || format!("its {name} is {:?}", cell.chars().take(20).collect::<String>());
            let whole = || {
                let number = whole_cell(&cell).and_then(|number| u32::try_from(number).ok());
                number.ok_or_else(wrong)
            };
            match *name {
                "index" => event.index = Some(whole()?),
                "stamp" => event.stamp = Some(cell.parse().map_err(|_| wrong())?),
                "degree" => event.degree = LineDegree::Given(Some(whole()?)),
                "door" => event.door = Some(whole()?),
                "actions" => event.actions = Some(cell.into_owned()),
                "marker" => {
                    let seen = bool_cell(&cell).map(LineMarker::Seen);
                    let door = || whole_cell(&cell).map(LineMarker::Door);
                    let words = || encode::sighting_in(&cell).map(LineMarker::Words);
                    event.marker = Some(seen.or_else(door).map_or_else(words, Ok)?);
                }
                _ => {
                    let number = || whole_cell(&cell).filter(|number| (0..=1).contains(number));
                    let turned = bool_cell(&cell).or_else(|| number().map(|number| number == 1));
                    event.turned_back = Some(turned.ok_or_else(wrong)?);
                }
            }
        }
        Ok(event)
    }
}

/// The cells of a CSV line. A cell in double quotes may have commas, and a quote as two.
fn cells(line: &str) -> Vec<Cow<'_, str>> {
    let mut cells = Vec::new();
    let mut rest = Some(line);
    while let Some(line) = rest {
        let (cell, next) = cell(line);
        cells.push(cell);
        rest = next;
    }
    cells
}

fn cell(line: &str) -> (Cow<'_, str>, Option<&str>) {
    let plain = || match line.split_once(',') {
        Some((cell, next)) => (cell.trim().into(), Some(next)),
        None => (line.trim().into(), None),
    };
    let Some(quoted) = line.trim_start().strip_prefix('"') else { return plain() };
    // Two quotes are one in the cell.
    let mut parts = quoted.split('"');
    let mut text = parts.next().unwrap_or_default().to_owned();
    let mut used = text.len() + 1;
    loop {
        match (parts.next(), parts.clone().next()) {
            (Some(""), Some(more)) => {
                text.push('"');
                text.push_str(more);
                parts.next();
                used += more.len() + 2;
            }
            (Some(_), _) => break,
            // There is no second quote.
            (None, _) => return plain(),
        }
    }
    let after = quoted.get(used..).unwrap_or_default();
    match after.split_once(',') {
        Some((space, next)) if space.trim().is_empty() => (text.into(), Some(next)),
        None if after.trim().is_empty() => (text.into(), None),
        _ => plain(),
    }
}

fn cause(error: &serde_json::Error) -> String {
    let message = error.to_string();
    message.split(" at line ").next().unwrap_or_default().replace(char::is_control, " ")
}

/// Reads a line; an error if it is not an event, and not another JSON object with a `kind`.
///
/// Takes at most 64 bytes of memory for each byte of the line, and 4096 besides.
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
    if let Some(stamp) = event.stamp.filter(|stamp| !(0.0..LATEST).contains(stamp)) {
        return Err(format!("its stamp is {stamp:?}; seconds are expected"));
    }
    event.sighting()?;
    event.actions()?;
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
            // A marker that points nowhere.
            (r#"{"degree":2,"door":1,"marker":true}"#, ",,2,1,true,,"),
            (r#"{"degree":2,"door":1,"marker":false}"#, ",,2,1,false,,"),
            // As tables of numbers that may be missing are written.
            (r#"{"index":3.0,"degree":2.0,"door":1.0,"marker":-1.0}"#, "3.0,nan,2.0,1.0,-1.0,NaN,"),
            (r#"{"degree":2,"door":null,"turned_back":true}"#, "NA,,2,<NA>,None,True,"),
            (r#"{"degree":2,"door":0,"marker":false,"turned_back":false}"#, ",,2,0,FALSE,0.0,"),
            // Not recognised, after turning back.
            (r#"{"degree":null,"turned_back":true}"#, ",,,,,true,"),
        ] {
            let Parsed::Event(event, degree) = parse(json.as_bytes(), None).unwrap() else {
                panic!("{json}")
            };
            assert_eq!(parse(csv.as_bytes(), Some(&columns)), Ok(Parsed::Event(event, degree)));
        }
        let columns_with_actions = Columns::read(b"degree,door,actions").unwrap();
        let json = br#"{"degree":2,"door":1,"actions":"pick-up drop"}"#;
        let csv = parse(b"2,1,pick-up drop", Some(&columns_with_actions)).unwrap();
        assert_eq!(parse(json, None), Ok(csv.clone()));
        let Parsed::Event(event, _) = csv else { panic!("{csv:?}") };
        assert_eq!(event.actions(), Ok(vec![AidAction::PickUp, AidAction::Drop]));
        let quoted =
            Columns::read(b"\"index\",stamp,\"degree\",door,marker,turned_back,\"a, note\"");
        assert_eq!(quoted, Some(Columns(columns.0.clone())));
        let line = |text: &str| parse(text.as_bytes(), quoted.as_ref()).unwrap();
        assert_eq!(line("3, \"41.2\" ,\"3\",1,,,\"a, \"\"note\"\"\""), line("3,41.2,3,1,,,a note"));
        let other = parse(br#"{"kind":"conform","marker":"none"}"#, None);
        assert_eq!(other, Ok(Parsed::Other("conform".into())));
    }

    #[test]
    fn a_file_of_events_may_begin_with_comments() {
        for head in ["# by hand\n\n{\"degree\":3}\n", "  # by hand\ndegree,door\n3,1\n"] {
            assert!(is_events(head.as_bytes()), "{head:?}");
        }
        for head in ["", "# by,degree,door\n", "# a CARMEN log\nPARAM robot_length 0.4\n"] {
            assert!(!is_events(head.as_bytes()), "{head:?}");
        }
    }

    /// The header of a CSV file, a line, and its error. Of 13 digits are milliseconds.
    const ERRORS: &str = r#"
 | {"door":1} | it has no degree
 | {"degree": | EOF while parsing a value
 | {"degree":-1} | invalid value: integer `-1`, expected u32
 | {"degree":2,"stamp":-1} | its stamp is -1.0; seconds are expected
 | {"degree":2,"stamp":1e300} | its stamp is 1e300; seconds are expected
 | {"degree":2,"stamp":1700000000000} | its stamp is 1700000000000.0; seconds are expected
degree,door,stamp | 2,1,9e99 | its stamp is 9e99; seconds are expected
 | {"degree":2,"marker":-9} | its marker is -9, which is not a door and not -1, no marker
 | {"degree":2,"marker":99999999999} | its marker is 99999999999, which is not a door and not -1, no marker
 | {"degree":2,"marker":[]} | invalid type: sequence, expected the marker: a door, -1, true, false, words or null
 | {"degree":2,"marker":"north"} | `north` is not what a robot sees of a marking aid; that is written as in `marker along door 1`, `2 markers`, `first marker`, `string through door 0, fixed end` or `robot 2 here along door 1`
degree,door,marker | 2,1,north | `north` is not what a robot sees of a marking aid; that is written as in `marker along door 1`, `2 markers`, `first marker`, `string through door 0, fixed end` or `robot 2 here along door 1`
degree,door,actions | 2,1,lift | `lift` is not an action; write a door number, pick-up, drop, pick-up-2, drop-2 or send-2:1
 | {"degree":2,"actions":"drop 2"} | `2` is not an action; write a door number, pick-up, drop, pick-up-2, drop-2 or send-2:1
degree,door | 2 | it has 1 cells, and the header 2
degree,door | 2,x | its door is "x"
degree,door | 2,1.5 | its door is "1.5"
 | {"degree":2.5} | invalid type: floating point `2.5`, expected u32
 | {"degree":2,"turned_back":1} | invalid type: integer `1`, expected a boolean"#;

    #[test]
    fn a_wrong_line_is_an_error() {
        for row in ERRORS.lines().skip(1) {
            let [header, line, error]: [&str; 3] =
                row.split(" | ").collect::<Vec<_>>().try_into().unwrap();
            let columns = Columns::read(header.as_bytes());
            assert_eq!(parse(line.as_bytes(), columns.as_ref()), Err(error.to_owned()), "{line}");
        }
        assert_eq!(Columns::read(b"degree,exit"), None);
        let repeated = Columns::read(b"degree,door,marker,Marker").unwrap();
        assert_eq!(repeated.repeated(), Some("marker"));
        assert_eq!(Columns::read(b"degree,door").unwrap().repeated(), None);
    }
}
