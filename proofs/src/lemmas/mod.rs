//! The lemmas, a file for each theme, in the order in which the theorem needs them.

use crate::lemma::Lemma;

mod arithmetic;
mod certificates;
mod codes;
mod decoders;
mod embedded_graph;
mod figure_1;
mod mapping;
mod retracing;
mod sighting;
mod validation;

/// The lemmas of each file.
pub(crate) const ALL: &[&[Lemma]] = &[
    arithmetic::LEMMAS,
    embedded_graph::LEMMAS,
    retracing::LEMMAS,
    codes::LEMMAS,
    sighting::LEMMAS,
    validation::LEMMAS,
    mapping::LEMMAS,
    figure_1::LEMMAS,
    certificates::LEMMAS,
    decoders::LEMMAS,
];
