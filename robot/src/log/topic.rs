//! The topics of a log, and the definitions of their messages.

use std::collections::BTreeMap;

use thiserror::Error;

use super::{
    container::Record,
    definition::{Definition, DefinitionError, Dialect, short_name},
};

/// A topic of a log. One name may stand for several topics, of different types.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Topic {
    /// Its name.
    pub name: String,
    /// The type of its messages in the log; empty if it has none.
    pub type_name: String,
    /// The encoding of its messages.
    pub encoding: Encoding,
    /// The definition of its messages.
    pub definition: Result<Definition, Undecodable>,
    /// The number of its messages.
    pub messages: u64,
}

/// The encoding of messages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// As ROS 1 does.
    Ros1,
    /// In CDR, as ROS 2 does.
    Cdr,
    /// In another way, which is not read.
    Other(String),
}

/// Why the messages of a topic cannot be decoded.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum Undecodable {
    /// Their definition is wrong.
    #[error(transparent)]
    Definition(#[from] DefinitionError),
    /// They are written in a way that is not known.
    #[error("messages in {messages:?} by a schema in {schema:?} cannot be read")]
    Encoding {
        /// How the messages are written.
        messages: String,
        /// How their definition is.
        schema: String,
    },
    /// There is no definition.
    #[error("the log does not define its messages")]
    NoSchema,
}

impl Topic {
    /// The type of its messages as `package/Type`, in ROS 2 as in ROS 1.
    #[must_use]
    pub fn short_type(&self) -> String {
        short_name(&self.type_name)
    }
}

/// Collects the topics of a log from its records. Repetitions are ignored.
#[derive(Default)]
pub(super) struct Topics {
    pub(super) list: Vec<Topic>,
    /// Of each topic, the text that defines it.
    texts: Vec<Vec<u8>>,
    /// The topic of each connection.
    pub(super) connections: BTreeMap<u32, usize>,
    schemas: BTreeMap<u16, Schema>,
}

struct Schema {
    name: String,
    encoding: String,
    text: Vec<u8>,
}

impl Topics {
    pub(super) fn add_record(&mut self, record: &Record<'_>) {
        match *record {
            Record::Connection { id, topic, type_name, definition } => {
                if !self.connections.contains_key(&id) {
                    self.add(id, lossy(topic), lossy(type_name), definition, |name, text| {
                        let read = Definition::read(Dialect::Ros1, name, text);
                        (Encoding::Ros1, read.map_err(Undecodable::from))
                    });
                }
            }
            Record::Schema { id, name, encoding, text } => {
                self.schemas.entry(id).or_insert_with(|| Schema {
                    name: lossy(name),
                    encoding: lossy(encoding),
                    text: text.to_owned(),
                });
            }
            Record::Channel { id, schema, topic, encoding } => {
                if self.connections.contains_key(&id.into()) {
                    return;
                }
                let messages = lossy(encoding);
                let Some(Schema { name, encoding, text }) = self.schemas.get(&schema) else {
                    self.add(id.into(), lossy(topic), String::new(), &[], |_, _| {
                        (Encoding::Other(messages), Err(Undecodable::NoSchema))
                    });
                    return;
                };
                let (name, schema, text) = (name.clone(), encoding.clone(), text.clone());
                self.add(id.into(), lossy(topic), name, &text, |name, text| {
                    let (encoding, dialect) = match (&*messages, &*schema) {
                        ("ros1", "ros1msg") => (Encoding::Ros1, Dialect::Ros1),
                        ("cdr", "ros2msg") => (Encoding::Cdr, Dialect::Ros2),
                        _ => {
                            let why = Undecodable::Encoding { messages: messages.clone(), schema };
                            return (Encoding::Other(messages), Err(why));
                        }
                    };
                    let read = Definition::read(dialect, name, text);
                    (encoding, read.map_err(Undecodable::from))
                });
            }
            Record::Message { .. } | Record::Other => {}
        }
    }

    /// Connections with the same topic, type and definition share one entry.
    fn add(
        &mut self,
        id: u32,
        name: String,
        type_name: String,
        text: &[u8],
        read: impl FnOnce(&str, &str) -> (Encoding, Result<Definition, Undecodable>),
    ) {
        let mut known = self.list.iter().zip(&self.texts);
        let same = known.position(|(topic, known_text)| {
            topic.name == name && topic.type_name == type_name && known_text == text
        });
        let index = same.unwrap_or_else(|| {
            let (encoding, definition) = read(&type_name, &String::from_utf8_lossy(text));
            self.list.push(Topic { name, type_name, encoding, definition, messages: 0 });
            self.texts.push(text.to_owned());
            self.list.len() - 1
        });
        self.connections.insert(id, index);
    }
}

fn lossy(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}
