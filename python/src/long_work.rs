//! Long work: without the interpreter lock, on threads of its own, while the thread of the caller handles signals and
//! shows progress. The threads end with the work: a process that is forked does not have its parent's.

use std::{
    panic::{AssertUnwindSafe, catch_unwind},
    sync::{
        atomic::{AtomicBool, AtomicU64, Ordering},
        mpsc,
    },
    thread,
    time::Duration,
};

use pyo3::prelude::*;
use rayon::ThreadPoolBuilder;
use toposlam_model::enumerate::{Watch, threads};

use crate::error::{error, internal};

/// Counts the cases that are done, and stops the work.
#[derive(Default)]
pub(crate) struct Watcher {
    done: AtomicU64,
    stopped: AtomicBool,
}

impl Watcher {
    /// Stops the work at its next question.
    pub(crate) fn stop_work(&self) {
        self.stopped.store(true, Ordering::Relaxed);
    }

    pub(crate) fn count(&self, cases: u64) {
        self.done.fetch_add(cases, Ordering::Relaxed);
    }
}

impl Watch for Watcher {
    fn part_done(&self, cases: u64) {
        self.count(cases);
    }

    fn stop(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }
}

/// How long the caller's thread waits before it looks at signals again.
const PATIENCE: Duration = Duration::from_millis(50);

/// Does long work. `progress` is called with the number of cases since the last call. After a signal the work
/// is stopped, and the exception of the signal is raised. If the work calls functions in Python, it does so in one
/// thread, always in the same order, and the method `stop` of `calls` ends such a call.
pub(crate) fn run_watched<R: Send>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    calls: Option<&Py<PyAny>>,
    work: impl FnOnce(&Watcher) -> R + Send,
) -> PyResult<R> {
    let watcher = Watcher::default();
    let threads = if calls.is_some() { 1 } else { threads() };
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|cause| error(py, "InternalError", cause))?;
    let progress = progress.map(|progress| progress.clone().unbind());
    let result = py.detach(|| {
        thread::scope(|scope| {
            let (done, end) = mpsc::channel();
            let (shared, pool) = (&watcher, &pool);
            scope.spawn(move || {
                let result = catch_unwind(AssertUnwindSafe(|| pool.install(|| work(shared))));
                // The caller waits for it.
                let _ = done.send(result);
            });
            let mut shown = 0;
            loop {
                let ended = end.recv_timeout(PATIENCE);
                let signalled: PyResult<()> = Python::attach(|py| {
                    py.check_signals()?;
                    let counted = watcher.done.load(Ordering::Relaxed);
                    if let Some(progress) = &progress
                        && counted > shown
                    {
                        progress.call1(py, (counted - shown,))?;
                        shown = counted;
                    }
                    Ok(())
                });
                if let Err(signal) = signalled {
                    watcher.stop_work();
                    // A call may catch the exception that ends it, so it is raised until the work has ended.
                    while matches!(end.recv_timeout(PATIENCE), Err(mpsc::RecvTimeoutError::Timeout))
                    {
                        if let Some(calls) = calls {
                            Python::attach(|py| calls.call_method0(py, "stop").map(drop))?;
                        }
                    }
                    return Err(signal);
                }
                match ended {
                    Ok(result) => return Ok(result.ok()),
                    Err(mpsc::RecvTimeoutError::Timeout) => {}
                    Err(mpsc::RecvTimeoutError::Disconnected) => return Ok(None),
                }
            }
        })
    })?;
    result.ok_or_else(|| internal(py))
}
