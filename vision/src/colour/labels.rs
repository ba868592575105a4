//! Label masks: what a person says that each pixel of an image shows.

use super::PixelClass;

impl PixelClass {
    /// The colour of a class in a label mask. Pixels that are to be ignored are unseen.
    #[must_use]
    pub fn label(self) -> [u8; 3] {
        match self {
            Self::Unseen | Self::Unknown => [255, 255, 255],
            Self::Floor => [0, 255, 0],
            Self::Stripe => [255, 0, 0],
            Self::Marker => [0, 0, 255],
            Self::Other => [0, 0, 0],
        }
    }

    /// The class that a colour of a label mask tells, [`PixelClass::Unseen`] for one to be ignored.
    #[must_use]
    pub fn of_label(label: [u8; 3]) -> Option<Self> {
        let told = Self::LEARNED.into_iter().chain([Self::Unseen]);
        told.into_iter().find(|class| class.label() == label)
    }
}
