//! What is found out about all scans of a topic before the first is read: how they write that there is no return.

use std::sync::PoisonError;

use super::{
    no_return::{NoReturnSign, RangeHistogram},
    reader::Log,
};

/// More scans are not looked at.
const SURVEYED: usize = 20_000;

/// The sign of the scans on a topic; `None` if it is the usual one, or none is seen. The scans are read once.
pub(super) fn of_topic(log: &Log, index: usize) -> Option<NoReturnSign> {
    let mut known = log.no_returns.lock().unwrap_or_else(PoisonError::into_inner);
    *known.entry(index).or_insert_with(|| surveyed(log, index))
}

fn surveyed(log: &Log, index: usize) -> Option<NoReturnSign> {
    let topic = log.topics().get(index)?;
    let has_largest_range = ["sensor_msgs/LaserScan", "carmen/RAWLASER", "carmen/ROBOTLASER"];
    if !has_largest_range.iter().any(|kind| topic.short_type().starts_with(kind)) {
        return None;
    }
    let mut histogram = RangeHistogram::default();
    for message in log.read(&[index]).take(SURVEYED).map_while(Result::ok) {
        if let Some(Ok(value)) = topic.decode(&message.bytes) {
            histogram.add(&value);
        }
    }
    histogram.sign()
}
