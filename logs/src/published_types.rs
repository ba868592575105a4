//! The definitions of published types, for logs that do not define their messages: databases of rosbag2
//! before ROS 2 Iron.

use std::fmt::Write;

use super::{
    definition::short_name,
    message::{TIME, TypeDefinition, definition},
    messages::{Command, Door, End, Hypothesis, Map, Percept, ProjectMessage, Run, Scene},
};

/// The types that carry a role, those that they use, and whole numbers.
const PUBLISHED: &[TypeDefinition] = &[
    TIME,
    definition!("geometry_msgs", "Point"),
    definition!("geometry_msgs", "Pose"),
    definition!("geometry_msgs", "Pose2D"),
    definition!("geometry_msgs", "PoseStamped"),
    definition!("geometry_msgs", "PoseWithCovariance"),
    definition!("geometry_msgs", "PoseWithCovarianceStamped"),
    definition!("geometry_msgs", "Quaternion"),
    definition!("geometry_msgs", "Transform"),
    definition!("geometry_msgs", "TransformStamped"),
    definition!("geometry_msgs", "Twist"),
    definition!("geometry_msgs", "TwistStamped"),
    definition!("geometry_msgs", "TwistWithCovariance"),
    definition!("geometry_msgs", "Vector3"),
    definition!("nav_msgs", "Odometry"),
    definition!("sensor_msgs", "CompressedImage"),
    definition!("sensor_msgs", "Image"),
    definition!("sensor_msgs", "LaserScan"),
    definition!("std_msgs", "Header"),
    definition!("std_msgs", "Int8"),
    definition!("std_msgs", "Int16"),
    definition!("std_msgs", "Int32"),
    definition!("std_msgs", "Int64"),
    definition!("std_msgs", "UInt8"),
    definition!("std_msgs", "UInt16"),
    definition!("std_msgs", "UInt32"),
    definition!("std_msgs", "UInt64"),
    definition!("tf2_msgs", "TFMessage"),
];

/// The types of the project, with their definitions.
const OWN: [(&str, &str); 8] = [
    (Command::TYPE, Command::DEFINITION),
    (Door::TYPE, Door::DEFINITION),
    (End::TYPE, End::DEFINITION),
    (Hypothesis::TYPE, Hypothesis::DEFINITION),
    (Map::TYPE, Map::DEFINITION),
    (Percept::TYPE, Percept::DEFINITION),
    (Run::TYPE, Run::DEFINITION),
    (Scene::TYPE, Scene::DEFINITION),
];

/// The text that defines a type and those that it uses, in the encoding `ros2msg`; `None` if the type is
/// not known.
pub(super) fn definition(type_name: &str) -> Option<String> {
    let name = short_name(type_name);
    let own = OWN.iter().find(|(own, _)| short_name(own) == name);
    let mut text = own.map(|(_, text)| *text).or_else(|| published(&name))?.to_owned();
    let mut used = vec![name.clone()];
    add_used(&text.clone(), &mut used, &mut text);
    Some(text)
}

fn published(name: &str) -> Option<&'static str> {
    PUBLISHED.iter().find(|published| published.name == name).map(|published| published.text)
}

/// Appends the definitions of the types in a definition.
fn add_used(definition: &str, used: &mut Vec<String>, text: &mut String) {
    for line in definition.lines() {
        let name = line.split([' ', '[']).next().unwrap_or_default();
        let Some(inner) = published(name).filter(|_| !used.iter().any(|known| known == name))
        else {
            continue;
        };
        used.push(name.to_owned());
        // Writing to a string cannot fail.
        let _ = write!(text, "{:=<80}\nMSG: {name}\n{inner}", "");
        add_used(inner, used, text);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::definition::{Definition, Dialect};

    #[test]
    fn every_published_type_is_defined_with_those_that_it_uses() {
        let own = OWN.iter().map(|(name, _)| *name);
        for name in PUBLISHED.iter().map(|published| published.name).chain(own) {
            let text = definition(name).unwrap();
            Definition::read(Dialect::Ros2, name, &text).unwrap();
        }
        assert_eq!(definition("lab_msgs/msg/Junction"), None);
        let scan = definition("sensor_msgs/msg/LaserScan").unwrap();
        assert_eq!(scan.matches("MSG: builtin_interfaces/Time").count(), 1);
    }
}
