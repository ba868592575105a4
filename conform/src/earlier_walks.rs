//! The walks of an earlier run, from its log.

use toposlam_logs::{reader::Log, record::Arrival, topic_map::TopicMap};
use toposlam_model::{
    mapping::EarlierWalk,
    percept::{Door, Percept},
};

use crate::{CheckedKind, Evidence, ExtractConfig, ExtractError, RunEvents, extract};

/// The walks that a log records: what the robot perceived, and the doors that it took. Where the robot got lost, another
/// walk begins.
///
/// # Errors
/// Returns an error if the log cannot be read, or records no percepts and doors.
pub fn earlier_walks(log: &Log, topics: &TopicMap) -> Result<Vec<EarlierWalk>, ExtractError> {
    let config = ExtractConfig { marked: true, ..ExtractConfig::new(Evidence::Recorded) };
    Ok(walks_of(&extract(log, topics, &config, &())?.events))
}

fn walks_of(run: &RunEvents) -> Vec<EarlierWalk> {
    let mut walks = Walks::default();
    let relocations: Vec<usize> = run.relocations().collect();
    for (index, event) in run.events.iter().enumerate() {
        match &event.kind {
            CheckedKind::Arrival { arrival, .. } => {
                walks.arrive(arrival, relocations.binary_search(&index).is_ok());
            }
            CheckedKind::Door { door, .. } => walks.leave(*door),
            _ => walks.end(),
        }
    }
    walks.end();
    walks.done
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
    use crate::CheckedEvent;

    fn percept(degree: u32) -> Percept {
        Percept { degree, sighting: Sighting::Nothing }
    }

    /// The walks of a robot that comes to junctions of these degrees, and leaves each by door 1.
    fn walks(junctions: &[(u32, bool)], change: impl Fn(usize, &mut Arrival)) -> Vec<EarlierWalk> {
        let mut kinds = Vec::new();
        for (index, &(degree, is_lost)) in junctions.iter().enumerate() {
            let mut kind = CheckedKind::from(percept(degree));
            if let CheckedKind::Arrival { arrival, .. } = &mut kind {
                arrival.number = Some(index as u32).filter(|_| !is_lost);
                change(index, arrival);
            }
            kinds.extend([kind, CheckedKind::from(Door(1))]);
        }
        let event = |kind| CheckedEvent { source: crate::EventSource::default(), kind };
        let events = kinds.into_iter().map(event).collect();
        walks_of(&RunEvents { events, has_head: true, ..RunEvents::default() })
    }

    fn walk(from: u32, to: u32, is_blocked: bool) -> EarlierWalk {
        EarlierWalk::new(percept(from), [(Door(1), percept(to))], is_blocked)
    }

    #[test]
    fn a_walk_to_an_obstacle_is_blocked() {
        let to = [(2, false), (1, false)];
        assert_eq!(walks(&to, |_, _| {}), [walk(2, 1, false)]);
        let at_obstacle = |index: usize, arrival: &mut Arrival| {
            arrival.entry = Some(0.0).filter(|_| index == 1);
        };
        assert_eq!(walks(&to, at_obstacle), [walk(2, 1, true)]);
        // It comes to obstacles twice.
        let twice = [(1, false), (1, false)];
        let at_each = |_: usize, arrival: &mut Arrival| arrival.entry = Some(0.0);
        assert_eq!(walks(&twice, at_each), [walk(1, 1, true)]);
    }

    #[test]
    fn a_log_that_ends_on_the_way_has_the_walk_to_its_last_junction() {
        let line = |degree: u32| {
            format!("{{\"kind\":\"event\",\"degree\":{degree},\"door\":1,\"marker\":-1}}\n")
        };
        let log = Log::of_bytes([2, 3].map(line).concat().into_bytes()).unwrap();
        let walks = earlier_walks(&log, &TopicMap::unambiguous(&log)).unwrap();
        assert_eq!(walks, [walk(2, 3, false)]);
    }

    #[test]
    fn where_a_robot_got_lost_another_walk_begins() {
        let lost = [(2, false), (3, false), (2, true), (4, false)];
        assert_eq!(walks(&lost, |_, _| {}), [walk(2, 3, false), walk(2, 4, false)]);
    }
}
