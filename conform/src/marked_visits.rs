//! Completes the visits of a laser log with what the robot sees of its marker: sightings of a fiducial, or a
//! marker that is assumed to have lain at a place. Section 2.3.

use thiserror::Error;
use toposlam_logs::{fiducials::FiducialSighting, topic_map::MarkerPlace};
use toposlam_model::{
    driving::scene::wrapped,
    marker::{Directional, Marker, Undirected},
    percept::{Door, Sighting},
};

use super::{
    events::{CheckedEvent, CheckedKind},
    params::LASER,
};

/// A junction that the robot visited, in the frame of odometry at that time.
#[derive(Clone, Debug, PartialEq)]
pub struct VisitedJunction {
    /// The index of the event: an arrival, or a visit that is undecided.
    pub event: usize,
    /// In metres.
    pub centre: [f64; 2],
    /// The distance from the centre to the nearest wall, in metres.
    pub clearance: f64,
    /// The directions of the doors, in radians, clockwise from the entry door; none if the visit is undecided.
    pub doors: Vec<f64>,
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
    /// A fiducial.
    Fiducial {
        /// The number of all sightings.
        sightings: usize,
        /// The number of them at no junction that the robot visited.
        elsewhere: usize,
    },
}

/// A sighting, and when it was, in nanoseconds.
pub type TimedSighting = (u64, FiducialSighting);

/// Why the visits cannot be completed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum MarkedVisitsError {
    /// The marker points somewhere, and the place does not.
    #[error("a directional marker needs a heading: at = [x, y, heading]")]
    NoHeading,
    /// Sightings at junctions are of these markers only.
    #[error("the marker `{0}` cannot be assumed at a place")]
    Marker(&'static str),
}

impl VisitedJunction {
    /// Whether a place is in the junction.
    #[must_use]
    pub fn contains(&self, [x, y]: [f64; 2]) -> bool {
        let off = (self.centre[0] - x).hypot(self.centre[1] - y);
        off <= self.clearance.max(LASER.inside) + LASER.marked_beside
    }

    /// The door nearest to a direction.
    fn door(&self, heading: f64) -> Option<Door> {
        let off = |door: usize| wrapped(self.doors[door] - heading).abs();
        let doors = 0..self.doors.len();
        let nearest = doors.min_by(|&one, &other| off(one).total_cmp(&off(other)))?;
        Some(Door(nearest as u32))
    }
}

/// A marker at the first junction that the robot visited, along its entry door.
#[must_use]
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
    marker: &dyn Marker,
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
    marker: &dyn Marker,
    sightings: &[TimedSighting],
) -> Result<usize, MarkedVisitsError> {
    let directional = is_directional(marker)?;
    // The sum of the unit vectors of the headings at each visit.
    let mut seen: Vec<Option<[f64; 2]>> = vec![None; junctions.len()];
    let mut elsewhere = 0;
    for &(time, FiducialSighting { position, heading }) in sightings {
        let apart = |visit: usize| {
            let begun = events.get(junctions[visit].event).map_or(0, |event| event.source.time);
            let next =
                events.get(junctions[visit].event + 1).map_or(begun, |event| event.source.time);
            begun.saturating_sub(time).max(time.saturating_sub(next))
        };
        let here = (0..junctions.len()).filter(|&visit| junctions[visit].contains(position));
        match here.min_by_key(|&visit| apart(visit)) {
            Some(visit) => {
                let [x, y] = seen[visit].unwrap_or_default();
                seen[visit] = Some([x + heading.cos(), y + heading.sin()]);
            }
            None => elsewhere += 1,
        }
    }
    let mut seen = seen.into_iter();
    complete(events, junctions, |_| {
        let heading = seen.next().flatten()?;
        Some(Some(heading[1].atan2(heading[0])).filter(|_| directional))
    });
    Ok(elsewhere)
}

fn is_directional(marker: &dyn Marker) -> Result<bool, MarkedVisitsError> {
    match marker.name() {
        name if name == Directional.name() => Ok(true),
        name if name == Undirected.name() => Ok(false),
        name => Err(MarkedVisitsError::Marker(name)),
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
        let Some(CheckedEvent { kind: CheckedKind::Arrival { arrival, .. }, .. }) =
            events.get_mut(junction.event)
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
    use crate::EventSource;

    /// Visits of junctions with these centres, one second each, every ten seconds. The robot comes from the
    /// west; the doors are west, north and east.
    fn visits(centres: &[[f64; 2]]) -> (Vec<CheckedEvent>, Vec<VisitedJunction>) {
        let doors = vec![PI, FRAC_PI_2, 0.0];
        let mut events = Vec::new();
        let mut junctions = Vec::new();
        for (number, &centre) in (1_u64..).zip(centres) {
            let event = events.len();
            junctions.push(VisitedJunction { event, centre, clearance: 1.2, doors: doors.clone() });
            let (seconds, entry) = (10 * number, Some(PI));
            let source = |seconds: u64| EventSource {
                time: seconds * 1_000_000_000,
                ..EventSource::default()
            };
            let arrival = Arrival { number: None, degree: 3, sighting: None, form: None, entry };
            let arrived = CheckedKind::Arrival { arrival, entry_off: None, hallway: None };
            events.push(CheckedEvent { source: source(seconds), kind: arrived });
            let left = CheckedKind::Door { door: Door(1), number: None, off: None };
            events.push(CheckedEvent { source: source(seconds + 1), kind: left });
        }
        (events, junctions)
    }

    fn sightings(events: &[CheckedEvent]) -> Vec<Option<Sighting>> {
        let arrivals = events.iter().filter_map(|event| match &event.kind {
            CheckedKind::Arrival { arrival, .. } => Some(arrival.sighting),
            _ => None,
        });
        arrivals.collect()
    }

    const NONE: Option<Sighting> = Some(Sighting::Nothing);

    #[test]
    fn an_assumed_marker_is_seen_at_each_visit_of_its_junction() {
        let centres = [[0.0, 0.0], [20.0, 0.0], [0.5, -0.5]];
        let (mut events, junctions) = visits(&centres);
        let place = MarkerPlace { position: [0.0, 2.0], heading: Some(FRAC_PI_2 - 0.7) };
        assert_eq!(assume_marker(&mut events, &junctions, &Directional, place), Ok(2));
        let north = Some(Sighting::Pointing(Door(1)));
        assert_eq!(sightings(&events), [north, NONE, north]);
        assert_eq!(assume_marker(&mut events, &junctions, &Undirected, place), Ok(2));
        let lies = Some(Sighting::Lying(1));
        assert_eq!(sightings(&events), [lies, NONE, lies]);
        // In no junction.
        let place = MarkerPlace { position: [10.0, 0.0], heading: None };
        assert_eq!(assume_marker(&mut events, &junctions, &Undirected, place), Ok(0));
        let without = assume_marker(&mut events, &junctions, &Directional, place);
        assert_eq!(without, Err(MarkedVisitsError::NoHeading));
        let without = assume_marker(&mut events, &junctions, &NoMarker, place);
        assert_eq!(without, Err(MarkedVisitsError::Marker("none")));
    }

    #[test]
    fn the_marker_at_the_start_points_along_the_way_back() {
        let (mut events, mut junctions) = visits(&[[3.0, 4.0], [20.0, 0.0], [3.0, 4.0]]);
        let place = marker_at_start(&junctions).unwrap();
        assert_eq!(place, MarkerPlace { position: [3.0, 4.0], heading: Some(PI) });
        assume_marker(&mut events, &junctions, &Directional, place).unwrap();
        let back = Some(Sighting::Pointing(Door(0)));
        assert_eq!(sightings(&events), [back, NONE, back]);
        // A visit that is undecided has no doors.
        junctions[0].doors.clear();
        assert_eq!(marker_at_start(&junctions).unwrap().position, [20.0, 0.0]);
    }

    #[test]
    fn a_sighting_belongs_to_the_visit_nearest_in_time() {
        let (mut events, junctions) = visits(&[[0.0, 0.0], [20.0, 0.0], [0.0, 0.0]]);
        let at = |milliseconds: u64, position, heading| {
            (milliseconds * 1_000_000, FiducialSighting { position, heading })
        };
        // Seen before the last visit, west on average; and a tag in a corridor.
        let seen = [
            at(26_000, [1.0, 0.0], PI - 0.9),
            at(28_000, [1.0, 0.5], PI + 0.8),
            at(12_000, [10.0, 0.0], 0.0),
        ];
        assert_eq!(mark_visits(&mut events, &junctions, &Directional, &seen), Ok(1));
        assert_eq!(sightings(&events), [NONE, NONE, Some(Sighting::Pointing(Door(0)))]);
        assert_eq!(mark_visits(&mut events, &junctions, &Undirected, &seen[..1]), Ok(0));
        assert_eq!(sightings(&events), [NONE, NONE, Some(Sighting::Lying(1))]);
        // The first visit ended at 11 s, the last one began at 30 s. North on average.
        let [before, after] = [20_400, 20_600].map(|time| at(time, [1.0, 0.0], 1.5));
        for (seen, expected) in [
            (before, [Some(Sighting::Pointing(Door(1))), NONE, NONE]),
            (after, [NONE, NONE, Some(Sighting::Pointing(Door(1)))]),
        ] {
            assert_eq!(mark_visits(&mut events, &junctions, &Directional, &[seen]), Ok(0));
            assert_eq!(sightings(&events), expected);
        }
    }
}
