//! The one binary of cross-method tests; `iso_tests::trials` holds them.

fn main() {
    let arguments = libtest_mimic::Arguments::from_args();
    libtest_mimic::run(&arguments, iso_tests::trials::all()).exit();
}
