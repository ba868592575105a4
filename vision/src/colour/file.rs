//! Colour files: a [`ColourModel`] as TOML, which people can read and change.

use std::fmt::Write as _;

use thiserror::Error;
use toposlam_model::format::document::{
    Document, DocumentError, DocumentErrorKind, DocumentTable, DocumentValue, FileError,
};

use super::{ColourModel, PixelClass, Smoothing, Stripe, StripeKind, hsv::Bin, model::Histogram};

const VERSION: i64 = 1;
const CLASSES: [&str; 4] = ["floor", "stripe", "marker", "other"];
const MOST_PIXELS: i64 = 1_000_000_000_000;

pub type ColourFileError = FileError<ColourFileErrorKind>;

#[derive(Clone, Debug, PartialEq, Error)]
pub enum ColourFileErrorKind {
    #[error(transparent)]
    Document(#[from] DocumentErrorKind),
    #[error("this is version {found} of colour files; only version {VERSION} can be read")]
    Version { found: i64 },
    #[error("there are two rows with value {value}, chroma {chroma}, hue {hue}")]
    BinTwice { value: u8, chroma: u8, hue: u16 },
    #[error("there is no colour; floor and stripe must have one")]
    NoColour,
}

impl StripeKind {
    /// Its place in one word: floor or wall.
    pub fn place(self) -> &'static str {
        match self {
            Self::OnFloor => "floor",
            Self::OnWall => "wall",
        }
    }
}

impl ColourModel {
    pub fn to_toml(&self) -> String {
        let Self { stripe, floor: [red, green, blue], smoothing, .. } = self;
        let [floor, stripe_prior, marker, other] = self.priors;
        let mut text = format!(
            "\
# The colours of a building, learned by `toposlam camera train`.
version = {VERSION}

[stripe]
kind = \"{}\" # on the floor along the wall, or on the wall at its foot
width = {:?} # metres

[floor]
colour = [{red:?}, {green:?}, {blue:?}] # red, green and blue to which each image's floor is brought

[priors] # how likely each class is before its colour is seen; only their ratios matter
floor = {floor:?}
stripe = {stripe_prior:?}
marker = {marker:?}
other = {other:?}

[smoothing]
colour = {:?} # by how much the same colour differs in the same light, in steps of chroma
light = {:?} # by which share the light differs from place to place
unknown_below = {:?} # a colour is unknown if each class has a smaller share of it

# What each class looks like, as [value, chroma, hue, pixels]. The value is the greatest of red,
# green and blue, in steps of 8 of 256; the chroma, in steps of 4, is what the greatest is above the
# least. At chroma c hues count from 0 to 6 c - 1: 0 is red, 2 c green, 4 c blue.
[histograms]
",
            stripe.kind.place(),
            stripe.width,
            smoothing.colour,
            smoothing.light,
            self.unknown_below,
        );
        for (class, histogram) in PixelClass::LEARNED.into_iter().zip(&self.histograms) {
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
    /// Returns an error if the bytes are not a colour file. No bytes make it panic.
    pub fn read(bytes: &[u8]) -> Result<Self, ColourFileError> {
        let document = Document::parse_toml(bytes)?;
        // A file of another version may have other keys.
        let version = document.root().any_table()?.need("version")?;
        let found = version.whole()?;
        if found != VERSION {
            return Err(version.position().error(ColourFileErrorKind::Version { found }));
        }
        let keys = ["version", "stripe", "floor", "priors", "smoothing", "histograms"];
        let file = document.root().table(&keys)?;
        let stripe = read_stripe(file.need("stripe")?)?;
        let floor = read_colour(file.need("floor")?.table(&["colour"])?.need("colour")?)?;
        let table = file.need("priors")?.table(&CLASSES)?;
        let mut priors = [0.0; 4];
        for (prior, class) in priors.iter_mut().zip(CLASSES) {
            *prior = table.need(class)?.number_in("a prior", 1e-6..=1.0)?;
        }
        let table = file.need("smoothing")?.table(&["colour", "light", "unknown_below"])?;
        let smoothing = Smoothing {
            colour: table.need("colour")?.number_in("the difference of colour", 0.1..=4.0)?,
            light: table.need("light")?.number_in("the difference of light", 0.0..=0.5)?,
        };
        let unknown_below = table.need("unknown_below")?.number_in("the share", 0.0..=0.1)?;
        let table = file.need("histograms")?.table(&CLASSES)?;
        let mut histograms: [Histogram; 4] = Default::default();
        for (histogram, class) in histograms.iter_mut().zip(CLASSES) {
            *histogram = read_histogram(&table, class)?;
        }
        for (class, histogram) in ["floor", "stripe"].into_iter().zip(&histograms) {
            if histogram.is_empty() {
                return Err(table.need(class)?.position().error(ColourFileErrorKind::NoColour));
            }
        }
        Ok(Self { stripe, floor, priors, smoothing, unknown_below, histograms })
    }
}

fn read_stripe(value: DocumentValue<'_>) -> Result<Stripe, DocumentError> {
    let table = value.table(&["kind", "width"])?;
    let kinds = [StripeKind::OnFloor, StripeKind::OnWall].map(|kind| (kind.place(), kind));
    let kind = table.need("kind")?.word(&kinds)?;
    let [least, most] = Stripe::WIDTHS;
    let width = table.need("width")?.number_in("the width in metres", least..=most)?;
    Ok(Stripe { kind, width })
}

fn read_colour(value: DocumentValue<'_>) -> Result<[f64; 3], DocumentError> {
    let [red, green, blue] = value.array("a list of three numbers, red, green and blue")?;
    let level = |value: DocumentValue<'_>| value.number_in("a channel", 1.0..=255.0);
    Ok([level(red)?, level(green)?, level(blue)?])
}

fn read_histogram(
    table: &DocumentTable<'_>,
    class: &'static str,
) -> Result<Histogram, ColourFileError> {
    let rows = || table.need(class)?.list("a list of bins");
    let mut histogram = rows()?.map(read_bin).collect::<Result<Histogram, _>>()?;
    histogram.sort_unstable();
    let Some(&[(bin, _), _]) = histogram.windows(2).find(|pair| pair[0].0 == pair[1].0) else {
        return Ok(histogram);
    };
    let is_bin = |row: &DocumentValue<'_>| read_bin(*row).is_ok_and(|(found, _)| found == bin);
    let second = rows()?.filter(is_bin).nth(1);
    let Bin { value, chroma, hue } = bin;
    let kind = ColourFileErrorKind::BinTwice { value, chroma, hue };
    Err(second.unwrap_or(table.need(class)?).position().error(kind))
}

fn read_bin(row: DocumentValue<'_>) -> Result<(Bin, u64), DocumentError> {
    let [value, chroma, hue, pixels] =
        row.array("a list of four whole numbers, value, chroma, hue and pixels")?;
    let value = value.whole_in("the value", 0..=31)? as u8;
    let chroma = chroma.whole_in("the chroma", 0..=Bin::most_chroma(value).into())? as u8;
    let hue = hue.whole_in("the hue", 0..=i64::from(Bin::hues(chroma)) - 1)? as u16;
    let pixels = pixels.whole_in("the number of pixels", 1..=MOST_PIXELS)? as u64;
    Ok((Bin { value, chroma, hue }, pixels))
}

#[cfg(test)]
mod tests;
