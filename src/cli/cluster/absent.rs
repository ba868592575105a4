//! A program that was built without the feature `cluster` is never a process of a cluster.

use std::{io::Write, path::Path};

use toposlam_model::{
    ambiguity::{AmbiguitySearch, Findings, KeptPairs, Unfinished},
    check::{FinishedUnits, SharedPrefixCheck, Tally},
    enumerate::Watch,
    mapping::MappingAlgorithm,
};

use super::{LostEnd, SharedSetting};
use crate::cli::CliError;

/// There is none.
#[derive(Debug)]
pub(in crate::cli) enum NoCluster {}

impl NoCluster {
    pub(super) fn connect(
        _: &Path,
        _: usize,
        _: &[SharedSetting],
        _: LostEnd,
    ) -> Result<Self, CliError> {
        let cause = "this program was built for one machine; to add clusters, run \
                     cargo build --release --features cluster";
        Err(CliError::at("--hosts", cause))
    }

    pub(in crate::cli) fn is_first(&self) -> bool {
        match *self {}
    }

    pub(in crate::cli) fn check(
        &mut self,
        _: MappingAlgorithm,
        _: &SharedPrefixCheck,
        _: &dyn FinishedUnits,
        _: &dyn Watch,
    ) -> Result<Tally, CliError> {
        match *self {}
    }

    pub(in crate::cli) fn search(
        &mut self,
        _: &AmbiguitySearch<'static>,
        _: KeptPairs,
        _: &dyn Watch,
    ) -> Result<Result<Findings, Unfinished>, CliError> {
        match *self {}
    }

    pub(in crate::cli) fn report(
        &mut self,
        _: &mut dyn Write,
        _: bool,
        _: &str,
    ) -> Result<(), CliError> {
        match *self {}
    }

    pub(in crate::cli) fn close(self) {
        match self {}
    }
}
