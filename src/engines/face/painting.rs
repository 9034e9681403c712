//! The answer of the face engines: polygons in the image, each a fragment of one face.
//!
//! ```text
//!  piece 0        piece 1                 a piece has one outer ring, counter-clockwise,
//!  ●──────●       ●─────────●             and any number of holes, clockwise (y up);
//!  │      │       │  ●───●  │             each side that begins at a point knows whether
//!  │      ┆       │  │ 1 │  │             it is on a line of the scene
//!  ●──────●       │  ●───●  │             ┆ a side made by a split
//!                 ●─────────●
//! ```

use glam::DVec2;

/// The side is not on a line of the scene: a split or a diagonal made it.
pub const NO_LINE: u32 = u32::MAX;

/// Pieces of faces in the order in which they are to be painted.
///
/// Painted one over the other they give the picture. Engines whose pieces never overlap say so.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Painting {
    points: Vec<DVec2>,
    lines: Vec<u32>,
    ring_ends: Vec<u32>,
    pieces: Vec<(u32, u32)>,
    /// Whether the pieces never overlap, so that their order does not matter.
    pub is_disjoint: bool,
}

/// A piece of a face.
#[derive(Debug, Clone, Copy)]
pub struct PaintedPiece<'a> {
    /// The face of the mesh.
    pub face: u32,
    painting: &'a Painting,
    first_ring: u32,
    last_ring: u32,
}

/// A closed polyline: the last point is joined to the first.
#[derive(Debug, Clone, Copy)]
pub struct Ring<'a> {
    /// Its corners in image coordinates.
    pub points: &'a [DVec2],
    /// For the side that begins at each corner: the line of the scene that it is on, or
    /// [`NO_LINE`]; see [`Scene::line`](crate::model::scene::Scene::line).
    pub lines: &'a [u32],
}

impl Painting {
    /// Nothing painted yet.
    pub fn new(is_disjoint: bool) -> Self {
        Self { is_disjoint, ..Self::default() }
    }

    /// Adds a piece over all others: its rings, the outer one first, as corners, each with the line of
    /// the side that begins there. Rings of fewer than three corners are left out.
    pub fn push<R>(&mut self, face: u32, rings: impl IntoIterator<Item = R>)
    where
        R: IntoIterator<Item = (DVec2, u32)>,
    {
        let n_rings = self.ring_ends.len();
        for ring in rings {
            let start = self.points.len();
            for (point, line) in ring {
                self.points.push(point);
                self.lines.push(line);
            }
            if self.points.len() < start + 3 {
                self.points.truncate(start);
                self.lines.truncate(start);
            } else {
                self.ring_ends.push(self.points.len() as u32);
            }
        }
        if self.ring_ends.len() > n_rings {
            self.pieces.push((face, self.ring_ends.len() as u32));
        }
    }

    /// Number of pieces.
    pub fn len(&self) -> usize {
        self.pieces.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.pieces.is_empty()
    }

    /// The pieces in the paint order.
    pub fn pieces(&self) -> impl ExactSizeIterator<Item = PaintedPiece<'_>> {
        (0..self.pieces.len()).map(|number| {
            let first_ring = match number.checked_sub(1) {
                Some(before) => self.pieces[before].1,
                None => 0,
            };
            let (face, last_ring) = self.pieces[number];
            PaintedPiece { face, painting: self, first_ring, last_ring }
        })
    }
}

impl<'a> PaintedPiece<'a> {
    /// The outer ring, then the holes.
    pub fn rings(&self) -> impl ExactSizeIterator<Item = Ring<'a>> + use<'a> {
        let painting = self.painting;
        (self.first_ring as usize..self.last_ring as usize).map(move |ring| {
            let start = match ring.checked_sub(1) {
                Some(before) => painting.ring_ends[before] as usize,
                None => 0,
            };
            let end = painting.ring_ends[ring] as usize;
            Ring { points: &painting.points[start..end], lines: &painting.lines[start..end] }
        })
    }

    /// The area in square image units, without the holes.
    pub fn area(&self) -> f64 {
        self.rings().map(|ring| ring.signed_area()).sum()
    }
}

impl Ring<'_> {
    /// The area within, positive when the corners run counter-clockwise (y up).
    pub fn signed_area(&self) -> f64 {
        let Some(&origin) = self.points.first() else { return 0.0 };
        let twice: f64 =
            self.points.windows(2).map(|side| (side[0] - origin).perp_dot(side[1] - origin)).sum();
        twice / 2.0
    }
}
