//! The topics of a log, and the definitions of their messages.

use std::collections::BTreeMap;

use thiserror::Error;

use super::{
    carmen,
    container::Record,
    decode::{DecodeError, decode},
    definition::{Definition, DefinitionError, Dialect, short_name},
    messages::published_schema,
    value::Value,
};

/// A topic of a log. One name may stand for several topics, of different types.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Topic {
    pub name: String,
    /// The type of its messages in the log; empty if it has none.
    pub type_name: String,
    pub encoding: Encoding,
    pub definition: Result<Definition, Undecodable>,
    pub messages: u64,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Encoding {
    Ros1,
    Cdr,
    Carmen,
    Event,
    Other(String),
}

#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum Undecodable {
    #[error(transparent)]
    Definition(#[from] DefinitionError),
    #[error("messages in {messages:?} by a schema in {schema:?} cannot be read")]
    Encoding { messages: String, schema: String },
    #[error("the log does not define its messages")]
    NoSchema,
}

impl Topic {
    /// The type of its messages as `package/Type`, in ROS 2 as in ROS 1.
    pub fn short_type(&self) -> String {
        short_name(&self.type_name)
    }

    /// The value of a message; `None` if the messages of the topic cannot be decoded.
    ///
    /// # Errors
    /// Returns an error if the bytes are not a message of the topic.
    pub fn decode<'a>(&'a self, bytes: &'a [u8]) -> Option<Result<Value<'a>, DecodeError>> {
        let definition = self.definition.as_ref().ok()?;
        match self.encoding {
            Encoding::Carmen => Some(carmen::decode(definition, bytes)),
            Encoding::Event => None,
            _ => Some(decode(definition, bytes)),
        }
    }
}

/// Collects the topics of a log from its records. Repetitions are ignored.
#[derive(Default)]
pub(super) struct Topics {
    pub(super) list: Vec<Topic>,
    texts: Vec<Vec<u8>>,
    pub(super) connections: BTreeMap<(usize, u32), usize>,
    schemas: BTreeMap<u16, Schema>,
    file: usize,
}

/// A type, the language of its definition, and its definition.
#[derive(Clone, Default)]
struct Schema {
    name: String,
    encoding: String,
    text: Vec<u8>,
}

impl Schema {
    fn new(name: &[u8], encoding: &[u8], text: &[u8]) -> Self {
        Self { name: lossy(name), encoding: lossy(encoding), text: text.to_owned() }
    }
}

impl Topics {
    pub(super) fn in_file(&mut self, file: usize) -> &mut Self {
        if file != self.file {
            self.file = file;
            self.schemas.clear();
        }
        self
    }

    /// The index of the present file.
    pub(super) fn present_file(&self) -> usize {
        self.file
    }

    pub(super) fn add_record(&mut self, record: &Record<'_>) {
        match *record {
            Record::Connection { id, topic, type_name, encoding, schema, definition } => {
                let schema = Schema::new(type_name, schema, definition);
                self.add(id, lossy(topic), lossy(encoding), schema);
            }
            Record::Schema { id, name, encoding, text } => {
                self.schemas.entry(id).or_insert_with(|| Schema::new(name, encoding, text));
            }
            Record::Channel { id, schema, topic, encoding } => {
                let schema = self.schemas.get(&schema).cloned().unwrap_or_default();
                self.add(id.into(), lossy(topic), lossy(encoding), schema);
            }
            Record::Message { .. } | Record::Other => {}
        }
    }

    /// Connections with the same topic, type and definition share one entry.
    fn add(&mut self, id: u32, name: String, encoding: String, schema: Schema) {
        if self.connections.contains_key(&(self.file, id)) {
            return;
        }
        let Schema { name: type_name, encoding: language, text } = schema;
        let mut known = self.list.iter().zip(&self.texts);
        let same = known.position(|(topic, known_text)| {
            topic.name == name && topic.type_name == type_name && *known_text == text
        });
        let index = same.unwrap_or_else(|| {
            let (encoding, definition) = defined(encoding, language, &type_name, &lossy(&text));
            self.list.push(Topic { name, type_name, encoding, definition, messages: 0 });
            self.texts.push(text);
            self.list.len() - 1
        });
        self.connections.insert((self.file, id), index);
    }
}

fn defined(
    messages: String,
    schema: String,
    name: &str,
    text: &str,
) -> (Encoding, Result<Definition, Undecodable>) {
    if messages == "cdr" && text.trim().is_empty() {
        let known = published_schema(name).ok_or(Undecodable::NoSchema);
        let definition = known.and_then(|text| Ok(Definition::read(Dialect::Ros2, name, &text)?));
        return (Encoding::Cdr, definition);
    }
    let (encoding, dialect) = match (&*messages, &*schema) {
        ("ros1", "ros1msg") => (Encoding::Ros1, Dialect::Ros1),
        ("cdr", "ros2msg") => (Encoding::Cdr, Dialect::Ros2),
        ("carmen", "text") => (Encoding::Carmen, Dialect::Ros1),
        ("event", "text") => (Encoding::Event, Dialect::Ros1),
        (_, "") => return (Encoding::Other(messages), Err(Undecodable::NoSchema)),
        _ => {
            let why = Undecodable::Encoding { messages: messages.clone(), schema };
            return (Encoding::Other(messages), Err(why));
        }
    };
    (encoding, Definition::read(dialect, name, text).map_err(Undecodable::from))
}

fn lossy(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}
