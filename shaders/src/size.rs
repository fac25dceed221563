//! How much code a composed module is.

use naga::{Block, Function, Module, Statement};

/// Expressions and statements of all functions and entry points, blocks within blocks included.
///
/// Composition leaves out functions that nothing calls, so this is what a driver is given.
pub fn code_size(module: &Module) -> u64 {
    let functions = module.functions.iter().map(|(_, function)| function);
    let entries = module.entry_points.iter().map(|entry| &entry.function);
    let size = |function: &Function| function.expressions.len() as u64 + statements(&function.body);
    functions.chain(entries).map(size).sum()
}

fn statements(block: &Block) -> u64 {
    block.iter().map(|statement| 1 + nested(statement)).sum()
}

fn nested(statement: &Statement) -> u64 {
    match statement {
        Statement::Block(block) => statements(block),
        Statement::If { accept, reject, .. } => statements(accept) + statements(reject),
        Statement::Switch { cases, .. } => cases.iter().map(|case| statements(&case.body)).sum(),
        Statement::Loop { body, continuing, .. } => statements(body) + statements(continuing),
        _ => 0,
    }
}
