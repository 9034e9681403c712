//! The visible pieces of the lines of a grid.

use std::sync::atomic::AtomicU8;

use super::HorizonCounts;

/// The side of the surface that is seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SurfaceSide {
    /// Beyond the upper horizon: from above.
    Upper,
    /// Beyond the lower horizon: from below.
    Lower,
}

/// A visible part of an edge between two neighboring samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VisiblePiece {
    /// The edge, see [`GridPieces`].
    pub edge: u32,
    /// Where it begins: 0 at the end with the smaller index, 1 at the other.
    pub t0: f64,
    /// Where it ends, greater than `t0`.
    pub t1: f64,
    /// Which side is seen.
    pub side: SurfaceSide,
}

pub(super) const HIDDEN: u8 = 0;
pub(crate) const UPPER: u8 = 1;
pub(crate) const LOWER: u8 = 2;
pub(crate) const PARTLY: u8 = 3;

/// Visible parts of all edges of a grid.
///
/// Edges are numbered as in [`Grid::n_edges`](crate::surface::Grid::n_edges), and as in
/// [`CutGrid`](crate::surface::CutGrid) where cells are cut.
#[derive(Debug, Clone, PartialEq)]
pub struct GridPieces {
    pub(super) nx: usize,
    pub(super) ny: usize,
    pub(crate) status: Vec<u8>,
    /// Of partly visible edges only, by edge and then from t = 0 to 1; disjoint.
    pub(crate) pieces: Vec<VisiblePiece>,
    pub(super) work: HorizonCounts,
}

impl GridPieces {
    /// Number of samples along x and y.
    pub fn size(&self) -> (usize, usize) {
        (self.nx, self.ny)
    }

    /// Number of edges.
    pub fn n_edges(&self) -> usize {
        self.status.len()
    }

    /// How much work it took.
    pub fn work(&self) -> HorizonCounts {
        self.work
    }

    /// The visible pieces of an edge in order of t. O(log pieces).
    pub fn of(&self, edge: u32) -> impl DoubleEndedIterator<Item = VisiblePiece> {
        let status = self.status[edge as usize];
        let whole = match status {
            UPPER => Some(SurfaceSide::Upper),
            LOWER => Some(SurfaceSide::Lower),
            _ => None,
        };
        let parts = if status == PARTLY {
            let first = self.pieces.partition_point(|piece| piece.edge < edge);
            let n = self.pieces[first..].partition_point(|piece| piece.edge == edge);
            &self.pieces[first..first + n]
        } else {
            &[]
        };
        let whole = whole.map(|side| VisiblePiece { edge, t0: 0.0, t1: 1.0, side });
        whole.into_iter().chain(parts.iter().copied())
    }

    /// All visible pieces in order of edge and t.
    pub fn iter(&self) -> impl Iterator<Item = VisiblePiece> {
        (0..self.status.len() as u32).flat_map(|edge| self.of(edge))
    }

    /// Combines the pieces and counts of strips.
    pub(super) fn of_strips(
        nx: usize,
        ny: usize,
        status: Vec<AtomicU8>,
        done: Vec<(HorizonCounts, Vec<VisiblePiece>)>,
    ) -> Self {
        let mut work = HorizonCounts::default();
        let mut found = Vec::with_capacity(done.iter().map(|(_, found)| found.len()).sum());
        for (strip_work, strip_found) in done {
            work += strip_work;
            found.extend(strip_found);
        }
        let status = status.into_iter().map(AtomicU8::into_inner).collect();
        Self { work, ..Self::join(nx, ny, status, found) }
    }

    /// Sorts and joins the pieces of strips.
    pub(super) fn join(
        nx: usize,
        ny: usize,
        mut status: Vec<u8>,
        mut found: Vec<VisiblePiece>,
    ) -> Self {
        found.sort_unstable_by(|a, b| {
            (a.edge.cmp(&b.edge))
                .then(a.t0.total_cmp(&b.t0))
                .then(a.side.cmp(&b.side))
                .then(a.t1.total_cmp(&b.t1))
        });
        let mut pieces: Vec<VisiblePiece> = Vec::with_capacity(found.len());
        let mut first = 0;
        for edge_pieces in found.chunk_by(|a, b| a.edge == b.edge) {
            let edge = edge_pieces[0].edge as usize;
            if status[edge] == UPPER || status[edge] == LOWER {
                continue;
            }
            for &piece in edge_pieces {
                match pieces[first..].last_mut() {
                    Some(last) if piece.t0 <= last.t1 && last.side == piece.side => {
                        last.t1 = last.t1.max(piece.t1);
                    }
                    Some(last) if piece.t0 < last.t1 => {
                        if piece.t1 > last.t1 {
                            let t0 = last.t1;
                            pieces.push(VisiblePiece { t0, ..piece });
                        }
                    }
                    _ => pieces.push(piece),
                }
            }
            match pieces[first..] {
                [only] if only.t0 == 0.0 && only.t1 == 1.0 => {
                    status[edge] = if only.side == SurfaceSide::Upper { UPPER } else { LOWER };
                    pieces.truncate(first);
                }
                _ => status[edge] = PARTLY,
            }
            first = pieces.len();
        }
        Self { nx, ny, status, pieces, work: HorizonCounts::default() }
    }
}
