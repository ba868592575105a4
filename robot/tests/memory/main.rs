//! Memory limits. The allocator of the whole process is measured, so this is a separate program
//! with one test.

use peak_alloc::PeakAlloc;

mod logs;
mod sensing;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

#[test]
fn reading_and_sensing_take_no_more_memory_than_stated() {
    logs::reading_takes_no_more_memory_than_stated();
    sensing::no_frame_takes_more_memory_than_the_frames_before_it();
}
