//! The figures of sensing with a laser scanner, their targets, and what failures have in common.

use super::{
    super::{
        report::{Figures, Group, Rate, labelled},
        traversals::JudgedTraversal,
    },
    judged_walk::{JudgedLaserVisit, JudgedWalk, LaserVerdict},
    scanned_run::ScannedRun,
};
use crate::sample_verdict::SampleVerdict;

/// The allowed shares of visits that are wrong, undecided, and invented.
const WRONG: f64 = 0.01;
const UNDECIDED: f64 = 0.05;
const INVENTED: f64 = 0.01;

type WalkVisit<'w> = (&'w JudgedWalk, &'w JudgedLaserVisit);

/// The figures of these walks, whole runs and traversals.
pub fn figures(
    walks: &[JudgedWalk],
    runs: &[ScannedRun],
    traversals: &[JudgedTraversal],
) -> Figures {
    let visits = walks.iter().flat_map(|walk| walk.visits.iter().map(move |visit| (walk, visit)));
    let visits: Vec<WalkVisit> = visits.collect();
    let mut rates = of_walks(walks, &visits);
    let is = |of, what, verdicts: &[SampleVerdict], verdict| {
        Rate::counted(of, what, None, verdicts, |&found| Some(found == verdict))
    };
    let verdicts: Vec<_> = runs.iter().map(|run| run.outcome.verdict()).collect();
    let sum = |part: fn(&ScannedRun) -> u64| runs.iter().map(|run| part(run) as usize).sum();
    let (percepts, wrong): (usize, _) = (sum(|run| run.tally.percepts), sum(|run| run.tally.wrong));
    let passed: usize = sum(|run| run.tally.passed);
    rates.extend([
        is("run", "wrong", &verdicts, SampleVerdict::Wrong),
        is("run", "gave up", &verdicts, SampleVerdict::Undecided),
        Rate { of: "percept", what: "wrong", seen: wrong, cases: percepts, limit: None },
        Rate {
            of: "percept",
            what: "missing",
            seen: passed,
            cases: percepts + passed,
            limit: None,
        },
    ]);
    let verdicts: Vec<_> = traversals.iter().map(|made| made.outcome.verdict()).collect();
    rates.extend([
        is("control", "wrong", &verdicts, SampleVerdict::Wrong),
        is("control", "gave up", &verdicts, SampleVerdict::Undecided),
    ]);
    Figures { rates, groups: groups(&visits), ..Figures::default() }
}

fn of_walks(walks: &[JudgedWalk], visits: &[WalkVisit]) -> Vec<Rate> {
    type Kind = (&'static str, fn(LaserVerdict) -> bool, Option<f64>);
    let sum = |part: fn(&JudgedWalk) -> usize| walks.iter().map(part).sum();
    let rate = |of, what, seen, cases| Rate { of, what, seen, cases, limit: None };
    let views: usize = sum(|walk| walk.junction_views.all());
    let corridor_views = sum(|walk| walk.corridor_views.all());
    let mut rates = vec![
        rate("junction", "not seen", sum(|walk| walk.junction_views.undecided), views),
        rate("junction", "arms wrong", sum(|walk| walk.junction_views.wrong), views),
        rate("hallway", "called junction", sum(|walk| walk.corridor_views.wrong), corridor_views),
    ];
    let kinds: [Kind; 5] = [
        ("wrong", |found| found.verdict() == SampleVerdict::Wrong, Some(WRONG)),
        ("missed", |found| found == LaserVerdict::Missed, None),
        ("degree wrong", |found| found == LaserVerdict::WrongDegree, None),
        ("door wrong", |found| found == LaserVerdict::WrongDoor, None),
        ("undecided", |found| found == LaserVerdict::Undecided, Some(UNDECIDED)),
    ];
    rates.extend(kinds.map(|(what, fails, limit)| {
        Rate::counted("visit", what, limit, visits, |(_, visit)| Some(fails(visit.verdict)))
    }));
    let invented = sum(|walk| walk.invented.len());
    let derived = visits.iter().filter(|(_, visit)| visit.found.is_some()).count() + invented;
    let invented = rate("visit", "invented", invented, derived);
    rates.push(Rate { limit: Some(INVENTED), ..invented });
    rates.push(Rate::counted("visit", "turning back wrong", None, visits, |(_, visit)| {
        visit.turning_right.map(|right| !right)
    }));
    rates.extend([("wrong", SampleVerdict::Wrong), ("undecided", SampleVerdict::Undecided)].map(
        |(what, verdict)| {
            Rate::counted("walk", what, None, walks, |walk| Some(walk.verdict() == verdict))
        },
    ));
    rates
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
