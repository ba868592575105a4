//! The smallest worlds that a marker cannot distinguish.

use pyo3::prelude::*;
use toposlam_model::{
    ambiguity::{AmbiguitySearch, Findings, PlacedWorld, Unfinished},
    enumerate::{Class, Watch},
    format::named_world::NamedWorld,
    marker::Marker,
};

use crate::{
    error::{error, interrupted},
    long_work::{Watcher, run_watched},
    own_marker::OwnMarker,
    world::{CoreWorld, named_aid},
};

/// The sizes searched, each as its number of edges, of placed worlds and of ambiguous ones; and the groups
/// of worlds that are indistinguishable.
type Found = (Vec<(usize, u64, u64)>, Vec<Vec<CoreWorld>>);

/// Stops as well if a function in Python has failed.
struct OwnWatch<'w> {
    watcher: &'w Watcher,
    marker: &'w OwnMarker,
}

impl Watch for OwnWatch<'_> {
    fn part_done(&self, cases: u64) {
        self.watcher.count(cases);
    }

    fn stop(&self) -> bool {
        self.watcher.stop() || self.marker.has_failed()
    }
}

/// Searches all placed worlds of a class with up to `edges` edges. `marker` is the name of a kind, or a function
/// from doors to a table of sightings. `progress` is called with the number of worlds since the last call.
#[pyfunction]
pub(crate) fn counterexample(
    py: Python<'_>,
    marker: &Bound<'_, PyAny>,
    class_: &str,
    edges: usize,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Found> {
    let class: Class = class_.parse().map_err(|unknown| error(py, "UnknownClassError", unknown))?;
    let size = |cause| error(py, "SizeError", cause);
    let findings = if let Ok(name) = marker.extract::<String>() {
        let kind = named_aid(py, &name)?;
        let search = AmbiguitySearch::new(class, edges, kind).map_err(size)?;
        run_watched(py, progress, None, |watcher| search.run(watcher))?
    } else {
        let own = OwnMarker::new(marker.clone().unbind());
        let kind: &dyn Marker = &own;
        let search = AmbiguitySearch::new(class, edges, kind).map_err(size)?;
        let findings = run_watched(py, progress, Some(own.stopper()), |watcher| {
            search.run(&OwnWatch { watcher, marker: &own })
        })?;
        if let Some(failure) = own.failure() {
            return Err(failure);
        }
        findings
    };
    match findings {
        Ok(findings) => Ok(found(&findings)),
        Err(Unfinished::Interrupted) => Err(interrupted()),
        Err(fault @ (Unfinished::Unconfirmed(_) | Unfinished::Unreadable)) => {
            Err(error(py, "InternalError", fault))
        }
    }
}

fn found(findings: &Findings) -> Found {
    let sizes = findings.sizes.iter();
    let sizes = sizes.map(|size| (size.edges, size.placed_worlds, size.ambiguous)).collect();
    let world = |placed: &PlacedWorld| {
        CoreWorld(NamedWorld::discovered("", "", &placed.graph, PlacedWorld::FACING))
    };
    let groups = findings.groups.iter();
    (sizes, groups.map(|group| group.worlds.iter().map(world).collect()).collect())
}
