//! Starts, permutations, numbers and runs, made from choices. Each choice is among the remaining
//! possibilities, so that no choice is in vain and each structure is made once.

use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    percept::Door,
};

use crate::choose::{Choose, Exhibit, Stop};

/// Not yet joined, or not yet taken.
const FREE: u32 = u32::MAX;

/// A start with the given number of edges, whose facing dart is dart 0; at most `MOST` edges, which is at
/// most 63.
///
/// Darts are numbered in the order in which a robot meets them: the lowest free dart is joined to
/// another free one, or to the first dart of a new vertex. Each start has exactly one such history.
///
/// # Errors
/// Returns an error if this is not a world, which would be a fault of this function or of the constructor.
pub fn start<const MOST: usize>(
    choose: &mut impl Choose,
    edges: usize,
) -> Result<EmbeddedGraph, Stop> {
    let darts = 2 * edges;
    let mut opposite = [[FREE; 2]; MOST];
    let opposite = &mut opposite.as_flattened_mut()[..darts];
    let mut clockwise = [[FREE; 2]; MOST];
    let clockwise = &mut clockwise.as_flattened_mut()[..darts];
    // How many darts are numbered, and how many of these are free.
    let (mut met, mut free) = (0, 0);
    // The lowest free dart.
    let mut this = 0;
    while this < darts {
        if this < met && opposite[this] != FREE {
            this += 1;
            continue;
        }
        let unmet = darts - met;
        // The last two free darts may be joined, and the last one may lead to a dead end, only if
        // nothing is left to be reached.
        let joins = if free == 0 || (free == 2 && unmet > 0) { 0 } else { free - 1 };
        if joins > 0 && (unmet == 0 || choose.below(2) == 0) {
            let other = later_free(opposite, this, choose.below(joins as u8));
            opposite[this] = other as u32;
            opposite[other] = this as u32;
            free -= 2;
        } else {
            let least = if free == 1 && unmet > 1 { 2 } else { 1 };
            let degree = degree(choose, least, unmet);
            let mut dart = met;
            while dart < met + degree {
                clockwise[dart] = dart as u32 + 1;
                dart += 1;
            }
            clockwise[met + degree - 1] = met as u32;
            // The start vertex is met by no dart.
            free += degree;
            if met > 0 {
                opposite[this] = met as u32;
                opposite[met] = this as u32;
                free -= 2;
            }
            met += degree;
        }
    }
    let graph = world(opposite, clockwise)?;
    choose.show(|| Exhibit::World { graph: graph.clone(), facing: Dart(0) });
    Ok(graph)
}

/// The free one after `this` that `pass` free ones precede.
fn later_free(partner: &[u32], this: usize, mut pass: u8) -> usize {
    let mut other = this + 1;
    while partner[other] != FREE || pass > 0 {
        if partner[other] == FREE {
            pass -= 1;
        }
        other += 1;
    }
    other
}

/// A degree from `least`, which is at most 4, to `most`. One of more than 4 is a choice among the small
/// ones, so that worlds drawn at random have many vertices and not a few large ones.
fn degree(choose: &mut impl Choose, least: usize, most: usize) -> usize {
    let small = most.min(4) + 1 - least;
    let option = usize::from(choose.below((small + usize::from(most > 4)) as u8));
    if option < small { least + option } else { 5 + usize::from(choose.below((most - 4) as u8)) }
}

/// A start with at least `LEAST` and at most `MOST` edges, whose facing dart is dart 0.
///
/// # Errors
/// As for [`start`].
pub fn start_of<const LEAST: usize, const MOST: usize>(
    choose: &mut impl Choose,
) -> Result<EmbeddedGraph, Stop> {
    let edges = LEAST + usize::from(choose.below((MOST - LEAST + 1) as u8));
    start::<MOST>(choose, edges)
}

/// The embedded graph of these two permutations.
///
/// # Errors
/// Returns an error if the constructor rejects them.
pub fn world(opposite: &[u32], clockwise: &[u32]) -> Result<EmbeddedGraph, Stop> {
    match EmbeddedGraph::from_permutations(opposite, clockwise) {
        Ok((graph, _)) => Ok(graph),
        Err(_) => Err(Stop::Fails("what was drawn is an embedded graph")),
    }
}

/// A dart of a graph that has at most 127 edges.
pub fn dart(choose: &mut impl Choose, graph: &EmbeddedGraph) -> Dart {
    Dart(u32::from(choose.below(graph.dart_count() as u8)))
}

/// A door of the vertex that was entered by this dart.
pub fn door(choose: &mut impl Choose, graph: &EmbeddedGraph, pose: Dart) -> Door {
    Door(u32::from(choose.below(graph.degree_around(pose) as u8)))
}

/// A permutation of the numbers below `n`, which is at most `MOST`; what follows them is 0.
pub fn permutation<const MOST: usize>(choose: &mut impl Choose, n: usize) -> [u32; MOST] {
    let mut image = [0; MOST];
    let mut taken = [false; MOST];
    let mut number = 0;
    while number < n {
        let mut left = choose.below((n - number) as u8);
        let mut free = 0;
        while taken[free] || left > 0 {
            if !taken[free] {
                left -= 1;
            }
            free += 1;
        }
        taken[free] = true;
        image[number] = free as u32;
        number += 1;
    }
    image
}

/// An involution without fixed points of the numbers below `n`, which is even and at most `MOST`.
pub fn pairing<const MOST: usize>(choose: &mut impl Choose, n: usize) -> [u32; MOST] {
    let mut partner = [FREE; MOST];
    let mut left = n;
    let mut this = 0;
    while this < n {
        if partner[this] == FREE {
            let other = later_free(&partner, this, choose.below((left - 1) as u8));
            partner[this] = other as u32;
            partner[other] = this as u32;
            left -= 2;
        }
        this += 1;
    }
    partner
}

/// A number with any lower `NIBBLES` half bytes, whose higher ones are all 0 or all 15: with 8, any
/// number.
pub fn number<const NIBBLES: u32>(choose: &mut impl Choose) -> u32 {
    let mut number = if NIBBLES < 8 && choose.below(2) == 1 { u32::MAX } else { 0 };
    let mut nibble = 0;
    while nibble < NIBBLES {
        number = number << 4 | u32::from(choose.below(16));
        nibble += 1;
    }
    number
}

pub fn byte(choose: &mut impl Choose) -> u8 {
    choose.below(16) << 4 | choose.below(16)
}

#[cfg(test)]
mod tests {
    use toposlam_model::isomorphism::code;

    use super::*;
    use crate::odometer::ChoiceOdometer;

    /// What is drawn in all cases; no two are the same.
    fn drawn<T: Clone + Ord>(mut draw: impl FnMut(&mut ChoiceOdometer) -> T) -> Vec<T> {
        let mut drawn = Vec::new();
        let lemma = |choose: &mut ChoiceOdometer| {
            drawn.push(draw(choose));
            Ok(())
        };
        ChoiceOdometer::exhaust(lemma, &()).unwrap();
        let mut different = drawn.clone();
        different.sort_unstable();
        different.dedup();
        assert_eq!(different.len(), drawn.len());
        drawn
    }

    /// OEIS A000698, shifted by one, as in the model's own enumeration.
    #[test]
    fn every_start_is_drawn_once() {
        for (edges, count) in [(1, 2), (2, 10), (3, 74), (4, 706), (5, 8162)] {
            let starts = drawn(|choose| code(&start::<5>(choose, edges).unwrap(), Dart(0)));
            assert_eq!(starts.len(), count);
        }
    }

    #[test]
    fn every_permutation_and_every_pairing_is_drawn_once() {
        assert_eq!(drawn(|choose| permutation::<5>(choose, 5)).len(), 120);
        assert_eq!(drawn(|choose| pairing::<8>(choose, 8)).len(), 7 * 5 * 3);
    }

    #[test]
    fn numbers_are_drawn_from_both_ends() {
        let drawn = drawn(number::<1>);
        assert_eq!(drawn.len(), 32);
        assert_eq!(drawn[..16], std::array::from_fn::<u32, 16, _>(|n| n as u32));
        assert_eq!(drawn[31], u32::MAX);
    }
}
