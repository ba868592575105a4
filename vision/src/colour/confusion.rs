//! How well colours are classified.

use super::Class;

/// How many pixels of each class are classified as what.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Confusion {
    /// A row for each of [`Class::LEARNED`], which the pixel is; a column for each of
    /// [`Confusion::TOLD`], which it is told to be.
    pub pixels: [[u64; 5]; 4],
}

impl Confusion {
    /// What a pixel can be told to be.
    pub const TOLD: [Class; 5] =
        [Class::Floor, Class::Stripe, Class::Marker, Class::Other, Class::Unknown];

    /// Counts so many pixels.
    pub fn count(&mut self, is: Class, told: Class, pixels: u64) {
        let row = Class::LEARNED.iter().position(|&class| class == is);
        let column = Self::TOLD.iter().position(|&class| class == told);
        if let (Some(row), Some(column)) = (row, column) {
            self.pixels[row][column] += pixels;
        }
    }

    /// All pixels of a class.
    #[must_use]
    pub fn of(&self, is: Class) -> u64 {
        let rows = Class::LEARNED.iter().zip(&self.pixels).filter(|(class, _)| **class == is);
        rows.flat_map(|(_, row)| row).sum()
    }

    /// Which share of a class is told to be it; `None` if there is nothing of it.
    #[must_use]
    pub fn recall(&self, class: Class) -> Option<f64> {
        share(self.right(class), self.of(class))
    }

    /// Which share of what is told to be of a class is of it; `None` if nothing is.
    #[must_use]
    pub fn precision(&self, class: Class) -> Option<f64> {
        let column = Self::TOLD.iter().position(|&told| told == class)?;
        share(self.right(class), self.pixels.iter().map(|row| row[column]).sum())
    }

    fn right(&self, class: Class) -> u64 {
        let place = Class::LEARNED.iter().position(|&learned| learned == class);
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
        confusion.count(Class::Floor, Class::Floor, 6);
        confusion.count(Class::Floor, Class::Stripe, 1);
        confusion.count(Class::Floor, Class::Unknown, 1);
        confusion.count(Class::Stripe, Class::Stripe, 3);
        assert_eq!(confusion.pixels, [[6, 1, 0, 0, 1], [0, 3, 0, 0, 0], [0; 5], [0; 5]]);
        assert_eq!(confusion.of(Class::Floor), 8);
        assert_eq!(confusion.recall(Class::Floor), Some(0.75));
        assert_eq!(confusion.precision(Class::Floor), Some(1.0));
        assert_eq!(confusion.recall(Class::Stripe), Some(1.0));
        assert_eq!(confusion.precision(Class::Stripe), Some(0.75));
        assert_eq!(confusion.recall(Class::Marker), None);
        assert_eq!(confusion.precision(Class::Marker), None);
        assert_eq!(confusion.precision(Class::Unseen), None);
    }
}
