//! XTC of GROMACS: frames of positions in nanometres, rounded to multiples of 1 by a precision and
//! packed to as few bits as they need.
//!
//! # How positions are packed
//! The box of whole numbers that positions become has corners that are written first. Each particle then
//! has three digits, one for each side, which make one number of mixed radix; its bits come most
//! significant first in each byte, but the least significant byte first. A bit behind it says whether a
//! run follows or changes: some particles that are near the one before, as differences from it in a small
//! box. Sizes of small boxes come from a table; a run can make the next one larger or smaller by one. The
//! first of a run and the particle before it are swapped, which makes waters smaller: their oxygen comes
//! between its hydrogens.

use glam::{DVec3, IVec3, UVec3};

use super::{Reader, Request, Span};
use crate::binary::{self, ByteOrder, Cursor, NumberType, Numbers};
use crate::cell::Cell;
use crate::error::Flaw;
use crate::notes::{Notes, counted};
use crate::table::Table;
use crate::units::Unit;

pub(super) const READER: Reader =
    Reader { name: "XTC", endings: &["xtc"], is_text: false, recognizes, frames, table };

/// What a frame begins with: the second where the size of packed positions has 64 bits.
const MAGICS: [i32; 2] = [1995, 2023];

/// So many positions or fewer are not packed.
const UNPACKED: usize = 9;

/// Sides of small boxes, as the format has them: the largest numbers whose cubes fit into as many bits
/// as their index, but for three that are below.
const SIDES: [u32; 73] = [
    0, 0, 0, 0, 0, 0, 0, 0, 0, 8, 10, 12, 16, 20, 25, 32, 40, 50, 64, 80, 101, 128, 161, 203, 256,
    322, 406, 512, 645, 812, 1024, 1290, 1625, 2048, 2580, 3250, 4096, 5060, 6501, 8192, 10321,
    13003, 16384, 20642, 26007, 32768, 41285, 52015, 65536, 82570, 104031, 131072, 165140, 208063,
    262144, 330280, 416127, 524287, 660561, 832255, 1048576, 1321122, 1664510, 2097152, 2642245,
    3329021, 4194304, 5284491, 6658042, 8388607, 10568983, 13316085, 16777216,
];

/// The index of the smallest of them.
const SMALLEST: usize = 9;

fn recognizes(bytes: &[u8]) -> bool {
    let mut cursor = Cursor::new(bytes, 0, ByteOrder::Big);
    // The number of atoms stands there twice.
    cursor.i32("").is_ok_and(|magic| MAGICS.contains(&magic))
        && bytes.len() >= 56
        && bytes[4..8] == bytes[52..56]
}

/// A frame before its positions are unpacked.
struct Frame<'a> {
    atoms: usize,
    cell: Option<Cell>,
    positions: Positions<'a>,
}

enum Positions<'a> {
    Plain(&'a [u8]),
    Packed(Packed<'a>),
}

/// Packed positions.
struct Packed<'a> {
    precision: f64,
    low: IVec3,
    /// How many whole numbers each side of the box has.
    sides: UVec3,
    small: usize,
    bytes: &'a [u8],
}

impl<'a> Frame<'a> {
    fn of(cursor: &mut Cursor<'a>) -> Result<Self, Flaw> {
        let at = cursor.at();
        let magic = cursor.i32("a frame")?;
        if !MAGICS.contains(&magic) {
            let flaw = Flaw::needed("1995 or 2023 at the start of a frame", magic);
            return Err(flaw.at_byte(at));
        }
        let atoms = cursor.count("the number of atoms")?;
        cursor.take(8, "step and time")?;
        let cell = edges(cursor.take(36, "the box")?);
        let at = cursor.at();
        let again = cursor.count("the number of atoms")?;
        if again != atoms {
            let needed = format!("the number of atoms {atoms} again");
            return Err(Flaw::needed(&needed, again).at_byte(at));
        }
        let positions = match atoms <= UNPACKED {
            true => Positions::Plain(cursor.take_all(atoms, 12, "positions")?),
            false => Positions::Packed(Packed::of(cursor, magic == MAGICS[1])?),
        };
        Ok(Self { atoms, cell, positions })
    }
}

/// The cell of nine numbers, an edge after the other.
fn edges(bytes: &[u8]) -> Option<Cell> {
    let numbers = Numbers::new(bytes, NumberType::F32, ByteOrder::Big, 4, 9)?;
    let edge = |edge: usize| DVec3::from_array([0, 1, 2].map(|axis| numbers.get(3 * edge + axis)));
    Cell::new([edge(0), edge(1), edge(2)])
}

impl<'a> Packed<'a> {
    fn of(cursor: &mut Cursor<'a>, has_long_size: bool) -> Result<Self, Flaw> {
        let at = cursor.at();
        let precision = cursor.number(NumberType::F32, "the precision")?;
        if !(precision > 0.0 && precision.is_finite()) {
            return Err(Flaw::needed("a precision above 0", precision).at_byte(at));
        }
        let at = cursor.at();
        let mut corners = [0; 6];
        for corner in &mut corners {
            *corner = cursor.i32("the corners of a box")?;
        }
        let side = |axis: usize| {
            let side = i64::from(corners[3 + axis]) - i64::from(corners[axis]) + 1;
            u32::try_from(side).ok().filter(|side| *side > 0)
        };
        let [Some(x), Some(y), Some(z)] = [0, 1, 2].map(side) else {
            let needed = "a box whose lower corner is below its upper one";
            return Err(Flaw::needed(needed, format_args!("{corners:?}")).at_byte(at));
        };
        let at = cursor.at();
        let small = cursor.count("the size of small boxes")?;
        if !(SMALLEST..SIDES.len()).contains(&small) {
            let needed = format!("a size of small boxes from {SMALLEST} to {}", SIDES.len() - 1);
            return Err(Flaw::needed(&needed, small).at_byte(at));
        }
        if has_long_size {
            cursor.take(4, "the size of positions")?;
        }
        let size = cursor.count("the size of positions")?;
        let bytes = cursor.take(size, "packed positions")?;
        let gap = size.next_multiple_of(4) - size;
        cursor.take(gap, "the gap behind positions")?;
        let low = IVec3::new(corners[0], corners[1], corners[2]);
        Ok(Self { precision, low, sides: UVec3::new(x, y, z), small, bytes })
    }

    /// So many positions.
    fn unpacked(&self, count: usize) -> Result<Vec<DVec3>, Flaw> {
        let mut bits = Bits { bytes: self.bytes, at: 0 };
        let mut positions = Vec::new();
        let large = Sides::of(self.sides);
        let mut small = Small::of(self.small);
        let cut = |found: usize| {
            let needed = format!("{} in packed positions", counted(count, "atom"));
            Flaw::needed(&needed, format_args!("the end of them after {found}"))
        };
        let mut run = 0;
        while positions.len() < count {
            let found = positions.len();
            let next = large.next(&mut bits).zip(bits.next(1));
            let (digits, is_changed) = next.ok_or_else(|| cut(found))?;
            let mut place = wrapped_sum(self.low, digits);
            let mut change = 1;
            if is_changed == 1 {
                let code = bits.next(5).ok_or_else(|| cut(found))?;
                (run, change) = (code / 3, code % 3);
            }
            let is_alone = run == 0;
            for index in 0..run {
                let digits = small.sides.next(&mut bits).ok_or_else(|| cut(positions.len()))?;
                let next = wrapped_sum(place, digits).wrapping_sub(small.half());
                // The first of a run comes before the one that it is measured from.
                positions.push(self.position(next));
                if index == 0 {
                    positions.push(self.position(place));
                }
                place = next;
            }
            if is_alone {
                positions.push(self.position(place));
            }
            small = small.changed(change).ok_or_else(|| {
                Flaw::needed("sizes of small boxes of the format", "one beyond them")
            })?;
        }
        match positions.len() == count {
            true => Ok(positions),
            false => Err(Flaw::needed(&counted(count, "atom"), positions.len())),
        }
    }

    fn position(&self, place: IVec3) -> DVec3 {
        place.as_dvec3() / self.precision
    }
}

/// A position by its steps from another. Sums beyond 32 bits are wrapped, as in GROMACS.
fn wrapped_sum(from: IVec3, steps: UVec3) -> IVec3 {
    from.wrapping_add(steps.as_ivec3())
}

/// The small boxes of runs.
struct Small {
    index: usize,
    sides: Sides,
}

impl Small {
    fn of(index: usize) -> Self {
        Self { index, sides: Sides { sides: UVec3::splat(SIDES[index]), bits: Some(index as u32) } }
    }

    /// Half a side: differences may be below 0.
    fn half(&self) -> IVec3 {
        IVec3::splat((SIDES[self.index] / 2) as i32)
    }

    /// Smaller by one (0), as it is (1), or larger by one (2).
    fn changed(self, change: u32) -> Option<Self> {
        let index = (self.index + change as usize).checked_sub(1)?;
        (SMALLEST..SIDES.len()).contains(&index).then(|| Self::of(index))
    }
}

/// How the whole numbers of a box are written.
struct Sides {
    sides: UVec3,
    /// The bits of the one number that all three make; `None` where each has its own.
    bits: Option<u32>,
}

impl Sides {
    /// A side above this has its own bits.
    const LONGEST: u32 = 0xff_ffff;

    fn of(sides: UVec3) -> Self {
        let product: u128 = sides.to_array().into_iter().map(u128::from).product();
        let bits = (sides.max_element() <= Self::LONGEST).then(|| 128 - product.leading_zeros());
        Self { sides, bits }
    }

    fn next(&self, bits: &mut Bits<'_>) -> Option<UVec3> {
        let [x, y, z] = self.sides.to_array();
        let Some(count) = self.bits else {
            let own = |side: u32| 32 - side.leading_zeros();
            return Some(UVec3::new(bits.next(own(x))?, bits.next(own(y))?, bits.next(own(z))?));
        };
        let number = bits.number(count)?;
        // Most numbers fit into 64 bits, which are divided faster.
        if let Ok(number) = u64::try_from(number) {
            let [y, z] = [y, z].map(u64::from);
            let (rest, last) = (number / z, number % z);
            return Some(UVec3::new((rest / y) as u32, (rest % y) as u32, last as u32));
        }
        let [y, z] = [y, z].map(u128::from);
        let (rest, last) = (number / z, number % z);
        Some(UVec3::new((rest / y) as u32, (rest % y) as u32, last as u32))
    }
}

/// Bits, of which the most significant of a byte comes first.
struct Bits<'a> {
    bytes: &'a [u8],
    /// The bit that comes next.
    at: usize,
}

impl Bits<'_> {
    /// So many, up to 32, as a number.
    fn next(&mut self, count: u32) -> Option<u32> {
        let end = self.at + count as usize;
        if end > 8 * self.bytes.len() {
            return None;
        }
        let rest = &self.bytes[self.at / 8..];
        let eight = rest.first_chunk().copied().unwrap_or_else(|| {
            let mut eight = [0; 8];
            eight[..rest.len()].copy_from_slice(rest);
            eight
        });
        let shifted = u64::from_be_bytes(eight) << (self.at % 8);
        self.at = end;
        Some(if count == 0 { 0 } else { (shifted >> (64 - count)) as u32 })
    }

    /// A number of so many bits, up to 72, whose least significant byte comes first.
    fn number(&mut self, count: u32) -> Option<u128> {
        let (mut number, mut done) = (0, 0);
        while count - done >= 32 {
            number |= u128::from(self.next(32)?.swap_bytes()) << done;
            done += 32;
        }
        while done < count {
            let bits = (count - done).min(8);
            number |= u128::from(self.next(bits)?) << done;
            done += bits;
        }
        Some(number)
    }
}

fn frames(bytes: &[u8]) -> Result<Vec<Span>, Flaw> {
    let mut spans = Vec::new();
    let mut cursor = Cursor::new(bytes, 0, ByteOrder::Big);
    while !cursor.rest().is_empty() {
        let start = cursor.at();
        Frame::of(&mut cursor)?;
        spans.push(Span { bytes: start..cursor.at(), line: 1 });
    }
    Ok(spans)
}

fn table(bytes: &[u8], span: &Span, _: &Request, _: &mut Notes) -> Result<Table, Flaw> {
    let mut cursor = Cursor::new(&bytes[..span.bytes.end], span.bytes.start, ByteOrder::Big);
    let Frame { atoms, cell, positions } = Frame::of(&mut cursor)?;
    let positions = match positions {
        Positions::Plain(bytes) => {
            let axis = |axis: usize| {
                let bytes = bytes.get(4 * axis..).unwrap_or_default();
                Numbers::new(bytes, NumberType::F32, ByteOrder::Big, 12, atoms)
            };
            match [0, 1, 2].map(axis) {
                [Some(x), Some(y), Some(z)] => binary::positions([x, y, z]),
                _ => Ok(Vec::new()),
            }
        }
        Positions::Packed(packed) => packed.unpacked(atoms),
    };
    let positions = positions.map_err(|flaw| flaw.at_byte(span.bytes.start))?;
    Ok(Table { positions, cell, unit: Some(Unit::Nanometre), ..Table::default() })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// A frame with this box around its whole numbers, packed one by one as numbers of so many bits.
    fn frame(magic: i32, corners: [i32; 6], places: &[[u32; 3]], widths: [u32; 3]) -> Vec<u8> {
        let mut text = String::new();
        for place in places {
            for (number, width) in place.iter().zip(widths) {
                text += &format!("{number:0width$b}", width = width as usize);
            }
            text += "0";
        }
        let bytes: Vec<u8> = text
            .as_bytes()
            .chunks(8)
            .map(|eight| eight.iter().rev().fold(0, |byte, bit| byte >> 1 | (bit & 1) << 7))
            .collect();
        let ints = |numbers: &[i32]| -> Vec<u8> {
            numbers.iter().flat_map(|number| number.to_be_bytes()).collect()
        };
        let count = places.len() as i32;
        let cell = [2.0_f32, 0.0, 0.0, 0.0, 3.0, 0.0, 1.0, 0.0, 4.0].map(f32::to_be_bytes).concat();
        let size =
            if magic == 2023 { vec![0, bytes.len() as i32] } else { vec![bytes.len() as i32] };
        let gap = vec![0; bytes.len().next_multiple_of(4) - bytes.len()];
        [
            ints(&[magic, count, 7, 0]),
            cell,
            ints(&[count]),
            100_f32.to_be_bytes().to_vec(),
            ints(&corners),
            ints(&[9]),
            ints(&size),
            bytes,
            gap,
        ]
        .concat()
    }

    fn read(bytes: &[u8], frame: usize) -> Result<Table, Flaw> {
        let spans = frames(bytes)?;
        table(bytes, &spans[frame], &Request::default(), &mut Notes::default())
    }

    /// Ten particles in a box too long for one number.
    fn wide(magic: i32) -> Vec<u8> {
        let places: Vec<[u32; 3]> = (0..10).map(|i| [i, 20_000_000 - i, 3]).collect();
        frame(magic, [-5, 0, 100, 4, 20_000_000, 103], &places, [4, 25, 3])
    }

    #[test]
    fn wide_boxes_have_numbers_of_their_own() {
        for magic in MAGICS {
            let bytes = wide(magic).repeat(2);
            assert!(recognizes(&bytes));
            let table = read(&bytes, 1).expect("legal");
            let expected: Vec<DVec3> = (0..10)
                .map(|i| DVec3::new(f64::from(i - 5), f64::from(20_000_000 - i), 103.0) / 100.0)
                .collect();
            assert_eq!(table.positions, expected);
            assert_eq!(table.cell.expect("a box").edges[2], DVec3::new(1.0, 0.0, 4.0));
        }
    }

    #[test]
    fn few_positions_are_not_packed() {
        let mut bytes = [1995, 1, 7, 0].map(i32::to_be_bytes).concat();
        bytes.extend([0; 36]);
        bytes.extend(1_i32.to_be_bytes());
        bytes.extend([1.0_f32, 2.0, 3.0].map(f32::to_be_bytes).concat());
        let table = read(&bytes, 0).expect("legal");
        assert_eq!(table.positions, [DVec3::new(1.0, 2.0, 3.0)]);
        assert_eq!((table.cell, table.unit), (None, Some(Unit::Nanometre)));
    }

    #[test]
    fn refusals_say_what_was_needed() {
        let bytes = wide(1995);
        let problem = |at: usize, byte: u8| {
            let mut bytes = bytes.clone();
            bytes[at] = byte;
            read(&bytes, 0).expect_err("refused").problem
        };
        assert_eq!(problem(3, 1), "needed 1995 or 2023 at the start of a frame, found 1793");
        assert!(problem(7, 11).contains("needed the number of atoms 11 again, found 10"));
        assert!(problem(56, 255).contains("needed a precision above 0"));
        assert!(problem(60, 127).contains("whose lower corner is below"));
        assert!(problem(87, 8).contains("a size of small boxes from 9 to 72, found 8"));
        let mut short = bytes.clone();
        short[91] = 8;
        let flaw = table(&short, &Span::whole(&short), &Request::default(), &mut Notes::default());
        let needed = "needed 10 atoms in packed positions, found the end of them after 1";
        assert_eq!(flaw.expect_err("refused").problem, needed);
        assert!(problem(91, 255).contains("bytes of packed positions, found the end of the file"));
    }

    proptest! {
        #[test]
        fn no_mutated_file_panics(at: prop::sample::Index, byte: u8, cut: prop::sample::Index) {
            let written = include_bytes!("../../tests/seeds/md.xtc").to_vec();
            for mut bytes in [wide(2023), written] {
                let cut = cut.index(bytes.len());
                let at = at.index(bytes.len());
                bytes[at] = byte;
                for bytes in [&bytes[..], &bytes[..cut]] {
                    let frames = frames(bytes).map_or(0, |spans| spans.len());
                    (0..frames).for_each(|frame| drop(read(bytes, frame)));
                }
            }
        }

        #[test]
        fn no_packed_bits_panic(
            corners: [i32; 6], small in 9_u32..73, bytes: Vec<u8>, count in 10_usize..200,
        ) {
            let side = |axis: usize| (corners[3 + axis].wrapping_sub(corners[axis]) as u32).max(1);
            for sides in [UVec3::new(side(0), side(1), side(2)), UVec3::new(7, 1, 300)] {
                let low = IVec3::from_slice(&corners);
                let packed =
                    Packed { precision: 1e3, low, sides, small: small as usize, bytes: &bytes };
                let _ = packed.unpacked(count);
            }
        }
    }
}
