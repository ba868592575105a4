//! What a robot senses besides its percepts when it comes to a vertex: the length of the edge that it has traversed, and
//! the direction of each door.
//!
//! Two darts that are one dart have one edge, which has one length, and their vertices are one vertex, whose doors have one
//! direction each. So what was sensed of both must agree; otherwise they are two. A length is known as an interval, and two
//! lengths agree if their intervals have a length in common. The edge then has the intersection.

use std::fmt;

use crate::{
    clone_in_place::clone_in_place,
    percept::{CompassView, Door, Percept, Sighting},
};

/// The lengths that an edge may have, in millimetres, from the least to the greatest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LengthInterval {
    least: u32,
    greatest: u32,
}

impl LengthInterval {
    /// That of an edge that was not measured.
    pub const ANY: Self = Self { least: 0, greatest: u32::MAX };

    pub fn exact(length: u32) -> Self {
        Self { least: length, greatest: length }
    }

    /// The true lengths for which a measured length, in millimetres, is wrong by at most so many thousandths of the true
    /// one. They are rounded outwards.
    pub fn measured(length: u32, thousandths: u32) -> Self {
        let (scaled, error) = (1000 * u64::from(length), u64::from(thousandths));
        let greatest = 1000_u64.checked_sub(error).filter(|&share| share > 0);
        let greatest = greatest.map_or(u64::MAX, |share| scaled.div_ceil(share));
        let [least, greatest] = [scaled / (1000 + error), greatest]
            .map(|length| u32::try_from(length).unwrap_or(u32::MAX));
        Self { least, greatest }
    }

    /// The least and the greatest length.
    pub fn bounds(self) -> [u32; 2] {
        [self.least, self.greatest]
    }

    pub fn contains(self, length: u32) -> bool {
        (self.least..=self.greatest).contains(&length)
    }

    /// The lengths that are in both intervals; `None` if there are none.
    #[must_use]
    pub fn intersection(self, other: Self) -> Option<Self> {
        let (least, greatest) = (self.least.max(other.least), self.greatest.min(other.greatest));
        (least <= greatest).then_some(Self { least, greatest })
    }
}

/// `12.500 m`, or `9.091 to 11.112 m`.
impl fmt::Display for LengthInterval {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        let [least, greatest] = [self.least, self.greatest].map(|length| f64::from(length) / 1e3);
        if self.least < self.greatest {
            write!(out, "{least:.3} to ")?;
        }
        write!(out, "{greatest:.3} m")
    }
}

/// What a robot senses besides its percept where it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ArrivalSenses {
    /// The length of the edge by which it came in, if it measures lengths.
    pub length: Option<LengthInterval>,
    /// The direction of each door, from door 0, if it has a compass. A view with another number of directions than there
    /// are doors is ignored.
    pub compass: Option<CompassView>,
}

/// What was sensed on a trail.
#[derive(Debug, Default)]
pub(super) struct SensedTrail {
    /// For each dart of a root, the length of its edge. An edge that was not measured, and those of all later darts, have any
    /// length.
    lengths: Vec<LengthInterval>,
    /// For each root, the directions of its doors, for a robot that came in by its first dart.
    views: Vec<Option<CompassView>>,
}

clone_in_place!(SensedTrail { lengths, views });

impl SensedTrail {
    pub(super) fn clear(&mut self) {
        self.lengths.clear();
        self.views.clear();
    }

    /// Whether nothing was sensed besides percepts.
    #[inline]
    pub(super) fn is_empty(&self) -> bool {
        self.lengths.is_empty() && self.views.is_empty()
    }

    pub(super) fn length(&self, dart: u32) -> LengthInterval {
        self.lengths.get(dart as usize).copied().unwrap_or(LengthInterval::ANY)
    }

    pub(super) fn set_length(&mut self, dart: u32, length: LengthInterval) {
        *at(&mut self.lengths, dart, LengthInterval::ANY) = length;
    }

    /// The directions at a vertex of this degree, as a percept; `None` if they were not seen.
    pub(super) fn view(&self, vertex: u32, degree: u32) -> Option<Percept> {
        let view = (*self.views.get(vertex as usize)?)?;
        Some(Percept { degree, sighting: Sighting::Compass(view) })
    }

    /// Keeps the directions that a robot sees at a vertex of this degree where it came in by the dart with this index.
    pub(super) fn set_view(&mut self, vertex: u32, index: u32, percept: Percept) {
        let from_first = percept.seen_from(Door(index).inverse(percept.degree));
        if let Sighting::Compass(view) = from_first.sighting {
            *at(&mut self.views, vertex, None) = Some(view);
        }
    }

    pub(super) fn clear_view(&mut self, vertex: u32) {
        *at(&mut self.views, vertex, None) = None;
    }
}

/// The element with a number. If there are fewer, default ones are added.
fn at<T: Clone>(elements: &mut Vec<T>, number: u32, default: T) -> &mut T {
    let number = number as usize;
    if elements.len() <= number {
        elements.resize(number + 1, default);
    }
    &mut elements[number]
}

impl ArrivalSenses {
    /// The directions at a vertex of this degree, as a percept; `None` if they were not seen.
    pub(super) fn view(self, degree: u32) -> Option<Percept> {
        let view = self.compass.filter(|view| view.directions().count() == degree as usize)?;
        Some(Percept { degree, sighting: Sighting::Compass(view) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each measurement within 10 % allows the true length, and none of a length that differs by 23 %.
    #[test]
    fn a_measurement_within_its_error_allows_the_true_length() {
        for length in [1, 7, 3000, 12_500, 30_000] {
            let measured = length * 9 / 10 + 1..=length * 11 / 10;
            for measured in measured.step_by((length as usize / 50).max(1)) {
                let interval = LengthInterval::measured(measured, 100);
                assert!(interval.contains(length), "{length} {measured} {interval}");
                assert!(length < 1000 || !interval.contains(length * 123 / 100));
            }
            assert_eq!(LengthInterval::measured(length, 0), LengthInterval::exact(length));
        }
        let greatest = LengthInterval::measured(u32::MAX, 1);
        assert!(greatest.contains(u32::MAX) && !greatest.contains(u32::MAX / 2));
    }

    /// A robot whose lengths may be wrong by all of a length knows only the least.
    #[test]
    fn an_error_of_a_whole_length_has_no_greatest() {
        for thousandths in [1000, 1001, u32::MAX] {
            assert!(LengthInterval::measured(5000, thousandths).contains(u32::MAX));
        }
        assert!(!LengthInterval::measured(5000, 1000).contains(2499));
    }

    #[test]
    fn lengths_agree_if_their_intervals_have_one_in_common() {
        let [low, high] = [10_000, 12_000].map(|length| LengthInterval::measured(length, 100));
        assert_eq!(low.to_string(), "9.090 to 11.112 m");
        assert_eq!(high.to_string(), "10.909 to 13.334 m");
        assert_eq!(low.intersection(high).unwrap().to_string(), "10.909 to 11.112 m");
        assert_eq!(low.intersection(LengthInterval::exact(12_000)), None);
        assert_eq!(low.intersection(LengthInterval::ANY), Some(low));
        assert_eq!(LengthInterval::exact(12_500).to_string(), "12.500 m");
    }
}
