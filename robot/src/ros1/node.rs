//! A ROS 1 node for blocking programs: topics to which it publishes, and the last message of each
//! topic to which it subscribes.

#![allow(clippy::missing_errors_doc, reason = "stated once, at the node")]

use std::{thread::sleep, time::Duration};

use roslibrust::ros1::{NodeHandle, PublisherAny};
use tokio::{
    runtime::{Builder, Runtime},
    time::timeout,
};
use toposlam_logs::message::Message;

use super::definition::{definition, type_name};
use crate::{
    live::topic::{self, Subscription},
    robot::RobotError,
};

/// The longest time until the master answers.
const ANSWER: Duration = Duration::from_secs(10);
/// The time for the last messages to leave before the node is gone.
const LEAVE: Duration = Duration::from_millis(200);
/// The most messages of a topic that are queued. Older ones are dropped.
const UNDER_WAY: usize = 16;
/// A message begins with its length, in bytes.
const LENGTH: usize = 4;

/// A node. When it is dropped, it unregisters from the master. Its publishers must be dropped
/// before it. An error means that the master or the connection fails.
pub(super) struct Node {
    handle: Option<NodeHandle>,
    /// `None` once it is dropped.
    runtime: Option<Runtime>,
    runner: tokio::runtime::Handle,
    master: String,
}

impl Node {
    /// A node of this master. The process number is added to the name.
    pub(super) fn new(master: &str, name: &str) -> Result<Self, RobotError> {
        let unreachable =
            |cause: String| RobotError::Unreachable { master: master.to_owned(), cause };
        let runtime = Builder::new_multi_thread().worker_threads(2).enable_all().build();
        let runtime = runtime.map_err(|error| unreachable(error.to_string()))?;
        let name = format!("{name}_{}", std::process::id());
        let joined = answered(runtime.handle(), NodeHandle::new(master, &name));
        let handle = joined.map_err(unreachable)?;
        let runner = runtime.handle().clone();
        let master = master.to_owned();
        Ok(Self { handle: Some(handle), runtime: Some(runtime), runner, master })
    }

    pub(super) fn advertise<M: Message>(&self, topic: &str) -> Result<Publisher, RobotError> {
        let handle = self.handle(topic)?;
        let (name, text) = (type_name::<M>(), definition::<M>());
        let advertised = handle.advertise_any(topic, &name, &text, UNDER_WAY, false);
        let sender = answered(&self.runner, advertised).map_err(|cause| self.unreachable(cause))?;
        Ok(Publisher { sender, runner: self.runner.clone(), topic: topic.to_owned() })
    }

    /// Subscribes to a topic. Messages that cannot be read are counted and skipped.
    pub(super) fn subscribe<T: Send + 'static>(
        &self,
        topic: &str,
        read: fn(&[u8]) -> Option<T>,
    ) -> Result<Subscription<T>, RobotError> {
        let handle = self.handle(topic)?;
        let subscribed = answered(&self.runner, handle.subscribe_any(topic, UNDER_WAY));
        let mut subscriber = subscribed.map_err(|cause| self.unreachable(cause))?;
        let (inbox, subscription) = topic::subscription(topic);
        self.runner.spawn(async move {
            while let Some(message) = subscriber.next().await {
                // Dropped messages are no error: newer ones follow.
                let Ok(bytes) = message else { continue };
                inbox.add(bytes.get(LENGTH..).and_then(read));
            }
        });
        Ok(subscription)
    }

    fn handle(&self, topic: &str) -> Result<&NodeHandle, RobotError> {
        let closed = || RobotError::Closed { topic: topic.to_owned() };
        self.handle.as_ref().filter(|handle| handle.is_ok()).ok_or_else(closed)
    }

    fn unreachable(&self, cause: String) -> RobotError {
        RobotError::Unreachable { master: self.master.clone(), cause }
    }
}

/// Waits for an answer of the master, or returns why there is none.
fn answered<T, E: ToString>(
    runner: &tokio::runtime::Handle,
    asked: impl Future<Output = Result<T, E>>,
) -> Result<T, String> {
    // The timer needs the runtime when it is made.
    match runner.block_on(async { timeout(ANSWER, asked).await }) {
        Ok(answer) => answer.map_err(|error| error.to_string()),
        Err(_) => Err("it does not answer".to_owned()),
    }
}

impl Drop for Node {
    fn drop(&mut self) {
        sleep(LEAVE);
        {
            let _inside = self.runner.enter();
            self.handle = None;
        }
        if let Some(runtime) = self.runtime.take() {
            sleep(LEAVE);
            runtime.shutdown_timeout(LEAVE);
        }
    }
}

/// A topic to which a node publishes.
pub(super) struct Publisher {
    sender: PublisherAny,
    runner: tokio::runtime::Handle,
    topic: String,
}

impl Publisher {
    /// Publishes the body of a message.
    pub(super) fn publish(&self, body: &[u8]) -> Result<(), RobotError> {
        let length = (body.len() as u32).to_le_bytes();
        let message = [&length[..], body].concat();
        let published = self.runner.block_on(self.sender.publish(message));
        published.map_err(|_| RobotError::Closed { topic: self.topic.clone() })
    }
}
