// Puts a pixel's list in order of rank. Where fragments arrive in draw order, as on many devices though
// none promises it, the list is in order already, which one walk finds; otherwise it is a few runs,
// which a natural merge sort of the links joins without further memory.

#import illes_fraglist::budget
#import illes_fraglist::lists

// What a list can be.
const IN_ORDER: u32 = 0u;
const OUT_OF_ORDER: u32 = 1u;
// It has more nodes than an invocation can walk along.
const TOO_LONG: u32 = 2u;

// One walk along a list.
struct Walk {
    // The node to visit next.
    node: u32,
    // The rank of the one visited last, and whether none was lower than the one before it.
    rank: u32,
    rises: bool,
}

fn order_of(pixel: u32) -> u32 {
    var walk = Walk(lists::head_of(pixel), 0u, true);
    for (var four = 0u; four < budget::LIST_CAPACITY / 4u && walk.node != lists::END; four++) {
        visit(&walk);
        visit(&walk);
        visit(&walk);
        visit(&walk);
    }
    if walk.node != lists::END {
        return TOO_LONG;
    }
    return select(OUT_OF_ORDER, IN_ORDER, walk.rises);
}

fn visit(walk: ptr<function, Walk>) {
    if (*walk).node == lists::END {
        return;
    }
    let visited = lists::node_at((*walk).node);
    let rises = (*walk).rises && visited.rank >= (*walk).rank;
    *walk = Walk(visited.next, visited.rank, rises);
}

// Whether the list, which was not, is in order. `false`: the budget is spent; the next dispatch resumes
// with what has been merged.
fn restore_order(pixel: u32) -> bool {
    while budget::can_continue() {
        if merge_runs(pixel) <= 1u {
            return true;
        }
    }
    return false;
}

// Two neighbouring runs on their way into one.
struct Merge {
    // What remains of the first, up to the second's first node; and of the second, up to the rest.
    first: u32,
    middle: u32,
    second: u32,
    rest: u32,
    // The last node that is in order.
    tail: u32,
}

// Merges each run of rising ranks with the one behind it. Returns the number of runs that remain.
fn merge_runs(pixel: u32) -> u32 {
    var runs = 0u;
    var merge = Merge();
    merge.rest = lists::head_of(pixel);
    while merge.rest != lists::END {
        merge.first = merge.rest;
        merge.middle = after_run(merge.first);
        if merge.middle == lists::END && merge.tail == lists::END {
            return 1u;
        }
        merge.second = merge.middle;
        merge.rest = after_run(merge.middle);
        while has_rest(merge) {
            put_lower(pixel, &merge);
            put_lower(pixel, &merge);
            put_lower(pixel, &merge);
            put_lower(pixel, &merge);
            budget::spend(1u);
        }
        runs++;
    }
    if merge.tail != lists::END {
        lists::link(pixel, merge.tail, lists::END);
    }
    return runs;
}

// Whether a node is still to be merged.
fn has_rest(merge: Merge) -> bool {
    return merge.first != merge.middle || merge.second != merge.rest;
}

// Puts the lower of the two next nodes behind the tail; does nothing when both runs are done.
fn put_lower(pixel: u32, merge: ptr<function, Merge>) {
    let now = *merge;
    if !has_rest(now) {
        return;
    }
    let is_first = now.first != now.middle
        && (now.second == now.rest || lists::rank_at(now.first) < lists::rank_at(now.second));
    let node = select(now.second, now.first, is_first);
    if is_first {
        (*merge).first = lists::after(node);
    } else {
        (*merge).second = lists::after(node);
    }
    lists::link(pixel, now.tail, node);
    (*merge).tail = node;
}

// The first node behind a run of rising ranks.
fn after_run(start: u32) -> u32 {
    var node = start;
    while is_followed(node) {
        node = next_of_run(node);
        node = next_of_run(node);
        node = next_of_run(node);
        node = next_of_run(node);
        budget::spend(1u);
    }
    return lists::after_or_end(node);
}

// Whether the node behind is of the same run.
fn is_followed(node: u32) -> bool {
    let next = lists::after_or_end(node);
    return next != lists::END && lists::rank_at(next) > lists::rank_at(node);
}

// The node behind in the same run; the last one stays.
fn next_of_run(node: u32) -> u32 {
    if is_followed(node) {
        return lists::after(node);
    }
    return node;
}
