//! The handshake of two processes on a new stream.
//!
//! ```text
//! process that called          process that listens
//!      greeting  -------------->
//!               <--------------  greeting
//!      confirmed -------------->                      the stream counts here
//!               <--------------  confirmed            the stream counts there
//! ```
//!
//! Both send their greetings at once. One that listens gives up a stream that is not confirmed in time. One that called
//! and confirmed waits until the stream breaks: it cannot know whether the stream counts for the other process.

use std::{
    io::{self, ErrorKind, Read, Write},
    net::TcpStream,
    time::{Duration, Instant},
};

use serde::{Deserialize, Serialize};
use socket2::{SockRef, TcpKeepalive};

use crate::{ConnectError, Setting};

const MAGIC: [u8; 8] = *b"toposlam";
const HEAD: usize = MAGIC.len() + 4;
const LONGEST: usize = 1 << 20;
const CONFIRMED: u8 = b'+';

/// The time of a whole handshake.
const PATIENCE: Duration = Duration::from_secs(5);

/// A connection whose machine is silent for half a minute is lost.
const KEEPALIVE: (Duration, Duration, u32) = (Duration::from_secs(15), Duration::from_secs(5), 3);

/// The first message on a stream.
#[derive(Serialize, Deserialize)]
pub(crate) struct Greeting {
    pub(crate) process: usize,
    pub(crate) settings: Vec<Setting>,
}

pub(crate) enum HandshakeError {
    /// The other end is not the process that is expected, is too slow, or is gone.
    Stream,
    /// The other process and this one cannot work together.
    Refused(ConnectError),
}

impl From<io::Error> for HandshakeError {
    fn from(_: io::Error) -> Self {
        Self::Stream
    }
}

/// The handshake on a stream that does not block.
pub(crate) struct Handshake {
    stream: TcpStream,
    /// The process that was called; `None` if the other one called.
    called: Option<usize>,
    begun: Instant,
    unsent: Vec<u8>,
    received: Vec<u8>,
    /// The process that sent the greeting.
    greeted: Option<usize>,
}

impl Handshake {
    /// `called` is the process that was called on this stream, if it was this end that called.
    pub(crate) fn start(
        stream: TcpStream,
        called: Option<usize>,
        ours: &Greeting,
    ) -> io::Result<Self> {
        stream.set_nonblocking(true)?;
        stream.set_nodelay(true)?;
        let (idle, between, tries) = KEEPALIVE;
        let keepalive =
            TcpKeepalive::new().with_time(idle).with_interval(between).with_retries(tries);
        SockRef::from(&stream).set_tcp_keepalive(&keepalive)?;
        // The same for a machine that is silent while something is sent to it.
        #[cfg(target_os = "linux")]
        SockRef::from(&stream).set_tcp_user_timeout(Some(idle + tries * between))?;
        let unsent = ours.message()?;
        let (begun, received) = (Instant::now(), Vec::new());
        Ok(Self { stream, called, begun, unsent, received, greeted: None })
    }

    pub(crate) fn called(&self) -> Option<usize> {
        self.called
    }

    /// The stream, which does not block.
    pub(crate) fn into_stream(self) -> TcpStream {
        self.stream
    }

    /// Sends and receives what is possible now. Returns the other process when the stream counts at this end.
    /// `check` returns the process that sent a greeting; `None` if it is not the one that is expected.
    pub(crate) fn advance(
        &mut self,
        check: impl FnOnce(Greeting) -> Result<Option<usize>, ConnectError>,
    ) -> Result<Option<usize>, HandshakeError> {
        self.send()?;
        if self.greeted.is_none()
            && let Some(greeting) = self.greeting()?
        {
            let process = check(greeting).map_err(HandshakeError::Refused)?;
            self.greeted = Some(process.ok_or(HandshakeError::Stream)?);
            self.received.clear();
            if self.called.is_some() {
                self.unsent.push(CONFIRMED);
                self.send()?;
            }
        }
        if self.greeted.is_some() && self.receive(1)? {
            if self.called.is_none() {
                self.unsent.push(CONFIRMED);
                self.send()?;
            }
            let is_confirmed = self.received == [CONFIRMED] && self.unsent.is_empty();
            return if is_confirmed { Ok(self.greeted) } else { Err(HandshakeError::Stream) };
        }
        let has_confirmed = self.called.is_some() && self.greeted.is_some();
        if !has_confirmed && self.begun.elapsed() > PATIENCE {
            return Err(HandshakeError::Stream);
        }
        Ok(None)
    }

    fn send(&mut self) -> io::Result<()> {
        while !self.unsent.is_empty() {
            match self.stream.write(&self.unsent) {
                Ok(sent) => drop(self.unsent.drain(..sent)),
                Err(error) if error.kind() == ErrorKind::WouldBlock => break,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    /// Receives up to this number of bytes in all, and nothing that follows. Returns whether all are there.
    fn receive(&mut self, length: usize) -> io::Result<bool> {
        let left = length.saturating_sub(self.received.len());
        match (&self.stream).take(left as u64).read_to_end(&mut self.received) {
            Ok(_) if self.received.len() < length => Err(ErrorKind::UnexpectedEof.into()),
            Err(error) if error.kind() != ErrorKind::WouldBlock => Err(error),
            _ => Ok(self.received.len() >= length),
        }
    }

    /// The other greeting, when it is complete.
    fn greeting(&mut self) -> io::Result<Option<Greeting>> {
        if !self.receive(HEAD)? {
            return Ok(None);
        }
        let (magic, length) = self.received[..HEAD].split_at(MAGIC.len());
        let length = length.iter().fold(0, |length, &byte| (length << 8) | usize::from(byte));
        if magic != MAGIC || length > LONGEST {
            return Err(ErrorKind::InvalidData.into());
        }
        if !self.receive(HEAD + length)? {
            return Ok(None);
        }
        Ok(Some(serde_json::from_slice(&self.received[HEAD..])?))
    }
}

impl Greeting {
    /// The greeting with its head: what is sent.
    pub(crate) fn message(&self) -> io::Result<Vec<u8>> {
        let text = serde_json::to_vec(self)?;
        Ok([&MAGIC, &(text.len() as u32).to_be_bytes()[..], &text].concat())
    }
}
