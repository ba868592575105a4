//! The walks of an earlier run, from its log.

use toposlam_model::{
    mapping::EarlierWalk,
    percept::{Door, Percept},
};
use toposlam_vision::laser::params::LaserParams;

use crate::{
    conform::{CheckedKind, Evidence, ExtractConfig, ExtractError, extract},
    log::{reader::Log, topic_map::TopicMap},
    record::Arrival,
};

/// The walks that a log records: what the robot perceived, and the doors that it took. Where the robot got lost, another
/// walk begins.
///
/// # Errors
/// Returns an error if the log cannot be read, or records no percepts and doors.
pub fn earlier_walks(log: &Log, topics: &TopicMap) -> Result<Vec<EarlierWalk>, ExtractError> {
    let config = ExtractConfig {
        evidence: Evidence::Recorded,
        sensor: None,
        marked: true,
        laser: LaserParams::default(),
    };
    let extracted = extract(log, topics, &config, &())?;
    let mut walks = Walks::default();
    let has_numbers = |kind: &CheckedKind| {
        matches!(kind, CheckedKind::Arrival { arrival: Arrival { number: Some(_), .. }, .. })
    };
    let is_numbered = extracted.events.events.iter().any(|event| has_numbers(&event.kind));
    for event in &extracted.events.events {
        match &event.kind {
            CheckedKind::Arrival { arrival, .. } => {
                let is_lost = is_numbered && arrival.number.is_none();
                walks.arrive(arrival, is_lost);
            }
            CheckedKind::Door { door, .. } => walks.leave(*door),
            CheckedKind::Aside { .. } | CheckedKind::TurnedBack | CheckedKind::Undecided(_) => {
                walks.end();
            }
        }
    }
    walks.end();
    Ok(walks.done)
}

/// The walks so far.
#[derive(Default)]
struct Walks {
    done: Vec<EarlierWalk>,
    first: Option<Percept>,
    moves: Vec<(Door, Percept)>,
    door: Option<Door>,
    is_blocked: bool,
}

impl Walks {
    fn arrive(&mut self, arrival: &Arrival, is_lost: bool) {
        let Some(percept) = arrival.percept() else { return self.end() };
        if is_lost {
            self.end();
        }
        if let (Some(_), Some(door)) = (self.first, self.door.take()) {
            self.moves.push((door, percept));
        } else {
            self.end();
            self.first = Some(percept);
        }
        self.is_blocked |= arrival.is_at_obstacle();
    }

    fn leave(&mut self, door: Door) {
        if self.door.replace(door).is_some() {
            self.end();
        }
    }

    fn end(&mut self) {
        let moves = std::mem::take(&mut self.moves);
        if let Some(first) = self.first.take().filter(|_| !moves.is_empty()) {
            self.done.push(EarlierWalk::new(first, moves, self.is_blocked));
        }
        self.door = None;
        self.is_blocked = false;
    }
}
