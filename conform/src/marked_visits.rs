//! Completes the visits of a laser log with what the robot sees of its marker: sightings of a fiducial, or a
//! marker that is assumed to have lain at a place. Section 2.3.

use nalgebra::Vector2;
use thiserror::Error;
use toposlam_logs::{fiducials::FiducialSighting, topic_map::MarkerPlace};
use toposlam_model::{
    marker::{Directional, MarkerKind, Undirected},
    percept::{Door, Sighting},
};
use toposlam_vision::{
    geometry::{angle, distance, unit},
    place::nearest_direction,
    visits::VisitPercept,
};

use super::events::CheckedEvent;

/// A junction contains a place that is at most this much farther from its centre than its extent, in metres: half of the
/// shortest way between two junctions.
const BESIDE: f64 = 1.5;

/// A junction that the robot visited, in the frame of odometry at that time.
#[derive(Clone, Debug, PartialEq)]
pub struct VisitedJunction {
    /// The index of the event: an arrival, or a visit that is undecided.
    pub event: usize,
    pub centre: [f64; 2],
    /// The distance from the centre to the nearest wall, in metres.
    pub clearance: f64,
    /// What is nearer to the centre is within the junction, in metres.
    pub extent: f64,
    /// The directions of the doors, in radians, clockwise from the entry door; none if the visit is undecided.
    pub doors: Vec<f64>,
    /// The percepts that the views cannot exclude, of which `None` is no junction; none if nothing is known.
    pub alternatives: Vec<Option<VisitPercept>>,
    /// Whether the robot left the way that it came.
    pub goes_back: bool,
    /// The direction to where it left, in radians; `None` if the log ends there.
    pub exit: Option<f64>,
}

/// Sightings that the log itself does not record as percepts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AddedMarker {
    /// A marker that was not there.
    Assumed {
        /// In the frame of odometry, in metres.
        position: [f64; 2],
        /// In radians; `None` for an undirected marker.
        heading: Option<f64>,
        /// The number of visits at which it would have been seen.
        seen: usize,
    },
    /// A fiducial, and how many of its sightings were at no junction that the robot visited.
    Fiducial { sightings: usize, elsewhere: usize },
}

/// A sighting, and when it was, in nanoseconds.
pub type TimedSighting = (u64, FiducialSighting);

#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum MarkedVisitsError {
    #[error("a directional marker needs a heading: at = [x, y, heading]")]
    NoHeading,
    #[error("the marker `{0}` cannot be assumed at a place")]
    Marker(&'static str),
}

impl VisitedJunction {
    fn contains(&self, place: [f64; 2]) -> bool {
        distance(self.centre, place) <= self.extent + BESIDE
    }

    fn door(&self, heading: f64) -> Option<Door> {
        nearest_direction(&self.doors, heading).map(|door| Door(door as u32))
    }
}

/// A marker at the first junction that the robot visited, along its entry door.
pub fn marker_at_start(junctions: &[VisitedJunction]) -> Option<MarkerPlace> {
    let first = junctions.iter().find(|junction| !junction.doors.is_empty())?;
    Some(MarkerPlace { position: first.centre, heading: first.doors.first().copied() })
}

/// Completes the arrivals as if a marker had lain at a place: at a junction that contains it the marker is
/// seen, directed along the door nearest to its heading. Returns the number of visits at which it is seen.
///
/// # Errors
/// Returns an error if the marker has no place, or a directional one no heading.
pub fn assume_marker(
    events: &mut [CheckedEvent],
    junctions: &[VisitedJunction],
    marker: MarkerKind,
    place: MarkerPlace,
) -> Result<usize, MarkedVisitsError> {
    let directional = is_directional(marker)?;
    if directional && place.heading.is_none() {
        return Err(MarkedVisitsError::NoHeading);
    }
    Ok(complete(events, junctions, |junction| {
        let here = junction.contains(place.position);
        let heading = place.heading.filter(|_| directional);
        here.then_some(heading)
    }))
}

/// Completes the arrivals with sightings of a fiducial. A sighting belongs to the visit, nearest in time, of a
/// junction that contains the fiducial. Returns the number of sightings that belong to none.
///
/// # Errors
/// Returns an error if the marker is not of a kind that lies at a junction.
pub fn mark_visits(
    events: &mut [CheckedEvent],
    junctions: &[VisitedJunction],
    marker: MarkerKind,
    sightings: &[TimedSighting],
) -> Result<usize, MarkedVisitsError> {
    let directional = is_directional(marker)?;
    // The sum of the unit vectors of the headings at each visit.
    let mut seen: Vec<Option<Vector2<f64>>> = vec![None; junctions.len()];
    let mut elsewhere = 0;
    for &(time, FiducialSighting { position, heading }) in sightings {
        let apart = |visit: &usize| {
            let event = junctions[*visit].event;
            let begun = events.get(event).map_or(0, |event| event.source.time);
            let next = events.get(event + 1).map_or(begun, |event| event.source.time);
            begun.saturating_sub(time).max(time.saturating_sub(next))
        };
        let here = (0..junctions.len()).filter(|&visit| junctions[visit].contains(position));
        match here.min_by_key(apart) {
            Some(visit) => {
                seen[visit] = Some(seen[visit].unwrap_or_default() + unit(heading));
            }
            None => elsewhere += 1,
        }
    }
    let mut seen = seen.into_iter();
    complete(events, junctions, |_| {
        let heading = seen.next().flatten()?;
        Some(Some(angle(heading)).filter(|_| directional))
    });
    Ok(elsewhere)
}

fn is_directional(marker: MarkerKind) -> Result<bool, MarkedVisitsError> {
    match marker {
        Directional => Ok(true),
        Undirected => Ok(false),
        other => Err(MarkedVisitsError::Marker(other.name())),
    }
}

/// Completes each arrival: whether the marker is at its junction, and its heading if it is directional.
/// Returns the number of arrivals at which it is.
fn complete(
    events: &mut [CheckedEvent],
    junctions: &[VisitedJunction],
    mut heading_at: impl FnMut(&VisitedJunction) -> Option<Option<f64>>,
) -> usize {
    let mut seen = 0;
    for junction in junctions {
        let heading = heading_at(junction);
        let Some(arrival) = events.get_mut(junction.event).and_then(CheckedEvent::arrival_mut)
        else {
            continue;
        };
        arrival.sighting = Some(match heading {
            None => Sighting::Nothing,
            Some(None) => Sighting::Lying(1),
            Some(Some(heading)) => {
                junction.door(heading).map_or(Sighting::Nothing, Sighting::Pointing)
            }
        });
        seen += usize::from(arrival.sighting != Some(Sighting::Nothing));
    }
    seen
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use toposlam_logs::record::Arrival;
    use toposlam_model::marker::NoMarker;

    use super::*;
    use crate::{CheckedKind, EventSource};

    const NONE: Option<Sighting> = Some(Sighting::Nothing);
    const LIES: Option<Sighting> = Some(Sighting::Lying(1));

    #[expect(clippy::unnecessary_wraps, reason = "a percept may have none")]
    fn along(door: u32) -> Option<Sighting> {
        Some(Sighting::Pointing(Door(door)))
    }

    /// Visits of junctions with these centres, one second each, every ten seconds. The robot comes from the
    /// west; the doors are west, north and east.
    fn visits(centres: [[f64; 2]; 3]) -> (Vec<CheckedEvent>, Vec<VisitedJunction>) {
        let doors = vec![PI, FRAC_PI_2, 0.0];
        let (mut events, mut junctions) = (Vec::new(), Vec::new());
        for (number, centre) in (1_u64..).zip(centres) {
            let (event, doors) = (events.len(), doors.clone());
            junctions.push(VisitedJunction {
                event,
                centre,
                clearance: 1.2,
                extent: 1.2,
                doors,
                alternatives: Vec::new(),
                goes_back: false,
                exit: None,
            });
            let entry = Some(PI);
            let arrival = Arrival { number: None, degree: 3, sighting: None, shape: None, entry };
            let arrived = CheckedKind::Arrival { arrival, entry_off: None, hallway: None };
            for (seconds, kind) in [(0, arrived), (1, Door(1).into())] {
                let time = (10 * number + seconds) * 1_000_000_000;
                let source = EventSource { time, ..EventSource::default() };
                events.push(CheckedEvent { source, kind });
            }
        }
        (events, junctions)
    }

    fn sightings(events: &[CheckedEvent]) -> Vec<Option<Sighting>> {
        events.iter().filter_map(|event| Some(event.arrival()?.sighting)).collect()
    }

    #[test]
    fn an_assumed_marker_is_seen_at_each_visit_of_its_junction() {
        let (mut events, junctions) = visits([[0.0, 0.0], [20.0, 0.0], [0.5, -0.5]]);
        let here = MarkerPlace { position: [0.0, 2.0], heading: Some(FRAC_PI_2 - 0.7) };
        let nowhere = MarkerPlace { position: [10.0, 0.0], heading: None };
        for (marker, place, seen, expected) in [
            (Directional, here, Ok(2), [along(1), NONE, along(1)]),
            (Undirected, here, Ok(2), [LIES, NONE, LIES]),
            (Undirected, nowhere, Ok(0), [NONE; 3]),
            (Directional, nowhere, Err(MarkedVisitsError::NoHeading), [NONE; 3]),
            (NoMarker, here, Err(MarkedVisitsError::Marker("none")), [NONE; 3]),
        ] {
            assert_eq!(assume_marker(&mut events, &junctions, marker, place), seen);
            assert_eq!(sightings(&events), expected);
        }
    }

    #[test]
    fn the_marker_at_the_start_points_along_the_way_back() {
        let (mut events, mut junctions) = visits([[3.0, 4.0], [20.0, 0.0], [3.0, 4.0]]);
        let place = marker_at_start(&junctions).unwrap();
        assert_eq!(place, MarkerPlace { position: [3.0, 4.0], heading: Some(PI) });
        assume_marker(&mut events, &junctions, Directional, place).unwrap();
        assert_eq!(sightings(&events), [along(0), NONE, along(0)]);
        // A visit that is undecided has no doors.
        junctions[0].doors.clear();
        assert_eq!(marker_at_start(&junctions).unwrap().position, [20.0, 0.0]);
    }

    #[test]
    fn a_sighting_belongs_to_the_visit_nearest_in_time() {
        let (mut events, junctions) = visits([[0.0, 0.0], [20.0, 0.0], [0.0, 0.0]]);
        let at = |milliseconds: u64, position, heading| {
            (milliseconds * 1_000_000, FiducialSighting { position, heading })
        };
        // Seen before the last visit, west on average; and a tag in a corridor.
        let last = [at(26_000, [1.0, 0.0], PI - 0.9), at(28_000, [1.0, 0.5], PI + 0.8)];
        let and_elsewhere = [last[0], last[1], at(12_000, [10.0, 0.0], 0.0)];
        // The first visit ended at 11 s, the last one began at 30 s.
        let [before, after] = [20_400, 20_600].map(|time| [at(time, [1.0, 0.0], 1.5)]);
        for (marker, seen, elsewhere, expected) in [
            (Directional, &and_elsewhere[..], 1, [NONE, NONE, along(0)]),
            (Undirected, &last[..1], 0, [NONE, NONE, LIES]),
            (Directional, &before, 0, [along(1), NONE, NONE]),
            (Directional, &after, 0, [NONE, NONE, along(1)]),
        ] {
            assert_eq!(mark_visits(&mut events, &junctions, marker, seen), Ok(elsewhere));
            assert_eq!(sightings(&events), expected);
        }
    }
}
