//! Memory limits. The allocator of the whole process is measured, so this is a separate program
//! with one test.

use peak_alloc::PeakAlloc;

mod sensing;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

#[test]
fn sensing_takes_no_more_memory_than_stated() {
    sensing::no_frame_takes_more_memory_than_the_frames_before_it();
}
