//! Lines cast onto faces: which parts of the drawn lines of a view lie in front of each triangle.
//!
//! ```text
//!      light ☼
//!             ╲╲
//!              e●───●           A drawn line e in front of triangle T. Its shadow on T runs from where
//!                ╲╲  ╲╲         the shadow of an end of e falls on T, or where that of e enters T over
//!           T  ╱──●───●─╲       a side.
//!             ╱__________╲
//! ```
//!
//! The view is that of the light. Exact.

use super::index::{ImageIndex, Visitor};
use super::rounding::Rounding;
use super::segment::Segment;
use super::shadow::cover_of_front;
use crate::classify::ViewedScene;
use crate::predicates::CutPlane;
use rayon::prelude::*;

/// How many segments make one piece of parallel work.
const CHUNK: usize = 256;

/// The shadow of a part of a line on a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lifted {
    /// The ends of the line, in its direction.
    pub line: [u32; 2],
    /// The triangle.
    pub triangle: u32,
    /// What cuts the line where the shadow begins and where it ends: [`CutPlane::End`] for its own ends,
    /// [`CutPlane::Sight`] for a side of the triangle, [`CutPlane::Triangle`] where it pierces it.
    pub ends: [CutPlane; 2],
}

/// The shadows of all drawn lines on the triangles that `is_wanted`, in the order of the lines and then of
/// the triangles.
///
/// Expected cost: the triangles, once, for an index, and for each line those near its image.
pub fn lifted(view: &ViewedScene, is_wanted: impl Fn(u32) -> bool + Sync) -> Vec<Lifted> {
    let segments: Vec<Segment> = view
        .selected()
        .par_iter()
        .filter_map(|drawn| {
            let segment = Segment::new(view, drawn.edge)?;
            // As if it lay infinitely far away: then every triangle is offered.
            Some(Segment { depth: [f64::INFINITY; 2], ..segment })
        })
        .collect();
    let rounding = Rounding::new(view);
    let n_triangles = view.scene().triangles().len();
    let index = ImageIndex::of_items(view, segments.iter(), n_triangles, None, |triangle| {
        rounding.place(view, triangle)
    });
    let parts: Vec<Vec<Lifted>> = segments
        .par_chunks(CHUNK)
        .map_init(
            || Visitor::new(Some(&index)),
            |visitor, chunk| {
                let mut found = Vec::new();
                for segment in chunk {
                    let first = found.len();
                    visitor.any(&index, view, segment, |triangle| {
                        if is_wanted(triangle)
                            && let Some(cover) = cover_of_front(view, segment, triangle)
                        {
                            let ends = [cover.from.plane, cover.to.plane];
                            found.push(Lifted { line: segment.ends, triangle, ends });
                        }
                        false
                    });
                    found[first..].sort_unstable_by_key(|lifted| lifted.triangle);
                }
                found
            },
        )
        .collect();
    parts.concat()
}
