//! Values of a YAML file, as far as calibrations need them.

use std::collections::BTreeMap;

use saphyr_parser::{Event, Parser};

use super::optics_file::{OpticsFileError, finite, shown};

/// The words of known keys, each with the line of the key; nested keys are joined by points.
pub(super) struct Values<'k> {
    known: &'k [&'static str],
    found: BTreeMap<&'static str, (usize, Vec<String>)>,
    path: Vec<Inside>,
}

/// What the parser is in: a mapping, under the key that was read last, or a list.
enum Inside {
    Mapping(Option<String>),
    List,
}

const DEPTH: usize = 2;

/// Reads the values of known keys, each a word or a list of words. Aliases and tags are ignored.
pub(super) fn values<'k>(
    text: &str,
    known: &'k [&'static str],
) -> Result<Values<'k>, OpticsFileError> {
    // OpenCV's files begin with a directive that is not YAML; in older ones no `---` follows.
    let first = text.lines().next().unwrap_or_default();
    let rest = if first.starts_with("%YAML:") { &text[first.len()..] } else { text };
    let mut values = Values::empty(known);
    for event in Parser::new_from_str(rest) {
        let (event, span) = event.map_err(|error| OpticsFileError::Syntax {
            line: error.marker().line(),
            message: shown(error.info()),
        })?;
        let line = span.start.line();
        match event {
            Event::Scalar(word, ..) => values.word(&word, line)?,
            Event::MappingStart(..) => values.begin(Inside::Mapping(None), line)?,
            Event::SequenceStart(..) => values.begin(Inside::List, line)?,
            Event::MappingEnd | Event::SequenceEnd => values.end(),
            Event::Alias(_) => {
                values.begin(Inside::List, line)?;
                values.end();
            }
            // Only the first document.
            Event::DocumentEnd => break,
            _ => {}
        }
    }
    Ok(values)
}

impl<'k> Values<'k> {
    pub(super) fn empty(known: &'k [&'static str]) -> Self {
        Self { known, found: BTreeMap::new(), path: Vec::new() }
    }

    /// Adds the words of a key, if it is known.
    pub(super) fn add(
        &mut self,
        key: &str,
        line: usize,
        words: impl Iterator<Item = String>,
    ) -> Result<(), OpticsFileError> {
        let Some(key) = self.known.iter().find(|known| **known == key) else { return Ok(()) };
        match self.found.insert(key, (line, words.collect())) {
            None => Ok(()),
            Some(_) => Err(OpticsFileError::Twice { line, key: (*key).to_owned() }),
        }
    }

    fn word(&mut self, word: &str, line: usize) -> Result<(), OpticsFileError> {
        if let Some(Inside::Mapping(key @ None)) = self.path.last_mut() {
            *key = Some(word.to_owned());
            return match self.known_key() {
                Some(key) => self.add(key, line, std::iter::empty()),
                None => Ok(()),
            };
        }
        if let Some((_, words)) = self.known_key().and_then(|key| self.found.get_mut(key)) {
            words.push(word.to_owned());
        }
        self.end_value();
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
        self.end_value();
    }

    /// In a mapping, a key follows.
    fn end_value(&mut self) {
        if let Some(Inside::Mapping(key)) = self.path.last_mut() {
            *key = None;
        }
    }

    /// The known key that the parser is under: in mappings, perhaps in lists in them.
    fn known_key(&self) -> Option<&'static str> {
        let is_list = |inside: &&Inside| matches!(inside, Inside::List);
        let lists = self.path.iter().rev().take_while(is_list).count();
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

    pub(super) fn has(&self, key: &str) -> bool {
        self.found.contains_key(key)
    }

    /// The first of these keys that has a value, or else the first one.
    pub(super) fn first_of(&self, keys: &[&'static str]) -> &'static str {
        let has_words =
            |key: &&&str| self.found.get(**key).is_some_and(|(_, words)| !words.is_empty());
        keys.iter().find(has_words).unwrap_or(&keys[0])
    }

    /// The word of a key, if there is one.
    pub(super) fn text(&self, key: &str) -> Option<&str> {
        self.found.get(key)?.1.first().map(String::as_str)
    }

    /// The numbers of a key, which must be `N`.
    pub(super) fn numbers<const N: usize>(
        &self,
        key: &'static str,
    ) -> Result<[f64; N], OpticsFileError> {
        let (line, words) = self.found.get(key).ok_or(OpticsFileError::MissingKey(key))?;
        if words.len() != N {
            return Err(OpticsFileError::Count { key, found: words.len(), expected: N });
        }
        let mut numbers = [0.0; N];
        for (number, word) in numbers.iter_mut().zip(words) {
            *number = finite(word, *line)?;
        }
        Ok(numbers)
    }

    /// The numbers of these keys.
    pub(super) fn each<const N: usize>(
        &self,
        keys: [&'static str; N],
    ) -> Result<[f64; N], OpticsFileError> {
        let mut numbers = [0.0; N];
        for (number, key) in numbers.iter_mut().zip(keys) {
            *number = self.number(key)?;
        }
        Ok(numbers)
    }

    pub(super) fn number(&self, key: &'static str) -> Result<f64, OpticsFileError> {
        self.numbers(key).map(|[number]| number)
    }
}
