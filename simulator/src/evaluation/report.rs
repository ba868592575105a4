//! What all measurements report: verdicts and their tallies, in groups with something in common; rates, errors and
//! their targets.

use std::collections::BTreeMap;

use crate::evaluation::bound::{cases_needed, lower_bound, upper_bound};

use super::judged_view::SceneClass;
use crate::sample_verdict::{SampleTally, SampleVerdict};

/// Samples with something in common.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// The property by which they are grouped, and its value.
    pub by: &'static str,
    pub what: String,
    pub tally: SampleTally,
    /// Whether it is one of the two groups on either side of a median. The group up to the median comes first.
    pub is_half: bool,
}

impl Group {
    /// The share of samples that are not right; 0 without samples.
    pub fn rate(&self) -> f64 {
        self.tally.failed() as f64 / self.tally.all().max(1) as f64
    }
}

/// One group for each label, short labels first.
pub fn labelled<T>(
    samples: &[T],
    verdict: impl Fn(&T) -> SampleVerdict,
    by: &'static str,
    label: impl Fn(&T) -> String,
) -> Vec<Group> {
    let mut groups: BTreeMap<(usize, String), SampleTally> = BTreeMap::new();
    for sample in samples {
        let what = label(sample);
        groups.entry((what.len(), what)).or_default().add(verdict(sample));
    }
    let group = |((_, what), tally)| Group { by, what, tally, is_half: false };
    groups.into_iter().map(group).collect()
}

/// Two groups for each number that varies: the samples up to its median, and those above it.
pub fn halved<T>(
    samples: &[T],
    verdict: impl Fn(&T) -> SampleVerdict,
    numbers: impl Fn(&T) -> Vec<(&'static str, f64)>,
) -> Vec<Group> {
    let numbers: Vec<Vec<_>> = samples.iter().map(numbers).collect();
    let names = numbers.iter().max_by_key(|numbers| numbers.len());
    let mut groups = Vec::new();
    for &(by, _) in names.into_iter().flatten() {
        let with = samples.iter().zip(&numbers).filter_map(|(sample, numbers)| {
            let &(_, value) = numbers.iter().find(|(other, _)| *other == by)?;
            Some((verdict(sample), value))
        });
        let with: Vec<_> = with.collect();
        let values: ErrorSample = with.iter().map(|&(_, value)| value).collect();
        let Some(median) = values.quantile(0.5) else { continue };
        let half = |side: &str, above: bool| {
            let half = with.iter().filter(|&&(_, value)| (value > median) == above);
            let places = if median.abs() < 0.1 { 4 } else { 2 };
            let what = format!("{side} {median:.places$}");
            let tally = half.map(|&(verdict, _)| verdict).collect();
            Group { by, what, tally, is_half: true }
        };
        let halves = [half("up to", false), half("above", true)];
        if halves[1].tally.all() > 0 {
            groups.extend(halves);
        }
    }
    groups
}

/// The figures of a measurement of sensing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Figures {
    /// Rates of failures.
    pub rates: Vec<Rate>,
    pub errors: Vec<Errors>,
    /// What the samples that are not right have in common.
    pub groups: Vec<Group>,
    /// For each true class, the number of scenes of each class.
    pub confusion: BTreeMap<SceneClass, BTreeMap<SceneClass, usize>>,
}

impl Figures {
    /// Whether each target is met.
    pub fn statuses(&self) -> impl Iterator<Item = TargetStatus> + '_ {
        self.rates.iter().map(Rate::status).chain(self.errors.iter().map(Errors::status))
    }

    /// Whether all targets are met.
    pub fn status(&self) -> TargetStatus {
        self.statuses().max().unwrap_or(TargetStatus::NotShown)
    }
}

/// The rate of a failure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rate {
    /// The kind of the cases.
    pub of: &'static str,
    /// The failure, in a few words.
    pub what: &'static str,
    /// The number of failures.
    pub seen: usize,
    pub cases: usize,
    /// The target: the greatest allowed share of the cases.
    pub limit: Option<f64>,
}

/// The sizes of an error.
#[derive(Clone, Debug, PartialEq)]
pub struct Errors {
    pub of: &'static str,
    pub what: &'static str,
    pub unit: ErrorUnit,
    /// In metres or radians.
    pub sample: ErrorSample,
    /// The targets: quantiles and their greatest allowed values, in the unit.
    pub limits: Vec<(f64, f64)>,
}

/// A unit of output: its name, its abbreviation, and how many there are in a metre or a radian.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorUnit {
    pub name: &'static str,
    pub short: &'static str,
    pub factor: f64,
}

pub const DEGREES: ErrorUnit =
    ErrorUnit { name: "degrees", short: "deg", factor: 180.0 / std::f64::consts::PI };
pub const CENTIMETRES: ErrorUnit = ErrorUnit { name: "centimetres", short: "cm", factor: 100.0 };

/// The quantiles that are reported, with their names.
pub const QUANTILES: [(f64, &str); 4] =
    [(0.5, "median"), (0.95, "95 %"), (0.99, "99 %"), (1.0, "most")];

toposlam_model::words! {
    /// Whether a target is met, by the one-sided intervals of the rate with a confidence of 95 %.
    TargetStatus {
        /// The upper bound is within the target, or there is no target.
        Met = "met",
        /// The target lies between the bounds: the sample is too small.
        NotShown = "not shown",
        /// The lower bound is beyond the target.
        Missed = "missed",
    }
}

impl TargetStatus {
    /// The status of a greatest allowed rate.
    pub fn from_counts(seen: usize, cases: usize, limit: f64) -> Self {
        if lower_bound(seen, cases) > limit {
            Self::Missed
        } else if upper_bound(seen, cases) <= shown_as(limit) {
            Self::Met
        } else {
            Self::NotShown
        }
    }
}

/// No sample shows that something never happens. A target of 0 is met if it was not seen, and the rate is
/// at most this.
const NEVER: f64 = 0.001;

/// The rate that must be shown for a target.
fn shown_as(limit: f64) -> f64 {
    if limit > 0.0 { limit } else { NEVER }
}

impl Rate {
    /// The rate of a failure of samples. `fails` returns `None` for those that do not count.
    pub fn counted<T>(
        of: &'static str,
        what: &'static str,
        limit: Option<f64>,
        samples: &[T],
        fails: impl Fn(&T) -> Option<bool>,
    ) -> Self {
        let cases = samples.iter().filter_map(fails);
        let (seen, cases) =
            cases.fold((0, 0), |(seen, cases), fails| (seen + usize::from(fails), cases + 1));
        Self { of, what, seen, cases, limit }
    }

    /// The share of failures; `None` without cases.
    pub fn rate(&self) -> Option<f64> {
        (self.cases > 0).then(|| self.seen as f64 / self.cases as f64)
    }

    /// The upper bound of the rate, with a confidence of 95 %.
    pub fn upper_bound(&self) -> f64 {
        upper_bound(self.seen, self.cases)
    }

    pub fn status(&self) -> TargetStatus {
        let status = |limit| TargetStatus::from_counts(self.seen, self.cases, limit);
        self.limit.map_or(TargetStatus::Met, status)
    }

    /// The least number of cases, all without a failure, that meet the target.
    pub fn cases_needed(&self) -> Option<usize> {
        self.limit.map(|limit| cases_needed(shown_as(limit)))
    }
}

impl Errors {
    /// The error below which this share of the errors lies, in the unit.
    pub fn quantile(&self, part: f64) -> Option<f64> {
        self.sample.quantile(part).map(|value| value * self.unit.factor)
    }

    /// Whether the targets are met: a quantile is at most its limit if no more than the rest of the errors
    /// exceed the limit.
    pub fn status(&self) -> TargetStatus {
        let statuses = self.limits.iter().map(|&(part, limit)| {
            let exceeding = self.sample.exceeding(limit / self.unit.factor);
            TargetStatus::from_counts(exceeding, self.sample.0.len(), 1.0 - part)
        });
        statuses.max().unwrap_or(TargetStatus::Met)
    }

    /// The least number of cases, none beyond its limit, that meet the targets.
    pub fn cases_needed(&self) -> Option<usize> {
        self.limits.iter().map(|(part, _)| cases_needed(shown_as(1.0 - part))).max()
    }
}

/// Values in ascending order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ErrorSample(Vec<f64>);

impl FromIterator<f64> for ErrorSample {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        let mut values: Vec<_> = values.into_iter().collect();
        values.sort_by(f64::total_cmp);
        Self(values)
    }
}

impl ErrorSample {
    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// The number of values greater than a limit.
    fn exceeding(&self, limit: f64) -> usize {
        self.0.len() - self.0.partition_point(|value| *value <= limit)
    }

    /// The value below which this share of the values lies, from 0 to 1; `None` without values.
    /// Between two values it is interpolated (Hyndman and Fan 1996, definition 7, as in R and
    /// NumPy).
    pub fn quantile(&self, part: f64) -> Option<f64> {
        let at = part.clamp(0.0, 1.0) * (self.0.len().checked_sub(1)? as f64);
        let [low, high] = [at.floor(), at.ceil()].map(|at| self.0[at as usize]);
        Some(low + (high - low) * at.fract())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_target_is_met_missed_or_not_shown() {
        for (seen, cases, limit, status) in [
            (0, 0, 0.005, TargetStatus::NotShown),
            (0, 11, 0.005, TargetStatus::NotShown),
            (0, 597, 0.005, TargetStatus::NotShown),
            (0, 598, 0.005, TargetStatus::Met),
            // More than allowed, but it may be chance: the interval begins at 0.085 %.
            (1, 60, 0.005, TargetStatus::NotShown),
            (9, 60, 0.005, TargetStatus::Missed),
            // What must never happen is missed by one case.
            (1, 100_000, 0.0, TargetStatus::Missed),
            (0, 2_994, 0.0, TargetStatus::NotShown),
            (0, 2_995, 0.0, TargetStatus::Met),
        ] {
            let found = TargetStatus::from_counts(seen, cases, limit);
            assert_eq!(found, status, "{seen} of {cases}, {limit}");
        }
    }

    #[test]
    fn a_quantile_is_met_by_the_share_of_greater_errors() {
        for (count, greater, status) in [
            (298, 0, TargetStatus::NotShown),
            (299, 0, TargetStatus::Met),
            (299, 1, TargetStatus::NotShown),
            (299, 10, TargetStatus::Missed),
        ] {
            let degrees = |case| if case < greater { 5.0_f64 } else { 1.0 };
            let errors = Errors {
                of: "hallway",
                what: "direction",
                unit: DEGREES,
                sample: (0..count).map(|case| degrees(case).to_radians()).collect(),
                limits: vec![(0.99, 4.0)],
            };
            assert_eq!(errors.status(), status, "{greater} of {count}");
            assert_eq!(errors.cases_needed(), Some(299));
        }
    }

    #[test]
    fn quantiles_are_those_of_definition_7_and_a_value_at_the_limit_does_not_exceed_it() {
        // quantile(c(15, 20, 35, 40, 50), c(0, 0.05, 0.4, 0.5, 0.95, 1)) in R.
        let sample: ErrorSample = [40.0, 15.0, 50.0, 35.0, 20.0].into_iter().collect();
        for (part, value) in
            [(0.0, 15.0), (0.05, 16.0), (0.4, 29.0), (0.5, 35.0), (0.95, 48.0), (1.0, 50.0)]
        {
            let found = sample.quantile(part).unwrap();
            assert!((found - value).abs() < 1e-12, "{part}: {found}");
        }
        assert_eq!(ErrorSample::default().quantile(0.5), None);
        let sample: ErrorSample = [3.0, 1.0, 2.0, 2.0].into_iter().collect();
        assert_eq!([0.5, 1.0, 2.0, 3.0].map(|limit| sample.exceeding(limit)), [4, 3, 1, 0]);
    }

    #[test]
    fn samples_are_grouped_by_labels_and_on_both_sides_of_a_median() {
        // Of the numbers up to 20, those above 15 are wrong, and 3 is undecided.
        let numbers: Vec<u32> = (1..=20).collect();
        let verdict = |&number: &u32| match number {
            3 => SampleVerdict::Undecided,
            16.. => SampleVerdict::Wrong,
            _ => SampleVerdict::Right,
        };
        let by_digits =
            labelled(&numbers, verdict, "digits", |number| number.to_string().len().to_string());
        let tallies: Vec<_> = by_digits.iter().map(|group| (&*group.what, group.tally)).collect();
        let [one, two] = [
            SampleTally { right: 8, undecided: 1, wrong: 0 },
            SampleTally { right: 6, undecided: 0, wrong: 5 },
        ];
        assert_eq!(tallies, [("1", one), ("2", two)]);
        let halves =
            halved(&numbers, verdict, |&number| vec![("size", number.into()), ("one", 1.0)]);
        let rates: Vec<_> = halves.iter().map(|group| (&*group.what, group.rate())).collect();
        assert_eq!(rates, [("up to 10.50", 0.1), ("above 10.50", 0.5)], "one number does not vary");
    }
}
