//! Tests that look inside.

mod baseline;
mod curves;
mod layouts;
mod options;
mod random;
mod records;
mod rectangles;
mod robust;
mod sums;
