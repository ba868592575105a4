//! Processes that run beside a test, and end with it.

use std::{
    process::{Child, Command, Output},
    thread::sleep,
    time::{Duration, Instant},
};

/// Sends a signal, such as `-INT`, that of Ctrl-C.
pub(crate) fn signal(process: &Child, name: &str) {
    let killed = Command::new("kill").args([name, &process.id().to_string()]).status().unwrap();
    assert!(killed.success());
}

/// Waits until something holds, for some seconds at most.
pub(crate) fn until(what: &str, seconds: u64, mut holds: impl FnMut() -> bool) {
    let end = Instant::now() + Duration::from_secs(seconds);
    while !holds() {
        assert!(Instant::now() < end, "not within {seconds} s: {what}");
        sleep(Duration::from_millis(10));
    }
}

/// A process that ends with the test.
pub(crate) struct Process(Option<Child>);

impl Process {
    pub(crate) fn start(command: &mut Command) -> Self {
        Self(Some(command.spawn().unwrap()))
    }

    pub(crate) fn signal(&self, name: &str) {
        signal(self.0.as_ref().unwrap(), name);
    }

    pub(crate) fn ends(mut self) -> Output {
        self.0.take().unwrap().wait_with_output().unwrap()
    }

    /// Its end, which must be within some seconds.
    pub(crate) fn ends_within(mut self, seconds: u64) -> Output {
        let child = self.0.as_mut().unwrap();
        until("the process ends", seconds, || child.try_wait().unwrap().is_some());
        self.ends()
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        if let Some(mut child) = self.0.take()
            && child.try_wait().is_ok_and(|ended| ended.is_none())
        {
            // After Ctrl-C it also stops its own children.
            signal(&child, "-INT");
            let end = Instant::now() + Duration::from_secs(20);
            while Instant::now() < end && child.try_wait().is_ok_and(|ended| ended.is_none()) {
                sleep(Duration::from_millis(20));
            }
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}
