//! Numbers in binary files.

use glam::DVec3;
use rayon::prelude::*;

use crate::error::Flaw;
use crate::notes::counted;

/// A type of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum NumberType {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

/// Which byte of a number comes first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum ByteOrder {
    /// The least significant.
    #[default]
    Little,
    /// The most significant.
    Big,
}

/// Numbers of one type at equal distances.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Numbers<'a> {
    bytes: &'a [u8],
    stride: usize,
    count: usize,
    read: fn(&[u8]) -> f64,
}

/// Bytes that are read from front to back.
#[derive(Debug, Clone)]
pub(crate) struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
    pub(crate) order: ByteOrder,
}

/// Numbers that a thread reads before it takes more.
const CHUNK: usize = 1 << 14;

impl NumberType {
    /// Bytes of one.
    pub(crate) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// What reads the one that bytes begin with.
    fn reader(self, order: ByteOrder) -> fn(&[u8]) -> f64 {
        macro_rules! reader {
            ($number:ty) => {
                match order {
                    ByteOrder::Little => |bytes| <$number>::from_le_bytes(first(bytes)) as f64,
                    ByteOrder::Big => |bytes| <$number>::from_be_bytes(first(bytes)) as f64,
                }
            };
        }
        match self {
            Self::I8 => reader!(i8),
            Self::U8 => reader!(u8),
            Self::I16 => reader!(i16),
            Self::U16 => reader!(u16),
            Self::I32 => reader!(i32),
            Self::U32 => reader!(u32),
            Self::I64 => reader!(i64),
            Self::U64 => reader!(u64),
            Self::F32 => reader!(f32),
            Self::F64 => reader!(f64),
        }
    }
}

/// The first bytes of more: [`Numbers::new`] and [`Cursor::take`] see to it that they are there.
fn first<const COUNT: usize>(bytes: &[u8]) -> [u8; COUNT] {
    *bytes.first_chunk().expect("the bytes of a number")
}

impl<'a> Numbers<'a> {
    /// So many numbers, the first where the bytes begin and the others `stride` bytes after each other;
    /// `None` where the bytes end before the last one does.
    pub(crate) fn new(
        bytes: &'a [u8],
        kind: NumberType,
        order: ByteOrder,
        stride: usize,
        count: usize,
    ) -> Option<Self> {
        let last = count.saturating_sub(1).checked_mul(stride)?;
        let end = if count == 0 { 0 } else { last.checked_add(kind.size())? };
        (end <= bytes.len()).then(|| Self { bytes, stride, count, read: kind.reader(order) })
    }

    /// The number of that index.
    pub(crate) fn get(&self, index: usize) -> f64 {
        (self.read)(&self.bytes[index * self.stride..])
    }

    /// All of them.
    pub(crate) fn to_vec(self) -> Vec<f64> {
        let indices = (0..self.count).into_par_iter().with_min_len(CHUNK);
        indices.map(|index| self.get(index)).collect()
    }
}

/// Positions of their coordinates, of which there are equally many.
pub(crate) fn positions(coordinates: [Numbers<'_>; 3]) -> Result<Vec<DVec3>, Flaw> {
    let indices = (0..coordinates[0].count).into_par_iter().with_min_len(CHUNK);
    let positions =
        indices.map(|index| DVec3::from_array(coordinates.map(|numbers| numbers.get(index))));
    finite(positions.collect())
}

/// The positions, refused if one has a coordinate that is no finite number.
pub(crate) fn finite(positions: Vec<DVec3>) -> Result<Vec<DVec3>, Flaw> {
    match positions.par_iter().position_first(|position| !position.is_finite()) {
        None => Ok(positions),
        Some(index) => {
            let needed = format!("finite coordinates of particle {index}, counted from 0");
            Err(Flaw::needed(&needed, positions[index]))
        }
    }
}

impl<'a> Cursor<'a> {
    /// From a byte on.
    pub(crate) fn new(bytes: &'a [u8], at: usize, order: ByteOrder) -> Self {
        Self { bytes, at, order }
    }

    /// The byte that comes next.
    pub(crate) fn at(&self) -> usize {
        self.at
    }

    /// What is left.
    pub(crate) fn rest(&self) -> &'a [u8] {
        self.bytes.get(self.at..).unwrap_or_default()
    }

    /// So many bytes of something.
    pub(crate) fn take(&mut self, count: usize, what: &str) -> Result<&'a [u8], Flaw> {
        let rest = self.rest();
        let Some(taken) = rest.get(..count) else {
            let needed = format!("{} of {what}", counted(count, "byte"));
            let found = format!("the end of the file after {}", rest.len());
            return Err(Flaw::needed(&needed, found).at_byte(self.at));
        };
        self.at += count;
        Ok(taken)
    }

    /// The bytes of so many numbers of something, each of which has `size` bytes.
    pub(crate) fn take_all(
        &mut self,
        count: usize,
        size: usize,
        what: &str,
    ) -> Result<&'a [u8], Flaw> {
        match count.checked_mul(size) {
            Some(bytes) => self.take(bytes, what),
            None => {
                let needed = format!("{count} times {} of {what}", counted(size, "byte"));
                let found = format!("the end of the file after {}", self.rest().len());
                Err(Flaw::needed(&needed, found).at_byte(self.at))
            }
        }
    }

    /// A number of something.
    pub(crate) fn number(&mut self, kind: NumberType, what: &str) -> Result<f64, Flaw> {
        Ok(kind.reader(self.order)(self.take(kind.size(), what)?))
    }

    /// An integer of 32 bits of something.
    pub(crate) fn i32(&mut self, what: &str) -> Result<i32, Flaw> {
        let bytes = first(self.take(4, what)?);
        Ok(match self.order {
            ByteOrder::Little => i32::from_le_bytes(bytes),
            ByteOrder::Big => i32::from_be_bytes(bytes),
        })
    }

    /// A count of something: an integer of 32 bits from 0 on.
    pub(crate) fn count(&mut self, what: &str) -> Result<usize, Flaw> {
        let at = self.at;
        let count = self.i32(what)?;
        let flaw = |_| Flaw::needed(&format!("{what}, from 0 on"), count).at_byte(at);
        usize::try_from(count).map_err(flaw)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_every_type_and_order_are_read() {
        let read = |bytes: &[u8], kind, order| {
            Numbers::new(bytes, kind, order, kind.size(), 1).map(|numbers| numbers.get(0))
        };
        let (little, big) = (ByteOrder::Little, ByteOrder::Big);
        for (kind, bytes, value) in [
            (NumberType::I8, (-3_i8).to_be_bytes().to_vec(), -3.0),
            (NumberType::U8, vec![253], 253.0),
            (NumberType::I16, (-300_i16).to_be_bytes().to_vec(), -300.0),
            (NumberType::U16, 65_000_u16.to_be_bytes().to_vec(), 65e3),
            (NumberType::I32, (-70_000_i32).to_be_bytes().to_vec(), -7e4),
            (NumberType::U32, 4_000_000_000_u32.to_be_bytes().to_vec(), 4e9),
            (NumberType::I64, (-5_000_000_000_i64).to_be_bytes().to_vec(), -5e9),
            (NumberType::U64, 5_000_000_000_u64.to_be_bytes().to_vec(), 5e9),
            (NumberType::F32, 1.5_f32.to_be_bytes().to_vec(), 1.5),
            (NumberType::F64, 1e300_f64.to_be_bytes().to_vec(), 1e300),
        ] {
            let reversed: Vec<u8> = bytes.iter().rev().copied().collect();
            assert_eq!(read(&bytes, kind, big), Some(value), "{kind:?}");
            assert_eq!(read(&reversed, kind, little), Some(value), "{kind:?}");
        }
    }

    #[test]
    fn numbers_stay_in_their_bytes() {
        let numbers = |stride, count| {
            let numbers =
                Numbers::new(&[1, 0, 2, 0, 3], NumberType::U8, ByteOrder::Little, stride, count);
            numbers.map(Numbers::to_vec)
        };
        assert_eq!(numbers(2, 3), Some(vec![1.0, 2.0, 3.0]));
        assert_eq!(numbers(2, 4), None);
        assert_eq!(numbers(usize::MAX, usize::MAX), None);
        assert_eq!(numbers(2, 0), Some(vec![]));
    }

    #[test]
    fn what_is_cut_off_is_located() {
        let mut cursor = Cursor::new(&[0, 0, 0, 7, 1], 0, ByteOrder::Big);
        assert_eq!(cursor.count("points"), Ok(7));
        let flaw = cursor.i32("cells").expect_err("refused");
        assert_eq!(flaw.location.byte, Some(4));
        assert_eq!(flaw.problem, "needed 4 bytes of cells, found the end of the file after 1");
        assert!(cursor.take_all(usize::MAX, 12, "points").is_err());
        let flaw = finite(vec![DVec3::ZERO, DVec3::NAN]).expect_err("refused");
        assert!(flaw.problem.starts_with("needed finite coordinates of particle 1"));
    }
}
