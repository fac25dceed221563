//! Tests of what is not public.

mod baseline;
mod curves;
mod layouts;
mod options;
mod random;
mod records;
mod rectangles;
mod robust;
mod sums;
