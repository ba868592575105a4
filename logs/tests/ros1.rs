//! Logs in the serialization of ROS 1, which needs no padding.

use std::collections::BTreeMap;

use super::written::{add_message, mcap, without_index};

/// A topic: its name, the type, definition and bodies of its messages, one a second.
pub(crate) type Topic = (&'static str, &'static str, String, Vec<Vec<u8>>);

pub(crate) const HEADER: &str =
    "===\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n";
pub(crate) const VECTOR3: &str =
    "===\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n";
pub(crate) const QUATERNION: &str =
    "===\nMSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n";
const POSE: &str = "===\nMSG: geometry_msgs/Pose\nPoint position\nQuaternion orientation\n\
    ===\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n";

/// A definition of fields with a header and a pose.
pub(crate) fn posed(fields: &str) -> String {
    [fields, HEADER, POSE, QUATERNION].concat()
}

pub(crate) const LEVEL: [f64; 4] = [0.0, 0.0, 0.0, 1.0];
pub(crate) const LEFT: [f64; 4] =
    [0.0, 0.0, std::f64::consts::FRAC_1_SQRT_2, std::f64::consts::FRAC_1_SQRT_2];

/// It is compressed, because definitions are long.
pub(crate) fn log_of(topics: &[Topic]) -> Vec<u8> {
    mcap(without_index(), |writer| {
        for (name, type_name, definition, messages) in topics {
            let schema = writer.add_schema(type_name, "ros1msg", definition.as_bytes()).unwrap();
            let channel = writer.add_channel(schema, name, "ros1", &BTreeMap::new()).unwrap();
            for (message, second) in messages.iter().zip(1..) {
                add_message(writer, channel, 1_000_000_000 * second, message);
            }
        }
    })
}

pub(crate) fn text(text: &str) -> Vec<u8> {
    [&(text.len() as u32).to_le_bytes(), text.as_bytes()].concat()
}

pub(crate) fn numbers<const MANY: usize>(numbers: [f64; MANY]) -> Vec<u8> {
    numbers.map(f64::to_le_bytes).concat()
}

pub(crate) fn whole<const MANY: usize>(numbers: [u32; MANY]) -> Vec<u8> {
    numbers.map(u32::to_le_bytes).concat()
}

pub(crate) fn header(sec: u32, frame: &str) -> Vec<u8> {
    [whole([0, sec, 5]), text(frame)].concat()
}

pub(crate) fn pose([x, y, z]: [f64; 3], [qx, qy, qz, qw]: [f64; 4]) -> Vec<u8> {
    numbers([x, y, z, qx, qy, qz, qw])
}

/// Odometry of a robot at (1, 2) that looks along y.
pub(crate) fn odometry() -> Topic {
    let definition = posed(
        "Header header\nPoseWithCovariance pose\n===\nMSG: geometry_msgs/PoseWithCovariance\nPose pose\n",
    );
    let message = [header(8, "odom"), pose([1.0, 2.0, 0.0], LEFT)].concat();
    ("/odom", "nav_msgs/Odometry", definition, vec![message])
}

/// Parent, child, translation and quaternion of each.
pub(crate) type Transform<'t> = (&'t str, &'t str, [f64; 3], [f64; 4]);

pub(crate) fn transforms(name: &'static str, all: &[Transform]) -> Topic {
    let definition = "TransformStamped[] transforms\n===\nMSG: geometry_msgs/TransformStamped\n\
        Header header\nstring child_frame_id\nTransform transform\n===\nMSG: geometry_msgs/Transform\n\
        Vector3 translation\nQuaternion rotation\n";
    let mut message = whole([all.len() as u32]);
    for (parent, child, translation, rotation) in all {
        message.extend([header(9, parent), text(child), pose(*translation, *rotation)].concat());
    }
    let definition = [definition, HEADER, VECTOR3, QUATERNION].concat();
    (name, "tf2_msgs/TFMessage", definition, vec![message])
}
