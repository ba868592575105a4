//! How well colours are classified.

use super::PixelClass;

/// The numbers of pixels by their true class and the class that the classifier gives them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Confusion {
    /// A row for each true class, one of [`PixelClass::LEARNED`]; a column for each given class, one of
    /// [`Confusion::GIVEN`].
    pub pixels: [[u64; 5]; 4],
}

impl Confusion {
    pub const GIVEN: [PixelClass; 5] = [
        PixelClass::Floor,
        PixelClass::Stripe,
        PixelClass::Marker,
        PixelClass::Other,
        PixelClass::Unknown,
    ];

    /// Counts pixels of a true class that the classifier gives another or the same class.
    pub fn count(&mut self, is: PixelClass, given: PixelClass, pixels: u64) {
        let row = PixelClass::LEARNED.iter().position(|&class| class == is);
        let column = Self::GIVEN.iter().position(|&class| class == given);
        if let (Some(row), Some(column)) = (row, column) {
            self.pixels[row][column] += pixels;
        }
    }

    pub fn of(&self, is: PixelClass) -> u64 {
        let rows = PixelClass::LEARNED.iter().zip(&self.pixels).filter(|(class, _)| **class == is);
        rows.flat_map(|(_, row)| row).sum()
    }

    /// The share of a class's pixels that is given this class; `None` without pixels.
    pub fn recall(&self, class: PixelClass) -> Option<f64> {
        share(self.right(class), self.of(class))
    }

    /// The share of the pixels given a class that is of this class; `None` without pixels.
    pub fn precision(&self, class: PixelClass) -> Option<f64> {
        let column = Self::GIVEN.iter().position(|&given| given == class)?;
        share(self.right(class), self.pixels.iter().map(|row| row[column]).sum())
    }

    fn right(&self, class: PixelClass) -> u64 {
        let place = PixelClass::LEARNED.iter().position(|&learned| learned == class);
        place.map_or(0, |place| self.pixels[place][place])
    }
}

fn share(part: u64, whole: u64) -> Option<f64> {
    (whole > 0).then(|| part as f64 / whole as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn recall_is_a_share_of_a_row_and_precision_of_a_column() {
        let mut confusion = Confusion::default();
        confusion.count(PixelClass::Floor, PixelClass::Floor, 6);
        confusion.count(PixelClass::Floor, PixelClass::Stripe, 1);
        confusion.count(PixelClass::Floor, PixelClass::Unknown, 1);
        confusion.count(PixelClass::Stripe, PixelClass::Stripe, 3);
        assert_eq!(confusion.pixels, [[6, 1, 0, 0, 1], [0, 3, 0, 0, 0], [0; 5], [0; 5]]);
        assert_eq!(confusion.of(PixelClass::Floor), 8);
        assert_eq!(confusion.recall(PixelClass::Floor), Some(0.75));
        assert_eq!(confusion.precision(PixelClass::Floor), Some(1.0));
        assert_eq!(confusion.recall(PixelClass::Stripe), Some(1.0));
        assert_eq!(confusion.precision(PixelClass::Stripe), Some(0.75));
        assert_eq!(confusion.recall(PixelClass::Marker), None);
        assert_eq!(confusion.precision(PixelClass::Marker), None);
        assert_eq!(confusion.precision(PixelClass::Unseen), None);
    }
}
