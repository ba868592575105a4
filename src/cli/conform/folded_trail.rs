//! What a log proves about its world: its folded trail, and the doors that were never followed.

use toposlam_conform::Judgement;
use toposlam_model::{
    embedded_graph::Dart,
    folding::{FoldedTrail, SmallestWorld},
    percept::Door,
};

use super::{JudgedLog, LISTED, known_world::Known};
use crate::{
    cli::text::{counted, vertices},
    picture::{OpenGraph, open_svg},
    report::FoldedReport,
};

/// The largest folded trail that is drawn, in vertices.
const DRAWN: usize = 400;

/// A door that was never followed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct OpenDoor {
    /// Its vertex in the known world, or else in the folded trail.
    pub(super) vertex: String,
    /// Its number, clockwise from the door by which the robot first came to the vertex.
    pub(super) door: u32,
    /// Where it leads in the known world.
    pub(super) toward: Option<String>,
}

/// The doors that were never followed; `None` if the log diverges, or if this is not known.
pub(super) fn open_doors(judged: &JudgedLog) -> Option<Vec<OpenDoor>> {
    let judgement = &judged.judgement;
    judgement.determines_world()?;
    if judgement.ways > 1 {
        return None;
    }
    let trail = judgement.trail.as_ref()?;
    let entries = trail.first_entries(judgement.trace.doors());
    let known = judged.known.as_ref().map(|known| (known, known_poses(judgement, trail)));
    let mut doors = Vec::new();
    for (number, &entry) in entries.iter().enumerate() {
        for door in (0..trail.degree(entry)).map(Door) {
            let dart = trail.behind(entry, door);
            if trail.opposite(dart).is_some() {
                continue;
            }
            let there = known.as_ref().and_then(|(known, poses)| {
                let (pose, there) = poses[trail.vertex(entry)]?;
                Some((known, known.world.graph.behind(there, trail.door(pose, dart))))
            });
            let vertex = there.map_or(format!("v{number}"), |(known, dart): (&&Known, Dart)| {
                known.world.at_text(dart).to_owned()
            });
            let toward = there.map(|(known, dart)| known.world.leads_to(dart).to_owned());
            doors.push(OpenDoor { vertex, door: door.0, toward });
        }
    }
    Some(doors)
}

/// For each vertex, a pose of the robot there and what it is in the known world, if that is certain.
fn known_poses(judgement: &Judgement, trail: &FoldedTrail) -> Vec<Option<(Dart, Dart)>> {
    let mut poses = vec![None; trail.trail_vertex_count()];
    let Some(known) = &judgement.poses else { return poses };
    let mut next = Some(trail.start());
    let mut doors = judgement.trace.doors().iter();
    let mut event = 0;
    while let Some(pose) = next {
        if let Some(Some(state)) = known.alone.get(event) {
            poses[trail.vertex(pose)].get_or_insert((pose, state.pose));
        }
        event += 2;
        next = doors.next().and_then(|&door| trail.opposite(trail.behind(pose, door)));
    }
    poses
}

/// Whether the log determines its world, in a sentence.
pub(super) fn in_words(doors: &[OpenDoor]) -> String {
    let never = match doors.len() {
        0 => return "This log determines its world.".to_owned(),
        1 => "1 door was".to_owned(),
        count => format!("{count} doors were"),
    };
    let mut listed: Vec<String> = doors.iter().take(LISTED).map(OpenDoor::in_words).collect();
    if let Some(more) = doors.len().checked_sub(LISTED + 1) {
        listed.push(format!("and {} more", more + 1));
    }
    format!("This log does not determine its world: {never} never followed: {}.", listed.join(", "))
}

impl OpenDoor {
    fn in_words(&self) -> String {
        let Self { vertex, door, toward } = self;
        match toward {
            Some(toward) => format!("{vertex} toward {toward}"),
            None => format!("{vertex} door {door}"),
        }
    }
}

impl JudgedLog<'_> {
    /// The unknown world of a log, as a fact.
    pub(super) fn unknown_world(&self) -> String {
        let judgement = &self.judgement;
        let Some(SmallestWorld::World { graph, limit, .. }) = &judgement.smallest else {
            return "unknown".to_owned();
        };
        let (edges, count) = (counted(graph.edge_count(), "edge"), graph.vertex_count());
        let size = format!("{edges}, {}", vertices(count));
        match (judgement.determines_world(), limit) {
            (Some(true), _) => format!("unknown; the only one that explains the log has {size}"),
            (_, None) => format!("unknown; the smallest that explains the log has {size}"),
            (_, Some(_)) => format!("unknown; one that explains the log has {size}"),
        }
    }

    /// The folded trail on the page; `None` if there is none, or if it is the world that is drawn.
    pub(super) fn folded(&self) -> Option<FoldedReport> {
        let judgement = &self.judgement;
        let trail = judgement.trail.as_ref()?;
        if judgement.determines_world() == Some(true) {
            return None;
        }
        let entries = trail.first_entries(judgement.trace.doors());
        let drawn = trail.vertex_count() <= DRAWN;
        let drawing = if drawn { open_svg(&OpenGraph::of_trail(trail, &entries)) } else { None };
        Some(FoldedReport {
            vertices: trail.vertex_count(),
            open_doors: trail.open_count(),
            drawing,
        })
    }
}
