//! The story of a movable marker: where it is dropped, searched for and found.

use toposlam_model::mapping::{MapWalk, MovableEvent};

use super::{Story, dart};
use crate::{moment::grouped, text::counted};

impl Story {
    pub(super) fn add_movable(&mut self, journey: &MapWalk, event: MovableEvent) {
        let map = journey.map();
        match event {
            MovableEvent::Arrived { edge, percept, candidates } => {
                self.add_round(journey, edge, " with the marker", percept);
                let candidates = match candidates {
                    0 => "none".to_owned(),
                    some => grouped(some as u128),
                };
                let known = match map.vertex_count() {
                    1 => "the 1 known vertex".to_owned(),
                    several => format!("the {} known vertices", grouped(several as u128)),
                };
                self.add_line(format!("Candidates: {candidates} of {known}."));
            }
            // To validate a place the robot drops the marker where it has just arrived. To validate a
            // back link it drops the marker at the known end of the edge.
            MovableEvent::Dropped if journey.moves() == self.moves => {
                self.add_line("The robot drops the marker here and searches for it.");
            }
            MovableEvent::Dropped => {
                let (at, moves) = (map.vertex(journey.robot()).0, self.take_moves(journey));
                self.add_line(format!(
                    "The robot carries the marker to v{at}{moves} and drops it."
                ));
            }
            MovableEvent::PickedUp if self.round == 0 => {
                self.add_paragraph("It picks the marker up.".to_owned());
            }
            MovableEvent::PickedUp if journey.moves() == self.moves => {
                self.add_line("The robot picks the marker up.");
            }
            MovableEvent::PickedUp => {
                let moves = self.take_moves(journey);
                self.add_line(format!("The robot returns to the marker{moves} and picks it up."));
            }
            MovableEvent::NotAt { vertex } => {
                let why = "because the marker is not here";
                self.add_rejected(journey, &format!("v{}", vertex.0), why);
            }
            MovableEvent::Found { vertex } => {
                let mut unexplored = map.unexplored_at(vertex);
                let unexplored = match (unexplored.next(), unexplored.count()) {
                    (Some(only), 0) => format!("only {} is unexplored", dart(map, only)),
                    (_, more) => format!("{} are unexplored", counted(more + 1, "dart")),
                };
                let why = format!("the marker is here, and {unexplored}");
                self.add_confirmed(journey, &format!("v{}", vertex.0), &why);
            }
            MovableEvent::NotFound => {
                self.add_omitted();
                self.add_line("The marker is at no known vertex.");
            }
            MovableEvent::NotBehind { dart: behind, percept } => {
                let why = format!("because it leads to {percept}, no marker");
                self.add_rejected(journey, &dart(map, behind), &why);
            }
            MovableEvent::Behind { dart: behind } => {
                self.add_confirmed(journey, &dart(map, behind), "it leads to the marker");
            }
        }
    }
}
