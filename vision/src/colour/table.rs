//! The classifier as one lookup.

use super::Class;

/// The class of every colour, six bits a channel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ColourTable {
    /// At index `red << 12 | green << 6 | blue`, each of six bits.
    pub(crate) classes: Vec<Class>,
}

/// By what an image's channels are multiplied.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gain(pub [f64; 3]);

/// A colour table for images of one gain.
#[derive(Clone, Debug)]
pub struct LitTable<'a> {
    classes: &'a [Class],
    /// For each channel, where the value leads in `classes`.
    offsets: [[u32; 256]; 3],
}

impl ColourTable {
    /// The table for images that are brought to the common light by this gain.
    #[must_use]
    pub fn lit(&self, gain: Gain) -> LitTable<'_> {
        let offset = |channel: usize, value: usize| {
            let bright = (value as f64 * gain.0[channel]).round().clamp(0.0, 255.0);
            (bright as u32 >> 2) << (12 - 6 * channel)
        };
        let mut offsets = [[0; 256]; 3];
        for (channel, table) in offsets.iter_mut().enumerate() {
            for (value, entry) in table.iter_mut().enumerate() {
                *entry = offset(channel, value);
            }
        }
        LitTable { classes: &self.classes, offsets }
    }
}

impl LitTable<'_> {
    /// The class of a colour.
    #[inline]
    #[must_use]
    pub fn class(&self, [red, green, blue]: [u8; 3]) -> Class {
        let [reds, greens, blues] = &self.offsets;
        let index = reds[red as usize] | greens[green as usize] | blues[blue as usize];
        self.classes[index as usize]
    }
}
