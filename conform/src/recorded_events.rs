//! The recorded arrivals, actions and doors of a log, compared with its odometry.

use std::{collections::VecDeque, f64::consts::PI};

use toposlam_logs::record::{Arrival, EventKind};
use toposlam_model::{
    driving::{odometry::Odometry, scene::wrapped},
    percept::Door,
};
use toposlam_robot::measured_hallway::{MeasuredHallway, direction};
use toposlam_vision::geometry;

use super::events::{CheckedEvent, CheckedKind, EventSource};

/// A direction by odometry needs this distance, in metres. Over much more, odometry drifts.
const FAR_ENOUGH: f64 = 1.0;

/// Collects arrivals and doors, and measures the directions between them.
#[derive(Clone, Debug, Default)]
pub struct RecordedEvents {
    events: Vec<CheckedEvent>,
    /// The last odometry, as far back as a direction needs.
    way: VecDeque<Odometry>,
    /// Where the robot last left a junction, the index of the event, and the direction of the door.
    left: Option<(Odometry, usize, f64)>,
    /// The hallway since the last arrival.
    hallway: Option<MeasuredHallway>,
    /// Whether the robot drives into arms before it reports where it is, as in a network of corridors: then its last way is
    /// not that by which it came.
    drives_into_arms: bool,
}

impl RecordedEvents {
    /// The next event of the log.
    pub fn observe(&mut self, source: EventSource, kind: &EventKind) {
        match kind {
            EventKind::Odometry(odometry) => self.moved(*odometry),
            EventKind::Arrival(arrival) if self.has_acted() => {
                let arrival = *arrival;
                let kind = CheckedKind::Arrival { arrival, entry_off: None, hallway: None };
                self.events.push(CheckedEvent { source, kind });
            }
            EventKind::Arrival(arrival) => self.arrived(source, *arrival),
            EventKind::Door { number, door } => self.left(source, *number, *door),
            EventKind::Action { number, action } => {
                let kind = CheckedKind::Action { number: *number, action: *action };
                self.events.push(CheckedEvent { source, kind });
            }
            _ => {}
        }
    }

    /// An event that is neither an arrival nor a door.
    pub fn note(&mut self, source: EventSource, kind: CheckedKind) {
        (self.left, self.hallway) = (None, None);
        self.events.push(CheckedEvent { source, kind });
    }

    /// Whether the robot has just done something with its marking aid: it then perceives again where it stands.
    fn has_acted(&self) -> bool {
        let last = self.events.last();
        last.is_some_and(|event| matches!(event.kind, CheckedKind::Action { .. }))
    }

    fn moved(&mut self, odometry: Odometry) {
        if let Some(hallway) = &mut self.hallway {
            hallway.add(odometry);
        }
        if let Some((from, event, direction)) = self.left
            && from.distance(&odometry) >= FAR_ENOUGH
        {
            self.left = None;
            if let Some(CheckedEvent { kind: CheckedKind::Door { off, .. }, .. }) =
                self.events.get_mut(event)
            {
                let way = geometry::direction(from.position, odometry.position);
                *off = Some(wrapped(way - direction).abs());
            }
        }
        while self.way.get(1).is_some_and(|second| second.distance(&odometry) >= FAR_ENOUGH) {
            self.way.pop_front();
        }
        self.way.push_back(odometry);
    }

    fn arrived(&mut self, source: EventSource, arrival: Arrival) {
        self.drives_into_arms |= arrival.shape.is_none() && arrival.degree > 1;
        let now = self.way.back();
        let came_from = if self.events.is_empty() {
            // At the start the robot stands with its back to the entry door.
            now.map(|now| now.whither(PI))
        } else {
            let ends = self.way.front().zip(now);
            let far_enough = ends.filter(|(from, now)| from.distance(now) >= FAR_ENOUGH);
            far_enough.map(|(from, now)| geometry::direction(now.position, from.position))
        };
        let entry_off = arrival.entry.zip(came_from).filter(|_| !self.drives_into_arms);
        let entry_off = entry_off.map(|(entry, from)| wrapped(entry - from).abs());
        let hallway = self.hallway.take().filter(|_| !self.drives_into_arms);
        let hallway = hallway.and_then(|hallway| hallway.measured(arrival.entry));
        self.hallway = Some(MeasuredHallway::from(now.copied()));
        let kind = CheckedKind::Arrival { arrival, entry_off, hallway };
        self.events.push(CheckedEvent { source, kind });
    }

    fn left(&mut self, source: EventSource, number: Option<u32>, door: Door) {
        let arrived =
            self.events.iter().rfind(|event| !matches!(event.kind, CheckedKind::Action { .. }));
        let direction = match arrived.map(|event| &event.kind) {
            Some(CheckedKind::Arrival {
                arrival: Arrival { shape: Some(shape), entry: Some(entry), .. },
                ..
            }) => direction(*shape, *entry, door),
            _ => None,
        };
        let now = self.way.back().copied();
        if let Some(hallway) = &mut self.hallway {
            hallway.leave(direction);
        }
        self.left = now.zip(direction).map(|(now, direction)| (now, self.events.len(), direction));
        // The next direction starts here.
        self.way.clear();
        self.way.extend(now);
        self.events
            .push(CheckedEvent { source, kind: CheckedKind::Door { door, number, off: None } });
    }

    /// The events.
    pub fn finish(self) -> Vec<CheckedEvent> {
        self.events
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use toposlam_model::{aid::AidAction, driving::visit::JunctionShape, percept::Sighting};

    use super::*;

    fn arrival(number: u32, shape: [bool; 4], entry: f64) -> EventKind {
        let shape = JunctionShape(shape);
        let (degree, sighting) = (shape.degree(), Some(Sighting::Nothing));
        let (number, shape, entry) = (Some(number), Some(shape), Some(entry));
        EventKind::Arrival(Arrival { number, degree, sighting, shape, entry })
    }

    /// A robot that comes to a T by its stem, leaves by a door as the log says, and drives somewhere.
    fn offs(door: u32, to: [f64; 2], entry: f64) -> (Option<f64>, Option<f64>) {
        let mut recorded = RecordedEvents::default();
        let at = |position| EventKind::Odometry(Odometry { position, heading: 0.0 });
        for kind in [
            at([0.0, 0.0]),
            arrival(0, [true, true, false, true], PI),
            EventKind::Door { number: Some(1), door: Door(door) },
            at(to),
            arrival(1, [true; 4], entry),
        ] {
            recorded.observe(EventSource::default(), &kind);
        }
        let events = recorded.finish();
        let CheckedKind::Door { off, .. } = events[1].kind else { panic!("{events:?}") };
        let CheckedKind::Arrival { entry_off, .. } = events[2].kind else { panic!("{events:?}") };
        (off, entry_off)
    }

    #[test]
    fn a_robot_that_does_something_with_its_marker_perceives_again_where_it_stands() {
        let mut recorded = RecordedEvents::default();
        let mut observe = |kind| recorded.observe(EventSource::default(), &kind);
        let at = |x| EventKind::Odometry(Odometry { position: [x, 0.0], heading: 0.0 });
        observe(arrival(0, [true, true, false, true], PI));
        observe(EventKind::Door { number: Some(1), door: Door(1) });
        observe(at(0.0));
        observe(at(4.0));
        observe(arrival(1, [true; 4], PI));
        let action = AidAction::Drop;
        observe(EventKind::Action { number: Some(1), action });
        observe(arrival(1, [true; 4], PI));
        let [.., before, acted, again] = &recorded.finish()[..] else { panic!() };
        assert_eq!(acted.kind, CheckedKind::Action { number: Some(1), action });
        let measured = |event: &CheckedEvent| match &event.kind {
            CheckedKind::Arrival { entry_off, .. } => entry_off.is_some(),
            other => panic!("{other:?}"),
        };
        assert_eq!([before, again].map(measured), [true, false]);
    }

    /// In a network of corridors a junction has no shape of right angles.
    #[test]
    fn a_robot_that_drives_into_arms_is_not_accused_of_the_way_to_the_place_where_it_was_before() {
        let mut recorded = RecordedEvents::default();
        let mut observe = |kind| recorded.observe(EventSource::default(), &kind);
        let at = |x| EventKind::Odometry(Odometry { position: [x, 0.0], heading: 0.0 });
        let sighting = Some(Sighting::Nothing);
        let junction =
            Arrival { number: Some(0), degree: 3, sighting, shape: None, entry: Some(PI) };
        observe(EventKind::Arrival(junction));
        observe(EventKind::Door { number: Some(1), door: Door(1) });
        // It came from the west, and was at last in the arm to the east.
        for x in [0.0, 30.0, 20.0] {
            observe(at(x));
        }
        observe(EventKind::Arrival(Arrival { number: Some(1), ..junction }));
        let last = recorded.finish().pop().unwrap();
        let CheckedKind::Arrival { entry_off, hallway, .. } = last.kind else { panic!("{last:?}") };
        assert_eq!((entry_off, hallway), (None, None));
        // A dead end has no shape of right angles anywhere.
        let mut recorded = RecordedEvents::default();
        let mut observe = |kind| recorded.observe(EventSource::default(), &kind);
        observe(EventKind::Arrival(Arrival { degree: 1, ..junction }));
        observe(at(0.0));
        observe(at(4.0));
        observe(arrival(1, [true; 4], PI));
        let last = recorded.finish().pop().unwrap();
        let CheckedKind::Arrival { entry_off, .. } = last.kind else { panic!("{last:?}") };
        assert_eq!(entry_off, Some(0.0));
    }

    #[test]
    fn odometry_decides_whether_a_door_was_taken() {
        // Door 1 is to the left, door 2 to the right.
        let (off, entry_off) = offs(1, [0.0, 4.0], -FRAC_PI_2);
        assert!(off.unwrap() < 1e-9 && entry_off.unwrap() < 1e-9);
        assert!((offs(2, [0.0, 4.0], -FRAC_PI_2).0.unwrap() - PI).abs() < 1e-9);
        assert!((offs(1, [0.0, 4.0], PI).1.unwrap() - FRAC_PI_2).abs() < 1e-9);
        // A door that does not exist has no direction.
        assert_eq!(offs(3, [0.0, 4.0], PI).0, None);
        // Half a metre is too short to decide.
        assert_eq!(offs(1, [0.0, 0.5], PI), (None, None));
    }
}
