//! The errors of two arrays that are not an embedded graph. Section 2.1.
//!
//! The checks work on plain slices and return a small copyable value.

use thiserror::Error;

use super::MAX_EDGES;

/// Why two arrays are not the `opposite` and `clockwise` of an embedded graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum GraphError {
    /// There is no dart at all.
    #[error("there is no edge; a world has at least one")]
    NoEdge,
    /// There are more edges than [`MAX_EDGES`](super::MAX_EDGES).
    #[error("there are more edges than can be numbered")]
    TooManyEdges,
    /// The two arrays have different lengths.
    #[error("`opposite` has {opposite} darts and `clockwise` has {clockwise}")]
    LengthsDiffer {
        /// The length of `opposite`.
        opposite: usize,
        /// The length of `clockwise`.
        clockwise: usize,
    },
    /// `opposite` names a dart that does not exist.
    #[error("the opposite of dart {dart} is {opposite}, which is not a dart")]
    OppositeOutOfRange {
        /// The dart.
        dart: u32,
        /// What was given as its opposite.
        opposite: u32,
    },
    /// A dart is its own opposite.
    #[error("dart {dart} is its own opposite")]
    OppositeFixed {
        /// The dart.
        dart: u32,
    },
    /// The opposite of the opposite is another dart.
    #[error("the opposite of dart {dart} is {opposite}, whose opposite is another dart")]
    OppositeNotMutual {
        /// The dart.
        dart: u32,
        /// Its opposite.
        opposite: u32,
    },
    /// `clockwise` names a dart that does not exist.
    #[error("clockwise from dart {dart} is {clockwise}, which is not a dart")]
    ClockwiseOutOfRange {
        /// The dart.
        dart: u32,
        /// What was given as the next one.
        clockwise: u32,
    },
    /// Two darts have the same successor around their vertex.
    #[error("clockwise from dart {dart} is {clockwise}, as from an earlier dart")]
    ClockwiseRepeated {
        /// The second of the two darts.
        dart: u32,
        /// The successor that both claim.
        clockwise: u32,
    },
    /// The graph is not connected.
    #[error("dart {dart} cannot be reached from dart 0: the world is not connected")]
    NotConnected {
        /// The least dart that cannot be reached.
        dart: u32,
    },
}

/// The error if a graph cannot have this number of darts.
#[must_use]
pub fn size_fault(darts: usize) -> Option<GraphError> {
    match darts / 2 {
        0 => Some(GraphError::NoEdge),
        edges if edges > MAX_EDGES => Some(GraphError::TooManyEdges),
        _ => None,
    }
}

/// The error if `opposite` is not an involution without fixed points on its own indices.
#[must_use]
pub fn opposite_fault(opposite: &[u32]) -> Option<GraphError> {
    let mut dart = 0;
    while dart < opposite.len() {
        let other = opposite[dart];
        let this = dart as u32;
        if other as usize >= opposite.len() {
            return Some(GraphError::OppositeOutOfRange { dart: this, opposite: other });
        }
        if other == this {
            return Some(GraphError::OppositeFixed { dart: this });
        }
        if opposite[other as usize] != this {
            return Some(GraphError::OppositeNotMutual { dart: this, opposite: other });
        }
        dart += 1;
    }
    None
}

/// The error if `clockwise` is not a permutation of its own indices. `taken` is scratch space, all
/// `false`, at least as long as `clockwise`.
#[must_use]
pub fn clockwise_fault(clockwise: &[u32], taken: &mut [bool]) -> Option<GraphError> {
    let mut dart = 0;
    while dart < clockwise.len() {
        let next = clockwise[dart];
        let this = dart as u32;
        if next as usize >= clockwise.len() {
            return Some(GraphError::ClockwiseOutOfRange { dart: this, clockwise: next });
        }
        if taken[next as usize] {
            return Some(GraphError::ClockwiseRepeated { dart: this, clockwise: next });
        }
        taken[next as usize] = true;
        dart += 1;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_graph_has_at_least_one_edge_and_not_more_than_can_be_numbered() {
        assert_eq!(size_fault(0), Some(GraphError::NoEdge));
        assert_eq!(size_fault(2), None);
        assert_eq!(size_fault(2 * MAX_EDGES), None);
        assert_eq!(size_fault(2 * (MAX_EDGES + 1)), Some(GraphError::TooManyEdges));
    }
}
