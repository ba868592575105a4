//! Sightings of a marker that is a fiducial, as `apriltag_msgs`, `vision_msgs` and `geometry_msgs` record them.
//! The x axis of the fiducial points along a door.
//!
//! `apriltag_msgs` has no poses: the pose of a tag is a transform with the stamp of the detection, from the frame
//! of the camera to that of the tag, which is called `tag36h11:3` for the tag 3 of the family `tag36h11`.

use std::collections::VecDeque;

use nalgebra::{Isometry3, Vector3};
use toposlam_model::driving::odometry::Odometry;

use super::{
    error::LogError,
    messages::Stamp,
    topic_map::{APRIL_TAGS, Carried, DETECTIONS},
    transforms::{
        self, Mounts, frame_name, heading, is_odometry, is_transforms, isometry, on_floor,
    },
    value::Value,
};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FiducialSighting {
    /// Where the marker is, in metres in the frame of odometry.
    pub position: [f64; 2],
    /// The direction of its x axis, in radians counter-clockwise from the x axis of odometry.
    pub heading: f64,
}

/// Detections and transforms of tags that wait for each other.
#[derive(Default)]
pub(super) struct Fiducials {
    detections: VecDeque<(Stamp, String)>,
    tags: VecDeque<(Stamp, String, Placed)>,
}

struct Placed {
    frame: String,
    pose: Isometry3<f64>,
}

/// The detections and transforms that wait, at most.
const WAITING: usize = 64;
/// The x axis of a fiducial has a direction on the floor if so much of it is level: 30 degrees off upright.
const LEVEL: f64 = 0.5;

impl Fiducials {
    /// The sightings in a message of the topic of the marker, or in transforms.
    pub(super) fn sightings(
        &mut self,
        carried: &Carried,
        message: &Value<'_>,
        odometry: &Odometry,
        mounts: &mut Mounts<'_>,
    ) -> Result<Result<Vec<FiducialSighting>, String>, LogError> {
        let found = match &*carried.type_name {
            APRIL_TAGS => detected_tags(carried, message).map(|tags| {
                self.detections.extend(tags);
                self.matched()
            }),
            kind if is_transforms(kind) => {
                let tags = transforms::transforms(message).into_iter();
                self.tags.extend(tags.filter_map(|transform| {
                    let placed =
                        Placed { frame: transform.parent, pose: transform.parent_from_child };
                    Some((transform.stamp?, transform.child, placed))
                }));
                Ok(self.matched())
            }
            DETECTIONS => detected_objects(carried, message),
            _ => posed(message).map(|placed| vec![placed]),
        };
        let found = match found {
            Ok(found) => found,
            Err(what) => return Ok(Err(what)),
        };
        let mut sightings = Vec::new();
        for placed in found {
            let frame = frame_name(&placed.frame);
            let pose = if is_odometry(&frame) {
                placed.pose
            } else {
                match mounts.pose_of(&frame)? {
                    Ok(robot_from_frame) => on_floor(odometry) * robot_from_frame * placed.pose,
                    Err(what) => return Ok(Err(what)),
                }
            };
            if (pose * Vector3::x()).xy().norm() < LEVEL {
                return Ok(Err("the x axis of the marker points up or down".to_owned()));
            }
            sightings.push(FiducialSighting {
                position: pose.translation.vector.xy().into(),
                heading: heading(&pose),
            });
        }
        Ok(Ok(sightings))
    }

    fn matched(&mut self) -> Vec<Placed> {
        let mut found = Vec::new();
        self.detections.retain(|(stamp, frame)| {
            let is_its =
                |(time, child, _): &(Stamp, String, Placed)| time == stamp && child == frame;
            let place = self.tags.iter().position(is_its);
            let placed = place.and_then(|place| self.tags.remove(place));
            let waits = placed.is_none();
            found.extend(placed.map(|(_, _, placed)| placed));
            waits
        });
        // The other of an old one is missing.
        self.detections.drain(..self.detections.len().saturating_sub(WAITING));
        self.tags.drain(..self.tags.len().saturating_sub(WAITING));
        found
    }
}

/// The stamps and the frames of the tags in a message of `apriltag_msgs`.
fn detected_tags(carried: &Carried, message: &Value<'_>) -> Result<Vec<(Stamp, String)>, String> {
    let stamp: Stamp = message.get("header.stamp").ok_or("it has no `header.stamp`")?;
    let mut tags = Vec::new();
    for tag in message.list_at("detections") {
        let id: i64 = tag.get("id").ok_or("a detection in it has no `id`")?;
        let family: String = tag.get("family").unwrap_or_default();
        let name = format!("{family}:{id}");
        let wanted = carried.id.as_ref();
        if wanted.is_none_or(|wanted| *wanted == id.to_string() || *wanted == name) {
            tags.push((stamp, carried.frame.as_ref().map_or(name, |frame| frame_name(frame))));
        }
    }
    Ok(tags)
}

/// The poses in a message of `vision_msgs`: of each detection, that of its best hypothesis.
fn detected_objects(carried: &Carried, message: &Value<'_>) -> Result<Vec<Placed>, String> {
    let mut found = Vec::new();
    for object in message.list_at("detections") {
        let results = object.list_at("results");
        let score = |result: &Value<'_>| {
            result.get("hypothesis.score").or(result.get("score")).unwrap_or(0.0)
        };
        let best = results
            .into_iter()
            .reduce(|best, other| if score(&other) > score(&best) { other } else { best });
        let Some(best) = best else { continue };
        let name = ["hypothesis.class_id", "id"].into_iter().find_map(|path| {
            best.get(path).or_else(|| best.get::<i64>(path).map(|id| id.to_string()))
        });
        if carried.id.is_some() && carried.id != name {
            continue;
        }
        let frames = [&object, message].map(|value| value.get("header.frame_id"));
        let frame = frames.into_iter().flatten().find(|frame: &String| !frame.is_empty());
        let pose = pose_at(&best, "pose.pose")?;
        found.push(Placed { frame: frame.unwrap_or_default(), pose });
    }
    Ok(found)
}

fn posed(message: &Value<'_>) -> Result<Placed, String> {
    let frame = message.get("header.frame_id").unwrap_or_default();
    let nested = message.at("pose.pose").is_some();
    let pose = pose_at(message, if nested { "pose.pose" } else { "pose" })?;
    Ok(Placed { frame, pose })
}

/// The pose at a path in a message.
pub(super) fn pose_at(value: &Value<'_>, path: &str) -> Result<Isometry3<f64>, String> {
    let part = |name: &str| value.number_at(&format!("{path}.position.{name}"));
    let translation = [part("x")?, part("y")?, part("z")?];
    let rotation = value.quaternion_at(&format!("{path}.orientation"), Value::number_at)?;
    isometry(translation, rotation).ok_or_else(|| format!("its `{path}` is no pose"))
}
