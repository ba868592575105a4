//! Sensing: from an image to a scene. Section 3, Figure 5.

use image::RgbImage;
use nalgebra::{Isometry2, Point2};
use thiserror::Error;
use toposlam_model::driving::{
    odometry::Odometry,
    scene::{JunctionView, Place, Reason, Scene},
};

use crate::{
    boundary::{Bearings, Boundary},
    camera::Camera,
    cluster::{Cluster, clusters},
    colour::{ColourModel, ColourTable, FloorRing, Stripe, StripeKind},
    corner::{Corner, corners},
    geometry::from_robot,
    ground_view::GroundView,
    hallway::{FittedHallway, hallway},
    junction::{FittedJunction, JunctionSearch, junction},
    line::{WallLine, lines},
    marker::marker,
    place::{Certainty, PlaceArm, PlaceSensor, PlaceView, SeenPlace, ViewSector},
    wall::{WallFrame, WallSegment},
};

/// The fewest boundary points that can show a place. Views.
const MIN_POINTS: usize = 40;
/// The fewest bearings on which floor is seen; with fewer there is no scene. Geometry: a fifth of the 720 bearings.
const MIN_FLOOR_BEARINGS: usize = 144;

/// Sensing with one camera in one building. Its tables are computed once.
#[derive(Clone, Debug)]
pub struct Sensor {
    camera: Camera,
    ring: FloorRing,
    bearings: Bearings,
    model: ColourModel,
    colours: ColourTable,
    view: GroundView,
}

/// Sees places in the scenes of a camera, sensed now or recorded.
#[derive(Clone, Copy, Debug, Default)]
pub struct SceneSensor;

impl PlaceSensor for SceneSensor {
    type Frame = Scene;

    fn view(&mut self, scene: &Scene, odometry: &Odometry) -> Option<PlaceView> {
        let place = |junction: &JunctionView, certainty| {
            let doors = junction.doors.iter().map(|door| odometry.whither(door.direction));
            let centre = from_robot(odometry) * Point2::from(junction.turning_point);
            let arms = doors.map(|direction| PlaceArm { direction, certainty }).collect();
            SeenPlace { centre, clearance: 0.0, arms }
        };
        let (places, possible_places) = match &scene.place {
            Place::Junction(junction) if junction.is_certain() => {
                let place = place(junction, Certainty::Certain);
                (vec![place.clone()], vec![place])
            }
            Place::Junction(junction) => (Vec::new(), vec![place(junction, Certainty::Possible)]),
            Place::Hallway(_) | Place::Unknown(_) => (Vec::new(), Vec::new()),
        };
        Some(PlaceView {
            robot: *odometry,
            odometry_from_map: Isometry2::identity(),
            places,
            possible_places,
            facts: None,
            sector: ViewSector::ALL_AROUND,
            width: None,
            scene: Some(scene.clone()),
        })
    }
}

/// An image of another size than the camera's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error(
    "the image has {} x {} pixels; those of the calibrated camera have {} x {}",
    .found[0], .found[1], .expected[0], .expected[1]
)]
pub struct WrongSize {
    pub found: [u32; 2],
    pub expected: [u32; 2],
}

/// The results of all steps that lead to a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SensingTrace {
    pub boundary: Option<Boundary>,
    pub clusters: Vec<Cluster>,
    pub lines: Vec<WallLine>,
    /// The frame along which most of them run.
    pub frame: Option<WallFrame>,
    /// The lines that run along its axes.
    pub walls: Vec<WallSegment>,
    pub corners: Vec<Corner>,
    pub hallway: Option<FittedHallway>,
    /// The junction, if one was searched for and found.
    pub junction: Option<FittedJunction>,
}

impl Sensor {
    /// Sensing with a camera in a building with these colours.
    pub fn new(camera: &Camera, colours: &ColourModel) -> Self {
        Self {
            camera: camera.clone(),
            ring: FloorRing::new(camera),
            bearings: Bearings::new(colours.stripe, camera.eye_height()),
            colours: colours.table(),
            model: colours.clone(),
            view: GroundView::unseen(camera),
        }
    }

    /// The scene in an image.
    ///
    /// # Errors
    /// Returns an error if the image is not of the calibrated camera's size.
    pub fn sense(&mut self, image: &RgbImage) -> Result<Scene, WrongSize> {
        self.trace(image).map(|(scene, _)| scene)
    }

    /// The scene in an image, and the results of the steps that lead to it.
    ///
    /// # Errors
    /// As [`Self::sense`].
    pub fn trace(&mut self, image: &RgbImage) -> Result<(Scene, SensingTrace), WrongSize> {
        let found = [image.width(), image.height()];
        if found != self.camera.image {
            return Err(WrongSize { found, expected: self.camera.image });
        }
        let gain = match self.model.gain(&self.ring.colours(image)) {
            Ok(gain) => gain,
            Err(light) => {
                self.view.clear();
                let scene = Scene { place: Place::Unknown(light.into()), marker: None };
                return Ok((scene, SensingTrace::default()));
            }
        };
        self.view.show(image, &self.colours.lit(gain));
        Ok(interpreted(&self.view, &self.bearings))
    }

    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The ground view of the last image.
    pub fn ground_view(&self) -> &GroundView {
        &self.view
    }
}

/// The scene in a ground view, and the results of the steps that lead to it.
// paper: sense.hallway.first
fn interpreted(view: &GroundView, bearings: &Bearings) -> (Scene, SensingTrace) {
    let (mut place, trace) = place_within(bearings.look(view), margin(bearings.stripe));
    if let (Place::Junction(view), Some(junction)) = (&mut place, &trace.junction) {
        view.confidence = junction.confidence_in_image();
    }
    let junction = match &place {
        Place::Junction(junction) if junction.is_certain() => Some(junction),
        Place::Junction(_) | Place::Hallway(_) | Place::Unknown(_) => None,
    };
    let boundary = trace.boundary.as_ref();
    let marker = boundary.and_then(|boundary| marker(view, boundary, junction));
    (Scene { marker, place }, trace)
}

/// The place within a boundary, and the results of the steps that lead to it. `margin` is the distance from
/// the boundary to the wall planes, in metres.
fn place_within(mut boundary: Boundary, margin: f64) -> (Place, SensingTrace) {
    let clusters = clusters(&boundary);
    let lines = lines(&clusters);
    let frame = WallFrame::fit(&lines);
    let walls = frame.map_or_else(Vec::new, |frame| frame.walls(&lines));
    if let Some(frame) = &frame {
        let on_wall =
            |point| walls.iter().any(|wall| wall.confirms(frame.walls_from_robot() * point));
        boundary.confirm(on_wall);
    }
    let hallway = frame.and_then(|frame| hallway(&walls, &boundary, &frame));
    let mut trace =
        SensingTrace { clusters, lines, frame, walls, hallway, ..SensingTrace::default() };
    let place = place(&mut trace, &boundary, margin);
    trace.boundary = Some(boundary);
    (place, trace)
}

/// The distance from the edge that is seen, between floor and stripe, to the wall plane, in metres.
fn margin(stripe: Stripe) -> f64 {
    match stripe.kind {
        StripeKind::OnFloor => stripe.width,
        StripeKind::OnWall => 0.0,
    }
}

/// Where the robot is. It searches for a hallway first, then for a junction.
fn place(trace: &mut SensingTrace, boundary: &Boundary, margin: f64) -> Place {
    if boundary.sights.iter().filter(|sight| sight.floor > 0.0).count() < MIN_FLOOR_BEARINGS {
        return Place::Unknown(Reason::NoFloor);
    }
    let Some(frame) = trace.frame.filter(|_| boundary.points().count() >= MIN_POINTS) else {
        return Place::Unknown(Reason::FewWalls);
    };
    let in_hallway = |hallway: &FittedHallway| Place::Hallway(hallway.view(margin));
    if let Some(hallway) = trace.hallway.as_ref().filter(|hallway| hallway.is_sure()) {
        return in_hallway(hallway);
    }
    trace.corners = corners(&trace.walls);
    let otherwise = |reason| match &trace.hallway {
        Some(hallway) => in_hallway(hallway),
        None => Place::Unknown(reason),
    };
    match junction(&trace.corners, &trace.walls, boundary, &frame) {
        JunctionSearch::Nothing => otherwise(Reason::NothingFits),
        JunctionSearch::Ambiguous => otherwise(Reason::Ambiguous),
        JunctionSearch::Junction(junction) => {
            trace.junction = Some(junction);
            if junction.is_here() {
                return Place::Junction(junction.view());
            }
            trace.hallway = junction.hallway(&trace.walls);
            match &trace.hallway {
                Some(hallway) => in_hallway(hallway),
                None => Place::Unknown(Reason::NothingFits),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use toposlam_model::driving::scene::wrapped;

    use super::*;
    use crate::{
        colour::PixelClass,
        drawn_place::{self, DrawnPlace},
    };

    /// Each kind of junction: whether it has a door ahead, to the left, behind and to the right.
    const KINDS: [[bool; 4]; 6] = [
        [false, false, true, false],
        [false, true, true, false],
        [false, false, true, true],
        [false, true, true, true],
        [true, true, true, false],
        [true, false, true, true],
    ];
    /// Half the width of the hallway, offset to the left, heading.
    const VIEWS: [(f64, f64, f64); 3] = [(0.8, 0.0, 0.0), (0.7, 0.2, 0.3), (1.0, -0.3, 0.4)];

    fn scene(doors: [bool; 4], before: f64, view: usize) -> Place {
        let (half, left, heading) = VIEWS[view % VIEWS.len()];
        let drawn = DrawnPlace::junction(doors, half).seen_from([-before, left], heading);
        interpreted(&drawn, &drawn_place::bearings()).0.place
    }

    // paper: sense.junction.type, sense.junction.entry, sense.centre-lines, sense.place
    // paper: drive.junction, alg2.6
    // paper: sense.junction.two, sense.junction.three
    #[test]
    fn every_junction_is_found_from_half_a_metre_before_it_to_beyond_it() {
        for (number, doors) in KINDS.into_iter().enumerate() {
            for (step, before) in [0.5, 0.2, 0.0, -0.1].into_iter().enumerate() {
                let view = number + step;
                let (_, left, heading) = VIEWS[view % VIEWS.len()];
                let Place::Junction(junction) = scene(doors, before, view) else {
                    panic!("{doors:?} {before} before");
                };
                let found: Vec<f64> = junction.doors.iter().map(|door| door.direction).collect();
                let ideal: Vec<f64> = [2_u32, 1, 0, 3]
                    .into_iter()
                    .filter(|&number| doors[number as usize])
                    .map(|number| f64::from(number) * FRAC_PI_2 - heading)
                    .collect();
                assert_eq!(found.len(), ideal.len(), "{doors:?} {before} before");
                for (found, ideal) in found.iter().zip(&ideal) {
                    assert!(wrapped(found - ideal).abs() < 0.01, "{found} is not {ideal}");
                }
                let [x, y] = junction.turning_point;
                let along = x * heading.cos() - y * heading.sin();
                let across = x * heading.sin() + y * heading.cos();
                assert!((along - before).abs() < 0.01, "{along} is not {before}");
                assert!((across + left).abs() < 0.01, "{across} is not {left}");
            }
        }
    }

    // paper: sense.hallway.first, sense.distances, sense.parallel, sense.opposite
    // paper: sense.hallway.two-clusters
    #[test]
    fn a_metre_and_a_half_before_a_junction_is_a_hallway() {
        for (number, doors) in KINDS.into_iter().enumerate() {
            for (step, before) in [1.5, 2.5].into_iter().enumerate() {
                let view = number + step;
                let (half, left, heading) = VIEWS[view % VIEWS.len()];
                let Place::Hallway(hallway) = scene(doors, before, view) else {
                    panic!("{doors:?} {before} before");
                };
                assert!((hallway.heading + heading).abs() < 0.01, "{hallway:?}");
                assert!((hallway.left - half + left).abs() < 0.01, "{hallway:?}");
                assert!((hallway.right - half - left).abs() < 0.01, "{hallway:?}");
            }
        }
    }

    #[test]
    fn without_floor_or_walls_the_scene_is_unknown_with_a_reason() {
        let reason = |class| {
            let mut view = GroundView::drawn();
            view.classes.fill(class);
            interpreted(&view, &drawn_place::bearings()).0.place
        };
        assert_eq!(reason(PixelClass::Other), Place::Unknown(Reason::NoFloor));
        assert_eq!(reason(PixelClass::Stripe), Place::Unknown(Reason::NoFloor));
        assert_eq!(reason(PixelClass::Unseen), Place::Unknown(Reason::NoFloor));
        assert_eq!(reason(PixelClass::Floor), Place::Unknown(Reason::FewWalls));
    }
}
