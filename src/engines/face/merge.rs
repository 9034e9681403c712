//! Disjoint regions: made from pieces painted over each other, and joined where they meet.

use glam::DVec2;
use rayon::prelude::*;

use super::boxes::BoxIndex;
use super::painting::{PaintedPiece, Painting};
use super::region::{Region, SnapGrid};

/// A painting of regions that do not overlap, listed by face; faces may come several times in a row.
///
/// Regions of one face that meet become one piece. O(n log n) in the sides of each face, in parallel.
pub fn by_face(regions: impl IntoIterator<Item = (u32, Vec<Region>)>, grid: &SnapGrid) -> Painting {
    let mut faces: Vec<(u32, Vec<Region>)> = Vec::new();
    for (face, regions) in regions {
        match faces.last_mut() {
            Some((last, list)) if *last == face => list.extend(regions),
            _ => faces.push((face, regions)),
        }
    }
    let merged: Vec<(u32, Region)> = faces
        .into_par_iter()
        // Even a single one: clipping leaves spikes without width along its sides.
        .map(|(face, regions)| (face, Region::union(&regions)))
        .collect();
    let mut painting = Painting::new(true);
    for (face, region) in &merged {
        push(&mut painting, *face, region, grid);
    }
    painting
}

/// Adds the parts of a region as pieces of a face.
pub fn push(painting: &mut Painting, face: u32, region: &Region, grid: &SnapGrid) {
    for part in region.parts() {
        let corners =
            part.into_iter().map(|ring| ring.iter().map(|side| (grid.point(side.from), side.line)));
        painting.push(face, corners);
    }
}

/// The part of each piece that is still seen once all others are painted over it: disjoint regions, one
/// for each piece, with their grid.
///
/// Each piece is clipped by all later overlapping ones in one operation, so its border is rounded once.
/// O(sides of pieces that overlap), in parallel.
pub fn seen(painting: &Painting) -> (Vec<Region>, SnapGrid) {
    let points = || painting.pieces().flat_map(|piece| piece.rings()).flat_map(|ring| ring.points);
    let nothing = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    let (low, high) = points().fold(nothing, |(low, high), &p| (low.min(p), high.max(p)));
    let grid = if low.is_finite() {
        SnapGrid::new(low, high)
    } else {
        SnapGrid::new(DVec2::ZERO, DVec2::ONE)
    };
    let pieces: Vec<PaintedPiece> = painting.pieces().collect();
    let regions: Vec<Region> = pieces.par_iter().map(|piece| region(piece, &grid)).collect();
    if painting.is_disjoint {
        return (regions, grid);
    }
    let index = BoxIndex::new(regions.iter().map(Region::bounds).collect());
    let seen = (0..regions.len()).into_par_iter().map(|number| {
        let region = &regions[number];
        if region.is_empty() {
            return Region::default();
        }
        let mut near = Vec::new();
        index.overlapping(region.bounds(), &mut near);
        let later = near.iter().map(|&other| other as usize).filter(|&other| other > number);
        region.without_all(later.map(|other| &regions[other]))
    });
    (seen.collect(), grid)
}

/// A piece as a region on a grid.
fn region(piece: &PaintedPiece, grid: &SnapGrid) -> Region {
    Region::of_rings(
        piece
            .rings()
            .map(|ring| ring.points.iter().zip(ring.lines).map(|(&p, &line)| (grid.snap(p), line))),
    )
}
