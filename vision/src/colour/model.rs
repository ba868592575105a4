//! What the classifier has learned.

use super::{
    Class, ColourTable, Gain,
    hsv::{BINS, Bin, PLANE, VALUES},
    light,
    table::{self, CELLS},
};

/// What the stripe between floor and wall is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stripe {
    /// Where it is.
    pub kind: StripeKind,
    /// How wide it is, in metres: across the floor, or up the wall.
    pub width: f64,
}

impl Stripe {
    /// How narrow and how wide a stripe can be, in metres.
    pub const WIDTHS: [f64; 2] = [0.005, 0.5];
}

/// Where a stripe is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StripeKind {
    /// A tape on the floor along the wall: its outer edge is the wall's foot.
    OnFloor,
    /// A baseboard at the foot of the wall: its lower edge is the wall's foot.
    OnWall,
}

/// How likely each class is before its colour is seen; only their ratios matter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Priors {
    /// Floor.
    pub floor: f64,
    /// Stripe.
    pub stripe: f64,
    /// Marker.
    pub marker: f64,
    /// Anything else.
    pub other: f64,
}

impl Priors {
    /// All alike. Of a picture the stripe is a few hundredths, the marker less: priors that are their
    /// shares would call what could be either floor or stripe floor. But a stripe that is missed opens
    /// a wall, while a speck of floor that is taken for stripe is too small to matter.
    pub const EQUAL: Self = Self { floor: 0.25, stripe: 0.25, marker: 0.25, other: 0.25 };

    /// Those of [`Class::LEARNED`].
    pub(super) fn of_learned(self) -> [f64; 4] {
        [self.floor, self.stripe, self.marker, self.other]
    }
}

/// Which colours a class has: bins in their order, each once, and how many pixels are in each.
pub(super) type Histogram = Vec<(Bin, u64)>;

/// A learned classifier of colours.
#[derive(Clone, Debug, PartialEq)]
pub struct ColourModel {
    /// The stripe of the building.
    pub stripe: Stripe,
    /// The floor's colour, to which each image is brought, as red, green and blue from 0 to 255.
    pub floor: [f64; 3],
    /// How likely each class is.
    pub priors: Priors,
    /// How far pixels spread over the bins around theirs: standard deviation, in bins.
    pub smoothing: f64,
    /// A colour of which each class has a smaller share is unknown.
    pub unknown_below: f64,
    /// What each of [`Class::LEARNED`] looks like.
    pub(super) histograms: [Histogram; 4],
}

impl ColourModel {
    /// By what an image is multiplied to be brought to the light of this model; `None` where it is too
    /// dark, burnt out, or without a common colour of the floor.
    ///
    /// `ring`: the image's colours in the [`FloorRing`](super::FloorRing).
    #[must_use]
    pub fn gain(&self, ring: &[[u8; 3]]) -> Option<Gain> {
        light::floor_colour(ring).ok().map(|floor| light::gain(floor, self.floor))
    }

    /// The classes of all colours.
    #[must_use]
    pub fn table(&self) -> ColourTable {
        let classes = self.classes();
        let cell = |cell| classes[Bin::of(table::centre(cell)).index()];
        ColourTable { classes: (0..CELLS).map(cell).collect() }
    }

    /// The class of each bin: that of the greatest prior times density.
    fn classes(&self) -> Vec<Class> {
        let mut best = vec![(0.0, Class::Unknown); BINS];
        let classes = Class::LEARNED.into_iter().zip(&self.histograms);
        for ((class, histogram), prior) in classes.zip(self.priors.of_learned()) {
            for (best, density) in best.iter_mut().zip(smoothed(histogram, self.smoothing)) {
                let likelihood = prior * density;
                if density >= self.unknown_below && likelihood > best.0 {
                    *best = (likelihood, class);
                }
            }
        }
        best.into_iter().map(|(_, class)| class).collect()
    }
}

/// Beyond so many standard deviations nothing spreads.
const REACH: f64 = 2.5;

/// The share of each bin when each pixel spreads over the bins around its own, evenly in hue and
/// chroma and in value.
fn smoothed(histogram: &Histogram, deviation: f64) -> Vec<f64> {
    let mut shares = vec![0.0; BINS];
    let total: f64 = histogram.iter().map(|&(_, count)| count as f64).sum();
    let weight = |distance: f64| (-0.5 * (distance / deviation).powi(2)).exp();
    let steps = (REACH * deviation) as usize;
    let weights: Vec<f64> = (0..=steps).map(|step| weight(step as f64)).collect();
    for group in histogram.chunk_by(|(a, _), (b, _)| a.value == b.value) {
        // First over the plane of this value, then from it to the values around.
        let mut plane = vec![0.0; PLANE];
        for &(bin, count) in group {
            let around: Vec<_> = bin
                .around(REACH * deviation)
                .map(|(other, distance)| (other.in_plane(), weight(distance)))
                .collect();
            let whole: f64 = around.iter().map(|(_, weight)| weight).sum();
            for (place, weight) in around {
                plane[place] += count as f64 / total * weight / whole;
            }
        }
        let value = usize::from(group[0].0.value);
        let values = value.saturating_sub(steps)..=(value + steps).min(VALUES - 1);
        let whole: f64 = values.clone().map(|other| weights[other.abs_diff(value)]).sum();
        for other in values {
            let part = weights[other.abs_diff(value)] / whole;
            for (share, plane) in shares[other * PLANE..].iter_mut().zip(&plane) {
                *share += part * plane;
            }
        }
    }
    shares
}
