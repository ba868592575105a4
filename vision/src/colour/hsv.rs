//! HSV colours, in bins of about the same size.
//!
//! Saturation is told as chroma, which is saturation times value: the noise of a camera makes the
//! saturation, and with it the hue, of dark colours mean nothing, while chroma stays small there.
//! Bins are eight levels of 256 wide in value and in chroma. The hues of one chroma lie on a ring
//! around the greys; the ring at chroma `8 r` has `6 r` bins, so that each is again eight levels of
//! the middle channel long. Greys, in the middle, have one bin and no hue.

/// A bin of colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct Bin {
    /// Eighths of the levels of the brightest channel, from 0 to 31.
    pub(super) value: u8,
    /// Eighths of the levels from the darkest to the brightest channel, from 0 to `value`.
    pub(super) chroma: u8,
    /// Where on the ring of this chroma, counted from red by way of green and blue.
    pub(super) hue: u8,
}

/// Bins along the value.
pub(super) const VALUES: usize = 32;
/// Bins of the same value.
pub(super) const PLANE: usize = 1 + ring_start(32);
/// All bins.
pub(super) const BINS: usize = VALUES * PLANE;

/// How many bins the rings before this one have, without the greys.
const fn ring_start(chroma: usize) -> usize {
    3 * chroma * (chroma - 1)
}

/// Levels a bin.
const WIDTH: f64 = 8.0;

impl Bin {
    /// The bin of a colour, red, green and blue from 0 to 255.
    pub(super) fn of([red, green, blue]: [f64; 3]) -> Self {
        let value = red.max(green).max(blue);
        let chroma = value - red.min(green).min(blue);
        // In sixths of the circle.
        let hue = if value <= red {
            ((green - blue) / chroma).rem_euclid(6.0)
        } else if value <= green {
            (blue - red) / chroma + 2.0
        } else {
            (red - green) / chroma + 4.0
        };
        let ring = (chroma / WIDTH) as u8;
        // Greys have no hue.
        let hue = if ring == 0 { 0 } else { (hue * f64::from(ring)).round() as u8 % (6 * ring) };
        Self { value: (value / WIDTH) as u8, chroma: ring, hue }
    }

    /// How many hues there are at a chroma.
    pub(super) fn hues(chroma: u8) -> u8 {
        if chroma == 0 { 1 } else { 6 * chroma }
    }

    /// Its place among those of the same value.
    pub(super) fn in_plane(self) -> usize {
        let hue = usize::from(self.hue);
        if self.chroma == 0 { 0 } else { 1 + ring_start(self.chroma.into()) + hue }
    }

    /// Its place among all.
    pub(super) fn index(self) -> usize {
        usize::from(self.value) * PLANE + self.in_plane()
    }

    /// Where it lies among those of the same value, in bins, the greys in the middle. Hues lie on a
    /// hexagon, along which one channel changes after the other.
    fn place(self) -> [f64; 2] {
        if self.chroma == 0 {
            return [0.0, 0.0];
        }
        let along = f64::from(self.hue) / f64::from(self.chroma);
        let corner = |sixth: f64| (sixth * std::f64::consts::FRAC_PI_3).sin_cos();
        let ((from_y, from_x), (to_y, to_x)) = (corner(along.floor()), corner(along.floor() + 1.0));
        let part = along.fract();
        [from_x + (to_x - from_x) * part, from_y + (to_y - from_y) * part]
            .map(|coordinate| coordinate * f64::from(self.chroma))
    }

    /// All that have the same value and lie no more than `reach` bins away, each with its distance.
    pub(super) fn around(self, reach: f64) -> impl Iterator<Item = (Self, f64)> {
        let rings = reach as u8 + 1;
        let chromas = self.chroma.saturating_sub(rings)..=(self.chroma + rings).min(31);
        let [x, y] = self.place();
        chromas
            .flat_map(|chroma| (0..Self::hues(chroma)).map(move |hue| (chroma, hue)))
            .map(move |(chroma, hue)| {
                let bin = Self { value: self.value, chroma, hue };
                let [other_x, other_y] = bin.place();
                (bin, (other_x - x).hypot(other_y - y))
            })
            .filter(move |&(_, distance)| distance <= reach)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use proptest::prelude::*;

    use super::*;

    fn all() -> impl Iterator<Item = Bin> {
        (0..32).flat_map(|value| {
            (0..32).flat_map(move |chroma| {
                (0..Bin::hues(chroma)).map(move |hue| Bin { value, chroma, hue })
            })
        })
    }

    #[test]
    fn every_bin_has_a_place_of_its_own() {
        let places: HashSet<_> = all().map(Bin::index).collect();
        assert_eq!(places.len(), BINS);
        assert_eq!(places.into_iter().max(), Some(BINS - 1));
        assert_eq!(BINS, 95_264);
    }

    #[test]
    fn primary_colours_lie_a_sixth_of_the_circle_apart() {
        let colours =
            [[255, 0, 0], [255, 255, 0], [0, 255, 0], [0, 255, 255], [0, 0, 255], [255, 0, 255]];
        for (sixth, colour) in colours.into_iter().enumerate() {
            let bin = Bin::of(colour.map(f64::from));
            assert_eq!(bin, Bin { value: 31, chroma: 31, hue: 31 * sixth as u8 });
        }
    }

    #[test]
    fn greys_have_no_hue() {
        for grey in 0..=255 {
            let grey = f64::from(grey);
            let bin = Bin { value: (grey / 8.0) as u8, chroma: 0, hue: 0 };
            for noise in [[0.0; 3], [-7.0, 0.0, 0.0], [0.0, -7.0, -3.0], [-2.0, 0.0, -7.0]] {
                assert_eq!(Bin::of(noise.map(|noise| (grey + noise).max(0.0))), bin);
            }
        }
    }

    #[test]
    fn the_circle_of_hues_is_closed() {
        // A red on either side of where the circle begins, and their common neighbour.
        let (purple, orange) = (Bin::of([200.0, 40.0, 48.0]), Bin::of([200.0, 48.0, 40.0]));
        assert_eq!([purple.hue, orange.hue], [119, 1]);
        let near: Vec<_> = purple.around(2.01).map(|(bin, _)| bin).collect();
        assert!(near.contains(&orange) && near.contains(&Bin { hue: 0, ..purple }));
    }

    #[test]
    fn six_neighbours_touch_a_bin() {
        for bin in [Bin { value: 9, chroma: 0, hue: 0 }, Bin { value: 9, chroma: 5, hue: 29 }] {
            let near: Vec<_> = bin.around(1.01).collect();
            assert_eq!(near.len(), 7, "{near:?}");
            let distance = |&(other, distance): &(Bin, f64)| {
                assert!((distance - f64::from(u8::from(other != bin))).abs() < 1e-9);
            };
            near.iter().for_each(distance);
        }
    }

    proptest! {
        #[test]
        fn colours_of_a_bin_are_alike(a in any::<[u8; 3]>(), b in any::<[u8; 3]>()) {
            let bins = [a, b].map(|colour| Bin::of(colour.map(f64::from)));
            for bin in bins {
                prop_assert!(bin.value < 32 && bin.chroma <= bin.value);
                prop_assert!(bin.hue < Bin::hues(bin.chroma));
            }
            let apart = a.into_iter().zip(b).map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0);
            prop_assert!(bins[0] != bins[1] || apart < 24, "{bins:?}");
        }

        #[test]
        fn being_near_is_mutual(colour in any::<[u8; 3]>(), reach in 0.5..3.0) {
            let bin = Bin::of(colour.map(f64::from));
            for (other, distance) in bin.around(reach) {
                let back = other.around(reach).find(|&(back, _)| back == bin);
                prop_assert!(back.is_some_and(|(_, back)| (back - distance).abs() < 1e-9));
            }
        }
    }
}
