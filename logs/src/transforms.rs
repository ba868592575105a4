//! The frames of a robot, as `/tf` and `/tf_static` relate them: the pose of a scanner on its robot, and
//! odometry.
//!
//! The robot is `base_link`, `base_footprint` or `base`, and moves in the frame `odom` (REP 105). A slash
//! before a name is ignored, and so is a name of the robot before a slash.

use std::collections::BTreeMap;

use toposlam_model::driving::odometry::Odometry;
use toposlam_vision::laser::scan::ScannerPose;

use super::{
    container::{PlacedRecord, Record},
    error::LogError,
    messages::Stamp,
    reader::Log,
    standard::Quaternion,
    value::Value,
};

/// The type of the messages.
pub(super) const TYPE: &str = "tf2_msgs/TFMessage";
/// The type in older logs of ROS 1.
pub(super) const OLD_TYPE: &str = "tf/tfMessage";

/// Whether messages of a type are transforms.
pub(super) fn is_transforms(type_name: &str) -> bool {
    type_name == TYPE || type_name == OLD_TYPE
}

/// The frames of a robot's centre.
const BASES: [&str; 3] = ["base_link", "base_footprint", "base"];
/// The frame of odometry.
const ODOM: &str = "odom";
/// More frames than any robot has between its scanner and its centre.
const MOST_FRAMES: usize = 64;
/// A scanner is level if its axis leans by less than this, as a cosine: about 25 degrees.
const LEVEL: f64 = 0.9;

/// The pose of one frame in another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rigid {
    rotation: [[f64; 3]; 3],
    translation: [f64; 3],
}

impl Rigid {
    const IDENTITY: Self = Self {
        rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        translation: [0.0; 3],
    };

    /// A pose; `None` if a number is not finite, or the quaternion is no rotation.
    pub(super) fn new(
        translation: [f64; 3],
        Quaternion { x, y, z, w }: Quaternion,
    ) -> Option<Self> {
        let norm = (x * x + y * y + z * z + w * w).sqrt();
        let finite = translation.iter().all(|part| part.is_finite());
        if !finite || !norm.is_finite() || norm < 1e-3 {
            return None;
        }
        let [x, y, z, w] = [x, y, z, w].map(|part| part / norm);
        let rotation = [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
            [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
            [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
        ];
        Some(Self { rotation, translation })
    }

    pub(super) fn turned(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        self.rotation.map(|[a, b, c]| a * x + b * y + c * z)
    }

    /// The pose in the outer frame of something with a pose in this one.
    pub(super) fn then(&self, inner: &Self) -> Self {
        let [x, y, z] = self.turned(inner.translation);
        let [a, b, c] = self.translation;
        let columns = [0, 1, 2].map(|column| self.turned(inner.rotation.map(|row| row[column])));
        let rotation = [0, 1, 2].map(|row| columns.map(|column| column[row]));
        Self { rotation, translation: [a + x, b + y, c + z] }
    }

    /// The pose of a robot on the floor.
    pub(super) fn on_floor(Odometry { position: [x, y], heading }: &Odometry) -> Self {
        let (sine, cosine) = heading.sin_cos();
        let rotation = [[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]];
        Self { rotation, translation: [*x, *y, 0.0] }
    }

    /// Where its origin is.
    pub(super) fn translation(&self) -> [f64; 3] {
        self.translation
    }
}

/// One transform of a message.
pub(super) struct FrameTransform {
    pub(super) parent: String,
    pub(super) child: String,
    pub(super) stamp: Option<Stamp>,
    pub(super) pose: Rigid,
}

/// The transforms in a message, without those that are no rigid transforms.
pub(super) fn transforms(message: &Value<'_>) -> Vec<FrameTransform> {
    let one = |transform: &Value<'_>| {
        let number = |path: &str| transform.at(path)?.f64();
        let translation = [
            number("transform.translation.x")?,
            number("transform.translation.y")?,
            number("transform.translation.z")?,
        ];
        let rotation = Quaternion {
            x: number("transform.rotation.x")?,
            y: number("transform.rotation.y")?,
            z: number("transform.rotation.z")?,
            w: number("transform.rotation.w")?,
        };
        Some(FrameTransform {
            parent: frame_name(&transform.at("header.frame_id")?.text()?),
            child: frame_name(&transform.at("child_frame_id")?.text()?),
            stamp: transform.at("header.stamp").and_then(|stamp| stamp.stamp()),
            pose: Rigid::new(translation, rotation)?,
        })
    };
    let list = message.at("transforms").and_then(|list| list.elements()).unwrap_or_default();
    list.iter().filter_map(one).collect()
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
    let FrameTransform { pose, stamp, .. } =
        all.find(|transform| is_called(&transform.parent, ODOM) && is_base(&transform.child))?;
    let [x, y, _] = pose.translation;
    let [ahead_x, ahead_y, _] = pose.turned([1.0, 0.0, 0.0]);
    Some((Odometry { position: [x, y], heading: ahead_y.atan2(ahead_x) }, stamp))
}

/// How a scanner is mounted on its robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Mount {
    pub(super) pose: ScannerPose,
    /// Whether it is mounted upside down, so that its angles count clockwise from above.
    pub(super) is_upside_down: bool,
}

/// The mounts of the scanners in a log, by their frames.
pub(super) struct Mounts<'l> {
    log: &'l Log,
    known: BTreeMap<String, Result<Mount, String>>,
    /// The poses of frames in that of the robot.
    frames: BTreeMap<String, Result<Rigid, String>>,
}

impl<'l> Mounts<'l> {
    pub(super) fn new(log: &'l Log) -> Self {
        Self { log, known: BTreeMap::new(), frames: BTreeMap::new() }
    }

    /// The mount of the scanner of a frame. In a log without transforms it is that of the robot's centre.
    pub(super) fn of(&mut self, frame: &str) -> Result<Result<Mount, String>, LogError> {
        let frame = frame_name(frame);
        if let Some(known) = self.known.get(&frame) {
            return Ok(known.clone());
        }
        let found = self.pose_of(&frame)?.and_then(|pose| mount(&pose, &frame));
        if self.known.len() < MOST_FRAMES {
            self.known.insert(frame, found.clone());
        }
        Ok(found)
    }

    /// The pose of a frame in that of the robot. In a log without transforms it is that of the robot's centre.
    pub(super) fn pose_of(&mut self, frame: &str) -> Result<Result<Rigid, String>, LogError> {
        if let Some(known) = self.frames.get(frame) {
            return Ok(known.clone());
        }
        let found = self.find(frame)?;
        if self.frames.len() < MOST_FRAMES {
            self.frames.insert(frame.to_owned(), found.clone());
        }
        Ok(found)
    }

    fn find(&self, frame: &str) -> Result<Result<Rigid, String>, LogError> {
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
            None if tree.parents.is_empty() => Ok(Rigid::IDENTITY),
            None => Err(format!(
                "its frame {frame:?} is not connected to the robot: no transform leads from it to {}",
                BASES.join(", ")
            )),
        })
    }
}

fn mount(pose: &Rigid, frame: &str) -> Result<Mount, String> {
    let [_, _, up] = pose.turned([0.0, 0.0, 1.0]);
    if up.abs() < LEVEL {
        return Err(format!("its frame {frame:?} is not level"));
    }
    let [x, y, _] = pose.translation;
    let [ahead_x, ahead_y, _] = pose.turned([1.0, 0.0, 0.0]);
    let pose = ScannerPose { position: [x, y], heading: ahead_y.atan2(ahead_x) };
    Ok(Mount { pose, is_upside_down: up < 0.0 })
}

/// The frames of a log: of each its parent, and its first pose there.
#[derive(Default)]
struct Tree {
    parents: BTreeMap<String, (String, Rigid)>,
}

impl Tree {
    /// Adds the transforms on some topics until a frame is connected to the robot; whether it is.
    fn read(&mut self, log: &Log, topics: &[usize], frame: &str) -> Result<bool, LogError> {
        for (index, section) in log.sections.iter().enumerate() {
            let Some((_, file)) = log.section(index) else { continue };
            let topic_of = |id: u32| log.connections.get(&(section.file, id));
            let wanted = |id: u32| topic_of(id).is_some_and(|topic| topics.contains(topic));
            if !section.counts.iter().flatten().any(|(id, _)| wanted(*id)) {
                continue;
            }
            let bytes = section.load(file)?;
            for read in section.records(file, &bytes) {
                let PlacedRecord { at, record, .. } = read?;
                let Record::Message { connection, bytes: within, .. } = record else { continue };
                let topic = topic_of(connection).filter(|topic| topics.contains(topic));
                let Some(topic) = topic.and_then(|topic| log.topics().get(*topic)) else {
                    continue;
                };
                let message = bytes.get(at + within.start..at + within.end).unwrap_or_default();
                let Ok(message) = file.message(message.to_vec()) else { continue };
                let Some(Ok(value)) = topic.decode(&message) else { continue };
                for FrameTransform { parent, child, pose, .. } in transforms(&value) {
                    self.parents.entry(child).or_insert((parent, pose));
                }
                if self.in_base(frame).is_some() {
                    return Ok(true);
                }
            }
        }
        Ok(self.in_base(frame).is_some())
    }

    /// The pose of a frame in that of the robot.
    fn in_base(&self, frame: &str) -> Option<Rigid> {
        let mut pose = Rigid::IDENTITY;
        let mut here = frame;
        for _ in 0..MOST_FRAMES {
            if is_base(here) {
                return Some(pose);
            }
            let (parent, step) = self.parents.get(here)?;
            pose = step.then(&pose);
            here = parent;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::*;

    fn tree(transforms: &[(&str, &str, [f64; 3], Quaternion)]) -> Tree {
        let mut tree = Tree::default();
        for (parent, child, translation, rotation) in transforms {
            let pose = Rigid::new(*translation, *rotation).unwrap();
            tree.parents.insert((*child).to_owned(), ((*parent).to_owned(), pose));
        }
        tree
    }

    #[test]
    fn a_mount_is_the_product_of_the_transforms_up_to_the_robot() {
        let tree = tree(&[
            ("odom", "base_link", [9.0, 9.0, 0.0], Quaternion::turn(1.0)),
            ("base_link", "plate", [0.5, 0.0, 0.2], Quaternion::turn(FRAC_PI_2)),
            ("plate", "laser", [0.1, 0.0, 0.1], Quaternion::turn(FRAC_PI_2)),
        ]);
        let found = mount(&tree.in_base("laser").unwrap(), "laser").unwrap();
        let ScannerPose { position: [x, y], heading } = found.pose;
        assert!((x - 0.5).abs() < 1e-12 && (y - 0.1).abs() < 1e-12, "{found:?}");
        assert!((heading.abs() - PI).abs() < 1e-12 && !found.is_upside_down, "{found:?}");
        assert_eq!(tree.in_base("camera"), None);
    }

    #[test]
    fn a_scanner_may_hang_upside_down_but_not_on_its_side() {
        let half = 0.5_f64.sqrt();
        let over = Quaternion { x: 1.0, y: 0.0, z: 0.0, w: 0.0 };
        let side = Quaternion { x: half, y: 0.0, z: 0.0, w: half };
        let tree = tree(&[("base", "over", [0.0; 3], over), ("base", "side", [0.0; 3], side)]);
        let over = mount(&tree.in_base("over").unwrap(), "over").unwrap();
        assert!(over.is_upside_down && over.pose.heading.abs() < 1e-12);
        let side = mount(&tree.in_base("side").unwrap(), "side");
        assert_eq!(side.unwrap_err(), "its frame \"side\" is not level");
    }

    #[test]
    fn frames_in_a_circle_are_not_connected() {
        let turn = Quaternion::turn(0.0);
        let tree = tree(&[("a", "b", [0.0; 3], turn), ("b", "a", [0.0; 3], turn)]);
        assert_eq!(tree.in_base("a"), None);
    }
}
