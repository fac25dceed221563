// For 4 balls.

const ARRAY_SIZE: u32 = 12u;
