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
pub(super) const PUBLISHED: &[TypeDefinition] = &published! {
    "builtin_interfaces" => "Time";
    "geometry_msgs" => "Point", "Pose", "Pose2D", "PoseStamped", "PoseWithCovariance",
        "PoseWithCovarianceStamped", "Quaternion", "Transform", "TransformStamped", "Twist",
        "TwistStamped", "TwistWithCovariance", "Vector3";
    "nav_msgs" => "Odometry";
    "sensor_msgs" => "CompressedImage", "Image", "LaserScan";
    "std_msgs" => "Header", "Int8", "Int16", "Int32", "Int64", "UInt8", "UInt16", "UInt32", "UInt64";
    "tf2_msgs" => "TFMessage";
};

pub(super) fn published(name: &str) -> Option<TypeDefinition> {
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
