// Puts a pixel's list in order of rank. Where fragments arrive in draw order, as many devices happen
// to have it and none promises, the list is in order already and one walk says so; otherwise it is a
// few runs, which a natural merge sort of the links joins in place.

#import illes_fraglist::budget
#import illes_fraglist::lists

// Whether the list is in order. `false`: the budget is spent; the next dispatch goes on from what
// has been merged.
fn restore_order(pixel: u32) -> bool {
    while budget::can_go_on() {
        if merge_runs(pixel) <= 1u {
            return true;
        }
    }
    return false;
}

// Whether the list has more nodes than an invocation can walk along.
fn is_too_long(pixel: u32) -> bool {
    var place = lists::head_of(pixel);
    for (var four = 0u; four < budget::LONGEST_LIST / 4u && place != lists::END; four++) {
        place = lists::after_or_end(place);
        place = lists::after_or_end(place);
        place = lists::after_or_end(place);
        place = lists::after_or_end(place);
    }
    return place != lists::END;
}

// Two neighbouring runs on their way into one.
struct Merge {
    // What remains of the first, up to the second's first node; and of the second, up to the rest.
    first: u32,
    middle: u32,
    second: u32,
    rest: u32,
    // The last node that is in its place.
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
        while goes_on(merge) {
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

fn goes_on(merge: Merge) -> bool {
    return merge.first != merge.middle || merge.second != merge.rest;
}

// Puts the lower of the two next nodes behind the tail; does nothing when both runs are done.
fn put_lower(pixel: u32, merge: ptr<function, Merge>) {
    let now = *merge;
    if !goes_on(now) {
        return;
    }
    let is_first = now.first != now.middle
        && (now.second == now.rest || lists::rank_at(now.first) < lists::rank_at(now.second));
    let place = select(now.second, now.first, is_first);
    if is_first {
        (*merge).first = lists::after(place);
    } else {
        (*merge).second = lists::after(place);
    }
    lists::link(pixel, now.tail, place);
    (*merge).tail = place;
}

// The first node behind a run of rising ranks.
fn after_run(start: u32) -> u32 {
    var place = start;
    while is_followed(place) {
        place = next_of_run(place);
        place = next_of_run(place);
        place = next_of_run(place);
        place = next_of_run(place);
        budget::spend(1u);
    }
    return lists::after_or_end(place);
}

// Whether the node behind is of the same run.
fn is_followed(place: u32) -> bool {
    let next = lists::after_or_end(place);
    return next != lists::END && lists::rank_at(next) > lists::rank_at(place);
}

// The node behind in the same run; the last one stays.
fn next_of_run(place: u32) -> u32 {
    if is_followed(place) {
        return lists::after(place);
    }
    return place;
}
