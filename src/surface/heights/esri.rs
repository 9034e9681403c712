//! ESRI ASCII grids: a header of keys and numbers, then the heights from the largest y down.
//!
//! ```text
//!   ncols 3          xllcorner is the left side of the first cell, xllcenter its center. GDAL
//!   nrows 2          writes dx and dy in place of cellsize for cells that are not square.
//!   xllcorner 10
//!   yllcorner 20     Samples are at the centers of cells.
//!   cellsize 2
//!   NODATA_value -9999
//!   4 5 6
//!   1 2 3
//! ```
//!
//! Source: "Esri ASCII raster format", ArcGIS documentation; GDAL's AAIGrid driver for dx, dy.

use rustc_hash::FxHashMap;

use super::raster::{NoData, Raster};
use super::{HeightError, size};
use crate::surface::cells::{Cell, Numbers, Separator, lines};
use crate::surface::grid::{MAX_SAMPLES, evenly};

/// Every key of a header, in lower case.
const KEYS: [&str; 10] = [
    "ncols",
    "nrows",
    "xllcorner",
    "xllcenter",
    "yllcorner",
    "yllcenter",
    "cellsize",
    "dx",
    "dy",
    "nodata_value",
];

/// The value for "no data" unless the header gives one.
const USUAL_NODATA: f64 = -9999.0;

fn key(word: &str) -> Option<&'static str> {
    KEYS.into_iter().find(|key| key.eq_ignore_ascii_case(word))
}

/// Whether a text begins with a key of a header that is followed by a number.
pub(super) fn has_header(text: &str) -> bool {
    let mut words = lines(text).flat_map(|(_, line)| line.split_whitespace());
    words.next().is_some_and(|word| key(word).is_some())
        && words.next().is_some_and(|word| {
            matches!(Numbers::default().read(word), Ok(Cell::Number(_) | Cell::Missing))
        })
}

pub(super) fn read(text: &str, nodata: Option<f64>) -> Result<Raster, HeightError> {
    let wrong = |what: String| HeightError::Esri(what);
    let mut words = lines(text)
        .flat_map(|(line, text)| Separator::Blanks.cells(text).map(move |word| (line, word)))
        .peekable();
    let mut numbers = Numbers::default();
    let mut read = |line: usize, word: &str| match numbers.read(word) {
        Ok(Cell::Number(number)) => Ok(number),
        Ok(Cell::Missing) => Ok(f64::NAN),
        Ok(Cell::Word) => Err(wrong(format!("line {line}: `{word:.40}` is not a number"))),
        Err(_) => Err(wrong(format!(
            "line {line}: `{word:.40}` mixes decimal points and decimal commas with the numbers \
             before it"
        ))),
    };
    let mut header = FxHashMap::default();
    while let Some(&(line, word)) = words.peek() {
        let Some(key) = key(word) else { break };
        words.next();
        let value = words.next().map(|(line, word)| read(line, word)).transpose()?;
        let value = value.ok_or_else(|| wrong(format!("line {line}: `{word}` has no value")))?;
        if header.insert(key, value).is_some() {
            return Err(wrong(format!("line {line}: `{word}` is given twice")));
        }
    }
    if let Some(&(line, word)) = words.peek()
        && matches!(Numbers::default().read(word), Ok(Cell::Word))
    {
        return Err(wrong(format!(
            "line {line}: `{word:.40}` is neither a number nor one of the header keys {}",
            KEYS.join(", ")
        )));
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
    let start = |center: &str, corner: &str, step: f64| {
        let at_corner = || header.get(corner).map(|corner| corner + step / 2.0);
        header.get(center).copied().or_else(at_corner).unwrap_or(0.0)
    };
    let (x, y) = (start("xllcenter", "xllcorner", dx), start("yllcenter", "yllcorner", dy));
    let named = header.get("nodata_value").copied().unwrap_or(USUAL_NODATA);
    let nodata = NoData::new(nodata, Some(named));
    let mut heights = Vec::new();
    for (line, word) in words {
        heights.push(nodata.height(read(line, word)?));
    }
    if heights.len() != expected {
        return Err(wrong(format!("{} heights for {columns} × {rows} cells", heights.len())));
    }
    let last = |from: f64, step: f64, n: usize| from + step * (n - 1) as f64;
    let mut raster = Raster::new(columns, rows, heights);
    raster.flip();
    raster.xs = Some(evenly(x, last(x, dx, columns), columns));
    raster.ys = Some(evenly(y, last(y, dy, rows), rows));
    Ok(raster)
}
