//! `check --estimate`: what a check will take, by random probes of the tree of all runs.
//!
//! D. E. Knuth, "Estimating the efficiency of backtrack programs" (1975): a probe goes down the tree and draws one
//! of the `n` branches at each node. A count below, times the product of the `n`, has the count of the whole
//! tree as its expected value. Here a probe draws until [`COMPLETE`] edges are left, and the subtree below is
//! searched completely, which makes the spread smaller.
//!
//! The time of a probe is no sample of the time of the check: the way down to its subtree is walked once for each
//! probe, and once for many subtrees in the check. So the time is that of the moves that the check makes, and a
//! smaller check measures how long a move takes.

use std::{io::Write, time::Instant};

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::Serialize;
use toposlam_model::{
    check::{Shard, SharedPrefixCheck},
    enumerate::{Class, Watch},
    mapping::MappingAlgorithm,
};

use crate::cli::{
    CliError, Outcome,
    json::print_line,
    progress::StopSignal,
    text::{counted, duration_text, grouped, print_paragraph},
};

/// The edges that are left where a probe no longer draws.
const COMPLETE: usize = 4;

/// A smaller check that takes as long as this measures the time of a move, in seconds.
const MEASURED: f64 = 0.1;

/// 95 % of a normal distribution are within this many standard deviations of its mean.
const STANDARD_DEVIATIONS: f64 = 1.96;

#[derive(clap::Args, Debug)]
pub(super) struct EstimateOptions {
    /// Do not check: predict starts, moves and time by random probes, 10000 or this many, with 95 %
    /// confidence intervals
    #[arg(long, value_name = "PROBES", num_args = 0..=1, default_missing_value = "10000", require_equals = true,
        value_parser = clap::value_parser!(u32).range(2..), conflicts_with_all = ["choices", "from", "shard", "worst", "failed", "journal", "report", "keep_going"])]
    pub(super) estimate: Option<u32>,

    /// With --estimate: random seed [default: 1]
    #[arg(long, value_name = "N", requires = "estimate", conflicts_with = "choices")]
    seed: Option<u64>,
}

/// The mean of a sample, and its standard error.
#[derive(Clone, Copy, Debug, Default)]
struct Sample {
    count: f64,
    mean: f64,
    /// The sum of the squares of the differences from the mean.
    squares: f64,
}

impl Sample {
    /// Adds a value (Welford's algorithm).
    fn add(&mut self, value: f64) {
        self.count += 1.0;
        let before = value - self.mean;
        self.mean += before / self.count;
        self.squares += before * (value - self.mean);
    }

    fn interval(self) -> Interval {
        let error = (self.squares / (self.count - 1.0) / self.count).sqrt();
        let bound = |times: f64| (self.mean + times * error).max(0.0);
        let [low, high] = [-STANDARD_DEVIATIONS, STANDARD_DEVIATIONS].map(bound);
        Interval { mean: self.mean, low, high }
    }
}

/// A mean with its 95 % confidence interval.
#[derive(Clone, Copy, Debug, Serialize)]
struct Interval {
    mean: f64,
    low: f64,
    high: f64,
}

impl Interval {
    fn text(self, number: impl Fn(f64) -> String) -> String {
        format!("{} ({} to {})", number(self.mean), number(self.low), number(self.high))
    }

    /// The product of two quantities.
    fn times(self, Self { mean, low, high }: Self) -> Self {
        Self { mean: self.mean * mean, low: self.low * low, high: self.high * high }
    }
}

/// The seconds that one move of a check takes on all threads, by complete checks of smaller sizes: the mean is that
/// of the largest one, and the interval is as wide to each side as its difference from the one before.
fn seconds_a_move(class: Class, edges: usize, algorithm: MappingAlgorithm) -> Option<Interval> {
    let mut times = Vec::new();
    for size in 1..=edges {
        let sweep = SharedPrefixCheck::new(class, size, Shard::WHOLE).ok()?;
        let begun = Instant::now();
        let check = algorithm.lazy_sweep(&sweep, &(), &StopSignal);
        let elapsed = begun.elapsed().as_secs_f64();
        if check.moves_made > 0 {
            times.push(elapsed / check.moves_made as f64);
        }
        if elapsed >= MEASURED {
            break;
        }
    }
    let mean = *times.last()?;
    let before = times.iter().rev().nth(1).copied().unwrap_or(mean);
    let difference = (mean - before).abs();
    Some(Interval { mean, low: (mean - difference).max(0.0), high: mean + difference })
}

/// What a check will take.
#[derive(Serialize)]
struct EstimateLine<'a> {
    edges: usize,
    class: &'a str,
    marker: &'a str,
    algorithm: &'a str,
    probes: u32,
    seed: u64,
    /// This and what follows is not known if no probe found a start.
    starts: Option<Interval>,
    /// Of one run for each start.
    moves_total: Option<Interval>,
    moves_made: Option<Interval>,
    /// On `threads` threads.
    seconds: Option<Interval>,
    threads: usize,
}

impl EstimateOptions {
    /// Prints the estimate for one number of edges. It is not known if no probe found a start.
    pub(super) fn print(
        &self,
        (edges, sweep): (usize, &SharedPrefixCheck),
        algorithm: MappingAlgorithm,
        json: bool,
        watch: &dyn Watch,
        out: &mut dyn Write,
    ) -> Result<Outcome, CliError> {
        let (probes, seed) = (self.estimate.unwrap_or_default(), self.seed.unwrap_or(1));
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let [mut starts, mut total, mut made] = [Sample::default(); 3];
        watch.parts(probes as usize);
        for _ in 0..probes {
            // One for the start vertex, and one for each edge.
            let draws = 1 + edges.saturating_sub(COMPLETE);
            let numbers = (0..draws).map(|_| random.random()).collect();
            let probe = algorithm.probe(sweep, numbers, watch);
            if watch.stop() {
                return Err(CliError::Interrupted);
            }
            starts.add(probe.weight * probe.tally.starts as f64);
            total.add(probe.weight * probe.tally.moves_total as f64);
            made.add(probe.weight * probe.tally.moves_made as f64);
            watch.part_done(probe.tally.starts);
        }
        let is_known = starts.mean > 0.0;
        let moves_made = made.interval();
        let a_move = is_known.then(|| seconds_a_move(sweep.class(), edges, algorithm)).flatten();
        if watch.stop() {
            return Err(CliError::Interrupted);
        }
        let line = EstimateLine {
            edges,
            class: sweep.class().name(),
            marker: algorithm.aid().name(),
            algorithm: algorithm.info().title,
            probes,
            seed,
            starts: is_known.then(|| starts.interval()),
            moves_total: is_known.then(|| total.interval()),
            moves_made: is_known.then_some(moves_made),
            seconds: a_move.map(|a_move| moves_made.times(a_move)),
            threads: rayon::current_num_threads(),
        };
        if json {
            print_line(out, "estimate", &line)?;
        } else {
            line.print(out)?;
        }
        Ok(if is_known { Outcome::Holds } else { Outcome::Incomplete })
    }
}

impl EstimateLine<'_> {
    fn print(&self, out: &mut dyn Write) -> Result<(), CliError> {
        fn whole(number: f64) -> String {
            grouped(number.round() as u128)
        }
        let text = |interval: Option<Interval>, number: fn(f64) -> String| {
            interval.map_or_else(|| "not known".to_owned(), |interval| interval.text(number))
        };
        let Self { edges, class, algorithm, marker, probes, seed, threads, .. } = self;
        print_paragraph(
            out,
            &format!("{algorithm}, {marker} marker, class {class}, {}", counted(*edges, "edge")),
        )?;
        writeln!(out, "  starts      {}", text(self.starts, whole))?;
        writeln!(out, "  moves       {}", text(self.moves_total, whole))?;
        writeln!(out, "  moves made  {}", text(self.moves_made, whole))?;
        let time = text(self.seconds, duration_text);
        writeln!(out, "  time        {time} on {}", counted(*threads, "thread"))?;
        let probes = grouped((*probes).into());
        let last = match self.starts {
            None => {
                format!(
                    "none of {probes} probes found a start, seed {seed}; use more: --estimate=N"
                )
            }
            Some(_) => format!("{probes} probes, seed {seed}; 95 % confidence"),
        };
        writeln!(out, "  {last}")?;
        Ok(out.flush()?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 2, 4, 4, 4, 5, 5, 7, 9: mean 5, sum of squares 32.
    #[test]
    fn the_interval_is_that_of_the_normal_distribution() {
        let mut sample = Sample::default();
        for value in [2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0] {
            sample.add(value);
        }
        let error = (32.0_f64 / 7.0 / 8.0).sqrt();
        let Interval { mean, low, high } = sample.interval();
        assert!((mean - 5.0).abs() < 1e-9);
        assert!((low - (5.0 - 1.96 * error)).abs() < 1e-9);
        assert!((high - (5.0 + 1.96 * error)).abs() < 1e-9);
    }

    #[test]
    fn the_interval_of_a_product_is_between_the_least_and_the_greatest_product() {
        let other = Interval { mean: 10.0, low: 9.0, high: 12.0 };
        let Interval { mean, low, high } = Interval { mean: 2.0, low: 1.0, high: 4.0 }.times(other);
        assert_eq!([mean, low, high].map(f64::to_bits), [20.0, 9.0, 48.0].map(f64::to_bits));
    }
}
