//! The story of a movable marker: where it is dropped, searched for and found.

use std::io::{self, Write};

use toposlam_model::mapping::{Journey, MovableEvent};

use super::{Story, dart};
use crate::{
    moment::grouped,
    text::{counted, print_paragraph},
};

impl<W: Write> Story<W> {
    pub(super) fn print_movable(
        &mut self,
        journey: &Journey,
        event: MovableEvent,
    ) -> io::Result<()> {
        let map = journey.map();
        match event {
            MovableEvent::Arrived { edge, percept, candidates } => {
                self.print_round(journey, edge, " with the marker", percept)?;
                let candidates = match candidates {
                    0 => "none".to_owned(),
                    some => grouped(some as u128),
                };
                let known = match map.vertex_count() {
                    1 => "the 1 known vertex".to_owned(),
                    several => format!("the {} known vertices", grouped(several as u128)),
                };
                self.print_line(format!("Candidates: {candidates} of {known}."))
            }
            // To validate a place the robot drops the marker where it has just arrived. To validate a
            // back link it drops the marker at the known end of the edge.
            MovableEvent::Dropped if journey.moves() == self.moves => {
                self.print_line("The robot drops the marker here and searches for it.")
            }
            MovableEvent::Dropped => {
                let (at, moves) = (map.vertex(journey.robot()).0, self.take_moves(journey));
                self.print_line(format!(
                    "The robot carries the marker to v{at}{moves} and drops it."
                ))
            }
            MovableEvent::PickedUp if self.round == 0 => {
                print_paragraph(&mut self.out, "It picks the marker up.")
            }
            MovableEvent::PickedUp if journey.moves() == self.moves => {
                self.print_line("The robot picks the marker up.")
            }
            MovableEvent::PickedUp => {
                let moves = self.take_moves(journey);
                self.print_line(format!("The robot returns to the marker{moves} and picks it up."))
            }
            MovableEvent::NotAt { vertex } => {
                let why = "because the marker is not here";
                self.print_rejected(journey, &format!("v{}", vertex.0), why)
            }
            MovableEvent::Found { vertex } => {
                let mut unexplored = map.unexplored_at(vertex);
                let unexplored = match (unexplored.next(), unexplored.count()) {
                    (Some(only), 0) => format!("only {} is unexplored", dart(map, only)),
                    (_, more) => format!("{} are unexplored", counted(more + 1, "dart")),
                };
                let why = format!("the marker is here, and {unexplored}");
                self.print_confirmed(journey, &format!("v{}", vertex.0), &why)
            }
            MovableEvent::NotFound => {
                self.print_omitted()?;
                self.print_line("The marker is at no known vertex.")
            }
            MovableEvent::NotBehind { dart: behind, percept } => {
                let why = format!("because it leads to {percept}, no marker");
                self.print_rejected(journey, &dart(map, behind), &why)
            }
            MovableEvent::Behind { dart: behind } => {
                self.print_confirmed(journey, &dart(map, behind), "it leads to the marker")
            }
        }
    }
}
