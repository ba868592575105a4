//! The classifier as one lookup.

use std::{array::from_fn, sync::LazyLock};

use super::PixelClass;

/// The class of every colour, with six bits per channel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ColourTable {
    /// At index `red << 12 | green << 6 | blue`, each of six bits.
    pub(crate) classes: Vec<PixelClass>,
}

pub(super) const CELLS: usize = 1 << 18;

/// The middle of the colours with 256 levels per channel that have this index.
pub(super) fn centre(cell: usize) -> [f64; 3] {
    [12, 6, 0].map(|shift| (4 * (cell >> shift & 63)) as f64 + 1.5)
}

/// The factors for the light of an image's channels: red, green and blue.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gain(pub [f64; 3]);

/// The light of a level, from 0 to 1, by the curve of sRGB, which most cameras use or nearly. Lamps
/// multiply light; multiplied levels would make dark surfaces too dark.
fn light(level: f64) -> f64 {
    let part = level / 255.0;
    if part <= 0.04045 { part / 12.92 } else { ((part + 0.055) / 1.055).powf(2.4) }
}

/// The light of each level.
static LIGHTS: LazyLock<[f64; 256]> = LazyLock::new(|| from_fn(|level| light(level as f64)));
/// The least light of each six bits but the first: levels are rounded.
static STEPS: LazyLock<[f64; 63]> =
    LazyLock::new(|| from_fn(|step| light(4.0 * step as f64 + 3.5)));

impl Gain {
    pub(super) fn between(from: [f64; 3], to: [f64; 3]) -> Self {
        Self(from_fn(|channel| light(to[channel]) / light(from[channel])))
    }

    /// For each level of each channel, its part of a colour's index.
    pub(super) fn offsets(self) -> [[u32; 256]; 3] {
        from_fn(|channel| {
            LIGHTS.map(|light| {
                let bits = STEPS.partition_point(|&least| least <= light * self.0[channel]);
                (bits as u32) << (12 - 6 * channel)
            })
        })
    }
}

/// The index of a colour, from the parts of its channels.
#[inline]
pub(super) fn index([reds, greens, blues]: &[[u32; 256]; 3], [red, green, blue]: [u8; 3]) -> usize {
    (reds[red as usize] | greens[green as usize] | blues[blue as usize]) as usize
}

/// A colour table for images of one gain.
#[derive(Clone, Debug)]
pub struct LitTable<'a> {
    classes: &'a [PixelClass],
    /// For each level of each channel, its part of the index in `classes`.
    offsets: [[u32; 256]; 3],
}

impl ColourTable {
    pub fn lit(&self, gain: Gain) -> LitTable<'_> {
        LitTable { classes: &self.classes, offsets: gain.offsets() }
    }
}

impl LitTable<'_> {
    #[inline]
    pub fn class(&self, colour: [u8; 3]) -> PixelClass {
        self.classes[index(&self.offsets, colour)]
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn the_gain_of_no_change_keeps_every_level() {
        let offsets = Gain([1.0; 3]).offsets();
        for level in 0..=255_u8 {
            let cell = index(&offsets, [level; 3]);
            assert_eq!(cell, usize::from(level >> 2) * 0b1_000_001_000_001);
            assert!(centre(cell).iter().all(|middle| (middle - f64::from(level)).abs() <= 1.5));
        }
    }

    #[test]
    fn half_the_light_is_that_of_srgb() {
        // 50 % grey is level 188, a quarter 137, as printed in tables of sRGB.
        let gain = Gain([0.5, 0.25, 1.0]);
        let centre = centre(index(&gain.offsets(), [255, 255, 255]));
        assert!((centre[0] - 188.0).abs() < 2.0 && (centre[1] - 137.0).abs() < 2.0, "{centre:?}");
        assert!((centre[2] - 253.5).abs() < 1e-9);
    }

    #[test]
    fn no_gain_leaves_the_table() {
        for gain in [0.0, -1.0, 1e300, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let offsets = Gain([gain; 3]).offsets();
            for level in 0..=255 {
                assert!(index(&offsets, [level; 3]) < CELLS);
            }
        }
    }

    /// The level of a light, by the curve of sRGB.
    fn level(light: f64) -> f64 {
        let part = if light <= 0.003_130_8 {
            light * 12.92
        } else {
            1.055 * light.powf(1.0 / 2.4) - 0.055
        };
        255.0 * part
    }

    proptest! {
        #[test]
        fn offsets_are_the_upper_bits_of_levels_in_the_other_light(
            gain in prop::array::uniform3(0.01..100.0_f64),
        ) {
            let offsets = Gain(gain).offsets();
            for channel in 0..3 {
                for (dark, &offset) in offsets[channel].iter().enumerate() {
                    let bright = level(light(dark as f64) * gain[channel]).round().min(255.0);
                    prop_assert_eq!(offset, (bright as u32 >> 2) << (12 - 6 * channel));
                }
            }
        }

        #[test]
        fn a_gain_brings_one_colour_to_another(
            from in prop::array::uniform3(4..250_u8), to in prop::array::uniform3(4..250_u8),
        ) {
            let gain = Gain::between(from.map(f64::from), to.map(f64::from));
            let plain = Gain([1.0; 3]);
            prop_assert_eq!(index(&gain.offsets(), from), index(&plain.offsets(), to));
        }
    }
}
