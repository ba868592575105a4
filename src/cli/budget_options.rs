//! The options of what a robot may spend.

use toposlam_robot::budget::RunBudget;

/// What a robot may spend.
#[derive(Clone, Copy, Debug, clap::Args)]
pub(super) struct BudgetOptions {
    /// Return to the marker before this number of moves is over
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    max_moves: Option<u64>,
    /// Return to the marker before this time is over, in minutes of the robot's clock
    #[arg(long, value_name = "MINUTES", allow_hyphen_values = true, value_parser = positive)]
    max_minutes: Option<f64>,
    /// Return to the marker before the battery is empty: the part of it that one metre takes, as in 0.001
    #[arg(long, value_name = "SHARE", allow_hyphen_values = true, value_parser = share)]
    battery_per_metre: Option<f64>,
}

impl BudgetOptions {
    pub(super) fn budget(self) -> RunBudget {
        RunBudget {
            moves: self.max_moves,
            seconds: self.max_minutes.map(|minutes| 60.0 * minutes),
            metres: self.battery_per_metre.map(|share| 1.0 / share),
        }
    }

    /// The options that give a budget again.
    pub(super) fn words(self) -> Vec<String> {
        let moves = self.max_moves.map(|moves| ["--max-moves".to_owned(), moves.to_string()]);
        let time = self.max_minutes.map(|time| ["--max-minutes".to_owned(), time.to_string()]);
        let battery = self
            .battery_per_metre
            .map(|share| ["--battery-per-metre".to_owned(), share.to_string()]);
        [moves, time, battery].into_iter().flatten().flatten().collect()
    }
}

fn positive(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| *number > 0.0 && number.is_finite());
    number.ok_or_else(|| "expected a number greater than 0".to_owned())
}

fn share(text: &str) -> Result<f64, String> {
    let share = text.parse().ok().filter(|share: &f64| *share > 0.0 && *share <= 1.0);
    share.ok_or_else(|| "expected a number greater than 0, and at most 1".to_owned())
}
