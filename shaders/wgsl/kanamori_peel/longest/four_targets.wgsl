// Four targets, as published.

const LONGEST: u32 = 14u;
