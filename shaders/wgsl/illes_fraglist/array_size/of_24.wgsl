// For 8 balls.

const ARRAY_SIZE: u32 = 24u;
