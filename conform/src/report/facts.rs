//! What was checked, and against what.

use serde::{Serialize, Serializer, ser::SerializeMap};
use toposlam_logs::{LineTimes, ReadingRemark, SkippedLines, error::Truncation, record::RunEnding};
use toposlam_model::{
    embedded_graph::Dart,
    enumerate::Class,
    folding::{FoldedTrail, SmallestWorld},
    format::named_world::NamedWorld,
    mapping::{MappingAlgorithm, MappingMethod, PartialMap},
    percept::Door,
    trace::{MatchEnd, MatchedChoices},
};

use super::super::{
    check::{CheckedLog, LogSource},
    config::RunDriver,
    divergence::DivergenceCause,
    events::{CheckedKind, UndecidedCause},
    extract::{Evidence, SkippedMessages},
    judgement::{Judgement, Unproved},
    known_world::Known,
    marked_visits::AddedMarker,
    measured_hallways::MeasuredHallways,
    possible_visits::PossibleVisits,
    scan_odometry::StampCounts,
    scan_track::MatchedScans,
    twin::TwinWorld,
};
use super::events::PoseName;

/// What was checked, and against what. Each serialized field is one of the JSON line of a log.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Facts {
    pub evidence: Evidence,
    /// A marker that is not recorded in percepts.
    #[serde(rename = "assumed_marker", serialize_with = "assumed_marker")]
    pub added_marker: Option<AddedMarker>,
    pub images: u64,
    pub unreadable_images: u64,
    pub scans: u64,
    /// The visits as sets of percepts: those of a log of scans, and those of images if some are not certain.
    pub possible: Option<PossibleVisits>,
    /// What does not fit, and accuses nobody.
    pub contradiction: Option<UnprovedDivergence>,
    pub skipped_messages: SkippedMessages,
    pub truncated: Option<Truncation>,
    /// The lines of a log of lines that are not read.
    #[serde(rename = "skipped")]
    pub skipped_lines: Option<SkippedLines>,
    /// The times of a log of lines, if some are not those of a clock.
    pub line_times: Option<LineTimes>,
    /// What was repaired in the messages, and which could not be used.
    #[serde(rename = "repaired")]
    pub reading: Vec<ReadingRemark>,
    pub stamps: StampCounts,
    /// How scans were placed, if the log has no odometry.
    pub matched_scans: Option<MatchedScans>,
    pub recorded: Option<RecordedWorld>,
    #[serde(serialize_with = "recorded_ending")]
    pub ending: Option<RunEnding>,
    pub world: Option<WorldFact>,
    pub smallest: Option<SmallestFound>,
    pub lengths: MeasuredHallways,
    /// Whether no other world explains the log.
    pub unique: Option<bool>,
    pub open_doors: Option<usize>,
    pub never_followed: Option<Vec<OpenDoor>>,
    /// Another world that explains the log, and that no walk distinguishes from the known one or the smallest.
    pub twin: Option<TwinWorld>,
    pub doors: Option<ComparedDoors>,
    pub map: Option<MapSize>,

    #[serde(skip)]
    pub has_head: bool,
    /// Whether the log has a head, but does not record how the run ended.
    #[serde(skip)]
    pub lacks_end: bool,
    /// The number of the first visit to a junction that was not recognised, and why.
    #[serde(skip)]
    pub unrecognised: Option<(usize, UndecidedCause)>,
    /// The number of the first event that is compared with no world, because the robot got lost before it.
    #[serde(skip)]
    pub lost: Option<usize>,
    /// The number of ways in which the visits of an undirected marker can be visits of one junction.
    #[serde(skip)]
    pub ways: usize,
    #[serde(skip)]
    pub class: Option<Class>,
    /// The widest field of view of a scan, in radians.
    #[serde(skip)]
    pub field_of_view: f64,
    /// The drift of the heading of the odometry in 10 m, in radians, if scans were matched because of it.
    #[serde(skip)]
    pub drift: Option<f64>,
}

/// An event that does not fit, which accuses nobody.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UnprovedDivergence {
    /// Its number, from 1; one more than there are at the end.
    pub event: usize,
    #[serde(skip)]
    pub found: Option<CheckedKind>,
    #[serde(serialize_with = "cause_name")]
    pub cause: DivergenceCause,
    #[serde(skip)]
    pub why: Unproved,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct RecordedWorld {
    pub world: String,
    /// `VERTEX:FACING`.
    pub start: String,
    /// Whether it is the known world.
    pub same_world: Option<bool>,
}

#[derive(Clone, Debug, Serialize)]
pub struct WorldFact {
    pub name: String,
    /// `None` if any start is possible.
    pub start: Option<String>,
    /// The number of candidate poses at the first event.
    pub candidates_at_start: usize,
    /// The number of candidate poses at the end; `None` if no event was compared with the world.
    #[serde(skip)]
    pub candidates_left: Option<usize>,
    /// The pose at the end, if only one is left.
    #[serde(skip)]
    pub pose: Option<PoseName>,
    #[serde(skip)]
    pub world: NamedWorld,
}

#[derive(Clone, Debug, Serialize)]
pub struct SmallestFound {
    pub vertices: usize,
    pub edges: usize,
    /// Whether all smaller worlds were excluded.
    pub least: bool,
    /// The world, with the marker at its start.
    #[serde(skip)]
    pub world: NamedWorld,
}

/// A door that was never followed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct OpenDoor {
    /// Its vertex in the known world, or else in the folded trail.
    pub vertex: String,
    /// Its number, clockwise from the door by which the robot first came to the vertex.
    pub door: u32,
    /// Where it leads in the known world.
    pub toward: Option<String>,
}

/// The algorithm with which the doors were compared, and its choices that explain them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ComparedDoors {
    pub algorithm: MappingAlgorithm,
    pub choices: MatchedChoices,
    pub recovers: bool,
    /// The number of events before the first that the algorithm does not have.
    pub departs_after: Option<usize>,
    /// Whether the log ends while the algorithm goes on.
    pub is_cut: bool,
}

/// The map at the last event that the algorithm explains.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct MapSize {
    pub complete: bool,
    pub vertices: usize,
    pub edges: usize,
    pub unexplored: usize,
}

impl CheckedLog {
    pub(super) fn facts(&self, source: &LogSource) -> Facts {
        let Self { extracted, judgement, known, .. } = self;
        let open = self.open_doors();
        let unrecognised = judgement.unrecognised.and_then(|event| {
            let found = judgement.events.events.get(event)?;
            let CheckedKind::Undecided(why) = found.kind else { return None };
            Some((event + 1, why))
        });
        let ending = judgement.events.end.as_ref().map(|end| end.ending.clone());
        let followed = judgement.algorithm.as_ref();
        Facts {
            evidence: extracted.evidence,
            added_marker: self.added,
            images: extracted.images,
            unreadable_images: extracted.unreadable,
            scans: extracted.scans,
            possible: judgement.possible.clone(),
            contradiction: judgement.contradiction.as_ref().map(|(divergence, why)| {
                let found = judgement.events.events.get(divergence.event);
                UnprovedDivergence {
                    event: divergence.event + 1,
                    found: found.map(|event| event.kind.clone()),
                    cause: divergence.cause.clone(),
                    why: *why,
                }
            }),
            skipped_messages: extracted.skipped,
            truncated: source.log.truncation().cloned(),
            skipped_lines: source.log.skipped().cloned(),
            line_times: source.log.irregular_times(),
            reading: extracted.remarks.clone(),
            stamps: extracted.stamps,
            recorded: source.head.filter(|run| !run.world_hash.is_empty()).map(|run| {
                let known = known.as_ref();
                RecordedWorld {
                    world: run.world.clone(),
                    start: run.start.clone(),
                    same_world: known.and_then(|known| known.is_recorded),
                }
            }),
            lacks_end: judgement.events.has_head && ending.is_none(),
            ending,
            world: known.as_ref().map(|known| self.world_fact(known)),
            smallest: self.smallest(),
            lengths: judgement.measured,
            unique: judgement.determines_world(),
            open_doors: open.as_ref().map(Vec::len),
            never_followed: open,
            twin: self.twin.clone(),
            doors: followed.map(|followed| ComparedDoors {
                algorithm: followed.algorithm,
                choices: followed.choices,
                recovers: matches!(
                    self.config.driver,
                    RunDriver::Method(MappingMethod::Recovering(_))
                ),
                departs_after: match &followed.reached {
                    MatchEnd::Departure(departure) => Some(departure.event.id),
                    _ => None,
                },
                is_cut: followed.reached == MatchEnd::EndOfTrace,
            }),
            map: followed.map(|followed| MapSize::from(followed.run.map())),
            has_head: source.head.is_some(),
            unrecognised,
            lost: judgement.lost.map(|event| event + 1),
            ways: judgement.ways,
            class: Some(self.config.search.class),
            field_of_view: extracted.field_of_view,
            drift: extracted.drift,
            matched_scans: extracted.matched_scans,
        }
    }

    fn world_fact(&self, known: &Known) -> WorldFact {
        let poses = self.judgement.poses.as_ref();
        let sets = self.judgement.possible.as_ref().filter(|_| self.judgement.are_sets_judged());
        let (last, first) = if let Some(sets) = sets {
            (Some(Some(sets.states.len())), sets.states.first().map(|state| state.pose))
        } else {
            let first = poses.and_then(|it| it.states.first()).map(|state| state.pose);
            (poses.map(|it| it.left.last().copied()), first)
        };
        let pose = first.filter(|_| last == Some(Some(1)));
        WorldFact {
            name: known.world.name.clone(),
            start: known.start.map(|start| known.world.start_text(start)),
            candidates_at_start: poses.and_then(|poses| poses.left.first()).copied().unwrap_or(0),
            candidates_left: last.map(Option::unwrap_or_default),
            pose: pose.map(|pose| known.pose_name(pose)),
            world: known.world.clone(),
        }
    }

    fn smallest(&self) -> Option<SmallestFound> {
        let Some(SmallestWorld::World { graph, marker, limit }) = &self.judgement.smallest else {
            return None;
        };
        let start = marker.or(Some(Dart(0)));
        let world = NamedWorld::numbered("smallest", "", graph.clone(), start);
        Some(SmallestFound {
            vertices: graph.vertex_count(),
            edges: graph.edge_count(),
            least: limit.is_none(),
            world: NamedWorld { marker: Some(self.config.aid), ..world },
        })
    }

    /// The doors that were never followed; `None` if the log diverges, or if this is not known.
    fn open_doors(&self) -> Option<Vec<OpenDoor>> {
        let judgement = &self.judgement;
        judgement.determines_world().filter(|_| judgement.ways <= 1)?;
        let trail = judgement.trail.as_ref()?;
        let known = self.known.as_ref().map(|known| (known, known_poses(judgement, trail)));
        let mut doors = Vec::new();
        for (number, entry) in trail.first_entries(judgement.trace.doors()).into_iter().enumerate()
        {
            for door in 0..trail.degree(entry) {
                let dart = trail.behind(entry, Door(door));
                if trail.opposite(dart).is_some() {
                    continue;
                }
                let there = known.as_ref().and_then(|(known, poses)| {
                    let (pose, there) = poses[trail.vertex(entry)]?;
                    Some((known, known.world.graph.behind(there, trail.door(pose, dart))))
                });
                let vertex = there.map_or(format!("v{number}"), |(known, dart)| {
                    known.world.at_text(dart).to_owned()
                });
                let toward = there.map(|(known, dart)| known.world.leads_to(dart).to_owned());
                doors.push(OpenDoor { vertex, door, toward });
            }
        }
        Some(doors)
    }
}

/// For each vertex, a pose of the robot there and what it is in the known world, if that is certain.
fn known_poses(judgement: &Judgement, trail: &FoldedTrail) -> Vec<Option<(Dart, Dart)>> {
    let mut poses = vec![None; trail.trail_vertex_count()];
    let Some(known) = &judgement.poses else { return poses };
    let mut next = Some(trail.start());
    let mut doors = judgement.trace.doors().iter();
    let mut event = 0;
    while let Some(pose) = next {
        if let Some(&Some(there)) = known.alone.get(event) {
            poses[trail.vertex(pose)].get_or_insert((pose, there));
        }
        event += 2;
        next = doors.next().and_then(|&door| trail.opposite(trail.behind(pose, door)));
    }
    poses
}

impl From<&PartialMap> for MapSize {
    fn from(map: &PartialMap) -> Self {
        let unexplored = map.unexplored_count() as usize;
        Self {
            complete: map.complete().is_some(),
            vertices: map.vertex_count(),
            edges: (map.dart_count() - unexplored) / 2,
            unexplored,
        }
    }
}

fn cause_name<S: Serializer>(cause: &DivergenceCause, serializer: S) -> Result<S::Ok, S::Error> {
    cause.name().serialize(serializer)
}

/// A fiducial is no field.
#[expect(clippy::ref_option, reason = "serde calls it with the field")]
fn assumed_marker<S: Serializer>(
    added: &Option<AddedMarker>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let Some(AddedMarker::Assumed { position, heading, seen }) = added else {
        return serializer.serialize_none();
    };
    let mut map = serializer.serialize_map(Some(3))?;
    map.serialize_entry("position", position)?;
    map.serialize_entry("heading", heading)?;
    map.serialize_entry("seen", seen)?;
    map.end()
}

#[expect(clippy::ref_option, reason = "serde calls it with the field")]
fn recorded_ending<S: Serializer>(
    ending: &Option<RunEnding>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let (how, cause) = match ending {
        None => return serializer.serialize_none(),
        Some(RunEnding::Mapped) => ("mapped", None),
        Some(RunEnding::Stopped) => ("stopped", None),
        Some(RunEnding::GaveUp(cause)) => ("gave-up", Some(cause)),
        Some(RunEnding::OutOfBudget(cause)) => ("out-of-budget", Some(cause)),
    };
    let mut map = serializer.serialize_map(Some(2))?;
    map.serialize_entry("how", how)?;
    map.serialize_entry("cause", &cause)?;
    map.end()
}

impl Serialize for ComparedDoors {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let (choices, from) = match self.choices {
            MatchedChoices::Default => ("default", None),
            MatchedChoices::Other { from } => ("other", from),
        };
        let mut map = serializer.serialize_map(Some(3))?;
        map.serialize_entry("algorithm", self.algorithm.name())?;
        map.serialize_entry("choices", choices)?;
        map.serialize_entry("from_event", &from.map(|event| event + 1))?;
        map.end()
    }
}
