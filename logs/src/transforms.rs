//! The frames of a robot, as `/tf` and `/tf_static` relate them: the pose of a scanner on its robot, and
//! odometry.
//!
//! The robot is `base_link`, `base_footprint` or `base`, and moves in the frame `odom` (REP 105). A slash
//! before a name is ignored, and so is a name of the robot before a slash.

use std::collections::BTreeMap;

use nalgebra::{Isometry2, Isometry3, UnitQuaternion, Vector3};
use toposlam_model::driving::odometry::Odometry;
use toposlam_vision::geometry::angle;

use super::{error::LogError, messages::Stamp, reader::Log, standard::Quaternion, value::Value};

pub(super) const TYPE: &str = "tf2_msgs/TFMessage";
pub(super) const OLD_TYPE: &str = "tf/tfMessage";

pub(super) fn is_transforms(type_name: &str) -> bool {
    type_name == TYPE || type_name == OLD_TYPE
}

const BASES: [&str; 3] = ["base_link", "base_footprint", "base"];
const ODOM: &str = "odom";
/// More frames than any robot has between its scanner and its centre.
const MOST_FRAMES: usize = 64;
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

/// The odometry in a message, and its time; `None` if it does not relate the robot to `odom`.
pub(super) fn odometry(message: &Value<'_>) -> Option<(Odometry, Option<Stamp>)> {
    let mut all = transforms(message).into_iter();
    let FrameTransform { parent_from_child: odom_from_robot, stamp, .. } =
        all.find(|transform| is_called(&transform.parent, ODOM) && is_base(&transform.child))?;
    let position = odom_from_robot.translation.vector.xy().into();
    Some((Odometry { position, heading: heading(&odom_from_robot) }, stamp))
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Mount {
    pub(super) robot_from_scanner: Isometry2<f64>,
    /// Whether it is mounted upside down, so that its angles count clockwise from above.
    pub(super) is_upside_down: bool,
}

/// The mounts of the scanners in a log, by their frames.
pub(super) struct Mounts<'l> {
    log: &'l Log,
    frames: BTreeMap<String, Result<Isometry3<f64>, String>>,
}

impl<'l> Mounts<'l> {
    pub(super) fn new(log: &'l Log) -> Self {
        Self { log, frames: BTreeMap::new() }
    }

    /// The mount of the scanner of a frame. In a log without transforms it is that of the robot's centre.
    pub(super) fn get(&mut self, frame: &str) -> Result<Result<Mount, String>, LogError> {
        let frame = frame_name(frame);
        Ok(self.pose_of(&frame)?.and_then(|pose| mount(&pose, &frame)))
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

    fn find(&self, frame: &str) -> Result<Result<Isometry3<f64>, String>, LogError> {
        let mut tree = Tree::default();
        let is_static = |name: &str| name.ends_with("tf_static");
        for wanted in [true, false] {
            let topics = self.log.topics().iter().enumerate().filter(|(_, topic)| {
                let kind = topic.short_type();
                is_transforms(&kind) && is_static(&topic.name) == wanted
            });
            let topics: Vec<_> = topics.map(|(index, _)| index).collect();
            if tree.read(self.log, &topics, frame)? {
                break;
            }
        }
        Ok(match tree.in_base(frame) {
            Some(pose) => Ok(pose),
            None if tree.parents.is_empty() => Ok(Isometry3::identity()),
            None => Err(format!(
                "its frame {frame:?} is not connected to the robot: no transform leads from it to {}",
                BASES.join(", ")
            )),
        })
    }
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

/// The frames of a log: of each its parent, and its first pose there.
#[derive(Default)]
struct Tree {
    parents: BTreeMap<String, (String, Isometry3<f64>)>,
}

impl Tree {
    /// Adds the transforms on some topics until a frame is connected to the robot; whether it is.
    fn read(&mut self, log: &Log, topics: &[usize], frame: &str) -> Result<bool, LogError> {
        for message in log.read(topics) {
            let message = message?;
            let topic = log.topics().get(message.topic);
            let Some(Ok(value)) = topic.and_then(|topic| topic.decode(&message.bytes)) else {
                continue;
            };
            for FrameTransform { parent, child, parent_from_child, .. } in transforms(&value) {
                self.parents.entry(child).or_insert((parent, parent_from_child));
            }
            if self.in_base(frame).is_some() {
                return Ok(true);
            }
        }
        Ok(self.in_base(frame).is_some())
    }

    fn in_base(&self, frame: &str) -> Option<Isometry3<f64>> {
        let mut pose = Isometry3::identity();
        let mut here = frame;
        for _ in 0..MOST_FRAMES {
            if is_base(here) {
                return Some(pose);
            }
            let (parent, step) = self.parents.get(here)?;
            pose = step * pose;
            here = parent;
        }
        None
    }
}
