//! `evaluate mistakes`: what one mistake does to the map of every small start.

use std::{io::Write, path::PathBuf};

use serde_json::{Value, json};
use toposlam_model::{
    check::{MistakeCheck, MistakeCounts, MistakeKind, MistakeTally, UndetectedMistake},
    enumerate::Class,
    format::named_world::NamedWorld,
    mapping::MappingMethod,
};

use toposlam_terminal::{
    CliError, Outcome,
    edge_range::EdgeRange,
    exit_codes::help_end,
    method_options::{MethodOptions, safeguards_in_words},
    output,
    progress::Progress,
    text::{WIDTH, capital, counted, grouped, print_paragraph, wrapped},
};

use super::report::{EvaluationReport, MeasurementEnd, ReportArguments};

/// Measure what one mistake does: is the map right, or is the mistake detected?
///
/// From each start of every world of a size, the robot explores once for each place of its run and for each
/// mistake that can happen there: another degree (from 1 to twice the number of edges), a marker where none
/// lies, a marker that is not seen, one along another door, or that somebody carries the robot to another
/// place. Everything else is true.
///
/// With --audit, the robot walks once more when its map is complete. The walk is the shortest one that can
/// show that the map is right. With --recover, it also goes on after a contradiction, with the percepts that it
/// keeps.
#[derive(clap::Args)]
#[command(after_help = help_end(
    "\
Examples:
  evaluate mistakes                      the folding explorer alone
  evaluate mistakes --audit              and with an audit
  evaluate mistakes --recover --edges 1..=4
  evaluate mistakes --algorithm algorithm1 --audit
  evaluate mistakes --out-dir mistakes   the smallest ones, as worlds

A wrong pose is not a violation if the robot was carried to a place that looks the \
same.",
    &[
        (0, "each run ends with the right map, or the mistake is detected"),
        (1, "a mistake that can be detected is not detected"),
        (2, "bad usage or input"),
        (3, "not all runs were made"),
    ],
))]
pub(super) struct EvaluateMistakesArguments {
    /// Number of edges, as in 4, or a range, as in 1..=5
    #[arg(long, default_value = "1..=5", value_name = "SIZES", allow_hyphen_values = true)]
    edges: EdgeRange,
    /// Class of worlds: multigraph, simple, corridor or planar
    #[arg(long, default_value_t = Class::Multigraph)]
    class: Class,
    #[command(flatten)]
    method: MethodOptions,
    /// Write the smallest start with an undetected mistake of each kind into this folder
    #[arg(long, value_name = "DIR")]
    out_dir: Option<PathBuf>,
    #[command(flatten)]
    report: ReportArguments,
}

impl EvaluateMistakesArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        let mut sheet = self.report.begin()?;
        let method = self.method.method()?;
        let check = |edges| {
            let check = MistakeCheck::new(self.class, edges, method);
            check.map_err(|error| CliError::at("--edges", error))
        };
        let checks = self.edges.iter().map(check).collect::<Result<Vec<_>, _>>()?;
        if let Some(folder) = &self.out_dir {
            output::make_folder(folder)?;
        }
        let mut tally = MistakeTally::default();
        for (edges, check) in self.edges.iter().zip(checks) {
            let progress = Progress::new(&counted(edges, "edge"), "runs")?;
            tally.merge(check.run(&progress));
            progress.finish();
            if tally.interrupted {
                break;
            }
        }
        let all = tally.all();
        let ending = if tally.interrupted {
            MeasurementEnd::Interrupted
        } else {
            MeasurementEnd::from_counts(all.runs() as usize, 0)
        };
        let violations = violations(&tally);
        let outcome = ending.outcome_with(violations);
        self.add(method, &tally, &mut sheet)?;
        let line = json!({
            "class": self.class.name(), "algorithm": method.algorithm().name(),
            "audits": method.audits(), "recover": method.recovers(),
            "starts": tally.starts, "runs": all.runs(), "right": all.right,
            "unnoticed": all.undetected(), "moves_total": tally.moves,
            "interrupted": tally.interrupted,
        });
        let violated = format!(
            "violated: {} of {} runs end with a detectable mistake that was not detected",
            grouped(violations.into()),
            grouped(all.runs().into()),
        );
        let holds = "holds: each run ends with the right map, or the mistake is detected";
        let verdict = ending.verdict(outcome, [holds, &violated, ""]);
        self.write_mistakes(&tally)?;
        let verdict = wrapped(*WIDTH, "", 0, verdict).join("\n");
        sheet.finish(out, ("mistakes", line), outcome, &format!("\n{verdict}"))
    }

    fn add(
        &self,
        method: MappingMethod,
        tally: &MistakeTally,
        sheet: &mut EvaluationReport,
    ) -> Result<(), CliError> {
        let algorithm = capital(method.algorithm().in_words());
        let safeguards = match safeguards_in_words(method) {
            none if none.is_empty() => "alone".to_owned(),
            safeguards => safeguards,
        };
        let class = self.class;
        writeln!(sheet.text, "{algorithm} {safeguards}, one mistake a run, class {class}")?;
        let starts = counted(tally.starts as usize, "start");
        let mean = tally.moves as f64 / tally.starts.max(1) as f64;
        writeln!(sheet.text, "  {starts}, {mean:.1} moves on average without a mistake\n")?;
        let heads = ["mistake", ">runs", ">right", ">detected", ">wrong pose", ">wrong map"];
        let all = tally.all();
        let kinds = MistakeKind::ALL.into_iter().map(MistakeKind::name).zip(tally.counts);
        sheet.table(heads, kinds.chain([("all", all)]).map(|(name, counts)| row(name, counts)))?;
        if method.recovers() {
            let extra = all.extra_moves as f64 / all.right.max(1) as f64;
            writeln!(sheet.text, "\n  a right run took {extra:.1} more moves on average")?;
        }
        for (kind, mistake) in first_mistakes(tally) {
            writeln!(sheet.text)?;
            print_paragraph(&mut sheet.text, &in_words(kind, mistake))?;
        }
        for (at, kind) in MistakeKind::ALL.into_iter().enumerate() {
            let line = mistake_line(kind, tally.counts[at], tally.first[at].as_ref());
            sheet.line("mistake", &line)?;
        }
        Ok(())
    }

    fn write_mistakes(&self, tally: &MistakeTally) -> Result<(), CliError> {
        let Some(folder) = &self.out_dir else { return Ok(()) };
        for (kind, mistake) in first_mistakes(tally) {
            let name = kind.name().replace(' ', "-");
            let UndetectedMistake { graph, facing, .. } = mistake;
            let world = NamedWorld::discovered(&name, &in_words(kind, mistake), graph, *facing);
            output::write_world(&folder.join(format!("{name}.toml")), &world)?;
        }
        Ok(())
    }
}

fn mistake_line(
    kind: MistakeKind,
    counts: MistakeCounts,
    first: Option<&UndetectedMistake>,
) -> Value {
    let MistakeCounts { right, reported, too_large, wrong_pose, wrong_map, extra_moves } = counts;
    let first = first.map(|first| {
        json!({
            "edges": first.graph.edge_count(), "moves": first.mistake.moves,
            "what": first.mistake.to_string(), "flaw": first.flaw.to_string(),
        })
    });
    json!({
        "mistake": kind.name(), "runs": counts.runs(), "right": right,
        "reported": reported, "gave_up": too_large, "wrong_pose": wrong_pose,
        "wrong_map": wrong_map, "extra_moves": extra_moves, "first": first,
    })
}

/// The first undetected mistake of each kind.
fn first_mistakes(
    tally: &MistakeTally,
) -> impl Iterator<Item = (MistakeKind, &UndetectedMistake)> + '_ {
    let first = MistakeKind::ALL.into_iter().zip(&tally.first);
    first.filter_map(|(kind, first)| first.as_ref().map(|first| (kind, first)))
}

/// The number of runs with a detectable mistake that was not detected. A robot cannot detect that it was carried to
/// a place that looks the same, but an audit detects a wrong map.
fn violations(tally: &MistakeTally) -> u64 {
    let of = |(kind, counts): (MistakeKind, MistakeCounts)| match kind {
        MistakeKind::Carried => counts.wrong_map,
        _ => counts.undetected(),
    };
    MistakeKind::ALL.into_iter().zip(tally.counts).map(of).sum()
}

fn row(name: &str, counts: MistakeCounts) -> [String; 6] {
    let MistakeCounts { right, reported, too_large, wrong_pose, wrong_map, .. } = counts;
    let [runs, right, reported, wrong_pose, wrong_map] =
        [counts.runs(), right, reported + too_large, wrong_pose, wrong_map]
            .map(|count| grouped(count.into()));
    [name.to_owned(), runs, right, reported, wrong_pose, wrong_map]
}

fn in_words(kind: MistakeKind, undetected: &UndetectedMistake) -> String {
    let UndetectedMistake { graph, mistake, flaw, .. } = undetected;
    let edges = counted(graph.edge_count(), "edge");
    format!(
        "{}, the smallest that is not detected: in a world with {edges}, {mistake}; {flaw}.",
        capital(kind.name())
    )
}
