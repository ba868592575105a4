//! Events from a log that tells percepts and doors itself; odometry, where the log has it, says whether
//! the robot went where they say.

use std::{
    collections::VecDeque,
    f64::consts::{FRAC_PI_2, PI},
};

use toposlam_model::{
    driving::{odometry::Odometry, scene::wrapped, visit::JunctionShape},
    percept::{Door, Percept, Sighting},
};

use super::events::{Event, Kind, Perceived, Source};
use crate::log::{entries::UNTOLD, messages};

/// Odometry tells a direction over so many metres. Over many more it drifts.
const TOLD: f64 = 1.0;

/// Makes events of percepts, doors and odometry as they come.
#[derive(Clone, Debug, Default)]
pub struct RecordedEvents {
    events: Vec<Event>,
    /// Where the robot was of late, by its wheels: as far back as a direction needs.
    way: VecDeque<Odometry>,
    /// That the robot left a junction lately, where, by which event and in which direction.
    left: Option<(Odometry, usize, f64)>,
}

impl RecordedEvents {
    /// The robot is there by its wheels.
    pub fn moved(&mut self, odometry: Odometry) {
        if let Some((from, event, direction)) = self.left
            && from.distance(&odometry) >= TOLD
        {
            self.left = None;
            if let Some(Event { kind: Kind::Left { off, .. }, .. }) = self.events.get_mut(event) {
                *off = Some(wrapped(way(&from, &odometry) - direction).abs());
            }
        }
        while self.way.get(1).is_some_and(|second| second.distance(&odometry) >= TOLD) {
            self.way.pop_front();
        }
        self.way.push_back(odometry);
    }

    /// The robot stands at a junction.
    pub fn perceived(&mut self, source: Source, message: &messages::Percept) {
        let sighting = u32::try_from(message.marker)
            .map_or(Sighting::Nothing, |door| Sighting::Pointing(Door(door)));
        let form = message.form.iter().any(|&door| door).then_some(JunctionShape(message.form));
        let now = self.way.back();
        let came_from = if self.events.is_empty() {
            // At the start the robot stands with its back to the entry door.
            now.map(|now| now.whither(PI))
        } else {
            let ends = self.way.front().zip(now);
            let told = ends.filter(|(from, now)| from.distance(now) >= TOLD);
            told.map(|(from, now)| way(now, from))
        };
        let entry = message.entry.is_finite().then_some(message.entry);
        let entry_off = entry.zip(came_from).map(|(entry, from)| wrapped(entry - from).abs());
        let kind = Kind::Perceived(Perceived {
            percept: Percept { degree: message.degree, sighting },
            number: known(message.r#move),
            form,
            entry,
            entry_off,
        });
        self.events.push(Event { source, kind });
    }

    /// The robot leaves by a door.
    pub fn left(&mut self, source: Source, message: &messages::Door) {
        let door = Door(message.door);
        let direction = match self.events.last().map(|event| &event.kind) {
            Some(Kind::Perceived(Perceived { form: Some(form), entry: Some(entry), .. })) => {
                direction(*form, *entry, door)
            }
            _ => None,
        };
        let now = self.way.back().copied();
        self.left = now.zip(direction).map(|(now, direction)| (now, self.events.len(), direction));
        // What comes next is the way from here.
        self.way.clear();
        self.way.extend(now);
        let kind = Kind::Left { door, number: known(message.r#move), off: None };
        self.events.push(Event { source, kind });
    }

    /// The events.
    #[must_use]
    pub fn finish(self) -> Vec<Event> {
        self.events
    }
}

/// The direction from one place to another.
fn way(from: &Odometry, to: &Odometry) -> f64 {
    let [x, y] = [0, 1].map(|axis| to.position[axis] - from.position[axis]);
    y.atan2(x)
}

/// A number of moves, where the log tells it.
fn known(number: u32) -> Option<u32> {
    (number != UNTOLD).then_some(number)
}

/// The direction in the frame of odometry in which a door of a junction leads.
#[must_use]
pub fn direction(form: JunctionShape, entry: f64, door: Door) -> Option<f64> {
    let mut doors = (0..4).filter(|&quarter| form.0[quarter]);
    let quarter = doors.nth(door.0 as usize)?;
    Some(wrapped(entry - quarter as f64 * FRAC_PI_2))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn percept(number: u32, form: [bool; 4], entry: f64) -> messages::Percept {
        let degree = form.iter().map(|&door| u32::from(door)).sum();
        messages::Percept { r#move: number, degree, marker: -1, form, entry, ..Default::default() }
    }

    /// A robot that comes to a T by its stem, says that it leaves by a door, and drives somewhere.
    fn offs(door: u32, to: [f64; 2], entry: f64) -> (Option<f64>, Option<f64>) {
        let mut telling = RecordedEvents::default();
        let at = |position| Odometry { position, heading: 0.0 };
        telling.moved(at([0.0, 0.0]));
        telling.perceived(Source::default(), &percept(0, [true, true, false, true], PI));
        let message = messages::Door { r#move: 1, door, ..Default::default() };
        telling.left(Source::default(), &message);
        telling.moved(at(to));
        telling.perceived(Source::default(), &percept(1, [true; 4], entry));
        let events = telling.finish();
        let Kind::Left { off, .. } = events[1].kind else { panic!("{events:?}") };
        let Kind::Perceived(perceived) = &events[2].kind else { panic!("{events:?}") };
        (off, perceived.entry_off)
    }

    #[test]
    fn odometry_tells_whether_a_door_was_taken() {
        // Door 1 is to the left, door 2 to the right.
        let (off, entry_off) = offs(1, [0.0, 4.0], -FRAC_PI_2);
        assert!(off.unwrap() < 1e-9 && entry_off.unwrap() < 1e-9);
        assert!((offs(2, [0.0, 4.0], -FRAC_PI_2).0.unwrap() - PI).abs() < 1e-9);
        assert!((offs(1, [0.0, 4.0], PI).1.unwrap() - FRAC_PI_2).abs() < 1e-9);
        // Nor is a door that is not there one in some direction.
        assert_eq!(offs(3, [0.0, 4.0], PI).0, None);
        // Half a metre is too little to tell.
        assert_eq!(offs(1, [0.0, 0.5], PI), (None, None));
    }
}
