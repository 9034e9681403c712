//! Height fields from files: rows of numbers, ESRI ASCII grids, NumPy arrays, gray pictures.
//!
//! ```text
//!   bytes ─► format, by content ─► raster: rows from the smallest y up, holes NaN ─► grid
//! ```

mod esri;
mod npy;
#[cfg(feature = "npz")]
mod npz;
#[cfg(feature = "png")]
mod png;
mod raster;
mod rows;
#[cfg(feature = "tiff")]
mod tiff;

use thiserror::Error;

use super::cells::has_thousands;
use super::grid::{Grid, GridError, MAX_SAMPLES};
use crate::read::FeatureOff;

/// How the samples of a height file are placed, and which of its heights are holes.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct HeightOptions {
    /// x of the first and the last column, in place of the file's own.
    pub x: Option<(f64, f64)>,
    /// y of the first and the last row from the smallest y up, in place of the file's own.
    pub y: Option<(f64, f64)>,
    /// Reverses the order of the rows. It has no effect on a file that gives the y of each row.
    pub flip_y: bool,
    /// This height, as written in the file, is a hole, in addition to the one that the file itself names.
    /// For heights of single precision it is rounded to single precision first.
    pub nodata: Option<f64>,
}

impl HeightOptions {
    /// x of the first and the last column.
    #[must_use]
    pub fn x(self, first: f64, last: f64) -> Self {
        Self { x: Some((first, last)), ..self }
    }

    /// y of the first and the last row, from the smallest y up.
    #[must_use]
    pub fn y(self, first: f64, last: f64) -> Self {
        Self { y: Some((first, last)), ..self }
    }

    /// The first row of the file has the largest y.
    #[must_use]
    pub fn flip_y(self) -> Self {
        Self { flip_y: true, ..self }
    }

    /// This height, as written in the file, is a hole.
    #[must_use]
    pub fn nodata(self, height: f64) -> Self {
        Self { nodata: Some(height), ..self }
    }
}

/// A height field as read.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightField {
    /// The samples.
    pub grid: Grid,
    /// Notes about the file.
    pub notes: Vec<HeightNote>,
}

/// What was skipped in a height file, or looks wrong in it.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum HeightNote {
    /// Lines before the first row of numbers.
    #[error("{} before the first row of numbers {}", counted(*.0), skipped(*.0))]
    TitlesSkipped(usize),
    /// Three columns that are probably x, y and z of one point per line.
    #[error("the {rows} rows of 3 numbers look like the points x y z, one on each line")]
    LooksLikePoints {
        /// How many rows there are.
        rows: usize,
    },
    /// Arrays of an NPZ file that are neither heights nor coordinates.
    #[error("only the heights in the array `{used}` are read, not {}", list(.others))]
    ArraysSkipped {
        /// The name of the array of heights.
        used: String,
        /// The names of the others.
        others: Vec<String>,
    },
}

fn counted(n: usize) -> String {
    if n == 1 { "1 line".to_owned() } else { format!("{n} lines") }
}

fn skipped(n: usize) -> &'static str {
    if n == 1 { "was skipped" } else { "were skipped" }
}

/// What to do about separators between thousands.
fn thousands(cell: &str) -> &'static str {
    if has_thousands(cell) { "; numbers have no separators between thousands" } else { "" }
}

/// What a decoder says, in other words where it speaks of its buffers.
#[cfg(any(feature = "png", feature = "tiff"))]
fn of_picture(error: &str) -> &str {
    match error {
        "failed to fill whole buffer" | "unexpected end of file" => "the file ends too early",
        _ => error,
    }
}

fn list(names: &[String]) -> String {
    let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    names.join(", ")
}

/// Why a file cannot be read as a height field. Lines and cells count from 1.
#[derive(Debug, Error)]
pub enum HeightError {
    /// Neither a known signature nor text.
    #[error("not rows of numbers, an ESRI ASCII grid, NPY, NPZ, PNG or TIFF")]
    UnknownFormat,
    /// A text without numbers.
    #[error("no heights in the file")]
    Empty,
    /// A row that is longer or shorter than the first.
    #[error("line {line}: {found} cells, but the first row has {expected}")]
    RowLength {
        /// In the file.
        line: usize,
        /// Cells on this line.
        found: usize,
        /// Cells on the first.
        expected: usize,
    },
    /// A cell that is not a number.
    #[error("line {line}, cell {cell}: `{text}` is not a number{}", thousands(.text))]
    NotANumber {
        /// In the file.
        line: usize,
        /// In the row.
        cell: usize,
        /// As written, shortened.
        text: String,
    },
    /// Decimal points and decimal commas in one file.
    #[error(
        "line {line}, cell {cell}: `{text}` mixes decimal points and decimal commas with the \
         numbers before it"
    )]
    MixedDecimals {
        /// In the file.
        line: usize,
        /// In the row.
        cell: usize,
        /// As written, shortened.
        text: String,
    },
    /// The header of an ESRI ASCII grid is wrong.
    #[error("ESRI ASCII grid: {0}")]
    Esri(String),
    /// An NPY file is damaged, or its kind of array is not supported.
    #[error("NPY: {0}")]
    Npy(&'static str),
    /// An NPZ file is damaged.
    #[cfg(feature = "npz")]
    #[error("NPZ: {0}")]
    Zip(#[from] zip::result::ZipError),
    /// An NPZ file cannot be unpacked.
    #[cfg(feature = "npz")]
    #[error("NPZ: {0}")]
    Unpack(#[from] std::io::Error),
    /// An NPZ file whose arrays do not form a height field.
    #[cfg(feature = "npz")]
    #[error("NPZ: {0}")]
    Npz(String),
    /// A PNG that cannot be decoded.
    #[cfg(feature = "png")]
    #[error("PNG: {}", of_picture(&.0.to_string()))]
    Png(#[from] ::png::DecodingError),
    /// A TIFF that cannot be decoded.
    #[cfg(feature = "tiff")]
    #[error("TIFF: {}", of_picture(&.0.to_string()))]
    Tiff(#[from] ::tiff::TiffError),
    /// The format is not in this build.
    #[error(transparent)]
    FeatureOff(#[from] FeatureOff),
    /// A picture with more than one channel.
    #[error("a height map must be a gray picture; this one is in color")]
    Colors,
    /// Numbers that do not form a grid.
    #[error(transparent)]
    Grid(#[from] GridError),
}

/// Reads a height field. The format is recognized by content.
///
/// | format | first row | placed at | holes |
/// |---|---|---|---|
/// | rows of numbers | smallest y | its own coordinates, if any | empty, `nan`, `null`, `-` … |
/// | ESRI ASCII grid | largest y | its corner and cell size | the same; `NODATA_value` |
/// | NPY, NPZ | smallest y | 0 to n − 1; the arrays `x` and `y` of an NPZ | NaN |
/// | PNG, gray | largest y | 0 to n − 1; black is 0, white 1 | |
/// | TIFF, gray, unsigned | largest y | the same | `GDAL_NODATA` |
/// | TIFF, gray, signed or float | largest y | 0 to n − 1; heights as stored | NaN, `GDAL_NODATA` |
///
/// Takes O(bytes) time and memory; for packed files O(unpacked samples), of which there are at most
/// [`MAX_SAMPLES`].
///
/// # Errors
/// See [`HeightError`].
pub fn read_heights(bytes: &[u8], options: &HeightOptions) -> Result<HeightField, HeightError> {
    let mut notes = Vec::new();
    let nodata = options.nodata;
    let starts_with = |marks: &[&[u8]]| marks.iter().any(|mark| bytes.starts_with(mark));
    let raster = if starts_with(&[b"\x89PNG"]) {
        #[cfg(not(feature = "png"))]
        return Err(FeatureOff { format: "PNG", feature: "png" }.into());
        #[cfg(feature = "png")]
        png::read(bytes, nodata)?
    } else if starts_with(&[b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"]) {
        #[cfg(not(feature = "tiff"))]
        return Err(FeatureOff { format: "TIFF", feature: "tiff" }.into());
        #[cfg(feature = "tiff")]
        tiff::read(bytes, nodata)?
    } else if starts_with(&[b"PK\x03\x04", b"PK\x05\x06"]) {
        #[cfg(not(feature = "npz"))]
        return Err(FeatureOff { format: "NPZ", feature: "npz" }.into());
        #[cfg(feature = "npz")]
        npz::read(bytes, nodata, &mut notes)?
    } else if starts_with(&[b"\x93NUMPY"]) {
        npy::read(bytes, nodata)?
    } else {
        let text = decoded(bytes).ok_or(HeightError::UnknownFormat)?;
        if esri::has_header(&text) {
            esri::read(&text, nodata)?
        } else {
            rows::read(&text, nodata, &mut notes)?
        }
    };
    Ok(HeightField { grid: raster.place(options)?, notes })
}

/// The text of a file in UTF-8, UTF-16 with a byte order mark, or an encoding that extends ASCII.
fn decoded(bytes: &[u8]) -> Option<std::borrow::Cow<'_, str>> {
    let utf16 = |word: fn([u8; 2]) -> u16| {
        let (words, rest) = bytes.get(2..)?.as_chunks::<2>();
        let characters = char::decode_utf16(words.iter().map(|pair| word(*pair)));
        let text = characters.collect::<Result<String, _>>().ok().filter(|_| rest.is_empty());
        text.map(std::borrow::Cow::Owned)
    };
    match bytes {
        [0xFF, 0xFE, ..] => utf16(u16::from_le_bytes),
        [0xFE, 0xFF, ..] => utf16(u16::from_be_bytes),
        // Letters beyond ASCII occur in titles and comments only, where they make no difference.
        _ => Some(String::from_utf8_lossy(bytes)).filter(|text| !text.contains('\0')),
    }
}

/// The number of samples of a grid, if that many can be read.
fn size(columns: usize, rows: usize) -> Result<usize, GridError> {
    let count = columns.checked_mul(rows).filter(|n| *n <= MAX_SAMPLES);
    count.ok_or(GridError::TooMany { x: columns, y: rows })
}

#[cfg(all(test, not(any(feature = "npz", feature = "ply", feature = "png", feature = "tiff"))))]
mod tests {
    use super::*;
    use crate::read::{Fault, read_bytes};

    #[test]
    fn a_format_left_out_of_the_build_is_refused_by_its_feature() {
        let error = read_bytes("a.ply", b"ply\nformat ascii 1.0\n", None).unwrap_err();
        assert!(matches!(error.fault, Fault::FeatureOff(off) if off.feature == "ply"));
        let message = "a.ply: this build cannot read PLY; build it with the feature `ply`";
        assert_eq!(error.to_string(), message);
        for (bytes, feature) in
            [(&b"\x89PNG\r\n"[..], "png"), (b"II*\0", "tiff"), (b"PK\x03\x04", "npz")]
        {
            let error = read_heights(bytes, &HeightOptions::default()).unwrap_err();
            assert!(matches!(error, HeightError::FeatureOff(off) if off.feature == feature));
        }
    }
}
