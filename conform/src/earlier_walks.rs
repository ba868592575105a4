//! The walks of an earlier run, from its log.

use toposlam_logs::{reader::Log, record::Arrival, topic_map::TopicMap};
use toposlam_model::{
    mapping::EarlierWalk,
    percept::{Door, Percept},
};
use toposlam_vision::laser::params::LaserParams;

use crate::{CheckedKind, Evidence, ExtractConfig, ExtractError, extract};

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
    let relocations: Vec<usize> = extracted.events.relocations().collect();
    for (index, event) in extracted.events.events.iter().enumerate() {
        match &event.kind {
            CheckedKind::Arrival { arrival, .. } => {
                walks.arrive(arrival, relocations.binary_search(&index).is_ok());
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

#[cfg(test)]
mod tests {
    use toposlam_model::percept::Sighting;

    use super::*;

    #[test]
    fn a_walk_to_an_obstacle_is_blocked() {
        let sighting = Some(Sighting::Nothing);
        let junction = Arrival { number: Some(0), degree: 2, sighting, form: None, entry: None };
        let obstacle = Arrival { degree: 1, entry: Some(0.0), ..junction };
        let walk = |far: &Arrival| {
            let mut walks = Walks::default();
            walks.arrive(&junction, false);
            walks.leave(Door(1));
            walks.arrive(far, false);
            walks.end();
            walks.done
        };
        for (far, is_blocked) in [(obstacle, true), (junction, false)] {
            let percept = |arrival: &Arrival| arrival.percept().unwrap();
            let moves = [(Door(1), percept(&far))];
            let expected = EarlierWalk::new(percept(&junction), moves, is_blocked);
            assert_eq!(walk(&far), [expected]);
        }
    }

    #[test]
    fn where_a_robot_got_lost_another_walk_begins() {
        let sighting = Some(Sighting::Nothing);
        let arrival = |degree| Arrival { number: None, degree, sighting, form: None, entry: None };
        let mut walks = Walks::default();
        for (degree, is_lost) in [(2, false), (3, false), (2, true), (4, false)] {
            walks.arrive(&arrival(degree), is_lost);
            walks.leave(Door(1));
        }
        walks.end();
        let percept = |degree| arrival(degree).percept().unwrap();
        let walk = |from, to| EarlierWalk::new(percept(from), [(Door(1), percept(to))], false);
        assert_eq!(walks.done, [walk(2, 3), walk(2, 4)]);
    }
}
