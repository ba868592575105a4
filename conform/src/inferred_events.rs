//! Infers events from scenes and odometry: visits to junctions, and the doors taken. Sections 3 to 5.

use std::f64::consts::FRAC_PI_2;

use toposlam_logs::record::Arrival;
use toposlam_model::{
    driving::{
        odometry::{Odometry, WayLength},
        scene::{JunctionView, Place, Scene, wrapped},
        visit::{JunctionEstimate, JunctionShape},
    },
    measurement::HallwayMeasurement,
    percept::{Door, Percept},
};
use toposlam_robot::measured_hallway::{direction, turn};

use super::{
    events::{CheckedEvent, CheckedKind, EventSource, UndecidedCause},
    params::SCENES,
};

/// Infers events from a sequence of scenes.
#[derive(Clone, Debug)]
pub struct InferredEvents {
    events: Vec<CheckedEvent>,
    approach: Option<Approach>,
    /// The estimate from the scenes since the last junction.
    seen: JunctionEstimate,
    /// The heading when the robot was last in a hallway.
    hallway: Option<f64>,
    /// The way since the last visit; `None` if it is not measured.
    way: Option<WayLength>,
    /// The direction in which the robot left then.
    exit: Option<f64>,
}

/// Consecutive scenes of one junction.
#[derive(Clone, Debug)]
struct Approach {
    /// Of its first scene.
    source: EventSource,
    visit: JunctionEstimate,
    /// The direction of the entry door in the frame of odometry.
    entry: f64,
    /// The turning point in that frame.
    turning_point: [f64; 2],
    /// The smallest distance to the turning point, in metres, and its scene.
    nearest: f64,
    visited: EventSource,
    /// The length of the way to the nearest scene, in metres, and the way since then.
    way: Option<f64>,
    onwards: WayLength,
}

impl InferredEvents {
    /// A robot at its start; if it is `marked`, it puts its marker down there.
    #[must_use]
    pub fn new(marked: bool) -> Self {
        let seen = if marked { JunctionEstimate::at_marker() } else { JunctionEstimate::default() };
        Self { events: Vec::new(), approach: None, seen, hallway: None, way: None, exit: None }
    }

    /// The next scene, and the odometry at its time.
    pub fn see(&mut self, source: EventSource, scene: &Scene, odometry: &Odometry) {
        let onwards = self.approach.as_mut().map(|approach| &mut approach.onwards);
        for way in self.way.iter_mut().chain(onwards) {
            way.add(*odometry);
        }
        match &scene.place {
            Place::Unknown(_) => {}
            Place::Hallway(_) => self.in_hallway(source, scene, odometry),
            Place::Junction(junction) => self.at_junction(source, scene, junction, odometry),
        }
    }

    /// The events, after the last scene.
    #[must_use]
    pub fn finish(mut self) -> Vec<CheckedEvent> {
        if let Some(approach) = self.approach.take().filter(Approach::is_visit) {
            self.visited(&approach);
        }
        self.events
    }

    fn in_hallway(&mut self, source: EventSource, scene: &Scene, odometry: &Odometry) {
        if let Some(approach) = self.approach.take() {
            if !approach.is_over(odometry) {
                // A junction that is still ahead looks like a hallway; its marker is visible.
                let mut approach = approach;
                if !approach.is_visit() {
                    approach.visit.see(scene);
                }
                self.approach = Some(approach);
                return;
            }
            self.leave(source, &approach, odometry.heading);
        } else if let Some(before) = self.hallway
            && wrapped(odometry.heading - before).abs() > FRAC_PI_2
        {
            self.push(source, CheckedKind::TurnedBack);
            self.seen = JunctionEstimate::default();
        }
        self.hallway = Some(odometry.heading);
        self.seen.see(scene);
    }

    /// The robot has left a junction or passed it.
    fn leave(&mut self, source: EventSource, approach: &Approach, heading: f64) {
        if approach.is_visit() {
            let Some((form, entry)) = self.visited(approach) else { return };
            let off = |door: u32| {
                let direction = direction(form, entry, Door(door))?;
                Some((wrapped(heading - direction).abs(), Door(door)))
            };
            let nearest = (0..form.degree()).filter_map(off);
            let nearest = nearest.min_by(|one, other| one.0.total_cmp(&other.0));
            let Some((off, door)) = nearest else { return };
            self.exit = direction(form, entry, door);
            self.push(source, CheckedKind::Door { door, number: None, off: Some(off) });
            if off > SCENES.aside {
                self.push(source, CheckedKind::LeftBetweenDoors { off });
            }
        } else if wrapped(heading - approach.entry).abs() < FRAC_PI_2 {
            self.push(source, CheckedKind::TurnedBack);
        } else {
            self.push(approach.source, CheckedKind::Undecided(UndecidedCause::Unclear));
        }
    }

    fn at_junction(
        &mut self,
        source: EventSource,
        scene: &Scene,
        junction: &JunctionView,
        odometry: &Odometry,
    ) {
        let turning_point = in_frame(junction.turning_point, odometry);
        let another = self.approach.as_ref().is_some_and(|approach| {
            let [x, y] = [0, 1].map(|axis| turning_point[axis] - approach.turning_point[axis]);
            x.hypot(y) > SCENES.another
        });
        if another && let Some(approach) = self.approach.take() {
            self.leave(source, &approach, odometry.heading);
            self.hallway = Some(odometry.heading);
        }
        let way = self.way.and_then(|way| way.length());
        let seen = &mut self.seen;
        let approach = self.approach.get_or_insert_with(|| Approach {
            source,
            visit: std::mem::take(seen),
            entry: junction.doors.first().map_or(0.0, |entry| odometry.whither(entry.direction)),
            turning_point,
            nearest: f64::INFINITY,
            visited: source,
            way,
            onwards: WayLength::default(),
        });
        let junction = junction.clone().entered_from(odometry.seen(approach.entry));
        let [x, y] = junction.turning_point;
        if x.hypot(y) < approach.nearest {
            (approach.nearest, approach.visited, approach.way) = (x.hypot(y), source, way);
            approach.onwards = WayLength::default();
            approach.onwards.add(*odometry);
        }
        approach.visit.see(&Scene { place: Place::Junction(junction), marker: scene.marker });
    }

    /// Adds the percept of a visit, and returns the junction's shape and the direction of its entry. If
    /// the images do not decide the percept, adds that as an event and returns `None`.
    fn visited(&mut self, approach: &Approach) -> Option<(JunctionShape, f64)> {
        let Approach { visit, entry, visited, way, onwards, .. } = approach;
        let (Some(form), Some(percept)) = (visit.form(), visit.percept()) else {
            self.push(*visited, CheckedKind::Undecided(UndecidedCause::Unclear));
            return None;
        };
        let Percept { degree, sighting } = percept;
        let arrival = Arrival {
            number: None,
            degree,
            sighting: Some(sighting),
            form: Some(form),
            entry: Some(*entry),
        };
        let hallway =
            way.map(|length| HallwayMeasurement { length, turn: turn(self.exit, Some(*entry)) });
        self.push(*visited, CheckedKind::Arrival { arrival, entry_off: None, hallway });
        (self.way, self.exit) = (Some(*onwards), None);
        Some((form, *entry))
    }

    fn push(&mut self, source: EventSource, kind: CheckedKind) {
        if matches!(kind, CheckedKind::TurnedBack | CheckedKind::Undecided(_)) {
            self.way = None;
        }
        self.events.push(CheckedEvent { source, kind });
    }
}

impl Approach {
    fn is_visit(&self) -> bool {
        self.nearest <= SCENES.near
    }

    /// Whether a robot in a hallway has left this junction: it is away from it after a visit, has passed it
    /// without one, or faces back.
    fn is_over(&self, odometry: &Odometry) -> bool {
        let [x, y] = [0, 1].map(|axis| odometry.position[axis] - self.turning_point[axis]);
        let inwards = -(x * self.entry.cos() + y * self.entry.sin());
        let looks_back = wrapped(odometry.heading - self.entry).abs() < FRAC_PI_2;
        x.hypot(y) >= SCENES.away && (self.is_visit() || looks_back || inwards >= SCENES.away)
    }
}

/// A point relative to the robot, in the frame of odometry.
fn in_frame([x, y]: [f64; 2], odometry: &Odometry) -> [f64; 2] {
    let (sine, cosine) = odometry.heading.sin_cos();
    let [east, north] = odometry.position;
    [east + x * cosine - y * sine, north + x * sine + y * cosine]
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_4, PI};

    use toposlam_logs::record::EventId;
    use toposlam_model::driving::scene::{CentreLine, HallwayStatus, HallwayView, Reason};

    use super::*;
    use crate::{SensedScene, infer_events, shorten_frames};

    /// What a robot sees that looks along x and has come along it; the junction has a door behind it and
    /// one to its left.
    fn junction(ahead: f64) -> Place {
        let through = [ahead, 0.0];
        let line = |direction| CentreLine { through, direction };
        let doors = vec![line(PI), line(FRAC_PI_2)];
        Place::Junction(JunctionView { doors, turning_point: through, confidence: 1.0 })
    }

    fn hallway() -> Place {
        let (heading, left, right) = (0.0, 0.8, 0.8);
        Place::Hallway(HallwayView {
            heading,
            left,
            right,
            status: HallwayStatus::Clear,
            confidence: 1.0,
        })
    }

    /// Places that are seen from somewhere, in turn.
    fn seen(places: &[(Place, [f64; 2], f64)]) -> Vec<SensedScene> {
        let seen =
            |(message, (place, position, heading)): (usize, &(Place, [f64; 2], f64))| SensedScene {
                source: EventSource {
                    time: message as u64,
                    id: EventId(message as u64),
                    offset: 0,
                },
                scene: Scene { place: place.clone(), marker: None },
                odometry: Odometry { position: *position, heading: *heading },
            };
        places.iter().enumerate().map(seen).collect()
    }

    fn kinds(places: &[(Place, [f64; 2], f64)], marked: bool) -> Vec<&'static str> {
        let name = |event: &CheckedEvent| match event.kind {
            CheckedKind::Arrival { .. } => "percept",
            CheckedKind::Door { .. } => "door",
            CheckedKind::LeftBetweenDoors { .. } => "aside",
            CheckedKind::TurnedBack => "turned back",
            CheckedKind::Undecided(_) => "undecided",
        };
        infer_events(&seen(places), marked).iter().map(name).collect()
    }

    /// A robot that comes along x to a junction at the origin, and visits it.
    fn visit() -> Vec<(Place, [f64; 2], f64)> {
        let from = |x: f64| (junction(-x), [x, 0.0], 0.0);
        vec![(hallway(), [-2.0, 0.0], 0.0), from(-0.8), from(-0.5), from(-0.2)]
    }

    #[test]
    fn a_visit_is_a_percept_and_the_door_by_which_it_ends() {
        let away = (hallway(), [0.0, 1.0], FRAC_PI_2);
        let places = [visit(), vec![away]].concat();
        assert_eq!(kinds(&places, false), ["percept", "door"]);
        let events = infer_events(&seen(&places), false);
        let CheckedKind::Door { door, off: Some(off), .. } = events[1].kind else {
            panic!("{events:?}")
        };
        assert_eq!(door, Door(1));
        assert!(off < 1e-9);
        // What cannot be made out, and a hallway beside the turning point, change nothing.
        let unknown = (Place::Unknown(Reason::NothingFits), [0.0; 2], 0.0);
        let beside = (hallway(), [0.0, 0.1], 0.0);
        let mut places = places;
        places.splice(4..4, [unknown, beside]);
        assert_eq!(kinds(&places, false), ["percept", "door"]);
    }

    #[test]
    fn whoever_leaves_between_the_doors_takes_none() {
        let aside = (hallway(), [0.7, 0.7], FRAC_PI_4);
        let places = [visit(), vec![aside]].concat();
        assert_eq!(kinds(&places, false), ["percept", "door", "aside"]);
    }

    #[test]
    fn turning_back_without_a_visit_is_an_event() {
        let mut places = visit();
        // In a hallway.
        places.push((hallway(), [0.0, 2.0], FRAC_PI_2));
        places.push((hallway(), [0.0, 1.9], -FRAC_PI_2));
        assert_eq!(kinds(&places, false), ["percept", "door", "turned back"]);
        // Before a junction.
        let mut places = visit()[..3].to_vec();
        places.push((hallway(), [-0.7, 0.0], PI));
        assert_eq!(kinds(&places, false), ["turned back"]);
    }

    #[test]
    fn a_junction_that_is_passed_or_seen_once_is_not_made_out() {
        let passed = [visit()[..2].to_vec(), vec![(hallway(), [0.7, 0.0], 0.0)]].concat();
        assert_eq!(kinds(&passed, false), ["undecided"]);
        let once = vec![(junction(0.2), [-0.2, 0.0], 0.0), (hallway(), [0.0, 1.0], FRAC_PI_2)];
        assert_eq!(kinds(&once, false), ["undecided"]);
    }

    #[test]
    fn a_robot_that_begins_with_a_marker_has_it_along_its_entry() {
        let here = (junction(0.0), [0.0; 2], 0.0);
        let places = [here.clone(), here, (hallway(), [-1.0, 0.0], PI)];
        // Without a marker it would have to be looked at from farther off.
        assert_eq!(kinds(&places, true), ["percept", "door"]);
        assert_eq!(kinds(&places, false), ["undecided"]);
    }

    #[test]
    fn what_led_to_an_event_is_the_least_that_was_seen() {
        let aside = (hallway(), [0.7, 0.7], FRAC_PI_4);
        let long = vec![(hallway(), [-2.0, 0.0], 0.0); 50];
        let seen = seen(&[long, visit(), vec![aside]].concat());
        let events = infer_events(&seen, false);
        let least = shorten_frames(&seen, events.last().unwrap()).unwrap();
        // Two images of the junction, and where the robot went.
        assert_eq!(least.len(), 3);
        assert!(matches!(
            infer_events(least, false).last().unwrap().kind,
            CheckedKind::LeftBetweenDoors { .. }
        ));
        // A percept does not show in what was seen alone.
        assert_eq!(shorten_frames(&seen, &events[0]), None);
    }
}
