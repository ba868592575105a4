//! Views and visits that have been judged.

use toposlam_model::{
    driving::{scene::Scene, visit::JunctionShape},
    percept::Percept,
};

use super::{
    rendered_view::RenderedView,
    scene_class::SceneClass,
    verdict::{MarkerVerdict, PlaceVerdict},
};
use crate::truth::{MarkerTruth, Truth};

/// Where a view is, as it matters to what is asked of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Zone {
    /// 1.5 m or more from any junction.
    Hallway,
    /// Nearer, but not yet at a junction.
    Between,
    /// At a junction, up to 0.1 m past its turning point.
    Before,
    /// At a junction, farther past its turning point.
    Past,
    /// At a junction, and turned away from the door by which it was entered.
    Turned,
}

/// So far past the turning point a junction is to be made out, in metres.
const PAST: f64 = 0.1;

/// A view, and what sensing made of it.
#[derive(Clone, Debug, PartialEq)]
pub struct JudgedView {
    /// What was to be seen.
    pub view: RenderedView,
    /// What is true there.
    pub truth: Truth,
    /// What sensing says.
    pub scene: Scene,
    /// Whether it is right about the place,
    pub verdict: PlaceVerdict,
    /// and about the marker.
    pub marker: MarkerVerdict,
}

/// A visit to a junction, and what came of it.
#[derive(Clone, Debug, PartialEq)]
pub struct JudgedVisit {
    /// Its pictures.
    pub pictures: Vec<JudgedView>,
    /// What the junction looks like from its entry.
    pub form: JunctionShape,
    /// What the robot should perceive.
    pub percept: Percept,
    /// As what the junction was made out, once two pictures agreed.
    pub decided: Option<(JunctionShape, Percept)>,
}

impl Zone {
    /// Where a view with this truth is.
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
    /// Where it is.
    #[must_use]
    pub fn zone(&self) -> Zone {
        Zone::of(&self.truth)
    }

    /// What the image shows; `None` where different answers are right.
    #[must_use]
    pub fn class(&self) -> Option<SceneClass> {
        match &self.truth {
            Truth::Hallway(_) => Some(SceneClass::Hallway),
            Truth::Between(..) => None,
            Truth::Junction(junction) => junction.form.map(SceneClass::Junction),
        }
    }

    /// Whether the marker is just where it should be seen, on the approach to its L.
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
    /// Whether the junction was made out as another.
    #[must_use]
    pub fn is_wrong(&self) -> bool {
        self.decided.is_some_and(|(form, _)| form != self.form)
    }
}
