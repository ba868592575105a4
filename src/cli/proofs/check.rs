//! The check of one lemma in every case within its bound, which can be interrupted.

use std::{
    sync::mpsc::{self, RecvTimeoutError},
    thread,
    time::{Duration, Instant},
};

use toposlam_model::enumerate::Watch;
use toposlam_proofs::{Counterexample, Lemma, lemma};

use crate::cli::CliError;

/// A check of a lemma.
pub(super) struct LemmaCheck {
    pub(super) end: CheckEnd,
    pub(super) seconds: f64,
}

/// How a check ended.
pub(super) enum CheckEnd {
    /// The lemma holds in all cases.
    Holds { cases: u64 },
    /// The lemma fails in a case.
    Fails(Counterexample),
    /// The lemma holds in all cases, but their number is not the expected one.
    Miscounted { pinned: u64, found: u64 },
    /// The check was interrupted after at least this many cases, in which the lemma holds.
    Interrupted { cases: u64 },
}

impl CheckEnd {
    /// The number of cases in which the lemma holds, before the first one in which it fails.
    pub(super) fn cases(&self) -> u64 {
        match *self {
            Self::Holds { cases }
            | Self::Interrupted { cases }
            | Self::Miscounted { found: cases, .. }
            | Self::Fails(Counterexample { cases, .. }) => cases,
        }
    }
}

/// How often an interrupt is looked for.
const INTERVAL: Duration = Duration::from_millis(50);

/// A message from the thread that checks.
enum Message {
    Cases(u64),
    End(Result<u64, lemma::LemmaFailure>),
}

/// Checks a lemma on a thread of its own, so that an interrupt need not wait for the next case.
///
/// # Errors
/// Returns an error if the thread cannot be started or panics.
pub(super) fn check_lemma(lemma: &Lemma, watch: &dyn Watch) -> Result<LemmaCheck, CliError> {
    let start = Instant::now();
    let (sender, receiver) = mpsc::channel();
    let lemma_copy = *lemma;
    // After an interrupt there is no receiver.
    let work = move || {
        let result = lemma_copy.check(&mut |cases| drop(sender.send(Message::Cases(cases))));
        drop(sender.send(Message::End(result)));
    };
    let spawned = thread::Builder::new().name(lemma.name.to_owned()).spawn(work);
    spawned.map_err(|error| CliError::at(lemma.name, error))?;
    let mut cases = 0;
    let end = loop {
        match receiver.recv_timeout(INTERVAL) {
            Ok(Message::End(result)) => break CheckEnd::from(result),
            Ok(Message::Cases(so_far)) => {
                if cases == 0 {
                    watch.parts((lemma.exhaustive.cases / so_far.max(1)) as usize);
                }
                watch.part_done(so_far - cases);
                cases = so_far;
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => {
                return Err(CliError::at(lemma.name, "the check ended without a result"));
            }
        }
        if watch.stop() {
            break CheckEnd::Interrupted { cases };
        }
    };
    Ok(LemmaCheck { end, seconds: start.elapsed().as_secs_f64() })
}

impl From<Result<u64, lemma::LemmaFailure>> for CheckEnd {
    fn from(result: Result<u64, lemma::LemmaFailure>) -> Self {
        match result {
            Ok(cases) => Self::Holds { cases },
            Err(lemma::LemmaFailure::Case(counterexample)) => Self::Fails(counterexample),
            Err(lemma::LemmaFailure::Cases { pinned, found }) => Self::Miscounted { pinned, found },
        }
    }
}
