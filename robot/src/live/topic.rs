//! Messages between the threads of a connection and the program: the last one of each topic.

use std::{
    sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError},
    time::{Duration, Instant},
};

use crate::robot::RobotError;

/// A topic to which a node subscribes, and what fills it. Messages that cannot be read are counted and skipped.
pub(crate) fn subscription<T>(topic: &str) -> (Inbox<T>, Subscription<T>) {
    let last = Last { message: None, unread: 0, closed: false };
    let shared = Arc::new(Shared { last: Mutex::new(last), news: Condvar::new() });
    (Inbox(shared.clone()), Subscription { shared, topic: topic.to_owned() })
}

/// Where messages come in. When it is dropped, no more can come.
pub(crate) struct Inbox<T>(Arc<Shared<T>>);

impl<T> Inbox<T> {
    /// Keeps a message; `None` is one that cannot be read.
    pub(crate) fn add(&self, message: Option<T>) {
        self.0.update(|last| match message {
            Some(message) => last.message = Some((message, Instant::now())),
            None => last.unread += 1,
        });
    }
}

impl<T> Drop for Inbox<T> {
    fn drop(&mut self) {
        self.0.update(|last| last.closed = true);
    }
}

/// A topic to which a node subscribes.
#[derive(Debug)]
pub(crate) struct Subscription<T> {
    shared: Arc<Shared<T>>,
    topic: String,
}

impl<T> Clone for Subscription<T> {
    fn clone(&self) -> Self {
        Self { shared: self.shared.clone(), topic: self.topic.clone() }
    }
}

#[derive(Debug)]
struct Shared<T> {
    last: Mutex<Last<T>>,
    news: Condvar,
}

#[derive(Debug)]
struct Last<T> {
    /// With the time at which it came.
    message: Option<(T, Instant)>,
    /// The number of messages that could not be read.
    unread: u64,
    closed: bool,
}

impl<T> Shared<T> {
    fn last(&self) -> MutexGuard<'_, Last<T>> {
        // The guarded data is valid at any time, even after a panic.
        self.last.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn update(&self, change: impl FnOnce(&mut Last<T>)) {
        change(&mut self.last());
        self.news.notify_all();
    }
}

/// Interval at which a waiting thread checks whether the run is to stop.
const STOP_INTERVAL: Duration = Duration::from_millis(20);

impl<T> Subscription<T> {
    /// Takes the last message, if it was not taken yet.
    pub(crate) fn take(&self) -> Option<T> {
        self.take_timed().map(|(message, _)| message)
    }

    /// The same, and when it came.
    pub(crate) fn take_timed(&self) -> Option<(T, Instant)> {
        self.shared.last().message.take()
    }

    /// What the last message shows, if it was not taken yet.
    pub(crate) fn peek<W>(&self, seen: impl FnOnce(&T) -> W) -> Option<W> {
        self.shared.last().message.as_ref().map(|(message, _)| seen(message))
    }

    pub(crate) fn topic(&self) -> &str {
        &self.topic
    }

    /// The error that no message came for this time.
    pub(crate) fn silent(&self, patience: Duration) -> RobotError {
        let (seconds, unread) = (patience.as_secs_f64(), self.shared.last().unread);
        RobotError::Silent { topic: self.topic.clone(), seconds, unread }
    }

    /// Waits for messages until `wanted` accepts one.
    ///
    /// # Errors
    /// Returns [`RobotError::Silent`] if none is accepted in time, [`RobotError::Stopped`] if the
    /// run is to stop, and [`RobotError::Closed`] if no more messages can come.
    pub(crate) fn wait<W>(
        &self,
        patience: Duration,
        stop: fn() -> bool,
        mut wanted: impl FnMut(T) -> Option<W>,
    ) -> Result<W, RobotError> {
        let until = Instant::now() + patience;
        let mut last = self.shared.last();
        loop {
            if stop() {
                return Err(RobotError::Stopped);
            }
            if let Some(found) = last.message.take().and_then(|(message, _)| wanted(message)) {
                return Ok(found);
            }
            if last.closed {
                return Err(RobotError::Closed { topic: self.topic.clone() });
            }
            let left = until.saturating_duration_since(Instant::now());
            if left.is_zero() {
                drop(last);
                return Err(self.silent(patience));
            }
            let waited = self.shared.news.wait_timeout(last, left.min(STOP_INTERVAL));
            last = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
    }
}
