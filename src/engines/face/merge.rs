//! Regions beside each other to a painting: those of one face become one where they meet.

use rayon::prelude::*;

use super::painting::Painting;
use super::region::{Grid, Region};

/// A painting of regions that do not overlap, listed by face; faces may come several times in a row.
///
/// What meets of one face is one piece. O(n log n) in the sides of each face, in parallel.
pub fn by_face(regions: impl IntoIterator<Item = (u32, Vec<Region>)>, grid: &Grid) -> Painting {
    let mut faces: Vec<(u32, Vec<Region>)> = Vec::new();
    for (face, regions) in regions {
        match faces.last_mut() {
            Some((last, list)) if *last == face => list.extend(regions),
            _ => faces.push((face, regions)),
        }
    }
    let merged: Vec<(u32, Region)> = faces
        .into_par_iter()
        .map(|(face, mut regions)| match regions.len() {
            1 => (face, regions.swap_remove(0)),
            _ => (face, Region::union(&regions)),
        })
        .collect();
    let mut painting = Painting::new(true);
    for (face, region) in &merged {
        push(&mut painting, *face, region, grid);
    }
    painting
}

/// Adds the parts of a region as pieces of a face.
pub fn push(painting: &mut Painting, face: u32, region: &Region, grid: &Grid) {
    for part in region.parts() {
        let corners =
            part.into_iter().map(|ring| ring.iter().map(|side| (grid.point(side.from), side.line)));
        painting.push(face, corners);
    }
}
