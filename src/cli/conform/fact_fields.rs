//! The facts of a report as fields of its JSON line.

use serde::Serialize;
use toposlam_conform::{Evidence, LogHead, MeasuredHallways, SkippedMessages};
use toposlam_logs::record::RunEnding;
use toposlam_model::{
    folding::SmallestWorld,
    format::named_world::NamedWorld,
    trace::{AlgorithmMatch, MatchedChoices},
};

use super::{
    JudgedLog,
    folded_trail::{OpenDoor, open_doors},
    other_world::{OtherWorld, OtherWorldFields},
    robot_marker::{AddedMarker, AssumedMarkerFields},
};
use crate::cli::{json::TruncatedLine, skipped_lines::SkippedLinesFields};

/// What the remarks and the facts of a report state in words.
#[derive(Serialize)]
pub(super) struct FactFields<'j> {
    evidence: &'static str,
    /// A marker that was assumed, and not in the log.
    assumed_marker: Option<AssumedMarkerFields>,
    /// The number of images that were sensed.
    images: u64,
    unreadable_images: u64,
    /// The number of laser scans that were sensed.
    scans: u64,
    skipped_messages: SkippedMessagesFields,
    truncated: Option<TruncatedLine>,
    /// The lines of a log of lines that are not read.
    skipped: Option<SkippedLinesFields<'j>>,
    recorded: Option<Recorded<'j>>,
    ending: Option<Ending<'j>>,
    world: Option<World<'j>>,
    smallest: Option<Size>,
    lengths: Lengths,
    /// Whether no other world explains the log.
    unique: Option<bool>,
    /// The number of doors that were never followed.
    open_doors: Option<usize>,
    never_followed: Option<Vec<NeverFollowed>>,
    /// Another world that explains the log, and that no walk distinguishes from the known one or the smallest.
    twin: Option<OtherWorldFields>,
    doors: Option<Doors>,
    map: Option<Map>,
}

/// The number of messages that were skipped when events were inferred.
#[derive(Serialize)]
struct SkippedMessagesFields {
    off_clock: u64,
    scans_without_odometry: u64,
}

/// What the log records about its world.
#[derive(Serialize)]
struct Recorded<'j> {
    world: &'j str,
    start: &'j str,
    /// Whether it is the world of `--world`.
    same_world: Option<bool>,
}

/// The recorded end of the run.
#[derive(Serialize)]
struct Ending<'j> {
    how: &'static str,
    cause: Option<&'j str>,
}

/// The world of `--world`.
#[derive(Serialize)]
struct World<'j> {
    name: &'j str,
    /// `None` if any start is possible.
    start: Option<String>,
    /// The number of candidate poses at the first event.
    candidates_at_start: usize,
}

/// The size of the smallest world that explains the log.
#[derive(Serialize)]
struct Size {
    vertices: usize,
    edges: usize,
    /// Whether all smaller worlds were excluded.
    least: bool,
}

/// How many hallways were measured by odometry.
#[derive(Serialize)]
struct Lengths {
    moves: usize,
    measured: usize,
    /// The number of moves through hallways that were measured before.
    compared: usize,
}

/// A door that was never followed.
#[derive(Serialize)]
struct NeverFollowed {
    vertex: String,
    door: u32,
    toward: Option<String>,
}

/// The algorithm with which the doors were compared, and its choices that explain them.
#[derive(Serialize)]
struct Doors {
    algorithm: &'static str,
    choices: &'static str,
    /// The first event that the default choices would not have.
    from_event: Option<usize>,
}

/// The map at the last event that the algorithm explains.
#[derive(Serialize)]
struct Map {
    complete: bool,
    vertices: usize,
    edges: usize,
    /// The number of unexplored edge ends.
    unexplored: usize,
}

impl<'j> FactFields<'j> {
    pub(super) fn of(judged: &'j JudgedLog) -> Self {
        let JudgedLog { opened, gathered, judgement, known, .. } = judged;
        let run = opened.run.as_ref();
        let smallest = match &judgement.smallest {
            Some(SmallestWorld::World { graph, limit, .. }) => Some(Size {
                vertices: graph.vertex_count(),
                edges: graph.edge_count(),
                least: limit.is_none(),
            }),
            _ => None,
        };
        let open = open_doors(judged);
        let candidates = judgement.poses.as_ref().and_then(|poses| poses.left.first());
        Self {
            evidence: match gathered.evidence {
                Evidence::Recorded => "recorded",
                Evidence::Scenes => "scenes",
                Evidence::Pictures => "pictures",
                Evidence::Laser => "laser",
            },
            assumed_marker: judged.added.and_then(AddedMarker::assumed),
            images: gathered.pictures,
            unreadable_images: gathered.unreadable,
            scans: gathered.scans,
            skipped_messages: SkippedMessagesFields::from(gathered.skipped),
            truncated: opened.log.truncation().map(TruncatedLine::from),
            skipped: opened.log.skipped().map(SkippedLinesFields::from),
            recorded: run.filter(|run| !run.world_hash.is_empty()).map(|run| Recorded {
                world: &run.world,
                start: &run.start,
                same_world: known
                    .as_ref()
                    .map(|known| !LogHead(Some(run)).is_of_other_world(&known.world.graph)),
            }),
            ending: judgement.events.end.as_ref().map(|end| Ending::of(&end.ending)),
            world: known.as_ref().map(|known| {
                let NamedWorld { name, .. } = known.world;
                World {
                    name,
                    start: known.start.map(|start| known.world.start_text(start)),
                    candidates_at_start: candidates.copied().unwrap_or(0),
                }
            }),
            smallest,
            lengths: Lengths::from(judgement.measured),
            unique: judgement.determines_world(),
            open_doors: open.as_ref().map(Vec::len),
            never_followed: open.map(|open| open.into_iter().map(NeverFollowed::from).collect()),
            twin: judged.twin.as_ref().map(OtherWorld::fields),
            doors: judgement.algorithm.as_ref().map(Doors::of),
            map: judgement.algorithm.as_ref().map(Map::of),
        }
    }
}

impl From<SkippedMessages> for SkippedMessagesFields {
    fn from(skipped: SkippedMessages) -> Self {
        let SkippedMessages { off_clock, scans_without_odometry } = skipped;
        Self { off_clock, scans_without_odometry }
    }
}

impl From<MeasuredHallways> for Lengths {
    fn from(MeasuredHallways { moves, measured, compared }: MeasuredHallways) -> Self {
        Self { moves, measured, compared }
    }
}

impl From<OpenDoor> for NeverFollowed {
    fn from(OpenDoor { vertex, door, toward }: OpenDoor) -> Self {
        Self { vertex, door, toward }
    }
}

impl<'j> Ending<'j> {
    fn of(ending: &'j RunEnding) -> Self {
        let (how, cause) = match ending {
            RunEnding::Mapped => ("mapped", None),
            RunEnding::Stopped => ("stopped", None),
            RunEnding::GaveUp(cause) => ("gave-up", Some(cause.as_str())),
            RunEnding::OutOfBudget(cause) => ("out-of-budget", Some(cause.as_str())),
        };
        Self { how, cause }
    }
}

impl Doors {
    fn of(followed: &AlgorithmMatch) -> Self {
        let (choices, from) = match followed.choices {
            MatchedChoices::Default => ("default", None),
            MatchedChoices::Other { from } => ("other", from),
        };
        let algorithm = followed.algorithm.name();
        Self { algorithm, choices, from_event: from.map(|event| event + 1) }
    }
}

impl Map {
    fn of(followed: &AlgorithmMatch) -> Self {
        let map = followed.run.map();
        let unexplored = map.unexplored_count() as usize;
        Self {
            complete: map.complete().is_some(),
            vertices: map.vertex_count(),
            edges: (map.dart_count() - unexplored) / 2,
            unexplored,
        }
    }
}
