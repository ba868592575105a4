//! The arithmetic of doors, darts and degrees: nothing overflows, nothing leaves its range.
//! Section 2.1.

use toposlam_model::{
    embedded_graph::{GraphError, MAX_EDGES, size_fault},
    percept::{Door, MarkerSet, Percept, Sighting},
};

use crate::{
    choose::{CaseResult, Choose, Exhibit, claim, given},
    draw,
    lemma::declare,
};

declare! {
    doors_stay_in_their_range {
        "At a vertex of any degree, the door from one dart to another is below the degree and \
         leads to that dart; its inverse leads back; seen from the first dart, the second is \
         behind this door.",
        paper "2.1",
        // The squares of 0 ... 31.
        exhaustive "two darts and a degree, each up to 15 or among the 16 highest \
                    numbers", 10_416 cases:
            doors::<_, 1>;
        sampled "any numbers of 32 bits": doors::<_, 8>;
        kani "any numbers of 32 bits", unwind 9: doors::<_, 8>;
        symbolic "any numbers of 32 bits": doors::<_, 8>;
    }
    a_percept_can_be_turned_and_turned_back {
        "A percept that is turned to another entry dart and back again is unchanged, unless what \
         was seen lies on the edge of the entry.",
        paper "2.1",
        // The squares of 0 ... 31, for each of six sightings.
        exhaustive "an entry, a sighting and a degree, each up to 15 or among the 16 highest \
                    numbers", 62_496 cases:
            turned::<_, 1>;
        sampled "any numbers of 32 bits": turned::<_, 8>;
        kani "any numbers of 32 bits", unwind 9: turned::<_, 8>;
        symbolic "any numbers of 32 bits": turned::<_, 8>;
    }
    every_door_leads_to_a_dart {
        "Any number, taken as a door at any pose, leads to a dart of the same vertex: as many \
         places clockwise from the entry dart, modulo the degree.",
        paper "2.1",
        // 2 2 + 10 4 + 74 6 + 706 8 poses.
        exhaustive "every start with up to 4 edges, every pose, doors up to 15 and the 16 highest \
                    numbers", 196_352 cases:
            behind::<_, 1, 4, 1>;
        sampled "starts with up to 40 edges, any number of 32 bits": behind::<_, 1, 40, 8>;
        kani "every start with 2 edges, every pose, doors up to 255 and the 256 highest \
              numbers", unwind 8:
            behind::<_, 2, 2, 2>;
    }
    the_highest_numbers_fit {
        "A graph is rejected for its size exactly if it has no edge, or more edges than can be \
         numbered. Any other graph leaves room for a vertex with as many darts: all numbers fit in \
         32 bits, and none is the one that stands for \"none\".",
        paper "2.1",
        exhaustive "two numbers within 256 of 0 or of the most darts", 261_121 cases:
            the_highest::<_, 2>;
        sampled "any numbers of 32 bits": the_highest::<_, 8>;
        kani "any numbers of 32 bits", unwind 9: the_highest::<_, 8>;
        symbolic "any numbers of 32 bits": the_highest::<_, 8>;
    }
}

/// Two numbers below a third.
fn darts_and_degree<const NIBBLES: u32>(choose: &mut impl Choose) -> Result<[u32; 3], crate::Stop> {
    let numbers = [(); 3].map(|()| draw::number::<NIBBLES>(choose));
    choose.show(|| Exhibit::Value { name: "darts, degree", value: format!("{numbers:?}") });
    let [one, other, degree] = numbers;
    given(choose, one < degree && other < degree)?;
    Ok(numbers)
}

// paper: percept.doors
fn doors<C: Choose, const NIBBLES: u32>(choose: &mut C) -> CaseResult {
    let [from, to, degree] = darts_and_degree::<NIBBLES>(choose)?;
    let wide = u64::from;
    let door = Door::between(from, to, degree);
    claim("the door exists", door.0 < degree)?;
    let leads = wide(from) + wide(door.0);
    claim("it leads there", leads == wide(to) || leads == wide(to) + wide(degree))?;
    let back = door.inverse(degree);
    claim("its inverse exists", back.0 < degree)?;
    let turn = wide(door.0) + wide(back.0);
    claim("its inverse leads back", turn == 0 || turn == wide(degree))?;
    claim("the inverse of its inverse is the door", back.inverse(degree) == door)?;
    claim("it is what is seen from the one", Door(to).seen_from(Door(from), degree) == door)?;
    let again = door.seen_from(Door(from).inverse(degree), degree);
    claim("seen from where the one was counted, it is the other", again == Door(to))
}

fn turned<C: Choose, const NIBBLES: u32>(choose: &mut C) -> CaseResult {
    let [door, entry, degree] = darts_and_degree::<NIBBLES>(choose)?;
    let these = |numbers: &[usize]| {
        MarkerSet::from_numbers(numbers.iter().copied()).map_or(Sighting::Nothing, Sighting::These)
    };
    let sighting = match choose.below(6) {
        0 => Sighting::Nothing,
        1 => Sighting::Pointing(Door(door)),
        2 => Sighting::Lying(door),
        3 => these(&[0]),
        4 => these(&[1]),
        _ => these(&[0, 1]),
    };
    let percept = Percept { degree, sighting };
    let turned = percept.seen_from(Door(entry));
    claim("the degree is the same", turned.degree == degree)?;
    if let Sighting::Pointing(door) = turned.sighting {
        claim("the door exists", door.0 < degree)?;
    }
    let back = turned.seen_from(Door(entry).inverse(degree));
    claim("it is the same percept", back == percept)
}

fn behind<C: Choose, const LEAST: usize, const MOST: usize, const NIBBLES: u32>(
    choose: &mut C,
) -> CaseResult {
    let graph = draw::start_of::<LEAST, MOST>(choose)?;
    let pose = draw::dart(choose, &graph);
    let door = Door(draw::number::<NIBBLES>(choose));
    choose.show(|| Exhibit::walk(pose, &[door]));
    let dart = graph.behind(pose, door);
    claim("it is a dart", dart.at() < graph.dart_count())?;
    claim("it is one of the vertex's", graph.vertex(dart) == graph.vertex(pose))?;
    let degree = u64::from(graph.degree_around(pose));
    let place = (u64::from(graph.index(pose)) + u64::from(door.0)) % degree;
    claim("it stands so many places clockwise", u64::from(graph.index(dart)) == place)
}

/// The most darts that a graph can have, and one more that makes no edge.
const MOST_DARTS: usize = 2 * MAX_EDGES + 1;

fn the_highest<C: Choose, const NIBBLES: u32>(choose: &mut C) -> CaseResult {
    // Around each place where anything could change.
    let mut near = || {
        let place = [0, MOST_DARTS as u32][usize::from(choose.below(2))];
        place.wrapping_add(draw::number::<NIBBLES>(choose)) as usize
    };
    let (darts, degree) = (near(), near());
    choose.show(|| Exhibit::Value { name: "darts, degree", value: format!("{darts}, {degree}") });
    let expected = match darts {
        0 | 1 => Some(GraphError::NoEdge),
        2..=MOST_DARTS => None,
        _ => Some(GraphError::TooManyEdges),
    };
    claim("it is rejected exactly for its size", size_fault(darts) == expected)?;
    given(choose, expected.is_none() && size_fault(degree).is_none())?;
    let sum = u32::try_from(darts + degree);
    claim("all numbers fit, and none stands for none", sum.is_ok_and(|sum| sum < u32::MAX))
}
