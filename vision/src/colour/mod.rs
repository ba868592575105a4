//! Colour classes: what a pixel shows. Section 3.

mod model;
mod table;

pub use model::{ColourModel, Stripe, StripeKind};
pub use table::{ColourTable, Gain, LitTable};

/// What a pixel shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum Class {
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
