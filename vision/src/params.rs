//! The parameters of sensing: the thresholds of Section 3's pipeline, in one place. The paper gives none of them.
//!
//! Lengths are in metres and angles in radians. A *bearing* is half a degree, a *step* is one pixel of the ground view
//! along a bearing: 7.5 mm. "A part of" is a number from 0 to 1. The values come from:
//!
//! * **geometry**: the robot, the camera or the building gives the value;
//! * **views**: chosen on rendered views, where it meets the targets of `evaluate vision` (`docs/sensing.md`).
//!
//! Not here are the sizes of tables ([`GroundView`](crate::ground_view::GroundView),
//! [`boundary`](crate::boundary)), and the parameters of [`colour`](crate::colour::params),
//! [`camera`](crate::camera::params) and [`laser`](crate::laser::params).

use std::ops::RangeInclusive;

use serde::de::DeserializeOwned;
use toposlam_model::format::document::{Document, DocumentError, DocumentValue};

/// What a TOML file can set: a number in a range, a switch, or a table of parameters.
pub trait Parameter {
    /// Checks a value of a file. A number lies in the range that is declared for it, or in that of its type.
    ///
    /// # Errors
    /// Returns an error if a number is out of its range.
    fn check(
        value: DocumentValue<'_>,
        range: Option<RangeInclusive<f64>>,
    ) -> Result<(), DocumentError>;
}

/// Reads parameters from TOML. What is not in the file has its default.
///
/// # Errors
/// Returns an error if a key is not known, or a number is not one that the parameter can have.
pub fn read<P: Parameter + DeserializeOwned>(text: &str) -> Result<P, DocumentError> {
    let document = Document::parse_settings(text.as_bytes())?;
    let params = document.root().read()?;
    P::check(document.root(), None)?;
    Ok(params)
}

macro_rules! numbers {
    ($($type:ty: $usual:expr;)*) => {$(
        impl Parameter for $type {
            fn check(
                value: DocumentValue<'_>,
                range: Option<RangeInclusive<f64>>,
            ) -> Result<(), DocumentError> {
                value.number_in("this parameter", range.unwrap_or($usual)).map(|_| ())
            }
        }
    )*};
}

numbers! {
    f32: 0.0..=1000.0;
    f64: 0.0..=1000.0;
    i32: 1.0..=1000.0;
    u8: 0.0..=255.0;
    u32: 1.0..=1000.0;
    u64: 1.0..=1000.0;
    usize: 1.0..=1000.0;
}

impl Parameter for bool {
    fn check(
        value: DocumentValue<'_>,
        _: Option<RangeInclusive<f64>>,
    ) -> Result<(), DocumentError> {
        value.truth().map(|_| ())
    }
}

impl<T: Parameter, const LENGTH: usize> Parameter for [T; LENGTH] {
    fn check(
        value: DocumentValue<'_>,
        range: Option<RangeInclusive<f64>>,
    ) -> Result<(), DocumentError> {
        value.list("a list")?.try_for_each(|item| T::check(item, range.clone()))
    }
}

/// Structs of parameters, each with its default, and a number with its range if that is not the usual one of its type.
/// The docs of each field show its default. [`read`](crate::params::read) reads them.
#[macro_export]
macro_rules! params {
    ($($(#[$meta:meta])* $name:ident {
        $($(#[$doc:meta])* $field:ident: $type:ty = $default:expr $(=> $range:expr)?,)*
    })*) => {$(
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize, serde::Serialize)]
        #[serde(default, deny_unknown_fields)]
        pub struct $name {
            $(
                $(#[$doc])*
                #[doc = concat!("\n\nDefault: `", stringify!($default), "`.")]
                pub $field: $type,
            )*
        }

        impl $name {
            pub const DEFAULT: Self = Self { $($field: $default,)* };
        }

        impl Default for $name {
            fn default() -> Self {
                Self::DEFAULT
            }
        }

        impl $crate::params::Parameter for $name {
            fn check(
                value: toposlam_model::format::document::DocumentValue<'_>,
                _: Option<std::ops::RangeInclusive<f64>>,
            ) -> Result<(), toposlam_model::format::document::DocumentError> {
                let table = value.any_table()?;
                $(if let Some(value) = table.get(stringify!($field)) {
                    let range = None::<std::ops::RangeInclusive<f64>>$(.or(Some($range)))?;
                    <$type as $crate::params::Parameter>::check(value, range)?;
                })*
                Ok(())
            }
        }
    )*};
}

params! {
    /// All parameters of sensing.
    ///
    /// [`Sensor::with_params`](crate::sensing::Sensor::with_params) takes other values than the
    /// defaults.
    SensingParams {
        /// The fewest boundary points that can show a place. Views.
        min_points: usize = 40,
        /// The fewest bearings on which floor is seen; with fewer there is no scene. Geometry: a fifth
        /// of the 720 bearings.
        min_floor_bearings: usize = 144,
        boundary: BoundaryParams = BoundaryParams::DEFAULT,
        cluster: ClusterParams = ClusterParams::DEFAULT,
        line: LineParams = LineParams::DEFAULT,
        wall: WallParams = WallParams::DEFAULT,
        corner: CornerParams = CornerParams::DEFAULT,
        outline: OutlineParams = OutlineParams::DEFAULT,
        hallway: HallwayParams = HallwayParams::DEFAULT,
        junction: JunctionParams = JunctionParams::DEFAULT,
        marker: MarkerParams = MarkerParams::DEFAULT,
    }

    /// Where floor ends at a stripe, on one bearing.
    BoundaryParams {
        /// A stripe is at least this part of its true width. Geometry: one pixel of the image may cover
        /// the rest.
        min_stripe_width: f64 = 0.40,
        /// A stripe is at most this many times its true width, plus [`Self::stripe_blur`]. Geometry: on
        /// most bearings a wall is met at an angle.
        max_stripe_width: f64 = 2.0,
        /// What pixels and blur add to a stripe's width, in steps. Views.
        stripe_blur: f64 = 10.0,
        /// What is this many times wider than the widest stripe is an area: lit floor may have the
        /// colour of a stripe in the shade. Views.
        area_width: f64 = 3.0,
        /// Steps between floor and stripe in which their colours mix. Views.
        mixed_steps: usize = 10,
        /// Fewer steps of another class do not end a stripe. Views.
        speck_steps: usize = 3,
        /// Steps behind a stripe that are searched for floor. Views.
        behind_steps: usize = 30,
        /// With this many steps of floor behind a stripe, its edge is not sure. Views.
        floor_behind_steps: usize = 10,
        /// After this many steps of other classes the rest of the bearing is ignored. Views.
        lost_steps: usize = 60,
    }

    /// Which boundary points belong to one piece of wall.
    ClusterParams {
        /// The largest gap between two successive points at the robot. Views.
        gap: f64 = 0.10,
        /// What each metre from the robot to the farther point adds to the gap. Geometry: pixels of
        /// the image cover more floor there.
        gap_per_metre: f64 = 0.08,
        /// The most bearings that a strut of the camera hides. Geometry: 8 degrees.
        hidden_bearings: usize = 16,
        /// Clusters of fewer points are noise. Views.
        min_points: usize = 6,
        /// Clusters of less extent are noise. Views.
        min_extent: f64 = 0.12,
    }

    /// Where a cluster bends, and which of its pieces are lines.
    LineParams {
        /// A cluster is split at a point this far from the chord between its ends, at the robot. Views.
        bend: f64 = 0.035,
        /// What each metre from the robot adds to that distance. Geometry: as
        /// [`ClusterParams::gap_per_metre`].
        bend_per_metre: f64 = 0.02,
        /// The fewest points of a line. Views.
        min_points: usize = 5,
        /// The least length of a line. Views.
        min_length: f64 = 0.10,
    }

    /// Which lines are walls.
    WallParams {
        /// The largest angle between a wall and its axis. Views.
        max_skew: f64 = 0.20,
        /// No wall is nearer to the robot's centre: such a line is the edge of a strut. Geometry: the
        /// radius of the SuperScout's body.
        min_offset: f64 = 0.20,
        /// A point this near to a wall is on it. Views.
        on_wall: f64 = 0.06,
        /// A boundary point on a wall of at least this length is sure. Views: the floor's own patterns
        /// are shorter.
        long_wall: f64 = 0.60,
    }

    /// Where walls meet.
    CornerParams {
        /// Walls meet if both end this near to the point where they would meet. Views.
        touch: f64 = 0.22,
    }

    /// How an outline is compared with what is seen on each bearing.
    OutlineParams {
        /// A point this near to a wall agrees with it, at the robot. Views.
        near: f64 = 0.05,
        /// What each metre from the robot adds to that distance. Geometry: as
        /// [`ClusterParams::gap_per_metre`].
        near_per_metre: f64 = 0.03,
        /// The length of a junction's arms, in hallway widths. Geometry: the next junction may begin
        /// there.
        arm: f64 = 1.0,
        /// Weight of a bearing on which the floor ends without a stripe, against 1 for one on which the
        /// wall is seen. Views.
        ended_weight: f64 = 0.5,
        /// Weight of a bearing on which floor is seen behind a wall. Views.
        through_weight: f64 = 1.5,
        /// Weight of a bearing on which a wall is seen in front of the outline. Views.
        against_weight: f64 = 3.0,
        /// The most bearings with a wall in front of the outline, as a part of those in support. Views.
        max_against: f64 = 0.12,
        /// The most bearings with doors, as a multiple of those in support. Views.
        max_doors: f64 = 2.0,
        /// Walls farther away are not expected to be seen. Geometry: a pixel of the image covers as
        /// much there as a stripe.
        max_range: f64 = 2.1,
        /// A direction need not be seen if it has at most this part of all bearings. Views.
        narrow: f64 = 0.02,
        /// In any other direction, at least this part of the bearings must be seen. Views.
        min_direction_seen: f64 = 0.25,
        /// A bearing is open if floor is seen for this part of the way. Views.
        open: f64 = 0.8,
        /// A gap in a wall is a door if it is narrower than this part of a hallway. Geometry.
        door_width: f64 = 0.75,
        /// Beside a door, this part of [`Self::near`] is near: around the corner of an opening there is
        /// wall, too. Views.
        door_near: f64 = 0.5,
        /// The length of wall that must be seen beside a door. Views.
        door_wall: f64 = 0.30,
        /// The part of that wall's bearings on which it must be seen. Views.
        door_wall_seen: f64 = 0.75,
    }

    /// When the robot is in a hallway, and whether the hallway is clear.
    HallwayParams {
        /// Half the width of a hallway, from the least to the greatest. Geometry: in less the robot
        /// cannot turn, and the walls of a wider one are too far away to be seen.
        half_width: [f64; 2] = [0.45, 1.2],
        /// The walls must be closed this far ahead and behind, less half the width. Views: nearer to a
        /// turning point they are open at a side.
        closed: f64 = 1.4,
        /// The least length of wall that must be closed, ahead and behind. Geometry: somewhat more than
        /// the robot's length.
        min_closed: f64 = 0.5,
        /// Segments whose offsets differ by less are one wall. Views.
        same_wall: f64 = 0.10,
        /// The most walls to consider on each side. Views.
        max_walls: usize = 3,
        /// The floor must be seen to go on this far ahead, plus half the width. Views.
        floor_ahead: f64 = 0.75,
        /// If it is not, a wall at a side must go on this far ahead, plus half the width. Views.
        wall_ahead: f64 = 0.65,
        /// The least length of a major cluster. Views.
        major_length: f64 = 0.25,
        /// A major cluster begins at most this far from the robot, along the hallway. Views.
        major_distance: f64 = 0.9,
        /// The least trust in a hallway. Views.
        min_trust: f64 = 0.68,
        /// With this trust no junction is searched for. Views: a door of the floor's colour looks like
        /// an opening.
        sure_trust: f64 = 0.85,
        /// The least part of its walls that must be seen. Views.
        min_cover: f64 = 0.20,
        /// The floor ahead is searched for on this many bearings to either side. Geometry: 12 degrees.
        sector: usize = 24,
        /// Other clusters nearer than this, along the hallway, count neither as ahead nor as behind. Views.
        abreast: f64 = 0.3,
        /// A segment farther from the wall planes than this belongs to another cluster. Views.
        off_wall: f64 = 0.15,
        /// The sizes of the major clusters differ if one is less than this part of the other. Views.
        size_ratio: f64 = 0.5,
    }

    /// Which junction the robot is at.
    JunctionParams {
        /// The robot is at a junction if its turning point is at most this far ahead or aside. Views.
        ahead: f64 = 1.0,
        /// The robot has left a junction whose turning point is farther behind. Views.
        behind: f64 = 0.75,
        /// Turning points farther away on either axis are not considered. Geometry: their walls are
        /// too far away to be seen.
        max_distance: f64 = 1.9,
        /// Every candidate is first compared on one bearing in this many. Views: faster, with the same
        /// results.
        coarse_step: usize = 5,
        /// The number of candidates that are then fitted. Views.
        short_list: usize = 6,
        /// The least trust in a junction. Views.
        min_trust: f64 = 0.75,
        /// The least part of its walls that must be seen. Views.
        min_cover: f64 = 0.40,
        /// The fewest bearings in support, as a part of all. Views.
        min_support: f64 = 0.17,
        /// The least lead over a different junction, in bearings as a part of all. Views.
        min_lead: f64 = 0.04,
        /// Junctions whose turning points are nearer to each other are the same. Views.
        same_place: f64 = 0.25,
        /// Candidates are the same if turning points and half widths differ by less. Views.
        same_candidate: f64 = 0.05,
    }

    /// The marker on the floor.
    MarkerParams {
        /// Its length. Geometry: the marker of Section 5.1.
        length: f64 = MARKER_LENGTH,
        /// Its width. Geometry: the marker of Section 5.1.
        width: f64 = MARKER_WIDTH,
        /// The least part of its area that must be seen. Views.
        min_seen: f64 = 0.12,
        /// The marker lies in front of the wall. Its colour farther behind is something else. Views.
        max_behind: f64 = 0.05,
        /// Points of its colour farther from their median are something else. Geometry: a little more
        /// than half its length.
        max_spread: f64 = 0.40,
        /// At a junction it lies this near to the turning point. Geometry: half its length.
        max_off_centre: f64 = 0.30,
    }
}

// paper: marker-sense.shape
/// The length of the marker of Section 5.1, in metres.
pub const MARKER_LENGTH: f64 = 0.60;
/// Its width, in metres.
pub const MARKER_WIDTH: f64 = 0.18;

/// The radius of the SuperScout's body, in metres.
pub const ROBOT_RADIUS: f64 = 0.205;

impl HallwayParams {
    /// Whether a hallway can be this wide; `half` is half its width.
    pub fn has_width(&self, half: f64) -> bool {
        (self.half_width[0]..=self.half_width[1]).contains(&half)
    }
}

#[cfg(test)]
mod tests {
    use std::fmt::Debug;

    use serde::Serialize;

    use super::*;
    use crate::{camera, colour, laser};

    fn is_read_as_written<P: Parameter + DeserializeOwned + Serialize + PartialEq + Debug>(
        params: P,
    ) {
        assert_eq!(read(&toml::to_string(&params).unwrap()), Ok(params));
    }

    #[test]
    fn every_default_is_in_its_range() {
        is_read_as_written(SensingParams::DEFAULT);
        is_read_as_written(camera::params::RimParams::DEFAULT);
        is_read_as_written(camera::params::UnchangingParams::DEFAULT);
        is_read_as_written(colour::params::LightParams::DEFAULT);
        is_read_as_written(colour::params::TrainingParams::DEFAULT);
        is_read_as_written(laser::params::LaserParams::DEFAULT);
        is_read_as_written(laser::params::ArmViewParams::DEFAULT);
        is_read_as_written(laser::params::DriftParams::DEFAULT);
        is_read_as_written(laser::params::PlaceParams::DEFAULT);
    }

    #[test]
    fn a_whole_number_is_as_good_as_any_other() {
        let params: laser::params::LaserParams = read("[arm]\nmin_gap = 0").unwrap();
        assert!(params.arm.min_gap.abs() < 1e-12);
    }
}
