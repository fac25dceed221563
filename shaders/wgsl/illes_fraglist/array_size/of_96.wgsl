// For 32 balls.

const ARRAY_SIZE: u32 = 96u;
