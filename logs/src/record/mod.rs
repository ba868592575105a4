//! The record of a run: frames, and events in the order of time. Live, simulated and recorded runs
//! produce the same events; logs, replay, conformance and pages consume them.

mod event;
mod frame;
mod map;
mod observer;
mod sensor;

pub use event::{Arrival, Event, EventId, EventKind, RunEnd, RunEnding, nanoseconds};
pub use frame::{CameraImage, Frame};
pub use map::MapRecord;
pub use observer::{RunObserver, StoppedBy};
pub use sensor::{FrameSensor, NoSensor, SensingError};
