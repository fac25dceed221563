//! Orders for a thread, of which only the latest counts.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// Holds the latest order that nobody has taken.
#[derive(Debug)]
pub(crate) struct Mailbox<T> {
    state: Mutex<State<T>>,
    changed: Condvar,
}

#[derive(Debug)]
struct State<T> {
    order: Option<T>,
    closed: bool,
}

impl<T> Mailbox<T> {
    pub(crate) fn new() -> Self {
        let state = Mutex::new(State { order: None, closed: false });
        Self { state, changed: Condvar::new() }
    }

    /// Puts an order in the place of the one that is there.
    pub(crate) fn put(&self, order: T) {
        self.state().order = Some(order);
        self.changed.notify_one();
    }

    /// Takes the order that is there, or waits for one; `None` when there will be none any more.
    pub(crate) fn take(&self) -> Option<T> {
        let mut state = self.state();
        loop {
            if state.closed {
                return None;
            }
            if let Some(order) = state.order.take() {
                return Some(order);
            }
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
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
        self.state().closed = true;
        self.changed.notify_all();
    }

    /// No code that holds the lock can panic.
    fn state(&self) -> MutexGuard<'_, State<T>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::thread;

    use super::*;

    #[test]
    fn only_the_latest_order_counts() {
        let mailbox = Mailbox::new();
        mailbox.put(1);
        mailbox.put(2);
        assert!(mailbox.calls());
        assert_eq!(mailbox.take(), Some(2));
        assert!(!mailbox.calls());
    }

    #[test]
    fn closing_ends_whoever_waits() {
        let mailbox = Arc::new(Mailbox::<u32>::new());
        let waits = {
            let mailbox = mailbox.clone();
            thread::spawn(move || mailbox.take())
        };
        mailbox.put(7);
        assert_eq!(waits.join().expect("no panic"), Some(7));
        let waits = {
            let mailbox = mailbox.clone();
            thread::spawn(move || mailbox.take())
        };
        mailbox.close();
        assert_eq!(waits.join().expect("no panic"), None);
        mailbox.put(8);
        assert!(mailbox.calls() && mailbox.is_closed());
        assert_eq!(mailbox.take(), None);
    }
}
