// For 16 balls.

const ARRAY_SIZE: u32 = 48u;
