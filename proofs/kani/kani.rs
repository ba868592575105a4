//! A stand-in for the library of [Kani](https://github.com/model-checking/kani), as far as the
//! harnesses use it. It proves nothing and runs nothing: where Kani is not installed,
//! `tests/harnesses` checks the types of the harnesses against it. Nothing depends on it.
//!
//! What stands here has the signature that it has in Kani's own `library/kani_core`; what a harness
//! needs besides is to be looked up there first.

pub use kani_macros::{proof, unwind};

/// A type that Kani makes symbols of.
pub trait Arbitrary: Sized {
    /// A symbol.
    fn any() -> Self;
}

impl Arbitrary for u8 {
    fn any() -> Self {
        unimplemented!("this is no Kani")
    }
}

/// A symbol, which stands for every value of its type.
pub fn any<T: Arbitrary>() -> T {
    T::any()
}

/// Goes on only where the condition holds.
pub fn assume(cond: bool) {
    let _ = cond;
}

/// Asks for an execution in which the condition holds.
pub const fn cover(_cond: bool, _msg: &'static str) {}

/// Asks for an execution in which the condition holds.
#[macro_export]
macro_rules! cover {
    ($cond:expr, $msg:literal) => {
        kani::cover($cond, $msg);
    };
}
