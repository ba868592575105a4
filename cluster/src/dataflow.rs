//! The dataflow of a job. Each process has one worker of timely dataflow, which exchanges messages and never
//! computes for long; the tasks run on the threads of rayon's pool.
//!
//! ```text
//!   +--> work ----- reports ----> dispatch --+      dispatch: process 0
//!   |      \                                 |
//!   |       +--- records by key ---> group ---> end: process 0
//!   +------------- assignments <-------------+
//! ```
//!
//! The loop ends when no task is left: then no process can send a message. Each process sees that and
//! groups its records.

use std::{
    cell::RefCell,
    net::TcpStream,
    rc::Rc,
    sync::{
        Arc,
        mpsc::{self, Sender},
    },
    time::{Duration, Instant},
};

use serde::{Deserialize, Serialize, de::DeserializeOwned};
pub(crate) use timely::worker::Worker as TimelyWorker;
use timely::{
    WorkerConfig,
    communication::{
        Hooks, WorkerGuards,
        allocator::{
            AllocatorBuilder, ProcessBuilder,
            zero_copy::initialize::initialize_networking_from_sockets,
        },
    },
    container::CapacityContainerBuilder,
    dataflow::{
        Scope, StreamVec,
        channels::pact::Exchange,
        operators::{
            Capability, ConnectLoop, Feedback, Probe, ToStream,
            generic::{
                OutputBuilder, OutputBuilderSession, builder_rc::OperatorBuilder,
                operator::Operator,
            },
            probe::Handle,
        },
    },
    scheduling::SyncActivator,
};

pub(crate) trait JobMessage:
    Clone + Serialize + DeserializeOwned + Send + Sync + 'static
{
}
impl<T: Clone + Serialize + DeserializeOwned + Send + Sync + 'static> JobMessage for T {}

/// Work that is divided into tasks, which are numbered from 0. The jobs of all processes are equal.
pub(crate) trait Job: Send + Sync + 'static {
    /// What a task reports to process 0.
    type Output: JobMessage;
    /// What a task finds under a key.
    type Record: JobMessage;
    /// What becomes of all records of some keys.
    type Group: JobMessage;

    fn work(&self, task: usize) -> (Self::Output, Vec<Self::Record>);

    /// The key of a record. Equal keys meet in one process.
    fn key(record: &Self::Record) -> u64;

    /// Groups all records of the keys of this process.
    fn group(&self, records: Vec<Self::Record>) -> Self::Group;
}

type Round = u64;

/// The output of an operator that sends nothing.
type Nothing<'o> = OutputBuilderSession<'o, Round, CapacityContainerBuilder<Vec<()>>>;

pub(crate) enum JobEvent<J: Job> {
    /// In process 0: a task is done.
    Done(usize, J::Output),
    /// In process 0: what a process has at the end.
    End(ProcessEnd<J::Group>),
    /// The job has ended in all processes.
    Complete,
}

#[derive(Clone, Serialize, Deserialize)]
pub(crate) struct ProcessEnd<G> {
    pub(crate) process: usize,
    /// For each thread, the tasks that it did and the seconds that they took.
    pub(crate) threads: Vec<(u64, f64)>,
    pub(crate) group: G,
}

/// A process has done tasks, and can do others.
#[derive(Clone, Serialize, Deserialize)]
struct Report<O> {
    process: usize,
    done: Vec<(usize, O)>,
    /// The number of assignments that it wants.
    wanted: usize,
}

/// Tasks for a thread of a process.
#[derive(Clone, Serialize, Deserialize)]
struct Assignment {
    process: usize,
    tasks: Vec<usize>,
}

struct Finished<J: Job> {
    done: Vec<(usize, J::Output)>,
    records: Vec<J::Record>,
    thread: usize,
    time: Duration,
}

/// An assignment has this share of the tasks that are left for a thread. At the end it has one task. A larger number
/// makes more messages, a smaller one makes threads end later than others: guided self-scheduling
/// (C. D. Polychronopoulos and D. J. Kuck, 1987).
const ASSIGNMENTS_TO_COME: usize = 32;

/// The assignments of a thread at a time: one that it does, and one that is next.
const ASSIGNMENTS_AT_A_TIME: usize = 2;

/// The reports of tasks, and what they found.
type Done<'s, J> =
    (StreamVec<'s, Round, Report<<J as Job>::Output>>, StreamVec<'s, Round, <J as Job>::Record>);

/// The tasks of each thread, and the seconds that they took.
type ThreadTimes = Rc<RefCell<Vec<(u64, f64)>>>;

/// Starts the worker of a process that is connected to the others.
pub(crate) fn start(
    streams: Vec<Option<TcpStream>>,
    process: usize,
    work: impl Fn(&mut TimelyWorker) + Send + Sync + 'static,
) -> Result<WorkerGuards<()>, String> {
    let hooks = Hooks::default();
    let own = ProcessBuilder::new_typed_vector(1, hooks.refill.clone(), None);
    let (builders, guard) = initialize_networking_from_sockets(own, streams, process, 1, hooks)
        .map_err(|error| error.to_string())?;
    let builders = builders.into_iter().map(AllocatorBuilder::Tcp).collect();
    timely::execute::execute_from(builders, Box::new(guard), WorkerConfig::default(), work)
}

/// Does a job with all other workers. Only worker 0 needs its tasks.
pub(crate) fn run<J: Job>(
    worker: &mut TimelyWorker,
    job: Arc<J>,
    tasks: Vec<usize>,
    events: &Sender<JobEvent<J>>,
) {
    let probe = worker.dataflow::<Round, _, _>(|scope| {
        let times = ThreadTimes::default();
        times.borrow_mut().resize(rayon::current_num_threads(), (0, 0.0));
        let (handle, assignments) = scope.feedback(1);
        let (reports, records) = work(scope, assignments, Arc::clone(&job), Rc::clone(&times));
        dispatch(scope.peers(), reports, tasks, events.clone()).connect_loop(handle);
        end(group(scope.index(), records, job, times), events.clone())
    });
    finish(worker, &probe);
    // Without a receiver, nobody needs it any more.
    let _ = events.send(JobEvent::Complete);
}

/// Sends a value of worker 0 to all.
pub(crate) fn share<T: JobMessage>(worker: &mut TimelyWorker, value: Option<T>, values: Sender<T>) {
    let probe = worker.dataflow::<Round, _, _>(|scope| {
        let all = 0..scope.peers() as u64;
        let copies = value
            .into_iter()
            .flat_map(move |value| all.clone().map(move |process| (process, value.clone())));
        let copies: StreamVec<'_, Round, (u64, T)> = copies.to_stream(scope);
        let shared: StreamVec<'_, Round, ()> =
            copies.unary(Exchange::new(|(process, _): &(u64, T)| *process), "share", |_, _| {
                move |input, _: &mut Nothing<'_>| {
                    input.for_each(|_, shared| {
                        for (_, value) in shared.drain(..) {
                            let _ = values.send(value);
                        }
                    });
                }
            });
        shared.probe().0
    });
    finish(worker, &probe);
}

/// Works until nothing can happen any more.
fn finish(worker: &mut TimelyWorker, probe: &Handle<Round>) {
    while !probe.done() {
        worker.step_or_park(None);
    }
}

/// Does the tasks of this process. Reports each of them, and sends what it found.
fn work<'s, J: Job>(
    scope: Scope<'s, Round>,
    assignments: StreamVec<'s, Round, Assignment>,
    job: Arc<J>,
    times: ThreadTimes,
) -> Done<'s, J> {
    let mut builder = OperatorBuilder::new("work".to_owned(), scope);
    let route = Exchange::new(|assignment: &Assignment| assignment.process as u64);
    let mut input = builder.new_input(assignments, route);
    let (reports_output, reports) = builder.new_output();
    let (records_output, records) = builder.new_output();
    let (mut reports_output, mut records_output) =
        (OutputBuilder::from(reports_output), OutputBuilder::from(records_output));
    let address = builder.operator_info().address.to_vec();
    let pool = Pool { job, wake: Arc::new(scope.worker().sync_activator_for(address)) };
    let process = scope.index();
    let (sender, finished) = mpsc::channel();
    builder.build(move |capabilities| {
        // The right to send reports and records. It is held while tasks run.
        let mut held: Option<Vec<Capability<Round>>> = Some(capabilities);
        let mut running = 0;
        let mut has_begun = false;
        move |_| {
            let (mut reports, mut records) = (reports_output.activate(), records_output.activate());
            if let Some(held) = held.as_ref().filter(|_| !std::mem::replace(&mut has_begun, true)) {
                let wanted = ASSIGNMENTS_AT_A_TIME * rayon::current_num_threads();
                reports.session(&held[0]).give(Report { process, done: Vec::new(), wanted });
            }
            input.for_each(|capability, assigned| {
                held = [0, 1].iter().map(|&output| capability.retain_least(output)).collect();
                for Assignment { tasks, .. } in assigned.drain(..) {
                    running += 1;
                    pool.spawn(tasks, sender.clone());
                }
            });
            if let Some(held) = &held {
                for Finished { done, records: found, thread, time } in finished.try_iter() {
                    running -= 1;
                    if let Some((tasks, seconds)) = times.borrow_mut().get_mut(thread) {
                        *tasks += done.len() as u64;
                        *seconds += time.as_secs_f64();
                    }
                    reports.session(&held[0]).give(Report { process, done, wanted: 1 });
                    records.session(&held[1]).give_iterator(found.into_iter());
                }
            }
            if running == 0 {
                held = None;
            }
        }
    });
    (reports, records)
}

struct Pool<J> {
    job: Arc<J>,
    wake: Arc<SyncActivator>,
}

impl<J: Job> Pool<J> {
    fn spawn(&self, tasks: Vec<usize>, finished: Sender<Finished<J>>) {
        let (job, wake) = (Arc::clone(&self.job), Arc::clone(&self.wake));
        rayon::spawn_fifo(move || {
            let begun = Instant::now();
            let mut all = Vec::new();
            let mut done_task = |task| {
                let (output, records) = job.work(task);
                all.extend(records);
                (task, output)
            };
            let done = tasks.into_iter().map(&mut done_task).collect();
            let time = begun.elapsed();
            let thread = rayon::current_thread_index().unwrap_or_default();
            // Without a worker, nobody needs it any more.
            let _ = finished.send(Finished { done, records: all, thread, time });
            let _ = wake.activate();
        });
    }
}

/// Process 0 gives tasks to those that want some.
fn dispatch<J: Job>(
    processes: usize,
    reports: StreamVec<'_, Round, Report<J::Output>>,
    tasks: Vec<usize>,
    events: Sender<JobEvent<J>>,
) -> StreamVec<'_, Round, Assignment> {
    let mut tasks = tasks.into_iter();
    // Of all processes, as if each had as many threads as this one.
    let assignments = ASSIGNMENTS_AT_A_TIME * rayon::current_num_threads() * processes;
    reports.unary(Exchange::new(|_: &Report<J::Output>| 0), "dispatch", |_, _| {
        move |input, output| {
            input.for_each(|capability, reports| {
                let mut session = output.session(&capability);
                for Report { process, done, wanted } in reports.drain(..) {
                    for (task, output) in done {
                        let _ = events.send(JobEvent::Done(task, output));
                    }
                    for _ in 0..wanted {
                        let count = 1 + tasks.len() / (ASSIGNMENTS_TO_COME * assignments);
                        let tasks: Vec<_> = tasks.by_ref().take(count).collect();
                        if !tasks.is_empty() {
                            session.give(Assignment { process, tasks });
                        }
                    }
                }
            });
        }
    })
}

/// When no task is left, each process groups the records of its keys.
fn group<J: Job>(
    process: usize,
    records: StreamVec<'_, Round, J::Record>,
    job: Arc<J>,
    times: ThreadTimes,
) -> StreamVec<'_, Round, ProcessEnd<J::Group>> {
    records.unary_frontier(Exchange::new(J::key), "group", |capability, _| {
        let mut held = Some(capability);
        let mut all = Vec::new();
        move |(input, frontier), output| {
            input.for_each(|_, found| all.append(found));
            if frontier.is_empty()
                && let Some(capability) = held.take()
            {
                let group = job.group(std::mem::take(&mut all));
                let threads = times.borrow().clone();
                output.session(&capability).give(ProcessEnd { process, threads, group });
            }
        }
    })
}

/// Process 0 gets what each process has.
fn end<J: Job>(
    ends: StreamVec<'_, Round, ProcessEnd<J::Group>>,
    events: Sender<JobEvent<J>>,
) -> Handle<Round> {
    let route = Exchange::new(|_: &ProcessEnd<J::Group>| 0);
    let collected: StreamVec<'_, Round, ()> = ends.unary(route, "end", |_, _| {
        move |input, _: &mut Nothing<'_>| {
            input.for_each(|_, ends| {
                for end in ends.drain(..) {
                    let _ = events.send(JobEvent::End(end));
                }
            });
        }
    });
    collected.probe().0
}
