//! The progress bar of long work, and Ctrl-C.
//!
//! Long work asks its [`Watch`] whether to stop, so that it can report what it has. Other work is ended.

use std::{
    fmt,
    sync::atomic::{AtomicBool, AtomicU64, Ordering},
    thread,
    time::Duration,
};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use toposlam_model::enumerate::Watch;

use super::{
    CliError, output, report_output, terminal,
    text::{duration_text, grouped, rough},
};

/// Set by the first Ctrl-C: the work stops soon.
static STOP: AtomicBool = AtomicBool::new(false);

/// Whether a second Ctrl-C also waits for the work to stop.
static ALWAYS_GRACEFUL: AtomicBool = AtomicBool::new(false);

/// Set when work asks whether to stop.
static ASKS: AtomicBool = AtomicBool::new(false);

/// Set when work has asked after Ctrl-C: it reports what it has.
static ANSWERED: AtomicBool = AtomicBool::new(false);

/// The time for work to ask whether to stop, and the time for it to report what it has.
const TO_ASK: Duration = Duration::from_millis(900);
const TO_REPORT: Duration = Duration::from_secs(10);

/// The time between two drawings of a bar that shows the time.
const TICK: Duration = Duration::from_millis(200);

/// Whether work is to stop: after Ctrl-C, or if nobody reads its result.
pub fn must_stop() -> bool {
    ASKS.store(true, Ordering::Relaxed);
    let interrupted = STOP.load(Ordering::Relaxed);
    if interrupted {
        ANSWERED.store(true, Ordering::Relaxed);
    }
    interrupted || report_output::is_useless()
}

/// Lets the work stop, as after Ctrl-C.
pub fn request_stop() {
    STOP.store(true, Ordering::Relaxed);
}

/// From now on a second Ctrl-C, too, waits for the work to stop: otherwise a robot would be left on its way.
pub fn always_stop_gracefully() {
    ALWAYS_GRACEFUL.store(true, Ordering::Relaxed);
}

/// Stops work when [`must_stop`], without a bar.
pub struct StopSignal;

impl Watch for StopSignal {
    fn stop(&self) -> bool {
        must_stop()
    }
}

/// A bar on standard error. It is hidden if that is not a terminal.
pub struct Progress {
    bar: ProgressBar,
    /// The noun for the cases.
    unit: &'static str,
    /// Whether the length of the work is unknown: then the bar shows the time.
    is_endless: bool,
    cases: AtomicU64,
}

impl Progress {
    /// Shows a bar for work on cases.
    pub fn new(work: &str, unit: &'static str) -> Result<Self, CliError> {
        let bar = if terminal::has_colors() { "{bar:12.cyan/blue}" } else { "{bar:12}" };
        // The message is cut at the end of the line.
        let template = format!("{{prefix}} {bar} {{percent:>3}} %  {{wide_msg}}");
        let style = ProgressStyle::with_template(&template)
            .map_err(|error| CliError::at("progress bar", error))?;
        // Without a length, no part is done; with length 0, all would be.
        let bar = ProgressBar::no_length().with_style(style).with_prefix(shortened(work));
        if terminal::is_quiet() {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        Ok(Self { bar, unit, is_endless: false, cases: AtomicU64::new(0) })
    }

    /// Shows the time of work of unknown length. It moves even if no part is done for long.
    pub fn endless(work: &str, unit: &'static str) -> Result<Self, CliError> {
        let progress = Self::new(work, unit)?;
        let style = ProgressStyle::with_template("{prefix} {spinner}  {time}  {wide_msg}")
            .map_err(|error| CliError::at("progress bar", error))?;
        let style = style.with_key("time", |state: &ProgressState, out: &mut dyn fmt::Write| {
            // A line that cannot be drawn is left out.
            let _ = out.write_str(&duration_text(state.elapsed().as_secs_f64()));
        });
        let bar = progress.bar.with_style(style);
        if !bar.is_hidden() {
            bar.enable_steady_tick(TICK);
        }
        Ok(Self { bar, is_endless: true, ..progress })
    }

    /// The next work.
    pub fn next(&self, work: &str) {
        self.bar.set_prefix(shortened(work));
        self.bar.set_message("");
        self.cases.store(0, Ordering::Relaxed);
        self.bar.reset_elapsed();
    }

    /// Shows no bar: the work prints its own progress.
    #[must_use]
    pub fn hidden(self) -> Self {
        self.bar.set_draw_target(ProgressDrawTarget::hidden());
        self
    }

    pub fn finish(self) {
        self.bar.finish_and_clear();
    }
}

impl Watch for Progress {
    fn parts(&self, count: usize) {
        self.bar.set_position(0);
        // All of nothing would be 100 %.
        self.bar.set_length(count.max(1) as u64);
    }

    fn part_done(&self, cases: u64) {
        let cases = self.cases.fetch_add(cases, Ordering::Relaxed) + cases;
        if !self.bar.is_hidden() {
            let seconds = self.bar.elapsed().as_secs_f64();
            let parts = [self.bar.position() + 1, self.bar.length().unwrap_or(0)];
            let rate = rate_text(seconds, cases, self.unit);
            self.bar.set_message(if self.is_endless {
                rate
            } else {
                format!("{}  {rate}", time_text(seconds, parts))
            });
        }
        self.bar.inc(1);
    }

    fn stop(&self) -> bool {
        must_stop()
    }
}

/// The work in at most 28 columns: with the bar and the time left, it fits in 60.
fn shortened(work: &str) -> String {
    const WIDEST: usize = 28;
    if work.chars().count() <= WIDEST {
        return work.to_owned();
    }
    let beginning: String = work.chars().take(WIDEST - 1).collect();
    beginning + "…"
}

/// The time that is left, or that has passed. `parts` are the number of parts that are done, and of all parts; 0 if
/// that is not known. In the first second too little is known.
fn time_text(seconds: f64, [done, all]: [u64; 2]) -> String {
    if seconds >= 1.0 && all > done && done > 0 {
        let left = seconds / done as f64 * (all - done) as f64;
        format!("{} left", duration_text(left))
    } else {
        duration_text(seconds)
    }
}

/// The number of cases, and how many there are in a second. The end of a long line is cut.
fn rate_text(seconds: f64, cases: u64, unit: &str) -> String {
    let rate = rough(cases as f64 / seconds.max(1e-3));
    format!("{} {unit}, {rate} a second", grouped(cases.into()))
}

/// From now on the first Ctrl-C, or another signal to terminate, stops work that asks soon, and all else at once; so does
/// the second one. A file that is being written is completed.
pub fn watch_for_interrupt() -> Result<(), CliError> {
    let handler = ctrlc::set_handler(|| {
        let again = STOP.swap(true, Ordering::Relaxed);
        if ALWAYS_GRACEFUL.load(Ordering::Relaxed) {
            return;
        }
        if again {
            output::exit_between_files(3);
        }
        // Without a thread, the work still ends at its next question.
        let _ = thread::Builder::new().spawn(|| {
            if ASKS.load(Ordering::Relaxed) {
                thread::sleep(TO_ASK);
            }
            if ANSWERED.load(Ordering::Relaxed) {
                thread::sleep(TO_REPORT);
            }
            terminal::print_message("interrupted\n");
            output::exit_between_files(3);
        });
    });
    handler.map_err(|error| CliError::at("Ctrl-C", error))
}

#[cfg(test)]
mod tests {
    use std::{
        io,
        sync::{Arc, Mutex},
    };

    use indicatif::TermLike;
    use textwrap::core::display_width;

    use super::*;

    #[test]
    fn the_time_left_is_known_after_a_second() {
        assert_eq!(time_text(2.0, [1, 4]), "6 s left");
        assert_eq!(time_text(0.001, [1, 400]), "0 s");
        assert_eq!(time_text(2.0, [4, 4]), "2 s");
        assert_eq!(time_text(90.0, [7, 0]), "1 min 30 s");
        assert_eq!(rate_text(2.0, 12_345, "starts"), "12,345 starts, 6,200 a second");
        assert_eq!(rate_text(90.0, 7, "moves"), "7 moves, 0.08 a second");
    }

    #[test]
    fn the_time_of_work_without_parts_moves() {
        let terminal = Recorded::default();
        let progress = Progress::endless("comparing", "starts").unwrap();
        let target = ProgressDrawTarget::term_like_with_hz(Box::new(terminal.clone()), 255);
        progress.bar.set_draw_target(target);
        progress.bar.enable_steady_tick(Duration::from_millis(5));
        while !terminal
            .0
            .lock()
            .unwrap()
            .iter()
            .any(|line| line.contains("comparing") && line.contains(" 1 s"))
        {
            thread::sleep(Duration::from_millis(5));
        }
        progress.finish();
    }

    /// What is drawn on a terminal of 60 columns.
    #[derive(Clone, Debug, Default)]
    struct Recorded(Arc<Mutex<Vec<String>>>);

    impl TermLike for Recorded {
        fn width(&self) -> u16 {
            60
        }
        fn move_cursor_up(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn move_cursor_down(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn move_cursor_right(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn move_cursor_left(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn write_line(&self, text: &str) -> io::Result<()> {
            self.write_str(text)
        }
        fn write_str(&self, text: &str) -> io::Result<()> {
            self.0.lock().unwrap().push(text.to_owned());
            Ok(())
        }
        fn clear_line(&self) -> io::Result<()> {
            Ok(())
        }
        fn flush(&self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_bar_fits_on_a_line_of_60_columns_and_ends_without_time_left() {
        let name = "a_confirmed_hypothesis_is_right_and_a_refuted_one_is_wrong";
        for (parts, work) in [(3, name), (1, "1 edges"), (0, "6 edges")] {
            let terminal = Recorded::default();
            let progress = Progress::new(work, "placed worlds").unwrap();
            let target = ProgressDrawTarget::term_like_with_hz(Box::new(terminal.clone()), 255);
            progress.bar.set_draw_target(target);
            progress.parts(parts);
            for _ in 0..parts.max(1) {
                thread::sleep(Duration::from_millis(10));
                progress.part_done(1_234_567);
            }
            let drawn = terminal.0.lock().unwrap().clone();
            let lines: Vec<_> = drawn.iter().filter(|line| line.contains('%')).collect();
            assert!(lines.iter().all(|line| display_width(line.trim_end()) <= 60), "{lines:#?}");
            assert!(lines[0].contains("  0 %"), "{lines:#?}");
            assert!(lines.iter().all(|line| !line.contains("0 s left")), "{lines:#?}");
            progress.finish();
        }
    }
}
