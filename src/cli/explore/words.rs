//! The words of which stories and endings are made.

pub(super) use crate::cli::words::{counted, vertices};
use toposlam_model::{
    embedded_graph::Dart,
    mapping::PartialMap,
    percept::{Percept, Sighting},
};

/// A dart of the map.
pub(super) fn dart(map: &PartialMap, dart: Dart) -> String {
    format!("v{}.{}", map.vertex(dart).0, map.index(dart))
}

/// A percept beside another: that there is no marker is told where it is what differs.
pub(super) fn seen_against(percept: Percept, other: Percept) -> String {
    let absent = percept.sighting == Sighting::Nothing && other.sighting != Sighting::Nothing;
    format!("{percept}{}", if absent { ", no marker" } else { "" })
}
