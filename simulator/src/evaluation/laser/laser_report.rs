//! Figures that were measured on many walks with a laser scanner, their targets, and what failures have in
//! common.

use super::{
    super::{
        report::{Rate, ReportSubject, TargetStatus},
        traversals::{JudgedTraversal, TraversalOutcome},
    },
    judged_walk::{JudgedLaserVisit, JudgedWalk, JunctionVerdict, LaserVerdict},
    laser_robot::PerceptTally,
    scanned_run::{ScannedOutcome, ScannedRun},
};

/// The figures of an evaluation of sensing with a laser scanner.
#[derive(Clone, Debug, PartialEq)]
pub struct LaserReport {
    /// Rates of failures.
    pub rates: Vec<Rate>,
    /// The visits that are not right, by what they have in common.
    pub groups: Vec<LaserGroup>,
}

/// Visits that have something in common.
#[derive(Clone, Debug, PartialEq)]
pub struct LaserGroup {
    /// In what they are alike.
    pub by: &'static str,
    /// What it is in these.
    pub what: String,
    /// The number that is wrong, and that is undecided.
    pub wrong: usize,
    /// See `wrong`.
    pub undecided: usize,
    /// Their number.
    pub of: usize,
}

/// The allowed shares of visits that are wrong, undecided, and invented.
const WRONG: f64 = 0.01;
const UNDECIDED: f64 = 0.05;
const INVENTED: f64 = 0.01;

impl LaserReport {
    /// The figures of these walks, whole runs and traversals.
    #[must_use]
    pub fn of(walks: &[JudgedWalk], runs: &[ScannedRun], traversals: &[JudgedTraversal]) -> Self {
        let rates = rates(walks).into_iter().chain(of_runs(runs)).chain(of_traversals(traversals));
        Self { rates: rates.collect(), groups: groups(walks) }
    }

    /// Whether all targets are met.
    #[must_use]
    pub fn standing(&self) -> TargetStatus {
        let standings = self.rates.iter().map(Rate::standing);
        standings.max().unwrap_or(TargetStatus::NotShown)
    }
}

fn rates(walks: &[JudgedWalk]) -> Vec<Rate> {
    let rate = |subject, what, seen: usize, cases: usize, limit| Rate {
        subject,
        what,
        seen,
        cases,
        limit,
    };
    let views: Vec<JunctionVerdict> =
        walks.iter().flat_map(|walk| walk.views.iter().copied()).collect();
    let views_that = |verdict| views.iter().filter(|&&view| view == verdict).count();
    let corridor_views =
        |index: usize| -> usize { walks.iter().map(|walk| walk.corridor_views[index]).sum() };
    let visits: Vec<&JudgedLaserVisit> = walks.iter().flat_map(|walk| &walk.visits).collect();
    let visits_that =
        |is: fn(LaserVerdict) -> bool| visits.iter().filter(|visit| is(visit.verdict)).count();
    let invented: usize = walks.iter().map(|walk| walk.invented.len()).sum();
    let derived = visits.iter().filter(|visit| visit.found.is_some()).count() + invented;
    let turned: Vec<bool> = visits.iter().filter_map(|visit| visit.turning_right).collect();
    let whole =
        |is: fn(LaserVerdict) -> bool| walks.iter().filter(|walk| is(walk.verdict())).count();
    let (view, visit, walk) = (ReportSubject::Junction, ReportSubject::Visit, ReportSubject::Walk);
    vec![
        rate(view, "not seen", views_that(JunctionVerdict::Unseen), views.len(), None),
        rate(view, "arms wrong", views_that(JunctionVerdict::Wrong), views.len(), None),
        rate(ReportSubject::Hallway, "called junction", corridor_views(1), corridor_views(0), None),
        rate(visit, "wrong", visits_that(LaserVerdict::is_wrong), visits.len(), Some(WRONG)),
        rate(visit, "missed", visits_that(|v| v == LaserVerdict::Missed), visits.len(), None),
        rate(
            visit,
            "degree wrong",
            visits_that(|v| v == LaserVerdict::WrongDegree),
            visits.len(),
            None,
        ),
        rate(
            visit,
            "door wrong",
            visits_that(|v| v == LaserVerdict::WrongDoor),
            visits.len(),
            None,
        ),
        rate(
            visit,
            "undecided",
            visits_that(|v| v == LaserVerdict::Undecided),
            visits.len(),
            Some(UNDECIDED),
        ),
        rate(visit, "invented", invented, derived, Some(INVENTED)),
        rate(
            visit,
            "turning back wrong",
            turned.iter().filter(|&&right| !right).count(),
            turned.len(),
            None,
        ),
        rate(walk, "wrong", whole(LaserVerdict::is_wrong), walks.len(), None),
        rate(walk, "undecided", whole(|v| v == LaserVerdict::Undecided), walks.len(), None),
    ]
}

fn of_runs(runs: &[ScannedRun]) -> [Rate; 4] {
    let rate =
        |subject, what, seen: usize, cases: usize| Rate { subject, what, seen, cases, limit: None };
    let that = |is: fn(&ScannedOutcome) -> bool| runs.iter().filter(|run| is(&run.outcome)).count();
    let wrong = that(|outcome| matches!(outcome, ScannedOutcome::Wrong(_)));
    let gave_up = that(|outcome| matches!(outcome, ScannedOutcome::GaveUp(_)));
    let sum =
        |part: fn(&PerceptTally) -> u64| runs.iter().map(|run| part(&run.tally) as usize).sum();
    let percepts = sum(|tally| tally.percepts);
    let passed: usize = sum(|tally| tally.passed);
    [
        rate(ReportSubject::Run, "wrong", wrong, runs.len()),
        rate(ReportSubject::Run, "gave up", gave_up, runs.len()),
        rate(ReportSubject::Percept, "wrong", sum(|tally| tally.wrong), percepts),
        rate(ReportSubject::Percept, "missing", passed, percepts + passed),
    ]
}

fn of_traversals(traversals: &[JudgedTraversal]) -> [Rate; 2] {
    let rate = |what, is: fn(&TraversalOutcome) -> bool| Rate {
        subject: ReportSubject::Traversal,
        what,
        seen: traversals.iter().filter(|traversal| is(&traversal.outcome)).count(),
        cases: traversals.len(),
        limit: None,
    };
    [
        rate("wrong", |outcome| matches!(outcome, TraversalOutcome::Wrong(_))),
        rate("gave up", |outcome| matches!(outcome, TraversalOutcome::GaveUp(_))),
    ]
}

/// The name of a property, and what it is in a visit of a walk.
type Property = (&'static str, fn(&JudgedWalk, &JudgedLaserVisit) -> String);

fn groups(walks: &[JudgedWalk]) -> Vec<LaserGroup> {
    let properties: [Property; 7] = [
        ("scanner", |walk, _| format!("{} degrees", walk.field_of_view)),
        ("doors", |_, visit| visit.features.degree.to_string()),
        ("junction", |_, visit| {
            if visit.features.is_lobby { "round lobby" } else { "corridors" }.to_owned()
        }),
        ("narrowest", |_, visit| upper(visit.features.widths[0], 0.2, "m")),
        ("width ratio", |_, visit| {
            let [narrow, wide] = visit.features.widths;
            upper(wide / narrow, 0.2, "")
        }),
        ("least angle", |_, visit| upper(visit.features.least_angle.to_degrees(), 15.0, "degrees")),
        ("leaves", |_, visit| {
            if visit.features.goes_back { "by the way back" } else { "by another door" }.to_owned()
        }),
    ];
    let mut groups: Vec<LaserGroup> = Vec::new();
    for (by, property) in properties {
        let begin = groups.len();
        for walk in walks {
            for visit in &walk.visits {
                let what = property(walk, visit);
                let known = groups[begin..].iter().position(|group| group.what == what);
                let at = known.map_or(groups.len(), |known| begin + known);
                if at == groups.len() {
                    groups.push(LaserGroup { by, what, wrong: 0, undecided: 0, of: 0 });
                }
                let group = &mut groups[at];
                group.of += 1;
                group.wrong += usize::from(visit.verdict.is_wrong());
                group.undecided += usize::from(visit.verdict == LaserVerdict::Undecided);
            }
        }
        groups[begin..].sort_by(|one, other| {
            (one.what.len(), &one.what).cmp(&(other.what.len(), &other.what))
        });
    }
    groups
}

/// The least multiple of a step that is not below a value, in words.
fn upper(value: f64, step: f64, unit: &str) -> String {
    let most = (value / step).ceil() * step;
    let digits = usize::from(step < 1.0);
    format!("up to {most:.digits$} {unit}").trim_end().to_owned()
}
