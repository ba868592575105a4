//! The names of junctions seen from their entry.

use toposlam_model::driving::visit::JunctionShape;

/// The shapes of junctions seen from their entry, and their names.
pub const FORMS: [(JunctionShape, &str); 6] = [
    (JunctionShape([true, false, false, false]), "dead-end"),
    (JunctionShape([true, true, false, false]), "l-left"),
    (JunctionShape([true, false, false, true]), "l-right"),
    (JunctionShape([true, true, false, true]), "t-by-stem"),
    (JunctionShape([true, true, true, false]), "t-stem-left"),
    (JunctionShape([true, false, true, true]), "t-stem-right"),
];
