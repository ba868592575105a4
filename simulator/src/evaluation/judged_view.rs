//! Judged views and visits.

use std::fmt;

use toposlam_model::{
    driving::{
        scene::{Place, Scene},
        visit::JunctionShape,
    },
    percept::Percept,
};

use super::verdict::{MarkerVerdict, PlaceVerdict};
use crate::{
    truth::{JunctionTruth, Truth},
    view_sampler::RenderedView,
};

/// The zone of a view. Different targets apply in different zones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
    pub view: RenderedView,
    pub truth: Truth,
    pub scene: Scene,
    pub verdict: PlaceVerdict,
    pub marker: MarkerVerdict,
}

#[derive(Clone, Debug, PartialEq)]
pub struct JudgedVisit {
    pub views: Vec<JudgedView>,
    /// The true shape of the junction, seen from its entry.
    pub shape: JunctionShape,
    pub percept: Percept,
    /// The shape and percept that were decided, once two images agreed.
    pub decided: Option<(JunctionShape, Percept)>,
}

impl JudgedView {
    pub fn zone(&self) -> Zone {
        match &self.truth {
            Truth::Hallway(_) => Zone::Hallway,
            Truth::Between(..) => Zone::Between,
            Truth::Junction(junction) => match junction.distance() {
                None => Zone::Turned,
                Some(distance) if distance >= -PAST => Zone::Before,
                Some(_) => Zone::Past,
            },
        }
    }

    /// Whether sensing should be right: the view is in a hallway, or of a junction up to its turning point.
    pub fn counts(&self) -> bool {
        matches!(self.zone(), Zone::Hallway | Zone::Before)
    }

    /// The true class; `None` if several answers are right.
    pub fn class(&self) -> Option<SceneClass> {
        match &self.truth {
            Truth::Hallway(_) => Some(SceneClass::Hallway),
            Truth::Between(..) => None,
            Truth::Junction(junction) => junction.shape.map(SceneClass::Junction),
        }
    }

    /// Whether the marker should be seen: the robot is approaching its L and near enough.
    pub fn is_marker_ahead(&self) -> bool {
        let marked = self.view.marker.map(|dart| self.view.plan.graph().vertex(dart));
        let here = self.truth.junctions().iter().find(|junction| Some(junction.vertex) == marked);
        let distance = here.and_then(JunctionTruth::distance);
        distance.is_some_and(|distance| (0.2..=0.8).contains(&distance))
    }

    /// Whether a marker is reported where there is none, or with a wrong door.
    pub fn has_wrong_marker(&self) -> bool {
        matches!(self.marker, MarkerVerdict::Phantom | MarkerVerdict::Seen(Some(false)))
    }
}

impl JudgedVisit {
    pub fn is_wrong(&self) -> bool {
        self.decided.is_some_and(|(shape, _)| shape != self.shape)
    }
}

/// The class of a view or of a scene: a row or a column of a confusion matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum SceneClass {
    Hallway,
    /// A junction, seen from its entry.
    Junction(JunctionShape),
    /// A junction with none of the [`JUNCTION_SHAPES`](toposlam_model::driving::visit::JUNCTION_SHAPES).
    Other,
    /// A junction that is only possible is unknown, too.
    Unknown,
}

impl SceneClass {
    pub fn from_scene(scene: &Scene) -> Self {
        match &scene.place {
            Place::Hallway(_) => Self::Hallway,
            Place::Unknown(_) => Self::Unknown,
            Place::Junction(junction) if !junction.is_certain() => Self::Unknown,
            Place::Junction(junction) => JunctionShape::from_view(junction)
                .filter(|shape| shape.name().is_some())
                .map_or(Self::Other, Self::Junction),
        }
    }
}

impl fmt::Display for SceneClass {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.pad(match *self {
            Self::Hallway => "hallway",
            Self::Junction(junction) => junction.name().unwrap_or("other"),
            Self::Other => "other",
            Self::Unknown => "unknown",
        })
    }
}
