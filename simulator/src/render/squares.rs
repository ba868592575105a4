//! An index of things by squares of the floor.

use toposlam_model::floor_plan::Rectangle;

/// Things on the floor, and for each square of a mesh the numbers of those that overlap it.
#[derive(Clone, Debug)]
pub struct Squares<T> {
    things: Vec<T>,
    least: [f32; 2],
    per_metre: f32,
    columns: usize,
    /// Of the things in each square, row by row.
    numbers: Vec<Vec<u32>>,
}

/// The least corner of all floors, and the size of their bounding box.
pub(crate) fn extent(floors: &[Rectangle]) -> ([f64; 2], [f64; 2]) {
    let least = |axis: usize| floors.iter().map(|floor| floor.least[axis]).fold(f64::MAX, f64::min);
    let greatest =
        |axis: usize| floors.iter().map(|floor| floor.greatest[axis]).fold(f64::MIN, f64::max);
    ([least(0), least(1)], [greatest(0) - least(0), greatest(1) - least(1)])
}

/// The side of a mesh's squares: the given one, or more to avoid millions of squares.
pub(crate) fn side(wished: f64, size: [f64; 2]) -> f64 {
    wished.max((size[0] * size[1] / 2.5e5).sqrt()).max(size[0].max(size[1]) / 1e5)
}

impl<T> Squares<T> {
    /// Indexes things on these floors by the rectangles around them.
    pub fn new(
        floors: &[Rectangle],
        wished: f64,
        things: Vec<T>,
        around: impl Fn(&T) -> Rectangle,
    ) -> Self {
        let (least, size) = extent(floors);
        let side = side(wished, size);
        let [columns, rows] = size.map(|length| (length / side) as usize + 1);
        let mut numbers = vec![Vec::new(); columns * rows];
        for (number, rectangle) in things.iter().map(around).enumerate() {
            let reach = |axis: usize, count: usize| {
                // The margin is larger than any rounding error.
                let at = |at: f64| ((at - least[axis]) / side).clamp(0.0, (count - 1) as f64);
                at(rectangle.least[axis] - 1e-3) as usize
                    ..=at(rectangle.greatest[axis] + 1e-3) as usize
            };
            for row in reach(1, rows) {
                for column in reach(0, columns) {
                    numbers[row * columns + column].push(number as u32);
                }
            }
        }
        let least = least.map(|at| at as f32);
        Self { things, least, per_metre: (1.0 / side) as f32, columns, numbers }
    }

    pub fn things(&self) -> &[T] {
        &self.things
    }

    /// All things around a place, and perhaps others.
    #[inline]
    pub fn at(&self, place: [f32; 2]) -> impl Iterator<Item = &T> {
        let [column, row] = [0, 1].map(|axis| {
            ((place[axis] - self.least[axis]) * self.per_metre).max(0.0) as i32 as usize
        });
        let square = (column < self.columns).then(|| row * self.columns + column);
        let numbers = square.and_then(|square| self.numbers.get(square));
        numbers.into_iter().flatten().map(|&number| &self.things[number as usize])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_rectangle_around_a_place_is_in_its_square() {
        let rectangle = |x: f64, y: f64, width: f64, height: f64| Rectangle {
            least: [x, y],
            greatest: [x + width, y + height],
        };
        let floors = [rectangle(-3.0, -2.0, 9.0, 2.0), rectangle(2.0, -2.0, 2.0, 11.0)];
        let rectangles: Vec<_> = (0..40)
            .map(|number| {
                let number = f64::from(number);
                rectangle(-4.0 + 0.29 * number, -3.0 + 0.31 * number, 0.1 + 0.05 * number, 0.2)
            })
            .collect();
        let squares = Squares::new(&floors, 0.25, rectangles, |rectangle| *rectangle);
        for (x, y) in (0..90).flat_map(|x| (0..110).map(move |y| (x, y))) {
            let place = [-3.0 + 0.1 * x as f32, -2.0 + 0.1 * y as f32];
            let found: Vec<_> = squares.at(place).collect();
            for rectangle in squares.things() {
                assert!(!rectangle.holds(place.map(f64::from)) || found.contains(&rectangle));
            }
            assert!(found.len() < squares.things().len());
        }
        assert!([[1e9, 0.0], [0.0, 1e9]].iter().all(|&far| squares.at(far).next().is_none()));
    }
}
