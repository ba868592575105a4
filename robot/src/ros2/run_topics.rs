//! What a run publishes while it goes on: its state, and its map in the project's own message and as markers.

use std::sync::Arc;

use toposlam_logs::{
    map_message,
    message::Message,
    messages::{self, ProjectMessage, Stamp},
    record::{Event, EventKind, MapRecord, RunObserver},
};
use toposlam_model::{
    mapping::{MappingEvent, SafeguardEvent},
    percept::Door,
};

use super::{
    markers::{MARKERS, MARKERS_TYPE, VisitedPlace, markers},
    messages::write,
    node::{DdsNode, Writer},
    status::PublishedState,
};
use crate::robot::RobotError;

/// Publishes a run.
pub struct RunTopics {
    state: Arc<PublishedState>,
    map: Writer,
    markers: Writer,
    /// The visits since the robot last did not know where it was.
    visits: Vec<VisitedPlace>,
    position: [f64; 2],
    door: Option<Door>,
}

impl RunTopics {
    pub(super) fn new(node: &DdsNode, state: Arc<PublishedState>) -> Result<Self, RobotError> {
        let map = node.advertise_last(messages::Map::TOPIC, messages::Map::TYPE)?;
        let markers = node.advertise_last(MARKERS, MARKERS_TYPE)?;
        let (visits, position) = (Vec::new(), [0.0; 2]);
        Ok(Self { state, map, markers, visits, position, door: None })
    }

    fn show(&mut self, time: u64, map: &MapRecord) {
        // A robot maps without spectators, too.
        let _ = self.map.publish(write(&map_message(Stamp::from_nanoseconds(time), map)));
        let _ = self.markers.publish(markers(map, &self.visits));
        let known = map.opposite.iter().flatten().count();
        self.state.change(|state| {
            state.vertices = map.degrees.len();
            state.edges = known / 2;
            state.unexplored = map.opposite.len() - known;
        });
    }
}

impl RunObserver for RunTopics {
    fn event(&mut self, event: &Event) {
        match &event.kind {
            EventKind::Odometry(odometry) => self.position = odometry.position,
            EventKind::Door { number, door } => {
                self.door = Some(*door);
                self.state.change(|state| {
                    state.moves = number.map_or(state.moves + 1, u64::from);
                    state.activity = format!("driving to the next junction by door {}", door.0);
                });
            }
            EventKind::Arrival(arrival) => {
                let (door, degree, position) = (self.door, arrival.degree, self.position);
                self.visits.push(VisitedPlace { door, degree, position });
                self.state.change(|state| {
                    state.activity = format!("at a junction of degree {degree}");
                });
            }
            EventKind::Hypothesis {
                event: MappingEvent::Safeguard(SafeguardEvent::Relocated),
                ..
            } => {
                let here = self.visits.len().saturating_sub(1);
                self.visits.drain(..here);
            }
            EventKind::Map(map) => self.show(event.time, map),
            EventKind::End(end) => self.state.change(|state| state.end(end)),
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use toposlam_logs::{
        decode::decode,
        definition::{Definition, Dialect},
        message::schema,
    };
    use toposlam_model::embedded_graph::Dart;

    use super::*;

    /// The definition is the one that `ros2/toposlam_msgs` installs.
    #[test]
    fn a_map_is_published_as_its_definition_says() {
        let map = MapRecord {
            moves: 3,
            degrees: vec![2, 1],
            opposite: vec![Some(Dart(2)), None, Some(Dart(0))],
            robot: Dart(2),
        };
        let stamp = Stamp { sec: 5, nanosec: 6 };
        let body = write(&map_message(stamp, &map));
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../ros2/toposlam_msgs/msg/Map.msg");
        let text = schema(&std::fs::read_to_string(folder).unwrap());
        let definition = Definition::read(Dialect::Ros2, "toposlam_msgs/Map", &text).unwrap();
        let encoded = [&[0, 1, 0, 0], body.as_slice()].concat();
        let message = decode(&definition, &encoded).unwrap();
        let field = |name| message.at(name).unwrap();
        let list = |name| -> Vec<_> {
            field(name).elements().unwrap().iter().map(|number| number.i64().unwrap()).collect()
        };
        assert_eq!(field("stamp").stamp(), Some(stamp));
        assert_eq!((field("move").u64(), field("robot").u64()), (Some(3), Some(2)));
        assert_eq!((list("degrees"), list("opposite")), (vec![2, 1], vec![2, -1, 0]));
    }
}
