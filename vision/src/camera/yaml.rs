//! Values of a YAML file, as far as calibrations need them.

use saphyr_parser::{Event, Parser};

use super::optics_file::{OpticsFileError, shown};

/// Values by their keys; nested keys are joined by points.
pub(super) struct Values {
    found: Vec<Value>,
}

struct Value {
    key: &'static str,
    line: usize,
    words: Vec<String>,
}

/// What the parser is in: a mapping, under the key that was read last, or a list.
enum Inside {
    Mapping(Option<String>),
    List,
}

const DEPTH: usize = 2;

/// Reads the values of known keys, each a word or a list of words. Aliases and tags are ignored.
pub(super) fn values(text: &str, known: &[&'static str]) -> Result<Values, OpticsFileError> {
    // OpenCV's files begin with a directive that is not YAML; in older ones no `---` follows.
    let first = text.lines().next().unwrap_or_default();
    let rest = if first.starts_with("%YAML:") { &text[first.len()..] } else { text };
    let mut reading = Reading { path: Vec::new(), found: Vec::new(), known };
    for event in Parser::new_from_str(rest) {
        let (event, span) = event.map_err(|error| OpticsFileError::Syntax {
            line: error.marker().line(),
            message: shown(error.info()),
        })?;
        let line = span.start.line();
        match event {
            Event::Scalar(word, ..) => reading.word(&word, line)?,
            Event::MappingStart(..) => reading.begin(Inside::Mapping(None), line)?,
            Event::SequenceStart(..) => reading.begin(Inside::List, line)?,
            Event::MappingEnd | Event::SequenceEnd => reading.end(),
            Event::Alias(_) => {
                reading.begin(Inside::List, line)?;
                reading.end();
            }
            // Only the first document.
            Event::DocumentEnd => break,
            _ => {}
        }
    }
    Ok(Values { found: reading.found })
}

struct Reading<'a> {
    path: Vec<Inside>,
    found: Vec<Value>,
    known: &'a [&'static str],
}

impl Reading<'_> {
    fn word(&mut self, word: &str, line: usize) -> Result<(), OpticsFileError> {
        if let Some(Inside::Mapping(key @ None)) = self.path.last_mut() {
            *key = Some(word.to_owned());
            return match self.known_key() {
                Some(key) if self.found.iter().any(|value| value.key == key) => {
                    Err(OpticsFileError::Twice { line, key: key.to_owned() })
                }
                Some(key) => {
                    self.found.push(Value { key, line, words: Vec::new() });
                    Ok(())
                }
                None => Ok(()),
            };
        }
        if let Some(key) = self.known_key() {
            for value in self.found.iter_mut().filter(|value| value.key == key) {
                value.words.push(word.to_owned());
            }
        }
        if let Some(Inside::Mapping(key)) = self.path.last_mut() {
            *key = None;
        }
        Ok(())
    }

    fn begin(&mut self, inside: Inside, line: usize) -> Result<(), OpticsFileError> {
        if let Some(Inside::Mapping(None)) = self.path.last() {
            let message = "a key should be a word".to_owned();
            return Err(OpticsFileError::Syntax { line, message });
        }
        self.path.push(inside);
        Ok(())
    }

    fn end(&mut self) {
        self.path.pop();
        if let Some(Inside::Mapping(key)) = self.path.last_mut() {
            *key = None;
        }
    }

    /// The known key that the parser is under: in mappings, perhaps in a list in them.
    fn known_key(&self) -> Option<&'static str> {
        let lists = usize::from(matches!(self.path.last(), Some(Inside::List)));
        let mappings = &self.path[..self.path.len() - lists];
        if mappings.len() > DEPTH {
            return None;
        }
        let keys: Option<Vec<&str>> = mappings
            .iter()
            .map(|inside| match inside {
                Inside::Mapping(key) => key.as_deref(),
                Inside::List => None,
            })
            .collect();
        let path = keys?.join(".");
        self.known.iter().find(|known| **known == path).copied()
    }
}

impl Values {
    fn get(&self, key: &str) -> Option<&Value> {
        self.found.iter().find(|value| value.key == key)
    }

    pub(super) fn has(&self, key: &str) -> bool {
        self.get(key).is_some()
    }

    /// The word of a key, if there is one.
    pub(super) fn text(&self, key: &str) -> Option<&str> {
        self.get(key)?.words.first().map(String::as_str)
    }

    /// The numbers of a key, which must be `N`.
    pub(super) fn numbers<const N: usize>(
        &self,
        key: &'static str,
    ) -> Result<[f64; N], OpticsFileError> {
        let value = self.get(key).ok_or(OpticsFileError::MissingKey(key))?;
        if value.words.len() != N {
            return Err(OpticsFileError::Count { key, found: value.words.len(), expected: N });
        }
        let mut numbers = [0.0; N];
        for (number, word) in numbers.iter_mut().zip(&value.words) {
            *number =
                word.parse().ok().filter(|number: &f64| number.is_finite()).ok_or_else(|| {
                    OpticsFileError::NotANumber { line: value.line, found: shown(word) }
                })?;
        }
        Ok(numbers)
    }

    pub(super) fn number(&self, key: &'static str) -> Result<f64, OpticsFileError> {
        self.numbers(key).map(|[number]| number)
    }
}
