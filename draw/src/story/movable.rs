//! The story of a marking aid that moves: where it is dropped, searched for and found.

use toposlam_model::{
    aid::AidAction,
    mapping::{MapWalk, MovableEvent},
};

use super::{Story, StoryAid, dart};
use crate::{moment::grouped, text::counted};

impl Story {
    pub(super) fn add_movable(&mut self, journey: &MapWalk, event: MovableEvent) {
        let map = journey.map();
        let (thing, no_thing) = match self.aid {
            StoryAid::Marker => ("the marker", "the marker"),
            StoryAid::String => ("the string", "the string"),
            StoryAid::Scout => ("robot 2", "robot 2"),
            StoryAid::Several("robot") => ("a robot", "another robot"),
            StoryAid::Several(_) => ("a marker", "another marker"),
        };
        match event {
            MovableEvent::Arrived { edge, percept, candidates } => {
                match self.aid {
                    StoryAid::Marker => self.add_round(journey, edge, " with the marker", percept),
                    StoryAid::String => self.add_round(journey, edge, " with the string", percept),
                    StoryAid::Several("marker") => {
                        self.add_round(journey, edge, " with markers", percept);
                    }
                    _ => self.add_round_of(journey, "another robot", edge, "", percept),
                }
                self.add_places(candidates, map.vertex_count());
            }
            MovableEvent::Did(action) => self.add_action(journey, action),
            MovableEvent::NotAt { vertex } => {
                let why = format!("because {no_thing} is not here");
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
                let thing = match self.aid {
                    StoryAid::Several("robot") => "One robot",
                    StoryAid::Several(_) => "One marker",
                    StoryAid::Scout => "Robot 2",
                    _ => "The marker",
                };
                self.add_line(format!("{thing} is at no known vertex."));
            }
            MovableEvent::NotBehind { dart: behind, percept } => {
                let lack = if self.aid == StoryAid::Marker { ", no marker" } else { "" };
                let why = format!("because it leads to {percept}{lack}");
                self.add_rejected(journey, &dart(map, behind), &why);
            }
            MovableEvent::Behind { dart: behind } => {
                let why = format!("it leads to {thing}");
                self.add_confirmed(journey, &dart(map, behind), &why);
            }
        }
    }

    /// How many places can be the one that was just reached.
    fn add_places(&mut self, candidates: usize, known: usize) {
        let count = match candidates {
            0 => "none".to_owned(),
            some => grouped(some as u128),
        };
        if self.aid == StoryAid::String {
            return self.add_line(format!("Unexplored darts where the string looks so: {count}."));
        }
        let known = match known {
            1 => "the 1 known vertex".to_owned(),
            several => format!("the {} known vertices", grouped(several as u128)),
        };
        self.add_line(format!("Candidates: {count} of {known}."));
    }

    fn add_action(&mut self, journey: &MapWalk, action: AidAction) {
        let thing = match (self.aid, action) {
            (StoryAid::String, _) => "the string's end".to_owned(),
            (_, AidAction::DropMarker(number) | AidAction::PickUpMarker(number)) => {
                format!("marker {number}")
            }
            (StoryAid::Several(_), _) => "a marker".to_owned(),
            _ => "the marker".to_owned(),
        };
        let it = match (self.aid, action) {
            (_, AidAction::DropMarker(number) | AidAction::PickUpMarker(number)) => {
                format!("marker {number}")
            }
            (StoryAid::Several(_), _) => "a marker".to_owned(),
            _ => "it".to_owned(),
        };
        let stands = journey.moves() == self.moves;
        match action {
            // To validate a place the robot drops the marker where it has just arrived. To validate a
            // back link it drops the marker at the known end of the edge.
            AidAction::Drop | AidAction::DropMarker(_) if stands => {
                let then = match self.aid {
                    StoryAid::Marker => " and searches for it",
                    StoryAid::String => " and follows the string",
                    _ => "",
                };
                self.add_line(format!("The robot drops {thing} here{then}."));
            }
            AidAction::Drop | AidAction::DropMarker(_) => {
                let (at, moves) =
                    (journey.map().vertex(journey.robot()).0, self.take_moves(journey));
                self.add_line(format!("The robot carries {thing} to v{at}{moves} and drops {it}."));
            }
            AidAction::PickUp | AidAction::PickUpMarker(_) if self.round == 0 => {
                self.add_paragraph(format!("It picks {thing} up."));
            }
            AidAction::PickUp | AidAction::PickUpMarker(_) if stands => {
                self.add_line(format!("The robot picks {thing} up."));
            }
            AidAction::PickUp | AidAction::PickUpMarker(_) => {
                let moves = self.take_moves(journey);
                let place = if self.aid == StoryAid::String { "it" } else { "the place" };
                let (to, up) = match self.aid {
                    StoryAid::Several(_) => (place.to_owned(), thing),
                    _ => (thing, "it".to_owned()),
                };
                self.add_line(format!("The robot returns to {to}{moves} and picks {up} up."));
            }
            AidAction::Send { .. } => {}
        }
    }
}
