//! Rays in the coordinates of a building.

/// A ray in the building's coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WorldRay {
    pub(crate) origin: [f32; 3],
    pub(crate) direction: [f32; 3],
    /// Direction counter-clockwise from east, in 1/65,536 of a turn.
    pub(crate) turn: u16,
}
