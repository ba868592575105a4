//! Work that is divided into tasks.

use serde::{Serialize, de::DeserializeOwned};

/// What processes send to each other.
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

    /// Does a task.
    fn work(&self, task: usize) -> (Self::Output, Vec<Self::Record>);

    /// The key of a record. Equal keys meet in one process.
    fn key(record: &Self::Record) -> u64;

    /// Groups all records of the keys of this process.
    fn group(&self, records: Vec<Self::Record>) -> Self::Group;
}
