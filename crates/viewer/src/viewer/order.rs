//! Which picture was ordered last, and how quickly pictures come.

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Duration;

use metaball::{Camera, Model, View};
use web_time::Instant;

use crate::painter::{Look, Order, Painter, Painting};

/// The camera rests when it has not moved for so long.
const REST: Duration = Duration::from_millis(140);

/// Pictures within this time make the rate.
const WINDOW: Duration = Duration::from_millis(1000);

/// What was ordered last.
#[derive(Debug, Default)]
pub(super) struct Ordered {
    last: Option<Order>,
    moved: Option<Instant>,
    arrived: VecDeque<Instant>,
}

/// All that a picture is of.
type Wanted<'a> = (Arc<Model>, Camera, (u32, u32), &'a Look);

impl Ordered {
    /// Orders a picture if it is another one, coarse if the camera or the model has just been another.
    /// Returns when the camera will be at rest, if it is not.
    pub(super) fn order(
        &mut self,
        painter: &Painter,
        (model, camera, size, look): Wanted<'_>,
        moving: bool,
    ) -> Option<Duration> {
        let now = Instant::now();
        let is_still = |last: &Order| {
            last.camera == camera && Arc::ptr_eq(&last.model, &model) && last.look == *look
        };
        let is_first = self.last.is_none();
        if !is_first && (moving || !self.last.as_ref().is_some_and(is_still)) {
            self.moved = Some(now);
        }
        let left = self.moved.and_then(|moved| REST.checked_sub(now - moved));
        let moving = left.is_some();
        let is_same = |last: &Order| is_still(last) && last.size == size && last.moving == moving;
        if !self.last.as_ref().is_some_and(is_same) {
            let order = Order { model, camera, size, look: look.clone(), moving };
            self.last = Some(order.clone());
            painter.order(order);
        }
        left
    }

    /// The view that was ordered, from where a camera is.
    pub(super) fn view(&self, camera: Camera) -> Option<View> {
        let (width, height) = self.size()?;
        View::new(camera, width, height).ok()
    }

    /// Its pixels across and down.
    pub(super) fn size(&self) -> Option<(u32, u32)> {
        Some(self.last.as_ref()?.size)
    }

    /// Counts a picture that has come.
    pub(super) fn count(&mut self, painted: &Result<Painting, String>) {
        let now = Instant::now();
        if painted.is_ok() {
            self.arrived.push_back(now);
        }
        while self.arrived.front().is_some_and(|first| now - *first > WINDOW) {
            self.arrived.pop_front();
        }
    }

    /// Pictures a second, of those that came within the last one.
    pub(super) fn rate(&self) -> Option<f64> {
        let (first, last) = (self.arrived.front()?, self.arrived.back()?);
        let intervals = self.arrived.len() - 1;
        (intervals > 1).then(|| intervals as f64 / (*last - *first).as_secs_f64().max(1e-3))
    }
}
