//! The markers that a robot carries, and those that it leaves at one place.

use crate::{
    aid::{AidAction, AidKind},
    percept::{Door, MarkerSet, Sighting},
};

/// The markers that the robot carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct CarriedMarkers {
    look: Look,
    /// How many, or which, as a set of bits from the lowest.
    markers: u8,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Look {
    Alike,
    Distinct,
    Pointing,
}

/// Markers that are left at one place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Marks {
    /// So many that look alike.
    Alike(u8),
    /// The one with this number, from 1.
    Distinct(u8),
    Pointing,
}

impl CarriedMarkers {
    pub(super) fn none() -> Self {
        Self { look: Look::Alike, markers: 0 }
    }

    /// All markers of an aid.
    pub(super) fn all(aid: AidKind) -> Self {
        match aid {
            AidKind::Markers(markers) if markers.are_alike() => {
                Self { look: Look::Alike, markers: markers.count() }
            }
            AidKind::Markers(markers) => {
                Self { look: Look::Distinct, markers: (1 << markers.count()) - 1 }
            }
            _ => Self { look: Look::Pointing, markers: 1 },
        }
    }

    pub(super) fn is_none(self) -> bool {
        self.markers == 0
    }

    /// Whether places can look alike that are marked at the same time.
    pub(super) fn may_look_alike(self) -> bool {
        self.look == Look::Alike && self.markers > 1
    }

    /// How they look where all of them lie, a directional one along this door.
    pub(super) fn lying(self, along: Door) -> Option<Sighting> {
        match self.look {
            Look::Alike => Some(Sighting::Lying(self.markers.into())),
            Look::Distinct => {
                let numbers = (0..8).filter(|at| self.markers >> at & 1 == 1);
                MarkerSet::from_numbers(numbers).map(Sighting::These)
            }
            Look::Pointing => Some(Sighting::Pointing(along)),
        }
    }

    /// Each of them.
    pub(super) fn each(self) -> impl Iterator<Item = Marks> {
        (0..8).filter_map(move |at| match self.look {
            Look::Alike => (at < self.markers).then_some(Marks::Alike(1)),
            _ if self.markers >> at & 1 == 0 => None,
            Look::Distinct => Some(Marks::Distinct(at + 1)),
            Look::Pointing => Some(Marks::Pointing),
        })
    }

    /// The fewest of them that look different from all of these.
    pub(super) fn marks_besides(self, others: impl Iterator<Item = Marks>) -> Option<Marks> {
        match self.look {
            Look::Alike => {
                let taken: Vec<_> = others.collect();
                (1..=self.markers).map(Marks::Alike).find(|marks| !taken.contains(marks))
            }
            _ => self.each().next(),
        }
    }

    pub(super) fn remove(&mut self, marks: Marks) {
        match marks {
            Marks::Alike(count) => self.markers = self.markers.saturating_sub(count),
            Marks::Distinct(number) => self.markers &= !bit(number),
            Marks::Pointing => self.markers = 0,
        }
    }

    pub(super) fn add(&mut self, marks: Marks) {
        match marks {
            Marks::Alike(count) => {
                *self = Self { look: Look::Alike, markers: self.markers + count }
            }
            Marks::Distinct(number) => {
                *self = Self { look: Look::Distinct, markers: self.markers | bit(number) };
            }
            Marks::Pointing => *self = Self { look: Look::Pointing, markers: 1 },
        }
    }
}

fn bit(number: u8) -> u8 {
    1_u8.checked_shl(u32::from(number).wrapping_sub(1)).unwrap_or_default()
}

impl Marks {
    /// How they look, a directional one along this door.
    pub(super) fn lying(self, along: Door) -> Sighting {
        match self {
            Self::Alike(count) => Sighting::Lying(count.into()),
            Self::Distinct(number) => {
                let only = MarkerSet::from_numbers([usize::from(number).wrapping_sub(1)]);
                only.map_or(Sighting::Nothing, Sighting::These)
            }
            Self::Pointing => Sighting::Pointing(along),
        }
    }

    /// Whether this is what is seen where they lie.
    pub(super) fn are_seen(self, sighting: Sighting) -> bool {
        match (self, sighting) {
            (Self::Pointing, Sighting::Pointing(_)) => true,
            _ => self.lying(Door::BACK) == sighting,
        }
    }

    /// The actions that drop them.
    pub(super) fn drops(self) -> impl Iterator<Item = AidAction> {
        self.times(AidAction::Drop, AidAction::DropMarker)
    }

    /// The actions that pick them up.
    pub(super) fn pick_ups(self) -> impl Iterator<Item = AidAction> {
        self.times(AidAction::PickUp, AidAction::PickUpMarker)
    }

    fn times(self, any: AidAction, one: fn(u8) -> AidAction) -> impl Iterator<Item = AidAction> {
        let (action, times) = match self {
            Self::Alike(count) => (any, count),
            Self::Distinct(number) => (one(number), 1),
            Self::Pointing => (any, 1),
        };
        std::iter::repeat_n(action, times.into())
    }
}
