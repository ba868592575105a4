//! The log of a simulated run, as a recorder writes it.

use std::io::{self, Write};

use image::{ImageFormat, RgbImage};
use mcap::MessageStream;
use toposlam_logs::{
    messages,
    record::{
        CameraImage, Event, EventKind, Frame, FrameSensor, NoSensor, RunObserver, SensingError,
    },
    recorder::{ANNOTATED, CMD_VEL, IMAGE, ODOM, Recorder, TF},
};
use toposlam_model::{
    driving::scene::Scene,
    mapping::{MappingAlgorithm, MappingError, MappingMethod},
};
use toposlam_robot::{
    any_explorer::RobotSensor,
    explorer::{ExplorerError, RobotExplorer},
    robot::{Robot, RobotError, TimedOdometry},
    run_settings::RunSettings,
};
use toposlam_simulator::{
    FaultKind, RobotFault, SimulatedRobot, SimulationConfig,
    run::{Run, run},
};
use toposlam_vision::camera::Camera;

use crate::recorded::{in_plan, recorded};

/// A run on shape 6, perhaps with a fault; the topic, the time and the body of each message of its log.
fn logged(fault: Option<RobotFault>, check: impl Fn(&Run)) -> Vec<Message> {
    let faults = fault.into_iter().collect();
    let config = SimulationConfig { faults, ..in_plan("shape-6", 5) };
    let settings = RunSettings::new(MappingAlgorithm::Algorithm1, 200);
    let (run, log) = recorded(&config, config.by_scene(), RobotSensor::Scenes, &settings);
    check(&run);
    messages(&log)
}

type Message = (String, u64, Vec<u8>);

fn messages(log: &[u8]) -> Vec<Message> {
    let messages = MessageStream::new(log).unwrap().map(Result::unwrap);
    messages.map(|m| (m.channel.topic.clone(), m.log_time, m.data.to_vec())).collect()
}

fn number(body: &[u8], at: usize) -> f64 {
    f64::from_le_bytes(body[4 + at..12 + at].try_into().unwrap())
}

#[test]
fn a_log_has_the_run_from_head_to_end_in_the_order_of_time() {
    let images = std::cell::Cell::new(0);
    let log = logged(None, |run| {
        assert_eq!((run.mapping.moves(), run.explore_moves), (8, 8));
        images.set(run.frames as usize);
    });
    let count = |topic: &str| log.iter().filter(|(found, ..)| found == topic).count();
    assert_eq!((&*log[0].0, &*log[log.len() - 1].0), ("/toposlam/run", "/toposlam/end"));
    assert!(log.is_sorted_by_key(|(_, time, _)| *time));
    assert_eq!((count("/toposlam/door"), count("/toposlam/percept")), (8, 9));
    // The start, and six edges.
    assert_eq!(count("/toposlam/map"), 7);
    assert_eq!((count(IMAGE), count(ANNOTATED)), (0, 0));
    assert_eq!(count("/toposlam/scene"), images.get());
    // All but the last image of each way are answered with a command.
    assert_eq!(count("/toposlam/scene"), count("/toposlam/command") + 9);
    assert_eq!(count(ODOM), count(TF));
}

#[test]
fn each_motion_ends_with_a_stop_and_the_robot_stands_where_a_image_is_taken() {
    let log = logged(None, |_| {});
    // The body of a twist: x ahead first, the turn about z last.
    let mut standing = true;
    let mut stops = 0;
    for (topic, _, body) in &log {
        match topic.as_str() {
            CMD_VEL => {
                let stop = number(body, 0) == 0.0 && number(body, 40) == 0.0;
                assert!(!(stop && standing), "it stood already");
                stops += u32::from(stop);
                standing = stop;
            }
            "/toposlam/scene" | "/toposlam/end" => assert!(standing),
            _ => {}
        }
    }
    assert!(stops > 60, "{stops}");
}

#[test]
fn the_end_of_a_log_has_the_reason_why_the_robot_gave_up() {
    let blocked = RobotFault::at(FaultKind::Blocked, 20);
    let log = logged(Some(blocked), |run| assert!(run.error.is_some()));
    let (topic, _, body) = &log[log.len() - 1];
    let text = String::from_utf8_lossy(body);
    assert!(topic == "/toposlam/end" && text.contains("gave-up\0"), "{text}");
    assert!(text.contains("3 commands in a row were not carried out"), "{text}");
}

/// A simulated robot without a camera image, to which the test adds one.
struct WithImages(SimulatedRobot);

impl Robot for WithImages {
    fn capture(&mut self) -> Result<Frame, RobotError> {
        let frame = self.0.capture()?;
        let mut file = io::Cursor::new(Vec::new());
        let colour = image::Rgb([frame.id as u8; 3]);
        RgbImage::from_pixel(64, 48, colour).write_to(&mut file, ImageFormat::Png).unwrap();
        Ok(Frame { image: Some(CameraImage::encoded(file.into_inner())), ..frame })
    }

    fn turn(&mut self, angle: f64) -> Result<(), RobotError> {
        self.0.turn(angle)
    }

    fn forward(&mut self, distance: f64) -> Result<(), RobotError> {
        self.0.forward(distance)
    }

    fn odometry(&self) -> TimedOdometry {
        self.0.odometry()
    }
}

/// Needs the pixels of each frame, as sensing and the page of a run do. An image that is kept stays where it is.
#[derive(Default)]
struct Pixels(Vec<CameraImage>);

impl FrameSensor for &mut Pixels {
    fn scene(&mut self, frame: &Frame) -> Result<Scene, SensingError> {
        let image = frame.image.as_ref().unwrap();
        image.pixels()?;
        self.0.push(image.clone());
        NoSensor.scene(frame)
    }
}

impl RunObserver for Pixels {
    fn event(&mut self, event: &Event) {
        if let EventKind::Frame(frame) = &event.kind {
            self.0.push(frame.image.clone().unwrap());
        }
    }
}

impl Pixels {
    /// Where the pixels of each image are.
    fn places(&self) -> Vec<*const u8> {
        self.0.iter().map(|image| image.pixels().unwrap().as_ptr()).collect()
    }
}

#[test]
fn a_frame_is_decoded_once_for_sensing_the_log_and_the_page() {
    let robot = WithImages(in_plan("shape-6", 5).by_scene());
    let camera = Some(Camera::superscout().sized([64, 48]));
    let mut log = Vec::new();
    let mut recorder = Recorder::new(&mut log, &messages::Run::default(), camera).unwrap();
    let [mut sensing, mut page] = <[Pixels; 2]>::default();
    let mut explorer = RobotExplorer::new(robot, &mut sensing, (&mut recorder, &mut page));
    let (_, mapped) = explorer.map(&RunSettings::new(MappingMethod::default(), 200));
    mapped.unwrap();
    assert!(page.0.len() > 60, "{}", page.0.len());
    assert_eq!(sensing.places(), page.places());
    recorder.finish().unwrap();
    let annotated = messages(&log).iter().filter(|(topic, ..)| topic == ANNOTATED).count();
    assert_eq!(annotated, page.0.len());
}

#[test]
fn a_full_disk_stops_the_run() {
    struct Full;
    impl Write for Full {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            // The head of a log is small.
            if bytes.len() > 2000 {
                Err(io::ErrorKind::StorageFull.into())
            } else {
                Ok(bytes.len())
            }
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }
    let config = in_plan("shape-6", 5);
    let mut recorder = Recorder::new(Full, &messages::Run::default(), None).unwrap();
    let (robot, settings) =
        (config.by_scene(), RunSettings::new(MappingAlgorithm::Algorithm1, 200));
    let run =
        run(&config.plan, config.marker, robot, RobotSensor::Scenes, &mut recorder, &settings);
    assert!(recorder.stop());
    let stopped = Some(MappingError::World(ExplorerError::Stopped { moves: 1 }));
    assert_eq!(run.error, stopped);
    assert!(recorder.finish().is_err());
}
