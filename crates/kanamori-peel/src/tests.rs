//! Tests that look inside.

mod layouts;
mod rectangles;
