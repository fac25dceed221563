//! The fuzz target's body on stable Rust: seeds that reach each of its ends, and random bytes.

mod fuzzing;

use fuzzing::{Outcome, build_and_trace};

#[test]
fn seeds_reach_every_end() {
    assert_eq!(build_and_trace(&[1, 1, 16]), Outcome::TooFew);
    // One ball at the origin seen from (0, 0, −5); a threshold of zero; a ball of NaN.
    let ball = [1, 1, 16, 0, 0, 216, 0x88, 8, 8];
    assert!(matches!(build_and_trace(&ball), Outcome::Traced(2..)), "{:?}", build_and_trace(&ball));
    assert_eq!(build_and_trace(&[1, 1, 0, 0, 0, 216, 0x88, 8, 8]), Outcome::Refused);
    let nan = [&[0, 1, 16, 0, 0, 216][..], &f32::NAN.to_le_bytes().repeat(5)].concat();
    assert_eq!(build_and_trace(&nan), Outcome::Refused);
    assert_eq!(build_and_trace(&[1, 1, 16, 0, 0, 216]), Outcome::Traced(0));
}

#[test]
fn random_bytes_are_answered() {
    let mut state = 0x9e37_79b9_7f4a_7c15u64;
    let mut random = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state
    };
    let mut hits = 0;
    for _ in 0..1500 {
        let length = random() % 160;
        let bytes: Vec<u8> = (0..length).map(|_| (random() >> 32) as u8).collect();
        if let Outcome::Traced(count) = build_and_trace(&bytes) {
            hits += count;
        }
    }
    assert!(hits > 1000, "{hits}");
}
