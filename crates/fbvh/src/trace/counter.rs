//! Counting what a ray costs.

/// Receives a call for each step of a trace. `()` counts nothing and costs nothing.
pub trait Counter {
    /// An interior node was read.
    fn node(&mut self) {}
    /// A leaf was searched, with so many balls in its list.
    fn leaf_test(&mut self, balls: usize) {
        let _ = balls;
    }
    /// The field was evaluated at a point, or bounded on an interval.
    fn evaluation(&mut self) {}
    /// A search for a root, the secant's or Newton's, made a step.
    fn iteration(&mut self) {}
}

impl Counter for () {}

/// Sums of what was done: table 3 of the paper, and the evaluations behind it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Work {
    /// Interior nodes read.
    pub nodes: u64,
    /// Leaves searched.
    pub leaf_tests: u64,
    /// Entries of the lists of those leaves.
    pub balls: u64,
    /// Evaluations of the field, one for each point or interval.
    pub evaluations: u64,
    /// Steps of searches for a root.
    pub iterations: u64,
}

impl Counter for Work {
    fn node(&mut self) {
        self.nodes += 1;
    }

    fn leaf_test(&mut self, balls: usize) {
        self.leaf_tests += 1;
        self.balls += balls as u64;
    }

    fn evaluation(&mut self) {
        self.evaluations += 1;
    }

    fn iteration(&mut self) {
        self.iterations += 1;
    }
}
