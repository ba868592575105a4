//! What is wrong with arrays or lists of names that are not an embedded graph. Section 2.1.

use thiserror::Error;

use super::MAX_EDGES;

/// Why two arrays are not the `opposite` and `clockwise` of an embedded graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum GraphError {
    #[error("there is no edge; a world has at least one")]
    NoEdge,
    #[error("there are more edges than can be numbered")]
    TooManyEdges,
    #[error("`opposite` has {opposite} darts and `clockwise` has {clockwise}")]
    LengthsDiffer { opposite: usize, clockwise: usize },
    #[error("the opposite of dart {dart} is {opposite}, which is not a dart")]
    OppositeOutOfRange { dart: u32, opposite: u32 },
    #[error("dart {dart} is its own opposite")]
    OppositeFixed { dart: u32 },
    #[error("the opposite of dart {dart} is {opposite}, whose opposite is another dart")]
    OppositeNotMutual { dart: u32, opposite: u32 },
    #[error("clockwise from dart {dart} is {clockwise}, which is not a dart")]
    ClockwiseOutOfRange { dart: u32, clockwise: u32 },
    #[error("clockwise from dart {dart} is {clockwise}, as from an earlier dart")]
    ClockwiseRepeated { dart: u32, clockwise: u32 },
    #[error("dart {dart} cannot be reached from the first dart: the world is not connected")]
    NotConnected { dart: u32 },
}

impl GraphError {
    /// The same error, where the first dart has this number.
    #[must_use]
    pub fn counted_from(self, first: u32) -> Self {
        let counted = |dart: u32| dart.saturating_add(first);
        match self {
            Self::NoEdge | Self::TooManyEdges | Self::LengthsDiffer { .. } => self,
            Self::OppositeOutOfRange { dart, opposite } => {
                Self::OppositeOutOfRange { dart: counted(dart), opposite: counted(opposite) }
            }
            Self::OppositeFixed { dart } => Self::OppositeFixed { dart: counted(dart) },
            Self::OppositeNotMutual { dart, opposite } => {
                Self::OppositeNotMutual { dart: counted(dart), opposite: counted(opposite) }
            }
            Self::ClockwiseOutOfRange { dart, clockwise } => {
                Self::ClockwiseOutOfRange { dart: counted(dart), clockwise: counted(clockwise) }
            }
            Self::ClockwiseRepeated { dart, clockwise } => {
                Self::ClockwiseRepeated { dart: counted(dart), clockwise: counted(clockwise) }
            }
            Self::NotConnected { dart } => Self::NotConnected { dart: counted(dart) },
        }
    }
}

/// Why lists of names are not an embedded graph.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum ListError {
    #[error("vertex `{vertex}` has two lists")]
    VertexTwice { vertex: String },
    #[error("vertex `{vertex}` lists the neighbour `{neighbour}`, which is not a vertex{similar}")]
    UnknownNeighbour { vertex: String, neighbour: String, similar: String },
    #[error(
        "vertex `{vertex}` lists the neighbour `{neighbour}`, which does not list `{vertex}` back"
    )]
    OneSided { vertex: String, neighbour: String },
    #[error(
        "vertex `{vertex}` lists the neighbour `{neighbour}` twice; \
         parallel edges need edge names, in [doors]"
    )]
    RepeatedNeighbour { vertex: String, neighbour: String },
    #[error("vertex `{vertex}` lists itself; loops need edge names, in [doors]")]
    OwnNeighbour { vertex: String },
    #[error("edge `{edge}` occurs {times} time{} ({places}); an edge has two ends", if *.times == 1 { "" } else { "s" })]
    NotTwoEnds { edge: String, times: usize, places: String },
    #[error("the world is not connected: vertex `{vertex}` cannot be reached from `{from}`")]
    NotConnected { vertex: String, from: String },
    #[error(transparent)]
    GraphError(#[from] GraphError),
}

/// The error if a graph cannot have this number of darts.
pub fn size_fault(darts: usize) -> Option<GraphError> {
    match darts / 2 {
        0 => Some(GraphError::NoEdge),
        edges if edges > MAX_EDGES => Some(GraphError::TooManyEdges),
        _ => None,
    }
}

/// The error if `opposite` is not an involution without fixed points on its own indices.
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
