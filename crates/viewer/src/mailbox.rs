//! Orders for a task, of which only the latest counts.

use std::future::poll_fn;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::task::{Context, Poll, Waker};

/// Holds the latest order that nobody has taken.
#[derive(Debug)]
pub(crate) struct Mailbox<T>(Mutex<State<T>>);

#[derive(Debug)]
struct State<T> {
    order: Option<T>,
    closed: bool,
    /// The one task that waits for an order.
    waits: Option<Waker>,
}

impl<T> Mailbox<T> {
    pub(crate) fn new() -> Self {
        Self(Mutex::new(State { order: None, closed: false, waits: None }))
    }

    /// Puts an order in the place of the one that is there.
    pub(crate) fn put(&self, order: T) {
        self.change(|state| state.order = Some(order));
    }

    /// Takes the order that is there, or waits for one; `None` when there will be none any more.
    pub(crate) async fn take(&self) -> Option<T> {
        poll_fn(|context| self.poll(context)).await
    }

    fn poll(&self, context: &Context<'_>) -> Poll<Option<T>> {
        let mut state = self.state();
        if state.closed {
            return Poll::Ready(None);
        }
        match state.order.take() {
            Some(order) => Poll::Ready(Some(order)),
            None => {
                state.waits = Some(context.waker().clone());
                Poll::Pending
            }
        }
    }

    /// Whether nothing more is to be taken.
    pub(crate) fn is_closed(&self) -> bool {
        self.state().closed
    }

    /// Whether whoever takes orders should look: there is one, or there will be none any more.
    pub(crate) fn calls(&self) -> bool {
        let state = self.state();
        state.closed || state.order.is_some()
    }

    /// Ends whoever waits.
    pub(crate) fn close(&self) {
        self.change(|state| state.closed = true);
    }

    fn change(&self, change: impl FnOnce(&mut State<T>)) {
        let waits = {
            let mut state = self.state();
            change(&mut state);
            state.waits.take()
        };
        if let Some(waker) = waits {
            waker.wake();
        }
    }

    /// No code that holds the lock can panic.
    fn state(&self) -> MutexGuard<'_, State<T>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::thread;

    use pollster::block_on;

    use super::*;

    #[test]
    fn only_the_latest_order_counts() {
        let mailbox = Mailbox::new();
        mailbox.put(1);
        mailbox.put(2);
        assert!(mailbox.calls());
        assert_eq!(block_on(mailbox.take()), Some(2));
        assert!(!mailbox.calls());
    }

    #[test]
    fn closing_ends_whoever_waits() {
        let mailbox = Arc::new(Mailbox::<u32>::new());
        let waits = {
            let mailbox = mailbox.clone();
            thread::spawn(move || block_on(mailbox.take()))
        };
        mailbox.put(7);
        assert_eq!(waits.join().expect("no panic"), Some(7));
        let waits = {
            let mailbox = mailbox.clone();
            thread::spawn(move || block_on(mailbox.take()))
        };
        mailbox.close();
        assert_eq!(waits.join().expect("no panic"), None);
        mailbox.put(8);
        assert!(mailbox.calls() && mailbox.is_closed());
        assert_eq!(block_on(mailbox.take()), None);
    }
}
