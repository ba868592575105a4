//! The scenes of a log, each with the odometry at its time: interpolated between the readings before and after it.
//!
//! The time of a message is its stamp, the clock of the robot. A few messages whose time is far from that of all
//! others are skipped. Any other step back of a clock is an error: the order of the messages is then not known.

use thiserror::Error;
use toposlam_logs::record::EventId;
use toposlam_model::driving::{odometry::Odometry, scene::Scene};

use super::{
    events::EventSource,
    message_clock::{MANY, MessageClock, PAUSE},
    scan_odometry::interpolated,
};

/// The largest step back, in nanoseconds: a message may be sent late.
const LATE: u64 = 1_000_000_000;

/// A scene, and where it was sensed.
#[derive(Clone, Debug, PartialEq)]
pub struct SensedScene {
    /// Its message, or that of its image.
    pub source: EventSource,
    pub scene: Scene,
    pub odometry: Odometry,
}

/// Collects odometry and scenes in the order of the log.
#[derive(Clone, Debug, Default)]
pub(super) struct PlacedScenes {
    readings: Vec<Timed<Odometry>>,
    scenes: Vec<Timed<(EventSource, Scene)>>,
}

/// What a message records, and its stamp in nanoseconds.
#[derive(Clone, Debug)]
struct Timed<T> {
    message: EventId,
    time: u64,
    content: T,
}

/// Why the odometry at the time of a scene is not known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum SceneClockError {
    /// The clock of one topic goes back, from the latest time before it to this one, in nanoseconds.
    #[error(
        "message {message}: its clock goes back, from {:.3} s to {:.3} s",
        *.before as f64 / 1e9,
        *.time as f64 / 1e9
    )]
    Back { message: u64, time: u64, before: u64 },
    /// Many images or scenes together, of which this is the first, have another clock than the odometry.
    #[error(
        "message {message}: its time, {:.3} s, is more than an hour from that of all odometry, as are those of \
         all {many} images or scenes from there on; they have another clock",
        *.time as f64 / 1e9
    )]
    Other { message: u64, time: u64, many: usize },
}

impl PlacedScenes {
    /// Adds a reading of the odometry, at a time in nanoseconds.
    pub(super) fn add_odometry(&mut self, message: EventId, time: u64, odometry: Odometry) {
        self.readings.push(Timed { message, time, content: odometry });
    }

    /// Adds a scene, at a time in nanoseconds.
    pub(super) fn add_scene(&mut self, source: EventSource, time: u64, scene: Scene) {
        self.scenes.push(Timed { message: source.id, time, content: (source, scene) });
    }

    /// The scenes in the order of time, and the number of messages that are skipped; an error if a clock goes back, or
    /// if many scenes together are far from all odometry.
    pub(super) fn finish(self) -> Result<(Vec<SensedScene>, u64), SceneClockError> {
        let (readings, mut skipped) = without_far(self.readings);
        let readings = in_order(readings)?.into_iter();
        let track: Vec<_> = readings.map(|reading| (reading.time, reading.content)).collect();
        let all = self.scenes.len();
        let mut scenes = Vec::new();
        // The last scenes that are far from all odometry.
        let mut off: Vec<Timed<_>> = Vec::new();
        for scene in self.scenes {
            if is_near(&track, scene.time) {
                off.clear();
                scenes.push(scene);
                continue;
            }
            skipped += 1;
            off.push(scene);
            if let [first, ..] = &off[..]
                && (off.len() >= MANY || off.len() == all)
            {
                let (message, time) = (first.message.0, first.time);
                return Err(SceneClockError::Other { message, time, many: off.len() });
            }
        }
        let placed = |Timed { time, content: (source, scene), .. }| {
            Some(SensedScene { source, scene, odometry: at(&track, time)? })
        };
        Ok((in_order(scenes)?.into_iter().filter_map(placed).collect(), skipped))
    }
}

/// Messages in the order of the log without a few that are far from all others, and the number of these.
fn without_far<T>(mut messages: Vec<Timed<T>>) -> (Vec<Timed<T>>, u64) {
    messages.sort_by_key(|message| message.time);
    let mut clock = MessageClock::default();
    let mut near: Vec<_> =
        messages.into_iter().flat_map(|message| clock.next(message.time, message)).collect();
    let (rest, skipped) = clock.finish();
    near.extend(rest);
    near.sort_by_key(|message| message.message);
    (near, skipped)
}

/// Messages of one topic in the order of time.
fn in_order<T>(mut messages: Vec<Timed<T>>) -> Result<Vec<Timed<T>>, SceneClockError> {
    let mut latest = 0;
    for &Timed { message, time, .. } in &messages {
        if time.saturating_add(LATE) < latest {
            return Err(SceneClockError::Back { message: message.0, time, before: latest });
        }
        latest = latest.max(time);
    }
    messages.sort_by_key(|message| message.time);
    Ok(messages)
}

/// Whether there is odometry within an hour of a time.
fn is_near(track: &[(u64, Odometry)], time: u64) -> bool {
    let after = track.partition_point(|&(reading, _)| reading <= time);
    let nearest = [after.checked_sub(1), Some(after)];
    let mut nearest = nearest.into_iter().flatten().filter_map(|index| track.get(index));
    nearest.any(|(reading, _)| reading.abs_diff(time) <= PAUSE)
}

/// The odometry at a time, interpolated between the nearest two readings. Of several at that time the last
/// counts.
fn at(track: &[(u64, Odometry)], time: u64) -> Option<Odometry> {
    let after = track.partition_point(|&(reading, _)| reading <= time);
    match (after.checked_sub(1).and_then(|before| track.get(before)), track.get(after)) {
        (Some(&(begin, from)), Some(&(end, to))) => {
            Some(interpolated((begin, from), (end, to), time))
        }
        (one, other) => one.or(other).map(|&(_, odometry)| odometry),
    }
}

#[cfg(test)]
mod tests {
    use toposlam_model::driving::scene::{Place, Reason};

    use super::*;

    const SECOND: u64 = 1_000_000_000;
    const FAR: u64 = 4_294_970_000;

    /// Where the robot was at the scenes, which have these times in seconds: the odometry, and the scenes, in
    /// turn. It drives a metre in a second.
    fn places(odometry: &[u64], scenes: &[u64]) -> Result<(Vec<f64>, u64), SceneClockError> {
        let mut log = PlacedScenes::default();
        for (index, time) in odometry.iter().enumerate() {
            let at = Odometry { position: [index as f64, 0.0], heading: 0.0 };
            log.add_odometry(EventId(index as u64), time * SECOND, at);
        }
        for (index, time) in scenes.iter().enumerate() {
            let source = EventSource { id: EventId(100 + index as u64), ..EventSource::default() };
            let scene = Scene { place: Place::Unknown(Reason::NothingFits), marker: None };
            log.add_scene(source, time * SECOND, scene);
        }
        let (placed, skipped) = log.finish()?;
        Ok((placed.iter().map(|scene| scene.odometry.position[0]).collect(), skipped))
    }

    fn times(range: std::ops::Range<u64>) -> Vec<u64> {
        range.collect()
    }

    /// These times with other ones in the place of some.
    fn with(range: std::ops::Range<u64>, others: &[(usize, u64)]) -> Vec<u64> {
        let mut times = times(range);
        for &(index, other) in others {
            times[index] = other;
        }
        times
    }

    #[test]
    fn a_few_scenes_and_readings_with_a_wrong_time_are_skipped_and_late_ones_put_in_order() {
        let steady = times(5000..5030);
        let alone: Vec<u64> = (5003..5015).flat_map(|time| [time, FAR]).collect();
        let each: Vec<f64> = (3..15).map(f64::from).collect();
        for (odometry, scenes, expected, skipped) in [
            (&steady, &[5003, 5004][..], &[3.0, 4.0][..], 0),
            // A scene that is far from all odometry has no place.
            (&steady, &[5003, FAR, 5004, 0], &[3.0, 4.0], 2),
            (&steady, &alone, &each, 12),
            // The scenes lie between the readings that are right.
            (&with(5000..5030, &[(3, FAR), (20, 0)]), &[5003, 5020], &[3.0, 20.0], 2),
            // An hour is no jump.
            (&steady, &[5003, 5029 + 3600], &[3.0, 29.0], 0),
            (&steady, &[5003, 5029 + 3601], &[3.0], 1),
            // The reading of the time 6 s is the sixth of the log, that of 5 s the seventh.
            (&with(0..20, &[(5, 6), (6, 5)]), &[6, 5], &[6.0, 5.0], 0),
            (&steady, &[], &[], 0),
        ] {
            assert_eq!(places(odometry, scenes), Ok((expected.to_vec(), skipped)), "{scenes:?}");
        }
    }

    #[test]
    fn a_clock_that_goes_back_and_one_of_the_scenes_alone_are_errors() {
        let back = |message, time: u64, before: u64| {
            let (time, before) = (time * SECOND, before * SECOND);
            Err(SceneClockError::Back { message, time, before })
        };
        let other = |message, time: u64, many| {
            Err(SceneClockError::Other { message, time: time * SECOND, many })
        };
        let steady = times(0..20);
        assert_eq!(places(&steady, &[6, 4]), back(101, 4, 6));
        assert!(places(&with(0..20, &[(5, 7)]), &[6]).is_ok());
        assert_eq!(places(&with(0..20, &[(5, 8)]), &[6]), back(6, 6, 8));
        // Many readings are not skipped.
        let far = [times(0..20), times(FAR..FAR + MANY as u64), times(20..40)].concat();
        assert_eq!(places(&far, &[6]), back(30, 20, FAR + MANY as u64 - 1));
        let scenes = |many: u64| [times(3..9), times(FAR..FAR + many)].concat();
        assert_eq!(places(&steady, &scenes(9)).unwrap().1, 9);
        assert_eq!(places(&steady, &scenes(10)), other(106, FAR, 10));
        // All of them, although they are few.
        assert_eq!(places(&steady, &[FAR, FAR + 1]), other(100, FAR, 2));
        assert_eq!(places(&[], &[5]), other(100, 5, 1));
    }

    #[test]
    fn between_two_readings_a_robot_is_between_two_places() {
        let odometry = |x, heading| Odometry { position: [x, 0.0], heading };
        let track = [(10, odometry(0.0, 3.0)), (20, odometry(1.0, -3.0))];
        for (time, place) in [(5, track[0].1), (10, track[0].1), (20, track[1].1), (30, track[1].1)]
        {
            assert_eq!(at(&track, time), Some(place));
        }
        let half = at(&track, 15).unwrap();
        assert_eq!(half.position, [0.5, 0.0]);
        assert!((half.heading.abs() - std::f64::consts::PI).abs() < 1e-12, "{half:?}");
        assert_eq!(at(&[], 5), None);
        // A CARMEN log has the odometry of a scan after that of the wheels, with the same time.
        let scan = odometry(5.0, 3.0);
        assert_eq!(at(&[track[0], (10, scan), track[1]], 10), Some(scan));
    }
}
