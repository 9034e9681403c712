//! Where families of planes cut faces: the segments that are hatched.
//!
//! ```text
//!          ●                 A plane crosses an edge between a vertex on its negative side and one
//!         ╱ ╲                that is not. A segment runs from where the plane enters the face to
//!   in ──┼───┼── out         where it leaves it, so that the segments of neighbors follow each
//!       ╱     ╲              other: `out` of the one is `in` of the other.
//!      ●───────●
//! ```
//!
//! The mesh is not cut: ends are exact points on edges. The pieces in the triangles of a planar face make one
//! segment; a bent face is cut triangle by triangle.

use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::families::{Families, least_halvings, rank};
use super::options::{HatchError, HatchLevels, HatchPage};
use super::tone::Tones;
use crate::camera::{Camera, ImagePoint, Projection};
use crate::classify::ViewSegments;
use crate::model::scene::Scene;
use crate::predicates::{FreePlane, PiercePoint, Sight, Sign, Solid};
use crate::shading::normals::corners;
use crate::strokes::StrokeKind;

/// Most segments: about two gigabytes.
pub(super) const MOST_SEGMENTS: usize = 1 << 23;

/// No triangle: the ground.
pub(super) const GROUND: u32 = u32::MAX;

/// What a segment is part of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct HatchSegment {
    /// Number of its family.
    pub(super) family: u16,
    /// Number of its line in the family.
    pub(super) line: i32,
    /// The triangle at each of its ends, or [`GROUND`].
    pub(super) at: [u32; 2],
}

/// An edge by its vertices, the lower one first, or a vertex twice.
type Place = [u32; 2];

/// A segment by what is at its ends.
#[derive(Debug, Clone, Copy)]
struct Cut {
    of: HatchSegment,
    ends: [Place; 2],
    within: [u32; 2],
}

/// What decides which segments are needed.
pub(super) struct Cutter<'a> {
    pub(super) scene: &'a Scene,
    pub(super) camera: &'a Camera,
    pub(super) families: &'a Families,
    pub(super) tones: &'a Tones<'a>,
    pub(super) page: &'a HatchPage,
    pub(super) levels: HatchLevels,
    /// Whether every line is wanted, whatever is drawn of it.
    pub(super) every_line: bool,
}

impl Cutter<'_> {
    /// All segments in faces that may be seen and may be dark enough, by family, then line, then face.
    ///
    /// Adds them and their points to `segments`, in that order. O(triangles + segments log segments),
    /// in parallel.
    pub(super) fn cut(&self, segments: &mut ViewSegments) -> Result<Vec<HatchSegment>, HatchError> {
        let faces = self.scene.triangle_faces();
        let mut groups = Vec::with_capacity(self.scene.mesh().n_faces());
        let mut first = 0;
        for group in faces.chunk_by(|a, b| a == b) {
            groups.push([first, first + group.len() as u32]);
            first += group.len() as u32;
        }
        let found = AtomicUsize::new(0);
        let sight = Sight::new(self.scene.mesh().positions(), self.camera);
        let solid = Solid::new(self.scene.mesh().positions());
        let parts: Vec<Vec<Cut>> = groups
            .par_chunks(CHUNK)
            .map(|groups| {
                let mut cuts = Vec::new();
                for &triangles in groups {
                    if found.load(Relaxed) + cuts.len() > MOST_SEGMENTS {
                        break;
                    }
                    self.cut_face(&sight, &solid, triangles, &mut cuts, &found);
                }
                found.fetch_add(cuts.len(), Relaxed);
                cuts
            })
            .collect();
        if found.into_inner() > MOST_SEGMENTS {
            return Err(HatchError::TooMany(MOST_SEGMENTS));
        }
        let mut cuts = parts.concat();
        drop(parts);
        // Within a line the order of the faces stays.
        cuts.par_sort_by_key(|cut| (cut.of.family, cut.of.line));
        add(&cuts, self.scene, self.families, segments);
        Ok(cuts.into_iter().map(|cut| cut.of).collect())
    }

    /// The segments in one face, which has these triangles.
    fn cut_face(
        &self,
        sight: &Sight,
        solid: &Solid,
        [first, end]: [u32; 2],
        cuts: &mut Vec<Cut>,
        found: &AtomicUsize,
    ) {
        let before = cuts.len();
        for triangle in first..end {
            self.cut_triangle(sight, triangle, [triangle, triangle + 1], cuts, found);
        }
        if end - first > 1 && cuts.len() > before + 1 {
            let all = self.scene.triangles();
            let own = all[first as usize];
            let is_planar = all[first as usize + 1..end as usize]
                .iter()
                .flatten()
                .all(|&vertex| solid.side_of(own, vertex) == Sign::Zero);
            if is_planar {
                join(cuts, before, [first, end]);
            }
        }
    }

    fn cut_triangle(
        &self,
        sight: &Sight,
        triangle: u32,
        within: [u32; 2],
        cuts: &mut Vec<Cut>,
        found: &AtomicUsize,
    ) {
        let vertices = self.scene.triangles()[triangle as usize];
        let [p, q, r] = vertices;
        let turn = sight.turn(p, q, r);
        let in_body = self.scene.intersections().in_bodies().get(triangle as usize);
        let is_never_seen = turn == Sign::Negative && in_body.is_some_and(|&is_in| is_in);
        if turn == Sign::Zero || is_never_seen {
            return;
        }
        let points = corners(self.scene, triangle);
        let Some(kept) = self.kept(&points) else { return };
        let part = self.scene.mesh().face_parts();
        let face = self.scene.triangle_faces()[triangle as usize];
        let class = self.families.class(part.get(face as usize).copied());
        for (number, family) in (0..).zip(&self.families.all) {
            if family.class != class || self.every_line && family.is_alternate() {
                continue;
            }
            let limit = match self.every_line {
                true => f64::INFINITY,
                false => self.tones.highest_rank(family, triangle, &points, turn),
            };
            if limit <= 0.0 {
                continue;
            }
            let halvings = match self.every_line {
                true => 0,
                false => least_halvings(self.levels, limit),
            };
            let Some(lines) = lines(kept.iter().map(|&p| family.place(p)), halvings) else {
                found.store(MOST_SEGMENTS + 1, Relaxed);
                return;
            };
            for line in lines {
                if !self.every_line && rank(self.levels, line) >= limit {
                    continue;
                }
                if cuts.len() + found.load(Relaxed) > MOST_SEGMENTS {
                    return;
                }
                if let Some(ends) = crossing(&family.plane(line), vertices, &points) {
                    let of = HatchSegment { family: number, line, at: [triangle; 2] };
                    cuts.push(Cut { of, ends, within });
                }
            }
        }
    }

    /// The corners of what of a triangle is in front of the eye; `None` when it is not on the page.
    /// Rounded, and a little too much.
    fn kept(&self, points: &[DVec3; 3]) -> Option<Kept> {
        let frame = self.camera.frame();
        let image = points.map(|p| ImagePoint::new(p - self.camera.eye(), self.camera, &frame));
        let mut kept = Kept { points: [DVec3::ZERO; 4], n: 0 };
        let nearest = match self.camera.projection() {
            Projection::Orthographic => f64::NEG_INFINITY,
            Projection::Perspective { near, .. } => near * self.camera.forward().length() * 0.5,
        };
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for i in 0..3 {
            let j = (i + 1) % 3;
            if image[i].depth >= nearest {
                kept.push(points[i]);
                low = low.min(image[i].image());
                high = high.max(image[i].image());
            }
            if (image[i].depth >= nearest) != (image[j].depth >= nearest) {
                let t = (nearest - image[i].depth) / (image[j].depth - image[i].depth);
                kept.push(points[i].lerp(points[j], t));
                let at = image[i].towards(image[j], t).image();
                low = low.min(at);
                high = high.max(at);
            }
        }
        let (from, to) = self.page.window;
        let margin = (to - from).abs() * WINDOW_MARGIN;
        let is_beside = low.cmpgt(to + margin).any() || high.cmplt(from - margin).any();
        (kept.n > 0 && !is_beside).then_some(kept)
    }
}

/// How much more than the window is cut, as a part of it: rounding.
const WINDOW_MARGIN: f64 = 1e-6;

/// Faces that one piece of parallel work cuts.
const CHUNK: usize = 1024;

/// A triangle cut off at the eye: up to four points.
struct Kept {
    points: [DVec3; 4],
    n: usize,
}

impl Kept {
    fn push(&mut self, point: DVec3) {
        if self.n < self.points.len() {
            self.points[self.n] = point;
            self.n += 1;
        }
    }

    fn iter(&self) -> impl Iterator<Item = &DVec3> {
        self.points[..self.n].iter()
    }
}

/// The lines between the least and the greatest of some places, and perhaps one more on each side,
/// whose numbers are divisible by two to the power of `halvings`. `None` when numbers are too large.
pub(super) fn lines(
    places: impl Iterator<Item = f64>,
    halvings: u32,
) -> Option<impl Iterator<Item = i32>> {
    let (low, high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), place| {
        (low.min(place), high.max(place))
    });
    let largest = low.abs().max(high.abs());
    if largest.is_nan() || largest >= LARGEST_LINE {
        return None;
    }
    // No number of lines is known so well that rounding could move it by more.
    let margin = 1e-9 * (1.0 + largest);
    let step = f64::from(1_u32 << halvings);
    let first = ((low - margin) / step).ceil() as i64;
    let last = ((high + margin) / step).floor() as i64;
    let step = step as i64;
    Some((first..=last).map(move |number| (number * step) as i32))
}

/// No line has a larger number.
const LARGEST_LINE: f64 = (1 << 30) as f64;

/// Where a plane enters a triangle and where it leaves it.
fn crossing(plane: &FreePlane, vertices: [u32; 3], points: &[DVec3; 3]) -> Option<[Place; 2]> {
    let sides = points.map(|p| plane.side(p));
    let is_above = sides.map(|side| side != Sign::Negative);
    if is_above == [true; 3] || is_above == [false; 3] {
        return None;
    }
    let mut ends = [[0; 2]; 2];
    for i in 0..3 {
        let j = (i + 1) % 3;
        if is_above[i] == is_above[j] {
            continue;
        }
        let above = if is_above[i] { i } else { j };
        let (a, b) = (vertices[i].min(vertices[j]), vertices[i].max(vertices[j]));
        let place = if sides[above] == Sign::Zero { [vertices[above]; 2] } else { [a, b] };
        ends[usize::from(is_above[i])] = place;
    }
    (ends[0] != ends[1]).then_some(ends)
}

/// Joins the segments of one planar face along the sides that its triangles share. On one line no two of
/// them overlap.
fn join(cuts: &mut Vec<Cut>, first: usize, triangles: [u32; 2]) {
    let line_of = |cut: &Cut| (cut.of.family, cut.of.line);
    let mut own = cuts.split_off(first);
    own.sort_by_key(|cut| (line_of(cut), cut.ends[0]));
    for line in own.chunk_by(|a, b| line_of(a) == line_of(b)) {
        let following = |cut: &Cut| {
            let next = line.partition_point(|other| other.ends[0] < cut.ends[1]);
            (line.get(next).is_some_and(|other| other.ends[0] == cut.ends[1])).then_some(next)
        };
        let mut follows = vec![false; line.len()];
        for next in line.iter().filter_map(following) {
            follows[next] = true;
        }
        for (i, start) in line.iter().enumerate() {
            if follows[i] {
                continue;
            }
            let mut whole = *start;
            let mut last = *start;
            while let Some(next) = following(&last) {
                last = line[next];
            }
            whole.ends[1] = last.ends[1];
            whole.of.at[1] = last.of.at[1];
            whole.within = triangles;
            cuts.push(whole);
        }
    }
}

/// Adds segments and the points at their ends, the same one for all that meet there.
fn add(cuts: &[Cut], scene: &Scene, families: &Families, segments: &mut ViewSegments) {
    let line_of = |cut: &Cut| (cut.of.family, cut.of.line);
    let groups: Vec<&[Cut]> = cuts.chunk_by(|a, b| line_of(a) == line_of(b)).collect();
    let places: Vec<Vec<Place>> = groups
        .par_iter()
        .map(|cuts| {
            let mut places: Vec<Place> =
                cuts.iter().flat_map(|cut| cut.ends).filter(|[a, b]| a != b).collect();
            places.sort_unstable();
            places.dedup();
            places
        })
        .collect();
    let positions = scene.mesh().positions();
    let points: Vec<PiercePoint> = groups
        .par_iter()
        .zip(&places)
        .flat_map_iter(|(cuts, places)| {
            let HatchSegment { family, line, .. } = cuts[0].of;
            let plane = families.all[family as usize].plane(line);
            places.iter().map(move |&edge| PiercePoint::on_plane(positions, edge, plane))
        })
        .collect();
    let mut first = segments.n_points() as u32;
    segments.extend_points(points);
    for (cuts, places) in groups.iter().zip(&places) {
        for cut in *cuts {
            let number = |place: Place| match place {
                [a, b] if a == b => a,
                _ => first + places.partition_point(|known| *known < place) as u32,
            };
            segments.push_within(cut.ends.map(number), StrokeKind::Hatch, cut.within);
        }
        first += places.len() as u32;
    }
}
