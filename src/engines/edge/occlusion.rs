//! Occlusion culling: what certainly lies behind a surface is left out before any line is traced.
//!
//! ```text
//!   eye ──►    ┌──┬──┬──┐ ╲ surface       Cells of the image get a depth behind which nothing
//!              │  │  │▓▓│  ╲▓▓▓▓▓▓▓       shows (▓). A triangle or line that lies behind that of
//!              │  │▓▓│▓▓│   ╲▓▓▓▓▓▓       every cell it touches is left out.
//!              └──┴──┴──┘    ╲▓▓▓▓▓
//! ```
//!
//! # Why a covered cell has no gap
//!
//! Start with a triangle whose image holds a certain point of the cell. Follow the sides that come near the
//! cell: wherever one has as many triangles on its left as on its right, add them all, and continue until
//! nothing is added. Now walk from there to any point of the cell. At each side that is crossed, as
//! many of the added triangles begin as end; so at least one of them lies over every point of the cell,
//! and on both sides of every line through it. Behind the deepest point of the added triangles nothing
//! shows. A side with a different number on its left and right (a silhouette, a border) leaves the cell
//! uncovered.
//!
//! # Why the visible parts stay the same
//!
//! If a triangle was left out, what it hides lies behind it, thus behind the depth of that cell, and is
//! hidden there by the triangles of that cell, on both sides. Those are never left out, as they lie
//! before that depth. So the remaining lines have the same visible parts among the remaining triangles
//! as among all of them. Only how many layers lie over a hidden part, and whether another line doubles
//! it there, is not known any more.
//!
//! All boxes and depths are rounded outwards, and a contact tolerance is added to the depths of the
//! cells, so the worst that can happen is that something hidden is kept.
//!
//! The depths of larger blocks of cells make a pyramid, as in N. Greene, M. Kass and G. Miller,
//! "Hierarchical Z-buffer visibility", SIGGRAPH 1993; the cells themselves go back to W. R. Franklin,
//! "A linear time exact hidden surface algorithm", SIGGRAPH 1980.

mod grid;

use self::grid::Grid;
use super::occluders::Occluders;
use super::rounding::Rounding;
use super::sides::Sides;
use super::{OcclusionCulling, VisibilityOptions};
use crate::classify::ViewedScene;
use crate::engines::visibility::{Span, Visibility};
use rayon::prelude::*;

/// Scenes with fewer triangles are fast without culling.
const MIN_TRIANGLES: usize = 1 << 14;

/// Culling is tried when there is more than one drawn line for this many triangles: for contours alone
/// it costs more than it saves.
const TRIANGLES_PER_LINE: usize = 2;

/// Culling is given up when fewer than one of this many cells with a surface in them is covered.
const CELLS_PER_COVERED: usize = 4;

/// What may show, of the lines and triangles of a view.
pub(super) struct Visible {
    /// Places in the list of drawn lines, in rising order.
    pub lines: Vec<u32>,
    /// The triangles that may hide some of these lines.
    pub occluders: Occluders,
}

/// Finds what may show; `None` where culling is out of the question or does not pay.
///
/// O(triangles + drawn lines), in parallel.
pub(super) fn cull(
    view: &ViewedScene,
    options: &VisibilityOptions,
    rounding: &Rounding,
    sides: &Sides,
    occluders: &Occluders,
) -> Option<Visible> {
    let n_triangles = view.scene().triangles().len();
    let n_lines = view.selected().len();
    let is_tried = match options.occlusion_culling {
        OcclusionCulling::Auto => {
            n_triangles >= MIN_TRIANGLES && n_lines * TRIANGLES_PER_LINE > n_triangles
        }
        OcclusionCulling::Always => true,
        OcclusionCulling::Never => false,
    };
    if !is_tried || options.count_layers || view.near_plane_cuts() {
        return None;
    }
    let is_forced = options.occlusion_culling == OcclusionCulling::Always;
    let grid = Grid::over(view, rounding)?;
    let samples = grid.samples(view, occluders);
    let depths = grid.covered_from(view, sides, occluders, &samples, options.contact_tolerance);
    let n_sampled = samples.par_iter().flatten().count();
    let n_covered = depths.par_iter().filter(|depth| depth.is_finite()).count();
    if !is_forced && n_covered * CELLS_PER_COVERED < n_sampled {
        return None;
    }
    let pyramid = grid.pyramid(depths);
    let triangles = view.scene().triangles();
    let occluders =
        occluders.culled(|triangle| grid.may_show(&pyramid, triangles[triangle as usize]));
    let may_show = |i: &u32| grid.may_show(&pyramid, view.line(view.selected()[*i as usize].edge));
    let lines = (0..n_lines as u32).into_par_iter().with_min_len(4096).filter(may_show).collect();
    Some(Visible { lines, occluders })
}

/// The spans of all `n_lines` lines, from those of some: the others are hidden.
pub(super) fn with_hidden(some: &Visibility, lines: &[u32], n_lines: usize) -> Visibility {
    const HIDDEN: Span = Span { t0: 0.0, t1: 1.0, qi: 1, doubled: false };
    let mut all = Visibility::default();
    for (i, &line) in lines.iter().enumerate() {
        while all.len() < line as usize {
            all.push(&[HIDDEN]);
        }
        all.push(some.spans(i));
    }
    while all.len() < n_lines {
        all.push(&[HIDDEN]);
    }
    all
}
