//! The known name that is most like an unknown one.

use std::fmt;

/// A known name, for a message that another name is unknown. Displayed as a question after the message;
/// empty if no known name is similar.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SimilarName(Option<Box<str>>);

impl SimilarName {
    /// The first of the known names that is reached from `name` by the fewest edits, at most one for
    /// every three characters: letters inserted, removed or replaced. Case does not count.
    pub(crate) fn of<'n>(name: &str, known: impl IntoIterator<Item = &'n str>) -> Self {
        let letters: Vec<_> = name.to_lowercase().chars().collect();
        let most = letters.len() / 3;
        // A longer name is compared with nothing: it is not a slip.
        if letters.len() > LONGEST {
            return Self(None);
        }
        let near = known.into_iter().filter(|known| known.chars().count() <= letters.len() + most);
        let distances = near.map(|known| (edits(&letters, known), known));
        let nearest = distances.min_by_key(|(distance, _)| *distance);
        Self(nearest.filter(|(distance, _)| *distance <= most).map(|(_, known)| known.into()))
    }
}

/// The length of the longest name for which a similar one is searched.
const LONGEST: usize = 60;

/// The number of edits from a lower-case name to another one (Levenshtein).
fn edits(name: &[char], other: &str) -> usize {
    let mut row: Vec<usize> = (0..=name.len()).collect();
    for letter in other.to_lowercase().chars() {
        let mut diagonal = row[0];
        row[0] += 1;
        for (place, known) in name.iter().enumerate() {
            let replaced = diagonal + usize::from(*known != letter);
            diagonal = row[place + 1];
            row[place + 1] = replaced.min(row[place] + 1).min(diagonal + 1);
        }
    }
    row[name.len()]
}

impl fmt::Display for SimilarName {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.0 {
            Some(name) => write!(out, "; did you mean `{name}`?"),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edits_are_insertions_removals_and_replacements() {
        let distance = |one: &str, other| edits(&one.chars().collect::<Vec<_>>(), other);
        for (one, other, edits) in [
            ("", "", 0),
            ("corner", "corner", 0),
            ("corner", "Corner", 0),
            ("corner", "crner", 1),
            ("corner", "corners", 1),
            ("corner", "korner", 1),
            ("kitten", "sitting", 3),
            ("", "abc", 3),
            ("abc", "", 3),
        ] {
            assert_eq!(distance(one, other), edits, "{one} {other}");
        }
    }

    #[test]
    fn the_nearest_name_is_offered_if_it_is_near() {
        let text = |name| SimilarName::of(name, ["corner", "tee", "end", "west-end"]).to_string();
        assert_eq!(text("corne"), "; did you mean `corner`?");
        assert_eq!(text("TEE"), "; did you mean `tee`?");
        assert_eq!(text("west_end"), "; did you mean `west-end`?");
        assert_eq!(text("hall"), "");
        assert_eq!(text(""), "");
        assert_eq!(text(&"corner".repeat(20)), "");
    }
}
