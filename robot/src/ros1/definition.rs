//! Message types as ROS 1 names and defines them, made from their definitions in ROS 2 (`logs/msgs`).
//!
//! In ROS 1 a type has no `/msg` in its name, a time is built in, a header begins with a sequence number, and
//! a field has no default.

use std::fmt::Write;

use toposlam_logs::message::{Message, TIME, TypeDefinition, used_types};

/// The type that begins with a sequence number in ROS 1.
const HEADER: &str = "std_msgs/Header";

/// The name of a type, `PACKAGE/TYPE`.
pub(super) fn type_name<M: Message>() -> String {
    M::TYPE.replacen("/msg/", "/", 1)
}

/// The definition of a type, followed by those of the types that it uses.
pub(super) fn definition<M: Message>() -> String {
    let mut text = fields(M::DEFINITION);
    for TypeDefinition { name, text: used } in used_types(M::DEFINITION) {
        if name == TIME.name {
            continue;
        }
        let number = if name == HEADER { "uint32 seq\n" } else { "" };
        // Writing to a string cannot fail.
        let _ = write!(text, "{:=<80}\nMSG: {name}\n{number}{}", "", fields(used));
    }
    text
}

/// The fields of a definition, one a line.
fn fields(definition: &str) -> String {
    let field = |line: &str| {
        let mut words = line.split_whitespace();
        let kind = words.next().filter(|kind| !kind.starts_with('#'))?;
        let kind = if kind == TIME.name { "time" } else { kind };
        Some(format!("{kind} {}\n", words.next()?))
    };
    definition.lines().filter_map(field).collect()
}

#[cfg(test)]
mod tests {
    use roslibrust::md5sum::from_message_definition;
    use toposlam_logs::standard::{
        CompressedImage, FileBytes, LaserScanMessage, OdometryMessage, PoseStamped, TFMessage,
        Twist,
    };

    use super::*;

    /// Nodes compare these checksums to check that their types agree. ROS computes the same values.
    fn checksum<M: Message>(name: &str, sum: &str) {
        assert_eq!(type_name::<M>(), name);
        assert_eq!(from_message_definition(name, &definition::<M>()).unwrap(), sum, "{name}");
    }

    #[test]
    fn the_types_are_those_of_ros() {
        checksum::<Twist>("geometry_msgs/Twist", "9f195f881246fdfa2798d1d3eebca84a");
        checksum::<OdometryMessage>("nav_msgs/Odometry", "cd5e73d190d741a2f92e81eda573aca7");
        checksum::<CompressedImage<FileBytes>>(
            "sensor_msgs/CompressedImage",
            "8f7a12909da2c9d3332d540a0977563f",
        );
        checksum::<TFMessage>("tf2_msgs/TFMessage", "94810edda583a504dfda3829e70d7eec");
        checksum::<LaserScanMessage<&[f32]>>(
            "sensor_msgs/LaserScan",
            "90c7ef2dc6895d81024acba2ac42f369",
        );
        checksum::<PoseStamped>("geometry_msgs/PoseStamped", "d3812c3cbc69362b77dc0b19b345f8f5");
    }
}
