//! The entries of a log by a topic map, in the order of time.

use std::{collections::VecDeque, sync::Arc};

use toposlam_model::{
    driving::{odometry::Odometry, scene::wrapped},
    percept::Door,
};
use toposlam_vision::laser::scan::Scan;

use super::{
    carmen::{self, RecordedScan},
    container::LogFile,
    encode,
    error::{LogError, LogErrorKind},
    event_line::{self, Parsed},
    fiducials::{FiducialSighting, Fiducials, pose_at},
    from_value::FromValue,
    merge::{RawMessage, RawMessages},
    messages::{Hypothesis, Run, Stamp},
    reader::Log,
    reading_remark::{ReadingRemark, Unusable},
    scan_convention::ScanRepairs,
    scan_survey,
    sensor_data::{self, image_of},
    topic::Encoding,
    topic_map::{BoundTopicMap, Carried, MessagePart, Role},
    transforms::{Mount, Mounts},
    value::Value,
};
use crate::record::{Arrival, EventId, EventKind, Frame};

#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// When it was recorded, in nanoseconds.
    pub time: u64,
    /// Where it is in its file: see [`RawMessage::offset`].
    pub offset: u64,
    /// The number of its message in the log, counted from 1.
    pub id: EventId,
    pub topic: usize,
    /// The `stamp` or `header.stamp` of the message, or that of its transform; without one, when it was
    /// recorded.
    pub stamp: Stamp,
    pub content: Content,
}

/// The usual type of odometry.
const NAV_ODOMETRY: &str = "nav_msgs/Odometry";
/// A robot is not farther from where it began, in metres.
const FARTHEST: f64 = 1e7;

#[derive(Clone, Debug, PartialEq)]
pub enum Content {
    Run(Run),
    Hypothesis(Hypothesis),
    Fiducial(FiducialSighting),
    TurnedBack,
    Undecided,
    /// Any other event. A frame has an image, a scan or a scene, and the last odometry before it.
    Event(EventKind),
}

pub struct Entries<'l> {
    log: &'l Log,
    bound: BoundTopicMap,
    messages: RawMessages<'l>,
    mounts: Mounts<'l>,
    fiducials: Fiducials,
    odometry: Odometry,
    next: VecDeque<Entry>,
    unusable: Unusable,
    repairs: ScanRepairs,
}

impl Log {
    /// Its entries by a topic map, in the order of time. Ends after the first error.
    pub fn entries(&self, mapping: &BoundTopicMap) -> Entries<'_> {
        let messages = self.read(&mapping.topics());
        let carried = |role| mapping.carried.iter().find(|carried: &&Carried| carried.role == role);
        let odometry = carried(Role::Odometry).map(|carried| carried.topic);
        let scans = carried(Role::Scan).map(|carried| carried.topic);
        Entries {
            log: self,
            bound: mapping.clone(),
            messages,
            mounts: Mounts::new(self, mapping.scanner.clone(), odometry),
            fiducials: Fiducials::default(),
            odometry: Odometry::default(),
            next: VecDeque::new(),
            unusable: Unusable::default(),
            repairs: ScanRepairs::new(scans.and_then(|topic| scan_survey::of_topic(self, topic))),
        }
    }
}

impl Iterator for Entries<'_> {
    type Item = Result<Entry, LogError>;

    fn next(&mut self) -> Option<Self::Item> {
        while self.next.is_empty() {
            let read = self.messages.next()?.and_then(|message| self.read(&message));
            if let Err(error) = read {
                self.messages.end();
                return Some(Err(error));
            }
        }
        self.next.pop_front().map(Ok)
    }
}

impl Entries<'_> {
    /// What was repaired in the messages so far, and how many were skipped.
    pub fn remarks(&self) -> Vec<ReadingRemark> {
        let tracked = self.mounts.tracked_frame().map(str::to_owned);
        let tracked = tracked.map(|frame| ReadingRemark::TrackedFrame { frame });
        self.unusable.remark().into_iter().chain(tracked).chain(self.repairs.remarks()).collect()
    }

    /// Reads a message. One of a sensor that cannot be used is skipped, unless there are many.
    fn read(&mut self, message: &RawMessage) -> Result<(), LogError> {
        let Err(error) = self.decode(message) else { return Ok(()) };
        let mut carried = self.bound.carried.iter().filter(|one| one.topic == message.topic);
        let is_sensor = carried.all(|carried| carried.role.is_sensor());
        let topic = self.log.topics().get(message.topic).filter(|_| is_sensor);
        match (&error.cause, topic) {
            (LogErrorKind::Content { .. }, Some(topic)) => {
                self.unusable.add(error, message.topic, topic.messages)
            }
            _ => Err(error),
        }
    }

    fn decode(&mut self, message: &RawMessage) -> Result<(), LogError> {
        let log = self.log;
        let Some(topic) = log.topics().get(message.topic) else { return Ok(()) };
        let Some(file) = log.files.get(message.file) else { return Ok(()) };
        let RawMessage { time, offset, number, .. } = *message;
        let name = || topic.name.clone();
        let wrong =
            |what| file.error(LogErrorKind::Content { number, topic: name(), what }, offset);
        // What is the same for all messages.
        let fixed = |what| file.error(LogErrorKind::Frame { number, topic: name(), what }, offset);
        if topic.encoding == Encoding::Event {
            let (stamp, contents) = self.event(file, message).map_err(wrong)?;
            for content in contents {
                self.add(message, stamp.unwrap_or(Stamp::from_nanoseconds(time)), content);
            }
            return Ok(());
        }
        let Some(value) = topic.decode(&message.bytes) else { return Ok(()) };
        let value = value.map_err(|error| wrong(error.to_string()))?;
        let stamp = stamp(&value, time);
        let since_start = stamp.nanoseconds().saturating_sub(log.start().unwrap_or(0));
        let taken = since_start as f64 / 1e9;
        let is_carmen = topic.encoding == Encoding::Carmen;
        let of_topic = |carried: &&Carried| carried.topic == message.topic;
        let all: Vec<_> = self.bound.carried.iter().filter(of_topic).cloned().collect();
        for carried in all {
            let frame = Frame { id: number, taken, odometry: self.odometry, ..Frame::default() };
            match (carried.role, &*carried.type_name) {
                (Role::Scan, "sensor_msgs/LaserScan") => {
                    let frame_id: String = value.get("header.frame_id").unwrap_or_default();
                    let mount = self.mounts.get(&frame_id)?.map_err(fixed)?;
                    let scan = sensor_data::scan_of(&value, &mount, &mut self.repairs);
                    let scan = Some(Arc::new(scan.map_err(wrong)?));
                    self.add(message, stamp, EventKind::Frame(Frame { scan, ..frame }).into());
                }
                (role @ (Role::Scan | Role::Odometry), _) if carried.own && is_carmen => {
                    let parameters = &file.text.parameters;
                    let recorded =
                        carmen::reading(&topic.type_name, &value, parameters, &mut self.repairs);
                    let RecordedScan { scan, odometry } = recorded.map_err(wrong)?;
                    let is_wanted = role == Role::Odometry || self.bound.carries(Role::Odometry);
                    if let Some(odometry) = odometry.filter(|_| is_wanted) {
                        let odometry = on_earth(odometry).map_err(wrong)?;
                        self.add(message, stamp, EventKind::Odometry(odometry).into());
                    }
                    if role == Role::Scan {
                        let mount = self.mounts.stated_mount();
                        let scan = match mount {
                            None => scan,
                            Some(mount) => mounted(&scan, &mount).map_err(wrong)?,
                        };
                        let scan = Some(Arc::new(scan));
                        let odometry = odometry.unwrap_or(self.odometry);
                        let frame = Frame { odometry, scan, ..frame };
                        self.add(message, stamp, EventKind::Frame(frame).into());
                    }
                }
                (Role::Marker, _) => {
                    let odometry = self.odometry;
                    let found =
                        self.fiducials.sightings(&carried, &value, &odometry, &mut self.mounts)?;
                    for sighting in found.map_err(wrong)? {
                        self.add(message, stamp, Content::Fiducial(sighting));
                    }
                }
                (Role::Odometry, _) if carried.own => {
                    if let Some((odometry, stamped)) = self.mounts.odometry(&value)? {
                        let odometry = on_earth(odometry).map_err(wrong)?;
                        let stamp =
                            stamped.filter(|stamp| *stamp != Stamp::default()).unwrap_or(stamp);
                        self.add(message, stamp, EventKind::Odometry(odometry).into());
                    }
                }
                (Role::Odometry, NAV_ODOMETRY) if carried.is_usual => {
                    let pose = pose_at(&value, "pose.pose").map_err(wrong)?;
                    let child: String = value.get("child_frame_id").unwrap_or_default();
                    let odometry = on_earth(self.mounts.odometry_of(&pose, &child)?);
                    let kind = EventKind::Odometry(odometry.map_err(wrong)?);
                    self.add(message, stamp, kind.into());
                }
                _ => {
                    let content = content(&carried, &value, frame).map_err(wrong)?;
                    self.add(message, stamp, content);
                }
            }
        }
        Ok(())
    }

    fn event(
        &self,
        file: &LogFile,
        message: &RawMessage,
    ) -> Result<(Option<Stamp>, Vec<Content>), String> {
        let parsed = event_line::parse(&message.bytes, file.text.columns.as_ref())?;
        let Parsed::Event(event, degree) = parsed else { return Ok((None, Vec::new())) };
        let moves = match event.index.map(|index| index.checked_sub(file.text.first_event)) {
            Some(None) => return Err("its index is before that of the first event".to_owned()),
            Some(moves) => moves,
            None => None,
        };
        let sighting = event.sighting()?;
        let arrival =
            |degree| Arrival { number: moves, degree, sighting, shape: None, entry: None };
        let mut contents = Vec::new();
        if self.bound.carries(Role::Percept) {
            contents
                .extend(event.turned_back.filter(|turned| *turned).map(|_| Content::TurnedBack));
            let visit = degree.map(|degree| EventKind::Arrival(arrival(degree)).into());
            contents.push(visit.unwrap_or(Content::Undecided));
        }
        if self.bound.carries(Role::Door) {
            let done = event.actions()?.into_iter();
            contents.extend(done.map(|action| EventKind::Action { number: moves, action }.into()));
        }
        if let Some(door) = event.door.filter(|_| self.bound.carries(Role::Door)) {
            let number = moves.map(|moves| moves.saturating_add(1));
            contents.push(EventKind::Door { number, door: Door(door) }.into());
        }
        let stamp =
            event.stamp.map(|seconds| Stamp::from_nanoseconds((seconds * 1e9).round() as u64));
        Ok((stamp, contents))
    }

    fn add(&mut self, message: &RawMessage, stamp: Stamp, content: Content) {
        if let Content::Event(EventKind::Odometry(odometry)) = content {
            self.odometry = odometry;
        }
        let RawMessage { time, offset, number, topic, .. } = *message;
        self.next.push_back(Entry { time, offset, id: EventId(number), topic, stamp, content });
    }
}

/// A scan of a scanner whose mount is another one.
fn mounted(scan: &Scan, mount: &Mount) -> Result<Scan, String> {
    let scan = Scan::new(scan.geometry(), scan.ranges().to_vec(), mount.robot_from_scanner);
    scan.map_err(|error| error.to_string())
}

impl From<EventKind> for Content {
    fn from(kind: EventKind) -> Self {
        Self::Event(kind)
    }
}

fn stamp(value: &Value<'_>, time: u64) -> Stamp {
    let found = ["stamp", "header.stamp"].into_iter().find_map(|path| value.get(path));
    // Some drivers leave it 0.
    let found = found.filter(|stamp| *stamp != Stamp::default());
    found.unwrap_or(Stamp::from_nanoseconds(time))
}

/// Odometry on the Earth, in metres and radians: larger numbers are errors.
fn on_earth(odometry: Odometry) -> Result<Odometry, String> {
    let Odometry { position: [x, y], heading } = odometry;
    let is_near = [x, y].iter().all(|place| place.abs() <= FARTHEST);
    let is_turn = heading.abs() <= FARTHEST;
    if is_near && is_turn { Ok(odometry) } else { Err(format!("its pose is {x}, {y}, {heading}")) }
}

fn content(carried: &Carried, value: &Value<'_>, frame: Frame) -> Result<Content, String> {
    Ok(Content::Event(match carried.role {
        Role::Run => return Ok(Content::Run(own(value)?)),
        Role::Hypothesis => return Ok(Content::Hypothesis(own(value)?)),
        Role::Image => EventKind::Frame(Frame { image: Some(image_of(value)?), ..frame }),
        // A scan is read by its type.
        Role::Scan => return Err("it is not a scan".to_owned()),
        Role::Marker => return Err("it is not a marker".to_owned()),
        Role::Scene => {
            let scene = encode::scene_of(&own(value)?).ok_or("there is no such scene")?;
            EventKind::Frame(Frame { scene: Some(scene), ..frame })
        }
        Role::Odometry => EventKind::Odometry(odometry(carried, value)?),
        Role::Motion => EventKind::Motion {
            forward: number(carried, value, MessagePart::Forward)? * carried.length.in_metres(),
            turn: number(carried, value, MessagePart::Turn)? * carried.angle.in_radians(),
        },
        Role::Percept if carried.own => EventKind::Arrival(encode::arrival_of(&own(value)?)?),
        Role::Percept => {
            let marker = carried.paths.get(&MessagePart::Marker).and_then(|path| value.at(path));
            let words = marker.as_ref().and_then(Value::text);
            let marker = match (marker, words) {
                (Some(Value::Bool(is_seen)), _) => Some(encode::seen(is_seen)),
                (_, Some(words)) => Some(encode::sighting_in(&words)?),
                _ => {
                    let marker = whole::<i64>(carried, value, MessagePart::Marker)?;
                    marker.map(encode::sighting_of).transpose()?
                }
            };
            EventKind::Arrival(Arrival {
                number: whole(carried, value, MessagePart::Move)?,
                degree: whole(carried, value, MessagePart::Degree)?.unwrap_or_default(),
                sighting: marker,
                shape: None,
                entry: None,
            })
        }
        Role::Door if carried.own => encode::door_of(&own(value)?),
        Role::Door => EventKind::Door {
            number: whole(carried, value, MessagePart::Move)?,
            door: Door(whole(carried, value, MessagePart::Door)?.unwrap_or_default()),
        },
        Role::Action => encode::action_of(&own(value)?)?,
        Role::Command => encode::command_of(&own(value)?),
        Role::Map => EventKind::Map(encode::map_of(&own(value)?)),
        Role::End => {
            EventKind::End(encode::end_of(own(value)?).ok_or("there is no such `ending`")?)
        }
    }))
}

fn own<M: FromValue>(value: &Value<'_>) -> Result<M, String> {
    M::from_value(value)
        .map_err(|field| format!("its field `{field}` is missing, or is not what it should be"))
}

fn number(carried: &Carried, value: &Value<'_>, part: MessagePart) -> Result<f64, String> {
    let path = carried.paths.get(&part).map_or("", String::as_str);
    value.finite_at(path)
}

fn whole<N: TryFrom<i64>>(
    carried: &Carried,
    value: &Value<'_>,
    part: MessagePart,
) -> Result<Option<N>, String> {
    let Some(path) = carried.paths.get(&part) else { return Ok(None) };
    let found = value.at(path).ok_or_else(|| format!("it has no `{path}`"))?;
    let whole = found.i64().and_then(|number| N::try_from(number).ok());
    whole.map(Some).ok_or_else(|| format!("its `{path}` is no {}", part.name()))
}

fn odometry(carried: &Carried, value: &Value<'_>) -> Result<Odometry, String> {
    let [x, y] = [number(carried, value, MessagePart::X)?, number(carried, value, MessagePart::Y)?];
    let heading = match carried.paths.get(&MessagePart::Quaternion) {
        None => number(carried, value, MessagePart::Heading)? * carried.angle.in_radians(),
        Some(path) => {
            let rotation = value.quaternion_at(path, Value::finite_at)?;
            rotation.heading().ok_or_else(|| format!("its `{path}` is no rotation"))?
        }
    };
    let length = carried.length.in_metres();
    on_earth(Odometry { position: [x * length, y * length], heading: wrapped(heading) })
}
