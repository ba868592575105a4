//! Classes of views: the rows and columns of a confusion matrix.

use std::fmt;

use toposlam_model::driving::{
    scene::{Place, Scene},
    visit::{JUNCTION_SHAPES, JunctionShape},
};

/// The class of a view or of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SceneClass {
    /// A hallway.
    Hallway,
    /// A junction, seen from its entry.
    Junction(JunctionShape),
    /// A junction with none of the [`JUNCTION_SHAPES`].
    Other,
    /// An unknown place.
    Unknown,
}

impl SceneClass {
    /// All classes. The last two occur only in scenes.
    pub fn all() -> impl Iterator<Item = Self> {
        let junctions = JUNCTION_SHAPES.into_iter().map(|(form, _)| Self::Junction(form));
        [Self::Hallway].into_iter().chain(junctions).chain([Self::Other, Self::Unknown])
    }

    /// The class of a scene.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        match &scene.place {
            Place::Hallway(_) => Self::Hallway,
            Place::Unknown(_) => Self::Unknown,
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
