// Puts a pixel's list in order of rank. Where fragments arrive in draw order, as many devices happen
// to have it and none promises, the list is in order already and one walk says so; otherwise it is a
// few runs, which a natural merge sort of the links joins in place.
#define_import_path metaball::illes_fraglist::order

#import metaball::illes_fraglist::budget
#import metaball::illes_fraglist::lists

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
    var length = 0u;
    for (var place = lists::head_of(pixel); place != lists::END; place = lists::after(place)) {
        length++;
        if length > budget::LONGEST_LIST {
            return true;
        }
    }
    return false;
}

// Merges each run of rising ranks with the one behind it. Returns the number of runs that remain.
fn merge_runs(pixel: u32) -> u32 {
    var runs = 0u;
    var tail = lists::END;
    var rest = lists::head_of(pixel);
    while rest != lists::END {
        var first = rest;
        let middle = after_run(first);
        if middle == lists::END && tail == lists::END {
            return 1u;
        }
        var second = middle;
        rest = after_run(middle);
        while first != middle || second != rest {
            let is_first = first != middle
                && (second == rest || lists::rank_at(first) < lists::rank_at(second));
            let place = select(second, first, is_first);
            if is_first {
                first = lists::after(place);
            } else {
                second = lists::after(place);
            }
            lists::link(pixel, tail, place);
            tail = place;
            budget::spend(1u);
        }
        runs++;
    }
    if tail != lists::END {
        lists::link(pixel, tail, lists::END);
    }
    return runs;
}

// The first node behind a run of rising ranks.
fn after_run(start: u32) -> u32 {
    var place = start;
    while place != lists::END {
        let next = lists::after(place);
        budget::spend(1u);
        if next == lists::END || lists::rank_at(next) < lists::rank_at(place) {
            return next;
        }
        place = next;
    }
    return lists::END;
}
