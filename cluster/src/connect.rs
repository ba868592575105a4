//! Connects the processes of a cluster, and checks that they do the same work.
//!
//! A process listens at its own address, and connects to those with lower numbers. Each of the two sends its number
//! and its settings first.

use std::{
    io::{self, Read, Write},
    net::{TcpListener, TcpStream, ToSocketAddrs},
    thread,
    time::{Duration, Instant},
};

use serde::{Deserialize, Serialize};
use socket2::{SockRef, TcpKeepalive};
use thiserror::Error;
use toposlam_model::enumerate::Watch;

use crate::Hosts;

const MAGIC: [u8; 8] = *b"toposlam";
const LONGEST: u32 = 1 << 20;

/// The time in which all processes must be there.
const PATIENCE: Duration = Duration::from_secs(600);
/// The time after which missing processes are named.
const SOON: Duration = Duration::from_secs(3);
const ANSWER: Duration = Duration::from_secs(5);
const BETWEEN_TRIES: Duration = Duration::from_millis(50);

/// A connection whose machine is silent for half a minute is lost.
const KEEPALIVE: (Duration, Duration, u32) = (Duration::from_secs(15), Duration::from_secs(5), 3);

/// A setting that all processes have in common: its name and its value.
pub type Setting = (String, String);

/// Why the processes are not connected.
#[derive(Debug, Error)]
pub enum ConnectError {
    /// The address of this process cannot be used.
    #[error("{name}: cannot listen at this address: {cause}")]
    Listen { name: String, cause: io::Error },
    #[error("{name} does other work: {setting} is {theirs} there, and {ours} here")]
    OtherWork { name: String, setting: String, theirs: String, ours: String },
    #[error("not connected within {} minutes: {}", PATIENCE.as_secs() / 60, names.join(", "))]
    Missing { names: Vec<String> },
    #[error("interrupted")]
    Interrupted,
}

#[derive(Serialize, Deserialize)]
struct Greeting {
    process: usize,
    settings: Vec<Setting>,
}

pub(crate) struct Connector<'w> {
    pub(crate) hosts: &'w Hosts,
    pub(crate) process: usize,
    pub(crate) settings: &'w [Setting],
    pub(crate) watch: &'w dyn Watch,
    /// Is called once with the processes that are not there soon.
    pub(crate) waiting: &'w dyn Fn(&[String]),
}

impl Connector<'_> {
    /// The connection to each other process; none at the place of this one.
    pub(crate) fn connect(&self) -> Result<Vec<Option<TcpStream>>, ConnectError> {
        let here = self.hosts.name(self.process);
        let listen = || {
            let listener = TcpListener::bind(self.hosts.address(self.process))?;
            listener.set_nonblocking(true)?;
            Ok(listener)
        };
        let listener = listen().map_err(|cause| ConnectError::Listen { name: here, cause })?;
        let mut streams: Vec<Option<TcpStream>> = (0..self.hosts.count()).map(|_| None).collect();
        let begun = Instant::now();
        let mut said = false;
        loop {
            while let Ok((stream, _)) = listener.accept() {
                if let Some((process, stream)) = self.greeted(stream)?
                    && process > self.process
                {
                    streams[process].get_or_insert(stream);
                }
            }
            for (lower, place) in streams.iter_mut().enumerate().take(self.process) {
                if place.is_none() {
                    let stream = dial(self.hosts.address(lower)).ok();
                    let greeted = stream.map(|stream| self.greeted(stream)).transpose()?.flatten();
                    let found = greeted.filter(|(found, _)| *found == lower);
                    *place = found.map(|(_, stream)| stream);
                }
            }
            let others = (0..streams.len()).filter(|&process| process != self.process);
            let missing: Vec<_> = others.filter(|&process| streams[process].is_none()).collect();
            let names = || missing.iter().map(|&process| self.hosts.name(process)).collect();
            if missing.is_empty() {
                return Ok(streams);
            }
            if self.watch.stop() {
                return Err(ConnectError::Interrupted);
            }
            if begun.elapsed() > PATIENCE {
                return Err(ConnectError::Missing { names: names() });
            }
            if begun.elapsed() > SOON && !std::mem::replace(&mut said, true) {
                let names: Vec<String> = names();
                (self.waiting)(&names);
            }
            thread::sleep(BETWEEN_TRIES);
        }
    }

    /// Exchanges greetings. Returns the other process; `None` if that is no process of a cluster.
    fn greeted(&self, stream: TcpStream) -> Result<Option<(usize, TcpStream)>, ConnectError> {
        let ours = Greeting { process: self.process, settings: self.settings.to_vec() };
        let Ok((stream, Greeting { process, settings })) = exchange(stream, &ours) else {
            return Ok(None);
        };
        if process == self.process || process >= self.hosts.count() {
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
        Ok(Some((process, stream)))
    }
}

fn dial(address: &str) -> io::Result<TcpStream> {
    let mut last = io::Error::from(io::ErrorKind::AddrNotAvailable);
    for address in address.to_socket_addrs()? {
        match TcpStream::connect_timeout(&address, ANSWER) {
            Ok(stream) => return Ok(stream),
            Err(error) => last = error,
        }
    }
    Err(last)
}

/// Sends a greeting and reads the other one.
fn exchange(mut stream: TcpStream, ours: &Greeting) -> io::Result<(TcpStream, Greeting)> {
    stream.set_nonblocking(false)?;
    stream.set_nodelay(true)?;
    stream.set_read_timeout(Some(ANSWER))?;
    let (idle, between, tries) = KEEPALIVE;
    let keepalive = TcpKeepalive::new().with_time(idle).with_interval(between).with_retries(tries);
    SockRef::from(&stream).set_tcp_keepalive(&keepalive)?;
    // The same for a machine that is silent while something is sent to it.
    #[cfg(target_os = "linux")]
    SockRef::from(&stream).set_tcp_user_timeout(Some(idle + tries * between))?;
    let text = serde_json::to_vec(ours)?;
    let mut message = MAGIC.to_vec();
    message.extend((text.len() as u32).to_be_bytes());
    message.extend(text);
    stream.write_all(&message)?;
    let (mut magic, mut length) = ([0; 8], [0; 4]);
    stream.read_exact(&mut magic)?;
    stream.read_exact(&mut length)?;
    let length = u32::from_be_bytes(length);
    if magic != MAGIC || length > LONGEST {
        return Err(io::ErrorKind::InvalidData.into());
    }
    let mut text = vec![0; length as usize];
    stream.read_exact(&mut text)?;
    let theirs = serde_json::from_slice(&text)?;
    stream.set_read_timeout(None)?;
    Ok((stream, theirs))
}
