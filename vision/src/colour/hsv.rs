//! HSV colours, in bins of about the same size.
//!
//! Chroma is saturation times value: the saturation and the hue of dark colours are only noise. The hues of one chroma
//! lie on a ring around the greys; the `r`-th ring has `6 r` bins. So the bins of one value are a lattice of hexagons.

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct Bin {
    /// The level of the brightest channel, in steps of [`VALUE_STEP`].
    pub(super) value: u8,
    /// The difference between the brightest and the darkest channel, in steps of [`CHROMA_STEP`].
    pub(super) chroma: u8,
    /// The index on the ring of this chroma, from red to green to blue.
    pub(super) hue: u16,
}

const VALUE_STEP: f64 = 8.0;
const CHROMA_STEP: f64 = 4.0;
pub(super) const VALUES: u8 = 32;
const CHROMAS: u8 = 64;
pub(super) const PLANE: usize = ring_start(CHROMAS);
pub(super) const BINS: usize = VALUES as usize * PLANE;

const fn ring_start(chroma: u8) -> usize {
    let chroma = chroma as usize;
    if chroma == 0 { 0 } else { 1 + 3 * chroma * (chroma - 1) }
}

impl Bin {
    /// The bin of a colour, red, green and blue from 0 to 255.
    pub(super) fn from_rgb([red, green, blue]: [f64; 3]) -> Self {
        let value = red.max(green).max(blue);
        let chroma = value - red.min(green).min(blue);
        let ring = (chroma / CHROMA_STEP) as u8;
        // In sixths of the circle.
        let hue = if value <= red {
            ((green - blue) / chroma).rem_euclid(6.0)
        } else if value <= green {
            (blue - red) / chroma + 2.0
        } else {
            (red - green) / chroma + 4.0
        };
        Self::on_ring((value / VALUE_STEP) as u8, ring, hue)
    }

    /// The nearest to a hue, in sixths of the circle.
    fn on_ring(value: u8, chroma: u8, hue: f64) -> Self {
        let hue = if chroma == 0 { 0 } else { (hue * f64::from(chroma)).round() as u16 };
        Self { value, chroma, hue: hue % Self::hues(chroma) }
    }

    pub(super) fn most_chroma(value: u8) -> u8 {
        2 * value + 1
    }

    /// The number of hues at a chroma.
    pub(super) fn hues(chroma: u8) -> u16 {
        if chroma == 0 { 1 } else { 6 * u16::from(chroma) }
    }

    /// Its index among the bins of the same value.
    pub(super) fn in_plane(self) -> usize {
        ring_start(self.chroma) + usize::from(self.hue)
    }

    pub(super) fn index(self) -> usize {
        usize::from(self.value) * PLANE + self.in_plane()
    }

    /// The bin of the same colour in other light, multiplied by a factor. Hue and saturation stay.
    pub(super) fn under(self, light: f64) -> Self {
        let lit = |steps: u8, most: u8| {
            let middle = (f64::from(steps) + 0.5) * light;
            (middle as u8).min(most)
        };
        let value = lit(self.value, VALUES - 1);
        if self.chroma == 0 {
            return Self { value, ..self };
        }
        let hue = f64::from(self.hue) / f64::from(self.chroma);
        let chroma = lit(self.chroma, CHROMAS - 1).min(Self::most_chroma(value));
        Self::on_ring(value, chroma, hue)
    }

    /// Its place in the lattice of hexagons, along two axes a sixth of the circle apart.
    fn hexagon(self) -> [i32; 2] {
        const CORNERS: [[i32; 2]; 6] = [[1, 0], [0, 1], [-1, 1], [-1, 0], [0, -1], [1, -1]];
        if self.chroma == 0 {
            return [0, 0];
        }
        let (ring, hue) = (i32::from(self.chroma), i32::from(self.hue));
        let side = (hue / ring) as usize;
        // A side points in the direction of the corner after its end.
        let (corner, along) = (CORNERS[side % 6], CORNERS[(side + 2) % 6]);
        [0, 1].map(|axis| corner[axis] * ring + along[axis] * (hue % ring))
    }
}

#[derive(Clone, Debug)]
pub(super) struct Lattice {
    hexagons: Vec<[i32; 2]>,
    bins: Vec<Option<usize>>,
}

const ACROSS: usize = 2 * CHROMAS as usize - 1;

impl Lattice {
    pub(super) fn new() -> Self {
        let chromas =
            (0..CHROMAS).flat_map(|chroma| (0..Bin::hues(chroma)).map(move |hue| (chroma, hue)));
        let hexagons: Vec<_> =
            chromas.map(|(chroma, hue)| Bin { value: 0, chroma, hue }.hexagon()).collect();
        let mut bins = vec![None; ACROSS * ACROSS];
        for (bin, &hexagon) in hexagons.iter().enumerate() {
            if let Some(place) = place(hexagon) {
                bins[place] = Some(bin);
            }
        }
        Self { hexagons, bins }
    }

    pub(super) fn beside(&self, bin: usize, [along, across]: [i32; 2]) -> Option<usize> {
        let [x, y] = self.hexagons[bin];
        self.bins[place([x + along, y + across])?]
    }

    pub(super) fn offsets(reach: i32) -> impl Iterator<Item = ([i32; 2], f64)> {
        let range = -reach..=reach;
        let pairs = range.clone().flat_map(move |x| range.clone().map(move |y| [x, y]));
        pairs
            .map(|[x, y]| ([x, y], f64::from(x * x + x * y + y * y).sqrt()))
            .filter(move |&(_, distance)| distance <= f64::from(reach))
    }
}

fn place([x, y]: [i32; 2]) -> Option<usize> {
    let middle = i32::from(CHROMAS) - 1;
    let [x, y] = [x + middle, y + middle].map(|axis| usize::try_from(axis).ok());
    let (x, y) = (x.filter(|&x| x < ACROSS)?, y.filter(|&y| y < ACROSS)?);
    Some(y * ACROSS + x)
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use proptest::prelude::*;

    use super::*;

    fn all() -> impl Iterator<Item = Bin> {
        (0..VALUES).flat_map(|value| {
            (0..CHROMAS).flat_map(move |chroma| {
                (0..Bin::hues(chroma)).map(move |hue| Bin { value, chroma, hue })
            })
        })
    }

    /// The bins whose hexagons touch one, and itself.
    fn beside(lattice: &Lattice, bin: usize) -> HashSet<usize> {
        Lattice::offsets(1).filter_map(|(offset, _)| lattice.beside(bin, offset)).collect()
    }

    #[test]
    fn every_bin_has_its_own_index_in_order() {
        let places: Vec<_> = all().map(Bin::index).collect();
        assert!(places.iter().copied().eq(0..BINS));
        assert_eq!(PLANE, 12_097);
        assert!(all().zip(all().skip(1)).all(|(one, next)| one < next));
    }

    #[test]
    fn primary_colours_lie_a_sixth_of_the_circle_apart() {
        let colours =
            [[255, 0, 0], [255, 255, 0], [0, 255, 0], [0, 255, 255], [0, 0, 255], [255, 0, 255]];
        for (sixth, colour) in colours.into_iter().enumerate() {
            let bin = Bin::from_rgb(colour.map(f64::from));
            assert_eq!(bin, Bin { value: 31, chroma: 63, hue: 63 * sixth as u16 });
        }
    }

    #[test]
    fn greys_have_no_hue() {
        for grey in 0..=255 {
            let grey = f64::from(grey);
            let bin = Bin { value: (grey / 8.0) as u8, chroma: 0, hue: 0 };
            for noise in [[0.0; 3], [-3.0, 0.0, 0.0], [0.0, -3.0, -1.0], [-2.0, 0.0, -3.0]] {
                assert_eq!(Bin::from_rgb(noise.map(|noise| (grey + noise).max(0.0))), bin);
            }
        }
    }

    #[test]
    fn the_circle_of_hues_is_closed() {
        // Two reds on both sides of the circle's beginning, and their common neighbour.
        let (purple, orange) =
            (Bin::from_rgb([200.0, 40.0, 44.0]), Bin::from_rgb([200.0, 44.0, 40.0]));
        assert_eq!([purple.hue, orange.hue], [239, 1]);
        let red = Bin { hue: 0, ..purple };
        let lattice = Lattice::new();
        let beside = |bin: Bin| beside(&lattice, bin.in_plane());
        assert!(beside(red).contains(&purple.in_plane()));
        assert!(beside(red).contains(&orange.in_plane()));
        assert!(beside(purple).contains(&red.in_plane()));
    }

    #[test]
    fn six_hexagons_touch_each() {
        assert_eq!(Lattice::offsets(1).count(), 7);
        assert_eq!(Lattice::offsets(2).count(), 19);
        let lattice = Lattice::new();
        for bin in 0..PLANE {
            let beside = beside(&lattice, bin);
            assert!(beside.contains(&bin));
            // The outermost ring has nothing beyond it.
            let inside = bin < ring_start(CHROMAS - 1);
            assert!(if inside { beside.len() == 7 } else { beside.len() < 6 }, "{bin}");
        }
    }

    #[test]
    fn a_step_of_one_channel_leads_to_a_hexagon_that_touches() {
        let lattice = Lattice::new();
        for colour in
            [[200, 40, 40], [40, 200, 120], [120, 116, 110], [100, 100, 100], [60, 90, 200]]
        {
            for channel in 0..3 {
                let mut other = colour;
                other[channel] += 4;
                let [bin, other] = [colour, other].map(|colour| {
                    Bin::from_rgb(colour.map(|level: i32| f64::from(level) + 1.5)).in_plane()
                });
                assert!(beside(&lattice, bin).contains(&other), "{colour:?}, {channel}");
            }
        }
    }

    proptest! {
        #[test]
        fn colours_of_a_bin_are_alike(a in any::<[u8; 3]>(), b in any::<[u8; 3]>()) {
            let bins = [a, b].map(|colour| Bin::from_rgb(colour.map(f64::from)));
            for bin in bins {
                prop_assert!(bin.value < VALUES && bin.chroma <= Bin::most_chroma(bin.value));
                prop_assert!(bin.hue < Bin::hues(bin.chroma));
            }
            let apart = a.into_iter().zip(b).map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0);
            prop_assert!(bins[0] != bins[1] || apart < 16, "{bins:?}");
        }

        #[test]
        fn more_light_keeps_the_hue(colour in any::<[u8; 3]>(), light in 0.6..1.6_f64) {
            let bin = Bin::from_rgb(colour.map(f64::from));
            prop_assert_eq!(bin.under(1.0), bin);
            let lit = bin.under(light);
            prop_assert!(lit.value < VALUES && lit.hue < Bin::hues(lit.chroma));
            prop_assert!(lit.chroma <= Bin::most_chroma(lit.value));
            let value = (f64::from(bin.value) + 0.5) * light;
            prop_assert!((f64::from(lit.value) + 0.5 - value.min(32.0)).abs() <= 0.51);
            if lit.chroma > 0 {
                let hue = |bin: Bin| f64::from(bin.hue) / f64::from(bin.chroma);
                let apart = (hue(bin) - hue(lit)).abs();
                prop_assert!(apart.min(6.0 - apart) <= 0.51 / f64::from(lit.chroma));
            }
        }
    }
}
