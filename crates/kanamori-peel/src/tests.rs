//! Tests that look inside.

mod curves;
mod layouts;
mod options;
mod random;
mod rectangles;
