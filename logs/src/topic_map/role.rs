//! What a topic can carry, of which parts that is, in which units, and where it stands in messages of
//! the usual types.

use crate::{
    container::EVENT,
    transforms::{OLD_TYPE as OLD_TRANSFORMS, TYPE as TRANSFORMS},
};

/// Tags of the project AprilTag; their poses are transforms.
pub(crate) const APRIL_TAGS: &str = "apriltag_msgs/AprilTagDetectionArray";
/// Detections of objects, with poses.
pub(crate) const DETECTIONS: &str = "vision_msgs/Detection3DArray";
/// One pose.
pub(crate) const POSE: &str = "geometry_msgs/PoseStamped";
/// One pose.
pub(crate) const POSE_WITH_COVARIANCE: &str = "geometry_msgs/PoseWithCovarianceStamped";
const CARMEN_FRONT: &str = "carmen/FLASER";
const CARMEN_REAR: &str = "carmen/RLASER";
const CARMEN_ROBOT: &str = "carmen/ROBOTLASER1";

/// The role of a topic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Role {
    /// Images of the robot's camera.
    Image,
    /// Scans of the robot's laser scanner.
    Scan,
    /// Odometry.
    Odometry,
    /// Commands to the wheels.
    Motion,
    /// Percepts.
    Percept,
    /// The door that it takes.
    Door,
    /// The head of a log of the project.
    Run,
    /// Scenes.
    Scene,
    /// Commands of Algorithm 2.
    Command,
    /// A step of Algorithm 1.
    Hypothesis,
    /// The map.
    Map,
    /// The end of a log of the project.
    End,
    /// Sightings of the marker, which is a fiducial.
    Marker,
}

/// A part of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum MessagePart {
    /// To the front of where the robot began.
    X,
    /// To the left.
    Y,
    /// The direction in which it looks, counter-clockwise.
    Heading,
    /// The same, as a quaternion with x, y, z and w.
    Quaternion,
    /// The speed straight ahead.
    Forward,
    /// The speed of turning, counter-clockwise.
    Turn,
    /// The number of doors.
    Degree,
    /// The door along which the marker points; -1: no marker.
    Marker,
    /// A door.
    Door,
    /// How many moves were made, or which it is.
    Move,
}

/// A unit of length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LengthUnit {
    /// Metres.
    Metres,
    /// Inches of 25.4 mm.
    Inches,
}

/// A unit of angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AngleUnit {
    /// Radians.
    Radians,
    /// Degrees.
    Degrees,
}

impl LengthUnit {
    /// As mapping files call it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Metres => "metres",
            Self::Inches => "inches",
        }
    }

    /// How many metres it is.
    #[must_use]
    pub fn in_metres(self) -> f64 {
        match self {
            Self::Metres => 1.0,
            Self::Inches => 0.0254,
        }
    }
}

impl AngleUnit {
    /// As mapping files call it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Radians => "radians",
            Self::Degrees => "degrees",
        }
    }

    /// How many radians it is.
    #[must_use]
    pub fn in_radians(self) -> f64 {
        match self {
            Self::Radians => 1.0,
            Self::Degrees => 1_f64.to_radians(),
        }
    }
}

impl MessagePart {
    /// As mapping files call it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::X => "x",
            Self::Y => "y",
            Self::Heading => "heading",
            Self::Quaternion => "quaternion",
            Self::Forward => "forward",
            Self::Turn => "turn",
            Self::Degree => "degree",
            Self::Marker => "marker",
            Self::Door => "door",
            Self::Move => "move",
        }
    }
}

impl Role {
    /// All of them.
    pub const ALL: [Self; 13] = [
        Self::Image,
        Self::Scan,
        Self::Odometry,
        Self::Motion,
        Self::Percept,
        Self::Door,
        Self::Run,
        Self::Scene,
        Self::Command,
        Self::Hypothesis,
        Self::Map,
        Self::End,
        Self::Marker,
    ];

    /// As mapping files call it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Image => "image",
            Self::Scan => "scan",
            Self::Odometry => "odometry",
            Self::Motion => "motion",
            Self::Percept => "percept",
            Self::Door => "door",
            Self::Run => "run",
            Self::Scene => "scene",
            Self::Command => "command",
            Self::Hypothesis => "hypothesis",
            Self::Map => "map",
            Self::End => "end",
            Self::Marker => "marker",
        }
    }

    /// Its parts.
    pub(super) fn parts(self) -> &'static [MessagePart] {
        match self {
            Self::Odometry => {
                &[MessagePart::X, MessagePart::Y, MessagePart::Heading, MessagePart::Quaternion]
            }
            Self::Motion => &[MessagePart::Forward, MessagePart::Turn],
            Self::Percept => &[MessagePart::Move, MessagePart::Degree, MessagePart::Marker],
            Self::Door => &[MessagePart::Move, MessagePart::Door],
            _ => &[],
        }
    }

    /// The type of the project's own messages of it, if they have one.
    pub(super) fn own(self) -> Option<&'static str> {
        match self {
            Self::Percept => Some("toposlam_msgs/Percept"),
            Self::Door => Some("toposlam_msgs/Door"),
            Self::Run => Some("toposlam_msgs/Run"),
            Self::Scene => Some("toposlam_msgs/Scene"),
            Self::Command => Some("toposlam_msgs/Command"),
            Self::Hypothesis => Some("toposlam_msgs/Hypothesis"),
            Self::Map => Some("toposlam_msgs/Map"),
            Self::End => Some("toposlam_msgs/End"),
            Self::Image | Self::Scan | Self::Odometry | Self::Motion | Self::Marker => None,
        }
    }

    /// The paths of its parts in messages of a usual type.
    pub(super) fn usual(self, type_name: &str) -> Option<&'static [(MessagePart, &'static str)]> {
        if self.own() == Some(type_name) {
            return Some(&[]);
        }
        Some(match (self, type_name) {
            (Self::Image, "sensor_msgs/CompressedImage" | "sensor_msgs/Image")
            | (Self::Scan, "sensor_msgs/LaserScan")
            | (Self::Scan | Self::Odometry, CARMEN_FRONT | CARMEN_REAR | CARMEN_ROBOT)
            | (Self::Odometry, TRANSFORMS | OLD_TRANSFORMS)
            | (Self::Percept | Self::Door, EVENT)
            | (Self::Marker, APRIL_TAGS | DETECTIONS | POSE | POSE_WITH_COVARIANCE) => &[],
            (Self::Odometry, "nav_msgs/Odometry" | POSE_WITH_COVARIANCE) => &[
                (MessagePart::X, "pose.pose.position.x"),
                (MessagePart::Y, "pose.pose.position.y"),
                (MessagePart::Quaternion, "pose.pose.orientation"),
            ],
            (Self::Odometry, POSE) => &[
                (MessagePart::X, "pose.position.x"),
                (MessagePart::Y, "pose.position.y"),
                (MessagePart::Quaternion, "pose.orientation"),
            ],
            (Self::Odometry, "geometry_msgs/Pose2D" | "turtlesim/Pose" | "carmen/ODOM") => {
                &[(MessagePart::X, "x"), (MessagePart::Y, "y"), (MessagePart::Heading, "theta")]
            }
            (Self::Motion, "geometry_msgs/Twist") => {
                &[(MessagePart::Forward, "linear.x"), (MessagePart::Turn, "angular.z")]
            }
            (Self::Motion, "geometry_msgs/TwistStamped") => {
                &[(MessagePart::Forward, "twist.linear.x"), (MessagePart::Turn, "twist.angular.z")]
            }
            _ => return None,
        })
    }

    /// How well messages of a usual type carry it: a topic of a lower rank is preferred.
    pub(super) fn rank(self, type_name: &str) -> u32 {
        match (self, type_name) {
            (Self::Odometry, "nav_msgs/Odometry" | "carmen/ODOM")
            | (Self::Scan, "sensor_msgs/LaserScan" | CARMEN_ROBOT) => 0,
            (Self::Odometry, TRANSFORMS | OLD_TRANSFORMS) | (_, CARMEN_REAR) => 2,
            (Self::Odometry | Self::Scan, _) => 1,
            _ => 0,
        }
    }
}
