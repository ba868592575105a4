//! The cameras of simulated robots: one renders images, one reports scenes without images, one only the marker.
//! Sections 2.5 and 3.

use std::{
    f64::consts::{FRAC_PI_2, PI, TAU},
    sync::Arc,
};

use image::RgbImage;
use nalgebra::Vector2;
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;
use toposlam_logs::record::{CameraImage, Frame};
use toposlam_model::{
    driving::{
        pose::Pose,
        scene::{
            CentreLine, HallwayStatus, HallwayView, JunctionView, MarkerView, Place, Reason, Scene,
            Unclear, undirected, wrapped,
        },
    },
    floor_plan::FloorPlan,
};
use toposlam_vision::geometry::unit;

use crate::{
    render::{Building, Effects, Rig, StreamPurpose, exposed, file, stream},
    truth::{HallwayTruth, JunctionTruth, LyingMarker, Truth},
};

/// The camera of a simulated robot.
#[derive(Debug)]
pub(super) enum SimulatedCamera {
    Images(Box<RenderingCamera>),
    Scenes(SceneCamera),
    /// A detector of the marker alone, for a robot whose other sensors do not see it.
    Marker(SceneCamera),
}

/// The light in which a frame is taken.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FrameLight {
    /// Overexposure, in stops.
    pub(super) stops: f64,
    pub(super) is_dark: bool,
}

impl SimulatedCamera {
    /// Puts the marker elsewhere, or takes it away.
    pub(super) fn place_marker(&mut self, marker: Option<LyingMarker>) {
        match self {
            Self::Images(camera) => camera.building.place_marker(marker),
            Self::Scenes(camera) | Self::Marker(camera) => camera.marker = marker,
        }
    }

    /// The frame with this number from a pose. The robot fills in time and odometry.
    pub(super) fn frame(&mut self, pose: Pose, number: u64, light: FrameLight) -> Frame {
        match self {
            Self::Images(camera) => camera.frame(pose, number, light),
            Self::Scenes(camera) => {
                let scene = Some(camera.scene(pose, number, light));
                Frame { id: number, scene, ..Frame::default() }
            }
            Self::Marker(camera) => {
                let marker = camera.scene(pose, number, light).marker;
                Frame { id: number, marker, ..Frame::default() }
            }
        }
    }
}

pub(super) fn corrupt(frame: Frame, number: u64) -> Frame {
    let unknown = Scene { place: Place::Unknown(Reason::NothingFits), marker: None };
    let scene = frame.scene.and(Some(unknown));
    let image = frame.image.as_ref().and_then(CameraImage::file).map(|file| {
        let mut file = file.to_vec();
        let mut chance = stream(number, StreamPurpose::Faults, file.len());
        for _ in 0..=file.len() / DAMAGED {
            let at = chance.random_range(0..file.len().max(1));
            if let Some(byte) = file.get_mut(at) {
                *byte = chance.random();
            }
        }
        CameraImage::encoded(file)
    });
    Frame { image, scene, ..frame }
}

/// A camera that renders images of a building and encodes them as JPEG, or as PNG if its effects
/// have no compression.
///
/// It adapts its exposure like a real camera: after an overexposed image it exposes the next one
/// less, and then gradually returns to the exposure of its effects.
#[derive(Clone, Debug)]
pub(super) struct RenderingCamera {
    rig: Arc<Rig>,
    building: Building,
    effects: Effects,
    seed: u64,
    /// Exposure below that of its effects, in stops.
    less: f64,
}

/// Change of the exposure when the lights are out, in stops.
const OUT: f64 = -8.0;
/// One of this many bytes of a damaged file is changed.
const DAMAGED: usize = 400;
/// Level from which a channel is overexposed, of 255.
const BURNT: u8 = 250;
/// Radius of the metered area in the middle of the image, as a share of the mirror's radius.
const METERED: f64 = 0.35;
/// Share of overexposed pixels above which the exposure is reduced.
const TOO_MUCH: f64 = 0.1;
/// Reduction of the exposure after such an image, in stops.
const LESS: f64 = 0.4;
/// Share of overexposed pixels below which the exposure is raised again.
const LITTLE: f64 = 0.02;
/// Rise of the exposure after such an image, up to that of the effects, in stops.
const MORE: f64 = 0.1;

impl RenderingCamera {
    /// A camera in a building. The noise of its images follows from the seed.
    pub(super) fn new(rig: Arc<Rig>, building: Building, effects: Effects, seed: u64) -> Self {
        Self { rig, building, effects, seed, less: 0.0 }
    }

    /// Sets the exposure of the next image from this one.
    fn adapt(&mut self, image: &RgbImage) {
        let ([u, v], rim) = self.rig.rim();
        let reach = METERED * rim;
        let (mut metered, mut burnt) = (0_u32, 0_u32);
        for (column, row, pixel) in image.enumerate_pixels() {
            if (f64::from(column) - u).hypot(f64::from(row) - v) < reach {
                metered += 1;
                burnt += u32::from(pixel.0.iter().any(|&level| level >= BURNT));
            }
        }
        let share = f64::from(burnt) / f64::from(metered.max(1));
        if share > TOO_MUCH {
            self.less += LESS;
        } else if share < LITTLE {
            self.less = (self.less - MORE).max(0.0);
        }
    }

    fn frame(&mut self, pose: Pose, number: u64, light: FrameLight) -> Frame {
        let lights = if light.is_dark { OUT } else { 0.0 };
        let exposure = self.effects.exposure - self.less + light.stops + lights;
        let effects = Effects { exposure, ..self.effects.clone() };
        let seed = self.seed.wrapping_add(number);
        let image = exposed(&self.rig, &self.building, pose, &effects, seed);
        self.adapt(&image);
        let image = CameraImage::encoded(file(&image, &effects));
        Frame { id: number, image: Some(image), ..Frame::default() }
    }
}

/// A camera and sensing in one, without images. It reports scenes with the error rates and errors
/// that were measured for sensing.
#[derive(Clone, Debug)]
pub(super) struct SceneCamera {
    pub(super) plan: Arc<FloorPlan>,
    /// `None` if the robot carries it.
    pub(super) marker: Option<LyingMarker>,
    /// Multiple of the measured error rates and errors.
    pub(super) noise: f64,
    pub(super) seed: u64,
}

/// Share of unknown scenes: in `evaluate vision --views 20000 --seed 100`, 4 of 3,786
/// hallways and 7 of 4,758 junctions.
const UNKNOWN: f64 = 11.0 / 8_544.0;
/// Share of wrong junctions: there were none in 14,263 images of junctions and their surroundings.
/// This is about half the upper bound with a confidence of 95 %.
const WRONG: f64 = 1e-4;
/// Share of missed markers: 4 of 816 images.
const MISSED: f64 = 4.0 / 816.0;
/// Standard deviations, from the 95 % quantiles of the measured errors: directions of a hallway and
/// of a centre line in radians, distances to a side and to a centre line in metres.
const HEADING: f64 = 0.17 / 1.96 / 180.0 * PI;
const DIRECTION: f64 = 0.11 / 1.96 / 180.0 * PI;
const SIDE: f64 = 0.0081 / 1.96;
const PLACE: f64 = 0.0033 / 1.96;
/// Range in which a junction is recognized, from before its turning point to behind it, in metres.
const HERE: [f64; 2] = [-1.0, 0.75];
/// Standard deviation of both limits, in metres.
const HERE_OFF: f64 = 0.03;
/// Distances at which the marker is recognized, in metres.
const MARKER_SEEN: std::ops::Range<f64> = 0.2..1.5;

impl SceneCamera {
    fn scene(&self, pose: Pose, number: u64, light: FrameLight) -> Scene {
        let numbers = stream(self.seed, StreamPurpose::Scenes, number as usize);
        let mut chance = Chance { numbers, noise: self.noise };
        // Sensing fails on dark and on overexposed images.
        let truth = Truth::at(&self.plan, pose).filter(|_| light.stops < 1.0 && !light.is_dark);
        let Some(truth) = truth else {
            return Scene { place: Place::Unknown(Reason::NoFloor), marker: None };
        };
        let place = Self::place(&truth, &mut chance);
        Scene { place, marker: self.marker(pose, &truth, &mut chance) }
    }

    fn place(truth: &Truth, chance: &mut Chance) -> Place {
        if chance.happens(UNKNOWN) {
            return Place::Unknown(Reason::NothingFits);
        }
        match truth {
            Truth::Junction(junction) => reported_junction(junction, chance),
            Truth::Between(hallway, junctions) => {
                let here = junctions.iter().find(|junction| {
                    let [ahead, aside] = in_axes(junction);
                    let off = chance.off(HERE_OFF);
                    (HERE[0]..=HERE[1]).contains(&(-ahead + off)) && aside.abs() <= -HERE[0]
                });
                match here {
                    Some(junction) => reported_junction(junction, chance),
                    None => reported_hallway(hallway, junctions, chance),
                }
            }
            Truth::Hallway(hallway) => reported_hallway(hallway, &[], chance),
        }
    }

    fn marker(&self, pose: Pose, truth: &Truth, chance: &mut Chance) -> Option<MarkerView> {
        let lying = self.marker?;
        let near = truth.junctions().iter().any(|near| near.vertex == lying.vertex);
        let marker = lying.seen_from(&self.plan, pose);
        let [x, y] = marker.position;
        (near && MARKER_SEEN.contains(&x.hypot(y)) && !chance.happens(MISSED)).then(|| MarkerView {
            position: [x + chance.off(PLACE), y + chance.off(PLACE)],
            axis: undirected(marker.axis + chance.off(HEADING)),
            door: marker.door,
        })
    }
}

struct Chance {
    numbers: Xoshiro256PlusPlus,
    noise: f64,
}

impl Chance {
    fn happens(&mut self, rate: f64) -> bool {
        self.numbers.random::<f64>() < rate * self.noise
    }

    fn off(&mut self, deviation: f64) -> f64 {
        let standard: f64 = StandardNormal.sample(&mut self.numbers);
        standard * deviation * self.noise
    }
}

/// The turning point along the hallway axis that is nearest to ahead, and across it.
fn in_axes(junction: &JunctionTruth) -> [f64; 2] {
    let door = junction.doors.first().copied().unwrap_or(0.0);
    let axis = unit(door - (door / FRAC_PI_2).round() * FRAC_PI_2);
    let point = Vector2::from(junction.turning_point);
    [axis.dot(&point), axis.perp(&point)]
}

fn reported_hallway(truth: &HallwayTruth, near: &[JunctionTruth], chance: &mut Chance) -> Place {
    let ahead = near.iter().any(|junction| in_axes(junction)[0] > 0.0);
    Place::Hallway(HallwayView {
        heading: undirected(truth.heading + chance.off(HEADING)),
        left: truth.left + chance.off(SIDE),
        right: truth.right + chance.off(SIDE),
        status: if ahead {
            HallwayStatus::Unclear(Unclear::ClustersAhead)
        } else {
            HallwayStatus::Clear
        },
        confidence: 1.0,
    })
}

fn reported_junction(truth: &JunctionTruth, chance: &mut Chance) -> Place {
    let off = [chance.off(PLACE), chance.off(PLACE)];
    let turning_point = [0, 1].map(|axis| truth.turning_point[axis] + off[axis]);
    let turned = chance.off(DIRECTION);
    let mut doors = truth.doors.clone();
    if chance.happens(WRONG) {
        // One door too many or too few.
        mistaken(&mut doors, &mut chance.numbers);
    }
    let line = |direction: &f64| CentreLine {
        through: turning_point,
        direction: wrapped(direction + turned),
    };
    let view =
        JunctionView { doors: doors.iter().map(line).collect(), turning_point, confidence: 1.0 };
    Place::Junction(view.entered_from(PI))
}

/// Removes one of three doors, or adds one. The doors stay in clockwise order.
fn mistaken(doors: &mut Vec<f64>, numbers: &mut Xoshiro256PlusPlus) {
    let entry = doors[0];
    if doors.len() == 3 {
        doors.remove(numbers.random_range(1..3));
        return;
    }
    let clockwise = |door: f64| ((entry - door).rem_euclid(TAU) / FRAC_PI_2).round() as u32 % 4;
    let free: Vec<u32> =
        (1..4).filter(|&quarter| doors.iter().all(|&door| clockwise(door) != quarter)).collect();
    let quarter = free[numbers.random_range(0..free.len())];
    doors.push(entry - f64::from(quarter) * FRAC_PI_2);
    doors.sort_by_key(|&door| clockwise(door));
}

#[cfg(test)]
mod tests {
    use toposlam_model::embedded_graph::Dart;
    use toposlam_vision::camera;

    use super::*;
    use crate::{LOOKS, evaluation::judged_view::SceneClass, plan_named, start_pose, starts_of};

    /// Shape 6, its first start, and the pose there: at an L whose other door is to the left.
    fn at_start() -> (Arc<FloorPlan>, Dart, Pose) {
        let plan = plan_named("shape-6").unwrap();
        let facing = starts_of(&plan)[0];
        let pose = start_pose(&plan, facing);
        (plan, facing, pose)
    }

    #[test]
    fn scenes_are_wrong_as_often_as_measured() {
        let (plan, facing, pose) = at_start();
        let junction = JunctionTruth::from_plan(&plan, plan.graph().vertex(facing), pose);
        let right = SceneClass::Junction(junction.shape.unwrap());
        let count = |noise: f64| {
            let marker = Some(LyingMarker::along(&plan, facing));
            let camera = SceneCamera { plan: plan.clone(), marker, noise, seed: 4 };
            let scene = |number| camera.scene(pose, number, FrameLight::default());
            let classes: Vec<_> =
                (0..20_000).map(|number| SceneClass::from_scene(&scene(number))).collect();
            let unknown = classes.iter().filter(|&&class| class == SceneClass::Unknown).count();
            let wrong =
                classes.iter().filter(|&&class| class != SceneClass::Unknown && class != right);
            (unknown, wrong.count())
        };
        assert_eq!(count(0.0), (0, 0));
        let (unknown, wrong) = count(1.0);
        // The expected numbers are 25.7 and 2.
        assert!((10..45).contains(&unknown) && wrong < 9, "{unknown} {wrong}");
        let (unknown, wrong) = count(20.0);
        assert!((400..640).contains(&unknown) && (15..70).contains(&wrong), "{unknown} {wrong}");
    }

    #[test]
    fn a_mistaken_junction_is_another_one_from_the_same_entry() {
        let mut numbers = stream(1, StreamPurpose::Scenes, 0);
        for doors in [vec![PI], vec![PI, FRAC_PI_2], vec![PI, 0.0, -FRAC_PI_2]] {
            for _ in 0..20 {
                let mut other = doors.clone();
                mistaken(&mut other, &mut numbers);
                let quarters = other.iter().map(|door| (PI - door).rem_euclid(TAU) / FRAC_PI_2);
                let quarters: Vec<_> = quarters.map(f64::round).collect();
                assert!(other.len() != doors.len() && (1..=3).contains(&other.len()), "{other:?}");
                assert!(quarters[0] == 0.0 && quarters.is_sorted_by(|a, b| a < b), "{other:?}");
            }
        }
    }

    #[test]
    fn after_an_overexposed_image_the_next_is_exposed_less() {
        let (plan, _, pose) = at_start();
        let rig = Arc::new(Rig::new(&camera::Camera::superscout().sized([320, 240])));
        let burnt = |exposure: f64, frames: u64| {
            let effects = Effects { exposure, ..Effects::plain() };
            let building = Building::new(&plan, &LOOKS[0], None, &effects, 1);
            let mut camera = RenderingCamera::new(rig.clone(), building, effects, 1);
            let frame =
                (0..frames).map(|n| camera.frame(pose, n, FrameLight::default())).last().unwrap();
            let image = frame.image.unwrap();
            let image = image.pixels().unwrap();
            image.pixels().filter(|pixel| pixel.0.contains(&255)).count()
        };
        let [first, last] = [1, 12].map(|frames| burnt(3.0, frames));
        assert!(2 * last < first, "{last} {first}");
        assert_eq!(burnt(0.0, 1), burnt(0.0, 5), "nothing is burnt out");
    }
}
