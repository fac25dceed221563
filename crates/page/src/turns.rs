//! The viewer's tasks in a browser, where there is one thread: each goes on when the others have had their
//! turn.

use std::sync::Arc;

use viewer::{Awaited, Crew, Task, Wake};
use wasm_bindgen::prelude::wasm_bindgen;
use wasm_bindgen_futures::spawn_local;

#[wasm_bindgen(module = "/src/turns.js")]
extern "C" {
    /// Awaited until what has happened meanwhile is dealt with.
    async fn turn();

    /// Says that there is something to be shown.
    fn wake();
}

/// Tasks in turns.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Turns;

impl Crew for Turns {
    fn begin(&self, task: Task) {
        spawn_local(task());
    }

    fn turn(&self) -> Awaited {
        Box::pin(turn())
    }
}

/// What tasks call that have something to show.
pub(crate) fn waking() -> Wake {
    Arc::new(wake)
}
