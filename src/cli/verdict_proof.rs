//! `--proof FILE`: the proof of a verdict, in the format of `docs/proofs-of-verdicts.md`.

use std::{fmt::Display, path::PathBuf};

use toposlam_model::proof::{NotProved, Proof};

use super::{CliError, output};

#[derive(Clone, Debug, clap::Args)]
pub(super) struct ProofOption {
    /// Write a proof of the verdict, which a small verified checker confirms
    #[arg(long, value_name = "FILE")]
    proof: Option<PathBuf>,
}

impl ProofOption {
    pub(super) fn path(&self) -> Option<&PathBuf> {
        self.proof.as_ref()
    }

    /// Checks the place, before long work begins.
    pub(super) fn check_place(&self) -> Result<(), CliError> {
        output::check_place(&self.proof, &["proof"])
    }

    /// Writes the proofs, if they are wanted. If there are none, a remark says why.
    pub(super) fn write<'g>(
        &self,
        proofs: impl FnOnce() -> Result<Vec<Proof<'g>>, NotProved>,
    ) -> Result<(), CliError> {
        if self.proof.is_none() {
            return Ok(());
        }
        match proofs() {
            Ok(proofs) => {
                self.write_text(&proofs.iter().map(ToString::to_string).collect::<String>())
            }
            Err(why) => {
                self.remark(&why);
                Ok(())
            }
        }
    }

    /// Writes the text of proofs, if they are wanted.
    pub(super) fn write_text(&self, text: &str) -> Result<(), CliError> {
        self.proof.as_ref().map_or(Ok(()), |path| output::write_whole(path, text.as_bytes()))
    }

    /// Why nothing is written.
    pub(super) fn remark(&self, why: &dyn Display) {
        if let Some(path) = &self.proof {
            remark!("{}: not written: {why}", path.display());
        }
    }
}
