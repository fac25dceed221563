//! Who does what goes on beside the window.

use std::fmt::Debug;
use std::future::ready;
use std::pin::Pin;
use std::thread;

/// What is to be awaited.
pub type Awaited = Pin<Box<dyn Future<Output = ()>>>;

/// A task, before it is begun where it will run.
pub type Task = Box<dyn FnOnce() -> Awaited + Send>;

/// Those who read, build and draw. Tasks wait for orders, and say between steps of some hundredths of a second
/// that others may have their turn.
pub trait Crew: Debug + Send + Sync {
    /// Begins a task that goes on beside all else, to its end.
    fn begin(&self, task: Task);

    /// Awaited by a task when the others may have their turn.
    fn turn(&self) -> Awaited;
}

/// A thread for each task, so that no turns need to be taken.
#[derive(Debug, Clone, Copy, Default)]
pub struct Threads;

impl Crew for Threads {
    fn begin(&self, task: Task) {
        thread::spawn(move || pollster::block_on(task()));
    }

    fn turn(&self) -> Awaited {
        Box::pin(ready(()))
    }
}
