//! Definitions of messages, as logs carry them: ROS 1 (`ros1msg`) and ROS 2 (`ros2msg`).
//!
//! The definitions of the messages that a message uses follow its own, each behind a line of `=` and a line
//! `MSG: package/Type`. `Header` is short for `std_msgs/Header`.

mod error;
mod line;
mod resolve;

pub use error::{DefinitionError, DefinitionErrorKind};

/// Which of the two languages a definition is written in, and which rules its messages follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Dialect {
    /// ROS 1: `time` and `duration` are built in.
    Ros1,
    /// ROS 2: they are messages; strings and lists may be bounded; fields may have defaults.
    Ros2,
}

/// The longest definition that is read, in bytes.
pub const MOST_BYTES: usize = 1 << 20;
pub const MOST_DEPTH: usize = 32;
/// How many fields a message may have, those of the messages in it counted too; a list counts once.
pub const MOST_FIELDS: usize = 1 << 16;

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Definition {
    dialect: Dialect,
    structs: Vec<Struct>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Struct {
    /// Its type, as `package/Type`.
    pub name: String,
    pub fields: Vec<Field>,
    /// The fewest bytes that a message of it can have, padding not counted.
    least: usize,
    /// The number of its fields and of those of the messages in it.
    width: usize,
    /// The number of levels of messages in it, with its own; 0 before it is resolved.
    depth: usize,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Field {
    pub name: String,
    pub kind: FieldType,
    pub count: Count,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldType {
    Bool,
    /// A whole number with a sign, with this number of bytes. `byte` in ROS 1.
    Int(u8),
    /// A whole number without a sign, with this number of bytes. `char`; `byte` in ROS 2.
    Unsigned(u8),
    Float(u8),
    Text,
    WideText,
    /// `time` of ROS 1: two numbers without a sign.
    Time,
    /// `duration` of ROS 1: two numbers with a sign.
    Duration,
    Struct(usize),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Count {
    One,
    Fixed(u32),
    Any,
    AtMost(u32),
}

impl Definition {
    /// Reads the definition of a type.
    ///
    /// Takes at most 256 bytes of memory for each byte of the text and of the name, and 4096 besides.
    ///
    /// # Errors
    /// The first thing that is wrong, with its line. No text makes it panic.
    pub fn read(dialect: Dialect, type_name: &str, text: &str) -> Result<Self, DefinitionError> {
        resolve::resolve(dialect, type_name, text)
    }

    pub fn dialect(&self) -> Dialect {
        self.dialect
    }

    pub fn root(&self) -> &Struct {
        // There is always a first one; the other is never made.
        static NOTHING: Struct = Struct::empty(String::new());
        self.structs.first().unwrap_or(&NOTHING)
    }

    pub fn get(&self, index: usize) -> Option<&Struct> {
        self.structs.get(index)
    }

    /// The field at a path such as `pose.position.x` or `doors[0]`, if anything can.
    pub fn at(&self, path: &str) -> Option<(FieldType, Count)> {
        let mut here = (FieldType::Struct(0), Count::One);
        for step in path.split('.') {
            let (FieldType::Struct(index), Count::One) = here else { return None };
            let (name, indices) = step.split_once('[').unwrap_or((step, ""));
            let (_, field) = self.get(index)?.field(name)?;
            here = (field.kind, field.count);
            if step.len() > name.len() {
                let index: u32 = indices.strip_suffix(']')?.parse().ok()?;
                match field.count {
                    Count::Fixed(most) | Count::AtMost(most) if index < most => {}
                    Count::Any => {}
                    _ => return None,
                }
                here.1 = Count::One;
            }
        }
        Some(here)
    }

    /// The fewest bytes that one of a kind can have, padding not counted.
    pub(super) fn least(&self, kind: FieldType) -> usize {
        least(kind, &self.structs)
    }
}

fn least(kind: FieldType, structs: &[Struct]) -> usize {
    match kind {
        FieldType::Bool => 1,
        FieldType::Int(bytes) | FieldType::Unsigned(bytes) | FieldType::Float(bytes) => {
            bytes.into()
        }
        FieldType::Text | FieldType::WideText => 4,
        FieldType::Time | FieldType::Duration => 8,
        FieldType::Struct(index) => structs.get(index).map_or(0, |found| found.least),
    }
}

impl Struct {
    const fn empty(name: String) -> Self {
        Self { name, fields: Vec::new(), least: 0, width: 0, depth: 0 }
    }

    pub fn field(&self, name: &str) -> Option<(usize, &Field)> {
        self.fields.iter().enumerate().find(|(_, field)| field.name == name)
    }
}

/// A type without the `msg` that ROS 2 puts in its middle: `package/Type`.
pub fn short_name(type_name: &str) -> String {
    type_name.replacen("/msg/", "/", 1)
}

#[cfg(test)]
mod tests;
