//! Progress of long work on a terminal, and Ctrl-C.

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

/// Whether somebody wants the work to end.
static STOP: AtomicBool = AtomicBool::new(false);

/// Whether it ends in good order however often somebody wants it.
static PATIENT: AtomicBool = AtomicBool::new(false);

/// A bar on standard error, hidden where that is no terminal.
pub(crate) struct Progress {
    bar: ProgressBar,
    /// What the cases are called.
    unit: &'static str,
    cases: AtomicU64,
}

impl Progress {
    /// Shows a bar for some work, on cases that are called so.
    pub(crate) fn new(work: &str, unit: &'static str) -> Result<Self, Failure> {
        watch_for_interrupt()?;
        let style = ProgressStyle::with_template(
            "{prefix} {wide_bar:.cyan/blue} {percent:>3} %  {msg}  {elapsed} done, {eta} to go",
        )
        .map_err(|error| Failure::at("progress bar", error))?;
        let bar = ProgressBar::new(0).with_style(style).with_prefix(work.to_owned());
        Ok(Self { bar, unit, cases: AtomicU64::new(0) })
    }

    /// The same for work whose end nobody knows.
    pub(crate) fn endless(work: &str, unit: &'static str) -> Result<Self, Failure> {
        let progress = Self::new(work, unit)?;
        let style = ProgressStyle::with_template("{prefix} {spinner}  {msg}  {elapsed} done")
            .map_err(|error| Failure::at("progress bar", error))?;
        Ok(Self { bar: progress.bar.with_style(style), ..progress })
    }

    /// The same for work that is never to end at once, as it would leave a robot on its way; it ends
    /// soon.
    #[cfg(feature = "ros1")]
    pub(crate) fn always_in_good_order(self) -> Self {
        PATIENT.store(true, Ordering::Relaxed);
        self
    }

    /// Takes the bar away where somebody else still asks whether the work is to end.
    #[cfg(feature = "ros1")]
    pub(crate) fn clear(&self) {
        self.bar.finish_and_clear();
    }

    /// The same without a bar, where the work tells of itself.
    pub(crate) fn hidden(self) -> Self {
        self.bar.set_draw_target(ProgressDrawTarget::hidden());
        self
    }

    /// Takes the bar away.
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

/// The first Ctrl-C ends the work in good order, the second at once.
fn watch_for_interrupt() -> Result<(), Failure> {
    static SET: Once = Once::new();
    let mut result = Ok(());
    SET.call_once(|| {
        result = ctrlc::set_handler(|| {
            if STOP.swap(true, Ordering::Relaxed) && !PATIENT.load(Ordering::Relaxed) {
                process::exit(3);
            }
        });
    });
    result.map_err(|error| Failure::at("Ctrl-C", error))
}
