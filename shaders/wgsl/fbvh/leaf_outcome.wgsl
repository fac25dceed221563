// What the search of a leaf has found.

const MISSED: u32 = 0u;
// A hit: see leaf::hit_t and leaf::hit_status.
const FOUND: u32 = 1u;
// The budget is spent: the search is to be resumed.
const WAITING: u32 = 2u;

// Of certified searches alone. Nothing, but the excess came so close to 0 at the ray's end that it may have
// reached it.
const UNCERTAIN: u32 = 3u;
// One root is between the ends of a bracket: leaf::close_in finds it.
const BRACKETED: u32 = 4u;
// The ray does not pass through the leaf's box.
const UNMET: u32 = 5u;
// Nothing, but on the search for an exit the excess came so close to 0 at the leaf's far face that it
// reaches it there, unless another leaf begins where this one ends: in no leaf the field is below T.
// leaf::hit_t is where.
const AT_FACE: u32 = 6u;
