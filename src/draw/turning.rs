//! Drafts for turning: the visible lines of a view in space, found quickly, which can be turned slightly
//! further until the next ones arrive.
//!
//! ```text
//!   eye 1 ●╌╌╌╌╌╌╌╌┐                    What eye 1 sees is found as for a drawing. Eye 2 is shown the
//!                  ├──▶ lines in space   same lines from where it stands: in the right place, while
//!   eye 2 ●╌╌╌╌╌╌╌╌┘                    what hides what is a moment old.
//! ```
//!
//! Nothing is carefully joined, dropped, dashed or ordered.

use glam::DVec3;

use super::DrawOptions;
use super::meshed::{self, MeshedOptions};
use crate::camera::{Camera, Projection};
use crate::classify::ViewedScene;
use crate::engines::edge::{LineEngine, VisibilityOptions, outline, solve};
use crate::engines::surface::tin;
use crate::engines::visibility::Visibility;
use crate::links::for_each_trail;
use crate::model::scene::Scene;
use crate::strokes::{StrokeKind, Strokes};
use crate::surface::LinedScene;

/// Visible lines as polylines in space, in model units relative to the camera's target.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TurningLines {
    points: Vec<DVec3>,
    heads: Vec<(StrokeKind, u32)>,
}

impl TurningLines {
    /// The polylines, each with the kind of its first piece.
    pub fn iter(&self) -> impl Iterator<Item = (StrokeKind, &[DVec3])> {
        self.heads.iter().scan(0, |start, &(kind, end)| {
            let points = &self.points[*start..end as usize];
            *start = end as usize;
            Some((kind, points))
        })
    }

    /// Number of polylines.
    pub fn len(&self) -> usize {
        self.heads.len()
    }

    /// Whether nothing is visible.
    pub fn is_empty(&self) -> bool {
        self.heads.is_empty()
    }

    /// Number of points of all polylines.
    pub fn n_points(&self) -> usize {
        self.points.len()
    }

    /// Adds strokes of the image as if they were drawn on a pane through the target, at right angles
    /// to the direction of view.
    pub fn push_pane(&mut self, strokes: &Strokes, camera: &Camera) {
        let frame = camera.frame();
        let scale = match camera.projection() {
            Projection::Perspective { .. } => camera.forward().length(),
            Projection::Orthographic => 1.0,
        };
        let center = camera.image(camera.target());
        for stroke in strokes.iter() {
            self.points.extend(stroke.points.iter().map(|&p| {
                let d = (p - center) * scale;
                frame.right * d.x + frame.upward * d.y
            }));
            self.heads.push((stroke.kind, self.points.len() as u32));
        }
    }
}

/// Finds the lines of `scene` that `camera` sees. The kinds of line, the crease angle, the engine and
/// the contact tolerance of `options` count; lines are joined within their kind only if they are to be
/// kept apart. Hidden lines are left out.
pub fn turning_lines(scene: &Scene, camera: &Camera, options: &DrawOptions) -> TurningLines {
    let view = ViewedScene::new(scene, camera, options.lines, options.crease_deg);
    let settings =
        VisibilityOptions { count_layers: false, find_doubled: false, ..options.visibility(scene) };
    let (visibility, ..) = solve(&view, options.engine, &settings);
    let outline = options.lines.has_outline().then(|| outline::find(&view));
    let mut pieces = Vec::with_capacity(view.selected().len());
    for (number, drawn) in view.selected().iter().enumerate() {
        let is_whole = outline.is_none() || !view.is_only_outline(drawn.edge);
        for span in visibility.spans(number).iter().filter(|span| span.qi == 0) {
            let mut push = |t0: f64, t1: f64| {
                if t0 < t1 {
                    pieces.push(Piece { number: number as u32, t0, t1 });
                }
            };
            match &outline {
                Some(outline) if !is_whole => outline
                    .parts(number)
                    .iter()
                    .for_each(|&[from, to]| push(from.max(span.t0), to.min(span.t1))),
                _ => push(span.t0, span.t1),
            }
        }
    }
    joined(&view, &pieces, options.apart_by_kind)
}

/// The same for a surface.
pub fn surface_turning_lines(
    surface: &LinedScene,
    camera: &Camera,
    options: &MeshedOptions,
) -> TurningLines {
    let view = meshed::view(surface, camera, options);
    let by_horizons = if options.engine == LineEngine::Auto { tin::solve(&view) } else { None };
    let visibility: Visibility = match by_horizons {
        Some((visibility, _)) => visibility,
        None => solve(&view, options.engine, &VisibilityOptions::default()).0,
    };
    let mut pieces = Vec::with_capacity(view.selected().len());
    for number in 0..view.selected().len() {
        let visible = visibility.spans(number).iter().filter(|span| span.qi == 0);
        pieces.extend(visible.map(|span| Piece {
            number: number as u32,
            t0: span.t0,
            t1: span.t1,
        }));
    }
    joined(&view, &pieces, options.apart_by_kind)
}

/// A visible part of the selected line of this number.
#[derive(Debug, Clone, Copy)]
struct Piece {
    number: u32,
    t0: f64,
    t1: f64,
}

/// No end of a piece, and no piece at a vertex.
const NONE: u32 = u32::MAX;

/// Joins pieces two by two where they meet at a point of the scene, in their order. O(points + pieces).
fn joined(view: &ViewedScene, pieces: &[Piece], apart_by_kind: bool) -> TurningLines {
    let selected = view.selected();
    let kind = |piece: u32| selected[pieces[piece as usize].number as usize].kind;
    let mut links = vec![NONE; 2 * pieces.len()];
    let mut open = vec![NONE; view.image().len()];
    for (piece, Piece { number, t0, t1 }) in (0..).zip(pieces) {
        let ends = view.line(selected[*number as usize].edge);
        for (side, point) in [(0, ends[0]), (1, ends[1])] {
            if [*t0 != 0.0, *t1 != 1.0][side as usize] {
                continue;
            }
            let (own, other) = (2 * piece + side, open[point as usize]);
            if other == NONE || apart_by_kind && kind(other / 2) != kind(piece) {
                open[point as usize] = own;
            } else {
                (links[own as usize], links[other as usize]) = (other, own);
                open[point as usize] = NONE;
            }
        }
    }
    let mut lines = TurningLines { points: Vec::with_capacity(pieces.len()), heads: Vec::new() };
    let camera = view.camera();
    let (frame, distance) = (camera.frame(), camera.forward().length());
    let at = |end: u32| {
        let Piece { number, t0, t1 } = pieces[end as usize / 2];
        let [a, b] = view.line(selected[number as usize].edge).map(|p| view.image()[p as usize]);
        let image = a.towards(b, if end.is_multiple_of(2) { t0 } else { t1 });
        // `x` and `y` are lengths in space: they are divided by `w` only to become an image.
        frame.right * image.x + frame.upward * image.y + frame.forward * (image.depth - distance)
    };
    for_each_trail(&links, |trail| {
        lines.points.push(at(trail[0]));
        lines.points.extend(trail.iter().map(|&end| at(end ^ 1)));
        lines.heads.push((kind(trail[0] / 2), lines.points.len() as u32));
    });
    lines
}
