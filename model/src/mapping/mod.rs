//! Mapping a world with a marking aid: Algorithm 1, the folding explorer, the explorers with markers, strings and robots
//! that move, and their parts. Section 2.3.

mod algorithm1;
pub(crate) mod audit;
mod candidates;
mod contradiction;
mod explored_map;
mod explorer;
mod folding_explorer;
mod map_walk;
mod mapping_algorithm;
mod mapping_event;
mod mapping_method;
mod movable_markers;
mod partial_map;
mod short_string;
mod team;
mod thread;
mod tree;

pub use algorithm1::{Algorithm1Run, MappingChoice};
pub use contradiction::{Contradiction, Flaw, InvalidStep, MappingError};
pub use explored_map::ExploredMap;
pub use explorer::{CostOrder, Explorer, ExplorerInfo, StateLevel, explore, explore_with};
pub(crate) use folding_explorer::map_with_recovery;
pub use folding_explorer::{
    ArrivalMeasurement, EarlierWalk, FoldingRun, FoldingStep, HypothesisTest, MappedWorld,
    RecoveryConfig, Relocate, WithMovableRun, WithMovableStep,
};
pub use map_walk::{DEFAULT_DART_BOUND, MapWalk, Mapped, Observed, ObservedWorld, Observer};
pub use mapping_algorithm::MappingAlgorithm;
pub(crate) use mapping_algorithm::with_explorer;
pub use mapping_event::{
    FoldingEvent, MapDart, MappingEvent, MovableEvent, SafeguardEvent, StepPurpose,
};
pub use mapping_method::MappingMethod;
pub use movable_markers::MovableMarkerRun;
pub use partial_map::{FACING, PartialMap};
pub use short_string::ShortStringRun;
pub use team::TeamRun;
pub use thread::ThreadRun;
