//! `check --estimate`: what a check will take, by random probes of the tree of all runs.
//!
//! D. E. Knuth, "Estimating the efficiency of backtrack programs" (1975): a probe goes down the tree and draws one
//! of the `n` branches at each node. A count below, times the product of the `n`, has the count of the whole
//! tree as its expected value. Here a probe draws until [`COMPLETE`] edges are left, and the subtree below is
//! searched completely. That makes the spread smaller, and its time can be measured.

use std::{io::Write, time::Instant};

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::Serialize;
use toposlam_model::{
    check::{LazySweep, MappingAlgorithm},
    enumerate::Watch,
};

use crate::cli::{
    CliError,
    json::print_line,
    text::{counted, duration_text, grouped, print_paragraph},
};

/// The edges that are left where a probe no longer draws.
const COMPLETE: usize = 4;

/// 95 % of a normal distribution are within this many standard deviations of its mean.
const STANDARD_DEVIATIONS: f64 = 1.96;

/// The options of an estimate.
#[derive(clap::Args, Debug)]
pub(super) struct EstimateOptions {
    /// Do not check: predict starts, moves and time by random probes, with 95 % confidence intervals
    #[arg(long, conflicts_with_all = ["from", "shard", "worst", "journal", "junit", "sarif", "keep_going"])]
    pub(super) estimate: bool,

    /// With --estimate: number of probes [default: 10000]
    #[arg(long, value_name = "N", requires = "estimate", value_parser = clap::value_parser!(u32).range(2..))]
    probes: Option<u32>,

    /// With --estimate: random seed [default: 1]
    #[arg(long, value_name = "N", requires = "estimate")]
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

    fn interval(self, unit: f64) -> Interval {
        let error = (self.squares / (self.count - 1.0) / self.count).sqrt();
        let bound = |times: f64| ((self.mean + times * error) * unit).max(0.0);
        Interval {
            mean: self.mean * unit,
            low: bound(-STANDARD_DEVIATIONS),
            high: bound(STANDARD_DEVIATIONS),
        }
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
    starts: Interval,
    /// Of one run for each start.
    moves_total: Interval,
    /// Those that the check makes.
    moves_made: Interval,
    /// On `threads` threads.
    seconds: Interval,
    threads: usize,
}

impl EstimateOptions {
    /// Prints the estimate for one number of edges.
    ///
    /// # Errors
    /// Returns an error if it was interrupted, or cannot be printed.
    pub(super) fn print(
        &self,
        (edges, sweep): (usize, &LazySweep),
        algorithm: &MappingAlgorithm,
        json: bool,
        watch: &dyn Watch,
        out: &mut dyn Write,
    ) -> Result<(), CliError> {
        let (probes, seed) = (self.probes.unwrap_or(10_000), self.seed.unwrap_or(1));
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let [mut starts, mut total, mut made, mut seconds] = [Sample::default(); 4];
        watch.parts(probes as usize);
        for _ in 0..probes {
            // One for the start vertex, and one for each edge.
            let draws = 1 + edges.saturating_sub(COMPLETE);
            let numbers = (0..draws).map(|_| random.random()).collect();
            let begun = Instant::now();
            let Some(probe) = algorithm.probe(sweep, numbers, watch) else {
                return Err(super::needs_default_choices("--estimate"));
            };
            let elapsed = begun.elapsed().as_secs_f64();
            if watch.stop() {
                return Err(CliError::Interrupted);
            }
            starts.add(probe.weight * probe.tally.starts as f64);
            total.add(probe.weight * probe.tally.moves_total as f64);
            made.add(probe.weight * probe.tally.moves_made as f64);
            seconds.add(probe.weight * elapsed);
            watch.part_done(probe.tally.starts);
        }
        let threads = rayon::current_num_threads();
        let line = EstimateLine {
            edges,
            class: sweep.class().name(),
            marker: algorithm.marker().name(),
            algorithm: algorithm.name(),
            probes,
            seed,
            starts: starts.interval(1.0),
            moves_total: total.interval(1.0),
            moves_made: made.interval(1.0),
            seconds: seconds.interval(1.0 / threads as f64),
            threads,
        };
        if json { print_line(out, "estimate", &line) } else { line.print(out) }
    }
}

impl EstimateLine<'_> {
    fn print(&self, out: &mut dyn Write) -> Result<(), CliError> {
        let whole = |number: f64| grouped(number.round() as u128);
        let Self { edges, class, algorithm, marker, probes, seed, threads, .. } = self;
        print_paragraph(
            out,
            &format!("{algorithm}, {marker} marker, class {class}, {}", counted(*edges, "edge")),
        )?;
        writeln!(out, "  starts      {}", self.starts.text(whole))?;
        writeln!(out, "  moves       {}", self.moves_total.text(whole))?;
        writeln!(out, "  moves made  {}", self.moves_made.text(whole))?;
        let threads = counted(*threads, "thread");
        writeln!(out, "  time        {} on {threads}", self.seconds.text(duration_text))?;
        writeln!(out, "  {} probes, seed {seed}; 95 % confidence", grouped((*probes).into()))?;
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
        let Interval { mean, low, high } = sample.interval(10.0);
        assert!((mean - 50.0).abs() < 1e-9);
        assert!((low - 10.0 * (5.0 - 1.96 * error)).abs() < 1e-9);
        assert!((high - 10.0 * (5.0 + 1.96 * error)).abs() < 1e-9);
    }
}
