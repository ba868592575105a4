//! A simulated SuperScout: a base, a camera, perhaps a laser scanner, and faults. Section 2.5.

use std::sync::Arc;

use rand::{RngExt, SeedableRng, seq::IndexedRandom};
use rand_xoshiro::Xoshiro256PlusPlus;
use toposlam_logs::record::Frame;
use toposlam_model::{
    aid::AidAction,
    driving::pose::Pose,
    floor_plan::{FloorPlan, Rectangle},
};
use toposlam_robot::{
    any_explorer::RobotSensor,
    robot::{Robot, RobotError, Sample, TimedOdometry},
    run_settings::LaserVertices,
    superscout::{Base, Drive},
};

use super::{
    cameras::{FrameLight, RenderingCamera, SceneCamera, SimulatedCamera, corrupt},
    config::SimulationConfig,
    faults::{FaultKind, RobotFault},
    learned_sensors::LearnedSensors,
    motion::{MotionNoise, SimulatedBase},
    scanner::{CorridorPlan, LaserScanner, ScannerParams},
    sent_robot::SentRobot,
};
use crate::{
    render::{Building, BuildingLook, Effects, Rig, StreamPurpose, stream},
    truth::{LyingMarker, junction_at, nearest_direction},
};

/// A SuperScout with a gripper in a simulated building.
#[derive(Debug)]
pub struct SimulatedRobot {
    plan: Arc<FloorPlan>,
    pub(crate) base: SimulatedBase,
    camera: SimulatedCamera,
    scanner: Option<LaserScanner>,
    /// `None` if the robot carries it.
    marker: Option<LyingMarker>,
    /// Its team.
    other: Option<Box<SentRobot>>,
    faults: Vec<RobotFault>,
    seed: u64,
    frames: u64,
    last: Option<Frame>,
    /// What a fault has put in its way.
    pub(crate) obstacle: Option<Rectangle>,
}

/// The time to take an image, in seconds.
pub(crate) const IMAGE_TIME: f64 = 0.3;
/// How much an overexposed image is overexposed, in stops.
const OVEREXPOSURE: f64 = 4.0;
/// Distance of an obstacle ahead of the robot's centre, and its depth, in metres.
const AHEAD: f64 = 1.2;
const DEEP: f64 = 0.3;
/// The time to pick the marker up or to put it down, in seconds.
const GRIP_TIME: f64 = 5.0;

impl SimulationConfig {
    /// A robot with a camera that renders images of a building.
    pub fn with_images(
        &self,
        rig: &Arc<Rig>,
        look: &BuildingLook,
        effects: &Effects,
    ) -> SimulatedRobot {
        let mut building = Building::new(&self.plan, look, None, effects, self.seed);
        building.place_marker(Some(self.lying_marker()));
        let camera = RenderingCamera::new(rig.clone(), building, effects.clone(), self.seed);
        SimulatedRobot::new(self, SimulatedCamera::Images(Box::new(camera)))
    }

    /// A robot with a camera that reports scenes without images.
    pub fn by_scene(&self) -> SimulatedRobot {
        SimulatedRobot::new(self, SimulatedCamera::Scenes(self.scene_camera()))
    }

    /// A robot with a laser scanner and a detector of the marker, without a camera.
    pub fn by_laser(&self, params: &ScannerParams) -> SimulatedRobot {
        let robot = SimulatedRobot::new(self, SimulatedCamera::Marker(self.scene_camera()));
        robot.with_scanner(self.scanner(params))
    }

    /// A laser scanner in the robot's building. Its rooms, furniture and people follow from the seed.
    pub fn scanner(&self, params: &ScannerParams) -> LaserScanner {
        LaserScanner::new(&CorridorPlan::from(&*self.plan), params, self.seed)
    }

    fn scene_camera(&self) -> SceneCamera {
        let &Self { ref plan, noise, seed, .. } = self;
        SceneCamera { plan: plan.clone(), marker: Some(self.lying_marker()), noise, seed }
    }

    pub(crate) fn lying_marker(&self) -> LyingMarker {
        LyingMarker::along(&self.plan, self.marker).moved(self.marker_off)
    }
}

/// The sensors of a simulated robot.
#[derive(Debug)]
pub enum RobotEquipment {
    Scenes,
    /// A camera whose images are rendered, in buildings of several looks.
    Images(LearnedSensors),
    /// A laser scanner, and a detector of the marker.
    Laser(ScannerParams),
}

impl RobotEquipment {
    /// The sensors of robots with a camera that takes images.
    pub fn sensors(&self) -> Option<&LearnedSensors> {
        match self {
            Self::Images(sensors) => Some(sensors),
            Self::Scenes | Self::Laser(_) => None,
        }
    }

    pub(super) fn robot(
        &self,
        config: &SimulationConfig,
        number: u64,
    ) -> (SimulatedRobot, RobotSensor) {
        match self {
            Self::Scenes => (config.by_scene(), RobotSensor::Scenes),
            Self::Images(sensors) => {
                let look = sensors.look(number);
                let mut chance = Xoshiro256PlusPlus::seed_from_u64(config.seed);
                let robot = config.with_images(sensors.rig(), look, &Effects::drawn(&mut chance));
                (robot, RobotSensor::Camera(Box::new(sensors.sensor(look))))
            }
            Self::Laser(params) => {
                (config.by_laser(params), LaserVertices::OF_HALLWAYS.params().into())
            }
        }
    }
}

impl SimulatedRobot {
    fn new(config: &SimulationConfig, camera: SimulatedCamera) -> Self {
        let SimulationConfig { plan, pose, faults, seed, .. } = config.clone();
        let noise = MotionNoise::DEFAULT.times(config.noise);
        let mut base = SimulatedBase::new(&plan, pose, &noise, (seed, config.robot));
        if config.keeps_track {
            base.keep_track();
        }
        let (scanner, last, obstacle, other) = (None, None, None, None);
        let marker = Some(config.lying_marker());
        Self { plan, base, camera, scanner, marker, other, faults, seed, frames: 0, last, obstacle }
    }

    /// The same robot with another one in its team, instead of a marker: the first one sees that one's plate, and that one sees
    /// none.
    #[must_use]
    pub fn with_other(mut self, mut other: Self, sensor: RobotSensor) -> Self {
        other.marker = None;
        other.camera.place_marker(None);
        self.other = Some(Box::new(SentRobot::waiting(self.plan.clone(), other, sensor)));
        self
    }

    #[must_use]
    pub fn with_scanner(self, scanner: LaserScanner) -> Self {
        Self { scanner: Some(scanner), ..self }
    }

    /// The number of images or scans that were requested.
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// The frame of the next number, as it is now, unless it does not come.
    pub(crate) fn expose(&mut self) -> Option<Frame> {
        self.frames += 1;
        let number = self.frames;
        let is_blocked = |at: u64| {
            let mut blocked = self.faults.iter().filter(|fault| fault.kind == FaultKind::Blocked);
            blocked.any(|fault| fault.frame < number && !fault.has_passed(at))
        };
        if is_blocked(number - 1) && !is_blocked(number) {
            self.base.surroundings.obstacles.clear();
        }
        for fault in self.faults.clone().iter().filter(|fault| fault.frame == number) {
            self.begin(fault);
        }
        let spoilt = |kind| self.faults.iter().any(|f| f.kind == kind && f.spoils(number));
        let taken = self.base.time();
        let stops = if spoilt(FaultKind::OverExposed) { OVEREXPOSURE } else { 0.0 };
        let light = FrameLight { stops, is_dark: spoilt(FaultKind::LightsOut) };
        let odometry = self.base.reading().odometry;
        let frame = match &self.last {
            Some(last) if spoilt(FaultKind::Late) => last.clone(),
            Some(last) if spoilt(FaultKind::Frozen) => Frame { taken, odometry, ..last.clone() },
            _ => {
                let pose = self.base.pose();
                let frame = self.camera.frame(pose, number, light);
                let scan = self.scanner.as_ref().map(|scanner| scanner.scan(pose, number, taken));
                let scan = scan.and_then(Result::ok).map(Arc::new);
                let frame = Frame { taken, odometry, scan, ..frame };
                if spoilt(FaultKind::Corrupt) { corrupt(frame, number) } else { frame }
            }
        };
        if spoilt(FaultKind::Dropped) {
            return None;
        }
        self.last = Some(frame.clone());
        Some(frame)
    }

    fn begin(&mut self, fault: &RobotFault) {
        match fault.kind {
            FaultKind::Ignored => self.base.ignore(fault.lasting),
            FaultKind::Blocked => {
                let obstacle = across_hallway(self.base.pose(), &self.plan);
                self.obstacle = Some(obstacle);
                self.base.surroundings.obstacles.push(obstacle);
            }
            FaultKind::Carried => {
                self.base.pose = elsewhere(&self.plan, self.seed, fault.frame);
            }
            _ => {}
        }
    }
}

impl Robot for SimulatedRobot {
    fn capture(&mut self) -> Result<Frame, RobotError> {
        let frame = self.expose();
        self.base.wait(IMAGE_TIME);
        frame.ok_or(RobotError::NoImage)
    }

    fn turn(&mut self, angle: f64) -> Result<(), RobotError> {
        if self.base.begin() { Drive(&mut self.base).turn(angle) } else { Ok(()) }
    }

    fn forward(&mut self, distance: f64) -> Result<(), RobotError> {
        if self.base.begin() { Drive(&mut self.base).forward(distance) } else { Ok(()) }
    }

    /// The gripper reaches everything in the junction where the robot stands.
    fn handle(&mut self, action: AidAction) -> Result<(), RobotError> {
        if let (AidAction::Send { robot: robot @ 2, door }, Some(other)) = (action, &mut self.other)
        {
            let begun = other.time();
            let went = other.go(door);
            self.base.wait(other.time() - begun);
            let plate = went.map_err(|error| RobotError::NotSent {
                robot,
                door,
                cause: error.to_string(),
            })?;
            self.marker = Some(plate);
            self.camera.place_marker(self.marker);
            return Ok(());
        }
        if self.other.is_some() {
            return Err(RobotError::CannotHandle { action });
        }
        let pose = self.base.pose();
        self.base.wait(GRIP_TIME);
        self.marker = match (action, self.marker) {
            (AidAction::PickUp, None) => return Err(RobotError::Gripper { holds: true }),
            (AidAction::PickUp, Some(marker)) => {
                let is_here = junction_at(&self.plan, pose) == Some(marker.vertex);
                if !is_here {
                    return Err(RobotError::NothingGripped);
                }
                None
            }
            (AidAction::Drop, Some(_)) => return Err(RobotError::Gripper { holds: false }),
            (AidAction::Drop, None) => {
                Some(LyingMarker::below(&self.plan, pose).ok_or(RobotError::NotAtJunction)?)
            }
            (action, _) => return Err(RobotError::CannotHandle { action }),
        };
        self.camera.place_marker(self.marker);
        Ok(())
    }

    fn reported_degree(&mut self) -> Option<u32> {
        self.other.as_ref()?.degree()
    }

    fn odometry(&self) -> TimedOdometry {
        self.base.reading()
    }

    fn track(&self) -> &[Sample] {
        self.base.track()
    }

    fn truth(&self) -> Option<Pose> {
        Some(self.base.pose())
    }
}

/// An obstacle across the hallway ahead of a pose.
fn across_hallway(pose: Pose, plan: &FloorPlan) -> Rectangle {
    let [x, y] = nearest_direction(pose.heading).vector();
    let middle = [pose.position[0] + AHEAD * x, pose.position[1] + AHEAD * y];
    let half = [x, y].map(|along| if along == 0.0 { plan.hallway_width() } else { DEEP / 2.0 });
    Rectangle::centred(middle, half)
}

/// A random pose in a hallway, along it.
fn elsewhere(plan: &FloorPlan, seed: u64, frame: u64) -> Pose {
    let mut chance = stream(seed, StreamPurpose::Faults, frame as usize);
    let ends = plan
        .hallways()
        .choose(&mut chance)
        .map(|hallway| [hallway.from, hallway.to].map(|vertex| plan.junction(vertex).position));
    let [mut from, mut to] = ends.unwrap_or_default();
    if chance.random() {
        std::mem::swap(&mut from, &mut to);
    }
    let along = chance.random::<f64>();
    let position = [0, 1].map(|axis| from[axis] + along * (to[axis] - from[axis]));
    Pose { position, heading: (to[1] - from[1]).atan2(to[0] - from[0]) }
}
