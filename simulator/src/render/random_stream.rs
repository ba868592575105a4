//! Reproducible randomness: streams of random numbers from a seed, and noise that depends only on
//! the position.

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// The purpose of a stream. Each purpose has its own stream.
#[derive(Clone, Copy, Debug)]
pub enum StreamPurpose {
    Lamps,
    Spots,
    Shadows,
    Gaps,
    Doors,
    Posters,
    /// The noise of the image sensor.
    Sensor,
    /// The slip of the wheels, and the noise of odometry.
    Wheels,
    /// Errors of a camera without images.
    Scenes,
    Faults,
    Rooms,
    /// Furniture that a laser scanner sees.
    Furniture,
    /// Surfaces that give a laser scanner no return.
    Surfaces,
    People,
    Ranges,
    /// Furniture along walls.
    Blocks,
    Cables,
    /// Pipes and struts above the floor.
    Overhead,
}

/// The stream of a seed for a purpose and an index, such as that of a wall.
pub fn stream(seed: u64, purpose: StreamPurpose, number: usize) -> Xoshiro256PlusPlus {
    let mixed = mixed(seed ^ mixed((purpose as u64) << 32 | number as u64));
    Xoshiro256PlusPlus::seed_from_u64(mixed)
}

/// A random number with this expectation: the expectation rounded up or down.
pub fn about(expected: f64, rng: &mut Xoshiro256PlusPlus) -> usize {
    (expected.min(500.0) + rng.random::<f64>()) as usize
}

/// Murmur's finalizer.
fn mixed(mut bits: u64) -> u64 {
    bits = bits.wrapping_add(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ bits >> 31
}

/// A random number from -1 to 1 for each cell of a plane.
#[inline]
pub(crate) fn speckle(x: i32, y: i32, salt: u32) -> f32 {
    let mut bits = (x as u32).wrapping_mul(0x9e37_79b1)
        ^ (y as u32).wrapping_mul(0x85eb_ca6b).rotate_left(13)
        ^ salt;
    bits = (bits ^ bits >> 15).wrapping_mul(0x2c1b_3c6d);
    bits = (bits ^ bits >> 12).wrapping_mul(0x297a_2d39);
    bits ^= bits >> 15;
    bits as f32 * (2.0 / u32::MAX as f32) - 1.0
}

/// The greatest integer not above a value.
#[inline]
pub(crate) fn floor(value: f32) -> i32 {
    let whole = value as i32;
    whole.wrapping_sub(i32::from(value < whole as f32))
}

/// Smooth noise from -1 to 1; its cells have side one.
#[inline]
pub fn clouds(x: f32, y: f32, salt: u32) -> f32 {
    let (left, low) = (floor(x), floor(y));
    let ease = |share: f32| share * share * (3.0 - 2.0 * share);
    let (across, up) = (ease(x - left as f32), ease(y - low as f32));
    let corner = |right, top| speckle(left.wrapping_add(right), low.wrapping_add(top), salt);
    let mix = |one: f32, other: f32, share: f32| one + (other - one) * share;
    mix(mix(corner(0, 0), corner(1, 0), across), mix(corner(0, 1), corner(1, 1), across), up)
}
