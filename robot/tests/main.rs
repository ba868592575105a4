//! Tests of the robot through its public interface.

mod logs;
mod renderer;
mod sensing;
