//! A process of a cluster.

use std::{
    mem,
    sync::{
        Arc, Mutex, PoisonError,
        mpsc::{self, RecvTimeoutError},
    },
    time::{Duration, Instant},
};

use serde::{Deserialize, Serialize};
use thiserror::Error;
use timely::communication::WorkerGuards;
use toposlam_model::enumerate::Watch;

use crate::{
    ConnectError, Hosts, Setting,
    connect::{Connector, PATIENCE},
    dataflow::{self, Job, JobEvent, JobMessage, TimelyWorker},
    loss,
};

/// The time after which the watch is asked again whether to stop.
const BETWEEN_QUESTIONS: Duration = Duration::from_millis(50);

type Command = Box<dyn FnOnce(&mut TimelyWorker) + Send>;

/// Why a cluster has no result.
#[derive(Debug, Error)]
pub enum ClusterError {
    #[error(transparent)]
    Connect(#[from] ConnectError),
    /// Timely dataflow does not start, or its thread ended.
    #[error("timely dataflow ended: {0}")]
    Ended(String),
    #[error("interrupted")]
    Interrupted,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ThreadUse {
    pub process: usize,
    /// The thread in its process, from 0.
    pub thread: usize,
    pub tasks: u64,
    pub busy_seconds: f64,
    /// The rest of the time from the first task of all to the end of the last, in seconds.
    pub idle_seconds: f64,
}

/// The groups of all processes, in their order, and what each thread did.
pub(crate) struct JobEnd<G> {
    pub(crate) groups: Vec<G>,
    pub(crate) threads: Vec<ThreadUse>,
}

/// One of some processes that share work. All of them do the same calls in the same order.
pub struct ClusterProcess {
    process: usize,
    processes: usize,
    commands: mpsc::Sender<Command>,
    guards: Option<WorkerGuards<()>>,
}

impl ClusterProcess {
    /// Connects to the other processes, and waits for them. `settings` must be the same in all of them.
    /// `waiting` is called with the names of those that are not there soon, and again if others are missing. `lost` is called with the
    /// name of a process to which the connection is lost; it should end this process.
    ///
    /// # Errors
    /// Returns an error if a process does other work, if one is not there within 10 minutes, or if the watch
    /// stops the wait.
    pub fn connect(
        hosts: &Hosts,
        process: usize,
        settings: &[Setting],
        watch: &dyn Watch,
        waiting: &dyn Fn(&[String]),
        lost: impl Fn(&str) + Send + Sync + 'static,
    ) -> Result<Self, ClusterError> {
        let own = [("the list of hosts".to_owned(), hosts.all())];
        let settings = &[settings, &own[..]].concat();
        let streams =
            Connector { hosts, process, settings, watch, waiting, patience: PATIENCE }.connect()?;
        let all = hosts.clone();
        loss::on_loss(move |other| lost(&all.name(other)));
        let (commands, received) = mpsc::channel::<Command>();
        let received = Mutex::new(received);
        let guards = dataflow::start(streams, process, move |worker| {
            let received = received.lock().unwrap_or_else(PoisonError::into_inner);
            for command in received.iter() {
                command(worker);
            }
        });
        let guards = Some(guards.map_err(ClusterError::Ended)?);
        Ok(Self { process, processes: hosts.count(), commands, guards })
    }

    /// Whether this is process 0, which has the result.
    pub fn is_first(&self) -> bool {
        self.process == 0
    }

    /// Ends the connections, when the work of all processes is done.
    pub fn close(mut self) {
        if let Some(guards) = self.guards.take() {
            drop(mem::replace(&mut self.commands, mpsc::channel().0));
            // Another process may be killed now, which changes nothing.
            loss::without_loss(|| drop(guards.join()));
        }
    }

    /// Does these tasks of a job, which only process 0 needs to know. `done` is called in process 0 for each
    /// of them, and the end has nothing in the others.
    pub(crate) fn run<J: Job>(
        &self,
        job: Arc<J>,
        tasks: Vec<usize>,
        watch: &dyn Watch,
        done: &mut dyn FnMut(usize, J::Output),
    ) -> Result<JobEnd<J::Group>, ClusterError> {
        let (events, received) = mpsc::channel();
        let begun = Instant::now();
        let mut left = if self.is_first() { tasks.len() } else { 0 };
        self.command(move |worker| dataflow::run(worker, job, tasks, &events))?;
        let mut ends = Vec::new();
        let mut is_complete = false;
        let mut seconds = 0.0;
        receive(&received, watch, &mut |event| match event {
            JobEvent::Done(task, output) => {
                seconds = begun.elapsed().as_secs_f64();
                left -= 1;
                done(task, output);
            }
            JobEvent::End(end) => ends.push(end),
            JobEvent::Complete => is_complete = true,
        })?;
        let expected_ends = if self.is_first() { self.processes } else { 0 };
        if !is_complete || left > 0 || ends.len() != expected_ends {
            return Err(ClusterError::Ended("some results are missing".to_owned()));
        }
        ends.sort_by_key(|end| end.process);
        let mut threads = Vec::new();
        let mut groups = Vec::new();
        for end in ends {
            for (thread, (tasks, busy_seconds)) in end.threads.into_iter().enumerate() {
                let idle_seconds = f64::max(seconds - busy_seconds, 0.0);
                let process = end.process;
                threads.push(ThreadUse { process, thread, tasks, busy_seconds, idle_seconds });
            }
            groups.push(end.group);
        }
        Ok(JobEnd { groups, threads })
    }

    /// The value that process 0 gives, in all processes.
    pub(crate) fn share<T: JobMessage>(
        &self,
        value: Option<T>,
        watch: &dyn Watch,
    ) -> Result<T, ClusterError> {
        let (values, received) = mpsc::channel();
        self.command(move |worker| dataflow::share(worker, value, values))?;
        let mut shared = None;
        receive(&received, watch, &mut |value| shared = Some(value))?;
        shared.ok_or_else(|| ClusterError::Ended("there is no result".to_owned()))
    }

    fn command(
        &self,
        command: impl FnOnce(&mut TimelyWorker) + Send + 'static,
    ) -> Result<(), ClusterError> {
        let sent = self.commands.send(Box::new(command));
        sent.map_err(|_| ClusterError::Ended("its thread does not answer".to_owned()))
    }
}

/// Receives all that is sent until the senders are gone.
fn receive<T>(
    received: &mpsc::Receiver<T>,
    watch: &dyn Watch,
    handle: &mut dyn FnMut(T),
) -> Result<(), ClusterError> {
    loop {
        match received.recv_timeout(BETWEEN_QUESTIONS) {
            Ok(value) => handle(value),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return Ok(()),
        }
        if watch.stop() {
            return Err(ClusterError::Interrupted);
        }
    }
}

impl Drop for ClusterProcess {
    /// Without [`close`](Self::close), the work is not done. The process ends, and nobody waits for the others.
    /// The connections must break: if the worker ended by itself, the others would wait for this process.
    fn drop(&mut self) {
        if let Some(guards) = self.guards.take() {
            mem::forget(guards);
            mem::forget(self.commands.clone());
        }
    }
}
