//! Label masks: the class of each pixel of an image, labelled by a person.

use super::PixelClass;

impl PixelClass {
    /// The colour of a class in a label mask. Pixels to ignore are unseen.
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

    /// The class for a colour of a label mask, [`PixelClass::Unseen`] for pixels to ignore.
    #[must_use]
    pub fn of_label(label: [u8; 3]) -> Option<Self> {
        let classes = Self::LEARNED.into_iter().chain([Self::Unseen]);
        classes.into_iter().find(|class| class.label() == label)
    }
}
