//! NPY: one array of NumPy, a header in Python's notation and then the numbers.
//!
//! Source: NumPy Enhancement Proposal 1, versions 1.0 to 3.0 of the format.

use super::raster::{NoData, Raster};
use super::{HeightError, size};

/// An array of at most two axes.
pub(super) struct Array {
    /// How many numbers along each axis; axes of length 1 are left out while there are more than 2.
    pub(super) shape: Vec<usize>,
    /// The last axis runs fastest.
    pub(super) values: Vec<f64>,
    /// Whether the numbers are stored in single precision.
    pub(super) is_single: bool,
}

pub(super) fn read(bytes: &[u8], nodata: Option<f64>) -> Result<Raster, HeightError> {
    raster(read_array(bytes)?, nodata)
}

/// The array as heights, the row of the smallest y first.
pub(super) fn raster(array: Array, nodata: Option<f64>) -> Result<Raster, HeightError> {
    let &[rows, columns] = &array.shape[..] else {
        return Err(HeightError::Npy("the array must have two axes"));
    };
    let nodata = NoData::new(nodata, None);
    let nodata = if array.is_single { nodata.in_single_precision() } else { nodata };
    let heights = array.values.into_iter().map(|z| nodata.height(z)).collect();
    Ok(Raster::new(columns, rows, heights))
}

pub(super) fn read_array(bytes: &[u8]) -> Result<Array, HeightError> {
    let wrong = HeightError::Npy;
    let cut_off = || wrong("the file ends early");
    let byte = |k: usize| bytes.get(k).copied().map(usize::from).ok_or_else(cut_off);
    if !bytes.starts_with(b"\x93NUMPY") {
        return Err(wrong("this is not an array"));
    }
    let (length, start) = match byte(6)? {
        1 => (byte(8)? | byte(9)? << 8, 10),
        2 | 3 => (byte(8)? | byte(9)? << 8 | byte(10)? << 16 | byte(11)? << 24, 12),
        _ => return Err(wrong("unknown version")),
    };
    let header = bytes.get(start..start + length).ok_or_else(cut_off)?;
    let header = std::str::from_utf8(header).map_err(|_| wrong("the header is not text"))?;
    let after =
        |key: &str| header.split_once(key).map(|(_, rest)| rest.trim_start_matches([' ', ':']));
    let kind = after("'descr'").filter(|rest| rest.starts_with('\''));
    let kind = kind.and_then(|rest| rest.split('\'').nth(1));
    let kind = kind.ok_or(wrong("only plain numbers are read"))?;
    let columns_first = after("'fortran_order'").is_some_and(|rest| rest.starts_with("True"));
    let mut shape = after("'shape'").and_then(shape).ok_or(wrong("the shape cannot be read"))?;
    while shape.len() > 2
        && let Some(flat) = shape.iter().position(|n| *n == 1)
    {
        shape.remove(flat);
    }
    let (rows, columns) = match shape[..] {
        [] => (1, 1),
        [n] => (1, n),
        [rows, columns] => (rows, columns),
        _ => return Err(wrong("the array must have two axes")),
    };
    let count = size(columns, rows)?;
    let data = &bytes[start + length..];
    let (order, number) = kind.split_at_checked(1).ok_or(wrong("unknown number type"))?;
    let little = match order {
        "<" | "|" => true,
        ">" => false,
        _ => return Err(wrong("unknown byte order")),
    };
    let values = match number {
        "f8" => numbers(data, count, little, f64::from_le_bytes),
        "f4" => numbers(data, count, little, |b| f64::from(f32::from_le_bytes(b))),
        "i1" => numbers(data, count, little, |b| f64::from(i8::from_le_bytes(b))),
        "u1" | "b1" => numbers(data, count, little, |b| f64::from(u8::from_le_bytes(b))),
        "i2" => numbers(data, count, little, |b| f64::from(i16::from_le_bytes(b))),
        "u2" => numbers(data, count, little, |b| f64::from(u16::from_le_bytes(b))),
        "i4" => numbers(data, count, little, |b| f64::from(i32::from_le_bytes(b))),
        "u4" => numbers(data, count, little, |b| f64::from(u32::from_le_bytes(b))),
        "i8" => numbers(data, count, little, |b| i64::from_le_bytes(b) as f64),
        "u8" => numbers(data, count, little, |b| u64::from_le_bytes(b) as f64),
        _ => return Err(wrong("only whole numbers and floats of 32 or 64 bits are read")),
    };
    let mut values = values.ok_or_else(cut_off)?;
    if columns_first {
        let at = |j: usize| (0..columns).map(move |i| i * rows + j);
        values = (0..rows).flat_map(at).map(|k| values[k]).collect();
    }
    Ok(Array { shape, values, is_single: number == "f4" })
}

/// A tuple in Python's notation, such as `(2, 3)` or `(5,)`.
fn shape(text: &str) -> Option<Vec<usize>> {
    let (list, _) = text.strip_prefix('(')?.split_once(')')?;
    let list = list.trim().trim_end_matches(',');
    if list.is_empty() {
        return Some(Vec::new());
    }
    list.split(',').map(|n| n.trim().parse().ok()).collect()
}

/// `count` numbers of `N` bytes each; `None` when there are too few bytes.
fn numbers<const N: usize>(
    data: &[u8],
    count: usize,
    little: bool,
    number: impl Fn([u8; N]) -> f64,
) -> Option<Vec<f64>> {
    let (numbers, _) = data.get(..count.checked_mul(N)?)?.as_chunks::<N>();
    let read = |mut bytes: [u8; N]| {
        if !little {
            bytes.reverse();
        }
        number(bytes)
    };
    Some(numbers.iter().map(|bytes| read(*bytes)).collect())
}
