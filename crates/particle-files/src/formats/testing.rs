//! What tests of several formats need.

use proptest::prelude::*;
use proptest::sample::Index;

use crate::table::Table;

/// The values of the column of that name, as text.
pub(super) fn words(table: &Table, name: &str) -> Vec<String> {
    let column = table.column(name).expect("a column of that name");
    (0..table.len()).map(|index| column.values.text(index).into_owned()).collect()
}

/// A good file with a few bytes changed, put in or taken out.
pub(super) fn changed(good: Vec<u8>) -> impl Strategy<Value = Vec<u8>> {
    let changes = prop::collection::vec((any::<Index>(), any::<u8>(), 0..3_u8), 1..8);
    changes.prop_map(move |changes| {
        let mut bytes = good.clone();
        for (at, byte, how) in changes {
            let at = at.index(bytes.len());
            match how {
                0 => bytes[at] = byte,
                1 => bytes.insert(at, byte),
                _ => drop(bytes.remove(at)),
            }
        }
        bytes
    })
}
