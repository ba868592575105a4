//! Tests of sensing through its public interface.

mod any_image;
mod calibration;
mod camera;
mod colour;
mod rim;
