//! One lemma in every case within its bound, while somebody watches and may break it off.

use std::{
    sync::mpsc::{self, RecvTimeoutError},
    thread,
    time::{Duration, Instant},
};

use toposlam_model::enumerate::Watch;
use toposlam_proofs::{Counterexample, Lemma, lemma};

use crate::cli::Failure;

/// What became of a check, and how long it took.
pub(super) struct LemmaCheck {
    pub(super) ending: CheckEnd,
    pub(super) seconds: f64,
}

/// What became of a check.
pub(super) enum CheckEnd {
    /// The lemma holds in so many cases, which are all.
    Holds { cases: u64 },
    /// It fails in this case.
    Fails(Counterexample),
    /// It holds in all cases, but there are more or fewer of them than there must be.
    Miscounted { pinned: u64, found: u64 },
    /// The check was broken off; until then the lemma held in so many cases at least.
    Interrupted { cases: u64 },
}

impl CheckEnd {
    /// In how many cases the lemma holds; where it fails, in how many before that.
    pub(super) fn cases(&self) -> u64 {
        match *self {
            Self::Holds { cases }
            | Self::Interrupted { cases }
            | Self::Miscounted { found: cases, .. }
            | Self::Fails(Counterexample { cases, .. }) => cases,
        }
    }
}

/// How long a check may go on before anybody asks whether to break it off.
const PATIENCE: Duration = Duration::from_millis(50);

/// What is heard of a check.
enum News {
    Cases(u64),
    Ended(Result<u64, lemma::LemmaFailure>),
}

/// Checks a lemma.
///
/// It works on a thread of its own: whoever breaks off need not wait for the next case.
pub(super) fn check_lemma(lemma: &Lemma, watch: &impl Watch) -> Result<LemmaCheck, Failure> {
    let begun = Instant::now();
    let (teller, news) = mpsc::channel();
    let at_work = *lemma;
    // Whoever has broken off listens no more.
    let work = move || {
        let result = at_work.check(&mut |cases| drop(teller.send(News::Cases(cases))));
        drop(teller.send(News::Ended(result)));
    };
    let spawned = thread::Builder::new().name(lemma.name.to_owned()).spawn(work);
    spawned.map_err(|error| Failure::at(lemma.name, error))?;
    let mut cases = 0;
    let ending = loop {
        match news.recv_timeout(PATIENCE) {
            Ok(News::Ended(result)) => break CheckEnd::from(result),
            Ok(News::Cases(so_far)) => {
                if cases == 0 {
                    watch.parts((lemma.exhaustive.cases / so_far.max(1)) as usize);
                }
                watch.part_done(so_far - cases);
                cases = so_far;
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => {
                return Err(Failure::at(lemma.name, "the check came to no end"));
            }
        }
        if watch.stop() {
            break CheckEnd::Interrupted { cases };
        }
    };
    Ok(LemmaCheck { ending, seconds: begun.elapsed().as_secs_f64() })
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
