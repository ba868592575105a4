//! The progress bar of long work, and Ctrl-C.
//!
//! Long work asks its [`Watch`] whether to stop, so that it can report what it has. Work that does not ask
//! soon is ended.

use std::{
    sync::{
        Once,
        atomic::{AtomicBool, AtomicU64, Ordering},
    },
    thread,
    time::Duration,
};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use toposlam_model::enumerate::Watch;

use super::{Failure, output, report_output};

/// Set by the first Ctrl-C: the work stops soon.
static STOP: AtomicBool = AtomicBool::new(false);

/// Whether a second Ctrl-C also waits for the work to stop.
static ALWAYS_GRACEFUL: AtomicBool = AtomicBool::new(false);

/// Set when work has asked after Ctrl-C: it reports what it has.
static ANSWERED: AtomicBool = AtomicBool::new(false);

/// The time for work to ask whether to stop, and the time for it to report what it has.
const TO_ASK: Duration = Duration::from_millis(900);
const TO_REPORT: Duration = Duration::from_secs(10);

/// Whether work is to stop: after Ctrl-C, or if nobody reads its result.
pub(crate) fn must_stop() -> bool {
    let interrupted = STOP.load(Ordering::Relaxed);
    if interrupted {
        ANSWERED.store(true, Ordering::Relaxed);
    }
    interrupted || report_output::is_useless()
}

/// Stops work when [`must_stop`], without a bar.
pub(crate) struct StopSignal;

impl Watch for StopSignal {
    fn stop(&self) -> bool {
        must_stop()
    }
}

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
        must_stop()
    }
}

/// The first Ctrl-C stops the work soon, the second one at once. A file that is being written is completed.
fn watch_for_interrupt() -> Result<(), Failure> {
    static SET: Once = Once::new();
    let mut result = Ok(());
    SET.call_once(|| {
        result = ctrlc::set_handler(|| {
            let again = STOP.swap(true, Ordering::Relaxed);
            if ALWAYS_GRACEFUL.load(Ordering::Relaxed) {
                return;
            }
            if again {
                output::exit_between_files(3);
            }
            // Without a thread, the work still ends at its next question.
            let _ = thread::Builder::new().spawn(|| {
                thread::sleep(TO_ASK);
                if ANSWERED.load(Ordering::Relaxed) {
                    thread::sleep(TO_REPORT);
                }
                eprintln!("interrupted");
                output::exit_between_files(3);
            });
        });
    });
    result.map_err(|error| Failure::at("Ctrl-C", error))
}
