//! TRR of GROMACS: frames of positions, velocities and forces in nanometres, the most significant byte
//! of numbers first, in single or double precision.

use glam::DVec3;

use super::{Reader, Request, Span};
use crate::binary::{self, ByteOrder, Cursor, NumberType, Numbers};
use crate::cell::Cell;
use crate::error::Flaw;
use crate::notes::{Notes, counted};
use crate::table::{Table, Values, component};
use crate::units::Unit;

pub(super) const READER: Reader =
    Reader { name: "TRR", endings: &["trr"], is_text: false, recognizes, frames, table };

/// What every frame begins with.
const MAGIC: i32 = 1993;

/// What stands in every frame, behind its length, which is written twice.
const VERSION: &[u8] = b"GMX_trn_file";

fn recognizes(bytes: &[u8]) -> bool {
    bytes.starts_with(&MAGIC.to_be_bytes()) && bytes.get(12..24) == Some(VERSION)
}

/// What a frame begins with.
struct Header {
    /// Bytes of the box, of virial and pressure together, of positions, velocities and forces.
    sizes: [usize; 5],
    atoms: usize,
    kind: NumberType,
}

impl Header {
    fn of(cursor: &mut Cursor<'_>) -> Result<Self, Flaw> {
        let at = cursor.at();
        let magic = cursor.i32("a frame")?;
        if magic != MAGIC {
            return Err(
                Flaw::needed(&format!("{MAGIC} at the start of a frame"), magic).at_byte(at)
            );
        }
        cursor.take(4, "the version")?;
        let length = cursor.count("the length of the version")?;
        cursor.take(length.next_multiple_of(4), "the version")?;
        let mut sizes = [0; 11];
        for size in &mut sizes {
            *size = cursor.count("the size of a part of a frame")?;
        }
        // Of input records and energies nothing is written, nor of topology and symbols.
        let [_, _, cell, virial, pressure, _, _, x, v, f, atoms] = sizes;
        // The step, and a number that is not used.
        cursor.take(8, "the step")?;
        let kind = kind(cell, [x, v, f], atoms).map_err(|flaw| flaw.at_byte(at))?;
        cursor.take(2 * kind.size(), "the time")?;
        Ok(Self { sizes: [cell, virial + pressure, x, v, f], atoms, kind })
    }

    fn has_positions(&self) -> bool {
        self.sizes[2] > 0
    }

    /// Bytes behind it.
    fn size(&self) -> usize {
        self.sizes.iter().fold(0, |sum, size| sum.saturating_add(*size))
    }
}

/// The type of numbers, by the sizes of the box and of what every atom has; both must fit.
fn kind(cell: usize, of_atoms: [usize; 3], atoms: usize) -> Result<NumberType, Flaw> {
    let fits = |size: usize| {
        let all = atoms.saturating_mul(3).saturating_mul(size);
        (cell == 0 || cell == 9 * size) && of_atoms.iter().all(|of| *of == 0 || *of == all)
    };
    match (fits(4), fits(8)) {
        (true, _) => Ok(NumberType::F32),
        (false, true) => Ok(NumberType::F64),
        (false, false) => {
            let needed = format!(
                "three numbers of 4 or 8 bytes for each of {} and nine for the box",
                counted(atoms, "atom")
            );
            let [x, v, f] = of_atoms;
            Err(Flaw::needed(&needed, format_args!("{x}, {v}, {f} and {cell} bytes")))
        }
    }
}

/// The frames that have positions.
fn frames(bytes: &[u8]) -> Result<Vec<Span>, Flaw> {
    Ok(steps(bytes)?.0)
}

/// The frames that have positions, and the number of those that have none.
fn steps(bytes: &[u8]) -> Result<(Vec<Span>, usize), Flaw> {
    let (mut spans, mut without) = (Vec::new(), 0);
    let mut cursor = Cursor::new(bytes, 0, ByteOrder::Big);
    while !cursor.rest().is_empty() {
        let start = cursor.at();
        let header = Header::of(&mut cursor)?;
        let number = spans.len() + without;
        cursor.take(header.size(), &format!("frame {number}, counted from 0"))?;
        if header.has_positions() {
            spans.push(Span { bytes: start..cursor.at(), line: 1 });
        } else {
            without += 1;
        }
    }
    Ok((spans, without))
}

fn table(bytes: &[u8], span: &Span, request: &Request, notes: &mut Notes) -> Result<Table, Flaw> {
    let mut cursor = Cursor::new(&bytes[..span.bytes.end], span.bytes.start, ByteOrder::Big);
    let Header { sizes: [cell, others, x, v, f], atoms, kind } = Header::of(&mut cursor)?;
    let cell = cursor.take(cell, "the box")?;
    cursor.take(others, "virial and pressure")?;
    let axes = |bytes: &[u8]| -> Option<[Vec<f64>; 3]> {
        let axis = |axis: usize| numbers(bytes, kind, axis, atoms).map(Numbers::to_vec);
        Some([axis(0)?, axis(1)?, axis(2)?])
    };
    let at = cursor.at();
    let bytes_of_x = cursor.take(x, "positions")?;
    let positions = match [0, 1, 2].map(|axis| numbers(bytes_of_x, kind, axis, atoms)) {
        [Some(x), Some(y), Some(z)] => binary::positions([x, y, z]),
        _ => Ok(Vec::new()),
    };
    let positions = positions.map_err(|flaw| flaw.at_byte(at))?;
    let mut table = Table {
        positions,
        cell: edges(cell, kind),
        unit: Some(Unit::Nanometre),
        ..Table::default()
    };
    for (name, size) in [("velocity", v), ("force", f)] {
        let bytes = cursor.take(size, name)?;
        for (axis, numbers) in axes(bytes).filter(|_| size > 0).into_iter().flatten().enumerate() {
            let name = component(name, axis, 3);
            if request.wanted.wants(&name) {
                table.add(name, Values::Numbers(numbers));
            }
        }
    }
    let (_, without) = steps(bytes)?;
    if without > 0 {
        notes.left_out(format!("{} without positions", counted(without, "frame")));
    }
    Ok(table)
}

/// One of three coordinates of all atoms.
fn numbers(bytes: &[u8], kind: NumberType, axis: usize, atoms: usize) -> Option<Numbers<'_>> {
    let bytes = bytes.get(axis * kind.size()..).unwrap_or_default();
    Numbers::new(bytes, kind, ByteOrder::Big, 3 * kind.size(), atoms)
}

/// The cell of nine numbers, an edge after the other.
fn edges(bytes: &[u8], kind: NumberType) -> Option<Cell> {
    let numbers = Numbers::new(bytes, kind, ByteOrder::Big, kind.size(), 9)?;
    let edge = |edge: usize| DVec3::from_array([0, 1, 2].map(|axis| numbers.get(3 * edge + axis)));
    Cell::new([edge(0), edge(1), edge(2)])
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// A frame of two atoms at these positions, with velocities or not.
    fn frame(numbers: &[f64], has_velocities: bool, is_double: bool) -> Vec<u8> {
        let real = |number: &f64| match is_double {
            true => number.to_be_bytes().to_vec(),
            false => (*number as f32).to_be_bytes().to_vec(),
        };
        let reals = |numbers: &[f64]| -> Vec<u8> { numbers.iter().flat_map(real).collect() };
        let size = if is_double { 8 } else { 4 };
        let (x, v) = (size * numbers.len() as i32, if has_velocities { 6 * size } else { 0 });
        let sizes = [0, 0, 9 * size, 0, 0, 0, 0, x, v, 0, 2, 100, 0];
        let header = [[MAGIC, 13, 12].map(i32::to_be_bytes).concat(), VERSION.to_vec()].concat();
        let cell = reals(&[2.0, 0.0, 0.0, 0.0, 3.0, 0.0, 1.0, 0.0, 4.0]);
        let velocities = if has_velocities { reals(&[7.0; 6]) } else { Vec::new() };
        [
            header,
            sizes.map(i32::to_be_bytes).concat(),
            reals(&[0.5, 0.0]),
            cell,
            reals(numbers),
            velocities,
        ]
        .concat()
    }

    const NUMBERS: [f64; 6] = [1.0, 2.0, 3.0, 4.0, 5.0, 6.5];

    fn file() -> Vec<u8> {
        [frame(&NUMBERS, false, false), frame(&[], true, false), frame(&NUMBERS, true, true)]
            .concat()
    }

    fn read(bytes: &[u8], frame: usize) -> Result<(Table, Notes), Flaw> {
        let (spans, mut notes) = (frames(bytes)?, Notes::default());
        let table = table(bytes, &spans[frame], &Request::default(), &mut notes)?;
        Ok((table, notes))
    }

    #[test]
    fn frames_of_both_precisions_are_read() {
        let bytes = file();
        assert!(recognizes(&bytes));
        assert_eq!(frames(&bytes).expect("legal").len(), 2);
        for frame in 0..2 {
            let (table, notes) = read(&bytes, frame).expect("legal");
            assert_eq!(table.positions, [DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 5.0, 6.5)]);
            assert_eq!(table.cell.expect("a box").edges[2], DVec3::new(1.0, 0.0, 4.0));
            assert_eq!(table.columns.len(), 3 * frame);
            assert!(notes.iter().any(|note| note.text == "1 frame without positions"));
        }
    }

    #[test]
    fn refusals_say_where() {
        let bytes = file();
        let flaw = |bytes: &[u8]| read(bytes, 0).expect_err("refused");
        let cut = flaw(&bytes[..bytes.len() - 1]);
        assert!(
            cut.problem.starts_with("needed 168 bytes of frame 2, counted from 0, found"),
            "{cut:?}"
        );
        let mut other = bytes.clone();
        let second = frame(&NUMBERS, false, false).len();
        other[second + 3] = 0;
        assert_eq!(flaw(&other).location.byte, Some(second));
        let mut other = bytes;
        other[24 + 4 * 10 + 3] = 3;
        assert!(
            flaw(&other)
                .problem
                .contains("for each of 3 atoms and nine for the box, found 24, 0, 0")
        );
    }

    proptest! {
        #[test]
        fn no_mutated_file_panics(at: prop::sample::Index, byte: u8, cut: prop::sample::Index) {
            let mut bytes = file();
            let cut = cut.index(bytes.len());
            let at = at.index(bytes.len());
            bytes[at] = byte;
            for bytes in [&bytes[..], &bytes[..cut]] {
                if let Ok(spans) = frames(bytes) {
                    (0..spans.len()).for_each(|frame| drop(read(bytes, frame)));
                }
            }
        }
    }
}
