//! The known name that is most like an unknown one.

/// A question after the message that a name is unknown: the first of the known names that is reached from it by the
/// fewest edits, at most one for every three characters: letters inserted, removed or replaced. Case does not
/// count. Empty if no known name is similar.
pub(crate) fn similar_name<'n>(name: &str, known: impl IntoIterator<Item = &'n str>) -> String {
    let letters: Vec<_> = name.to_lowercase().chars().collect();
    let most = letters.len() / 3;
    // A longer name is compared with nothing: it is not a slip.
    if letters.len() > LONGEST {
        return String::new();
    }
    let near = known.into_iter().filter(|known| known.chars().count() <= letters.len() + most);
    let distances = near.map(|known| (edits(&letters, known), known));
    match distances.min_by_key(|(distance, _)| *distance) {
        Some((distance, known)) if distance <= most => format!("; did you mean `{known}`?"),
        _ => String::new(),
    }
}

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_is_offered_if_it_is_near() {
        for (name, offered) in [
            ("corne", "; did you mean `corner`?"),
            ("TEE", "; did you mean `tee`?"),
            ("west_end", "; did you mean `west-end`?"),
            ("hall", ""),
            ("", ""),
            (&"corner".repeat(20), ""),
        ] {
            let known = ["corner", "tee", "end", "west-end"];
            assert_eq!(similar_name(name, known), offered);
        }
    }
}
