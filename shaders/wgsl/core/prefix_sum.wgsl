// Sums over the invocations of a workgroup.

// Invocations of a workgroup at most.
const THREADS: u32 = 256u;

var<workgroup> sums: array<u32, THREADS>;

// The sum of what the invocations before this one contribute. In uniform control flow.
fn sum_before(thread: u32, own: u32) -> u32 {
    sums[thread] = own;
    workgroupBarrier();
    var sum = 0u;
    for (var before = 0u; before < thread; before++) {
        sum += sums[before];
    }
    return sum;
}
