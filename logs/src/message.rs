//! Messages of ROS 2: a type name, and the definitions that a reader needs.

use std::fmt::Write;

use serde::Serialize;

use super::messages::ProjectMessage;

/// A message that a log can hold.
pub trait Message: Serialize {
    /// Its type, as ROS 2 names it.
    const TYPE: &'static str;
    /// Its definition.
    const DEFINITION: &'static str;
    /// The types that it uses, and those that they use.
    const USES: &'static [TypeDefinition];
}

/// A type and its definition.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TypeDefinition {
    /// Its name, as definitions refer to it: `PACKAGE/TYPE`.
    pub name: &'static str,
    /// Its definition.
    pub text: &'static str,
}

/// The definition of a published type.
macro_rules! definition {
    ($package:literal, $name:literal) => {
        $crate::message::TypeDefinition {
            name: concat!($package, "/", $name),
            text: include_str!(concat!("../msgs/", $package, "/msg/", $name, ".msg")),
        }
    };
}
pub(super) use definition;

/// A time, which nearly every message has.
pub const TIME: TypeDefinition = definition!("builtin_interfaces", "Time");

/// The project's messages are made of numbers, words and a time.
impl<M: ProjectMessage> Message for M {
    const TYPE: &'static str = M::TYPE;
    const DEFINITION: &'static str = M::DEFINITION;
    const USES: &'static [TypeDefinition] = &[TIME];
}

/// The schema of a message in MCAP's encoding `ros2msg`: its definition, and those of the types that it
/// uses.
#[must_use]
pub fn schema<M: Message>() -> String {
    let mut text = M::DEFINITION.to_owned();
    for TypeDefinition { name, text: used } in M::USES {
        // Writing to a string cannot fail.
        let _ = write!(text, "{:=<80}\nMSG: {name}\n{used}", "");
    }
    text
}
