//! A long computation, watched: signals end it, and a bar shows how far it is.

use std::ops::ControlFlow;

use pyo3::prelude::*;

/// Watches a computation that does not hold the interpreter.
pub(crate) struct Watch {
    /// An object with `update(n)`, as tqdm's bars have; what it is told of is done.
    bar: Option<Py<PyAny>>,
    told: usize,
    /// What a signal or the bar has raised.
    raised: Option<PyErr>,
}

impl Watch {
    pub(crate) fn new(bar: Option<Py<PyAny>>) -> Self {
        Self { bar, told: 0, raised: None }
    }

    /// So much is done: whether to go on.
    pub(crate) fn goes_on(&mut self, done: usize) -> ControlFlow<()> {
        let asked = Python::attach(|py| {
            py.check_signals()?;
            match &self.bar {
                Some(bar) if done > self.told => {
                    bar.call_method1(py, "update", (done - self.told,)).map(drop)
                }
                _ => Ok(()),
            }
        });
        self.told = done;
        match asked {
            Ok(()) => ControlFlow::Continue(()),
            Err(error) => {
                self.raised = Some(error);
                ControlFlow::Break(())
            }
        }
    }

    /// What was computed, or what ended it.
    pub(crate) fn outcome<T>(self, computed: PyResult<T>) -> PyResult<T> {
        match self.raised {
            Some(error) => Err(error),
            None => computed,
        }
    }
}
