//! Progress of a long check on a terminal, and Ctrl-C.

use std::{
    process,
    sync::{
        Once,
        atomic::{AtomicBool, AtomicU64, Ordering},
    },
};

use indicatif::{ProgressBar, ProgressStyle};
use toposlam_model::enumerate::Watch;

use crate::cli::Failure;

/// Whether somebody wants the check to end.
static STOP: AtomicBool = AtomicBool::new(false);

/// A bar on standard error, hidden where that is no terminal.
pub(super) struct Progress {
    bar: ProgressBar,
    starts: AtomicU64,
}

impl Progress {
    /// Shows a bar for worlds with `edges` edges.
    pub(super) fn new(edges: usize) -> Result<Self, Failure> {
        watch_for_interrupt()?;
        let style = ProgressStyle::with_template(
            "{prefix} {wide_bar:.cyan/blue} {percent:>3} %  {msg}  {elapsed} done, {eta} to go",
        )
        .map_err(|error| Failure::at("progress bar", error))?;
        let bar = ProgressBar::new(0).with_style(style).with_prefix(format!("{edges} edges"));
        Ok(Self { bar, starts: AtomicU64::new(0) })
    }

    /// Takes the bar away.
    pub(super) fn finish(self) {
        self.bar.finish_and_clear();
    }
}

impl Watch for Progress {
    fn parts(&self, count: usize) {
        self.bar.set_length(count as u64);
    }

    fn part_done(&self, cases: u64) {
        let starts = self.starts.fetch_add(cases, Ordering::Relaxed) + cases;
        self.bar.inc(1);
        if !self.bar.is_hidden() {
            let rate = starts as f64 / self.bar.elapsed().as_secs_f64().max(1e-3);
            self.bar.set_message(format!("{starts} starts, {:.2} million a second", rate / 1e6));
        }
    }

    fn stop(&self) -> bool {
        STOP.load(Ordering::Relaxed)
    }
}

/// The first Ctrl-C ends the check in good order, the second at once.
fn watch_for_interrupt() -> Result<(), Failure> {
    static SET: Once = Once::new();
    let mut result = Ok(());
    SET.call_once(|| {
        result = ctrlc::set_handler(|| {
            if STOP.swap(true, Ordering::Relaxed) {
                process::exit(3);
            }
        });
    });
    result.map_err(|error| Failure::at("Ctrl-C", error))
}
