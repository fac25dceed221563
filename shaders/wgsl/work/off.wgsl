// Counting compiled out.

fn count_node() {}

fn go_down() {}

fn leave_for_later(slot: u32) {}

fn come_back_to(slot: u32) {}

fn count_leaf_test() {}

fn count_balls(n: u32) {}

fn count_evaluations(n: u32) {}

fn count_iterations(n: u32) {}

fn count_search_end() {}

fn count_layers(n: u32) {}

fn write_work(pixel: u32) {}
