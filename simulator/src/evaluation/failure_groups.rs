//! Groups of views, to find what failures have in common.

use super::{
    judged_view::{JudgedView, Zone},
    quantile::ErrorSample,
    scene_class::SceneClass,
    verdict::PlaceVerdict,
};
use crate::truth::Truth;

/// A group of views with something in common, and the number that failed.
#[derive(Clone, Debug, PartialEq)]
pub struct FailureGroup {
    /// The property by which the views are grouped.
    pub by: &'static str,
    /// Its value in this group.
    pub what: String,
    /// The number of views that failed: those that are not right.
    pub failed: usize,
    /// The number of views.
    pub of: usize,
    /// Whether it is one of the two groups on either side of a median. The group up to the median
    /// comes first.
    pub is_half: bool,
}

impl FailureGroup {
    /// The share of views that failed; 0 without views.
    #[must_use]
    pub fn rate(&self) -> f64 {
        self.failed as f64 / self.of.max(1) as f64
    }
}

/// Groups of the views in hallways and before turning points: by look, image size, class, distance,
/// heading and offset, and by each effect above or up to its median.
#[must_use]
pub fn groups(views: &[JudgedView]) -> Vec<FailureGroup> {
    let asked = |judged: &&JudgedView| matches!(judged.zone(), Zone::Hallway | Zone::Before);
    let views: Vec<_> = views.iter().filter(asked).collect();
    let mut groups = Vec::new();
    groups.extend(labelled(&views, "look", |judged| judged.view.look.name.to_owned()));
    groups.extend(labelled(&views, "size", |judged| {
        let [width, height] = judged.view.image;
        format!("{width}x{height}")
    }));
    let class = |judged: &JudgedView| judged.class().unwrap_or(SceneClass::Other).to_string();
    groups.extend(labelled(&views, "place", class));
    groups.extend(labelled(&views, "distance", |judged| distance(&judged.truth).to_owned()));
    let place = |judged: &JudgedView| -> Vec<(&'static str, f64)> {
        let mut numbers = vec![("width of the hallway", judged.view.plan.hallway_width())];
        if let Some((heading, aside)) = lie(&judged.truth) {
            numbers.extend([("turned by", heading), ("aside by", aside)]);
        }
        numbers
    };
    groups.extend(halved(&views, place));
    let effects = |judged: &JudgedView| -> Vec<(&'static str, f64)> {
        let settings = judged.view.effects.settings();
        settings.into_iter().map(|(knob, value)| (knob.name, value)).collect()
    };
    groups.extend(halved(&views, effects));
    groups
}

/// The robot's angle to its hallway, and its distance from the middle, both without sign.
fn lie(truth: &Truth) -> Option<(f64, f64)> {
    match truth {
        Truth::Hallway(hallway) | Truth::Between(hallway, _) => {
            Some((hallway.heading.abs(), (hallway.left - hallway.right).abs() / 2.0))
        }
        Truth::Junction(junction) => {
            let entry = junction.doors.first().filter(|_| junction.form.is_some())?;
            let [x, y] = junction.turning_point;
            let aside = (y * entry.cos() - x * entry.sin()).abs();
            Some((std::f64::consts::PI - entry.abs(), aside))
        }
    }
}

/// The distance from the turning point, in words.
fn distance(truth: &Truth) -> &'static str {
    let Truth::Junction(junction) = truth else { return "1.5 m or more" };
    match junction.distance() {
        None => "turned away",
        Some(distance) if distance > 0.3 => "0.3 to 0.5 m before",
        Some(distance) if distance > 0.1 => "0.1 to 0.3 m before",
        Some(distance) if distance >= -0.1 => "within 0.1 m",
        Some(_) => "farther past",
    }
}

/// One group for each label, in the order of the labels.
fn labelled(
    views: &[&JudgedView],
    by: &'static str,
    label: impl Fn(&JudgedView) -> String,
) -> Vec<FailureGroup> {
    let mut groups = std::collections::BTreeMap::new();
    for judged in views {
        let (failed, of) = groups.entry(label(judged)).or_insert((0, 0));
        *failed += usize::from(failed_at(judged));
        *of += 1;
    }
    let group = |(what, (failed, of))| FailureGroup { by, what, failed, of, is_half: false };
    groups.into_iter().map(group).collect()
}

/// Two groups for each number that varies: the views above its median, and the others.
fn halved(
    views: &[&JudgedView],
    numbers: impl Fn(&JudgedView) -> Vec<(&'static str, f64)>,
) -> Vec<FailureGroup> {
    let numbers: Vec<Vec<_>> = views.iter().map(|judged| numbers(judged)).collect();
    let names = numbers.iter().max_by_key(|numbers| numbers.len());
    let names: Vec<_> = names.into_iter().flatten().map(|&(name, _)| name).collect();
    let mut groups = Vec::new();
    for name in names {
        let with = views.iter().zip(&numbers).filter_map(|(judged, numbers)| {
            let &(_, value) = numbers.iter().find(|(other, _)| *other == name)?;
            Some((failed_at(judged), value))
        });
        let with: Vec<_> = with.collect();
        let Some(median) =
            with.iter().map(|&(_, value)| value).collect::<ErrorSample>().quantile(0.5)
        else {
            continue;
        };
        let half = |above: bool| {
            let half = with.iter().filter(|&&(_, value)| (value > median) == above);
            let failed = half.clone().filter(|(failed, _)| *failed).count();
            (failed, half.count())
        };
        let (above, below) = (half(true), half(false));
        if above.1 > 0 {
            let group = |side, (failed, of)| FailureGroup {
                by: name,
                what: format!("{side} {}", rounded(median)),
                failed,
                of,
                is_half: true,
            };
            groups.extend([group("up to", below), group("above", above)]);
        }
    }
    groups
}

/// Rounds to three significant digits.
fn rounded(value: f64) -> String {
    let places = if value.abs() < 0.1 { 4 } else { 2 };
    format!("{value:.places$}")
}

fn failed_at(judged: &JudgedView) -> bool {
    judged.verdict != PlaceVerdict::Right
}

#[cfg(test)]
mod tests {
    use toposlam_model::driving::scene::{Place, Reason, Scene};

    use super::*;
    use crate::{LOOKS, evaluation::verdict::MarkerVerdict, view_sampler::ViewSampler};

    #[test]
    fn groups_with_more_failures_have_higher_rates() {
        let views = ViewSampler::of(&LOOKS, [640, 480], 0).unwrap();
        // Sensing fails in blurred views of the theatre only.
        let judged: Vec<_> = (0..600)
            .map(|number| {
                let view = views.view(number).unwrap();
                let fails = view.look.name == "theatre" && view.effects.blur > 0.7;
                let verdict = if fails { PlaceVerdict::Unknown } else { PlaceVerdict::Right };
                let scene = Scene { place: Place::Unknown(Reason::FewWalls), marker: None };
                let truth = view.truth().unwrap();
                JudgedView { view, truth, scene, verdict, marker: MarkerVerdict::NotSeen }
            })
            .collect();
        let groups = groups(&judged);
        let rate = |by: &str, what: &str| {
            let is_it = |group: &&FailureGroup| group.by == by && group.what.starts_with(what);
            groups.iter().find(is_it).unwrap().rate()
        };
        assert!(rate("look", "theatre") > 0.2);
        assert_eq!(rate("look", "school"), 0.0);
        assert!(rate("blur", "above") > 0.02);
        assert!(rate("blur", "up to") < 0.01);
        let asked =
            judged.iter().filter(|judged| matches!(judged.zone(), Zone::Hallway | Zone::Before));
        let all = asked.count();
        for by in ["look", "place", "distance", "blur"] {
            let of: usize =
                groups.iter().filter(|group| group.by == by).map(|group| group.of).sum();
            assert_eq!(of, all, "{by}");
        }
    }
}
