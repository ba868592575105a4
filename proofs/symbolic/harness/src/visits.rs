//! Visits that leave several percepts possible. Section 2.1.

use std::collections::BTreeSet;

use toposlam_model::{
    aid::State,
    embedded_graph::{Dart, EmbeddedGraph},
    marker::Directional,
    percept::{Door, Percept, Sighting},
    visits::{VisitAlternative, VisitSet, VisitWay, states_after},
};
use toposlam_proofs::{
    CaseResult, Stop,
    choose::claim,
    draw,
    input::{Input, any_below},
};

use crate::{Body, HOLDS, Harness};

pub(crate) fn all() -> [Harness; 1] {
    [Harness {
        name: "a_set_of_percepts_is_judged_as_its_percepts",
        input: "two sightings of the marker, with any numbers of 32 bits, or one and no vertex, at the marker of \
                a world with 2 edges",
        body: Body::Lemma(judged_as_each),
        covers: &[HOLDS],
    }]
}

/// A sighting of the marker and a door, with any numbers.
fn alternative() -> VisitAlternative {
    let number = || draw::number::<8>(&mut Input);
    let percept = Percept { degree: number(), sighting: Sighting::Pointing(Door(number())) };
    VisitAlternative { percept, door: Some(Door(number())) }
}

/// The states after a visit with two alternatives are those after the one and those after the other.
fn judged_as_each(_: &mut Input) -> CaseResult {
    let Ok((graph, _)) = EmbeddedGraph::from_permutations(&[1, 0, 3, 2], &[2, 1, 0, 3]) else {
        return Err(Stop::Fails("this is a world"));
    };
    let start = State { pose: Dart(0), placed: Dart(0) };
    let one = Some(alternative());
    let other = (any_below(2) == 1).then(alternative);
    let after = |alternatives: &[Option<VisitAlternative>]| {
        let visit = VisitSet::new(alternatives.iter().copied(), VisitWay::Back);
        states_after(&graph, &Directional, &[start], &[visit]).concat()
    };
    let both: BTreeSet<State> = after(&[one]).into_iter().chain(after(&[other])).collect();
    claim("a set is judged as its percepts", after(&[one, other]).into_iter().eq(both))
}
