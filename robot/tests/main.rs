//! Tests of the robot through its public interface.

mod logs;
mod modules;
mod renderer;
mod sensing;
