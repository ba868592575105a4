//! A process that runs an explorer: a line goes to its standard input, and a line comes back.

use std::{
    collections::VecDeque,
    io::{BufRead, BufReader, Read, Write},
    path::Path,
    process::{Command, ExitStatus},
    str::FromStr,
    sync::{
        Arc, Mutex, PoisonError,
        mpsc::{self, Receiver, RecvTimeoutError, Sender},
    },
    thread,
    time::{Duration, Instant},
};

use super::{fault::ExplorerFault, protocol::shortened};
use crate::cli::{
    CliError,
    children::{ProgramStreams, RunningProgram},
    progress::must_stop,
};

/// The longest line that is read, in bytes: a map of some 40,000 edges. The parser takes less than 100 bytes
/// for each byte.
const LONGEST_LINE: u64 = 1 << 20;

/// The end of the standard error that is kept, in bytes.
const KEPT_ERRORS: usize = 2000;

/// How long a process may take to end: after the end of its input, and after the end of its output.
const TO_END: Duration = Duration::from_secs(1);

/// The longest time between two looks at whether to stop.
const LOOK: Duration = Duration::from_millis(50);

#[derive(Clone, Debug)]
pub(in crate::cli) struct ExplorerCommand {
    /// As on the command line.
    pub(in crate::cli) text: String,
    words: Vec<String>,
}

/// A text whose words are separated and quoted as in a shell.
impl FromStr for ExplorerCommand {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match shlex::split(text) {
            None => Err("a quote is not closed".to_owned()),
            Some(words) if words.is_empty() => Err("it names no program".to_owned()),
            Some(words) => Ok(Self { text: text.to_owned(), words }),
        }
    }
}

impl ExplorerCommand {
    /// The explorer's file: the first file that the command names by a relative path. An interpreter has an absolute path,
    /// or is found by its name.
    pub(in crate::cli) fn file(&self) -> Option<&Path> {
        self.words.iter().map(Path::new).find(|path| path.is_relative() && path.is_file())
    }

    pub(in crate::cli) fn start(&self) -> Result<ExplorerProcess, CliError> {
        let mut words = self.words.iter();
        let program = words.next().map_or("", String::as_str);
        let mut command = Command::new(program);
        command.args(words);
        let (running, streams) = RunningProgram::start(&mut command).map_err(|error| {
            CliError::at("--explorer", format!("{program} cannot be started: {error}"))
        })?;
        let ProgramStreams { stdin, stdout, stderr } = streams;
        let (requests, to_send) = mpsc::channel();
        let (answers, received) = mpsc::channel();
        let converse = move || converse(stdin, BufReader::new(stdout), &to_send, &answers);
        let errors = Arc::new(Mutex::new(VecDeque::new()));
        let (kept, (all_kept, ended)) = (Arc::clone(&errors), mpsc::channel());
        let keep = move || {
            keep_end(stderr, &kept);
            // Without a receiver, the process was dropped.
            let _ = all_kept.send(());
        };
        for work in [Box::new(converse) as Box<dyn FnOnce() + Send>, Box::new(keep)] {
            thread::Builder::new().spawn(work).map_err(|error| {
                CliError::at("--explorer", format!("a thread cannot be started: {error}"))
            })?;
        }
        Ok(ExplorerProcess { running, requests: Some(requests), received, errors, ended })
    }
}

pub(in crate::cli) struct ExplorerProcess {
    running: RunningProgram,
    /// `None` after the end of its input.
    requests: Option<Sender<String>>,
    /// The lines that come back; closed after the end of its output.
    received: Receiver<Result<Vec<u8>, ExplorerFault>>,
    errors: Arc<Mutex<VecDeque<u8>>>,
    /// Receives when its standard error is closed.
    ended: Receiver<()>,
}

impl ExplorerProcess {
    /// Sends a line and returns the next one, without its end. `None` if the check is to stop.
    pub(super) fn ask(
        &mut self,
        line: String,
        timeout: Duration,
    ) -> Option<Result<Vec<u8>, ExplorerFault>> {
        if let Some(requests) = &self.requests {
            // It fails if the process has ended, which is found below.
            let _ = requests.send(line);
        }
        let begun = Instant::now();
        // An explorer can answer faster than it is looked at.
        while !must_stop() {
            let left = timeout.saturating_sub(begun.elapsed());
            match self.received.recv_timeout(left.min(LOOK)) {
                Ok(answer) => return Some(answer),
                Err(RecvTimeoutError::Disconnected) => {
                    let status = self.running.wait(TO_END);
                    let failed = status.is_some_and(|status| !status.success());
                    let status = status.map(status_text);
                    return Some(Err(ExplorerFault::Ended { status, failed }));
                }
                Err(RecvTimeoutError::Timeout) if begun.elapsed() >= timeout => {
                    let seconds = timeout.as_secs_f64();
                    return Some(Err(ExplorerFault::TimedOut { seconds }));
                }
                Err(RecvTimeoutError::Timeout) => {}
            }
        }
        None
    }

    /// Ends the process and returns the end of its standard error.
    pub(in crate::cli) fn end(self) -> String {
        let Self { running, requests, received, errors, ended } = self;
        drop((running, requests, received));
        // Another program may keep it open.
        let _ = ended.recv_timeout(TO_END);
        let mut errors = errors.lock().unwrap_or_else(PoisonError::into_inner);
        let text = String::from_utf8_lossy(errors.make_contiguous()).into_owned();
        text.trim().to_owned()
    }

    /// Ends its input, and the process if it does not end soon.
    pub(in crate::cli) fn finish(mut self) {
        self.requests = None;
        self.running.wait(TO_END);
    }
}

/// Sends each line and then receives one, until the end of the output.
fn converse(
    mut stdin: impl Write,
    mut stdout: BufReader<impl Read>,
    requests: &Receiver<String>,
    answers: &Sender<Result<Vec<u8>, ExplorerFault>>,
) {
    for request in requests {
        // A process that has ended does not read, and has no more output either.
        let _ = stdin.write_all(request.as_bytes()).and_then(|()| stdin.flush());
        let mut line = Vec::new();
        let read = stdout.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut line);
        let answer = match (read, line.last()) {
            (Ok(_), Some(b'\n')) if !stdout.buffer().is_empty() => {
                let rest = String::from_utf8_lossy(stdout.buffer());
                let line = rest.lines().next().unwrap_or_default();
                Err(ExplorerFault::ExtraLine { line: shortened(line.trim()) })
            }
            (Ok(_), Some(b'\n')) => {
                line.pop();
                Ok(line)
            }
            (Ok(_), Some(_)) if line.len() as u64 == LONGEST_LINE => {
                Err(ExplorerFault::LineTooLong { limit: LONGEST_LINE })
            }
            // A last line may have no end.
            (Ok(_), Some(_)) => Ok(line),
            (Ok(_), None) | (Err(_), _) => break,
        };
        if answers.send(answer).is_err() {
            break;
        }
    }
}

fn keep_end(mut stream: impl Read, kept: &Mutex<VecDeque<u8>>) {
    let mut buffer = [0; 1024];
    while let Ok(count @ 1..) = stream.read(&mut buffer) {
        let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.extend(&buffer[..count]);
        let more = kept.len().saturating_sub(KEPT_ERRORS);
        kept.drain(..more);
    }
}

fn status_text(status: ExitStatus) -> String {
    #[cfg(unix)]
    if let Some(signal) = std::os::unix::process::ExitStatusExt::signal(&status) {
        let name = nix::sys::signal::Signal::try_from(signal);
        return name.map_or(format!("signal {signal}"), |name| format!("signal {name}"));
    }
    status.code().map_or_else(|| status.to_string(), |code| format!("exit code {code}"))
}
