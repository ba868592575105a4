//! The classifier as one lookup.

use super::Class;

/// The class of every colour, six bits a channel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ColourTable {
    /// At index `red << 12 | green << 6 | blue`, each of six bits.
    pub(crate) classes: Vec<Class>,
}

/// How many colours there are of six bits a channel.
pub(super) const CELLS: usize = 1 << 18;

/// The middle of the colours of 256 levels a channel that have this index.
pub(super) fn centre(cell: usize) -> [f64; 3] {
    [12, 6, 0].map(|shift| (4 * (cell >> shift & 63)) as f64 + 1.5)
}

/// By what an image's channels are multiplied.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gain(pub [f64; 3]);

impl Gain {
    /// For each level of each channel, its part of the index of a colour.
    pub(super) fn offsets(self) -> [[u32; 256]; 3] {
        let offset = |channel: usize, level: usize| {
            let bright = (level as f64 * self.0[channel]).round().clamp(0.0, 255.0);
            (bright as u32 >> 2) << (12 - 6 * channel)
        };
        let mut offsets = [[0; 256]; 3];
        for (channel, table) in offsets.iter_mut().enumerate() {
            for (level, entry) in table.iter_mut().enumerate() {
                *entry = offset(channel, level);
            }
        }
        offsets
    }
}

/// The index of a colour, of the parts of its channels.
#[inline]
pub(super) fn index([reds, greens, blues]: &[[u32; 256]; 3], [red, green, blue]: [u8; 3]) -> usize {
    (reds[red as usize] | greens[green as usize] | blues[blue as usize]) as usize
}

/// A colour table for images of one gain.
#[derive(Clone, Debug)]
pub struct LitTable<'a> {
    classes: &'a [Class],
    /// For each channel, where the level leads in `classes`.
    offsets: [[u32; 256]; 3],
}

impl ColourTable {
    /// The table for images that are brought to the common light by this gain.
    #[must_use]
    pub fn lit(&self, gain: Gain) -> LitTable<'_> {
        LitTable { classes: &self.classes, offsets: gain.offsets() }
    }
}

impl LitTable<'_> {
    /// The class of a colour.
    #[inline]
    #[must_use]
    pub fn class(&self, colour: [u8; 3]) -> Class {
        self.classes[index(&self.offsets, colour)]
    }
}
