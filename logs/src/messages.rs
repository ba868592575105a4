//! The messages of the project. `robot/msgs/toposlam_msgs` defines each of them and documents its fields;
//! the fields here have the same order.

use serde::{Deserialize, Serialize};

use super::{from_value::FromValue, message::Message, value::Value};

/// A time, in seconds and nanoseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Stamp {
    /// Whole seconds.
    pub sec: i32,
    pub nanosec: u32,
}

impl Stamp {
    pub fn of(nanoseconds: u64) -> Self {
        const SECOND: u64 = 1_000_000_000;
        let sec = i32::try_from(nanoseconds / SECOND).unwrap_or(i32::MAX);
        Self { sec, nanosec: (nanoseconds % SECOND) as u32 }
    }

    /// The time in nanoseconds; 0 before the beginning of time.
    pub fn nanoseconds(self) -> u64 {
        u64::try_from(self.sec).unwrap_or(0) * 1_000_000_000 + u64::from(self.nanosec)
    }
}

pub trait ProjectMessage: Message {
    const TOPIC: &'static str;
}

macro_rules! own {
    ($($(#[$doc:meta])* $name:ident $topic:literal {
        $($field:ident: $type:ty $(= $older:expr)?,)*
    })*) => {
        /// The types and their definitions, without those that they use.
        #[cfg(feature = "sqlite")]
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
                    let stamp = value.field("stamp").ok_or("stamp")?;
                    $(
                        let name = stringify!($field).trim_start_matches("r#");
                        let $field = value.field(name)$(.or(Some($older)))?.ok_or(name)?;
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
    Percept "/toposlam/percept" {
        r#move: u32,
        degree: u32,
        marker: i32,
        form: [bool; 4],
        entry: f64,
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
