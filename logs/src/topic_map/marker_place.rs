//! Where a marker lies in the frame of odometry.

use std::fmt;

/// Where a marker lies in the frame of odometry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MarkerPlace {
    /// In metres.
    pub position: [f64; 2],
    /// The direction in which it points, in radians counter-clockwise from x; `None` if it has none.
    pub heading: Option<f64>,
}

/// A list, as a mapping file has it.
impl fmt::Display for MarkerPlace {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        let [x, y] = self.position;
        match self.heading {
            Some(heading) => write!(out, "[{x:?}, {y:?}, {heading:?}]"),
            None => write!(out, "[{x:?}, {y:?}]"),
        }
    }
}
