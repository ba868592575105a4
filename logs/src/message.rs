//! Messages of ROS 2: a type name, and the definitions that a reader needs.

use std::fmt::Write;

use serde::Serialize;

/// A message that a log can hold.
pub trait Message: Serialize {
    const TYPE: &'static str;
    /// Its definition, without those of the types that it uses.
    const DEFINITION: &'static str;
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TypeDefinition {
    /// Its name, as definitions refer to it: `PACKAGE/TYPE`.
    pub name: &'static str,
    pub text: &'static str,
}

macro_rules! definition {
    ($package:literal, $name:literal) => {
        TypeDefinition {
            name: concat!($package, "/", $name),
            text: include_str!(concat!("../msgs/", $package, "/msg/", $name, ".msg")),
        }
    };
}

pub const TIME: TypeDefinition = definition!("builtin_interfaces", "Time");

macro_rules! published {
    ($($package:literal => $($name:literal),*;)*) => { [$($(definition!($package, $name),)*)*] };
}

/// The types that carry a role, those that they use, and whole numbers.
const PUBLISHED: &[TypeDefinition] = &published! {
    "builtin_interfaces" => "Time";
    "geometry_msgs" => "Point", "Pose", "Pose2D", "PoseStamped", "PoseWithCovariance",
        "PoseWithCovarianceStamped", "Quaternion", "Transform", "TransformStamped", "Twist",
        "TwistStamped", "TwistWithCovariance", "Vector3";
    "nav_msgs" => "Odometry";
    "sensor_msgs" => "CompressedImage", "Image", "LaserScan";
    "std_msgs" => "Header", "Int8", "Int16", "Int32", "Int64", "UInt8", "UInt16", "UInt32", "UInt64";
    "tf2_msgs" => "TFMessage";
};

fn published(name: &str) -> Option<TypeDefinition> {
    PUBLISHED.iter().find(|published| published.name == name).copied()
}

/// The types that a definition uses, and those that they use, in the order in which they are met.
pub fn used_types(definition: &str) -> Vec<TypeDefinition> {
    let mut used = Vec::new();
    add_used(definition, &mut used);
    used
}

fn add_used(definition: &str, used: &mut Vec<TypeDefinition>) {
    for line in definition.lines() {
        let name = line.split([' ', '[']).next().unwrap_or_default();
        if let Some(inner) = published(name).filter(|inner| !used.contains(inner)) {
            used.push(inner);
            add_used(inner.text, used);
        }
    }
}

/// A schema in MCAP's encoding `ros2msg`: a definition, and those of the types that it uses.
pub fn schema(definition: &str) -> String {
    let mut text = definition.to_owned();
    for TypeDefinition { name, text: used } in used_types(definition) {
        // Writing to a string cannot fail.
        let _ = write!(text, "{:=<80}\nMSG: {name}\n{used}", "");
    }
    text
}

/// The schema of a published type or one of the project, for logs that do not define their messages: databases of
/// rosbag2 before ROS 2 Iron.
#[cfg(feature = "sqlite")]
pub(super) fn published_schema(type_name: &str) -> Option<String> {
    use super::{definition::short_name, messages::OWN};
    let name = short_name(type_name);
    let own = OWN.iter().find(|(own, _)| short_name(own) == name);
    let text = own.map(|(_, text)| *text).or_else(|| Some(published(&name)?.text));
    text.map(schema)
}

#[cfg(all(test, feature = "sqlite"))]
mod tests {
    use super::*;
    use crate::{
        definition::{Definition, Dialect},
        messages::OWN,
    };

    #[test]
    fn every_type_is_defined_with_those_that_it_uses() {
        let own = OWN.iter().map(|(name, _)| *name);
        for name in PUBLISHED.iter().map(|published| published.name).chain(own) {
            let text = published_schema(name).unwrap();
            Definition::read(Dialect::Ros2, name, &text).unwrap();
        }
        assert_eq!(published_schema("lab_msgs/msg/Junction"), None);
        let scan = published_schema("sensor_msgs/msg/LaserScan").unwrap();
        assert_eq!(scan.matches("MSG: builtin_interfaces/Time").count(), 1);
    }
}
