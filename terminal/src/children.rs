//! Programs that this program starts. Each is the first of a process group of its own, so that Ctrl-C
//! reaches only this program, which ends the whole group.

use std::{
    collections::BTreeSet,
    io,
    process::{Child, ChildStderr, ChildStdin, ChildStdout, Command, ExitStatus, Stdio},
    sync::{Mutex, MutexGuard, PoisonError},
    thread,
    time::{Duration, Instant},
};

/// The running programs, by their process ids; `None` when this program ends and starts no more.
static RUNNING: Mutex<Option<BTreeSet<u32>>> = Mutex::new(Some(BTreeSet::new()));

fn running() -> MutexGuard<'static, Option<BTreeSet<u32>>> {
    RUNNING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A running program. It is ended when this is dropped.
pub struct RunningProgram {
    child: Child,
    status: Option<ExitStatus>,
}

/// The other ends of a program's standard streams.
pub struct ProgramStreams {
    pub stdin: ChildStdin,
    pub stdout: ChildStdout,
    pub stderr: ChildStderr,
}

impl RunningProgram {
    /// Starts a program.
    ///
    /// # Errors
    /// Returns an error if it cannot be started, or this program ends.
    pub fn start(command: &mut Command) -> io::Result<(Self, ProgramStreams)> {
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(command, 0);
        let mut child = spawn(command)?;
        let streams = (child.stdin.take(), child.stdout.take(), child.stderr.take());
        let program = Self { child, status: None };
        match streams {
            (Some(stdin), Some(stdout), Some(stderr)) => {
                Ok((program, ProgramStreams { stdin, stdout, stderr }))
            }
            _ => Err(io::Error::other("it has no standard streams")),
        }
    }

    /// Waits until the program ends; `None` if it still runs after this time.
    pub fn wait(&mut self, at_most: Duration) -> Option<ExitStatus> {
        let begun = Instant::now();
        while self.status.is_none() {
            // Its process id may belong to another program once it is read.
            let mut running = running();
            self.status = self.child.try_wait().ok().flatten();
            if self.status.is_some() {
                // Programs that it started may still run.
                end_group(self.child.id());
                running.as_mut().map(|running| running.remove(&self.child.id()));
                break;
            }
            drop(running);
            if begun.elapsed() >= at_most {
                break;
            }
            thread::sleep(Duration::from_millis(1));
        }
        self.status
    }
}

impl Drop for RunningProgram {
    fn drop(&mut self) {
        if self.status.is_some() {
            return;
        }
        let mut running = running();
        end_group(self.child.id());
        // It is the only program that is left on a system without process groups.
        let _ = self.child.kill();
        let _ = self.child.wait();
        running.as_mut().map(|running| running.remove(&self.child.id()));
    }
}

/// Starts a program, and lists it. The list is locked meanwhile: otherwise the program could outlive this one.
fn spawn(command: &mut Command) -> io::Result<Child> {
    let mut running = running();
    let Some(running) = running.as_mut() else {
        return Err(io::Error::other("interrupted"));
    };
    let child = command.spawn()?;
    running.insert(child.id());
    Ok(child)
}

/// Ends every program that was started. No other can be started.
pub fn end_all() {
    for id in running().take().unwrap_or_default() {
        end_group(id);
    }
}

/// Ends a program, and those that it started. Nothing else can have this id: the program was not waited for before
/// now, or it started programs that still run.
fn end_group(id: u32) {
    #[cfg(unix)]
    if let Ok(id) = i32::try_from(id) {
        use nix::{
            sys::signal::{Signal, killpg},
            unistd::Pid,
        };
        // It may have ended by itself.
        let _ = killpg(Pid::from_raw(id), Signal::SIGKILL);
    }
    #[cfg(not(unix))]
    let _ = id;
}
