//! What a topic can carry, of which parts that is, in which units, and where it stands in messages of
//! the usual types.

use crate::{
    container::EVENT,
    transforms::{OLD_TYPE as OLD_TRANSFORMS, TYPE as TRANSFORMS},
};

/// Tags of the project AprilTag; their poses are transforms.
pub(crate) const APRIL_TAGS: &str = "apriltag_msgs/AprilTagDetectionArray";
pub(crate) const DETECTIONS: &str = "vision_msgs/Detection3DArray";
pub(crate) const POSE: &str = "geometry_msgs/PoseStamped";
pub(crate) const POSE_WITH_COVARIANCE: &str = "geometry_msgs/PoseWithCovarianceStamped";
const CARMEN_FRONT: &str = "carmen/FLASER";
const CARMEN_REAR: &str = "carmen/RLASER";
const CARMEN_ROBOT: &str = "carmen/ROBOTLASER1";
const CARMEN_ROBOT_REAR: &str = "carmen/ROBOTLASER2";
const CARMEN_ODOM: &str = "carmen/ODOM";
const CARMEN_SHORT_ODOM: &str = "carmen/SHORT_ODOM";
const CARMEN_READING: &str = "carmen/LASER_READING";
const CARMEN_RAW: &str = "carmen/RAWLASER1";
const CARMEN_RAW_REAR: &str = "carmen/RAWLASER2";

toposlam_model::words! {
    Role {
        Image = "image",
        Scan = "scan",
        Odometry = "odometry",
        Motion = "motion",
        Percept = "percept",
        Door = "door",
        Action = "action",
        Run = "run",
        Scene = "scene",
        Command = "command",
        Hypothesis = "hypothesis",
        Map = "map",
        End = "end",
        Marker = "marker",
    }

    MessagePart {
        X = "x",
        Y = "y",
        /// The direction in which it looks, counter-clockwise.
        Heading = "heading",
        Quaternion = "quaternion",
        Forward = "forward",
        /// The speed of turning, counter-clockwise.
        Turn = "turn",
        Degree = "degree",
        /// The door along which the marker points; -1: no marker.
        Marker = "marker",
        Door = "door",
        Move = "move",
    }

    #[derive(Default)]
    LengthUnit {
        #[default]
        Metres = "metres",
        Inches = "inches",
    }

    #[derive(Default)]
    AngleUnit {
        #[default]
        Radians = "radians",
        Degrees = "degrees",
    }
}

impl LengthUnit {
    pub fn in_metres(self) -> f64 {
        match self {
            Self::Metres => 1.0,
            Self::Inches => 0.0254,
        }
    }
}

impl AngleUnit {
    pub fn in_radians(self) -> f64 {
        match self {
            Self::Radians => 1.0,
            Self::Degrees => 1_f64.to_radians(),
        }
    }
}

impl Role {
    /// Whether sensors publish it again and again, so that one message more or less does not matter.
    pub(crate) fn is_sensor(self) -> bool {
        matches!(self, Self::Image | Self::Scan | Self::Odometry | Self::Motion)
    }

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

    /// Where its parts stand in messages of a type; nothing for a type that is read as a whole, as those of the project.
    pub(super) fn usual(self, type_name: &str) -> Option<&'static [(MessagePart, &'static str)]> {
        Some(match (self, type_name) {
            (Self::Percept, "toposlam_msgs/Percept")
            | (Self::Door, "toposlam_msgs/Door")
            | (Self::Action, "toposlam_msgs/Action")
            | (Self::Run, "toposlam_msgs/Run")
            | (Self::Scene, "toposlam_msgs/Scene")
            | (Self::Command, "toposlam_msgs/Command")
            | (Self::Hypothesis, "toposlam_msgs/Hypothesis")
            | (Self::Map, "toposlam_msgs/Map")
            | (Self::End, "toposlam_msgs/End")
            | (Self::Image, "sensor_msgs/CompressedImage" | "sensor_msgs/Image")
            | (Self::Scan, "sensor_msgs/LaserScan" | CARMEN_RAW | CARMEN_RAW_REAR)
            | (
                Self::Scan | Self::Odometry,
                CARMEN_FRONT | CARMEN_REAR | CARMEN_ROBOT | CARMEN_ROBOT_REAR | CARMEN_READING,
            )
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
            (
                Self::Odometry,
                "geometry_msgs/Pose2D" | "turtlesim/Pose" | CARMEN_ODOM | CARMEN_SHORT_ODOM,
            ) => &[(MessagePart::X, "x"), (MessagePart::Y, "y"), (MessagePart::Heading, "theta")],
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
            (Self::Odometry, "nav_msgs/Odometry" | CARMEN_ODOM | CARMEN_SHORT_ODOM)
            | (Self::Scan, "sensor_msgs/LaserScan" | CARMEN_ROBOT) => 0,
            (Self::Scan, CARMEN_ROBOT_REAR | CARMEN_RAW_REAR) => 3,
            (Self::Odometry, TRANSFORMS | OLD_TRANSFORMS) | (_, CARMEN_REAR | CARMEN_RAW) => 2,
            (Self::Odometry | Self::Scan, _) => 1,
            _ => 0,
        }
    }
}
