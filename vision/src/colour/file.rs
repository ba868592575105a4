//! Colour files: a [`ColourModel`] as TOML, which people can read and change.

use std::fmt::{self, Write as _};

use thiserror::Error;
use toml::{Table as Toml, Value};
use toposlam_model::format::place::Place;

use super::{
    Class, ColourModel, Priors, Smoothing, Stripe, StripeKind, hsv::Bin, model::Histogram,
};

/// The version of the files that are written and read.
const VERSION: i64 = 1;
const CLASSES: [&str; 4] = ["floor", "stripe", "marker", "other"];
/// More pixels of a colour nobody counts.
const MOST_PIXELS: i64 = 1_000_000_000_000;

/// Why bytes are not a colour file: one message that names place and cause.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{place}{cause}")]
pub struct ColourFileError {
    /// Where in the file.
    pub place: Place,
    /// What is wrong there.
    #[source]
    pub cause: Cause,
}

/// What can be wrong at a place of a colour file.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Cause {
    /// The bytes are not UTF-8.
    #[error("this is not UTF-8 text")]
    NotText,
    /// The text is not TOML.
    #[error("{0}")]
    Syntax(String),
    /// The file is of another version.
    #[error("this is version {found} of colour files; only version {VERSION} is read")]
    Version {
        /// The version.
        found: i64,
    },
    /// A key that has no meaning here.
    #[error("unknown key; here can stand: {known}")]
    UnknownKey {
        /// The keys that have one.
        known: String,
    },
    /// A key that must be here is not.
    #[error("the key `{key}` is missing")]
    MissingKey {
        /// The key.
        key: &'static str,
    },
    /// A value of the wrong kind.
    #[error("here should be {expected}, not {found}")]
    WrongKind {
        /// What should be here.
        expected: &'static str,
        /// What is here.
        found: &'static str,
    },
    /// A number that cannot be.
    #[error("{what} is {found}; it can be from {least} to {most}")]
    OutOfRange {
        /// What the number is.
        what: &'static str,
        /// The number.
        found: f64,
        /// The least that it can be.
        least: f64,
        /// The most that it can be.
        most: f64,
    },
    /// A kind of stripe that there is not.
    #[error("there is no stripe on the `{found}`; there are floor and wall")]
    NoSuchStripe {
        /// What was given.
        found: String,
    },
    /// A bin that stands twice.
    #[error("value {value}, chroma {chroma}, hue {hue} has stood before")]
    BinTwice {
        /// The bin's value.
        value: u8,
        /// Its chroma.
        chroma: u8,
        /// Its hue.
        hue: u16,
    },
    /// A class that must have a colour has none.
    #[error("there is no colour; floor and stripe must have one")]
    NoColour,
}

impl Cause {
    fn at(self, path: impl Into<String>) -> ColourFileError {
        ColourFileError { place: Place::Key(path.into()), cause: self }
    }

    fn in_file(self) -> ColourFileError {
        ColourFileError { place: Place::File, cause: self }
    }

    fn at_byte(self, text: &str, byte: usize) -> ColourFileError {
        ColourFileError { place: Place::at_byte(text.as_bytes(), byte), cause: self }
    }
}

impl StripeKind {
    /// Where it is, in a word: floor or wall.
    #[must_use]
    pub fn place(self) -> &'static str {
        match self {
            Self::OnFloor => "floor",
            Self::OnWall => "wall",
        }
    }
}

impl ColourModel {
    /// The model as a colour file.
    #[must_use]
    pub fn to_toml(&self) -> String {
        let Self { stripe, floor: [red, green, blue], priors, smoothing, .. } = self;
        let mut text = format!(
            "\
# The colours of a building, learned by `toposlam train`.
version = {VERSION}

[stripe]
kind = \"{}\" # on the floor along the wall, or on the wall at its foot
width = {:?} # metres

[floor]
colour = [{red:?}, {green:?}, {blue:?}] # red, green and blue to which each image's floor is brought

[priors] # how likely each class is before its colour is seen; only their ratios matter
floor = {:?}
stripe = {:?}
marker = {:?}
other = {:?}

[smoothing]
colour = {:?} # by how much the same colour differs in the same light, in steps of chroma
light = {:?} # by which share the light differs from place to place
unknown_below = {:?} # a colour is unknown of which each class has a smaller share

# What each class looks like, as [value, chroma, hue, pixels]. The value is the greatest of red,
# green and blue, in steps of 8 of 256; the chroma, in steps of 4, is what the greatest is above the
# least. At chroma c hues count from 0 to 6 c - 1: 0 is red, 2 c green, 4 c blue.
[histograms]
",
            stripe.kind.place(),
            stripe.width,
            priors.floor,
            priors.stripe,
            priors.marker,
            priors.other,
            smoothing.colour,
            smoothing.light,
            self.unknown_below,
        );
        for (class, histogram) in Class::LEARNED.into_iter().zip(&self.histograms) {
            text += class.name();
            text += " = [\n";
            for (Bin { value, chroma, hue }, pixels) in histogram {
                // Writing to a string does not fail.
                let _ = writeln!(text, "  [{value}, {chroma}, {hue}, {pixels}],");
            }
            text += "]\n";
        }
        text
    }

    /// Reads a colour file.
    ///
    /// Reading takes at most 512 bytes of memory for each byte of the file, and 4096 besides.
    ///
    /// # Errors
    /// The first thing that is wrong, with its place. No bytes make it panic.
    pub fn read(bytes: &[u8]) -> Result<Self, ColourFileError> {
        let text = std::str::from_utf8(bytes).map_err(|error| {
            let valid = &bytes[..error.valid_up_to()];
            Cause::NotText.at_byte(&String::from_utf8_lossy(valid), valid.len())
        })?;
        let parsed: Toml = toml::from_str(text).map_err(|error| {
            let message = error.message().replace('\n', ", ");
            Cause::Syntax(message).at_byte(text, error.span().map_or(0, |span| span.start))
        })?;
        read_file(parsed)
    }
}

fn read_file(parsed: Toml) -> Result<ColourModel, ColourFileError> {
    // A file of another version may have other keys.
    match parsed.get("version") {
        Some(Value::Integer(VERSION)) => {}
        Some(Value::Integer(found)) => return Err(Cause::Version { found: *found }.in_file()),
        Some(other) => return Err(wrong_kind("version", "a whole number", other)),
        None => return Err(Cause::MissingKey { key: "version" }.in_file()),
    }
    let keys = &["version", "stripe", "floor", "priors", "smoothing", "histograms"];
    let mut file = Table::new("", parsed, keys)?;
    let stripe = read_stripe(file.table("stripe", &["kind", "width"])?)?;
    let floor = read_colour(file.table("floor", &["colour"])?)?;
    let mut table = file.table("priors", &CLASSES)?;
    let mut prior = |class| table.number(class, "a prior", 1e-6, 1.0);
    let priors = Priors {
        floor: prior("floor")?,
        stripe: prior("stripe")?,
        marker: prior("marker")?,
        other: prior("other")?,
    };
    let mut table = file.table("smoothing", &["colour", "light", "unknown_below"])?;
    let smoothing = Smoothing {
        colour: table.number("colour", "the difference of colour", 0.1, 4.0)?,
        light: table.number("light", "the difference of light", 0.0, 0.5)?,
    };
    let unknown_below = table.number("unknown_below", "the share", 0.0, 0.1)?;
    let mut table = file.table("histograms", &CLASSES)?;
    let histograms = [
        read_histogram(&mut table, "floor")?,
        read_histogram(&mut table, "stripe")?,
        read_histogram(&mut table, "marker")?,
        read_histogram(&mut table, "other")?,
    ];
    for (class, histogram) in [("floor", &histograms[0]), ("stripe", &histograms[1])] {
        if histogram.is_empty() {
            return Err(Cause::NoColour.at(format!("histograms.{class}")));
        }
    }
    Ok(ColourModel { stripe, floor, priors, smoothing, unknown_below, histograms })
}

fn read_stripe(mut table: Table) -> Result<Stripe, ColourFileError> {
    let kind = match table.need("kind")? {
        Value::String(kind) if kind == "floor" => StripeKind::OnFloor,
        Value::String(kind) if kind == "wall" => StripeKind::OnWall,
        Value::String(found) => {
            let found = found.escape_debug().to_string();
            return Err(Cause::NoSuchStripe { found }.at("stripe.kind"));
        }
        other => return Err(wrong_kind("stripe.kind", "a text", &other)),
    };
    let [least, most] = Stripe::WIDTHS;
    Ok(Stripe { kind, width: table.number("width", "the width in metres", least, most)? })
}

fn read_colour(mut table: Table) -> Result<[f64; 3], ColourFileError> {
    const EXPECTED: &str = "a list of three numbers, red, green and blue";
    let path = "floor.colour";
    let levels = match table.need("colour")? {
        Value::Array(levels) => levels,
        other => return Err(wrong_kind(path, EXPECTED, &other)),
    };
    let [red, green, blue] = levels.as_slice() else {
        return Err(
            Cause::WrongKind { expected: EXPECTED, found: "a list of another length" }.at(path)
        );
    };
    let level = |value| in_range(path, number(path, value)?, "a channel", 1.0, 255.0);
    Ok([level(red)?, level(green)?, level(blue)?])
}

fn read_histogram(table: &mut Table, class: &'static str) -> Result<Histogram, ColourFileError> {
    let path = format!("histograms.{class}");
    let rows = match table.need(class)? {
        Value::Array(rows) => rows,
        other => return Err(wrong_kind(&path, "a list of bins", &other)),
    };
    let mut histogram = Vec::with_capacity(rows.len());
    for (nth, row) in rows.iter().enumerate() {
        let (bin, pixels) = read_bin(row).map_err(|cause| cause.at(format!("{path}[{nth}]")))?;
        histogram.push((bin, pixels));
    }
    histogram.sort_unstable();
    match histogram.windows(2).find(|pair| pair[0].0 == pair[1].0) {
        Some(&[(Bin { value, chroma, hue }, _), _]) => {
            Err(Cause::BinTwice { value, chroma, hue }.at(path))
        }
        _ => Ok(histogram),
    }
}

fn read_bin(row: &Value) -> Result<(Bin, u64), Cause> {
    const EXPECTED: &str = "a list of four whole numbers, value, chroma, hue and pixels";
    let wrong = |found| Cause::WrongKind { expected: EXPECTED, found };
    let numbers = row.as_array().ok_or_else(|| wrong(kind(row)))?;
    let [value, chroma, hue, pixels] = numbers.as_slice() else {
        return Err(wrong("a list of another length"));
    };
    let whole = |number: &Value, what, least: i64, most: i64| match number {
        Value::Integer(found) if (least..=most).contains(found) => Ok(*found as u64),
        Value::Integer(found) => {
            let [found, least, most] = [*found, least, most].map(|number| number as f64);
            Err(Cause::OutOfRange { what, found, least, most })
        }
        other => Err(wrong(kind(other))),
    };
    let value = whole(value, "the value", 0, 31)? as u8;
    let chroma = whole(chroma, "the chroma", 0, Bin::most_chroma(value).into())? as u8;
    let hue = whole(hue, "the hue", 0, i64::from(Bin::hues(chroma)) - 1)? as u16;
    Ok((Bin { value, chroma, hue }, whole(pixels, "the number of pixels", 1, MOST_PIXELS)?))
}

/// A table of which only known keys are taken.
struct Table {
    path: &'static str,
    entries: Toml,
}

impl Table {
    fn new(path: &'static str, entries: Toml, known: &[&str]) -> Result<Self, ColourFileError> {
        match entries.keys().find(|key| !known.contains(&key.as_str())) {
            Some(key) => {
                Err(Cause::UnknownKey { known: known.join(", ") }
                    .at(join(path, &key.escape_debug())))
            }
            None => Ok(Self { path, entries }),
        }
    }

    fn need(&mut self, key: &'static str) -> Result<Value, ColourFileError> {
        self.entries.remove(key).ok_or_else(|| {
            let cause = Cause::MissingKey { key };
            if self.path.is_empty() { cause.in_file() } else { cause.at(self.path) }
        })
    }

    fn table(&mut self, key: &'static str, known: &[&str]) -> Result<Self, ColourFileError> {
        match self.need(key)? {
            Value::Table(entries) => Self::new(key, entries, known),
            other => Err(wrong_kind(key, "a table", &other)),
        }
    }

    fn number(
        &mut self,
        key: &'static str,
        what: &'static str,
        least: f64,
        most: f64,
    ) -> Result<f64, ColourFileError> {
        let value = self.need(key)?;
        let path = join(self.path, &key);
        in_range(&path, number(&path, &value)?, what, least, most)
    }
}

fn join(path: &str, key: &impl fmt::Display) -> String {
    if path.is_empty() { key.to_string() } else { format!("{path}.{key}") }
}

fn number(path: &str, value: &Value) -> Result<f64, ColourFileError> {
    match value {
        Value::Float(number) => Ok(*number),
        Value::Integer(number) => Ok(*number as f64),
        other => Err(wrong_kind(path, "a number", other)),
    }
}

fn in_range(
    path: &str,
    found: f64,
    what: &'static str,
    least: f64,
    most: f64,
) -> Result<f64, ColourFileError> {
    if (least..=most).contains(&found) {
        Ok(found)
    } else {
        Err(Cause::OutOfRange { what, found, least, most }.at(path))
    }
}

fn wrong_kind(path: &str, expected: &'static str, found: &Value) -> ColourFileError {
    Cause::WrongKind { expected, found: kind(found) }.at(path)
}

fn kind(value: &Value) -> &'static str {
    match value {
        Value::String(_) => "a text",
        Value::Integer(_) => "a whole number",
        Value::Float(_) => "a number",
        Value::Boolean(_) => "true or false",
        Value::Datetime(_) => "a date",
        Value::Array(_) => "a list",
        Value::Table(_) => "a table",
    }
}

#[cfg(test)]
mod tests;
