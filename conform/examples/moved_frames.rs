//! How many visits of junctions are derived correctly from a real log if the frame of its odometry is turned or
//! shifted, which must not matter, and if its heading drifts.
//!
//! The visits are compared with those that were marked by hand: JSON lines with `degree` and `door`. Those of
//! fewer than three doors count only if a file of parameters makes corners vertices. A visit is right if it is
//! in the longest common subsequence of both lists; the other derived visits are wrong or invented. Undecided
//! ones are neither.
//!
//! ```sh
//! cargo run --release -p toposlam-conform --example moved_frames -- aces.log.gz aces-visits.jsonl [PARAMS.toml]
//! ```

use std::{env, error::Error, fs, path::Path, sync::Arc};

use nalgebra::{Isometry2, Point2, Vector2};
use serde_json::Value;
use toposlam_logs::{
    entries::Content,
    reader::Log,
    record::{EventKind, Frame},
    topic_map::TopicMap,
};
use toposlam_model::driving::odometry::Odometry;
use toposlam_vision::{
    geometry::{self, direction, distance},
    laser::{params::LaserParams, scan::Scan, scan_log::ScanLog},
    params,
    visits::{self, logged_visits},
};

/// Turns of the frame in degrees, each with a shift along both axes in metres.
const FRAMES: [[f64; 2]; 8] = [
    [0.0, 0.0],
    [0.0, 0.05],
    [0.0, 0.1],
    [10.0, 0.0],
    [20.0, 0.07],
    [33.0, 0.03],
    [45.0, 0.0],
    [60.0, 0.1],
];
/// Drifts of the heading, in degrees in 10 m.
const DRIFTS: [f64; 6] = [2.0, -2.0, 5.0, -5.0, 10.0, -10.0];

/// A scan, and the odometry at its time.
type PlacedScan = (Arc<Scan>, Odometry);
/// A degree, and the door that was taken, if it is known.
type Visit = (u64, Option<u64>);

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [log, visits, params @ ..] = &arguments[..] else {
        return Err("usage: moved_frames LOG VISITS [PARAMS]".into());
    };
    let params = match params {
        [] => LaserParams::default(),
        [file, ..] => params::read(&fs::read_to_string(file)?)?,
    };
    let scans = scans(Path::new(log))?;
    let mut marked = marked(&fs::read_to_string(visits)?)?;
    marked.retain(|visit| params.corner.corners || visit.0 >= 3);
    println!("turn  shift  drift    of  right  other  undecided");
    for [turn, shift] in FRAMES {
        let motion = Isometry2::new(Vector2::new(shift, shift), turn.to_radians());
        let moved = scans.iter().map(|(scan, odometry)| (scan, geometry::moved(&motion, odometry)));
        print_row([turn, shift, 0.0], &marked, &derived(moved, &params));
    }
    for drift in DRIFTS {
        let drifted = drifted(&scans, drift.to_radians() / 10.0);
        let scans = scans.iter().zip(drifted).map(|((scan, _), odometry)| (scan, odometry));
        print_row([0.0, 0.0, drift], &marked, &derived(scans, &params));
    }
    Ok(())
}

fn scans(log: &Path) -> Result<Vec<PlacedScan>, Box<dyn Error>> {
    let log = Log::open(log)?;
    let topics = TopicMap::from_log(&log)?.bind(&log)?;
    let mut scans = Vec::new();
    for entry in log.entries(&topics) {
        if let Content::Event(EventKind::Frame(Frame { scan: Some(scan), odometry, .. })) =
            entry?.content
        {
            scans.push((scan, odometry));
        }
    }
    Ok(scans)
}

fn marked(lines: &str) -> Result<Vec<Visit>, Box<dyn Error>> {
    let visit = |line| -> Result<Visit, Box<dyn Error>> {
        let visit: Value = serde_json::from_str(line)?;
        Ok((visit["degree"].as_u64().ok_or("a visit has no degree")?, visit["door"].as_u64()))
    };
    lines.lines().map(visit).collect()
}

/// Odometry whose heading drifts by so many radians a metre.
fn drifted(scans: &[PlacedScan], drift: f64) -> Vec<Odometry> {
    let mut last: Option<(Odometry, Odometry)> = None;
    let mut turned = 0.0;
    let moved = |(_, odometry): &PlacedScan| {
        let position = match last {
            None => odometry.position,
            Some((before, moved)) => {
                let length = distance(before.position, odometry.position);
                let ahead = direction(before.position, odometry.position);
                let step = length * geometry::unit(ahead + turned + drift * length / 2.0);
                turned += drift * length;
                (Point2::from(moved.position) + step).into()
            }
        };
        let moved = Odometry { position, heading: odometry.whither(turned) };
        last = Some((*odometry, moved));
        moved
    };
    scans.iter().map(moved).collect()
}

/// The visits that are decided, and the number of those that are not.
fn derived<'a>(
    scans: impl Iterator<Item = (&'a Arc<Scan>, Odometry)>,
    params: &LaserParams,
) -> (Vec<Visit>, usize) {
    let log = ScanLog::new(scans.map(|(scan, odometry)| (Arc::clone(scan), odometry)), *params);
    let views: Vec<_> = (0..log.len()).map(|view| log.view(view, false)).collect();
    let mut visits = logged_visits(&log, &views, |_| ()).visits;
    let all = visits.len();
    visits.retain(|visit| visit.doubt.is_none());
    let undecided = all - visits.len();
    let percepts = visits.iter().map(visits::Visit::percept);
    (percepts.map(|seen| (seen.degree.into(), seen.door.map(u64::from))).collect(), undecided)
}

fn print_row(
    [turn, shift, drift]: [f64; 3],
    marked: &[Visit],
    (visits, undecided): &(Vec<Visit>, usize),
) {
    let right = common(marked, visits);
    println!(
        "{turn:>4}  {shift:>5}  {drift:>5}  {:>4}  {right:>5}  {:>5}  {undecided:>9}",
        marked.len(),
        visits.len() - right
    );
}

/// The length of the longest common subsequence. A marked visit without a door has any.
fn common(marked: &[Visit], visits: &[Visit]) -> usize {
    let mut lengths = vec![0; visits.len() + 1];
    for mark in marked {
        let before = lengths.clone();
        for (index, visit) in visits.iter().enumerate() {
            let is_same = mark.0 == visit.0 && (mark.1.is_none() || mark.1 == visit.1);
            let longer = before[index] + usize::from(is_same);
            lengths[index + 1] = longer.max(before[index + 1]).max(lengths[index]);
        }
    }
    lengths.last().copied().unwrap_or_default()
}
