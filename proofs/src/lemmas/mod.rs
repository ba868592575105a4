//! The lemmas, a file for each theme, in the order in which the theorem needs them.

use crate::lemma::Lemma;

mod retracing;

/// The lemmas of each file.
pub(crate) const ALL: &[&[Lemma]] = &[retracing::LEMMAS];
