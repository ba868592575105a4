//! Rays in the coordinates of a building.

/// A ray in the building's coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) struct WorldRay {
    pub(super) origin: [f32; 3],
    pub(super) direction: [f32; 3],
    /// Direction counter-clockwise from east, in 1/65,536 of a turn.
    pub(super) turn: u16,
}
