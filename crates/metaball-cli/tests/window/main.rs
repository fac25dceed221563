//! The binary with a window, on a display that nobody sees. Without Xvfb these tests show as ignored.

#[cfg(target_os = "linux")]
mod display;
#[cfg(target_os = "linux")]
mod screen;
#[cfg(target_os = "linux")]
mod trials;

fn main() {
    let arguments = libtest_mimic::Arguments::from_args();
    #[cfg(target_os = "linux")]
    let trials = trials::all();
    #[cfg(not(target_os = "linux"))]
    let trials = Vec::new();
    libtest_mimic::run(&arguments, trials).exit();
}
