//! The end of a process whose connection to another one is lost.
//!
//! The threads of timely dataflow that send and receive panic if their connection breaks. Their names have the
//! number of the other process.

use std::{
    panic::{self, AssertUnwindSafe},
    sync::atomic::{AtomicBool, Ordering},
    thread,
    time::Duration,
};

/// The time from the loss of a process to the end of this one. Without it, the others could notice the end of this
/// one first.
const LINGER: Duration = Duration::from_secs(1);

/// Set when the work is done: a connection that breaks now is not lost.
static DONE: AtomicBool = AtomicBool::new(false);

/// Calls `lost` with the number of the process to which the connection is lost first, once, a second later: then all
/// processes name the one that ended, and not one that ended for that reason. It should not return.
pub(crate) fn on_loss(lost: impl Fn(usize) + Send + Sync + 'static) {
    static LOST: AtomicBool = AtomicBool::new(false);
    let usual = panic::take_hook();
    panic::set_hook(Box::new(move |panic| {
        let thread = thread::current();
        match thread.name().and_then(other_process) {
            _ if DONE.load(Ordering::Relaxed) => {}
            Some(process) if !LOST.swap(true, Ordering::Relaxed) => {
                thread::sleep(LINGER);
                if !DONE.load(Ordering::Relaxed) {
                    lost(process);
                }
            }
            // Another thread panics because of the loss, which ends this process before it goes on.
            _ if LOST.load(Ordering::Relaxed) => thread::sleep(2 * LINGER),
            _ => usual(panic),
        }
    }));
}

/// Ends the connections: meanwhile none is lost, whatever errors the threads report.
pub(crate) fn without_loss(end: impl FnOnce()) {
    DONE.store(true, Ordering::Relaxed);
    let _ = panic::catch_unwind(AssertUnwindSafe(end));
    DONE.store(false, Ordering::Relaxed);
}

/// The number of the process to which a thread of timely dataflow sends, or from which it receives.
fn other_process(thread: &str) -> Option<usize> {
    let number = thread.strip_prefix("timely:send-").or(thread.strip_prefix("timely:recv-"))?;
    number.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_of_a_thread_has_the_other_process() {
        assert_eq!(other_process("timely:send-12"), Some(12));
        assert_eq!(other_process("timely:recv-0"), Some(0));
        assert_eq!(other_process("timely:work-0"), None);
        assert_eq!(other_process("main"), None);
    }
}
