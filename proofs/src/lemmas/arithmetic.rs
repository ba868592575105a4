//! The arithmetic of doors, darts and degrees: nothing overflows, nothing leaves its range.
//! Section 2.1.

use toposlam_model::{
    embedded_graph::MAX_EDGES,
    percept::{Door, Percept, Sighting},
};

use crate::{
    choose::{Case, Choose, Exhibit, claim, given},
    draw,
    lemma::declare,
};

declare! {
    doors_stay_in_their_range {
        "At a vertex of any degree, the door from one dart to another is below the degree and leads \
         there, its inverse leads back, and it is the door that is seen from the one.",
        paper "2.1",
        // The squares of 0 ... 31.
        exhaustive "two darts and a degree, each up to 15 or among the 16 highest numbers", 10_416 cases:
            doors::<_, 1>;
        sampled "any numbers of 32 bits": doors::<_, 8>;
        kani "any numbers of 32 bits", unwind 9: doors::<_, 8>;
    }
    a_percept_can_be_turned_and_turned_back {
        "The percept of a vertex, seen from another entry and from there again from the first, is the \
         same percept, if what was seen does not lie on the edge of the entry.",
        paper "2.1",
        // The squares of 0 ... 31, for each of six sightings.
        exhaustive "an entry, a sighting and a degree, each up to 15 or among the 16 highest numbers",
            62_496 cases: turned::<_, 1>;
        sampled "any numbers of 32 bits": turned::<_, 8>;
        kani "any numbers of 32 bits", unwind 9: turned::<_, 8>;
    }
    every_door_leads_to_a_dart {
        "Whatever number is taken as a door, at whatever pose, the dart behind it is one of the \
         vertex's, so many places clockwise from the entry dart, counted modulo the degree.",
        paper "2.1",
        // 2 2 + 10 4 + 74 6 + 706 8 poses.
        exhaustive "every start with up to 4 edges, every pose, doors up to 15 and the 16 highest \
                    numbers", 196_352 cases: behind::<_, 1, 4, 1>;
        sampled "starts with up to 40 edges, any number of 32 bits": behind::<_, 1, 40, 8>;
        kani "every start with 2 edges, every pose, any number of 32 bits", unwind 9:
            behind::<_, 2, 2, 8>;
    }
    the_highest_numbers_fit {
        "A vertex of any degree can be added to a graph of any size that a constructor accepts: the \
         sum fits in 32 bits, no dart has the number that stands for none, and the words of a code \
         for darts and for vertices differ.",
        paper "2.1",
        exhaustive "a size and a degree, each up to 255 or within 256 of the most", 262_144 cases:
            the_highest::<_, 2>;
        sampled "any size and degree": the_highest::<_, 8>;
        kani "any size and degree", unwind 9: the_highest::<_, 8>;
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
fn doors<C: Choose, const NIBBLES: u32>(choose: &mut C) -> Case {
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

fn turned<C: Choose, const NIBBLES: u32>(choose: &mut C) -> Case {
    let [door, entry, degree] = darts_and_degree::<NIBBLES>(choose)?;
    let sighting = match choose.below(6) {
        0 => Sighting::Nothing,
        1 => Sighting::Pointing(Door(door)),
        2 => Sighting::Lying(door),
        3 => Sighting::First,
        4 => Sighting::Second,
        _ => Sighting::Both,
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
) -> Case {
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

fn the_highest<C: Choose, const NIBBLES: u32>(choose: &mut C) -> Case {
    let most = 2 * MAX_EDGES;
    // From either end of what is possible.
    let upto = |number: u32| match number as usize {
        number if number <= most => Some(number),
        number => most.checked_sub(u32::MAX as usize - number),
    };
    let (darts, degree) =
        (upto(draw::number::<NIBBLES>(choose)), upto(draw::number::<NIBBLES>(choose)));
    choose
        .show(|| Exhibit::Value { name: "darts, degree", value: format!("{darts:?}, {degree:?}") });
    let (Some(darts), Some(degree)) = (darts, degree) else {
        return given(choose, false);
    };
    claim("the sum fits", u32::try_from(darts + degree).is_ok())?;
    let (darts, degree) = (darts as u32, degree as u32);
    claim("no dart has the number that stands for none", darts + degree != u32::MAX)?;
    claim("words of darts and of vertices differ", darts < u32::MAX - degree)
}
