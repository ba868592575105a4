//! The figures of sensing with a laser scanner, their targets, and what failures have in common.

use super::{
    super::{
        report::{Figures, Group, Rate, labelled},
        traversals::JudgedTraversal,
    },
    judged_walk::{JudgedLaserVisit, JudgedWalk, LaserVerdict},
    scanned_run::{PerceptTally, ScannedRun},
};
use crate::sample_verdict::{SampleTally, SampleVerdict};

/// The allowed shares of visits that are wrong, undecided, and invented.
const WRONG: f64 = 0.01;
const UNDECIDED: f64 = 0.05;
const INVENTED: f64 = 0.01;
/// That of visits whose percept is not among those that the scans leave.
const OUTSIDE: f64 = 0.005;

type WalkVisit<'w> = (&'w JudgedWalk, &'w JudgedLaserVisit);

/// The figures of these walks, whole runs and traversals.
pub fn figures(
    walks: &[JudgedWalk],
    runs: &[ScannedRun],
    traversals: &[JudgedTraversal],
) -> Figures {
    let visits = walks.iter().flat_map(|walk| walk.visits.iter().map(move |visit| (walk, visit)));
    let visits: Vec<WalkVisit> = visits.collect();
    let junctions: SampleTally = walks.iter().map(|walk| walk.junction_views).sum();
    let corridors: SampleTally = walks.iter().map(|walk| walk.corridor_views).sum();
    let found: SampleTally = visits.iter().map(|(_, visit)| visit.verdict.verdict()).collect();
    let with = |verdict| visits.iter().filter(|(_, visit)| visit.verdict == verdict).count();
    let invented: usize = walks.iter().map(|walk| walk.invented.len()).sum();
    let outside = visits.iter().filter(|(_, visit)| visit.in_set != Some(true)).count();
    let possible: usize = walks.iter().map(|walk| walk.only_possible).sum();
    let derived = visits.iter().filter(|(_, visit)| visit.found.is_some()).count() + invented;
    let turned = visits.iter().filter_map(|(_, visit)| visit.turning_right);
    let turned: SampleTally = turned.map(SampleVerdict::right_if).collect();
    let walked: SampleTally = walks.iter().map(JudgedWalk::verdict).collect();
    let mapped: SampleTally = runs.iter().map(|run| run.outcome.verdict()).collect();
    let sum = |part: fn(&PerceptTally) -> u64| -> usize {
        runs.iter().map(|run| part(&run.tally) as usize).sum()
    };
    let [percepts, wrong, passed] =
        [sum(|tally| tally.percepts), sum(|tally| tally.wrong), sum(|tally| tally.passed)];
    let driven: SampleTally = traversals.iter().map(|made| made.outcome.verdict()).collect();
    let rates = [
        ("junction", "not seen", junctions.undecided, junctions.all(), None),
        ("junction", "arms wrong", junctions.wrong, junctions.all(), None),
        ("hallway", "called junction", corridors.wrong, corridors.all(), None),
        ("visit", "wrong", found.wrong, found.all(), Some(WRONG)),
        ("visit", "missed", with(LaserVerdict::Missed), found.all(), None),
        ("visit", "degree wrong", with(LaserVerdict::WrongDegree), found.all(), None),
        ("visit", "door wrong", with(LaserVerdict::WrongDoor), found.all(), None),
        ("visit", "undecided", found.undecided, found.all(), Some(UNDECIDED)),
        ("visit", "not in its set", outside, found.all(), Some(OUTSIDE)),
        ("visit", "invented", invented, derived, Some(INVENTED)),
        ("visit", "only possible elsewhere", possible, found.all(), None),
        ("visit", "turning back wrong", turned.wrong, turned.all(), None),
        ("walk", "wrong", walked.wrong, walked.all(), None),
        ("walk", "undecided", walked.undecided, walked.all(), None),
        ("run", "wrong", mapped.wrong, mapped.all(), None),
        ("run", "gave up", mapped.undecided, mapped.all(), None),
        ("percept", "wrong", wrong, percepts, None),
        ("percept", "missing", passed, percepts + passed, None),
        ("control", "wrong", driven.wrong, driven.all(), None),
        ("control", "gave up", driven.undecided, driven.all(), None),
    ];
    let rates = rates.map(|(of, what, seen, cases, limit)| Rate { of, what, seen, cases, limit });
    Figures { rates: rates.into(), groups: groups(&visits), ..Figures::default() }
}

fn groups(visits: &[WalkVisit]) -> Vec<Group> {
    type Property = (&'static str, fn(&WalkVisit) -> String);
    let properties: [Property; 7] = [
        ("scanner", |(walk, _)| format!("{} degrees", walk.field_of_view)),
        ("doors", |(_, visit)| visit.degree.to_string()),
        ("junction", |(_, visit)| {
            if visit.is_lobby { "round lobby" } else { "corridors" }.to_owned()
        }),
        ("narrowest", |(_, visit)| upper(visit.widths[0], 0.2, "m")),
        ("width ratio", |(_, visit)| upper(visit.widths[1] / visit.widths[0], 0.2, "")),
        ("least angle", |(_, visit)| upper(visit.least_angle.to_degrees(), 15.0, "degrees")),
        ("leaves", |(_, visit)| {
            if visit.door == 0 { "by the way back" } else { "by another door" }.to_owned()
        }),
    ];
    let verdict = |(_, visit): &WalkVisit| visit.verdict.verdict();
    let groups = properties.map(|(by, property)| labelled(visits, verdict, by, property));
    groups.concat()
}

/// The least multiple of a step that is not below a value, in words.
fn upper(value: f64, step: f64, unit: &str) -> String {
    let most = (value / step).ceil() * step;
    let digits = usize::from(step < 1.0);
    format!("up to {most:.digits$} {unit}").trim_end().to_owned()
}
