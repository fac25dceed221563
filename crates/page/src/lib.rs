//! The viewer in a browser. A [`Page`] lives in a worker of the page, beside its model: what a user does
//! comes in as JSON, what the panel shows goes out as JSON, and pictures go out as bytes. The page itself,
//! its widgets and its worker's loop, is the folder `crates/page/site`; `cargo xtask web` puts it together.
//!
//! There is one thread: threads would need memory that is shared, which a stable toolchain does not compile
//! for. The viewer's tasks take turns instead.

mod act;
mod files;
mod front;
mod state;
mod turns;

use std::sync::Arc;

use wasm_bindgen::JsError;
use wasm_bindgen::prelude::wasm_bindgen;

use crate::front::Front;
use crate::turns::{Turns, waking};

/// The viewer, as JavaScript has it.
#[wasm_bindgen]
pub struct Page(Front);

/// A picture: four bytes a pixel, sRGB, row by row from the top left.
#[wasm_bindgen(getter_with_clone)]
pub struct Pixels {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Red, green, blue, opacity.
    pub rgba: Vec<u8>,
}

#[wasm_bindgen]
impl Page {
    /// With nothing to be seen yet.
    #[wasm_bindgen(constructor)]
    #[allow(clippy::new_without_default, reason = "JavaScript knows constructors alone")]
    pub fn new() -> Self {
        Self(Front::new(Arc::new(Turns), &waking()))
    }

    /// Opens the bytes of a file of that name.
    pub fn open(&mut self, name: String, bytes: Vec<u8>) {
        self.0.open(name, bytes);
    }

    /// Does what a user has done.
    ///
    /// # Errors
    /// When it is no act.
    pub fn act(&mut self, json: &str) -> Result<(), JsError> {
        Ok(self.0.act(json)?)
    }

    /// Goes on with what the tasks have done. Returns the milliseconds after which it wants to be called
    /// again, if nothing else happens.
    #[wasm_bindgen(js_name = goOn)]
    pub fn go_on(&mut self) -> Option<f64> {
        Some(1e3 * self.0.go_on()?.as_secs_f64())
    }

    /// The latest picture, if it has not been handed out yet.
    pub fn picture(&mut self) -> Option<Pixels> {
        let image = self.0.picture()?;
        Some(Pixels { width: image.width, height: image.height, rgba: image.rgba.clone() })
    }

    /// What the panel shows, in JSON.
    ///
    /// # Errors
    /// When a number in it is none of JSON's.
    pub fn state(&self) -> Result<String, JsError> {
        Ok(serde_json::to_string(&self.0.state())?)
    }
}
