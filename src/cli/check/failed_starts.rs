//! The folder of `--failed`: world files of the starts that an explorer does not map. With `--failed-first` they are
//! checked first, as pytest's option of this name does with tests.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
};

use toposlam_model::{
    check::EnumeratedStart,
    embedded_graph::{Dart, EmbeddedGraph},
    format::named_world::NamedWorld,
};

use super::Work;
use crate::cli::{CliError, input, output};

/// The most starts of a size that are written.
pub(super) const MOST: usize = 100;

/// A start that was not mapped, and its file.
struct FailedFile {
    path: PathBuf,
    graph: EmbeddedGraph,
    facing: Dart,
}

pub(super) struct FailedStarts {
    folder: PathBuf,
    /// What was there at the beginning, by name.
    files: Vec<FailedFile>,
}

impl FailedStarts {
    /// Whether `--failed` names a folder: one that exists, or a name without an ending.
    pub(super) fn is_folder(path: &Path) -> bool {
        path.is_dir() || (!path.exists() && path.extension().is_none())
    }

    /// Reads the starts in a folder; none if it does not exist.
    ///
    /// # Errors
    /// Returns an error if a file is not a world with a start, or if there are starts, and `are_expected` is false.
    pub(super) fn open(folder: &Path, are_expected: bool) -> Result<Self, CliError> {
        let mut paths = Vec::new();
        if folder.is_dir() {
            for entry in fs::read_dir(folder).map_err(|error| CliError::in_file(folder, error))? {
                paths.push(entry.map_err(|error| CliError::in_file(folder, error))?.path());
            }
        }
        paths.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
        paths.sort();
        if !are_expected && !paths.is_empty() {
            let cause =
                "this folder has starts of an earlier check; --failed-first checks them first";
            return Err(CliError::in_file(folder, cause));
        }
        let read = |path: PathBuf| {
            let world = input::read_world(&path)?;
            let Some(facing) = world.start else {
                return Err(CliError::in_file(&path, "this world has no start"));
            };
            Ok(FailedFile { path, graph: world.graph, facing })
        };
        let files = paths.into_iter().map(read).collect::<Result<_, _>>()?;
        Ok(Self { folder: folder.to_owned(), files })
    }

    pub(super) fn name(&self) -> String {
        self.folder.display().to_string()
    }

    pub(super) fn count(&self) -> usize {
        self.files.len()
    }

    /// The starts that were there, by their number of edges.
    pub(super) fn work(&self) -> BTreeMap<usize, Work> {
        let mut sizes: BTreeMap<usize, Vec<_>> = BTreeMap::new();
        for FailedFile { graph, facing, .. } in &self.files {
            sizes.entry(graph.edge_count()).or_default().push((graph.clone(), Some(*facing)));
        }
        sizes.into_iter().map(|(edges, worlds)| (edges, Work::Listed(worlds))).collect()
    }

    /// Removes the files of the starts with a number of edges that are not among these.
    pub(super) fn keep_only(&self, edges: usize, unmapped: &[NamedWorld]) -> Result<(), CliError> {
        let start = |world: &NamedWorld| Some(EnumeratedStart::new(&world.graph, world.start?));
        let unmapped: BTreeSet<_> = unmapped.iter().filter_map(start).collect();
        for FailedFile { path, graph, facing } in &self.files {
            let is_mapped = || !unmapped.contains(&EnumeratedStart::new(graph, *facing));
            if graph.edge_count() == edges && is_mapped() {
                fs::remove_file(path).map_err(|error| CliError::in_file(path, error))?;
            }
        }
        Ok(())
    }

    /// Writes a file for each start.
    pub(super) fn write(&self, unmapped: &[NamedWorld]) -> Result<(), CliError> {
        if unmapped.is_empty() {
            return Ok(());
        }
        output::make_folder(&self.folder)?;
        let mut numbers: BTreeMap<usize, usize> = BTreeMap::new();
        for world in unmapped {
            let edges = world.graph.edge_count();
            let number = numbers.entry(edges).or_default();
            let path = loop {
                *number += 1;
                let path = self.folder.join(format!("{edges}-edges-{number:03}.toml"));
                // What was read is not written.
                if !self.files.iter().any(|file| file.path == path) {
                    break path;
                }
            };
            output::write_world(&path, world)?;
        }
        Ok(())
    }
}
