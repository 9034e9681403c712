//! From spans to strokes: which pieces are drawn, and how they join into long polylines.
//!
//! Pieces of edges meet where they share a vertex of the mesh, never because they are near each
//! other. Where several meet at a vertex, the straightest pair is joined first, since corners slow a
//! pen down:
//!
//! ```text
//!        ╲   ╱               the two straight lines go through,
//!         ╲ ╱                and the fifth piece ends here
//!   ───────●
//!         ╱ ╲
//!        ╱   ╲
//! ```

pub mod grid_lines;
mod pen_path;

use crate::camera::{ImagePoint, Projection};
use crate::classify::ViewedScene;
use crate::engines::edge::outline::Outline;
use crate::engines::visibility::{Span, Visibility};
use crate::links::{FREE, for_each_trail};
use crate::strokes::draft::{Draft, DraftPoint, Mark};
use crate::strokes::{StrokeKind, Strokes, SurfacePart};
use glam::DVec2;
use rayon::prelude::*;

/// Which spans are kept, and which of them join.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChainOptions {
    /// Keep hidden spans too.
    pub hidden: bool,
    /// Keep only hidden spans with at most this quantitative invisibility, and join only equal ones;
    /// `None` keeps and joins all of them.
    pub hidden_levels: Option<u32>,
    /// One two-point stroke for each maximal visible span and each hidden one of constant `qi`;
    /// nothing is joined or dropped, and lines that coincide are all kept.
    pub exact: bool,
    /// Join only pieces of one kind, one part of a surface and one `qi`, so that a stroke's attributes apply to all of it.
    /// Otherwise all visible pieces join, and all hidden ones, as one pen draws them.
    pub apart_by_kind: bool,
    /// Visible strokes shorter than this are dropped, and hidden gaps shorter than this between
    /// two visible pieces of one edge are closed. In image units; zero for none.
    pub shortest: f64,
}

impl ChainOptions {
    /// Segments of a draft of one class may be one stroke.
    pub fn class(&self, mark: Mark) -> (u32, u32) {
        class(mark.kind, mark.qi, mark.outline, self)
    }
}

/// A part of a line that is drawn.
#[derive(Debug, Clone, Copy)]
struct Piece {
    kind: StrokeKind,
    part: SurfacePart,
    qi: u32,
    outline: bool,
    only_outline: bool,
    points: [DVec2; 2],
    /// Pseudo-depth at each end; see [`DraftPoint::depth`].
    depths: [f64; 2],
    /// The mesh's vertex at each end, or [`FREE`] where a cut ends the piece.
    ends: [u32; 2],
}

/// Two cuts at one place, each within `2⁻³⁶` of it, are no further apart than this as parameters of
/// their edge: what lies between them is rounding.
const SAME_CUT: f64 = 1.0 / (1u64 << 35) as f64;

/// Turns the spans of all drawn edges into strokes, in the order of the edges.
///
/// With `outline`, visible strokes are marked that belong to it. O(pieces log pieces); where very many
/// edges meet at one vertex, they are joined in order.
pub fn chain(
    view: &ViewedScene,
    visibility: &Visibility,
    outline: Option<&Outline>,
    options: &ChainOptions,
) -> Strokes {
    join(&pieces(view, visibility, outline, options), options, outline.is_some())
}

/// Joins pieces into strokes; those of the outline are drawn apart if there is one.
fn join(pieces: &[Piece], options: &ChainOptions, has_outline: bool) -> Strokes {
    let mut drawing = Strokes::default();
    if options.exact {
        pieces.iter().for_each(|piece| push(&mut drawing, piece, &piece.points));
        return drawing;
    }
    // What is short is so by all visible lines that continue from it, whatever draws them.
    let is_visible = |piece: &Piece| (0, piece.qi.min(1));
    let mut is_short = vec![false; pieces.len()];
    let mut points = Vec::new();
    let links = link(pieces, is_visible);
    if options.shortest > 0.0 {
        for_each_trail(&links, |trail| {
            points_along(pieces, trail, &mut points);
            let first = &pieces[trail[0] as usize / 2];
            if first.qi == 0 && is_shorter(&points, options.shortest) {
                trail.iter().for_each(|&end| is_short[end as usize / 2] = true);
            }
        });
    }
    let is_apart = options.apart_by_kind || options.hidden_levels.is_some() || has_outline;
    let links = if is_apart {
        link(pieces, |piece| {
            let part = if options.apart_by_kind { piece.part } else { SurfacePart::default() };
            (class(piece.kind, piece.qi, piece.outline, options), part)
        })
    } else {
        links
    };
    for_each_trail(&links, |trail| {
        let first = &pieces[trail[0] as usize / 2];
        // Joined with others, one that is short by itself may begin a long one.
        if !trail.iter().all(|&end| is_short[end as usize / 2]) {
            points_along(pieces, trail, &mut points);
            push(&mut drawing, first, &points);
        }
    });
    drawing
}

/// Turns the spans of all drawn edges into drafts of the visible and of the hidden lines: pieces are
/// joined whatever their kind, and nothing is dropped.
///
/// Pieces that are drawn only where they are outline are all there, since only the paper will tell.
/// Where hidden lines of different `qi` are drawn differently, their pieces are not joined. The other options
/// are those of [`chain`]; `exact` must be off.
pub fn draft(view: &ViewedScene, visibility: &Visibility, options: &ChainOptions) -> [Draft; 2] {
    let pieces = pieces(view, visibility, None, options);
    let has_levels = options.hidden_levels.is_some() || options.apart_by_kind;
    let level = |piece: &Piece| (0, if has_levels { piece.qi } else { piece.qi.min(1) });
    let mut drafts = [Draft::default(), Draft::default()];
    for_each_trail(&link(&pieces, level), |trail| {
        let draft = &mut drafts[usize::from(pieces[trail[0] as usize / 2].qi > 0)];
        for &end in trail {
            let Piece { kind, qi, outline, only_outline, points, depths, .. } =
                pieces[end as usize / 2];
            let mark = Mark { kind, qi, outline, only_outline };
            for side in [end as usize % 2, 1 - end as usize % 2] {
                draft.push(DraftPoint { at: points[side], depth: depths[side], mark });
            }
        }
        draft.end_stroke();
    });
    drafts
}

fn push(drawing: &mut Strokes, first: &Piece, points: &[DVec2]) {
    if first.outline {
        drawing.push_outline(first.kind, points.iter().copied());
    } else if first.qi == 0 {
        drawing.push_part(first.kind, first.part, points.iter().copied());
    } else {
        drawing.push(first.kind, first.qi, points.iter().copied());
    }
}

/// Pieces of one class may join.
fn class(kind: StrokeKind, qi: u32, outline: bool, options: &ChainOptions) -> (u32, u32) {
    let kind = if options.apart_by_kind { kind as u32 } else { 0 };
    let levels_apart = options.apart_by_kind || options.hidden_levels.is_some();
    let qi = if levels_apart { qi } else { qi.min(1) };
    (kind << 1 | u32::from(outline), qi)
}

/// The points of a trail.
fn points_along(pieces: &[Piece], trail: &[u32], points: &mut Vec<DVec2>) {
    points.clear();
    for &end in trail {
        let piece = &pieces[end as usize / 2];
        if points.is_empty() {
            points.push(piece.points[end as usize % 2]);
        }
        points.push(piece.points[1 - end as usize % 2]);
    }
}

fn is_shorter(points: &[DVec2], limit: f64) -> bool {
    let mut length = 0.0;
    for pair in points.windows(2) {
        length += pair[0].distance(pair[1]);
        if length >= limit {
            return false;
        }
    }
    true
}

/// The pieces to draw, in the order of edges and spans.
fn pieces(
    view: &ViewedScene,
    visibility: &Visibility,
    outline: Option<&Outline>,
    options: &ChainOptions,
) -> Vec<Piece> {
    const CHUNK: usize = 4096;
    let is_perspective = matches!(view.camera().projection(), Projection::Perspective { .. });
    // Larger farther away, and affine along lines in the image.
    let depth = |p: ImagePoint| if is_perspective { -1.0 / p.depth } else { p.depth };
    let parts: Vec<Vec<Piece>> = view
        .selected()
        .par_chunks(CHUNK)
        .enumerate()
        .map(|(chunk, drawn)| {
            let mut pieces = Vec::with_capacity(drawn.len());
            let (mut spans, mut parts) = (Vec::new(), Vec::<[f64; 2]>::new());
            let deepest = options.hidden_levels.unwrap_or(u32::MAX);
            for (i, drawn) in drawn.iter().enumerate() {
                let ends = view.line(drawn.edge);
                let images = ends.map(|end| view.image()[end as usize]);
                let point = |t: f64| {
                    // Ends are taken as they are, so that joined pieces share the very point.
                    if t == 0.0 {
                        images[0]
                    } else if t == 1.0 {
                        images[1]
                    } else {
                        images[0].towards(images[1], t)
                    }
                };
                let at = |t: f64| point(t).image();
                spans.clear();
                spans.extend_from_slice(visibility.spans(chunk * CHUNK + i));
                parts.clear();
                parts.extend(outline.into_iter().flat_map(|o| o.parts(chunk * CHUNK + i)));
                if !options.exact && options.shortest > 0.0 {
                    let is_short = |t0, t1| at(t0).distance(at(t1)) < options.shortest;
                    close_gaps(&mut spans, is_short);
                    parts.dedup_by(|next, last| {
                        let is_gap_short = is_short(last[1], next[0]);
                        last[1] = if is_gap_short { next[1] } else { last[1] };
                        is_gap_short
                    });
                }
                merge(&mut spans, options);
                let only_outline = view.is_only_outline(drawn.edge);
                let leaves_out_rest = only_outline && outline.is_some();
                let kept = spans.iter().filter(|span| {
                    span.qi == 0 || options.hidden && span.qi <= deepest && !only_outline
                });
                for span in kept.filter(|span| options.exact || !span.doubled) {
                    let parts = if span.qi == 0 { &parts[..] } else { &[] };
                    split(span, parts, |t0, t1, outline| {
                        if leaves_out_rest && !outline {
                            return;
                        }
                        pieces.push(Piece {
                            kind: drawn.kind,
                            part: drawn.part,
                            qi: span.qi,
                            outline,
                            only_outline,
                            points: [at(t0), at(t1)],
                            depths: [t0, t1].map(|t| depth(point(t))),
                            ends: [
                                if t0 == 0.0 { ends[0] } else { FREE },
                                if t1 == 1.0 { ends[1] } else { FREE },
                            ],
                        });
                    });
                }
            }
            pieces
        })
        .collect();
    parts.concat()
}

/// Calls `f` with the stretches of a span, each with whether it is one of the outline's parts.
fn split(span: &Span, parts: &[[f64; 2]], mut f: impl FnMut(f64, f64, bool)) {
    let mut start = span.t0;
    for &[from, to] in parts {
        let (from, to) = (from.max(start), to.min(span.t1));
        if to - from <= SAME_CUT {
            continue;
        }
        if from - start > SAME_CUT {
            f(start, from, false);
            start = from;
        }
        let to = if span.t1 - to <= SAME_CUT { span.t1 } else { to };
        f(start, to, true);
        start = to;
    }
    if start < span.t1 || start == span.t0 {
        f(start, span.t1, false);
    }
}

/// Makes short hidden spans between two visible ones visible.
fn close_gaps(spans: &mut [Span], is_short: impl Fn(f64, f64) -> bool) {
    let mut start = 0;
    while start < spans.len() {
        let end = start + spans[start..].iter().take_while(|span| span.qi > 0).count();
        if end > start && start > 0 && end < spans.len() && is_short(spans[start].t0, spans[end].t0)
        {
            for span in &mut spans[start..end] {
                span.qi = 0;
            }
        }
        start = end.max(start + 1);
    }
}

/// Joins neighboring spans that are drawn alike.
fn merge(spans: &mut Vec<Span>, options: &ChainOptions) {
    spans.dedup_by(|next, last| {
        let same_doubling = options.exact || next.doubled == last.doubled;
        let as_one_pen =
            !options.exact && !options.apart_by_kind && options.hidden_levels.is_none();
        let same_layers = next.qi == last.qi || (as_one_pen && next.qi > 0 && last.qi > 0);
        let alike = same_doubling && same_layers;
        if alike {
            last.t1 = next.t1;
        }
        alike
    });
}

/// For each end of each piece (numbered `2 · piece + side`) the end it is joined to, or [`FREE`].
fn link<C: Copy + Ord + Send>(pieces: &[Piece], class: impl Fn(&Piece) -> C) -> Vec<u32> {
    let mut links = vec![FREE; 2 * pieces.len()];
    // Ends by vertex, then class, then number: ends that may join are neighbors.
    let mut ends: Vec<(u32, C, u32)> = (0..links.len() as u32)
        .filter_map(|end| {
            let piece = &pieces[end as usize / 2];
            let vertex = piece.ends[end as usize % 2];
            (vertex != FREE).then(|| (vertex, class(piece), end))
        })
        .collect();
    ends.par_sort_unstable();
    let mut pairs = Vec::new();
    for group in ends.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        match group {
            [_] => {}
            &[(.., a), (.., b)] => {
                links[a as usize] = b;
                links[b as usize] = a;
            }
            _ => {
                straightest_pairs(pieces, group.iter().map(|&(.., end)| end), &mut pairs);
                for &(_, a, b) in &pairs {
                    if links[a as usize] == FREE && links[b as usize] == FREE {
                        links[a as usize] = b;
                        links[b as usize] = a;
                    }
                }
            }
        }
    }
    links
}

/// Most ends at one vertex of which every pair is weighed; more are paired in order.
const MAX_WEIGHED_ENDS: usize = 64;

/// Pairs of ends at one vertex, those that continue straightest first.
fn straightest_pairs(
    pieces: &[Piece],
    ends: impl Iterator<Item = u32> + Clone,
    pairs: &mut Vec<(f64, u32, u32)>,
) {
    let direction = |end: u32| {
        let piece = &pieces[end as usize / 2];
        let side = end as usize % 2;
        (piece.points[1 - side] - piece.points[side]).normalize_or_zero()
    };
    pairs.clear();
    let n_ends = ends.clone().count();
    for (i, a) in ends.clone().enumerate() {
        let others = ends.clone().skip(i + 1);
        let others = others.take(if n_ends > MAX_WEIGHED_ENDS { 1 } else { n_ends });
        // −1 is straight on, 1 is straight back.
        pairs.extend(others.map(|b| (direction(a).dot(direction(b)), a, b)));
    }
    if n_ends <= MAX_WEIGHED_ENDS {
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    }
}
