//! The placed worlds that may be ambiguous, as bytes: they can be sorted, stored, and sent to another process.

use serde::{Deserialize, Serialize};

use super::{PlacedWorld, quotient::QuotientCode, space::StateLabel};
use crate::{
    isomorphism::StartCode,
    percept::{Door, OtherRobot, Sighting, StringView, TeamView, TwoMarkersView},
};

/// A placed world that may be ambiguous, with the code of its quotient, as bytes.
///
/// Placed worlds of a search are indistinguishable exactly if their candidates have the same
/// [quotient](Self::quotient). Candidates are ordered by their quotients, in some order, and then as in a report:
/// fewer edges first, then the lesser code.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct AmbiguityCandidate(Box<[u8]>);

/// The number of bytes of the length of a quotient.
const LENGTH: usize = 4;

/// The word of a [`StartCode`] in a byte: an enumerated world has at most 64 darts, so a dart is less than 64 and
/// the word of a new vertex is more. The order stays.
fn to_byte(word: u32) -> u8 {
    word as u8
}

fn to_word(byte: u8) -> u32 {
    if byte < 128 { byte.into() } else { u32::MAX - u32::from(u8::MAX - byte) }
}

/// Adds a number: most take one byte.
fn push_number(bytes: &mut Vec<u8>, number: u32) {
    match u8::try_from(number) {
        Ok(number) if number < u8::MAX => bytes.push(number),
        _ => {
            bytes.push(u8::MAX);
            bytes.extend(number.to_be_bytes());
        }
    }
}

fn push_label(bytes: &mut Vec<u8>, (percept, held): StateLabel) {
    let mut push = |numbers: &[u32]| {
        for &number in numbers {
            push_number(bytes, number);
        }
    };
    let door = |door: Option<Door>| door.map_or(0, |Door(door)| door + 1);
    push(&[percept.degree, held]);
    match percept.sighting {
        Sighting::Nothing => push(&[0]),
        Sighting::Pointing(Door(door)) => push(&[1, door]),
        Sighting::Lying(count) => push(&[2, count]),
        Sighting::These(markers) => push(&[3, markers.bits()]),
        Sighting::Passed => push(&[4]),
        Sighting::PassedAlong => push(&[5]),
        Sighting::PassedAgainst => push(&[6]),
        Sighting::String(StringView { doors, fixed_end, free_end, hand }) => {
            push(&[7, doors.bits(), fixed_end.into(), free_end.into(), door(hand)]);
        }
        Sighting::Team(TeamView(others)) => {
            push(&[8]);
            for other in others {
                match other {
                    OtherRobot::Absent => push(&[0]),
                    OtherRobot::Elsewhere { degree } => push(&[1, degree]),
                    OtherRobot::Here => push(&[2]),
                    OtherRobot::HereAlong(Door(door)) => push(&[3, door]),
                    OtherRobot::WithSecond => push(&[4]),
                    OtherRobot::WithSecondAlong(Door(door)) => push(&[5, door]),
                }
            }
        }
        Sighting::Ball(ball) => {
            push(&[9]);
            push(&ball.words());
        }
        Sighting::TwoMarkers(TwoMarkersView { along, movable }) => {
            push(&[11, door(along), movable.into()]);
        }
        Sighting::Compass(view) => {
            push(&[10]);
            // There are as many as doors.
            for direction in view.directions() {
                push(&[direction as u32]);
            }
        }
    }
}

impl AmbiguityCandidate {
    pub(super) fn new(quotient: &QuotientCode, code: &StartCode) -> Self {
        let mut bytes = vec![0; LENGTH];
        for (label, leads_to) in quotient {
            push_label(&mut bytes, *label);
            push_number(&mut bytes, leads_to.len() as u32);
            for &class in leads_to {
                push_number(&mut bytes, class);
            }
        }
        let length = (bytes.len() - LENGTH) as u32;
        bytes[..LENGTH].copy_from_slice(&length.to_be_bytes());
        // A world with fewer edges has a shorter code.
        bytes.push(code.words().len() as u8);
        bytes.extend(code.words().iter().copied().map(to_byte));
        Self(bytes.into_boxed_slice())
    }

    /// The candidate of these bytes; `None` if they are not those of one.
    pub fn from_bytes(bytes: Box<[u8]>) -> Option<Self> {
        let candidate = Self(bytes);
        let (_, world) = candidate.parts()?;
        let (&length, words) = world.split_first()?;
        (usize::from(length) == words.len()).then_some(candidate)
    }

    pub fn as_bytes(&self) -> &[u8] {
        &self.0
    }

    pub fn quotient(&self) -> &[u8] {
        self.parts().map_or(&[], |(quotient, _)| quotient)
    }

    /// The placed world; `None` if the bytes are not those of a candidate.
    pub fn world(&self) -> Option<PlacedWorld> {
        let (_, world) = self.parts()?;
        let words: Vec<u32> = world.get(1..)?.iter().copied().map(to_word).collect();
        let graph = StartCode::start_of(&words)?;
        Some(PlacedWorld { graph, code: StartCode::of_words(words) })
    }

    fn parts(&self) -> Option<(&[u8], &[u8])> {
        let (length, rest) = self.0.split_first_chunk::<LENGTH>()?;
        rest.split_at_checked(u32::from_be_bytes(*length) as usize)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::{
        any_graph::{Class, any_graph},
        embedded_graph::{Dart, EmbeddedGraph},
        isomorphism::{as_discovered, code},
        percept::{Door, Percept},
    };

    fn placed(graph: &EmbeddedGraph, facing: Dart) -> PlacedWorld {
        PlacedWorld { graph: as_discovered(graph, facing), code: code(graph, facing) }
    }

    proptest! {
        #[test]
        fn a_placed_world_is_restored_from_its_candidate_and_ordered_as_in_a_report(
            one in any_graph(Class::Multigraph, 9),
            other in any_graph(Class::Multigraph, 9),
            facing in any::<prop::sample::Index>(),
        ) {
            let worlds =
                [placed(&one, Dart(facing.index(one.dart_count()) as u32)), placed(&other, Dart(0))];
            let candidates =
                worlds.each_ref().map(|world| AmbiguityCandidate::new(&Vec::new(), &world.code));
            let rank = |world: &PlacedWorld| (world.graph.edge_count(), world.code.clone());
            prop_assert_eq!(
                candidates[0].cmp(&candidates[1]),
                rank(&worlds[0]).cmp(&rank(&worlds[1]))
            );
            let [candidate, _] = candidates;
            let [world, _] = worlds;
            prop_assert_eq!(candidate.world(), Some(world));
            let bytes: Box<[u8]> = candidate.as_bytes().into();
            prop_assert_eq!(AmbiguityCandidate::from_bytes(bytes.clone()), Some(candidate));
            for length in 0..bytes.len() {
                prop_assert_eq!(AmbiguityCandidate::from_bytes(bytes[..length].into()), None);
            }
        }
    }

    #[test]
    fn different_quotients_have_different_bytes() {
        let class = |degree, sighting, held, leads_to: &[u32]| {
            ((Percept { degree, sighting }, held), leads_to.into())
        };
        let quotients: [QuotientCode; 11] = [
            vec![],
            vec![class(1, Sighting::Nothing, 0, &[0; 2])],
            vec![class(1, Sighting::Nothing, 0, &[0; 3])],
            vec![class(2, Sighting::Nothing, 0, &[0; 3])],
            vec![class(1, Sighting::Nothing, 1, &[0; 3])],
            vec![class(1, Sighting::Pointing(Door(0)), 0, &[0; 3])],
            vec![class(1, Sighting::Nothing, 0, &[0, 0, 1])],
            vec![class(1, Sighting::Nothing, 0, &[0, 0, 256])],
            vec![class(1, Sighting::Lying(1), 0, &[0; 3])],
            vec![class(1, Sighting::Lying(257), 0, &[0; 3])],
            vec![class(1, Sighting::Nothing, 0, &[0; 3]); 300],
        ];
        let start = StartCode::of_words(vec![u32::MAX - 1, u32::MAX - 1]);
        let candidates = quotients.map(|quotient| AmbiguityCandidate::new(&quotient, &start));
        for (place, one) in candidates.iter().enumerate() {
            for other in &candidates[..place] {
                assert_ne!(one.quotient(), other.quotient());
            }
            assert!(one.world().is_some());
        }
    }

    #[test]
    fn bytes_that_are_no_world_have_none() {
        for wrong in [&[0, 0, 0, 0, 0][..], &[0, 0, 0, 0, 2, 254, 7], &[0, 0, 0, 0, 1, 254]] {
            let candidate = AmbiguityCandidate::from_bytes(wrong.into());
            assert_eq!(candidate.and_then(|candidate| candidate.world()), None, "{wrong:?}");
        }
    }
}
