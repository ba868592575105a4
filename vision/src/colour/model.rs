//! What the classifier has learned.

use super::ColourTable;

/// What the stripe between floor and wall is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stripe {
    /// Where it is.
    pub kind: StripeKind,
    /// How wide it is, in metres: across the floor, or up the wall.
    pub width: f64,
}

/// Where a stripe is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StripeKind {
    /// A tape on the floor along the wall: its outer edge is the wall's foot.
    OnFloor,
    /// A baseboard at the foot of the wall: its lower edge is the wall's foot.
    OnWall,
}

/// A learned classifier of colours.
#[derive(Clone, Debug, PartialEq)]
pub struct ColourModel {
    /// The stripe of the building.
    pub stripe: Stripe,
    /// The floor's colour, to which each image is brought, as red, green and blue from 0 to 255.
    pub floor: [f64; 3],
}

impl ColourModel {
    /// The classes of all colours.
    #[must_use]
    pub fn table(&self) -> ColourTable {
        unimplemented!()
    }
}

impl ColourModel {
    /// placeholder until the colour branch is merged
    #[must_use]
    pub fn gain(&self, _: impl Iterator<Item = [u8; 3]>) -> Option<super::Gain> {
        None
    }
}
