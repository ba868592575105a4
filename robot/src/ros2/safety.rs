//! Bumpers, cliff sensors and batteries of robots that have them: topics of known names and types.

use std::{
    sync::{
        Arc,
        mpsc::{self, RecvTimeoutError},
    },
    thread::{self, JoinHandle},
    time::Duration,
};

use serde::Deserialize;
use toposlam_logs::standard::Header;

use super::{
    messages::{EncodedBody, read},
    node::DdsNode,
    status::PublishedState,
    wheels::WheelsTopic,
};
use crate::{live::messages::RawBytes, robot::RobotError};

/// What a message shows of the safety of a robot.
#[derive(Clone, Copy, Debug, PartialEq)]
enum SafetyReading {
    Clear,
    /// The robot must not go on.
    Hazard(&'static str),
    /// The part of its charge that a battery has, in hundredths.
    Battery(u8),
}

/// A topic of a robot, and how it is read; `None` for a message that is not of this type.
struct SafetyTopic {
    name: &'static str,
    type_name: &'static str,
    read: fn(&EncodedBody) -> Option<SafetyReading>,
}

const BUMPER: SafetyReading = SafetyReading::Hazard("the bumper is pressed");
const CLIFF: SafetyReading = SafetyReading::Hazard("there is a cliff");
const WHEEL_DROP: SafetyReading = SafetyReading::Hazard("a wheel hangs in the air");
const STALL: SafetyReading = SafetyReading::Hazard("a wheel is blocked");

const TOPICS: [SafetyTopic; 6] = [
    // Create 3, TurtleBot 4.
    SafetyTopic {
        name: "/hazard_detection",
        type_name: "irobot_create_msgs/msg/HazardDetectionVector",
        read: read_create_3,
    },
    // TurtleBot 3. What its cliff sensor reads depends on the floor.
    SafetyTopic {
        name: "/sensor_state",
        type_name: "turtlebot3_msgs/msg/SensorState",
        read: read_turtlebot_3,
    },
    // Kobuki.
    SafetyTopic {
        name: "/events/bumper",
        type_name: "kobuki_ros_interfaces/msg/BumperEvent",
        read: |body| read_kobuki::<(u8, u8)>(body, |event| event.1, BUMPER),
    },
    SafetyTopic {
        name: "/events/cliff",
        type_name: "kobuki_ros_interfaces/msg/CliffEvent",
        read: |body| read_kobuki::<(u8, u8, u16)>(body, |event| event.1, CLIFF),
    },
    SafetyTopic {
        name: "/events/wheel_drop",
        type_name: "kobuki_ros_interfaces/msg/WheelDropEvent",
        read: |body| read_kobuki::<(u8, u8)>(body, |event| event.1, WHEEL_DROP),
    },
    SafetyTopic {
        name: "/battery_state",
        type_name: "sensor_msgs/msg/BatteryState",
        read: read_battery,
    },
];

type AnyHeader = Header<RawBytes>;

/// The types of hazards of a Create 3 that end a run. It also reports that it is close to something, which it is in every
/// hallway, and that it may not go backwards any more, which it never does.
fn read_create_3(body: &EncodedBody) -> Option<SafetyReading> {
    let (_, detections) = read::<(AnyHeader, Vec<(AnyHeader, u8)>)>(body)?;
    let hazard = detections.into_iter().find_map(|(_, kind)| match kind {
        1 => Some(BUMPER),
        2 => Some(CLIFF),
        3 => Some(STALL),
        4 => Some(WHEEL_DROP),
        _ => None,
    });
    Some(hazard.unwrap_or(SafetyReading::Clear))
}

/// `turtlebot3_msgs/msg/SensorState`.
#[derive(Deserialize)]
#[expect(dead_code, reason = "the fields are those of the message")]
struct SensorState {
    header: AnyHeader,
    bumper: u8,
    cliff: f32,
    sonar: f32,
    illumination: f32,
    led: u8,
    button: u8,
    torque: bool,
    encoders: [i32; 2],
    battery: f32,
}

fn read_turtlebot_3(body: &EncodedBody) -> Option<SafetyReading> {
    let is_pressed = read::<SensorState>(body)?.bumper != 0;
    Some(if is_pressed { BUMPER } else { SafetyReading::Clear })
}

fn read_kobuki<T: serde::de::DeserializeOwned>(
    body: &EncodedBody,
    state: fn(T) -> u8,
    hazard: SafetyReading,
) -> Option<SafetyReading> {
    Some(if state(read(body)?) == 0 { SafetyReading::Clear } else { hazard })
}

/// `sensor_msgs/msg/BatteryState`.
#[derive(Deserialize)]
#[expect(dead_code, reason = "the fields are those of the message")]
struct BatteryState {
    header: AnyHeader,
    voltage: f32,
    temperature: f32,
    current: f32,
    charges: [f32; 3],
    percentage: f32,
    kinds: [u8; 3],
    present: bool,
    cell_voltage: Vec<f32>,
    cell_temperature: Vec<f32>,
    location: RawBytes,
    serial_number: RawBytes,
}

fn read_battery(body: &EncodedBody) -> Option<SafetyReading> {
    let charge = read::<BatteryState>(body)?.percentage;
    // A part of 1; some drivers send hundredths.
    let charge = if charge > 1.0 { charge } else { charge * 100.0 };
    let is_known = (0.0..=100.0).contains(&charge);
    Some(if is_known { SafetyReading::Battery(charge.round() as u8) } else { SafetyReading::Clear })
}

/// Interval of looks for topics, and of the state.
const INTERVAL: Duration = Duration::from_secs(1);

/// A thread that looks for the topics of bumpers, cliff sensors and batteries, and publishes the state once a second. It
/// ends when this is dropped.
pub(super) struct SafetyWatch {
    end: Option<mpsc::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl SafetyWatch {
    /// # Errors
    /// Returns an error if there can be no thread.
    pub(super) fn new(
        node: Arc<DdsNode>,
        wheels: Arc<WheelsTopic>,
        state: Arc<PublishedState>,
    ) -> Result<Self, RobotError> {
        let (end, ends) = mpsc::channel();
        let watch = move || {
            let mut missing: Vec<_> = TOPICS.iter().collect();
            loop {
                missing.retain(|topic| !topic.subscribe(&node, &wheels, &state));
                state.publish();
                if ends.recv_timeout(INTERVAL) != Err(RecvTimeoutError::Timeout) {
                    return;
                }
            }
        };
        let thread = thread::Builder::new().spawn(watch);
        let thread = thread.map_err(|error| RobotError::NoDds { cause: error.to_string() })?;
        Ok(Self { end: Some(end), thread: Some(thread) })
    }
}

impl Drop for SafetyWatch {
    fn drop(&mut self) {
        drop(self.end.take());
        if let Some(thread) = self.thread.take() {
            // A panic of the thread does not matter any more.
            let _ = thread.join();
        }
    }
}

impl SafetyTopic {
    /// Subscribes if somebody publishes this topic with this type. Whether it is done. Another type is a warning.
    fn subscribe(
        &self,
        node: &DdsNode,
        wheels: &Arc<WheelsTopic>,
        state: &Arc<PublishedState>,
    ) -> bool {
        let types = node.published_types(self.name);
        let is_known = types.len() == 1 && types.contains(self.type_name);
        if !is_known {
            let types: Vec<_> = types.into_iter().collect();
            let cause = (!types.is_empty()).then(|| format!("its type is {}", types.join(" and ")));
            state.change(|state| state.show_unread(self.name, cause));
            return false;
        }
        let (wheels, state, read, name) = (wheels.clone(), state.clone(), self.read, self.name);
        let received = move |message: Option<EncodedBody>| {
            let reading = message.and_then(|body| read(&body));
            let fault = reading.is_none().then(|| "its messages have another form".to_owned());
            state.change(|state| state.show_unread(name, fault));
            match reading {
                Some(SafetyReading::Hazard(what)) => {
                    let hazard = RobotError::Hazard { topic: name, what };
                    if wheels.end(hazard.clone()) {
                        state.change(|state| state.hazard(&hazard));
                    }
                }
                Some(SafetyReading::Battery(charge)) => {
                    state.change(|state| state.battery = Some(charge));
                }
                Some(SafetyReading::Clear) | None => {}
            }
        };
        node.listen(self.name, self.type_name, false, received).is_ok()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use rustdds::RepresentationIdentifier;
    use serde::Serialize;
    use toposlam_logs::messages::Stamp;

    use super::*;
    use crate::ros2::messages::write;

    const HEADER: Header = Header { stamp: Stamp { sec: 1, nanosec: 2 }, frame_id: "base_link" };

    fn reading(type_name: &str, message: impl Serialize) -> Option<SafetyReading> {
        let encoding = RepresentationIdentifier::CDR_LE;
        let body = EncodedBody { encoding, bytes: write(&message) };
        let topic = TOPICS.iter().find(|topic| topic.type_name.ends_with(type_name)).unwrap();
        (topic.read)(&body)
    }

    #[test]
    fn bumpers_and_cliffs_are_hazards_and_walls_nearby_are_not() {
        let create = |kinds: &[u8]| {
            let detections: Vec<_> = kinds.iter().map(|&kind| (HEADER, kind)).collect();
            reading("HazardDetectionVector", (HEADER, detections))
        };
        assert_eq!(create(&[]), Some(SafetyReading::Clear));
        assert_eq!(create(&[0, 5]), Some(SafetyReading::Clear));
        assert_eq!(create(&[5, 1]), Some(BUMPER));
        assert_eq!(create(&[2]), Some(CLIFF));
        assert_eq!(create(&[4]), Some(WHEEL_DROP));
        let turtlebot = |bumper: u8| {
            let numbers = (0.5_f32, 0.0_f32, 3.0_f32, 0_u8, 0_u8, true);
            reading("SensorState", (HEADER, bumper, numbers, [5_i32, 6], 11.5_f32))
        };
        assert_eq!([turtlebot(0), turtlebot(2)], [Some(SafetyReading::Clear), Some(BUMPER)]);
        assert_eq!(reading("BumperEvent", (1_u8, 1_u8)), Some(BUMPER));
        assert_eq!(reading("BumperEvent", (1_u8, 0_u8)), Some(SafetyReading::Clear));
        assert_eq!(reading("CliffEvent", (1_u8, 1_u8, 900_u16)), Some(CLIFF));
        assert_eq!(reading("WheelDropEvent", (1_u8, 1_u8)), Some(WHEEL_DROP));
        assert_eq!(reading("WheelDropEvent", (1_u64, 1_u64)), None);
    }

    #[test]
    fn a_charge_is_a_part_of_1_or_of_100() {
        let battery = |percentage: f32| {
            let numbers = (12.0_f32, f32::NAN, -1.5_f32, [f32::NAN; 3], percentage);
            let cells: (Vec<f32>, Vec<f32>) = (vec![4.0; 3], vec![]);
            let texts = ("", "42");
            reading("BatteryState", (HEADER, numbers, [2_u8, 1, 2], true, cells, texts))
        };
        assert_eq!(battery(0.5), Some(SafetyReading::Battery(50)));
        assert_eq!(battery(50.0), Some(SafetyReading::Battery(50)));
        for unknown in [f32::NAN, -1.0, 1e9] {
            assert_eq!(battery(unknown), Some(SafetyReading::Clear));
        }
    }

    proptest! {
        #[test]
        fn no_bytes_are_too_strange(bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
            let body = EncodedBody { encoding: RepresentationIdentifier::CDR_LE, bytes };
            for topic in &TOPICS {
                let _ = (topic.read)(&body);
            }
        }
    }
}
