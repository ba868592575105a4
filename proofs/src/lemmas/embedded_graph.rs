//! What the constructors accept: `opposite` is an involution without fixed points, `clockwise` a
//! permutation, and the graph connected. Section 2.1.

use toposlam_model::embedded_graph::{
    Dart, EmbeddedGraph, GraphError, Vertex, clockwise_fault, opposite_fault,
};

use crate::{
    choose::{CaseResult, Choose, Exhibit, claim, given},
    definition::{is_connected, is_involution_without_fixed_points, is_permutation},
    draw,
    lemma::declare,
};

declare! {
    opposite_is_checked {
        "An array is rejected as `opposite` exactly if it is not an involution without fixed \
         points, and the reported fault is there.",
        paper "2.1",
        exhaustive "every array of up to 6 entries, each up to 6 or the highest \
                    number", 299_593 cases:
            opposite_is_checked::<_, 0, 6, 0>;
        sampled "involutions of up to 60 darts, up to two entries altered":
            altered_opposite::<_, 60>;
        kani "every array of 6 numbers of 32 bits", unwind 9: opposite_is_checked::<_, 6, 6, 8>;
    }
    clockwise_is_checked {
        "An array is rejected as `clockwise` exactly if it is not a permutation, and the reported \
         fault is there.",
        paper "2.1",
        exhaustive "every array of up to 6 entries, each up to 6 or the highest \
                    number", 299_593 cases:
            clockwise_is_checked::<_, 0, 6, 0>;
        sampled "permutations of up to 60 darts, up to two entries altered":
            altered_clockwise::<_, 60>;
        kani "every array of 6 numbers of 32 bits", unwind 9: clockwise_is_checked::<_, 6, 6, 8>;
    }
    arrays_are_accepted_exactly_if_they_are_a_graph {
        "Two arrays are accepted exactly if they are `opposite` and `clockwise` of a connected \
         graph with an edge; then the graph has them, under the returned numbers.",
        paper "2.1",
        exhaustive "any two arrays of up to 4 entries, each up to 4 or the highest \
                    number", 2_418_025 cases:
            arrays_are_accepted::<_, 0, 4, 0>;
        kani "any two arrays of 4 numbers of 32 bits", unwind 9: arrays_are_accepted::<_, 4, 4, 8>;
    }
    permutations_are_accepted_exactly_if_connected {
        "An involution without fixed points and a permutation are accepted exactly if every dart \
         can be reached from every other; then the graph has them, under the returned numbers.",
        paper "2.1",
        // 2 + 3 4! + 15 6! + 105 8!
        exhaustive "every two such permutations of up to 8 darts", 4_244_474 cases:
            permutations_are_accepted::<_, 1, 4, 8>;
        sampled "permutations of up to 40 darts": permutations_are_accepted::<_, 1, 20, 40>;
    }
    darts_that_nothing_leads_out_of_are_all_darts {
        "A non-empty set of darts that contains the opposite and the clockwise successor of each \
         of its darts is the set of all darts.",
        paper "2.1",
        exhaustive "every such set in every start with up to 4 edges", 792 cases:
            closed_sets::<_, 1, 4>;
    }
}

/// An array of `n` entries of the given number of half bytes; with 0 half bytes each entry is at most
/// `MOST`, or the highest number.
fn array<const MOST: usize, const NIBBLES: u32>(choose: &mut impl Choose, n: usize) -> [u32; MOST] {
    let mut array = [0; MOST];
    let mut place = 0;
    while place < n {
        array[place] = if NIBBLES > 0 {
            draw::number::<NIBBLES>(choose)
        } else {
            match usize::from(choose.below(MOST as u8 + 2)) {
                entry if entry <= MOST => entry as u32,
                _ => u32::MAX,
            }
        };
        place += 1;
    }
    choose.show(|| Exhibit::Value { name: "array", value: format!("{:?}", &array[..n]) });
    array
}

/// A number from `LEAST` to `MOST`.
fn length<const LEAST: usize, const MOST: usize>(choose: &mut impl Choose) -> usize {
    LEAST + usize::from(choose.below((MOST - LEAST + 1) as u8))
}

/// The array, with up to two entries altered to any up to `n`.
fn altered<const MOST: usize>(
    choose: &mut impl Choose,
    mut array: [u32; MOST],
    n: usize,
) -> [u32; MOST] {
    for _ in 0..choose.below(3) {
        if n > 0 {
            array[usize::from(choose.below(n as u8))] = choose.below(n as u8 + 1).into();
        }
    }
    choose.show(|| Exhibit::Value { name: "array", value: format!("{:?}", &array[..n]) });
    array
}

fn opposite_is_checked<C: Choose, const LEAST: usize, const MOST: usize, const NIBBLES: u32>(
    choose: &mut C,
) -> CaseResult {
    let n = length::<LEAST, MOST>(choose);
    check_opposite(&array::<MOST, NIBBLES>(choose, n)[..n])
}

fn altered_opposite<C: Choose, const MOST: usize>(choose: &mut C) -> CaseResult {
    let n = length::<0, MOST>(choose) / 2 * 2;
    let array = draw::pairing::<MOST>(choose, n);
    check_opposite(&altered(choose, array, n)[..n])
}

fn check_opposite(array: &[u32]) -> CaseResult {
    let fault = opposite_fault(array);
    claim(
        "it is accepted exactly if it is an involution without fixed points",
        fault.is_none() == is_involution_without_fixed_points(array),
    )?;
    let is_there = match fault {
        None => true,
        Some(GraphError::OppositeOutOfRange { dart, opposite }) => {
            array[dart as usize] == opposite && opposite as usize >= array.len()
        }
        Some(GraphError::OppositeFixed { dart }) => array[dart as usize] == dart,
        Some(GraphError::OppositeNotMutual { dart, opposite }) => {
            array[dart as usize] == opposite && array[opposite as usize] != dart
        }
        Some(_) => false,
    };
    claim("the fault is there", is_there)
}

fn clockwise_is_checked<C: Choose, const LEAST: usize, const MOST: usize, const NIBBLES: u32>(
    choose: &mut C,
) -> CaseResult {
    let n = length::<LEAST, MOST>(choose);
    check_clockwise::<MOST>(&array::<MOST, NIBBLES>(choose, n)[..n])
}

fn altered_clockwise<C: Choose, const MOST: usize>(choose: &mut C) -> CaseResult {
    let n = length::<0, MOST>(choose);
    let array = draw::permutation::<MOST>(choose, n);
    check_clockwise::<MOST>(&altered(choose, array, n)[..n])
}

fn check_clockwise<const MOST: usize>(array: &[u32]) -> CaseResult {
    let fault = clockwise_fault(array, &mut [false; MOST]);
    claim(
        "it is accepted exactly if it is a permutation",
        fault.is_none() == is_permutation(array),
    )?;
    let is_there = match fault {
        None => true,
        Some(GraphError::ClockwiseOutOfRange { dart, clockwise }) => {
            array[dart as usize] == clockwise && clockwise as usize >= array.len()
        }
        Some(GraphError::ClockwiseRepeated { dart, clockwise }) => {
            let mut earlier = 0;
            while earlier < dart as usize && array[earlier] != clockwise {
                earlier += 1;
            }
            earlier < dart as usize && array[dart as usize] == clockwise
        }
        Some(_) => false,
    };
    claim("the fault is there", is_there)
}

/// Whether the graph has these permutations, under the numbers of their darts.
fn has(graph: &EmbeddedGraph, numbers: &[Dart], opposite: &[u32], clockwise: &[u32]) -> bool {
    let darts = opposite.len();
    if graph.dart_count() != darts || numbers.len() != darts {
        return false;
    }
    let mut dart = 0;
    while dart < darts {
        let number = numbers[dart];
        let mut other = 0;
        while other < dart && numbers[other] != number {
            other += 1;
        }
        let around = graph.degree(graph.vertex(number));
        if number.at() >= darts
            || other < dart
            || graph.opposite(number) != numbers[opposite[dart] as usize]
            || graph.clockwise(number) != numbers[clockwise[dart] as usize]
            || graph.counterclockwise(graph.clockwise(number)) != number
            || graph.degree_around(number) != around
            || graph.dart(graph.vertex(number), graph.index(number)) != Some(number)
            || orbit(clockwise, dart) != around
        {
            return false;
        }
        dart += 1;
    }
    graph.vertex(Dart(0)) == Vertex(0)
}

/// The number of darts around a dart's vertex.
fn orbit(clockwise: &[u32], dart: usize) -> u32 {
    let mut next = clockwise[dart] as usize;
    let mut count = 1;
    while next != dart {
        next = clockwise[next] as usize;
        count += 1;
    }
    count
}

// paper: world.graph, world.embedding
fn arrays_are_accepted<C: Choose, const LEAST: usize, const MOST: usize, const NIBBLES: u32>(
    choose: &mut C,
) -> CaseResult {
    let n = length::<LEAST, MOST>(choose);
    let opposite = array::<MOST, NIBBLES>(choose, n);
    let opposite = &opposite[..n];
    let n = length::<LEAST, MOST>(choose);
    let clockwise = array::<MOST, NIBBLES>(choose, n);
    let clockwise = &clockwise[..n];
    let is_graph = n > 0
        && opposite.len() == n
        && is_involution_without_fixed_points(opposite)
        && is_permutation(clockwise)
        && is_connected(opposite, clockwise, &mut [false; MOST]);
    match EmbeddedGraph::from_permutations(opposite, clockwise) {
        Ok((graph, numbers)) => {
            claim("what is accepted is a graph", is_graph)?;
            claim("the graph has them", has(&graph, &numbers, opposite, clockwise))
        }
        Err(_) => claim("what is refused is no graph", !is_graph),
    }
}

fn permutations_are_accepted<
    C: Choose,
    const LEAST: usize,
    const MOST: usize,
    const DARTS: usize,
>(
    choose: &mut C,
) -> CaseResult {
    let darts = 2 * length::<LEAST, MOST>(choose);
    let opposite = draw::pairing::<DARTS>(choose, darts);
    let opposite = &opposite[..darts];
    let clockwise = draw::permutation::<DARTS>(choose, darts);
    let clockwise = &clockwise[..darts];
    choose.show(|| Exhibit::Value { name: "opposite", value: format!("{opposite:?}") });
    choose.show(|| Exhibit::Value { name: "clockwise", value: format!("{clockwise:?}") });
    let connected = is_connected(opposite, clockwise, &mut [false; DARTS]);
    match EmbeddedGraph::from_permutations(opposite, clockwise) {
        Ok((graph, numbers)) => {
            claim("what is accepted is connected", connected)?;
            claim("the graph has them", has(&graph, &numbers, opposite, clockwise))
        }
        Err(GraphError::NotConnected { .. }) => {
            claim("what is refused is not connected", !connected)
        }
        Err(_) => claim("nothing else is rejected", false),
    }
}

fn closed_sets<C: Choose, const LEAST: usize, const MOST: usize>(choose: &mut C) -> CaseResult {
    let graph = draw::start_of::<LEAST, MOST>(choose)?;
    let mut within = [[false; 2]; MOST];
    let within = within.as_flattened_mut();
    let mut size = 0;
    let mut dart = 0;
    while dart < graph.dart_count() {
        within[dart] = choose.below(2) == 1;
        size += usize::from(within[dart]);
        dart += 1;
    }
    let mut closed = size > 0;
    let mut dart = 0;
    while dart < graph.dart_count() {
        let this = Dart(dart as u32);
        closed &= !within[dart]
            || (within[graph.opposite(this).at()] && within[graph.clockwise(this).at()]);
        dart += 1;
    }
    given(choose, closed)?;
    claim("it is the set of all darts", size == graph.dart_count())
}
