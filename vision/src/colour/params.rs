//! The parameters of colours, in one place. Training and sensing use the same: they belong to the colour model, and
//! are not among [`SensingParams`](crate::params::SensingParams).
//!
//! Levels are those of a channel, from 0 to 255. The values come from:
//!
//! * **geometry**: the robot or the numbers of an image give the value;
//! * **views**: chosen on rendered views of other buildings than those learned from (`docs/sensing.md`).

use crate::params;

params! {
    /// How the light of an image is found: the colour of the floor beside the robot's body.
    LightParams {
        /// The inner and the outer radius of the ring of samples, in metres. Geometry: the body hides what is nearer;
        /// farther away there may be walls.
        ring: [f64; 2] = [0.34, 0.50],
        /// The number of bearings with samples. Geometry: every 1.5 degrees.
        bearings: u32 = 240,
        /// The number of samples on each bearing. Geometry: every 1.5 cm.
        ranges: u32 = 12,
        /// From this level on, a channel may be saturated. Geometry: a JPEG image blurs the greatest level.
        burnt: u8 = 250,
        /// Below this level of the brightest channel, single levels are too coarse to be multiplied. Geometry.
        dark: f64 = 16.0,
        /// Levels below this are noise. Views.
        noise: f64 = 4.0,
        /// Samples of the floor differ from its colour by at most this factor. Views.
        spread: f64 = 1.35,
        /// At least this part of the samples is floor. Views.
        agreeing: f64 = 0.3,
    }

    /// How colours are learned.
    TrainingParams {
        /// The radius of the floor that is learned from, in metres from the robot's centre. Geometry: the reach of the
        /// ground view.
        range: f64 = 3.0,
        /// The spread of one colour in the same light ([`Smoothing::colour`](super::Smoothing)). Views.
        colour_smoothing: f64 = 0.7,
        /// The relative spread of the light from place to place ([`Smoothing::light`](super::Smoothing)). Views.
        light_smoothing: f64 = 0.08,
        /// A class does not have a colour if its part of the pixels is less. Views.
        unknown_below: f64 = 1e-6,
        /// The number of mixed pixels that count as one pure pixel. Views: a floor in the shade has the colour of a
        /// mixture of lit floor and dark stripe, and is floor. If no pure pixel has the colour, it is a mixture.
        mixed: u64 = 256,
    }
}
