//! Any text as scattered points: an error or triangles over them, never a panic.
#![no_main]

use hiddenline::stages::surface::{Duplicates, ScatteredPoints, delaunay};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    if let Ok(mut read) = ScatteredPoints::read(text, None)
        && read.merge(Duplicates::Mean).is_ok()
        && let Ok(triangles) = delaunay(&read.points)
    {
        assert!(triangles.iter().flatten().all(|&k| (k as usize) < read.points.len()));
    }
});
