//! Mapping a world with markers: Algorithm 1, the movable marker algorithm, and their parts.
//! Section 2.3.

mod algorithm1;
mod algorithm1_run;
mod audit;
mod choices;
mod contradiction;
mod explored_map;
mod explorer;
mod flaw;
mod folding_explorer;
mod map_walk;
mod mapping_algorithm;
mod mapping_event;
mod mapping_method;
mod movable_marker;
mod movable_marker_run;
mod partial_map;
mod step_purpose;
mod tree;

pub use algorithm1::{ValidationResult, map_world, step, step_with, try_path};
pub use algorithm1_run::Algorithm1Run;
pub use audit::{Audit, AuditError, AuditMove, audit};
pub use choices::{Choices, MappingChoice, Nearest};
pub use contradiction::{Contradiction, InvalidStep, MappingError};
pub use explored_map::ExploredMap;
pub use explorer::{CostOrder, DEFAULT_MOVE_BOUND, Explorer, ExplorerInfo, StateKey, explore};
pub use flaw::Flaw;
pub use folding_explorer::{
    ArrivalMeasurement, EarlierWalk, FoldingRun, FoldingStep, HypothesisTest, MappedWorld,
    RecoveryConfig, Relocate, map_with_recovery,
};
pub use map_walk::{DEFAULT_DART_BOUND, MapWalk, Observer};
pub use mapping_algorithm::MappingAlgorithm;
pub(crate) use mapping_algorithm::with_explorer;
pub use mapping_event::{FoldingEvent, MappingEvent, MovableEvent, SafeguardEvent};
pub use mapping_method::MappingMethod;
pub use movable_marker::{
    ReachedPlace, explore_edge, map_with_movable_marker, validate_back_link, validate_place,
};
pub use movable_marker_run::MovableMarkerRun;
pub use partial_map::{FACING, PartialMap};
pub use step_purpose::{MapDart, StepPurpose};
