//! Sensing, judged against the truth of the floor plan.
