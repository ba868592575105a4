//! Colour classes of pixels. Section 3.
//!
//! A [`Training`] learns a [`ColourModel`] from images with label masks. The colour of its
//! [`FloorRing`] gives the gain that brings an image to the light of the model. Then one lookup in a
//! [`LitTable`] gives the class of a pixel.

#![allow(clippy::cast_sign_loss, reason = "levels and pixels are never negative")]

mod confusion;
mod file;
mod hsv;
mod light;
mod model;
mod table;
mod training;

pub use confusion::Confusion;
pub use file::{ColourFileError, ColourFileErrorKind};
pub use light::{FloorRing, LightError};
pub use model::{ColourModel, Smoothing, Stripe, StripeKind};
pub use table::{ColourTable, Gain, LitTable};
pub use training::{ClassPixels, ExampleError, Training, TrainingError};

toposlam_model::words! {
    #[repr(u8)]
    #[derive(Default)]
    PixelClass {
        /// Outside of the view: beyond the mirror, or the robot's own body.
        #[default]
        Unseen = "unseen",
        /// A colour that the classifier never saw.
        Unknown = "unknown",
        Floor = "floor",
        Stripe = "stripe",
        Marker = "marker",
        /// Anything else: walls, doors, posters.
        Other = "other",
    }
}

impl PixelClass {
    pub const LEARNED: [Self; 4] = [Self::Floor, Self::Stripe, Self::Marker, Self::Other];

    /// The colour of a class in a label mask. Pixels to ignore are unseen.
    pub fn label(self) -> [u8; 3] {
        match self {
            Self::Unseen | Self::Unknown => [255, 255, 255],
            Self::Floor => [0, 255, 0],
            Self::Stripe => [255, 0, 0],
            Self::Marker => [0, 0, 255],
            Self::Other => [0, 0, 0],
        }
    }

    /// The class for a colour of a label mask, [`PixelClass::Unseen`] for pixels to ignore.
    pub fn of_label(label: [u8; 3]) -> Option<Self> {
        let classes = Self::LEARNED.into_iter().chain([Self::Unseen]);
        classes.into_iter().find(|class| class.label() == label)
    }
}
