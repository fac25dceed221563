//! What tasks report, and how the window hears of it.

use std::fmt;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

/// Called when there is something to be shown.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

/// A task's end of a channel.
pub(crate) struct Post<T> {
    sender: Sender<T>,
    wake: Wake,
}

impl<T> Post<T> {
    pub(crate) fn new(wake: Wake) -> (Self, Receiver<T>) {
        let (sender, receiver) = channel();
        (Self { sender, wake }, receiver)
    }

    /// Says that there is something to be shown, without a report.
    pub(crate) fn wake(&self) {
        (self.wake)();
    }

    /// Sends a report. When nobody is there any more, nobody misses it.
    pub(crate) fn send(&self, report: T) {
        let _ = self.sender.send(report);
        (self.wake)();
    }
}

impl<T> Clone for Post<T> {
    fn clone(&self) -> Self {
        Self { sender: self.sender.clone(), wake: self.wake.clone() }
    }
}

impl<T> fmt::Debug for Post<T> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("Post")
    }
}
