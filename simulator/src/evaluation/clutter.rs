//! Sensing under clutter: views with one effect that is off by default, and with all of them.

use super::{
    judged_view::{JudgedView, Zone},
    verdict::{MarkerVerdict, PlaceVerdict},
};
use crate::{EffectSettings, KnobError};

/// Effects as a photograph of a real mirror camera shows them: a name, and the settings.
pub const CLUTTER: [(&str, &[(&str, f64)]); 8] = [
    ("furniture", &[("furniture", 5.0)]),
    ("cables", &[("cables", 6.0)]),
    ("wide struts", &[("strut-width", 14.0)]),
    ("open laptop", &[("laptop", 0.06)]),
    ("yellow cast", &[("cast", 0.77)]),
    ("cropped mirror", &[("zoom", 1.45), ("off-centre", -0.03)]),
    ("dark rim", &[("dark-rim", 0.65)]),
    (
        "all of these",
        &[
            ("furniture", 5.0),
            ("cables", 6.0),
            ("strut-width", 14.0),
            ("laptop", 0.06),
            ("cast", 0.77),
            ("zoom", 1.45),
            ("off-centre", -0.03),
            ("dark-rim", 0.65),
        ],
    ),
];

/// The name of views without clutter.
pub const NO_CLUTTER: &str = "none";

/// The settings of each kind of clutter, first none.
///
/// # Errors
/// Returns an error if an effect is unknown.
pub fn cluttered_settings() -> Result<Vec<(&'static str, EffectSettings)>, KnobError> {
    let clutter = CLUTTER.iter().map(|(name, settings)| (*name, *settings));
    let all = [(NO_CLUTTER, [].as_slice())].into_iter().chain(clutter);
    all.map(|(name, settings)| Ok((name, EffectSettings::new(settings.iter().copied())?))).collect()
}

/// The results of sensing for the views with one kind of clutter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ClutterCounts {
    /// Views in hallways, and up to the turning points of junctions.
    pub views: usize,
    /// Of these, the right scenes.
    pub right: usize,
    /// Of these, the unknown scenes.
    pub unknown: usize,
    /// Wrong scenes, of all views.
    pub wrong: usize,
    /// Markers where there are none, or with a wrong door, of all views.
    pub wrong_markers: usize,
    /// All views.
    pub all: usize,
}

impl ClutterCounts {
    /// The counts of these views.
    #[must_use]
    pub fn of(judged: &[JudgedView]) -> Self {
        let mut counts = Self { all: judged.len(), ..Self::default() };
        for view in judged {
            if matches!(view.zone(), Zone::Hallway | Zone::Before) {
                counts.views += 1;
                counts.right += usize::from(view.verdict == PlaceVerdict::Right);
                counts.unknown += usize::from(view.verdict == PlaceVerdict::Unknown);
            }
            counts.wrong += usize::from(view.verdict.is_wrong());
            let marker = view.marker;
            let wrong = matches!(marker, MarkerVerdict::Phantom | MarkerVerdict::Seen(Some(false)));
            counts.wrong_markers += usize::from(wrong);
        }
        counts
    }
}

#[cfg(test)]
mod tests {
    use toposlam_vision::camera::Camera;

    use super::*;
    use crate::Effects;

    #[test]
    fn every_kind_of_clutter_sets_effects_that_are_off_by_default() {
        let kinds = cluttered_settings().unwrap();
        assert_eq!(kinds.len(), CLUTTER.len() + 1);
        for (name, settings) in &kinds[1..] {
            let effects = settings.applied(Effects::plain());
            assert_ne!(effects, Effects::plain(), "{name}");
            assert!(effects.camera(&Camera::superscout()).is_some(), "{name}");
        }
        let [.., (_, all)] = kinds.as_slice() else { panic!() };
        let one_by_one = kinds[1..CLUTTER.len()].iter();
        let together = one_by_one.fold(Effects::plain(), |effects, (_, one)| one.applied(effects));
        assert_eq!(all.applied(Effects::plain()), together);
    }
}
