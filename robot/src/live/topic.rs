//! Messages between the threads of a connection and the program: the last one of each topic.

use std::{
    sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError},
    time::{Duration, Instant},
};

use crate::robot::RobotError;

/// A topic to which a node subscribes, and what fills it. Messages that cannot be read are counted and skipped.
pub(crate) fn subscription<T>(topic: &str) -> (Inbox<T>, Subscription<T>) {
    let last = Last { message: None, unread: 0, has_two_sources: false, closed: false };
    let shared = Arc::new(Shared { last: Mutex::new(last), arrived: Condvar::new() });
    (Inbox(shared.clone()), Subscription { shared, topic: topic.to_owned() })
}

/// Where messages come in. When it is dropped, no more can come.
pub(crate) struct Inbox<T>(Arc<Shared<T>>);

impl<T> Inbox<T> {
    /// Keeps a message; `None` is one that cannot be read.
    pub(crate) fn add(&self, message: Option<T>) {
        self.0.update(|last| match message {
            Some(message) => {
                (last.message, last.unread) = (Some((message, Instant::now())), 0);
            }
            None => last.unread += 1,
        });
    }

    /// Records that two nodes send the messages of this topic.
    #[cfg(feature = "ros2")]
    pub(crate) fn record_two_sources(&self) {
        self.0.update(|last| last.has_two_sources = true);
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
    arrived: Condvar,
}

#[derive(Debug)]
struct Last<T> {
    /// With the time at which it came.
    message: Option<(T, Instant)>,
    /// The number of messages since the last one that could be read.
    unread: u64,
    has_two_sources: bool,
    closed: bool,
}

impl<T> Shared<T> {
    fn last(&self) -> MutexGuard<'_, Last<T>> {
        // The guarded data is valid at any time, even after a panic.
        self.last.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn update(&self, change: impl FnOnce(&mut Last<T>)) {
        change(&mut self.last());
        self.arrived.notify_all();
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

    /// # Errors
    /// Returns an error if two nodes send the messages of this topic.
    pub(crate) fn check_source(&self) -> Result<(), RobotError> {
        if self.shared.last().has_two_sources {
            return Err(RobotError::TwoSources { topic: self.topic.clone() });
        }
        Ok(())
    }

    /// # Errors
    /// Returns an error if the last message could not be read.
    pub(crate) fn check_readable(&self) -> Result<(), RobotError> {
        match self.shared.last().unread {
            0 => Ok(()),
            unread => Err(RobotError::Unreadable { topic: self.topic.clone(), unread }),
        }
    }

    /// The error that no message came for this time.
    pub(crate) fn silent(&self, patience: Duration) -> RobotError {
        let (seconds, unread) = (patience.as_secs_f64(), self.shared.last().unread);
        RobotError::Silent { topic: self.topic.clone(), seconds, unread }
    }

    /// Waits for messages until `wanted` accepts one.
    ///
    /// # Errors
    /// Returns [`RobotError::Silent`] if none is accepted in time, [`RobotError::Stopped`] if the run is to stop,
    /// [`RobotError::TwoSources`] if two nodes send messages, and [`RobotError::Closed`] if no more can come.
    pub(crate) fn wait<W>(
        &self,
        patience: Duration,
        stop: fn() -> bool,
        mut wanted: impl FnMut(T) -> Option<W>,
    ) -> Result<W, RobotError> {
        self.wait_timed(patience, stop, |message, _| wanted(message))
    }

    /// The same with the time at which each message came.
    pub(crate) fn wait_timed<W>(
        &self,
        patience: Duration,
        stop: fn() -> bool,
        mut wanted: impl FnMut(T, Instant) -> Option<W>,
    ) -> Result<W, RobotError> {
        let until = Instant::now() + patience;
        loop {
            if stop() {
                return Err(RobotError::Stopped);
            }
            self.check_source()?;
            // Messages can come in while this one is looked at.
            let message = self.take_timed();
            if let Some(found) = message.and_then(|(message, arrived)| wanted(message, arrived)) {
                return Ok(found);
            }
            let left = until.saturating_duration_since(Instant::now());
            let last = self.shared.last();
            if last.closed && last.message.is_none() {
                return Err(RobotError::Closed { topic: self.topic.clone() });
            }
            if left.is_zero() {
                drop(last);
                return Err(self.silent(patience));
            }
            if last.message.is_none() {
                let waited = self.shared.arrived.wait_timeout(last, left.min(STOP_INTERVAL));
                drop(waited.unwrap_or_else(PoisonError::into_inner));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::{sync::mpsc, thread};

    use super::*;

    /// A message is looked at for a while, as when pixels become a file. The thread that receives messages does not wait.
    #[test]
    fn messages_come_in_while_one_is_looked_at() {
        let (inbox, subscription) = subscription("/numbers");
        let (done, is_done) = mpsc::channel();
        inbox.add(Some(1));
        thread::spawn(move || {
            let found = subscription.wait(
                Duration::from_secs(5),
                || false,
                |number| {
                    inbox.add(Some(number + 1));
                    (number == 3).then_some(number)
                },
            );
            // The test has ended if nobody receives this.
            let _ = done.send(found);
        });
        assert_eq!(is_done.recv_timeout(Duration::from_secs(20)), Ok(Ok(3)));
    }

    #[test]
    fn a_message_that_can_be_read_ends_those_that_cannot() {
        let (inbox, subscription) = subscription("/numbers");
        assert_eq!(subscription.check_readable(), Ok(()));
        inbox.add(None);
        inbox.add(None);
        let unreadable = RobotError::Unreadable { topic: "/numbers".to_owned(), unread: 2 };
        assert_eq!(subscription.check_readable(), Err(unreadable));
        inbox.add(Some(1));
        assert_eq!(subscription.check_readable(), Ok(()));
    }

    #[test]
    fn the_last_message_counts_although_no_more_can_come() {
        let (inbox, subscription) = subscription("/numbers");
        inbox.add(Some(1));
        drop(inbox);
        let wait = || subscription.wait(Duration::from_secs(5), || false, Some);
        assert_eq!(wait(), Ok(1));
        assert_eq!(wait(), Err(RobotError::Closed { topic: "/numbers".to_owned() }));
    }
}
