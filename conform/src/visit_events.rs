//! The events of the visits that are derived from what a robot sees, and the places where it visited junctions.

use toposlam_logs::record::Arrival;
use toposlam_model::percept::Door;
use toposlam_vision::visits::{Visit, VisitExit, VisitLog};

use super::{
    divergence::OFF,
    events::{CheckedEvent, CheckedKind, EventSource},
    marked_visits::VisitedJunction,
};

/// Visits by what was driven or is seen to end, with their events.
#[derive(Clone, Debug, Default)]
pub struct DrivenVisits {
    pub(crate) events: Vec<CheckedEvent>,
    pub(crate) junctions: Vec<VisitedJunction>,
}

impl DrivenVisits {
    pub(crate) fn new(log: VisitLog<EventSource>) -> Self {
        let (events, junctions) = visit_events(log);
        Self { events, junctions }
    }
}

/// The events of visits, and the junctions of those that are arrivals or undecided. They are in order by construction: the
/// time of an event that belongs to an earlier view than the one before it is that of the one before.
pub fn visit_events(log: VisitLog<EventSource>) -> (Vec<CheckedEvent>, Vec<VisitedJunction>) {
    let (mut events, mut junctions): (Vec<CheckedEvent>, Vec<_>) = (Vec::new(), Vec::new());
    let turned_back =
        |&source: &EventSource| CheckedEvent { source, kind: CheckedKind::TurnedBack };
    for visit in log.visits {
        events.extend(visit.turned_back.iter().map(turned_back));
        let Visit { at, clearance, extent, sighting, shape, hallway, doubt, .. } = visit;
        junctions.push(VisitedJunction {
            event: events.len(),
            centre: visit.centre.into(),
            clearance,
            extent,
            doors: if doubt.is_none() { visit.doors() } else { Vec::new() },
            alternatives: visit.alternatives(),
            goes_back: visit.goes_back,
            exit: visit.exit.map(|exit| exit.direction),
        });
        let mut push = |source, kind| events.push(CheckedEvent { source, kind });
        if let Some(cause) = doubt {
            push(at, CheckedKind::Undecided(cause));
            continue;
        }
        let (percept, entry) = (visit.percept(), visit.entry());
        let degree = percept.degree;
        let arrival = Arrival { number: None, degree, sighting, shape, entry };
        push(at, CheckedKind::Arrival { arrival, entry_off: None, hallway });
        let Some((VisitExit { at, off, .. }, door)) = visit.exit.zip(percept.door) else {
            continue;
        };
        push(at, CheckedKind::Door { door: Door(door), number: None, off });
        if let Some(off) = off.filter(|&off| off > OFF) {
            push(at, CheckedKind::LeftBetweenDoors { off });
        }
    }
    events.extend(log.turned_back.iter().map(turned_back));
    let mut last = 0;
    for CheckedEvent { source, .. } in &mut events {
        source.time = source.time.max(last);
        last = source.time;
    }
    (events, junctions)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

    use toposlam_logs::record::EventId;
    use toposlam_model::driving::{
        odometry::Odometry,
        scene::{CentreLine, HallwayStatus, HallwayView, JunctionView, Place, Scene},
    };

    use super::*;
    use crate::{SensedScene, infer_events, shorten_frames};

    #[test]
    fn what_led_to_an_event_is_the_least_that_was_seen() {
        let hallway = |position, heading| {
            let status = HallwayStatus::Clear;
            let view = HallwayView { heading: 0.0, left: 0.8, right: 0.8, status, confidence: 1.0 };
            (Place::Hallway(view), Odometry { position, heading })
        };
        // A robot that comes along x to an L at the origin, and leaves between its doors.
        let junction = |x: f64| {
            let through = [-x, 0.0];
            let doors = vec![PI, FRAC_PI_2];
            let doors = doors.into_iter().map(|direction| CentreLine { through, direction });
            let doors = doors.collect();
            let view = JunctionView { doors, turning_point: through, confidence: 1.0 };
            (Place::Junction(view), Odometry { position: [x, 0.0], heading: 0.0 })
        };
        let long = vec![hallway([-2.0, 0.0], 0.0); 50];
        let visit = [-0.8, -0.5, -0.2].map(junction).to_vec();
        let aside = vec![hallway([0.7, 0.7], FRAC_PI_4)];
        let scene = |(number, (place, odometry))| SensedScene {
            source: EventSource { time: number, id: EventId(number), offset: 0 },
            scene: Scene { place, marker: None },
            odometry,
        };
        let seen = (0..).zip([long, visit, aside].concat()).map(scene).collect::<Vec<_>>();
        let events = infer_events(&seen, false);
        let kinds = |events: &[CheckedEvent]| match events {
            [percept, door, aside] => {
                assert!(matches!(percept.kind, CheckedKind::Arrival { .. }));
                assert!(matches!(door.kind, CheckedKind::Door { .. }));
                matches!(aside.kind, CheckedKind::LeftBetweenDoors { .. })
            }
            _ => false,
        };
        assert!(kinds(&events), "{events:?}");
        let least = shorten_frames(&seen, &events[2]).unwrap();
        // Two images of the junction, and where the robot went.
        assert!(least.len() == 3 && kinds(&infer_events(least, false)));
        // A robot that turns back comes from a junction.
        let on = [hallway([0.0, 2.0], FRAC_PI_2), hallway([0.0, 1.9], -FRAC_PI_2)];
        let visit = [-0.8, -0.5, -0.2].map(junction).to_vec();
        let seen: Vec<_> = (0..).zip([visit, on.to_vec()].concat()).map(scene).collect();
        let turned = infer_events(&seen, false).pop().unwrap();
        assert_eq!(turned.kind, CheckedKind::TurnedBack);
        assert_eq!(shorten_frames(&seen, &turned).unwrap().len(), 4);
        // A place that is left after the next one was seen is left before it.
        let mut log = VisitLog { visits: Vec::new(), turned_back: Vec::new() };
        log.turned_back = [9, 7, 8].map(|time| EventSource { time, ..events[0].source }).to_vec();
        let times: Vec<_> = visit_events(log).0.iter().map(|event| event.source.time).collect();
        assert_eq!(times, [9, 9, 9]);
        // A percept does not show in what was seen alone.
        assert_eq!(shorten_frames(&seen, &events[0]), None);
    }
}
