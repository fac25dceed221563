// No test, so that leaves are searched by ranges alone: for kernels other than v^2, and for the search for
// an exit.

#import fbvh::relative_ray::RelativeRay
#import fbvh::test_result::{TestResult, UNCERTAIN}

const MOST_TESTS: u32 = 0u;

fn polynomial_test(ray: RelativeRay, direction: vec3<f32>, low: f32, high: f32) -> TestResult {
    return TestResult(UNCERTAIN, low, high, high);
}
