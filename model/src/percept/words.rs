//! Sightings that are read from the words in which they are written.

use std::str::FromStr;

use thiserror::Error;

use super::{
    Door, MARKER_NAMES, MarkerSet, OtherRobot, Sighting, StringView, TeamView, TwoMarkersView,
};

#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error(
    "`{}` is not what a robot sees of a marking aid; that is written as in `marker along door 1`, `2 markers`, \
     `first marker`, `string through door 0, fixed end` or `robot 2 here along door 1`",
    .0.escape_debug()
)]
pub struct UnknownSighting(String);

/// Of a marker, of markers, of a string or of a team, exactly as it is written. What is seen through binoculars and by a
/// compass is not read.
impl FromStr for Sighting {
    type Err = UnknownSighting;

    fn from_str(text: &str) -> Result<Self, UnknownSighting> {
        let sighting = match text {
            "no marker" => Some(Self::Nothing),
            "marker" => Some(Self::Lying(1)),
            "past the mark" => Some(Self::Passed),
            "past the mark, along its arrow" => Some(Self::PassedAlong),
            "past the mark, against its arrow" => Some(Self::PassedAgainst),
            _ => markers(text)
                .or_else(|| two_markers(text))
                .or_else(|| team(text))
                .or_else(|| string(text)),
        };
        let sighting = sighting.filter(|sighting| sighting.to_string() == text);
        sighting.ok_or_else(|| UnknownSighting(text.to_owned()))
    }
}

fn markers(text: &str) -> Option<Sighting> {
    if let Some(door) = text.strip_prefix("marker along ") {
        return door_of(door).map(Sighting::Pointing);
    }
    if let Some(count) = text.strip_suffix(" markers") {
        return count.parse().ok().filter(|&count| count > 0).map(Sighting::Lying);
    }
    let names = listed(text.strip_suffix(" marker")?);
    let numbers = names.map(|name| MARKER_NAMES.iter().position(|known| *known == name));
    let numbers: Option<Vec<_>> = numbers.collect();
    MarkerSet::from_numbers(numbers?).map(Sighting::These)
}

fn two_markers(text: &str) -> Option<Sighting> {
    let mut view = TwoMarkersView::default();
    for part in text.split(", ") {
        match part.strip_prefix("directional marker along ") {
            Some(door) => view.along = Some(door_of(door)?),
            None if part == "movable marker" => view.movable = true,
            None => return None,
        }
    }
    Some(Sighting::TwoMarkers(view))
}

fn string(text: &str) -> Option<Sighting> {
    let mut view = StringView::default();
    for part in listed(text) {
        match part {
            "fixed end" => view.fixed_end = true,
            "free end" => view.free_end = true,
            _ => {
                if let Some(door) = part.strip_prefix("from the hand through ") {
                    view.hand = Some(door_of(door)?);
                    continue;
                }
                let number = part.strip_prefix("string through ").unwrap_or(part);
                let number = number.strip_prefix("doors ").unwrap_or(number);
                let door = number.parse().ok().map(Door).or_else(|| door_of(number));
                view.doors.insert(door?);
            }
        }
    }
    Some(Sighting::String(view))
}

fn team(text: &str) -> Option<Sighting> {
    let mut robots = [OtherRobot::Absent; 2];
    for (part, number) in text.split(", ").zip(2..) {
        let place = part.strip_prefix(&format!("robot {number} "))?;
        *robots.get_mut(number - 2)? = other_robot(place)?;
    }
    Some(Sighting::Team(TeamView(robots)))
}

fn other_robot(place: &str) -> Option<OtherRobot> {
    let along = |here: &str| place.strip_prefix(here).and_then(door_of);
    match place {
        "here" => Some(OtherRobot::Here),
        "with robot 2" => Some(OtherRobot::WithSecond),
        _ => along("here along ")
            .map(OtherRobot::HereAlong)
            .or_else(|| along("with robot 2 along ").map(OtherRobot::WithSecondAlong))
            .or_else(|| {
                let (degree, _) = place.strip_prefix("elsewhere at ")?.split_once(' ')?;
                Some(OtherRobot::Elsewhere { degree: degree.parse().ok()? })
            }),
    }
}

/// `door 1`.
fn door_of(text: &str) -> Option<Door> {
    text.strip_prefix("door ")?.parse().ok().map(Door)
}

/// The parts of `1`, `1 and 2`, `1, 2 and 3`.
fn listed(text: &str) -> impl Iterator<Item = &str> {
    text.split(", ").flat_map(|part| part.split(" and "))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::percept::DoorSet;

    fn door() -> impl Strategy<Value = Door> {
        (0..DoorSet::MOST).prop_map(Door)
    }

    fn other() -> impl Strategy<Value = OtherRobot> {
        prop_oneof![
            (1_u32..9).prop_map(|degree| OtherRobot::Elsewhere { degree }),
            Just(OtherRobot::Here),
            door().prop_map(OtherRobot::HereAlong),
            Just(OtherRobot::WithSecond),
            door().prop_map(OtherRobot::WithSecondAlong),
        ]
    }

    fn sighting() -> impl Strategy<Value = Sighting> {
        let string =
            (prop::collection::vec(door(), 0..5), any::<[bool; 2]>(), prop::option::of(door()))
                .prop_filter_map(
                    "of a string something is seen",
                    |(list, [fixed_end, free_end], hand)| {
                        let mut doors = DoorSet::default();
                        for door in list {
                            doors.insert(door);
                        }
                        let view = StringView { doors, fixed_end, free_end, hand };
                        (view != StringView::default()).then_some(Sighting::String(view))
                    },
                );
        prop_oneof![
            Just(Sighting::Nothing),
            Just(Sighting::Passed),
            Just(Sighting::PassedAlong),
            Just(Sighting::PassedAgainst),
            any::<u32>().prop_map(|door| Sighting::Pointing(Door(door))),
            (1_u32..).prop_map(Sighting::Lying),
            (1_u8..).prop_map(|bits| {
                let numbers = (0..8).filter(|at| bits >> at & 1 == 1);
                Sighting::These(MarkerSet::from_numbers(numbers).unwrap())
            }),
            (prop::option::of(any::<u32>()), any::<bool>()).prop_filter_map(
                "one of the markers is here",
                |(door, movable)| {
                    let view = TwoMarkersView { along: door.map(Door), movable };
                    (view != TwoMarkersView::default()).then_some(Sighting::TwoMarkers(view))
                },
            ),
            string,
            (other(), prop::option::of(other())).prop_map(|(second, third)| {
                Sighting::Team(TeamView([second, third.unwrap_or_default()]))
            }),
        ]
    }

    proptest! {
        #[test]
        fn a_sighting_is_read_as_it_is_written(sighting in sighting()) {
            prop_assert_eq!(sighting.to_string().parse(), Ok(sighting));
        }

        #[test]
        fn no_text_panics(text in "[a-z0-9 ,]{0,40}") {
            if let Ok(sighting) = text.parse::<Sighting>() {
                prop_assert_eq!(sighting.to_string(), text);
            }
        }
    }

    #[test]
    fn what_is_written_otherwise_is_no_sighting() {
        for text in [
            "",
            "marker along door",
            "marker along door +1",
            "1 markers",
            "0 markers",
            "third and first marker",
            "movable marker, directional marker along door 1",
            "movable marker, movable marker",
            "string through doors 1",
            "string through doors 2 and 1",
            "string through door 40",
            "free end, fixed end",
            "robot 3 here",
            "robot 2 elsewhere at 1 doors",
            "robot 2 here, robot 3 here, robot 4 here",
            "east",
        ] {
            assert!(text.parse::<Sighting>().is_err(), "{text}");
        }
    }
}
