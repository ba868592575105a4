//! What is told of a movable marker: where it was carried, dropped and looked for, and which dart
//! led back to it.

use std::io::{self, Write};

use toposlam_model::mapping::{Journey, MovableEvent};

use super::{Story, dart};

impl<W: Write> Story<W> {
    pub(super) fn tell_movable(
        &mut self,
        journey: &Journey,
        event: MovableEvent,
    ) -> io::Result<()> {
        let map = journey.map();
        match event {
            MovableEvent::Arrived { edge, percept, candidates } => {
                self.tell_round(journey, edge, " with the marker", percept)?;
                match candidates {
                    0 => writeln!(self.out, "     no known vertex fits"),
                    fit => {
                        let known = map.vertex_count();
                        writeln!(self.out, "     {fit} of the {known} known vertices may fit")
                    }
                }
            }
            // For place validation the marker is dropped where the robot has just arrived, for
            // back-link validation at the known end of the edge.
            MovableEvent::Dropped if journey.moves() == self.moves => {
                writeln!(self.out, "     it drops the marker here and goes to look for it")
            }
            MovableEvent::Dropped => {
                let (at, moves) = (map.vertex(journey.robot()).0, self.count_moves(journey));
                writeln!(self.out, "     it carries the marker to v{at} and drops it ({moves})")
            }
            MovableEvent::PickedUp if self.round == 0 => {
                writeln!(self.out, "It picks the marker up.")
            }
            MovableEvent::PickedUp if journey.moves() == self.moves => {
                writeln!(self.out, "     it picks the marker up")
            }
            MovableEvent::PickedUp => {
                let moves = self.count_moves(journey);
                writeln!(self.out, "     it goes back to the marker and picks it up ({moves})")
            }
            MovableEvent::NotAt { vertex } => {
                self.tell_rejected(journey, &format!("v{}", vertex.0), "no: the marker is not here")
            }
            MovableEvent::Found { vertex } => {
                self.tell_untold()?;
                let moves = self.count_moves(journey);
                let mut unexplored = map.unexplored_at(vertex);
                let which = match (unexplored.next(), unexplored.count()) {
                    (Some(only), 0) => format!("only {} is unexplored", dart(map, only)),
                    (_, more) => format!("{} darts are unexplored", more + 1),
                };
                let v = vertex.0;
                writeln!(self.out, "     v{v}? yes: the marker is here, where {which} ({moves})")
            }
            MovableEvent::NotFound => {
                self.tell_untold()?;
                writeln!(self.out, "     the marker is at no known vertex")
            }
            MovableEvent::NotBehind { dart: behind, percept } => {
                let why = format!("no: {percept}, no marker");
                self.tell_rejected(journey, &dart(map, behind), &why)
            }
            MovableEvent::Behind { dart: behind } => {
                self.tell_untold()?;
                let (behind, moves) = (dart(map, behind), self.count_moves(journey));
                writeln!(self.out, "     {behind}? yes: it leads to the marker ({moves})")
            }
        }
    }
}
