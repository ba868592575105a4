//! `--proof FILE`: for each start the proof that its run determines its map, one after the other.

use std::{io::Write, ops::ControlFlow, path::Path};

use sha2::{Digest, Sha256};
use toposlam_logs::hexadecimal;
use toposlam_model::{
    enumerate::{Class, Each, Enumeration, Watch},
    mapping::{FACING, MappingAlgorithm, MappingMethod},
    proof::{NotProved, Proof, WalkRecorder},
    world::GraphWorld,
};

use crate::cli::{
    CliError,
    output::{self, WholeFile},
};

/// The file of all proofs.
pub(super) struct MapProofs<'p> {
    path: &'p Path,
    file: WholeFile,
    is_empty: bool,
}

impl<'p> MapProofs<'p> {
    pub(super) fn create(path: &'p Path) -> Result<Self, CliError> {
        Ok(Self { path, file: output::create_whole(path)?, is_empty: true })
    }

    /// Adds the proofs of all starts of a size, in the order of the enumeration, and returns their digest: SHA-256 of their
    /// text.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written, if a run has no proof, or if the watch stops.
    pub(super) fn add_size(
        &mut self,
        (class, edges): (Class, usize),
        algorithm: MappingAlgorithm,
        watch: &dyn Watch,
    ) -> Result<String, CliError> {
        let starts = Enumeration::new(Each::Start, class, edges);
        let starts = starts.map_err(|error| CliError::at("--edges", error))?;
        let mut digest = Sha256::new();
        let mut result = Ok(());
        let _ = starts.for_each(&mut |found| {
            result = watch.check_stop().map_err(CliError::from).and_then(|()| {
                let mut world = GraphWorld::new(found.graph, FACING);
                let mut recorder = WalkRecorder::default();
                let bound = found.graph.dart_count();
                let method = MappingMethod::from(algorithm);
                let (journey, _) = method.map_world(&mut world, bound, &[], &mut recorder);
                let map = journey.map().complete().ok_or(NotProved::NoMap);
                let proof = map.and_then(|map| Proof::of_map(map, FACING, recorder.walk()?));
                let text = proof.map_err(|error| CliError::at("--proof", error))?.to_string();
                digest.update(&text);
                watch.part_done(1);
                self.is_empty = false;
                self.file
                    .write_all(text.as_bytes())
                    .map_err(|error| output::not_writable(self.path, &error))
            });
            if result.is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        result.map(|()| hexadecimal(&digest.finalize()))
    }

    /// Gives the file its name. Without a proof none is written.
    pub(super) fn close(self) -> Result<(), CliError> {
        if self.is_empty { Ok(()) } else { self.file.complete() }
    }
}
