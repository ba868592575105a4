//! The story of a marking aid that moves: where it is dropped, searched for and found.

use toposlam_model::{
    aid::AidAction,
    embedded_graph::Dart,
    mapping::{MapWalk, MovableEvent},
    percept::{OtherRobot, Percept, Sighting},
};

use super::{Story, StoryAid, dart};
use crate::{moment::grouped, text::counted};

impl Story {
    pub(super) fn add_movable(&mut self, journey: &MapWalk, event: MovableEvent) {
        let map = journey.map();
        let aid = self.aid.unwrap_or(StoryAid::Marker);
        // What is found, and what is not.
        let (thing, no_thing) = match aid {
            StoryAid::Markers => ("a marker", "no marker"),
            StoryAid::Scouts => ("another robot", "no other robot"),
            _ => ("the marker", "the marker"),
        };
        match event {
            MovableEvent::Arrived { edge, percept, candidates } => {
                match aid {
                    StoryAid::Markers => self.add_round(journey, edge, " with markers", percept),
                    StoryAid::String => self.add_round(journey, edge, " with the string", percept),
                    StoryAid::Scouts => {
                        return self.add_scout(journey, (edge, percept), candidates);
                    }
                    _ => self.add_round(journey, edge, " with the marker", percept),
                }
                if aid == StoryAid::Markers && percept.sighting != Sighting::Nothing {
                    self.add_line("It is at the end of an earlier edge, where it left markers.");
                } else {
                    self.add_places(candidates, map.vertex_count());
                }
            }
            MovableEvent::Did(action) => self.add_action(journey, action),
            MovableEvent::NotAt { vertex } => {
                let why = match aid {
                    StoryAid::Marker => "because the marker is not here".to_owned(),
                    _ => format!("because {no_thing} is here"),
                };
                self.add_rejected(journey, &format!("v{}", vertex.0), &why);
            }
            MovableEvent::Found { vertex } => {
                let mut unexplored = map.unexplored_at(vertex);
                let unexplored = match (unexplored.next(), unexplored.count()) {
                    (Some(only), 0) => format!("only {} is unexplored", dart(map, only)),
                    (_, more) => format!("{} are unexplored", counted(more + 1, "dart")),
                };
                let why = format!("{thing} is here, and {unexplored}");
                self.add_confirmed(journey, &format!("v{}", vertex.0), &why);
            }
            MovableEvent::NotFound => {
                self.add_omitted();
                let thing = match aid {
                    StoryAid::Markers => "One marker",
                    StoryAid::Scouts => "One robot",
                    _ => "The marker",
                };
                self.add_line(format!("{thing} is at no known vertex."));
            }
            MovableEvent::NotBehind { dart: behind, percept } => {
                let degree = counted(percept.degree as usize, "door");
                let lack = if aid == StoryAid::Scouts { no_thing } else { "no marker" };
                let why = format!("because it leads to {degree}, {lack}");
                self.add_rejected(journey, &dart(map, behind), &why);
            }
            MovableEvent::Behind { dart: behind } => {
                let why = format!("it leads to {thing}");
                self.add_confirmed(journey, &dart(map, behind), &why);
            }
        }
    }

    /// A round begins: a robot that was sent has followed an unexplored dart.
    fn add_scout(
        &mut self,
        journey: &MapWalk,
        (edge, percept): (Dart, Percept),
        candidates: usize,
    ) {
        let sent = self.sent;
        let seen = match percept.sighting {
            Sighting::Team(view) => view.0.get(usize::from(sent).wrapping_sub(2)).copied(),
            _ => None,
        };
        let who = match seen {
            Some(OtherRobot::Here | OtherRobot::HereAlong(_)) => ", where the explorer is",
            Some(OtherRobot::WithSecond | OtherRobot::WithSecondAlong(_)) => ", where robot 2 is",
            _ => "",
        };
        let (edge, moves) = (dart(journey.map(), edge), self.take_moves(journey));
        let degree = counted(percept.degree as usize, "door");
        self.begin_round(format!("robot {sent} takes {edge}{moves} and senses {degree}{who}."));
        if who.is_empty() {
            self.add_places(candidates, journey.map().vertex_count());
        }
    }

    /// How many places can be the one that was just reached.
    fn add_places(&mut self, candidates: usize, known: usize) {
        let count = match candidates {
            0 => "none".to_owned(),
            some => grouped(some as u128),
        };
        if self.aid == Some(StoryAid::String) {
            return self.add_line(format!("Unexplored darts that the string fits: {count}."));
        }
        let known = match known {
            1 => "the 1 known vertex".to_owned(),
            several => format!("the {} known vertices", grouped(several as u128)),
        };
        self.add_line(format!("Candidates: {count} of {known}."));
    }

    fn add_action(&mut self, journey: &MapWalk, action: AidAction) {
        let Some(aid) = self.aid else {
            self.aid = Some(StoryAid::LaidString);
            let text = "It lays its string over the edge behind it, and comes back.";
            return self.add_paragraph(text.to_owned());
        };
        let thing = match (aid, action) {
            (StoryAid::String, _) => "the end of the string".to_owned(),
            (_, AidAction::DropMarker(number) | AidAction::PickUpMarker(number)) => {
                format!("marker {number}")
            }
            (StoryAid::Markers, _) => "a marker".to_owned(),
            _ => "the marker".to_owned(),
        };
        let stands = journey.moves() == self.moves;
        let at = journey.map().vertex(journey.robot()).0;
        match action {
            AidAction::Send { robot, .. } => self.sent = robot,
            // To validate a place the robot drops the marker where it has just arrived. To validate a
            // back link it drops the marker at the known end of the edge.
            AidAction::Drop | AidAction::DropMarker(_) if stands => {
                let then = match aid {
                    StoryAid::Marker => " and searches for it",
                    StoryAid::String => " and follows the string",
                    _ => "",
                };
                self.add_line(format!("The robot drops {thing} here{then}."));
            }
            AidAction::Drop | AidAction::DropMarker(_) => {
                let moves = self.take_moves(journey);
                self.add_line(format!("The robot carries {thing} to v{at}{moves} and drops it."));
            }
            AidAction::PickUp | AidAction::PickUpMarker(_) if self.round == 0 => {
                self.add_paragraph(format!("It picks {thing} up."));
            }
            AidAction::PickUp | AidAction::PickUpMarker(_) if stands => {
                self.add_line(format!("The robot picks {thing} up."));
            }
            AidAction::PickUp | AidAction::PickUpMarker(_) => {
                let moves = self.take_moves(journey);
                self.add_line(format!("The robot returns to {thing}{moves} and picks it up."));
            }
        }
    }
}
