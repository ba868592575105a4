//! The learned classifier.

use super::{
    ColourTable, Gain, LightError, PixelClass,
    hsv::{BINS, Bin, Lattice, PLANE, VALUES},
    light,
    table::{self, CELLS},
};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stripe {
    pub kind: StripeKind,
    /// Its width in metres: across the floor, or up the wall.
    pub width: f64,
}

impl Stripe {
    /// The least and the greatest width of a stripe, in metres.
    pub const WIDTHS: [f64; 2] = [0.005, 0.5];
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StripeKind {
    /// A tape on the floor along the wall: its outer edge is the wall's foot.
    OnFloor,
    /// A baseboard at the foot of the wall: its lower edge is the wall's foot.
    OnWall,
}

/// Equal priors. The stripe is a few hundredths of an image, the marker less, so priors equal to these shares would
/// classify as floor what could be either. But a missed stripe opens a wall, while a speck of floor that is taken for
/// stripe does not matter.
pub(super) const EQUAL_PRIORS: [f64; 4] = [0.25; 4];

/// How far the learned colours stand for similar ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Smoothing {
    /// The spread of one colour in the same light, in steps of chroma: images are noisy, and the light
    /// is never equally white.
    pub colour: f64,
    pub light: f64,
}

/// The colours of a class: bins in order, each once, with their numbers of pixels.
pub(super) type Histogram = Vec<(Bin, u64)>;

#[derive(Clone, Debug, PartialEq)]
pub struct ColourModel {
    pub stripe: Stripe,
    /// The floor's colour in the light of the model: red, green and blue from 0 to 255.
    pub floor: [f64; 3],
    /// How likely each of [`PixelClass::LEARNED`] is before its colour is seen. Only the ratios matter.
    pub priors: [f64; 4],
    pub smoothing: Smoothing,
    /// A colour is unknown if each class has a smaller share of it.
    pub unknown_below: f64,
    /// The colours of each of [`PixelClass::LEARNED`].
    pub(super) histograms: [Histogram; 4],
}

impl ColourModel {
    /// The gain that brings an image to the light of this model. `ring` has the colours of its
    /// [`FloorRing`](super::FloorRing).
    ///
    /// # Errors
    /// Returns an error if they are too dark, overexposed, or without a common colour.
    pub fn gain(&self, ring: &[[u8; 3]]) -> Result<Gain, LightError> {
        light::floor_colour(ring).map(|floor| light::gain(floor, self.floor))
    }

    pub fn table(&self) -> ColourTable {
        let classes = self.classes();
        let cell = |cell| classes[Bin::from_rgb(table::centre(cell)).index()];
        ColourTable { classes: (0..CELLS).map(cell).collect() }
    }

    /// The class of each bin: the one with the greatest prior times density.
    // paper: sense.classify, marker-sense.colour
    fn classes(&self) -> Vec<PixelClass> {
        let mut best = vec![(0.0, PixelClass::Unknown); BINS];
        let smoothed = self.smoothing.applied_to(&self.histograms);
        for ((class, densities), prior) in
            PixelClass::LEARNED.into_iter().zip(smoothed).zip(self.priors)
        {
            for (best, density) in best.iter_mut().zip(densities) {
                let likelihood = prior * density;
                if density >= self.unknown_below && likelihood > best.0 {
                    *best = (likelihood, class);
                }
            }
        }
        best.into_iter().map(|(_, class)| class).collect()
    }
}

impl Smoothing {
    fn applied_to(self, histograms: &[Histogram; 4]) -> [Vec<f64>; 4] {
        let lattice = Lattice::new();
        let near = self.near();
        histograms.each_ref().map(|histogram| {
            let lit = self.in_other_light(histogram);
            let mut shares = vec![0.0; BINS];
            for place in 0..PLANE {
                let values =
                    (0..VALUES).map(|value| (value, lit[usize::from(value) * PLANE + place]));
                let values: Vec<_> = values.filter(|&(_, share)| share > 0.0).collect();
                if values.is_empty() {
                    continue;
                }
                for &(offset, steps, weight) in &near {
                    let Some(beside) = lattice.beside(place, offset) else { continue };
                    for &(value, share) in &values {
                        let value = value.saturating_add_signed(steps).min(VALUES - 1);
                        shares[usize::from(value) * PLANE + beside] += weight * share;
                    }
                }
            }
            shares
        })
    }

    /// The shares of a class if the light is brighter as often as darker.
    fn in_other_light(self, histogram: &Histogram) -> Vec<f64> {
        const STEPS: i32 = 8;
        let lights = (-STEPS..=STEPS).map(|step| {
            let deviations = 2.5 * f64::from(step) / f64::from(STEPS);
            ((self.light * deviations).exp(), (-0.5 * deviations * deviations).exp())
        });
        let lights: Vec<_> = lights.collect();
        let whole: f64 = lights.iter().map(|(_, weight)| weight).sum();
        let pixels: f64 = histogram.iter().map(|&(_, pixels)| pixels as f64).sum();
        let mut shares = vec![0.0; BINS];
        for &(bin, count) in histogram {
            for &(light, weight) in &lights {
                shares[bin.under(light).index()] += count as f64 / pixels * weight / whole;
            }
        }
        shares
    }

    /// How a bin is spread: offsets in the lattice and in value, each with its share. It is Student's
    /// distribution: most stays near, and a little goes far, so that a new colour belongs to the class
    /// with the most similar ones.
    fn near(self) -> Vec<([i32; 2], i8, f64)> {
        // A step of value is two steps of chroma.
        let apart = |[offset, value]: [f64; 2]| (offset * offset + 4.0 * value * value).sqrt();
        let weight = |distance: f64| (1.0 + (distance / self.colour).powi(2)).powi(-2);
        let near: Vec<_> = Lattice::offsets(4)
            .flat_map(|(offset, distance)| {
                [-1, 0, 1].map(|steps| (offset, steps, weight(apart([distance, f64::from(steps)]))))
            })
            .collect();
        let whole: f64 = near.iter().map(|(_, _, weight)| weight).sum();
        near.into_iter().map(|(offset, steps, weight)| (offset, steps, weight / whole)).collect()
    }
}
