//! Memory limits. The allocator of the whole process is measured, so this is a separate program
//! with one test.

use peak_alloc::PeakAlloc;

mod logs;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

#[test]
fn reading_takes_no_more_memory_than_stated() {
    logs::reading_takes_no_more_memory_than_stated();
}
