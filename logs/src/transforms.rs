//! The frames of a robot, as `/tf` and `/tf_static` relate them: the pose of a scanner on its robot, and
//! odometry.
//!
//! The robot is `base_link`, `base_footprint` or `base`, or else the frame of which the odometry is, and moves in the
//! frame `odom` (REP 105). A slash before a name is ignored, and so is a name of the robot before a slash.

use std::collections::BTreeMap;

use nalgebra::{Isometry2, Isometry3, UnitQuaternion, Vector3};
use toposlam_model::driving::odometry::Odometry;
use toposlam_vision::{geometry::angle, laser::scan::ScanGeometry};

use super::{
    error::LogError, messages::Stamp, reader::Log, standard::Quaternion, topic::Topic, value::Value,
};

pub(super) const TYPE: &str = "tf2_msgs/TFMessage";
pub(super) const OLD_TYPE: &str = "tf/tfMessage";

pub(super) fn is_transforms(type_name: &str) -> bool {
    type_name == TYPE || type_name == OLD_TYPE
}

const BASES: [&str; 3] = ["base_link", "base_footprint", "base"];
const ODOM: &str = "odom";
/// The frames in which a robot moves (REP 105), and other usual names of them.
const FLOORS: [&str; 5] = [ODOM, "map", "world", "earth", "odom_combined"];
/// More frames than any robot has between its scanner and its centre.
const MOST_FRAMES: usize = 64;
/// What to do if no transforms lead from a scanner to the robot.
const STATE_IT: &str = "a topics file (--topics) can state where the scanner is, in metres ahead and to the left and \
                        radians: [scanner] mount = [x, y, yaw]; or the frame of the robot: base_frame = \"NAME\"";
/// A scanner is level if its axis leans by less than this, as a cosine: about 25 degrees.
const LEVEL: f64 = 0.9;

/// The pose of one frame in another; `None` if a number is not finite, or the quaternion is no rotation.
pub(super) fn isometry(
    translation: [f64; 3],
    Quaternion { x, y, z, w }: Quaternion,
) -> Option<Isometry3<f64>> {
    let quaternion = nalgebra::Quaternion::new(w, x, y, z);
    let norm = quaternion.norm();
    let is_finite = norm.is_finite() && translation.iter().all(|part| part.is_finite());
    (is_finite && norm >= 1e-3).then(|| {
        let rotation = UnitQuaternion::from_quaternion(quaternion);
        Isometry3::from_parts(translation.into(), rotation)
    })
}

pub(super) fn on_floor(Odometry { position: [x, y], heading }: &Odometry) -> Isometry3<f64> {
    Isometry3::new(Vector3::new(*x, *y, 0.0), *heading * Vector3::z())
}

/// The direction of the x axis of a frame, seen from above, in radians.
pub(super) fn heading(pose: &Isometry3<f64>) -> f64 {
    angle((pose * Vector3::x()).xy())
}

pub(super) struct FrameTransform {
    pub(super) parent: String,
    pub(super) child: String,
    pub(super) stamp: Option<Stamp>,
    pub(super) parent_from_child: Isometry3<f64>,
}

/// The transforms in a message, without those that are no rigid transforms.
pub(super) fn transforms(message: &Value<'_>) -> Vec<FrameTransform> {
    let one = |transform: &Value<'_>| {
        let part = |name| transform.get(&format!("transform.translation.{name}"));
        let translation = [part("x")?, part("y")?, part("z")?];
        let rotation = transform.quaternion_at("transform.rotation", Value::number_at).ok()?;
        Some(FrameTransform {
            parent: frame_name(&transform.get::<String>("header.frame_id")?),
            child: frame_name(&transform.get::<String>("child_frame_id")?),
            stamp: transform.get("header.stamp"),
            parent_from_child: isometry(translation, rotation)?,
        })
    };
    message.list_at("transforms").iter().filter_map(one).collect()
}

/// The name of a frame without the slash before it.
pub(super) fn frame_name(name: &str) -> String {
    name.trim_start_matches('/').to_owned()
}

/// Whether a frame has this name, perhaps behind that of the robot.
fn is_called(frame: &str, name: &str) -> bool {
    frame.rsplit('/').next() == Some(name)
}

/// Whether a frame is fixed to the floor on which the robot drives.
pub(super) fn is_odometry(frame: &str) -> bool {
    is_called(frame, ODOM)
}

fn is_base(frame: &str) -> bool {
    BASES.iter().any(|base| is_called(frame, base))
}

/// Whether a frame is one of the usual ones of a robot: `base_link`, `base_footprint` or `base`.
pub fn is_robot_frame(frame: &str) -> bool {
    is_base(&frame_name(frame))
}

/// Whether a robot moves in a frame.
fn is_floor(frame: &str) -> bool {
    FLOORS.iter().any(|floor| is_called(frame, floor))
}

/// A pose on the floor, as odometry.
fn to_floor(pose: &Isometry3<f64>) -> Odometry {
    Odometry { position: pose.translation.vector.xy().into(), heading: heading(pose) }
}

/// What a topics file states of the scanner, and transforms do not.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ScannerFrames {
    /// Where the scanner is on the robot: metres ahead and to the left, and radians counter-clockwise.
    pub mount: Option<[f64; 3]>,
    /// The name of the frame of the robot.
    pub base_frame: Option<String>,
}

/// Where a scanner is on its robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mount {
    pub robot_from_scanner: Isometry2<f64>,
    /// Whether it is mounted upside down, so that its angles count clockwise from above.
    pub is_upside_down: bool,
}

impl Mount {
    /// In the robot's centre, looking ahead.
    pub fn centre() -> Self {
        Self { robot_from_scanner: Isometry2::identity(), is_upside_down: false }
    }

    /// The geometry of a scan with angles counter-clockwise from above.
    pub fn seen_from_above(&self, geometry: ScanGeometry) -> ScanGeometry {
        let sense = if self.is_upside_down { -1.0 } else { 1.0 };
        let ScanGeometry { angle_min, angle_increment, .. } = geometry;
        ScanGeometry {
            angle_min: sense * angle_min,
            angle_increment: sense * angle_increment,
            ..geometry
        }
    }
}

/// The frames of a log, and the mounts of its scanners.
pub(super) struct Mounts<'l> {
    log: &'l Log,
    stated: ScannerFrames,
    tree: Option<FrameTree>,
    /// Whether transforms that may change are in the tree, too.
    has_moving: bool,
    frames: BTreeMap<String, Result<Isometry3<f64>, String>>,
    /// The topic of the odometry, and the frame that its first message names.
    odometry: Option<usize>,
    child: Option<String>,
    /// The frame of which the odometry is, and its pose on the robot if it is another one.
    tracked: Option<(String, Option<Isometry3<f64>>)>,
}

impl<'l> Mounts<'l> {
    pub(super) fn new(log: &'l Log, stated: ScannerFrames, odometry: Option<usize>) -> Self {
        Self {
            log,
            stated,
            tree: None,
            has_moving: false,
            frames: BTreeMap::new(),
            odometry,
            child: None,
            tracked: None,
        }
    }

    /// The mount of the scanner of a frame: as stated, or else by the transforms. In a log without transforms it is
    /// that of the robot's centre.
    pub(super) fn get(&mut self, frame: &str) -> Result<Result<Mount, String>, LogError> {
        if let Some(mount) = self.stated_mount() {
            return Ok(Ok(mount));
        }
        let frame = frame_name(frame);
        let pose = self.pose_of(&frame)?.map_err(|what| format!("{what}; {STATE_IT}"));
        Ok(pose.and_then(|pose| mount(&pose, &frame)))
    }

    /// The mount that a topics file states.
    pub(super) fn stated_mount(&self) -> Option<Mount> {
        let [x, y, yaw] = self.stated.mount?;
        let robot_from_scanner = Isometry2::new([x, y].into(), yaw);
        Some(Mount { robot_from_scanner, is_upside_down: false })
    }

    /// The pose of a frame in that of the robot. In a log without transforms it is that of the robot's centre.
    pub(super) fn pose_of(
        &mut self,
        frame: &str,
    ) -> Result<Result<Isometry3<f64>, String>, LogError> {
        if let Some(known) = self.frames.get(frame) {
            return Ok(known.clone());
        }
        let found = self.find(frame)?;
        if self.frames.len() < MOST_FRAMES {
            self.frames.insert(frame.to_owned(), found.clone());
        }
        Ok(found)
    }

    /// The odometry of the robot, from the pose of the frame that a message names.
    pub(super) fn odometry_of(
        &mut self,
        odom_from_child: &Isometry3<f64>,
        child: &str,
    ) -> Result<Odometry, LogError> {
        let child = frame_name(child);
        if self.tracked.as_ref().is_none_or(|(frame, _)| *frame != child) {
            // A frame that the tree does not have is the robot.
            let pose = self.in_whole_tree(&child)?.filter(|pose| *pose != Isometry3::identity());
            self.tracked = Some((child, pose));
        }
        Ok(match &self.tracked {
            Some((_, Some(base_from_child))) => {
                to_floor(&(odom_from_child * base_from_child.inverse()))
            }
            _ => to_floor(odom_from_child),
        })
    }

    /// The frame of which the odometry is, if it is another one than the robot's.
    pub(super) fn tracked_frame(&self) -> Option<&str> {
        let (frame, pose) = self.tracked.as_ref()?;
        pose.as_ref().map(|_| frame.as_str())
    }

    /// The odometry in a message of transforms, and its time; `None` if it does not relate the robot to `odom`.
    pub(super) fn odometry(
        &mut self,
        message: &Value<'_>,
    ) -> Result<Option<(Odometry, Option<Stamp>)>, LogError> {
        let mut found = None;
        for transform in transforms(message) {
            if is_called(&transform.parent, ODOM) {
                let is_robot = self.is_robot(&transform.child);
                if is_robot || found.is_none() && self.in_base(&transform.child)?.is_some() {
                    found = Some(transform);
                    if is_robot {
                        break;
                    }
                }
            }
        }
        let Some(FrameTransform { child, stamp, parent_from_child, .. }) = found else {
            return Ok(None);
        };
        Ok(Some((self.odometry_of(&parent_from_child, &child)?, stamp)))
    }

    fn is_robot(&self, frame: &str) -> bool {
        self.stated
            .base_frame
            .as_ref()
            .map_or_else(|| is_base(frame), |base| is_called(frame, base))
    }

    fn find(&mut self, frame: &str) -> Result<Result<Isometry3<f64>, String>, LogError> {
        Ok(match self.in_whole_tree(frame)? {
            Some(pose) => Ok(pose),
            None if self.tree.as_ref().is_none_or(|tree| !tree.has_transforms) => {
                Ok(Isometry3::identity())
            }
            None => {
                let base = self.stated.base_frame.as_ref().or(self.child.as_ref());
                let bases = base.map_or_else(|| BASES.join(", "), Clone::clone);
                Err(format!(
                    "its frame {frame:?} is not connected to the robot: no transform leads from it to {bases}"
                ))
            }
        })
    }

    /// The pose of a frame on the robot, also by transforms that may change if the static ones do not have it.
    fn in_whole_tree(&mut self, frame: &str) -> Result<Option<Isometry3<f64>>, LogError> {
        let found = self.in_base(frame)?;
        if found.is_some() || std::mem::replace(&mut self.has_moving, true) {
            return Ok(found);
        }
        if let Some(tree) = &mut self.tree {
            tree.read(self.log, false)?;
        }
        self.in_base(frame)
    }

    /// The pose of a frame on the robot, which is the nearest frame with the name of one, or else the frame of
    /// odometry.
    fn in_base(&mut self, frame: &str) -> Result<Option<Isometry3<f64>>, LogError> {
        if self.tree.is_none() {
            let mut tree = FrameTree::default();
            tree.read(self.log, true)?;
            self.tree = Some(tree);
            self.child = first_child(self.log, self.odometry)?;
        }
        let Some(tree) = &self.tree else { return Ok(None) };
        let named = tree.nearest(frame, |frame| self.is_robot(frame));
        let child = self.child.as_deref().filter(|_| self.stated.base_frame.is_none());
        Ok(named.or_else(|| tree.nearest(frame, |frame| Some(frame) == child)))
    }
}

/// The frame that the first message of odometry names: its child, or that of `odom` among transforms.
fn first_child(log: &Log, topic: Option<usize>) -> Result<Option<String>, LogError> {
    let Some((index, topic)) = topic.and_then(|at| Some((at, log.topics().get(at)?))) else {
        return Ok(None);
    };
    for message in log.read(&[index]) {
        let message = message?;
        let Some(Ok(value)) = topic.decode(&message.bytes) else { continue };
        if !is_transforms(&topic.short_type()) {
            let child: Option<String> = value.get("child_frame_id");
            return Ok(child.map(|child| frame_name(&child)).filter(|child| !child.is_empty()));
        }
        let mut all = transforms(&value).into_iter();
        if let Some(found) = all.find(|transform| is_odometry(&transform.parent)) {
            return Ok(Some(found.child));
        }
    }
    Ok(None)
}

fn mount(robot_from_scanner: &Isometry3<f64>, frame: &str) -> Result<Mount, String> {
    let up = (robot_from_scanner * Vector3::z()).z;
    if up.abs() < LEVEL {
        return Err(format!("its frame {frame:?} is not level"));
    }
    let position = robot_from_scanner.translation.vector.xy();
    let robot_from_scanner = Isometry2::new(position, heading(robot_from_scanner));
    Ok(Mount { robot_from_scanner, is_upside_down: up < 0.0 })
}

/// The frames of a robot: of each its neighbours, and their first poses in it. The frames in which the robot moves
/// are left out.
#[derive(Clone, Debug, Default)]
pub struct FrameTree {
    neighbours: BTreeMap<String, Vec<(String, Isometry3<f64>)>>,
    /// Whether there was any transform.
    has_transforms: bool,
}

impl FrameTree {
    /// Adds the transforms of a message of `tf2_msgs/TFMessage`.
    pub fn add_message(&mut self, message: &Value<'_>) {
        for transform in transforms(message) {
            self.add(transform);
        }
    }

    /// The mount of the scanner of a frame on the robot; `None` if no transforms lead from it to the robot.
    ///
    /// # Errors
    /// Returns an error if the scanner is not level.
    pub fn scanner_mount(&self, frame: &str) -> Result<Option<Mount>, String> {
        let frame = frame_name(frame);
        self.nearest(&frame, is_base).map(|pose| mount(&pose, &frame)).transpose()
    }

    /// Adds the transforms of a log that are static, or the others.
    fn read(&mut self, log: &Log, is_static: bool) -> Result<(), LogError> {
        let is_wanted = |topic: &Topic| {
            is_transforms(&topic.short_type()) && topic.name.ends_with("tf_static") == is_static
        };
        let topics = log.topics().iter().enumerate().filter(|(_, topic)| is_wanted(topic));
        let topics: Vec<_> = topics.map(|(index, _)| index).collect();
        for message in log.read(&topics) {
            let message = message?;
            let topic = log.topics().get(message.topic);
            let Some(Ok(value)) = topic.and_then(|topic| topic.decode(&message.bytes)) else {
                continue;
            };
            self.add_message(&value);
        }
        Ok(())
    }

    fn add(&mut self, FrameTransform { parent, child, parent_from_child, .. }: FrameTransform) {
        self.has_transforms = true;
        if is_floor(&parent) || is_floor(&child) {
            return;
        }
        let known = self.neighbours.entry(parent.clone()).or_default();
        if known.iter().any(|(frame, _)| *frame == child) {
            return;
        }
        known.push((child.clone(), parent_from_child));
        self.neighbours.entry(child).or_default().push((parent, parent_from_child.inverse()));
    }

    /// The pose of a frame in the nearest frame that is wanted.
    fn nearest(&self, frame: &str, is_wanted: impl Fn(&str) -> bool) -> Option<Isometry3<f64>> {
        let mut seen: Vec<(&str, Isometry3<f64>)> = vec![(frame, Isometry3::identity())];
        let mut next = 0;
        while let Some(&(here, here_from_frame)) = seen.get(next).filter(|_| next < MOST_FRAMES) {
            next += 1;
            if is_wanted(here) {
                return Some(here_from_frame);
            }
            for (neighbour, here_from_neighbour) in self.neighbours.get(here).into_iter().flatten()
            {
                if seen.iter().all(|(frame, _)| frame != neighbour) {
                    seen.push((neighbour, here_from_neighbour.inverse() * here_from_frame));
                }
            }
        }
        None
    }
}
