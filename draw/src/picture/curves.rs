//! Curves from door to door: cubic Béziers that leave and arrive straight through the doors.

use super::geometry::{Extent, Point};

/// Straight steps that approximate one cubic.
const STEPS: usize = 14;

/// A chain of cubics.
#[derive(Clone, Debug)]
pub(super) struct Curve {
    pub(super) start: Point,
    /// Two control points and the end of each piece.
    pub(super) pieces: Vec<[Point; 3]>,
    /// Points along the curve, to measure with.
    pub(super) trace: Vec<Point>,
    pub(super) extent: Extent,
}

/// A place where a curve begins or ends: on the border of a disc, facing outwards.
#[derive(Clone, Copy, Debug)]
pub(super) struct DoorKnob {
    pub(super) at: Point,
    /// The direction outwards, of length 1.
    pub(super) out: Point,
}

impl DoorKnob {
    pub(super) fn new(centre: Point, radius: f64, angle: f64) -> Self {
        let out = Point::polar(angle, 1.0);
        Self { at: centre + out * radius, out }
    }
}

impl Curve {
    /// One cubic with handles of the given lengths.
    pub(super) fn cubic(from: DoorKnob, to: DoorKnob, handles: [f64; 2]) -> Self {
        let controls = [from.at + from.out * handles[0], to.at + to.out * handles[1]];
        Self::new(from.at, vec![[controls[0], controls[1], to.at]])
    }

    /// A smooth chain of cubics through the given points.
    pub(super) fn through(from: DoorKnob, way: &[Point], to: DoorKnob) -> Self {
        let points: Vec<_> =
            [from.at].into_iter().chain(way.iter().copied()).chain([to.at]).collect();
        let last = points.len() - 1;
        let heading = |index: usize| match index {
            0 => from.out,
            end if end == last => to.out * -1.0,
            _ => (points[index + 1] - points[index - 1]).direction(),
        };
        let pieces = (0..last)
            .map(|index| {
                let (a, b) = (points[index], points[index + 1]);
                let handle = 0.38 * a.distance(b);
                [a + heading(index) * handle, b - heading(index + 1) * handle, b]
            })
            .collect();
        Self::new(from.at, pieces)
    }

    fn new(start: Point, pieces: Vec<[Point; 3]>) -> Self {
        let mut trace = vec![start];
        let mut from = start;
        for &[one, two, to] in &pieces {
            trace.extend((1..=STEPS).map(|step| {
                let t = step as f64 / STEPS as f64;
                let s = 1.0 - t;
                from * (s * s * s)
                    + one * (3.0 * s * s * t)
                    + two * (3.0 * s * t * t)
                    + to * (t * t * t)
            }));
            from = to;
        }
        let extent = Extent::from_points(trace.iter().copied());
        Self { start, pieces, trace, extent }
    }

    /// The same curve from its end to its start.
    pub(super) fn reversed(&self) -> Self {
        let mut starts = vec![self.start];
        starts.extend(self.pieces.iter().map(|piece| piece[2]));
        let end = starts.pop().unwrap_or(self.start);
        let pieces = self.pieces.iter().zip(&starts).rev();
        Self::new(end, pieces.map(|(&[one, two, _], &from)| [two, one, from]).collect())
    }

    /// The curve's beginning, about as long as given.
    pub(super) fn beginning(&self, length: f64) -> Self {
        let mut gone = 0.0;
        let short = self.trace.windows(2).take_while(|two| {
            gone += two[0].distance(two[1]);
            gone <= length
        });
        let whole = short.count();
        let (piece, step) = (whole / STEPS, whole % STEPS);
        let Some(&[one, two, to]) = self.pieces.get(piece) else {
            return self.clone();
        };
        let mut pieces = self.pieces[..piece].to_vec();
        let from = pieces.last().map_or(self.start, |piece| piece[2]);
        // De Casteljau.
        let between = |a: Point, b: Point| a + (b - a) * (step as f64 / STEPS as f64);
        let first = [between(from, one), between(one, two), between(two, to)];
        let second = [between(first[0], first[1]), between(first[1], first[2])];
        pieces.push([first[0], second[0], between(second[0], second[1])]);
        Self::new(self.start, pieces)
    }

    pub(super) fn length(&self) -> f64 {
        self.trace.windows(2).map(|two| two[0].distance(two[1])).sum()
    }

    /// The point at the given share of the length.
    pub(super) fn at(&self, share: f64) -> Point {
        let mut left = share * self.length();
        for two in self.trace.windows(2) {
            let step = two[0].distance(two[1]);
            if step >= left && step > 0.0 {
                return two[0] + (two[1] - two[0]) * (left / step);
            }
            left -= step;
        }
        self.trace.last().copied().unwrap_or(self.start)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_can_be_turned_around_and_cut_off() {
        let door = |x: f64, angle| DoorKnob::new(Point::new(x, 0.0), 1.0, angle);
        let way = [Point::new(3.0, 4.0), Point::new(9.0, -2.0)];
        let curve = Curve::through(door(0.0, 0.0), &way, door(12.0, 1.0));
        let back = curve.reversed();
        let off = curve.trace.iter().zip(back.trace.iter().rev()).map(|(a, b)| a.distance(*b));
        assert!(off.fold(0.0, f64::max) < 1e-9);
        for share in [0.1, 0.4, 0.8] {
            let begun = curve.beginning(share * curve.length());
            assert!((begun.length() - share * curve.length()).abs() < 0.06 * curve.length());
            let end = *begun.trace.last().unwrap();
            let nearest = curve.trace.windows(2).map(|two| end.distance_to_segment(two[0], two[1]));
            assert!(nearest.fold(f64::INFINITY, f64::min) < 1e-6);
            assert_eq!(begun.start, curve.start);
        }
        assert_eq!(curve.beginning(1e9).trace, curve.trace);
    }
}
