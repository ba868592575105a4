//! The messages of the project. `robot/msgs/toposlam_msgs` defines each of them and documents its fields;
//! the fields here have the same order.

use serde::Serialize;

pub use super::stamp::Stamp;
use super::{from_value::FromValue, message::Message, value::Value};

pub trait ProjectMessage: Message {
    const TOPIC: &'static str;
}

macro_rules! own {
    ($($(#[$doc:meta])* $name:ident $topic:literal {
        $($field:ident: $type:ty $(= $older:expr)?,)*
    })*) => {
        /// The types and their definitions, without those that they use.
        pub(super) const OWN: &[(&str, &str)] = &[$(($name::TYPE, $name::DEFINITION),)*];

        $(
            $(#[$doc])*
            #[derive(Clone, Debug, Default, PartialEq, Serialize)]
            pub struct $name {
                pub stamp: Stamp,
                $(pub $field: $type,)*
            }

            impl Message for $name {
                const TYPE: &'static str = concat!("toposlam_msgs/msg/", stringify!($name));
                const DEFINITION: &'static str =
                    include_str!(concat!("../msgs/toposlam_msgs/msg/", stringify!($name), ".msg"));
            }

            impl ProjectMessage for $name {
                const TOPIC: &'static str = $topic;
            }

            impl FromValue for $name {
                fn from_value(value: &Value<'_>) -> Result<Self, &'static str> {
                    let stamp = value.get("stamp").ok_or("stamp")?;
                    $(
                        let name = stringify!($field).trim_start_matches("r#");
                        let $field = value.get(name)$(.or(Some($older)))?.ok_or(name)?;
                    )*
                    Ok(Self { stamp, $($field,)* })
                }
            }
        )*
    };
}

// A field with a value has that in older logs, which do not have the field.
own! {
    Run "/toposlam/run" {
        version: String,
        world: String,
        world_hash: String,
        start: String,
        marker: String,
        seed: u64,
        calibration: String,
        colours: String,
        command: String,
        algorithm: String = String::new(),
    }
    Scene "/toposlam/scene" {
        place: String,
        status: String,
        reason: String,
        heading: f64,
        left: f64,
        right: f64,
        doors: Vec<f64>,
        turning_point: [f64; 2],
        confidence: f64,
        marker: bool,
        marker_position: [f64; 2],
        marker_axis: f64,
        marker_door: i32,
    }
    Command "/toposlam/command" {
        state: String,
        turn: f64,
        forward: f64,
    }
    Door "/toposlam/door" {
        r#move: u32,
        door: u32,
    }
    Action "/toposlam/action" {
        r#move: u32,
        action: String,
    }
    Percept "/toposlam/percept" {
        r#move: u32,
        degree: u32,
        marker: i32,
        form: [bool; 4],
        entry: f64,
        sighting: String = String::new(),
    }
    Hypothesis "/toposlam/hypothesis" {
        r#move: u32,
        step: String,
        dart: i32,
        other: i32,
        contradicted: u32,
        hypotheses: u32,
        followed: u32,
    }
    Map "/toposlam/map" {
        r#move: u32,
        degrees: Vec<u32>,
        opposite: Vec<i32>,
        robot: u32,
    }
    End "/toposlam/end" {
        moves: u32,
        ending: String,
        cause: String,
    }
}

/// The schema of a published type or one of the project, for logs that do not define their messages: databases of
/// rosbag2 before ROS 2 Iron, and MCAP files whose recorder had no definitions.
pub(super) fn published_schema(type_name: &str) -> Option<String> {
    use super::{
        definition::short_name,
        message::{published, schema},
    };
    let name = short_name(type_name);
    let own = OWN.iter().find(|(own, _)| short_name(own) == name);
    let text = own.map(|(_, text)| *text).or_else(|| Some(published(&name)?.text));
    text.map(schema)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        definition::{Definition, Dialect},
        message::PUBLISHED,
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
