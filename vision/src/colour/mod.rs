//! Colour classes of pixels. Section 3.
//!
//! A [`Training`] learns a [`ColourModel`] from images with label masks. The colour of its
//! [`FloorRing`] gives the gain that brings an image to the light of the model. Then one lookup in a
//! [`LitTable`] gives the class of a pixel.

#![allow(clippy::cast_sign_loss, reason = "levels and pixels are never negative")]

mod confusion;
mod file;
mod hsv;
mod labels;
mod light;
mod model;
pub mod params;
mod table;
mod training;

pub use confusion::Confusion;
pub use file::{ColourFileError, ColourFileErrorKind};
pub use light::{FloorRing, LightError};
pub use model::{ColourModel, Priors, Smoothing, Stripe, StripeKind};
pub use table::{ColourTable, Gain, LitTable};
pub use training::{ClassPixels, Example, ExampleError, Training, TrainingError, TrainingView};

/// The class of a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum PixelClass {
    /// Outside of the view: beyond the mirror, or the robot's own body.
    #[default]
    Unseen,
    /// A colour that the classifier never saw.
    Unknown,
    /// Floor.
    Floor,
    /// The boundary stripe between floor and wall.
    Stripe,
    /// The marker.
    Marker,
    /// Anything else: walls, doors, posters.
    Other,
}

impl PixelClass {
    /// The classes that are learned.
    pub const LEARNED: [Self; 4] = [Self::Floor, Self::Stripe, Self::Marker, Self::Other];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Unseen => "unseen",
            Self::Unknown => "unknown",
            Self::Floor => "floor",
            Self::Stripe => "stripe",
            Self::Marker => "marker",
            Self::Other => "other",
        }
    }
}
