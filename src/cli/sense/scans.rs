//! Senses the laser scans of a log.

use std::{io::Write, path::Path};

use serde::Serialize;
use toposlam_logs::{
    entries::Content,
    record::{EventKind, Frame},
    topic_map::{Role, TopicMap},
};
use toposlam_model::{driving::scene::wrapped, enumerate::Watch};
use toposlam_vision::{
    geometry::from_robot,
    laser::{local_map::LocalMap, pictures, scan::Scan, sensor::LaserSensor},
    place::{PlaceSensor, PlaceView, SeenPlace},
};

use super::SenseArguments;
use crate::cli::{
    CliError, input,
    json::print_line,
    picture_file,
    progress::StopSignal,
    scene::{bearing, place_in_words, rounded, rounded_angle},
    text::{counted, print_hanging},
};

/// The JSON line of a scan.
#[derive(Serialize)]
struct ScanLine<'a> {
    log: &'a str,
    scan: u64,
    stamp: f64,
    junctions: Vec<JunctionLine>,
}

/// A junction, relative to the robot.
#[derive(Serialize)]
struct JunctionLine {
    degree: usize,
    position: [f64; 2],
    doors: Vec<f64>,
}

impl JunctionLine {
    fn new(junction: &SeenPlace, view: &PlaceView) -> Self {
        let robot_from_map = from_robot(&view.robot).inverse();
        let door = |arm: f64| rounded_angle(view.robot.seen(arm), std::f64::consts::PI);
        let doors: Vec<f64> = separate(junction).into_iter().map(door).collect();
        Self {
            degree: doors.len(),
            position: (robot_from_map * junction.centre).map(rounded).into(),
            doors,
        }
    }

    /// For example "T, 2.31 m ahead and 0.12 m to the left; doors straight ahead, straight behind".
    fn in_words(&self) -> String {
        let kind = match self.degree {
            1 => "dead end".to_owned(),
            2 => "corner".to_owned(),
            3 => "T".to_owned(),
            degree => format!("junction with {degree} doors"),
        };
        let doors: Vec<_> = self.doors.iter().map(|&door| bearing(door)).collect();
        format!("{kind}, {}; doors {}", place_in_words(self.position), doors.join(", "))
    }
}

/// The directions of the arms of a place. Two ways around something that stands in an arm leave in one direction, and are one
/// door.
fn separate(place: &SeenPlace) -> Vec<f64> {
    let mut doors: Vec<f64> = Vec::new();
    for door in place.directions() {
        if doors.iter().all(|known| wrapped(known - door).abs() >= ONE_DOOR) {
            doors.push(door);
        }
    }
    doors
}

/// Arms that are nearer to each other than this are one door, in radians. Geometry: under half of the angle between two arms
/// of a junction with eight.
const ONE_DOOR: f64 = 0.35;

impl SenseArguments {
    /// Senses the scans of a log, and prints what is seen whenever the robot has moved on.
    pub(super) fn sense_scans(&self, path: &Path, out: &mut dyn Write) -> Result<(), CliError> {
        let wrong = |error: &dyn std::fmt::Display| CliError::in_file(path, error.to_string());
        let log = input::open_log(path)?;
        let topics = match &self.topics {
            None => TopicMap::unambiguous(&log),
            Some(file) => TopicMap::read(&input::read(file)?)
                .map_err(|error| CliError::in_file(file, error))?,
        };
        if topics.carrier(Role::Scan).is_none() || topics.carrier(Role::Odometry).is_none() {
            return Err(wrong(&"this is no image, and no log with laser scans and odometry"));
        }
        let bound = topics.only(&[Role::Scan, Role::Odometry]).bind(&log);
        let bound = bound.map_err(|error| wrong(&error))?;
        if !self.json {
            writeln!(out, "{}", path.display())?;
        }
        let params = self.laser.params(None)?;
        let mut sensor = LaserSensor::new(params);
        let mut number = 0;
        for entry in log.entries(&bound) {
            StopSignal.check_stop()?;
            let entry = entry.map_err(|error| wrong(&error))?;
            let Content::Event(EventKind::Frame(Frame { scan: Some(scan), odometry, .. })) =
                entry.content
            else {
                continue;
            };
            let scan_number = number;
            number += 1;
            if self.scans.as_ref().is_some_and(|scans| scan_number > scans.last) {
                break;
            }
            let Some(view) = sensor.view(&scan, &odometry) else { continue };
            if self.scans.as_ref().is_some_and(|scans| scan_number < scans.first) {
                continue;
            }
            let stamp = entry.stamp.nanoseconds() as f64 / 1e9;
            self.print_scan((path, scan_number, stamp), &view, params.corner.corners, out)?;
            self.write_stages(path, scan_number, &view, sensor.map(), &scan)?;
        }
        match self.scans {
            Some(scans) if scans.first >= number => {
                let count = counted(number as usize, "scan");
                Err(CliError::at("--scans", format!("the log has {count}, counted from 0")))
            }
            _ => Ok(()),
        }
    }

    fn print_scan(
        &self,
        (path, scan, stamp): (&Path, u64, f64),
        view: &PlaceView,
        corners: bool,
        out: &mut dyn Write,
    ) -> Result<(), CliError> {
        // A corridor that passes something on both sides is no junction.
        let is_vertex =
            |junction: &JunctionLine| corners && junction.degree > 0 || junction.degree >= 3;
        let line = |junction: &SeenPlace| JunctionLine::new(junction, view);
        let mut junctions: Vec<_> = view.places.iter().map(line).filter(is_vertex).collect();
        let far = |junction: &JunctionLine| junction.position[0].hypot(junction.position[1]);
        junctions.sort_by(|one, other| far(one).total_cmp(&far(other)));
        if self.json {
            let log = &*path.display().to_string();
            return print_line(out, "scan", &ScanLine { log, scan, stamp, junctions });
        }
        let mut texts: Vec<_> = junctions.iter().map(JunctionLine::in_words).collect();
        if texts.is_empty() {
            texts.push("no junction".to_owned());
        }
        print_hanging(out, &format!("  {scan:>6}  {stamp:.3} s  "), &texts.join("; "))?;
        Ok(())
    }

    fn write_stages(
        &self,
        path: &Path,
        number: u64,
        view: &PlaceView,
        map: Option<&LocalMap>,
        scan: &Scan,
    ) -> Result<(), CliError> {
        let (Some(folder), Some(map)) = (&self.stages, map) else { return Ok(()) };
        for (stage, picture) in &pictures::stages(view, map, scan) {
            let mut name = input::stem(path);
            name.push(format!("-{number}-{stage}.png"));
            let legend = pictures::legend(stage, map.clearances.grid.cell);
            picture_file::write_stage(&folder.join(name), &legend, picture)?;
        }
        Ok(())
    }
}

/// Some scans of a log, counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ScanRange {
    first: u64,
    last: u64,
}

impl std::str::FromStr for ScanRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let (first, last) = text.split_once("..=").unwrap_or((text, text));
        let number = |text: &str| text.parse().map_err(|_| format!("{text:?} is no number"));
        let (first, last) = (number(first)?, number(last)?);
        if last < first {
            return Err("the last scan is before the first one".to_owned());
        }
        Ok(Self { first, last })
    }
}
