//! The input of engines that work in the image: the image of each face, flat, with its depth.
//!
//! ```text
//!  face ─► triangles ─► those in one plane ─► near plane ─► Flat: region on the grid,
//!                       together, exactly                   plane of depth, vertices
//! ```
//!
//! An exactly planar face is one [`Flat`]; a bent face is one for each of its triangles. Which of two
//! flats is in front is decided exactly, from the vertices of the scene, if the plane of one does not
//! cut the other, and otherwise by depths in the image.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::painting::NO_LINE;
use super::region::{Region, SnapGrid};
use crate::camera::{Camera, Frame, Projection};
use crate::engines::image::raster::Corners;
use crate::model::scene::Scene;
use crate::predicates::{Sight, Sign, Solid};

/// How near the points of a plane are, a linear function of the image: `at_origin + slope · point`.
///
/// *Nearness* is 1 / w in perspective, where w is the distance along the direction of view, and −w in
/// orthographic projection. Larger is nearer.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Nearness {
    /// At the image's origin.
    pub at_origin: f64,
    /// Its change along x and y.
    pub slope: DVec2,
}

impl Nearness {
    /// At a point of the image.
    #[inline]
    pub fn at(&self, point: DVec2) -> f64 {
        self.at_origin + self.slope.dot(point)
    }

    fn of_plane(corner: DVec3, normal: DVec3, camera: &Camera, frame: &Frame) -> Self {
        let d = corner - camera.eye();
        let (k, n_forward) = (normal.dot(d), normal.dot(frame.forward));
        let aside = DVec2::new(normal.dot(frame.right), normal.dot(frame.upward));
        match camera.projection() {
            // w (f + x r + y u) · n = k
            Projection::Perspective { .. } => Self { at_origin: n_forward / k, slope: aside / k },
            // (w f + x r + y u) · n = k
            Projection::Orthographic => {
                Self { at_origin: -k / n_forward, slope: aside / n_forward }
            }
        }
    }
}

/// The depth order of two flats, from the first one's side.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DepthOrder {
    /// The other is farther wherever both overlap.
    Behind,
    /// The other is nearer wherever both overlap.
    InFront,
    /// The plane of each cuts the other: nearer in one part and farther in the other.
    Crossing,
}

/// The image of a face or, of a bent one, of a triangle.
#[derive(Debug, Clone)]
pub struct Flat {
    /// The face of the mesh.
    pub face: u32,
    /// A triangle of the scene that spans its plane.
    triangle: [u32; 3],
    /// Which way the triangle turns in the image.
    turn: Sign,
    /// The vertices, some of them twice.
    vertices: Vec<u32>,
    /// The part of the image that it covers.
    pub region: Region,
    /// How near it is.
    pub nearness: Nearness,
    /// How near its nearest point is.
    pub nearest: f64,
}

/// The flats of a scene as seen by a camera, and the grid of their regions.
#[derive(Debug)]
pub struct Images<'a> {
    sight: Sight<'a>,
    /// The flats in the order of their faces; those that are edge-on or behind the near plane are
    /// left out.
    pub flats: Vec<Flat>,
    /// The grid that all regions are on.
    pub grid: SnapGrid,
    /// The box around all images.
    pub bounds: (DVec2, DVec2),
}

impl<'a> Images<'a> {
    /// O(corners), in parallel. Without any image there are no flats.
    pub fn new(scene: &'a Scene, camera: &Camera) -> Self {
        let corners = Corners::new(scene, camera);
        let positions = scene.mesh().positions();
        let (sight, solid) = (Sight::new(positions, camera), Solid::new(positions));
        let bounds = corners.bounds().unwrap_or_default();
        let grid = SnapGrid::new(bounds.0, bounds.1);
        let frame = camera.frame();
        let groups = groups(scene, &solid);
        let flats = groups.par_iter().filter_map(|group| {
            let triangles = &scene.triangles()[group.start as usize..group.end as usize];
            let spanning = triangles.iter().find(|t| sight.turn(t[0], t[1], t[2]) != Sign::Zero);
            let &triangle = spanning?;
            let [a, b, c] = triangle.map(|vertex| positions[vertex as usize]);
            let nearness = Nearness::of_plane(a, (b - a).cross(c - a), camera, &frame);
            let rings = group.clone().flat_map(|number| rings(scene, &corners, number, &grid));
            let region = Region::of_rings(rings);
            if region.is_empty() {
                return None;
            }
            let nearest = region
                .sides()
                .iter()
                .map(|side| nearness.at(grid.point(side.from)))
                .fold(f64::NEG_INFINITY, f64::max);
            Some(Flat {
                face: scene.triangle_faces()[group.start as usize],
                triangle,
                turn: sight.turn(triangle[0], triangle[1], triangle[2]),
                vertices: triangles.as_flattened().to_vec(),
                region,
                nearness,
                nearest,
            })
        });
        let flats = flats.collect();
        Self { sight, flats, grid, bounds }
    }

    /// Where flat `other` is as seen from flat `this`.
    ///
    /// Exact unless it is [`DepthOrder::Crossing`]; of flats in one plane the first is in front.
    pub fn place(&self, this: usize, other: usize) -> DepthOrder {
        match self.side(this, other) {
            Some(Sign::Positive) => DepthOrder::Behind,
            Some(Sign::Negative) => DepthOrder::InFront,
            Some(Sign::Zero) if other > this => DepthOrder::Behind,
            Some(Sign::Zero) => DepthOrder::InFront,
            None => match self.side(other, this) {
                Some(Sign::Positive) => DepthOrder::InFront,
                Some(Sign::Negative) => DepthOrder::Behind,
                Some(Sign::Zero) | None => DepthOrder::Crossing,
            },
        }
    }

    /// The side of `this` flat's plane that all vertices of `other` are on: positive is behind, as the
    /// eye sees it. `None` when they are on both sides.
    fn side(&self, this: usize, other: usize) -> Option<Sign> {
        let Flat { triangle, turn, .. } = self.flats[this];
        let mut side = Sign::Zero;
        for &vertex in &self.flats[other].vertices {
            let here = self.sight.depth(triangle, vertex).times(turn);
            if here != Sign::Zero {
                if here == side.flipped() {
                    return None;
                }
                side = here;
            }
        }
        Some(side)
    }

    /// How much nearer flat `a` is than `b`, over the image.
    pub fn difference(&self, a: usize, b: usize) -> Nearness {
        let (a, b) = (self.flats[a].nearness, self.flats[b].nearness);
        Nearness { at_origin: a.at_origin - b.at_origin, slope: a.slope - b.slope }
    }

    /// The half of the image plane where flat `other` is nearer than `this`. For two flats the border is
    /// always the same.
    ///
    /// `None` when rounding hides the line: then the one nearer in the middle is nearer everywhere.
    pub fn where_nearer(&self, other: usize, this: usize) -> Option<Region> {
        let line = self.difference(other, this);
        let length = line.slope.length();
        let (a, b) = (self.flats[this].region.bounds(), self.flats[other].region.bounds());
        let (low, high) = (a.0.max(b.0), a.1.min(b.1));
        let (low, high) = (self.grid.point(low), self.grid.point(high));
        let middle = low / 2.0 + high / 2.0;
        let up = line.slope / length;
        let on_line = middle - up * (line.at(middle) / length);
        let reach = (self.bounds.1 - self.bounds.0).length();
        if !(up.is_finite() && on_line.is_finite()) || on_line.distance(middle) > reach {
            return None;
        }
        let along = up.perp() * reach;
        let corners = [
            on_line + along,
            on_line - along,
            on_line - along + up * (2.0 * reach),
            on_line + along + up * (2.0 * reach),
        ];
        Some(Region::of_rings([corners.map(|p| (self.grid.snap(p), NO_LINE))]))
    }
}

/// Runs of triangles that are one flat: all of a face that lies in a plane, or one.
fn groups(scene: &Scene, solid: &Solid) -> Vec<std::ops::Range<u32>> {
    let faces = scene.triangle_faces();
    let mut groups = Vec::new();
    let mut start = 0;
    while start < faces.len() {
        let n = faces[start..].iter().take_while(|&&face| face == faces[start]).count();
        let (first, last) = (start as u32, (start + n) as u32);
        if n == 1 || is_flat(&scene.triangles()[start..start + n], solid) {
            groups.push(first..last);
        } else {
            groups.extend((first..last).map(|triangle| triangle..triangle + 1));
        }
        start += n;
    }
    groups
}

/// Whether the triangles of a face lie in one plane, exactly.
fn is_flat(triangles: &[[u32; 3]], solid: &Solid) -> bool {
    let vertices = triangles.as_flattened();
    // All vertices are in the plane of a triangle without area, which proves nothing.
    let spans = |triangle: &&[u32; 3]| {
        let [a, b, c] = triangle.map(|vertex| solid.positions()[vertex as usize]);
        (b - a).cross(c - a) != DVec3::ZERO
    };
    triangles.iter().find(spans).is_some_and(|&triangle| {
        vertices.iter().all(|&vertex| solid.side_of(triangle, vertex) == Sign::Zero)
    })
}

/// The image of a triangle, clipped at the near plane, counter-clockwise, with the mesh edges that its
/// sides are on.
fn rings(scene: &Scene, corners: &Corners, number: u32, grid: &SnapGrid) -> Vec<[(DVec2, u32); 3]> {
    let [a, b, c] = scene.triangles()[number as usize];
    let line = |a, b| scene.topology().find_edge(a, b).unwrap_or(NO_LINE);
    let lines = [line(a, b), line(b, c), line(c, a)];
    let lines_of = corners.side_sources(number);
    let pieces = corners.pieces(number).into_iter().zip(lines_of);
    pieces
        .filter_map(|(piece, sides)| Some((piece?, sides)))
        .map(|(piece, sides)| {
            let lines = sides.map(|side| side.map_or(NO_LINE, |side| lines[side]));
            let at = piece.map(|corner| grid.snap(corner.image()));
            if super::region::turn(at[0], at[1], at[2]) >= 0 {
                [0, 1, 2].map(|k| (at[k], lines[k]))
            } else {
                // In reverse order, the side that begins at a corner is the one that ended there.
                [(at[0], lines[2]), (at[2], lines[1]), (at[1], lines[0])]
            }
        })
        .collect()
}
