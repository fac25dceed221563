// Eight targets.

const LONGEST: u32 = 30u;
