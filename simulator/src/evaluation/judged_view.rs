//! Judged views and visits.

use toposlam_model::{
    driving::{scene::Scene, visit::JunctionShape},
    percept::Percept,
};

use super::{
    scene_class::SceneClass,
    verdict::{MarkerVerdict, PlaceVerdict},
};
use crate::{
    rendered_view::RenderedView,
    truth::{MarkerTruth, Truth},
};

/// The zone of a view. Different targets apply in different zones.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Zone {
    /// 1.5 m or more from every junction.
    Hallway,
    /// Nearer to a junction, but not yet at one.
    Between,
    /// At a junction, up to 0.1 m past its turning point.
    Before,
    /// At a junction, farther past its turning point.
    Past,
    /// At a junction, and turned away from the entry door.
    Turned,
}

/// Up to this distance past its turning point, a junction must be recognized, in metres.
const PAST: f64 = 0.1;

/// A view with its ground truth, its scene and the verdicts.
#[derive(Clone, Debug, PartialEq)]
pub struct JudgedView {
    /// The view.
    pub view: RenderedView,
    /// The ground truth.
    pub truth: Truth,
    /// The scene.
    pub scene: Scene,
    /// The verdict on the place.
    pub verdict: PlaceVerdict,
    /// The verdict on the marker.
    pub marker: MarkerVerdict,
}

/// A judged visit to a junction.
#[derive(Clone, Debug, PartialEq)]
pub struct JudgedVisit {
    /// Its views.
    pub views: Vec<JudgedView>,
    /// The true shape of the junction, seen from its entry.
    pub form: JunctionShape,
    /// The true percept.
    pub percept: Percept,
    /// The shape and percept that were decided, once two images agreed.
    pub decided: Option<(JunctionShape, Percept)>,
}

impl Zone {
    /// The zone of a view with this ground truth.
    #[must_use]
    pub fn of(truth: &Truth) -> Self {
        match truth {
            Truth::Hallway(_) => Self::Hallway,
            Truth::Between(..) => Self::Between,
            Truth::Junction(junction) => match junction.distance() {
                None => Self::Turned,
                Some(distance) if distance >= -PAST => Self::Before,
                Some(_) => Self::Past,
            },
        }
    }
}

impl JudgedView {
    /// The view's zone.
    #[must_use]
    pub fn zone(&self) -> Zone {
        Zone::of(&self.truth)
    }

    /// The true class; `None` if several answers are right.
    #[must_use]
    pub fn class(&self) -> Option<SceneClass> {
        match &self.truth {
            Truth::Hallway(_) => Some(SceneClass::Hallway),
            Truth::Between(..) => None,
            Truth::Junction(junction) => junction.form.map(SceneClass::Junction),
        }
    }

    /// The marker, if it should be seen: the robot is approaching its L and near enough.
    #[must_use]
    pub fn marker_ahead(&self) -> Option<MarkerTruth> {
        let marker = self.view.marker()?;
        let junction = match &self.truth {
            Truth::Junction(junction) => std::slice::from_ref(junction),
            Truth::Between(_, junctions) => junctions.as_slice(),
            Truth::Hallway(_) => &[],
        };
        let vertex = self.view.plan.graph().vertex(self.view.marker?);
        let here = junction.iter().any(|junction| junction.vertex == vertex);
        let distance = marker.distance.filter(|distance| (0.2..=0.8).contains(distance));
        (here && distance.is_some()).then_some(marker)
    }
}

impl JudgedVisit {
    /// Whether another shape was decided.
    #[must_use]
    pub fn is_wrong(&self) -> bool {
        self.decided.is_some_and(|(form, _)| form != self.form)
    }
}
