//! Outlines: the parts of edges seen only against the background.
//!
//! ```text
//!          ┌────────┐
//!     ┌────┼────┐   │       Two boxes that overlap in the image: the border of both together is
//!     │    ┆    │   │       outline, whichever of them is in front, and what runs inside it
//!     │    └┄┄┄┄┼───┘       (┆, and the part of │ in the middle) is not.
//!     └─────────┘
//! ```
//!
//! In the image, a point just to the left or right of an edge either lies inside some triangle, in
//! front of the edge or behind it, or inside none. Where one of the two sides lies inside none, the edge
//! is *outline*. Nothing covers such a side, so outlines are always visible, and depths play no part:
//! the intervals and sides are those of [`roberts`](super::roberts), but every triangle covers, even
//! those that contain the edge.
//!
//! Only silhouette, boundary, and non-manifold edges are tested, where the surface can end in the
//! image. All others have a triangle on either side, or an edge-on face whose other edges have the
//! same image. Exact.
//!
//! Coherence: object coherence, through the index over the image, as in Roberts.

use super::index::{ImageIndex, Visitor};
use super::rounding::Rounding;
use super::segment::Segment;
use super::shadow::{Cover, image_cover};
use super::sides::Sides;
use super::sweep::Sweep;
use crate::classify::ViewedScene;
use crate::engines::visibility::Span;
use crate::predicates::CutPlane;
use crate::strokes::StrokeKind;
use rayon::prelude::*;

/// How many segments make one piece of parallel work.
const CHUNK: usize = 256;

/// The outline's parts of many segments in one flat array, in the order of the segments.
#[derive(Debug, Clone, PartialEq)]
pub struct Outline {
    parts: Vec<[f64; 2]>,
    starts: Vec<u32>,
}

impl Outline {
    /// The parts of one segment as parameters along it, in order and apart from each other. Panics
    /// when there is no such segment.
    pub fn parts(&self, segment: usize) -> &[[f64; 2]] {
        &self.parts[self.starts[segment] as usize..self.starts[segment + 1] as usize]
    }
}

/// Whether edges of a kind can be outline.
pub fn can_be_outline(kind: StrokeKind) -> bool {
    matches!(kind, StrokeKind::Silhouette | StrokeKind::Boundary | StrokeKind::Nonmanifold)
}

/// Finds the outline's parts of all drawn edges of `view`, in their order.
///
/// Expected cost: the triangles, once, for the index, and for each edge those near its image.
pub fn find(view: &ViewedScene) -> Outline {
    let segments: Vec<Option<Segment>> = view
        .selected()
        .par_iter()
        .map(|drawn| {
            let segment = can_be_outline(drawn.kind).then(|| Segment::new(view, drawn.edge))??;
            // As if it lay infinitely far away: then every triangle is offered.
            Some(Segment { depth: [f64::INFINITY; 2], ..segment })
        })
        .collect();
    let rounding = Rounding::new(view);
    let n_triangles = view.scene().triangles().len();
    let index =
        ImageIndex::of_items(view, segments.iter().flatten(), n_triangles, None, |triangle| {
            rounding.place(view, triangle)
        });
    let sides = Sides::new(view);
    let parts: Vec<Vec<Vec<[f64; 2]>>> = segments
        .par_chunks(CHUNK)
        .map_init(
            || (Sweep::default(), Visitor::new(Some(&index))),
            |(sweep, visitor), chunk| {
                let parts = chunk.iter().map(|segment| {
                    let Some(segment) = segment else { return Vec::new() };
                    outline_of(view, &index, &sides, visitor, sweep, segment)
                });
                parts.collect()
            },
        )
        .collect();
    let mut outline = Outline { parts: Vec::new(), starts: vec![0] };
    for parts in parts.iter().flatten() {
        outline.parts.extend_from_slice(parts);
        outline.starts.push(outline.parts.len() as u32);
    }
    outline
}

/// The outline's parts of one segment.
fn outline_of(
    view: &ViewedScene,
    index: &ImageIndex,
    sides: &Sides,
    visitor: &mut Visitor,
    sweep: &mut Sweep,
    segment: &Segment,
) -> Vec<[f64; 2]> {
    sweep.clear();
    let mut is_whole = [false; 2];
    // True when both sides are covered from end to end: then nothing more need be known.
    let mut add = |cover: Cover| {
        if is_from_end_to_end(&cover) {
            for (whole, count) in is_whole.iter_mut().zip(cover.sides.counts()) {
                *whole |= count > 0;
            }
        }
        sweep.add_cover(&cover);
        is_whole == [true; 2]
    };
    let [a, b] = segment.ends;
    let triangles = view.scene().triangles();
    let corners = |triangle: u32| triangles[triangle as usize];
    let mut test = |triangle: u32, is_own: bool| {
        let touches_both = corners(triangle).contains(&a) && corners(triangle).contains(&b);
        touches_both == is_own && image_cover(view, segment, triangle).is_some_and(&mut add)
    };
    let is_inside = sides.along_edge(view, segment.edge).any(|(own, _)| test(own, true))
        || visitor.any(index, view, segment, |triangle| test(triangle, false));
    if is_inside {
        return Vec::new();
    }
    let spans = sweep.spans(view.sight(), segment, false).iter();
    spans.filter(|span| span.qi == 0).map(|&Span { t0, t1, .. }| [t0, t1]).collect()
}

fn is_from_end_to_end(cover: &Cover) -> bool {
    let is_end = |plane| plane == CutPlane::End || plane == CutPlane::Near;
    is_end(cover.from.plane) && is_end(cover.to.plane)
}
