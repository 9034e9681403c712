//! Grids of heights in files of other programs: ESRI ASCII grid, NPY, PNG and TIFF.

use thiserror::Error;

use super::csv::{CsvError, Placement, read_csv};
use super::grid::{Grid, GridError, MAX_SAMPLES, evenly};
use crate::read::FeatureOff;

/// Why a file gives no grid of heights.
#[derive(Debug, Error)]
pub enum HeightFileError {
    /// Rows of numbers that are wrong.
    #[error(transparent)]
    Csv(#[from] CsvError),
    /// Numbers that make no grid.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// Neither a known signature nor text.
    #[error("not a text of numbers, an ESRI ASCII grid, an NPY file, a PNG or a TIFF")]
    Unknown,
    /// A header of an ESRI ASCII grid that is wrong.
    #[error("ESRI ASCII grid: {0}")]
    Esri(String),
    /// An NPY file that is wrong or of a kind that is not read.
    #[error("NPY: {0}")]
    Npy(&'static str),
    /// A PNG that cannot be decoded.
    #[cfg(feature = "png")]
    #[error("PNG: {0}")]
    Png(#[from] png::DecodingError),
    /// A TIFF that cannot be decoded.
    #[cfg(feature = "tiff")]
    #[error("TIFF: {0}")]
    Tiff(#[from] tiff::TiffError),
    /// The format is left out of this build.
    #[error(transparent)]
    FeatureOff(#[from] FeatureOff),
    /// A picture without one channel of gray.
    #[error("a height map must be a gray picture; this one has colors")]
    Colors,
}

/// Reads a grid of heights, its format found by its content.
///
/// | format | rows | placed at |
/// |---|---|---|
/// | text | first is the smallest y | its own coordinates, if any |
/// | ESRI ASCII grid | first is the largest y | its corner and cell size; NODATA is a hole |
/// | NPY, two axes | first is the smallest y | 0 to n − 1 |
/// | PNG, gray | first is the largest y | 0 to n − 1; black is 0, white 1 |
/// | TIFF, gray, whole numbers | first is the largest y | the same, if they have no sign |
/// | TIFF, gray, floats | first is the largest y | 0 to n − 1; the heights are as they are |
///
/// `placement` overrides where the lines stand, and its flip turns the order of the rows over.
///
/// # Errors
/// See [`HeightFileError`].
pub fn read_heights(bytes: &[u8], placement: Placement) -> Result<Grid, HeightFileError> {
    if bytes.starts_with(b"\x89PNG") {
        return read_png(bytes)?.place(placement);
    }
    if bytes.starts_with(b"II*\0") || bytes.starts_with(b"MM\0*") {
        return read_tiff(bytes)?.place(placement);
    }
    if bytes.starts_with(b"\x93NUMPY") {
        return read_npy(bytes)?.place(placement);
    }
    let text = std::str::from_utf8(bytes).map_err(|_| HeightFileError::Unknown)?;
    let start = text.trim_start();
    if start.get(..5).is_some_and(|word| word.eq_ignore_ascii_case("ncols")) {
        return read_esri(start)?.place(placement);
    }
    Ok(read_csv(text, placement)?)
}

/// Heights row by row, the row of the smallest y first.
struct Heights {
    columns: usize,
    rows: usize,
    values: Vec<f64>,
    /// First and last x and y, where the file tells.
    extent: Option<[(f64, f64); 2]>,
}

impl Heights {
    fn place(mut self, placement: Placement) -> Result<Grid, HeightFileError> {
        if placement.flip_y {
            self.flip();
        }
        let axis = |name: char, given: Option<(f64, f64)>, own: Option<(f64, f64)>, n: usize| {
            let (from, to) = given.or(own).unwrap_or((0.0, n.saturating_sub(1) as f64));
            if n > 1 && from.partial_cmp(&to) != Some(std::cmp::Ordering::Less) {
                return Err(GridError::Range { axis: name, from, to });
            }
            Ok(evenly(from, to, n))
        };
        let xs = axis('x', placement.x, self.extent.map(|e| e[0]), self.columns)?;
        let ys = axis('y', placement.y, self.extent.map(|e| e[1]), self.rows)?;
        Ok(Grid::new(xs, ys, self.values)?)
    }

    fn flip(&mut self) {
        if self.columns > 0 {
            self.values = self.values.chunks(self.columns).rev().flatten().copied().collect();
        }
    }
}

fn size(columns: usize, rows: usize) -> Result<usize, GridError> {
    let count = columns.checked_mul(rows).filter(|n| *n <= MAX_SAMPLES);
    count.ok_or(GridError::TooMany { x: columns, y: rows })
}

fn read_esri(text: &str) -> Result<Heights, HeightFileError> {
    let wrong = |what: String| HeightFileError::Esri(what);
    let mut words = text.split_whitespace().peekable();
    let mut header = rustc_hash::FxHashMap::default();
    while let Some(name) = words.next_if(|word| word.starts_with(|c: char| c.is_alphabetic())) {
        // `nan` may be the first height.
        let name = name.to_ascii_lowercase();
        let value = words.next().and_then(|word| fast_float2::parse::<f64, _>(word).ok());
        let value = value.ok_or_else(|| wrong(format!("`{name}` is not followed by a number")))?;
        header.insert(name, value);
        if header.len() > 8 {
            return Err(wrong("too long a header".into()));
        }
    }
    let count = |name: &str| match header.get(name) {
        Some(n) if *n >= 1.0 && n.fract() == 0.0 && *n <= MAX_SAMPLES as f64 => Ok(*n as usize),
        Some(n) => Err(wrong(format!("`{name}` is {n}"))),
        None => Err(wrong(format!("`{name}` is missing"))),
    };
    let (columns, rows) = (count("ncols")?, count("nrows")?);
    let expected = size(columns, rows)?;
    let cell = header.get("cellsize").copied();
    let step = |name: &str| {
        let step = header.get(name).copied().or(cell);
        step.filter(|step| *step > 0.0 && step.is_finite())
            .ok_or_else(|| wrong("`cellsize` is missing or not above 0".into()))
    };
    let (dx, dy) = (step("dx")?, step("dy")?);
    // A corner is half a cell away from the first sample.
    let start = |center: &str, corner: &str, step: f64| {
        let at_corner = || header.get(corner).map(|corner| corner + step / 2.0);
        header.get(center).copied().or_else(at_corner).unwrap_or(0.0)
    };
    let (x, y) = (start("xllcenter", "xllcorner", dx), start("yllcenter", "yllcorner", dy));
    let hole = header.get("nodata_value").copied().unwrap_or(-9999.0);
    let mut values = Vec::new();
    for word in words {
        let z = fast_float2::parse::<f64, _>(word)
            .map_err(|_| wrong(format!("`{:.40}` is not a number", word)))?;
        values.push(if z == hole { f64::NAN } else { z });
    }
    if values.len() != expected {
        return Err(wrong(format!("{} heights for {columns} × {rows} cells", values.len())));
    }
    let last = |from: f64, step: f64, n: usize| from + step * n.saturating_sub(1) as f64;
    let extent = Some([(x, last(x, dx, columns)), (y, last(y, dy, rows))]);
    let mut heights = Heights { columns, rows, values, extent };
    heights.flip();
    Ok(heights)
}

fn read_npy(bytes: &[u8]) -> Result<Heights, HeightFileError> {
    let wrong = HeightFileError::Npy;
    let cut_off = || wrong("the file ends early");
    let byte = |k: usize| bytes.get(k).copied().map(usize::from).ok_or_else(cut_off);
    let (length, start) = match byte(6)? {
        1 => (byte(8)? | byte(9)? << 8, 10),
        2 | 3 => (byte(8)? | byte(9)? << 8 | byte(10)? << 16 | byte(11)? << 24, 12),
        _ => return Err(wrong("unknown version")),
    };
    let header = bytes.get(start..start + length).ok_or_else(cut_off)?;
    let header = std::str::from_utf8(header).map_err(|_| wrong("the header is no text"))?;
    let after =
        |key: &str| header.split_once(key).map(|(_, rest)| rest.trim_start_matches([' ', ':']));
    let kind = after("'descr'").and_then(|rest| rest.split('\'').nth(1));
    let kind = kind.ok_or(wrong("only plain numbers are read"))?;
    let columns_first = after("'fortran_order'").is_some_and(|rest| rest.starts_with("True"));
    let shape: Vec<usize> = after("'shape'")
        .and_then(|rest| rest.strip_prefix('(')?.split_once(')'))
        .map(|(list, _)| list.split(',').filter_map(|n| n.trim().parse().ok()).collect())
        .unwrap_or_default();
    let &[rows, columns] = &shape[..] else {
        return Err(wrong("the array must have two axes"));
    };
    let count = size(columns, rows)?;
    let data = &bytes[start + length..];
    let (order, number) = kind.split_at_checked(1).ok_or(wrong("no type of numbers"))?;
    let little = match order {
        "<" | "|" => true,
        ">" => false,
        _ => return Err(wrong("unknown order of bytes")),
    };
    let values = match number {
        "f8" => numbers(data, count, little, f64::from_le_bytes),
        "f4" => numbers(data, count, little, |b| f64::from(f32::from_le_bytes(b))),
        "i1" => numbers(data, count, little, |b| f64::from(i8::from_le_bytes(b))),
        "u1" => numbers(data, count, little, |b| f64::from(u8::from_le_bytes(b))),
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
    Ok(Heights { columns, rows, values, extent: None })
}

/// `count` numbers of `N` bytes each; `None` when there are too few bytes.
fn numbers<const N: usize>(
    data: &[u8],
    count: usize,
    little: bool,
    number: impl Fn([u8; N]) -> f64,
) -> Option<Vec<f64>> {
    let data = data.get(..count.checked_mul(N)?)?;
    let read = |bytes: &[u8]| {
        let mut bytes: [u8; N] = bytes.try_into().unwrap_or([0; N]);
        if !little {
            bytes.reverse();
        }
        number(bytes)
    };
    Some(data.chunks_exact(N).map(read).collect())
}

#[cfg(not(feature = "png"))]
fn read_png(_: &[u8]) -> Result<Heights, HeightFileError> {
    Err(FeatureOff { format: "PNG", feature: "png" }.into())
}

#[cfg(feature = "png")]
fn read_png(bytes: &[u8]) -> Result<Heights, HeightFileError> {
    let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info()?;
    let info = reader.info();
    let (columns, rows) = (info.width as usize, info.height as usize);
    let count = size(columns, rows)?;
    let channels = match reader.output_color_type().0 {
        png::ColorType::Grayscale => 1,
        png::ColorType::GrayscaleAlpha => 2,
        _ => return Err(HeightFileError::Colors),
    };
    let is_wide = reader.output_color_type().1 == png::BitDepth::Sixteen;
    let n_bytes = count * channels * if is_wide { 2 } else { 1 };
    let mut pixels = vec![0; reader.output_buffer_size().unwrap_or(n_bytes).max(n_bytes)];
    reader.next_frame(&mut pixels)?;
    let values = if is_wide {
        let gray = |p: &[u8]| f64::from(u16::from_be_bytes([p[0], p[1]])) / f64::from(u16::MAX);
        pixels[..n_bytes].chunks_exact(2 * channels).map(gray).collect()
    } else {
        pixels[..n_bytes].chunks_exact(channels).map(|p| f64::from(p[0]) / 255.0).collect()
    };
    let mut heights = Heights { columns, rows, values, extent: None };
    heights.flip();
    Ok(heights)
}

#[cfg(not(feature = "tiff"))]
fn read_tiff(_: &[u8]) -> Result<Heights, HeightFileError> {
    Err(FeatureOff { format: "TIFF", feature: "tiff" }.into())
}

#[cfg(feature = "tiff")]
fn read_tiff(bytes: &[u8]) -> Result<Heights, HeightFileError> {
    use tiff::decoder::{Decoder, DecodingResult};
    let mut decoder = Decoder::new(std::io::Cursor::new(bytes))?;
    let (columns, rows) = decoder.dimensions()?;
    let (columns, rows) = (columns as usize, rows as usize);
    size(columns, rows)?;
    if !matches!(decoder.colortype()?, tiff::ColorType::Gray(_)) {
        return Err(HeightFileError::Colors);
    }
    fn heights<T: Copy + Into<f64>>(values: &[T], white: f64) -> Vec<f64> {
        values.iter().map(|&z| z.into() / white).collect()
    }
    let values = match decoder.read_image()? {
        DecodingResult::U8(z) => heights(&z, f64::from(u8::MAX)),
        DecodingResult::U16(z) => heights(&z, f64::from(u16::MAX)),
        DecodingResult::U32(z) => heights(&z, f64::from(u32::MAX)),
        DecodingResult::I8(z) => heights(&z, 1.0),
        DecodingResult::I16(z) => heights(&z, 1.0),
        DecodingResult::I32(z) => heights(&z, 1.0),
        DecodingResult::F32(z) => heights(&z, 1.0),
        DecodingResult::F64(z) => heights(&z, 1.0),
        _ => {
            let kind = tiff::TiffUnsupportedError::UnknownInterpretation;
            return Err(tiff::TiffError::UnsupportedError(kind).into());
        }
    };
    let mut heights = Heights { columns, rows, values, extent: None };
    heights.flip();
    Ok(heights)
}

#[cfg(all(test, not(any(feature = "ply", feature = "png", feature = "tiff"))))]
mod tests {
    use super::*;
    use crate::read::{Fault, read_bytes};

    #[test]
    fn a_format_left_out_of_the_build_is_refused_by_its_feature() {
        let error = read_bytes("a.ply", b"ply\nformat ascii 1.0\n", None).unwrap_err();
        assert!(matches!(error.fault, Fault::FeatureOff(off) if off.feature == "ply"));
        let message = "a.ply: this build cannot read PLY; build it with the feature `ply`";
        assert_eq!(error.to_string(), message);
        for (bytes, feature) in [(&b"\x89PNG\r\n"[..], "png"), (b"II*\0", "tiff")] {
            let error = read_heights(bytes, Placement::default()).unwrap_err();
            assert!(matches!(error, HeightFileError::FeatureOff(off) if off.feature == feature));
        }
    }
}
