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

    /// The column of a class, which is also its row if it is one of [`PixelClass::LEARNED`].
    fn place(class: PixelClass) -> Option<usize> {
        Self::GIVEN.iter().position(|&given| given == class)
    }

    fn row(&self, class: PixelClass) -> Option<&[u64; 5]> {
        self.pixels.get(Self::place(class)?)
    }

    /// Counts pixels of a true class that the classifier gives another or the same class.
    pub fn count(&mut self, is: PixelClass, given: PixelClass, pixels: u64) {
        let (row, column) = (Self::place(is), Self::place(given));
        if let (Some(row), Some(column)) = (row.and_then(|row| self.pixels.get_mut(row)), column) {
            row[column] += pixels;
        }
    }

    pub fn pixels(&self, is: PixelClass) -> u64 {
        self.row(is).map_or(0, |row| row.iter().sum())
    }

    /// The share of a class's pixels that is given this class; `None` without pixels.
    pub fn recall(&self, class: PixelClass) -> Option<f64> {
        share(self.row(class)?[Self::place(class)?], self.pixels(class))
    }

    /// The share of the pixels given a class that is of this class; `None` without pixels.
    pub fn precision(&self, class: PixelClass) -> Option<f64> {
        let column = Self::place(class)?;
        let right = self.row(class).map_or(0, |row| row[column]);
        share(right, self.pixels.iter().map(|row| row[column]).sum())
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
        assert_eq!(confusion.pixels(PixelClass::Floor), 8);
        assert_eq!(confusion.recall(PixelClass::Floor), Some(0.75));
        assert_eq!(confusion.precision(PixelClass::Floor), Some(1.0));
        assert_eq!(confusion.recall(PixelClass::Stripe), Some(1.0));
        assert_eq!(confusion.precision(PixelClass::Stripe), Some(0.75));
        assert_eq!(confusion.recall(PixelClass::Marker), None);
        assert_eq!(confusion.precision(PixelClass::Marker), None);
        assert_eq!(confusion.precision(PixelClass::Unseen), None);
    }
}
