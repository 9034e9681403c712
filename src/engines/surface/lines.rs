//! Visible pieces of grid lines, chained into strokes.
//!
//! One stroke runs along a grid line as long as it is visible. Lines are taken to and fro, so that
//! the pen goes on near where it stopped.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::pieces::{GridPieces, LOWER, PARTLY, Piece, Side, UPPER};
use crate::strokes::{Drawing, StrokeKind};
use crate::surface::Grid;
use crate::view::{Camera, Frame, Projection};

/// Which grid lines are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Lines {
    /// Those along x.
    pub along_x: bool,
    /// Those along y.
    pub along_y: bool,
    /// Only each line with a number that is a multiple of this, counted from 0, and the last one.
    pub every: usize,
    /// Only what is seen from this side.
    pub side: Option<Side>,
    /// Two-point strokes, one for each visible piece of each edge, instead of chains.
    pub separate: bool,
}

impl Default for Lines {
    fn default() -> Self {
        Self { along_x: true, along_y: true, every: 1, side: None, separate: false }
    }
}

/// Draws the visible pieces. What lies nearer than the camera's near plane is cut off.
///
/// O(edges), in parallel; the order of strokes does not depend on the number of threads.
pub fn strokes(grid: &Grid, pieces: &GridPieces, camera: &Camera, lines: &Lines) -> Drawing {
    let projector = Projector::new(camera);
    let (nx, ny) = (grid.xs().len(), grid.ys().len());
    let every = lines.every.max(1);
    let chosen = |n: usize| (0..n).filter(move |k| k % every == 0 || k + 1 == n);
    let mut wanted: Vec<Line> = Vec::new();
    if lines.along_x {
        wanted.extend(chosen(ny).map(|j| Line {
            first: j * nx,
            step: 1,
            edge: j * (nx - 1),
            n: nx,
        }));
    }
    if lines.along_y {
        let along_x = ny * (nx - 1);
        wanted.extend(chosen(nx).map(|i| Line {
            first: i,
            step: nx,
            edge: along_x + i * (ny - 1),
            n: ny,
        }));
    }
    let chains: Vec<Chains> = wanted
        .par_iter()
        .enumerate()
        .map(|(k, line)| {
            let mut chains = line.chains(grid, pieces, &projector, lines);
            if k % 2 == 1 {
                chains.reverse();
            }
            chains
        })
        .collect();
    let mut drawing = Drawing::default();
    for chains in &chains {
        let mut start = 0;
        for &end in &chains.ends {
            drawing.push(StrokeKind::Grid, 0, chains.points[start..end].iter().copied());
            start = end;
        }
    }
    drawing
}

/// The camera with its frame at hand.
struct Projector {
    eye: DVec3,
    frame: Frame,
    /// Perspective: the least distance along `frame.forward`.
    near: Option<f64>,
}

impl Projector {
    fn new(camera: &Camera) -> Self {
        let near = match camera.projection() {
            Projection::Perspective { near, .. } => Some(near * camera.forward().length()),
            Projection::Orthographic => None,
        };
        Self { eye: camera.eye(), frame: camera.frame(), near }
    }

    fn image(&self, p: DVec3) -> DVec2 {
        let d = p - self.eye;
        let image = DVec2::new(d.dot(self.frame.right), d.dot(self.frame.upward));
        if self.near.is_some() { image / d.dot(self.frame.forward) } else { image }
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
struct Line {
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
}

impl Chains {
    /// Goes on to `to`, from where the last chain ended if it is `joined`, otherwise from `from`.
    fn extend(&mut self, joined: bool, from: impl FnOnce() -> DVec2, to: DVec2) {
        if joined {
            self.ends.pop();
        } else {
            self.points.push(from());
        }
        self.points.push(to);
        self.ends.push(self.points.len());
    }

    fn reverse(&mut self) {
        self.points.reverse();
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        let n = self.points.len();
        let mut ends: Vec<usize> = starts.take(self.ends.len()).map(|start| n - start).collect();
        ends.reverse();
        self.ends = ends;
    }
}

impl Line {
    fn chains(
        &self,
        grid: &Grid,
        pieces: &GridPieces,
        projector: &Projector,
        lines: &Lines,
    ) -> Chains {
        let mut chains = Chains::default();
        let point = |k: usize| grid.point((self.first + k * self.step) as u32);
        let first_edge = self.edge as u32;
        let mut partial =
            pieces.pieces[pieces.pieces.partition_point(|piece| piece.edge < first_edge)..].iter();
        // Whether the chain reaches the sample where the next edge begins.
        let mut reaches = false;
        let wanted = |side: Side| lines.side.is_none_or(|only| only == side);
        for k in 0..self.n - 1 {
            let edge = (self.edge + k) as u32;
            let status = pieces.status[self.edge + k];
            let mut reached = false;
            let mut last = (reaches && !lines.separate).then_some(0.0);
            let mut add = |piece: &Piece| {
                let (p, q) = (point(k), point(k + 1));
                if !wanted(piece.side) {
                    return;
                }
                let Some((t0, t1)) = projector.kept(p, q, (piece.t0, piece.t1)) else {
                    return;
                };
                let at = |t: f64| match t {
                    0.0 => projector.image(p),
                    1.0 => projector.image(q),
                    t => projector.image(p + t * (q - p)),
                };
                chains.extend(last == Some(t0), || at(t0), at(t1));
                last = Some(t1);
                reached = t1 == 1.0;
            };
            match status {
                UPPER | LOWER => {
                    let side = if status == UPPER { Side::Upper } else { Side::Lower };
                    add(&Piece { edge, t0: 0.0, t1: 1.0, side });
                }
                PARTLY => {
                    while let Some(piece) = partial.as_slice().first().filter(|p| p.edge == edge) {
                        add(piece);
                        partial.next();
                    }
                }
                _ => {}
            }
            reaches = reached;
        }
        chains
    }
}
