//! The progress bar of long work, and Ctrl-C.

use std::{
    process,
    sync::{
        Once,
        atomic::{AtomicBool, AtomicU64, Ordering},
    },
};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use toposlam_model::enumerate::Watch;

use super::Failure;

/// Set by the first Ctrl-C: the work stops soon.
static STOP: AtomicBool = AtomicBool::new(false);

/// Whether a second Ctrl-C also waits for the work to stop.
static ALWAYS_GRACEFUL: AtomicBool = AtomicBool::new(false);

/// A bar on standard error. It is hidden if that is not a terminal.
pub(crate) struct Progress {
    bar: ProgressBar,
    /// The noun for the cases.
    unit: &'static str,
    cases: AtomicU64,
}

impl Progress {
    /// Shows a bar for work on cases.
    pub(crate) fn new(work: &str, unit: &'static str) -> Result<Self, Failure> {
        watch_for_interrupt()?;
        let style = ProgressStyle::with_template(
            "{prefix} {wide_bar:.cyan/blue} {percent:>3} %  {msg}  {elapsed} done, {eta} to go",
        )
        .map_err(|error| Failure::at("progress bar", error))?;
        let bar = ProgressBar::new(0).with_style(style).with_prefix(work.to_owned());
        Ok(Self { bar, unit, cases: AtomicU64::new(0) })
    }

    /// Shows a bar for work of unknown length.
    pub(crate) fn endless(work: &str, unit: &'static str) -> Result<Self, Failure> {
        let progress = Self::new(work, unit)?;
        let style = ProgressStyle::with_template("{prefix} {spinner}  {msg}  {elapsed} done")
            .map_err(|error| Failure::at("progress bar", error))?;
        Ok(Self { bar: progress.bar.with_style(style), ..progress })
    }

    /// Also a second Ctrl-C waits for the work to stop: otherwise a robot would be left on its way.
    #[cfg(feature = "ros1")]
    pub(crate) fn always_graceful(self) -> Self {
        ALWAYS_GRACEFUL.store(true, Ordering::Relaxed);
        self
    }

    /// Removes the bar. Others may still ask whether the work must stop.
    #[cfg(feature = "ros1")]
    pub(crate) fn clear(&self) {
        self.bar.finish_and_clear();
    }

    /// Shows no bar: the work prints its own progress.
    pub(crate) fn hidden(self) -> Self {
        self.bar.set_draw_target(ProgressDrawTarget::hidden());
        self
    }

    /// Removes the bar.
    pub(crate) fn finish(self) {
        self.bar.finish_and_clear();
    }
}

impl Watch for Progress {
    fn parts(&self, count: usize) {
        self.bar.set_position(0);
        self.bar.set_length(count as u64);
    }

    fn part_done(&self, cases: u64) {
        let cases = self.cases.fetch_add(cases, Ordering::Relaxed) + cases;
        self.bar.inc(1);
        if !self.bar.is_hidden() {
            let rate = cases as f64 / self.bar.elapsed().as_secs_f64().max(1e-3);
            let (rate, times) = if rate < 1e4 { (rate, "") } else { (rate / 1e6, " million") };
            let unit = self.unit;
            self.bar.set_message(format!("{cases} {unit}, {rate:.2}{times} a second"));
        }
    }

    fn stop(&self) -> bool {
        STOP.load(Ordering::Relaxed)
    }
}

/// The first Ctrl-C stops the work soon, the second one at once.
fn watch_for_interrupt() -> Result<(), Failure> {
    static SET: Once = Once::new();
    let mut result = Ok(());
    SET.call_once(|| {
        result = ctrlc::set_handler(|| {
            if STOP.swap(true, Ordering::Relaxed) && !ALWAYS_GRACEFUL.load(Ordering::Relaxed) {
                process::exit(3);
            }
        });
    });
    result.map_err(|error| Failure::at("Ctrl-C", error))
}
