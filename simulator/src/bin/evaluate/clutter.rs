//! `evaluate vision --clutter`: sensing with things in the image that a plain building lacks.

use std::io::Write;

use serde::Serialize;
use toposlam_simulator::evaluation::bound::upper_bound;
use toposlam_terminal::{
    CliError, Outcome,
    progress::Progress,
    text::{grouped, print_rows},
};

use super::evaluation_report::{EvaluationReport, MeasurementEnd, outcome, unmeasured};

use toposlam_simulator::{
    EffectSettings,
    evaluation::{
        calibration::Calibration,
        clutter::{ClutterCounts, cluttered_settings},
        judge::Judge,
        report::TargetStatus,
    },
    view_sampler::ViewSampler,
};

/// The JSON line of one kind of clutter.
#[derive(Serialize)]
struct ClutterLine {
    clutter: &'static str,
    effects: serde_json::Map<String, serde_json::Value>,
    views: usize,
    right: usize,
    unknown: usize,
    all_views: usize,
    wrong: usize,
    wrong_markers: usize,
}

/// Measures the same views with each kind of clutter. `judge` returns the judge of views.
pub(super) fn measure(
    judge: impl Fn(&ViewSampler, &[Calibration]) -> Result<Judge, CliError>,
    views: &ViewSampler,
    count: u64,
    mut sheet: EvaluationReport,
    out: &mut dyn Write,
) -> Result<Outcome, CliError> {
    let kinds = cluttered_settings().map_err(unmeasured)?;
    let (mut rows, mut all, mut ending) =
        (Vec::new(), ClutterCounts::default(), MeasurementEnd::Whole);
    for (name, settings) in kinds {
        let views = ViewSampler { settings, ..views.clone() };
        let judge = judge(&views, &[Calibration::Right])?;
        let progress = Progress::new(&format!("views, clutter: {name}"), "views")?;
        let judged = judge.views(&views, 0..count, Calibration::Right, &progress);
        progress.finish();
        let counts = ClutterCounts::of(&judged.map_err(unmeasured)?);
        all.all += counts.all;
        all.wrong += counts.wrong;
        all.wrong_markers += counts.wrong_markers;
        sheet.line("clutter", &line(name, &views.settings, counts))?;
        rows.push(row(name, counts));
        if (counts.all as u64) < count {
            ending = MeasurementEnd::Interrupted;
            break;
        }
    }
    let wrong = all.wrong + all.wrong_markers;
    let status = TargetStatus::of(wrong, all.all, 0.0);
    let text = sheet.text();
    writeln!(text, "Sensing on {} views with each kind of clutter\n", grouped(count.into()))?;
    let heads = ["clutter", "right", "unknown", "wrong scenes", "wrong markers", ""];
    print_rows(text, heads, &rows)?;
    let views = grouped((all.all as u64).into());
    let most = 100.0 * upper_bound(wrong, all.all.max(1));
    let wrong = grouped(wrong as u128);
    writeln!(text, "\nwrong: {wrong} of {views}, at most {most:.3} % ({})", status.name())?;
    sheet.print(out, outcome(status, ending))
}

fn line(clutter: &'static str, settings: &EffectSettings, counts: ClutterCounts) -> ClutterLine {
    let effects = settings.iter().map(|(name, value)| (name.to_owned(), value.into()));
    let ClutterCounts { views, right, unknown, wrong, wrong_markers, all } = counts;
    let effects = effects.collect();
    ClutterLine { clutter, effects, views, right, unknown, all_views: all, wrong, wrong_markers }
}

fn row(name: &str, counts: ClutterCounts) -> [String; 6] {
    let share =
        |part: usize| format!("{:>5.1} %", 100.0 * part as f64 / counts.views.max(1) as f64);
    [
        name.to_owned(),
        share(counts.right),
        share(counts.unknown),
        format!("{:>5} of {}", counts.wrong, counts.all),
        format!("{:>5} of {}", counts.wrong_markers, counts.all),
        String::new(),
    ]
}
