//! DCD of CHARMM, NAMD, X-PLOR and those like them: frames of positions in ångströms, in records whose
//! length of 32 bits stands before and behind them, of either byte order.

use std::ops::Range;

use super::{Reader, Request, Span};
use crate::binary::{self, ByteOrder, Cursor, NumberType, Numbers};
use crate::cell::Cell;
use crate::error::Flaw;
use crate::notes::{Notes, counted};
use crate::table::Table;
use crate::units::Unit;

pub(super) const READER: Reader =
    Reader { name: "DCD", endings: &["dcd"], is_text: false, recognizes, frames, table };

/// What the first record begins with.
const MAGIC: &[u8] = b"CORD";

/// Bytes of the first record.
const HEADER: i32 = 84;

fn recognizes(bytes: &[u8]) -> bool {
    [4, 8].iter().any(|at| bytes.get(*at..at + 4) == Some(MAGIC)) && order(bytes).is_some()
}

/// The order in which the length of the first record is right.
fn order(bytes: &[u8]) -> Option<ByteOrder> {
    let length = bytes.first_chunk::<4>()?;
    match () {
        () if *length == HEADER.to_le_bytes() => Some(ByteOrder::Little),
        () if *length == HEADER.to_be_bytes() => Some(ByteOrder::Big),
        // The most significant half of a length of 64 bits, as some compilers write it.
        () if *length == [0; 4] && bytes.get(7) == Some(&84) => Some(ByteOrder::Big),
        () => None,
    }
}

/// What stands before the frames.
struct Header {
    order: ByteOrder,
    /// The number of frames that it claims; 0 where its program did not know yet.
    frames: usize,
    atoms: usize,
    has_cell: bool,
    has_fourth: bool,
    /// Where the first frame begins.
    end: usize,
}

impl Header {
    fn of(bytes: &[u8]) -> Result<Self, Flaw> {
        let order =
            order(bytes).ok_or_else(|| Flaw::needed("a first record of 84 bytes", "another"))?;
        if bytes.get(4..8) != Some(MAGIC) {
            return Err(Flaw::needed("lengths of 32 bits before records", "those of 64").at_byte(0));
        }
        let mut cursor = Cursor::new(bytes, 0, order);
        let first = record(&mut cursor, "the header")?;
        let mut numbers = Cursor::new(&bytes[..first.end], first.start + 4, order);
        let mut control = [0; 20];
        for number in &mut control {
            *number = numbers.i32("the header")?;
        }
        // X-PLOR, which has no version there, has neither cells nor a fourth coordinate.
        let is_charmm = control[19] != 0;
        if control[8] != 0 {
            let found = counted(control[8].unsigned_abs() as usize, "fixed atom");
            let flaw = Flaw::needed("all atoms in every frame", found).at_byte(40);
            return Err(flaw.or("write the trajectory again without fixed atoms"));
        }
        record(&mut cursor, "the titles")?;
        let at = cursor.at();
        let third = record(&mut cursor, "the number of atoms")?;
        if third.len() != 4 {
            let flaw = Flaw::needed("a record of 4 bytes with the number of atoms", third.len());
            return Err(flaw.at_byte(at));
        }
        let atoms = Cursor::new(bytes, third.start, order).count("the number of atoms")?;
        Ok(Self {
            order,
            frames: usize::try_from(control[0]).unwrap_or(0),
            atoms,
            has_cell: is_charmm && control[10] != 0,
            has_fourth: is_charmm && control[11] != 0,
            end: cursor.at(),
        })
    }

    /// Bytes of a frame.
    fn frame(&self) -> Option<usize> {
        let axis = self.atoms.checked_mul(4)?.checked_add(8)?;
        let axes = axis.checked_mul(if self.has_fourth { 4 } else { 3 })?;
        axes.checked_add(if self.has_cell { 56 } else { 0 })
    }
}

/// The content of the next record.
fn record(cursor: &mut Cursor<'_>, what: &str) -> Result<Range<usize>, Flaw> {
    let length = cursor.count(&format!("the length of the record with {what}"))?;
    let start = cursor.at();
    cursor.take(length, what)?;
    let at = cursor.at();
    let again = cursor.count(&format!("the length of the record with {what}"))?;
    if again != length {
        let needed = format!("the length {length} again behind the record with {what}");
        return Err(Flaw::needed(&needed, again).at_byte(at));
    }
    Ok(start..start + length)
}

fn frames(bytes: &[u8]) -> Result<Vec<Span>, Flaw> {
    let header = Header::of(bytes)?;
    let (rest, size) = (bytes.len() - header.end, header.frame());
    let size = size.filter(|_| header.atoms > 0);
    let count = size.map_or(0, |size| rest / size);
    let is_whole = size.is_some_and(|size| rest % size == 0);
    // A run that ends early leaves the number of frames that it was to have.
    if !is_whole || (header.frames != 0 && header.frames < count) {
        let frames = match header.frames {
            0 => "whole frames".to_owned(),
            frames => counted(frames, "frame"),
        };
        let needed = format!("{frames} of {} as the header says", counted(header.atoms, "atom"));
        let part = if is_whole { "" } else { " and a part of one" };
        let found = format!("{count}{part} in {}", counted(rest, "byte"));
        return Err(Flaw::needed(&needed, found).at_byte(header.end));
    }
    let size = size.unwrap_or(0);
    let start = |frame: usize| header.end + frame * size;
    Ok((0..count).map(|frame| Span { bytes: start(frame)..start(frame + 1), line: 1 }).collect())
}

fn table(bytes: &[u8], span: &Span, _: &Request, notes: &mut Notes) -> Result<Table, Flaw> {
    let header = Header::of(bytes)?;
    let there = (bytes.len() - header.end) / span.bytes.len().max(1);
    if header.frames > there {
        let said = counted(header.frames, "frame");
        notes.left_out(format!("the header says {said}, and {there} are in the file"));
    }
    let mut cursor = Cursor::new(&bytes[..span.bytes.end], span.bytes.start, header.order);
    let cell = match header.has_cell {
        true => cell(bytes, record(&mut cursor, "the cell")?, header.order),
        false => None,
    };
    let mut axes = Vec::with_capacity(3);
    for axis in ["x", "y", "z"] {
        let at = cursor.at();
        let record = record(&mut cursor, axis)?;
        if record.len() / 4 != header.atoms {
            let needed = format!("{axis} of {}", counted(header.atoms, "atom"));
            return Err(Flaw::needed(&needed, record.len() / 4).at_byte(at));
        }
        axes.extend(Numbers::new(&bytes[record], NumberType::F32, header.order, 4, header.atoms));
    }
    let &[x, y, z] = &axes[..] else { return Ok(Table::default()) };
    let positions = binary::positions([x, y, z]).map_err(|flaw| flaw.at_byte(span.bytes.start))?;
    Ok(Table { positions, cell, unit: Some(Unit::Angstrom), ..Table::default() })
}

/// The cell of `a γ b β α c`, where angles are degrees or, as NAMD writes them, their cosines; or of
/// CHARMM's symmetric matrix `xx xy yy xz yz zz`.
fn cell(bytes: &[u8], record: Range<usize>, order: ByteOrder) -> Option<Cell> {
    let numbers = Numbers::new(&bytes[record], NumberType::F64, order, 8, 6)?.to_vec();
    let &[a, gamma, b, beta, alpha, c] = &numbers[..] else { return None };
    let angles = [alpha, beta, gamma];
    if angles.iter().all(|angle| angle.abs() <= 1.0) {
        // That of 0 is exactly 90.
        let degrees =
            angles.map(|cosine| if cosine == 0.0 { 90.0 } else { cosine.acos().to_degrees() });
        return Cell::of_lengths_and_angles([a, b, c], degrees);
    }
    if angles.iter().all(|angle| (0.0..=180.0).contains(angle)) {
        return Cell::of_lengths_and_angles([a, b, c], angles);
    }
    let [xx, xy, yy, xz, yz, zz] = [a, gamma, b, beta, alpha, c];
    Cell::new([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]].map(glam::DVec3::from_array))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use proptest::prelude::*;

    use super::*;

    /// Two frames of two atoms.
    fn file(order: ByteOrder, claimed: i32, fixed: i32, angle: f64) -> Vec<u8> {
        let turned = |mut bytes: Vec<u8>| {
            if order == ByteOrder::Little {
                bytes.reverse();
            }
            bytes
        };
        let int = |number: i32| turned(number.to_be_bytes().to_vec());
        let float = |number: f32| turned(number.to_be_bytes().to_vec());
        let record = |content: &[u8]| {
            let length = int(content.len() as i32);
            [&length, content, &length].concat()
        };
        let mut control = [0; 20];
        (control[0], control[8], control[10], control[19]) = (claimed, fixed, 1, 24);
        let header = [MAGIC.to_vec(), control.map(int).concat()].concat();
        let titles = [int(1), vec![b' '; 80]].concat();
        let mut bytes = [record(&header), record(&titles), record(&int(2))].concat();
        for shift in [0.0, 0.5] {
            let cell = [10.0, angle, 11.0, angle, angle, 12.0];
            let cell: Vec<u8> =
                cell.iter().flat_map(|n: &f64| turned(n.to_be_bytes().to_vec())).collect();
            bytes.extend(record(&cell));
            for axis in [[1.0, 4.0], [2.0, 5.0], [3.0, 6.0]] {
                bytes.extend(record(&axis.map(|number| float(number + shift)).concat()));
            }
        }
        bytes
    }

    fn read(bytes: &[u8], frame: usize) -> Result<Table, Flaw> {
        let spans = frames(bytes)?;
        table(bytes, &spans[frame], &Request::default(), &mut Notes::default())
    }

    #[test]
    fn frames_of_both_orders_are_read() {
        for order in [ByteOrder::Little, ByteOrder::Big] {
            for (claimed, angle) in [(2, 90.0), (0, 0.0), (5, 90.0)] {
                let bytes = file(order, claimed, 0, angle);
                assert!(recognizes(&bytes));
                assert_eq!(frames(&bytes).expect("legal").len(), 2);
                let table = read(&bytes, 1).expect("legal");
                assert_eq!(table.positions, [DVec3::new(1.5, 2.5, 3.5), DVec3::new(4.5, 5.5, 6.5)]);
                let edges = table.cell.expect("a cell").edges;
                assert_eq!(edges, [10.0 * DVec3::X, 11.0 * DVec3::Y, 12.0 * DVec3::Z]);
            }
        }
    }

    #[test]
    fn tilted_cells_are_angles_or_a_matrix() {
        let edges = |angle| {
            let table = read(&file(ByteOrder::Little, 2, 0, angle), 0).expect("legal");
            table.cell.expect("a cell").edges
        };
        assert!((edges(60.0)[1] - edges(0.5)[1]).length() < 1e-12);
        assert!((edges(60.0)[1] - 11.0 * DVec3::new(0.5, 0.75_f64.sqrt(), 0.0)).length() < 1e-12);
        assert_eq!(edges(-2.0)[1], DVec3::new(-2.0, 11.0, -2.0));
    }

    #[test]
    fn refusals_say_both_numbers() {
        let problem = |bytes: &[u8]| read(bytes, 0).expect_err("refused").problem;
        let bytes = file(ByteOrder::Little, 1, 0, 90.0);
        assert_eq!(
            problem(&bytes),
            "needed 1 frame of 2 atoms as the header says, found 2 in 208 bytes"
        );
        let cut = file(ByteOrder::Little, 2, 0, 90.0);
        let cut = &cut[..cut.len() - 3];
        assert!(problem(cut).ends_with("found 1 and a part of one in 205 bytes"));
        assert!(problem(&file(ByteOrder::Big, 2, 7, 90.0)).contains("found 7 fixed atoms"));
        let long = [&[84, 0, 0, 0, 0, 0, 0, 0][..], MAGIC, &[0; 100]].concat();
        assert!(recognizes(&long));
        assert!(problem(&long).contains("needed lengths of 32 bits"));
    }

    proptest! {
        #[test]
        fn no_mutated_file_panics(at: prop::sample::Index, byte: u8, cut: prop::sample::Index) {
            let mut bytes = file(ByteOrder::Big, 2, 0, 90.0);
            let cut = cut.index(bytes.len());
            let at = at.index(bytes.len());
            bytes[at] = byte;
            for bytes in [&bytes[..], &bytes[..cut]] {
                if let Ok(spans) = frames(bytes) {
                    let all = spans.iter().map(|span| {
                        table(bytes, span, &Request::default(), &mut Notes::default())
                    });
                    let _ = all.collect::<Vec<_>>();
                }
            }
        }
    }
}
