//! Mapping a world with markers: Algorithm 1, the movable marker algorithm, and their parts.
//! Section 2.3.

mod algorithm1;
mod audit;
mod choices;
mod contradiction;
mod exploration;
mod folding_explorer;
mod journey;
mod mapping_event;
mod mapping_method;
mod mapping_run;
mod marker_search;
mod movable_marker;
mod partial_map;
mod tree;

pub use algorithm1::{ValidationResult, map_world, step, step_with, try_path};
pub use audit::{Audit, AuditError, AuditMove, audit};
pub use choices::{Choices, MappingChoice, Nearest};
pub use contradiction::{Contradiction, InvalidStep, MappingError};
pub use exploration::{DEFAULT_DART_BOUND, Exploration};
pub use folding_explorer::{
    ArrivalMeasurement, EarlierWalk, FoldingExploration, FoldingStep, HypothesisTest, MappedWorld,
    RecoveryConfig, Relocate, map_by_folding, map_with_recovery,
};
pub use journey::{Journey, Observer};
pub use mapping_event::{FoldingEvent, MappingEvent, MovableEvent, SafeguardEvent};
pub use mapping_method::MappingMethod;
pub use mapping_run::{DirectionalAlgorithm, MappingRun};
pub use marker_search::MarkerSearch;
pub use movable_marker::{
    ReachedPlace, explore_edge, map_with_movable_marker, validate_back_link, validate_place,
};
pub use partial_map::{FACING, PartialMap};
