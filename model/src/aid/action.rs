//! What a robot can do: take a door, or do something with its marking aid.

use std::{fmt, str::FromStr};

use serde::{Deserialize, Deserializer, Serialize, Serializer, de};
use thiserror::Error;

use crate::{
    counts::{counted, grouped},
    percept::Door,
};

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Action {
    Take(Door),
    Do(AidAction),
}

/// An action beside doors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum AidAction {
    /// Picks up a marker that lies here, or the end of the string.
    PickUp,
    /// Drops a marker, or the end of the string, here.
    Drop,
    /// Picks up that one of the markers that look different, counted from 1.
    PickUpMarker(u8),
    /// Drops that one of the markers that look different, counted from 1.
    DropMarker(u8),
    /// Sends a robot of the team, counted from 2, through a door of its own.
    Send { robot: u8, door: Door },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum RefusedAction {
    #[error("door {} was taken at a vertex with {}", door.0, counted(*degree as usize, "door"))]
    NoSuchDoor { door: Door, degree: u32 },
    #[error("there is no marker here that could be picked up")]
    NothingToPickUp,
    #[error("the robot carries no marker that it could drop")]
    NothingToDrop,
    #[error(
        "the string is too short: only the door through which it runs from the robot's hand can be taken"
    )]
    StringTooShort,
    #[error("this aid is seen at vertices with at most {} only", counted(*most as usize, "door"))]
    TooManyDoors { most: u32 },
    #[error("{action} is no action of a robot with this marking aid")]
    NotOfThisAid { action: AidAction },
    #[error("no more than {} moves are allowed", grouped((*bound).into()))]
    OutOfMoves { bound: u64 },
    #[error("no world of this class and size agrees with what the robot has perceived")]
    NoWorldLeft,
}

impl Action {
    /// The door, if the action takes one.
    pub fn door(self) -> Option<Door> {
        match self {
            Self::Take(door) => Some(door),
            Self::Do(_) => None,
        }
    }

    /// The number of edges that are traversed: by the robot itself, or by one that it sends.
    pub fn moves(self) -> u64 {
        u64::from(matches!(self, Self::Take(_) | Self::Do(AidAction::Send { .. })))
    }
}

impl AidAction {
    /// Why it is not possible with an aid that does not have it.
    pub(super) fn refused(self) -> RefusedAction {
        match self {
            Self::PickUp => RefusedAction::NothingToPickUp,
            Self::Drop => RefusedAction::NothingToDrop,
            action => RefusedAction::NotOfThisAid { action },
        }
    }
}

/// The door's number, or the action: `2`, `pick-up`, `drop-2`, `send-2:1`.
impl fmt::Display for Action {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Take(door) => write!(out, "{}", door.0),
            Self::Do(action) => write!(out, "{action}"),
        }
    }
}

impl fmt::Display for AidAction {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::PickUp => write!(out, "pick-up"),
            Self::Drop => write!(out, "drop"),
            Self::PickUpMarker(number) => write!(out, "pick-up-{number}"),
            Self::DropMarker(number) => write!(out, "drop-{number}"),
            Self::Send { robot, door } => write!(out, "send-{robot}:{}", door.0),
        }
    }
}

/// A door is a number, another action is a word.
impl Serialize for Action {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Take(door) => door.serialize(serializer),
            Self::Do(action) => serializer.collect_str(action),
        }
    }
}

impl<'de> Deserialize<'de> for Action {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum Written {
            Door(u32),
            Word(String),
        }
        match Written::deserialize(deserializer)? {
            Written::Door(door) => Ok(Self::Take(Door(door))),
            Written::Word(word) => word.parse().map_err(de::Error::custom),
        }
    }
}

#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error(
    "`{}` is not an action; write a door number, pick-up, drop, pick-up-2, drop-2 or send-2:1",
    .0.escape_debug()
)]
pub struct UnknownAction(String);

impl FromStr for Action {
    type Err = UnknownAction;

    fn from_str(text: &str) -> Result<Self, UnknownAction> {
        let door = digits(text).map(|door| Self::Take(Door(door)));
        door.map_or_else(|| text.parse().map(Self::Do), Ok)
    }
}

impl FromStr for AidAction {
    type Err = UnknownAction;

    fn from_str(text: &str) -> Result<Self, UnknownAction> {
        let action = match text.rsplit_once('-') {
            _ if text == "drop" => Some(Self::Drop),
            _ if text == "pick-up" => Some(Self::PickUp),
            Some(("drop", number)) => digits(number).map(Self::DropMarker),
            Some(("pick-up", number)) => digits(number).map(Self::PickUpMarker),
            Some(("send", order)) => order.split_once(':').and_then(|(robot, door)| {
                Some(Self::Send { robot: digits(robot)?, door: Door(digits(door)?) })
            }),
            _ => None,
        };
        action.ok_or_else(|| UnknownAction(text.to_owned()))
    }
}

/// A number that is written with digits alone.
fn digits<N: FromStr>(text: &str) -> Option<N> {
    text.bytes().all(|byte| byte.is_ascii_digit()).then(|| text.parse().ok()).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_action_is_read_as_it_is_written() {
        let actions = [
            Action::Take(Door(17)),
            Action::Do(AidAction::PickUp),
            Action::Do(AidAction::Drop),
            Action::Do(AidAction::PickUpMarker(2)),
            Action::Do(AidAction::DropMarker(4)),
            Action::Do(AidAction::Send { robot: 3, door: Door(1) }),
        ];
        let written = actions.map(|action| action.to_string());
        assert_eq!(written, ["17", "pick-up", "drop", "pick-up-2", "drop-4", "send-3:1"]);
        for (action, text) in actions.into_iter().zip(&written) {
            assert_eq!(text.parse(), Ok(action));
            let json = serde_json::to_string(&action).unwrap();
            assert_eq!(serde_json::from_str::<Action>(&json).unwrap(), action);
        }
        for wrong in ["", "-1", "+1", "pick", "drop-", "drop-300", "send-2", "send-2:", "send-x:1"]
        {
            assert!(wrong.parse::<Action>().is_err(), "{wrong}");
        }
    }
}
