//! Connects the processes of a cluster, and checks that they do the same work.
//!
//! A process listens at its own address, and calls those with lower numbers. A stream counts when both have
//! [confirmed it](crate::handshake). No stranger, and no process that is slow, delays the others.

use std::{
    io,
    net::{TcpListener, TcpStream, ToSocketAddrs},
    sync::mpsc::{self, Receiver, RecvTimeoutError, Sender},
    thread,
    time::{Duration, Instant},
};

use thiserror::Error;
use toposlam_model::enumerate::Watch;

use crate::{
    Hosts,
    handshake::{Greeting, Handshake, HandshakeError},
};

/// The time in which all processes must be there.
pub(crate) const PATIENCE: Duration = Duration::from_secs(600);
/// The time after which missing processes are named.
const SOON: Duration = Duration::from_secs(3);
/// The time in which an address answers a call.
const ANSWER: Duration = Duration::from_secs(5);
const BETWEEN_TRIES: Duration = Duration::from_millis(50);
const BETWEEN_LOOKS: Duration = Duration::from_millis(10);
/// The number of handshakes at a time. More strangers wait, for at most the time of a handshake.
const MOST_HANDSHAKES: usize = 256;

/// A setting that all processes have in common: its name and its value.
pub type Setting = (String, String);

/// Why the processes are not connected.
#[derive(Debug, Error)]
pub enum ConnectError {
    /// The address of this process cannot be used.
    #[error("{name}: cannot listen at this address: {cause}")]
    Listen { name: String, cause: io::Error },
    /// This machine has no thread for a call.
    #[error("{name}: cannot call this address: {cause}")]
    Call { name: String, cause: io::Error },
    #[error("{name} does other work: {setting} is {theirs} there, and {ours} here")]
    OtherWork { name: String, setting: String, theirs: String, ours: String },
    #[error("not connected within {} minutes: {}", PATIENCE.as_secs() / 60, names.join(", "))]
    Missing { names: Vec<String> },
    #[error("interrupted")]
    Interrupted,
}

pub(crate) struct Connector<'w> {
    pub(crate) hosts: &'w Hosts,
    pub(crate) process: usize,
    pub(crate) settings: &'w [Setting],
    pub(crate) watch: &'w dyn Watch,
    /// Is called with the processes that are missing for some time, and again if others are.
    pub(crate) waiting: &'w dyn Fn(&[String]),
    /// The time in which all processes must be there.
    pub(crate) patience: Duration,
}

/// The calls of a process with a lower number. They end with this value.
struct Calls {
    requests: Sender<()>,
    streams: Receiver<TcpStream>,
    is_calling: bool,
}

impl Connector<'_> {
    /// The connection to each other process; none at the place of this one.
    pub(crate) fn connect(&self) -> Result<Vec<Option<TcpStream>>, ConnectError> {
        let listen = || {
            let listener = TcpListener::bind(self.hosts.address(self.process))?;
            listener.set_nonblocking(true)?;
            Ok(listener)
        };
        let name = |process| self.hosts.name(process);
        let listener =
            listen().map_err(|cause| ConnectError::Listen { name: name(self.process), cause })?;
        let calls = (0..self.process).map(|lower| {
            Calls::start(self.hosts.address(lower))
                .map_err(|cause| ConnectError::Call { name: name(lower), cause })
        });
        let mut calls = calls.collect::<Result<Vec<_>, _>>()?;
        let mut handshakes: Vec<Handshake> = Vec::new();
        let mut streams: Vec<Option<TcpStream>> = (0..self.hosts.count()).map(|_| None).collect();
        let mut named = vec![false; streams.len()];
        let begun = Instant::now();
        let ours = Greeting { process: self.process, settings: self.settings.to_vec() };
        loop {
            while handshakes.len() < MOST_HANDSHAKES
                && let Ok((stream, _)) = listener.accept()
            {
                handshakes.extend(Handshake::start(stream, None, &ours).ok());
            }
            for (lower, calls) in calls.iter_mut().enumerate() {
                let stream = calls.answered();
                let start = |stream| Handshake::start(stream, Some(lower), &ours).ok();
                handshakes.extend(stream.and_then(start));
            }
            for mut handshake in std::mem::take(&mut handshakes) {
                let called = handshake.called();
                match handshake.advance(|greeting| self.greeted(greeting, called)) {
                    Ok(None) => handshakes.push(handshake),
                    // The other process gave up the stream that it had before.
                    Ok(Some(process)) => streams[process] = Some(handshake.into_stream()),
                    Err(HandshakeError::Refused(error)) => return Err(error),
                    Err(HandshakeError::Stream) => {}
                }
            }
            for (lower, calls) in calls.iter_mut().enumerate() {
                let is_called =
                    handshakes.iter().any(|handshake| handshake.called() == Some(lower));
                if streams[lower].is_none() && !is_called {
                    calls.request();
                }
            }
            let missing = |process: &usize| *process != self.process && streams[*process].is_none();
            let missing: Vec<usize> = (0..streams.len()).filter(missing).collect();
            // A stream that broke since is a process that is lost, not one that is missing: it is not called again.
            if missing.is_empty() {
                return Ok(streams);
            }
            for stream in &mut streams {
                stream.take_if(|stream| is_broken(stream));
            }
            if self.watch.stop() {
                return Err(ConnectError::Interrupted);
            }
            let names = || missing.iter().copied().map(name).collect();
            if begun.elapsed() > self.patience {
                return Err(ConnectError::Missing { names: names() });
            }
            if begun.elapsed() > SOON && missing.iter().any(|&process| !named[process]) {
                let names: Vec<String> = names();
                (self.waiting)(&names);
                for &process in &missing {
                    named[process] = true;
                }
            }
            thread::sleep(BETWEEN_LOOKS);
        }
    }

    /// The process that sent this greeting; `None` if another one is expected.
    fn greeted(
        &self,
        greeting: Greeting,
        called: Option<usize>,
    ) -> Result<Option<usize>, ConnectError> {
        let Greeting { process, settings } = greeting;
        let is_expected = match called {
            Some(lower) => process == lower,
            None => process > self.process && process < self.hosts.count(),
        };
        if !is_expected {
            return Ok(None);
        }
        let value = |settings: &[Setting], name: &str| {
            let found = settings.iter().find(|(known, _)| known == name);
            found.map_or_else(|| "nothing".to_owned(), |(_, value)| value.clone())
        };
        for (name, _) in self.settings.iter().chain(&settings) {
            let (theirs, ours) = (value(&settings, name), value(self.settings, name));
            if theirs != ours {
                let (setting, name) = (name.clone(), self.hosts.name(process));
                return Err(ConnectError::OtherWork { name, setting, theirs, ours });
            }
        }
        Ok(Some(process))
    }
}

impl Calls {
    fn start(address: &str) -> io::Result<Self> {
        let (requests, requested) = mpsc::channel();
        let (called, streams) = mpsc::channel();
        let address = address.to_owned();
        thread::Builder::new().spawn(move || answer_requests(&address, &requested, &called))?;
        Ok(Self { requests, streams, is_calling: false })
    }

    /// Calls until there is an answer.
    fn request(&mut self) {
        if !std::mem::replace(&mut self.is_calling, true) {
            let _ = self.requests.send(());
        }
    }

    fn answered(&mut self) -> Option<TcpStream> {
        let stream = self.streams.try_recv().ok()?;
        self.is_calling = false;
        Some(stream)
    }
}

/// Calls an address once for each request, until nobody can send one.
fn answer_requests(address: &str, requests: &Receiver<()>, streams: &Sender<TcpStream>) {
    while requests.recv().is_ok() {
        let stream = loop {
            if let Ok(stream) = call(address) {
                break stream;
            }
            if requests.recv_timeout(BETWEEN_TRIES) == Err(RecvTimeoutError::Disconnected) {
                return;
            }
        };
        if streams.send(stream).is_err() {
            return;
        }
        thread::sleep(BETWEEN_TRIES);
    }
}

fn call(address: &str) -> io::Result<TcpStream> {
    let mut last = io::Error::from(io::ErrorKind::AddrNotAvailable);
    for address in address.to_socket_addrs()? {
        match TcpStream::connect_timeout(&address, ANSWER) {
            Ok(stream) => return Ok(stream),
            Err(error) => last = error,
        }
    }
    Err(last)
}

/// Whether the other process closed the stream. What it sends is left for the work.
fn is_broken(stream: &TcpStream) -> bool {
    match stream.peek(&mut [0]) {
        Ok(length) => length == 0,
        Err(error) => {
            !matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::Interrupted)
        }
    }
}

#[cfg(test)]
mod tests;
