//! Visible pieces of grid lines, chained into strokes.
//!
//! One stroke runs along a grid line as long as it is visible.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::pen_path::{LineStroke, order};
use super::{ChainOptions, Piece, join};
use crate::camera::{Camera, Frame, Projection};
use crate::engines::surface::{GridPieces, SurfaceSide, VisiblePiece};
use crate::links::FREE;
use crate::predicates::Sign;
use crate::predicates::exact::{Towards, facing};
use crate::strokes::{GridFamily, StrokeKind, Strokes, SurfacePart};
use crate::surface::formula::Axis;
use crate::surface::{CutGrid, Grid, Places};

/// This many grid lines are chained at a time, in parallel: many small lists at once would leave much memory
/// in use after them.
const TOGETHER: usize = 128;

/// Which grid lines are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridLines<'a> {
    /// Those along x.
    pub along_x: bool,
    /// Those along y.
    pub along_y: bool,
    /// Only each line with a number that is a multiple of this, counted from 0, and the last one.
    pub every: usize,
    /// Which lines of the grid count, if not all do.
    pub places: Option<&'a Places>,
    /// Only what is seen from this side; lines on the surface's border are seen as their triangle
    /// is.
    pub side: Option<SurfaceSide>,
    /// Two-point strokes, one for each visible piece of each edge, instead of chains.
    pub separate: bool,
    /// Strokes of the cuts' own lines shorter than this are dropped, in image units.
    pub shortest: f64,
}

impl Default for GridLines<'_> {
    fn default() -> Self {
        let (side, places) = (None, None);
        Self {
            along_x: true,
            along_y: true,
            every: 1,
            places,
            side,
            separate: false,
            shortest: 0.0,
        }
    }
}

/// Draws the visible pieces: those of grid lines, and then those of the lines that cells are cut along, as
/// folds, which grid lines leave to them. What lies nearer than the camera's near plane is cut off.
///
/// O(edges), in parallel; the order of strokes does not depend on the number of threads.
pub fn strokes(cut: &CutGrid, pieces: &GridPieces, camera: &Camera, lines: &GridLines) -> Strokes {
    let grid = cut.grid;
    let projector = Projector::new(camera);
    let samples = 0..grid.zs().len() as u32;
    let on_edges =
        cut.cuts.lines().iter().filter(|ends| ends.iter().all(|end| samples.contains(end)));
    let mut left_out: Vec<u32> = on_edges.filter_map(|ends| grid.edge(*ends)).collect();
    left_out.sort_unstable();
    let cut_lines = CutLines { cut, pieces, left_out: &left_out };
    let (nx, ny) = (grid.xs().len(), grid.ys().len());
    let chosen = |n: usize, axis: Axis| -> Vec<usize> {
        let every = lines.every.max(1);
        match lines.places {
            Some(places) => {
                let drawn = places.drawn(axis, every);
                (0..n).filter(|&k| drawn[k]).collect()
            }
            None => (0..n).filter(|k| k % every == 0 || k + 1 == n).collect(),
        }
    };
    let mut families: Vec<(GridFamily, Vec<GridLine>)> = Vec::new();
    if lines.along_x {
        let line = |j| GridLine { first: j * nx, step: 1, edge: j * (nx - 1), n: nx };
        families
            .push((GridFamily::AlongX, chosen(ny, Axis::Second).into_iter().map(line).collect()));
    }
    if lines.along_y {
        let along_x = ny * (nx - 1);
        let line = |i| GridLine { first: i, step: nx, edge: along_x + i * (ny - 1), n: ny };
        families
            .push((GridFamily::AlongY, chosen(nx, Axis::First).into_iter().map(line).collect()));
    }
    let mut drawing = Strokes::default();
    for (family, lines_of_family) in &families {
        let part = SurfacePart { sheet: 1, level: 0, family: Some(*family) };
        let mut points: Vec<DVec2> = Vec::new();
        let mut strokes: Vec<LineStroke> = Vec::new();
        let mut ends = Vec::new();
        let mut number = 0;
        for block in lines_of_family.chunks(TOGETHER) {
            let chains: Vec<Chains> =
                block.par_iter().map(|line| line.chains(&cut_lines, &projector, lines)).collect();
            for (chains, line) in chains.iter().zip(number..) {
                for (stroke, its_points) in chains.strokes(line) {
                    strokes.push(stroke);
                    points.extend_from_slice(its_points);
                    ends.push(points.len());
                }
            }
            number += block.len() as u32;
        }
        let points_of = |stroke: usize| {
            let start = if stroke == 0 { 0 } else { ends[stroke - 1] };
            points[start..ends[stroke]].iter().copied()
        };
        if lines.separate {
            for stroke in 0..strokes.len() {
                drawing.push_part(StrokeKind::Grid, part, points_of(stroke));
            }
            continue;
        }
        for (stroke, is_backwards) in order(&strokes) {
            if is_backwards {
                drawing.push_part(StrokeKind::Grid, part, points_of(stroke).rev());
            } else {
                drawing.push_part(StrokeKind::Grid, part, points_of(stroke));
            }
        }
    }
    let options = ChainOptions {
        hidden: false,
        hidden_levels: None,
        exact: lines.separate,
        apart_by_kind: false,
        shortest: lines.shortest,
    };
    drawing.append(&join(&pieces_of_lines(cut, pieces, &projector, lines), &options, false));
    drawing
}

/// The visible pieces of the lines that cells are cut along.
fn pieces_of_lines(
    cut: &CutGrid,
    pieces: &GridPieces,
    projector: &Projector,
    lines: &GridLines,
) -> Vec<Piece> {
    let mut found = Vec::new();
    for &ends in cut.cuts.lines() {
        let Some(edge) = cut.edge(ends) else { continue };
        let [p, q] = ends.map(|end| cut.point(end));
        let is_wanted = |piece: &VisiblePiece| lines.side.is_none_or(|side| piece.side == side);
        let of_edge = pieces.of(edge).filter(is_wanted);
        let mut parts: Vec<(f64, f64)> =
            of_edge.filter_map(|piece| projector.kept(p, q, (piece.t0, piece.t1))).collect();
        let at = |t: f64| projector.between(p, q, t);
        parts.dedup_by(|next, last| {
            let is_short = !lines.separate && at(last.1).distance(at(next.0)) < lines.shortest;
            last.1 = if is_short { next.1 } else { last.1 };
            is_short
        });
        for (t0, t1) in parts {
            found.push(Piece {
                kind: StrokeKind::Silhouette,
                part: SurfacePart { sheet: 1, ..SurfacePart::default() },
                qi: 0,
                outline: false,
                only_outline: false,
                points: [at(t0), at(t1)],
                depths: [0.0; 2],
                ends: [
                    if t0 == 0.0 { ends[0] } else { FREE },
                    if t1 == 1.0 { ends[1] } else { FREE },
                ],
            });
        }
    }
    found
}

/// Grid lines some of whose edges are in two pieces, or drawn as other lines.
struct CutLines<'a> {
    cut: &'a CutGrid<'a>,
    pieces: &'a GridPieces,
    /// The edges that are not drawn as grid lines, in rising order.
    left_out: &'a [u32],
}

/// The camera with its frame.
struct Projector {
    eye: DVec3,
    frame: Frame,
    /// Perspective: the least distance along `frame.forward`.
    near: Option<f64>,
    towards: Towards,
}

impl Projector {
    fn new(camera: &Camera) -> Self {
        let towards = match camera.projection() {
            Projection::Perspective { .. } => Towards::Point(camera.eye()),
            Projection::Orthographic => Towards::Along(camera.forward()),
        };
        Self { eye: camera.eye(), frame: camera.frame(), near: camera.near_distance(), towards }
    }

    fn image(&self, p: DVec3) -> DVec2 {
        let d = p - self.eye;
        let image = DVec2::new(d.dot(self.frame.right), d.dot(self.frame.upward));
        if self.near.is_some() { image / d.dot(self.frame.forward) } else { image }
    }

    /// The image of a point on the way from `p` to `q`.
    fn between(&self, p: DVec3, q: DVec3, t: f64) -> DVec2 {
        match t {
            0.0 => self.image(p),
            1.0 => self.image(q),
            t => self.image(p + t * (q - p)),
        }
    }

    /// Cuts a range of the segment from `p` to `q` to what lies beyond the near plane.
    fn kept(&self, p: DVec3, q: DVec3, (t0, t1): (f64, f64)) -> Option<(f64, f64)> {
        let Some(near) = self.near else {
            return Some((t0, t1));
        };
        let beyond = |p: DVec3| (p - self.eye).dot(self.frame.forward) - near;
        let (a, b) = (beyond(p), beyond(q));
        let range = match (a >= 0.0, b >= 0.0) {
            (true, true) => return Some((t0, t1)),
            (false, false) => return None,
            (true, false) => (t0, t1.min(a / (a - b))),
            (false, true) => (t0.max(a / (a - b)), t1),
        };
        (range.0 < range.1).then_some(range)
    }
}

/// A line of the grid: its samples are `first + k·step`, its edges `edge + k`.
struct GridLine {
    first: usize,
    step: usize,
    edge: usize,
    n: usize,
}

/// Polylines one after the other.
#[derive(Default)]
struct Chains {
    points: Vec<DVec2>,
    ends: Vec<usize>,
    /// Where each begins and ends on its line, in samples.
    spans: Vec<[f64; 2]>,
}

impl Chains {
    /// Goes on to `to`, from where the last chain ended if it is `joined`, otherwise from `from`.
    fn extend(&mut self, joined: bool, from: impl FnOnce() -> DVec2, to: DVec2, span: [f64; 2]) {
        match self.spans.last_mut() {
            Some(last) if joined => {
                last[1] = span[1];
                self.ends.pop();
            }
            _ => {
                self.points.push(from());
                self.spans.push(span);
            }
        }
        self.points.push(to);
        self.ends.push(self.points.len());
    }

    fn strokes(&self, line: u32) -> impl Iterator<Item = (LineStroke, &[DVec2])> {
        let starts = std::iter::once(&0).chain(&self.ends);
        starts.zip(&self.ends).zip(&self.spans).map(move |((&start, &end), &span)| {
            let points = &self.points[start..end];
            (LineStroke { line, span, ends: [points[0], points[points.len() - 1]] }, points)
        })
    }
}

impl GridLine {
    /// Which side of the surface is seen at an edge on its border, by its only triangle; `None`
    /// inside.
    fn border_side(&self, grid: &Grid, k: usize, projector: &Projector) -> Option<SurfaceSide> {
        let (nx, ny) = (grid.xs().len(), grid.ys().len());
        let from = self.first + k * self.step;
        let (i, j) = (from % nx, from / nx);
        let (cell, is_lower_right) = match self.step {
            1 if j == 0 => (from, true),
            1 if j + 1 == ny => (from - nx, false),
            1 => return None,
            _ if i == 0 => (from, false),
            _ if i + 1 == nx => (from - 1, true),
            _ => return None,
        };
        let corners = if is_lower_right {
            [cell, cell + 1, cell + nx + 1]
        } else {
            [cell, cell + nx + 1, cell + nx]
        };
        let triangle = corners.map(|sample| grid.point(sample as u32));
        let is_upper = facing(triangle, projector.towards) != Sign::Negative;
        Some(if is_upper { SurfaceSide::Upper } else { SurfaceSide::Lower })
    }

    fn chains(&self, cut_lines: &CutLines, projector: &Projector, lines: &GridLines) -> Chains {
        let CutLines { cut, pieces, left_out } = *cut_lines;
        let point = |k: usize| cut.grid.point((self.first + k * self.step) as u32);
        let mut chain = OpenChain { chains: Chains::default(), reaches: false, projector, lines };
        let mut q = point(0);
        for k in 0..self.n - 1 {
            let edge = (self.edge + k) as u32;
            let p = std::mem::replace(&mut q, point(k + 1));
            if !left_out.is_empty() && left_out.binary_search(&edge).is_ok() {
                chain.reaches = false;
                continue;
            }
            let seen = |piece: VisiblePiece| match lines.side {
                Some(_) => {
                    let side = self.border_side(cut.grid, k, projector).unwrap_or(piece.side);
                    VisiblePiece { side, ..piece }
                }
                None => piece,
            };
            let at = k as f64;
            let Some((vertex, [first, last])) = cut.cut(edge) else {
                chain.follow([p, q], pieces.of(edge).map(seen), [at, at + 1.0]);
                continue;
            };
            let middle = cut.point(vertex);
            chain.follow([p, middle], pieces.of(first).map(seen), [at, at + 0.5]);
            // This one is numbered from its end on the grid.
            let backwards = |piece: VisiblePiece| VisiblePiece {
                t0: 1.0 - piece.t1,
                t1: 1.0 - piece.t0,
                ..piece
            };
            let of_last = pieces.of(last).rev().map(seen).map(backwards);
            chain.follow([middle, q], of_last, [at + 0.5, at + 1.0]);
        }
        chain.chains
    }
}

/// Chains along a line as far as it has been followed.
struct OpenChain<'a> {
    chains: Chains,
    /// Whether the last chain reaches the point where the next edge begins.
    reaches: bool,
    projector: &'a Projector,
    lines: &'a GridLines<'a>,
}

impl OpenChain<'_> {
    /// Goes on along an edge by its visible pieces in order; `span` is where it begins and ends on the line.
    fn follow(
        &mut self,
        [p, q]: [DVec3; 2],
        pieces: impl Iterator<Item = VisiblePiece>,
        [from, to]: [f64; 2],
    ) {
        let mut last = (self.reaches && !self.lines.separate).then_some(0.0);
        self.reaches = false;
        for piece in pieces {
            if self.lines.side.is_some_and(|only| piece.side != only) {
                continue;
            }
            let Some((t0, t1)) = self.projector.kept(p, q, (piece.t0, piece.t1)) else { continue };
            let at = |t: f64| self.projector.between(p, q, t);
            let span = [t0, t1].map(|t| from + t * (to - from));
            self.chains.extend(last == Some(t0), || at(t0), at(t1), span);
            last = Some(t1);
            self.reaches = t1 == 1.0;
        }
    }
}
