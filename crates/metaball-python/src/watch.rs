//! A long computation, watched: it has a thread of its own, while the caller's looks for signals and tells a bar
//! how far it is.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread;
use std::time::Duration;

use pyo3::prelude::*;

/// How long a signal may wait.
const PAUSE: Duration = Duration::from_millis(50);

/// A computation, as it sees whoever watches it.
pub(crate) struct Watched<'a> {
    given_up: &'a AtomicBool,
    done: Sender<usize>,
}

impl Watched<'_> {
    /// Whether it is still wanted.
    pub(crate) fn goes_on(&self) -> bool {
        !self.given_up.load(Ordering::Relaxed)
    }

    /// So much of it is done.
    pub(crate) fn is_at(&self, done: usize) {
        // Whoever watches waits for the end.
        let _ = self.done.send(done);
    }
}

/// What is computed, without the interpreter. `bar` is an object with `update(n)`, as tqdm's bars have.
///
/// # Errors
/// The computation's own, or what a signal or the bar has raised: then its own is not looked at.
pub(crate) fn watch<T: Send>(
    py: Python<'_>,
    bar: Option<Py<PyAny>>,
    compute: impl FnOnce(&Watched<'_>) -> PyResult<T> + Send,
) -> PyResult<T> {
    py.detach(|| {
        let given_up = AtomicBool::new(false);
        let (done, told) = mpsc::channel();
        thread::scope(|scope| {
            let watched = Watched { given_up: &given_up, done };
            let worker = scope.spawn(move || compute(&watched));
            let (mut shown, mut raised) = (0, None);
            loop {
                let done = match told.recv_timeout(PAUSE) {
                    Ok(done) => done,
                    Err(RecvTimeoutError::Timeout) => shown,
                    Err(RecvTimeoutError::Disconnected) => break,
                };
                if raised.is_none() {
                    raised = Python::attach(|py| look(py, bar.as_ref(), done - shown)).err();
                    given_up.store(raised.is_some(), Ordering::Relaxed);
                }
                shown = done;
            }
            let computed = worker.join().unwrap_or_else(|panic| resume_unwind(panic));
            raised.map_or(computed, Err)
        })
    })
}

/// Handles signals, and tells the bar of what has been done since.
fn look(py: Python<'_>, bar: Option<&Py<PyAny>>, steps: usize) -> PyResult<()> {
    py.check_signals()?;
    match bar {
        Some(bar) if steps > 0 => bar.call_method1(py, "update", (steps,)).map(drop),
        _ => Ok(()),
    }
}
