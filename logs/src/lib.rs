//! Logs of runs: rosbag2 and MCAP of ROS 2, ROS 1 bags, CARMEN logs, lists of events; and the record of a run that
//! live, simulated and recorded runs share. Sections 5 and 6.

// Tests compare exact numbers.
#![cfg_attr(test, allow(clippy::float_cmp))]

mod carmen;
mod compressed;
mod container;
pub mod decode;
pub mod definition;
mod encode;
pub mod entries;
pub mod error;
mod event_line;
pub mod fiducials;
mod from_value;
mod line_times;
mod mcap_writer;
mod merge;
pub mod message;
pub mod messages;
mod no_return;
pub mod reader;
mod reading_remark;
pub mod record;
pub mod recorder;
pub mod rosbag2;
mod scan_convention;
mod scan_survey;
mod sensor_data;
mod skipped_lines;
mod source;
pub mod stamp;
pub mod standard;
pub mod topic;
pub mod topic_map;
mod transforms;
pub mod value;
pub mod verify;
mod world_hash;
pub mod writer;

pub use compressed::FileCompression;
pub use container::{Format, MOST_GROWTH};
pub use encode::{
    action as action_message, arrival as arrival_message, door as door_message, map as map_message,
    scene as scene_message,
};
pub use line_times::LineTimes;
pub use merge::{RawMessage, RawMessages};
pub use no_return::NoReturnSign;
pub use reading_remark::ReadingRemark;
pub use skipped_lines::SkippedLines;
pub use transforms::{FrameTree, Mount, is_robot_frame};
pub use world_hash::{hexadecimal, world_hash};
