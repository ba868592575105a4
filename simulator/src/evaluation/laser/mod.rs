//! Compares junctions that are sensed with a laser scanner with the truth, in random buildings.

mod corridor_pilot;
pub mod corridor_world;
pub mod judged_walk;
pub mod laser_report;
mod laser_robot;
mod robot_params;
pub mod scanned_run;
pub mod walk;

/// The item with the least distance.
fn nearest<T>(items: impl IntoIterator<Item = T>, off: impl Fn(&T) -> f64) -> Option<T> {
    items.into_iter().min_by(|one, other| off(one).total_cmp(&off(other)))
}
