//! The lemmas, a file for each theme, in the order in which the theorem needs them.

use crate::lemma::Lemma;

mod arithmetic;
mod certificates;
mod codes;
pub(crate) mod decoders;
mod driving;
mod embedded_graph;
mod figure_1;
mod folding;
pub(crate) mod mapping;
mod retracing;
mod sighting;
mod validation;

/// All lemmas, in the order in which the theorem needs them.
pub fn all() -> impl Iterator<Item = &'static Lemma> {
    THEMES.iter().copied().flatten()
}

/// The lemmas that are executed symbolically.
#[cfg(feature = "symbolic")]
pub fn compiled() -> impl Iterator<Item = &'static crate::lemma::CompiledHarness> {
    COMPILED.iter().copied().flatten()
}

/// The lemmas of each file.
const THEMES: &[&[Lemma]] = &[
    embedded_graph::LEMMAS,
    decoders::LEMMAS,
    arithmetic::LEMMAS,
    codes::LEMMAS,
    sighting::LEMMAS,
    retracing::LEMMAS,
    validation::LEMMAS,
    mapping::LEMMAS,
    folding::LEMMAS,
    figure_1::LEMMAS,
    certificates::LEMMAS,
    driving::LEMMAS,
];

#[cfg(feature = "symbolic")]
const COMPILED: &[&[crate::lemma::CompiledHarness]] = &[
    embedded_graph::COMPILED,
    decoders::COMPILED,
    arithmetic::COMPILED,
    codes::COMPILED,
    sighting::COMPILED,
    retracing::COMPILED,
    validation::COMPILED,
    mapping::COMPILED,
    folding::COMPILED,
    figure_1::COMPILED,
    certificates::COMPILED,
    driving::COMPILED,
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_is_given_once_and_every_sentence_is_one() {
        let mut names: Vec<_> = all().map(|lemma| lemma.name).collect();
        assert!(names.len() > 12);
        names.sort_unstable();
        assert!(names.windows(2).all(|pair| pair[0] != pair[1]), "{names:?}");
        for Lemma { name, sentence, .. } in all() {
            assert!(sentence.ends_with('.') && sentence.starts_with(char::is_uppercase), "{name}");
        }
    }
}
