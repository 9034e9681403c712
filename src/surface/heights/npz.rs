//! NPZ: several arrays of NumPy in a ZIP archive, as `numpy.savez(file, x=…, y=…, z=…)` writes it.

use std::io::{Cursor, Read};

use zip::ZipArchive;

use super::npy::{Array, raster, read_array};
use super::raster::Raster;
use super::{HeightError, HeightNote};
use crate::surface::grid::MAX_SAMPLES;

/// Most arrays of one archive.
const MOST_ARRAYS: usize = 1000;

/// Most bytes that an archive is unpacked to, so that a small file cannot fill the memory: a grid
/// with the most samples in double precision, with coordinates.
const MOST_BYTES: u64 = 8 * MAX_SAMPLES as u64 + (64 << 20);

/// Names for heights, in lower case; `arr_0` is that of the first array without a name.
const HEIGHTS: [&str; 5] = ["z", "heights", "height", "elevation", "arr_0"];

/// Reads the only array with two axes, or the one that is named for heights. Arrays `x` and `y` are
/// the coordinates, as lists or as `numpy.meshgrid` makes them.
pub(super) fn read(
    bytes: &[u8],
    nodata: Option<f64>,
    notes: &mut Vec<HeightNote>,
) -> Result<Raster, HeightError> {
    let wrong = |what: String| HeightError::Npz(what);
    let mut archive = ZipArchive::new(Cursor::new(bytes))?;
    if archive.len() > MOST_ARRAYS {
        return Err(wrong(format!("more than {MOST_ARRAYS} arrays")));
    }
    let mut arrays: Vec<(String, Array)> = Vec::new();
    let mut others = Vec::new();
    let mut left = MOST_BYTES;
    for k in 0..archive.len() {
        let file = archive.by_index(k)?;
        let Some(name) = file.name()?.strip_suffix(".npy").map(str::to_owned) else { continue };
        let mut unpacked = Vec::new();
        file.take(left).read_to_end(&mut unpacked)?;
        left -= unpacked.len() as u64;
        if left == 0 {
            return Err(wrong(format!("more than {MOST_BYTES} bytes when unpacked")));
        }
        match read_array(&unpacked) {
            Ok(array) => arrays.push((name, array)),
            // For example an array of text, which is not needed.
            Err(_) if !is_known(&name) => others.push(name),
            Err(error) => return Err(wrong(format!("array `{name}`: {error}"))),
        }
    }
    let is_coordinate = |name: &str| ["x", "y"].iter().any(|c| name.eq_ignore_ascii_case(c));
    let planes: Vec<&str> = arrays
        .iter()
        .filter(|(name, array)| array.shape.len() == 2 && !is_coordinate(name))
        .map(|(name, _)| &name[..])
        .collect();
    let named = HEIGHTS
        .iter()
        .find_map(|wanted| planes.iter().position(|name| name.eq_ignore_ascii_case(wanted)));
    let used = match (named, &planes[..]) {
        (Some(named), _) => planes[named].to_owned(),
        (None, [only]) => (*only).to_owned(),
        (None, []) => return Err(wrong("no array of numbers has two axes".into())),
        (None, several) => {
            let names = several.join("`, `");
            return Err(wrong(format!(
                "`{names}` have two axes; name the one with the heights `z`"
            )));
        }
    };
    let mut take = |wanted: &str| {
        let at = arrays.iter().position(|(name, _)| name.eq_ignore_ascii_case(wanted))?;
        Some(arrays.swap_remove(at).1)
    };
    let (heights, x, y) = (take(&used), take("x"), take("y"));
    let heights = heights.ok_or_else(|| wrong("no heights".into()))?;
    let mut raster = raster(heights, nodata)?;
    raster.xs = coordinates("x", x, raster.columns, raster.rows, 1)?;
    raster.ys = coordinates("y", y, raster.rows, raster.columns, raster.columns)?;
    others.extend(arrays.into_iter().map(|(name, _)| name));
    if !others.is_empty() {
        others.sort_unstable();
        notes.push(HeightNote::ArraysSkipped { used, others });
    }
    Ok(raster)
}

fn is_known(name: &str) -> bool {
    HEIGHTS.iter().chain(&["x", "y"]).any(|known| name.eq_ignore_ascii_case(known))
}

/// The coordinates along an axis with `n` samples, `step` apart in arrays of two axes.
fn coordinates(
    name: &str,
    array: Option<Array>,
    n: usize,
    n_across: usize,
    step: usize,
) -> Result<Option<Vec<f64>>, HeightError> {
    let Some(array) = array else { return Ok(None) };
    let wrong = |what: String| Err(HeightError::Npz(format!("array `{name}`: {what}")));
    let Array { shape, values, .. } = array;
    if shape.len() < 2 {
        return match values.len() {
            found if found == n => Ok(Some(values)),
            found => wrong(format!("{found} numbers for {n} samples along {name}")),
        };
    }
    if values.len() != n * n_across {
        return wrong("it must be as large as the array of heights".into());
    }
    let across = if step == 1 { n } else { 1 };
    let list: Vec<f64> = (0..n).map(|k| values[k * step]).collect();
    let is_grid = (0..n).all(|k| (0..n_across).all(|m| values[k * step + m * across] == list[k]));
    if is_grid {
        Ok(Some(list))
    } else {
        wrong("the samples do not form a rectangular grid".into())
    }
}
