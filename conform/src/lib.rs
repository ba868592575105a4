//! Checks a recorded run against the specification: the first divergence, what the specification allows
//! there instead, and the class of the fault. Sections 2 and 4 to 6.

// Tests compare exact numbers.
#![cfg_attr(test, allow(clippy::float_cmp))]

mod budget_check;
mod check;
mod config;
mod consistency;
mod divergence;
pub mod earlier_walks;
mod events;
mod extract;
mod frame_content;
pub mod fuzz;
mod impossible;
mod json;
mod judgement;
mod known_world;
mod log_head;
mod marked_visits;
mod measured_hallways;
mod message_clock;
mod placed_scenes;
mod possible_visits;
mod proof;
mod quirks;
mod recorded_events;
mod report;
mod scan_odometry;
mod scan_track;
mod shorten;
mod shorten_measured;
mod tolerance;
mod twin;
mod visit_events;
pub mod words;

#[cfg(test)]
mod tests;

pub use check::{
    CheckError, CheckedLog, DoorChooser, LogCheck, LogSource, MarkerPlaceError, RobotStart,
};
pub use config::{ConformConfig, RunDriver};
pub use divergence::{Divergence, DivergenceCause, FaultClass};
pub use events::{
    CheckedEvent, CheckedKind, EventSource, OutOfOrder, RunEvents, SightingError, UndecidedCause,
};
pub use extract::{
    Evidence, ExtractConfig, ExtractError, ExtractedRun, SkippedMessages, extract, infer_events,
};
pub use frame_content::{FrameContent, FrameContents};
pub use impossible::Impossibility;
pub use json::LogsLine;
pub use judgement::{
    ConformVerdict, JudgeError, Judgement, ReachedLimit, RunCoverage, Unproved, judge,
};
pub use known_world::{Known, KnownWorld};
pub use log_head::{LogHead, MarkerNotShown, RESUMED_REMARK};
pub use marked_visits::{
    AddedMarker, MarkedVisitsError, TimedSighting, VisitedJunction, assume_marker, mark_visits,
    marker_at_start,
};
pub use measured_hallways::MeasuredHallways;
pub use placed_scenes::{SceneClockError, SensedScene};
pub use possible_visits::{PossibleVisits, VisitFit};
pub use quirks::Quirks;
pub use recorded_events::RecordedEvents;
pub use report::{
    Allowed, ComparedDoors, ConformReports, CoveredCase, DivergenceReport, EventPose, Facts,
    FoldedReport, Limit, LogReport, MapSize, MessagePlace, OpenDoor, PoseName, RecordedWorld,
    ReportedEvent, ReportedVisit, RequiredCoverage, SmallestFound, SourceFile, ToleratedQuirk,
    UnprovedDivergence, UnreadLog, WorldFact, case_names,
};
pub use scan_track::{MatchedScans, UnmatchedScan};
pub use shorten::{ShortenedRun, shorten_frames, shorten_run};
pub use twin::TwinWorld;
pub use visit_events::{DrivenVisits, visit_events};
