//! Folds as edges of triangles, so that the outline of the triangles follows the fold of the function.
//!
//! ```text
//!        ●  Φ > 0           Each edge between vertices of different sides has a new vertex where the
//!       ╱ ╲                 function itself folds, on the function, shared by the triangles on both
//!      ×━━━×  Φ = 0         sides of it. A vertex that is nearly on the fold is taken to be on it:
//!     ╱  ╱  ╲               its image is off that of the fold by the square of the distance only, and
//!    ●───────●  Φ < 0       triangles stay wide.
//! ```
//!
//! Which edges are drawn is then decided for the triangles; see `fold_lines`.

use std::ops::Range;

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};

use super::fold_lines::{SidedTriangle, fold_lines};
use super::folds::{FoldFunction, FoldView};
use super::lined_mesh::{LinedMesh, SurfaceLine};
use crate::predicates::{Sign, orient2d};
use crate::strokes::{StrokeKind, SurfacePart};

/// A vertex is on a fold that crosses one of its edges within this part of it.
const NEAR_VERTEX: f64 = 1.0 / 8.0;

/// Where a lattice has no normal, that of a place beside is taken, by this part of the way to its middle.
const BESIDE_POLE: f64 = 1e-6;

/// The folds of one sheet.
pub(super) struct SheetFolds {
    pub(super) function: FoldFunction,
    /// u and v of the first vertices of the sheet, for those that are not in plan.
    pub(super) parameters: Vec<DVec2>,
    /// Whether triangles have their upper sides where the function has its lower side.
    pub(super) is_turned: bool,
}

/// Where an edge is cut.
#[derive(Debug, Clone, Copy)]
struct Cut {
    edge: [u32; 2],
    /// As a part of the way from the first end.
    t: f64,
    point: DVec3,
}

/// What became of triangles that were cut.
pub(super) struct FoldPieces {
    /// For each triangle the one that it is a piece of.
    pub(super) origins: Vec<u32>,
    /// The edges that were cut, lower ends first, and the vertices on them.
    pub(super) cuts: Vec<([u32; 2], u32)>,
}

impl LinedMesh {
    /// Cuts triangles along the folds of the functions of the sheets, and lines where they cross folds.
    /// Sheets are cut in their order; at edges that they share the first one decides. O(triangles).
    pub(super) fn add_folds(&mut self, folds: &[SheetFolds], view: &FoldView) -> FoldPieces {
        let twins = self.first_twins(folds.iter().all(|of| of.function.is_in_plan()));
        let mut cuts: FxHashMap<[u32; 2], u32> = FxHashMap::default();
        let mut starts: Vec<usize> = self.sheets.iter().map(|sheet| sheet.first_triangle).collect();
        if starts.is_empty() {
            starts.push(0);
        }
        let ends = starts.iter().skip(1).copied().chain([self.triangles.len()]);
        let ranges: Vec<Range<usize>> =
            starts.iter().zip(ends).map(|(start, end)| *start..end).collect();
        let mut triangles = Vec::with_capacity(self.triangles.len());
        let mut origins = Vec::with_capacity(self.triangles.len());
        let mut firsts = Vec::with_capacity(ranges.len());
        let mut sided = Vec::with_capacity(self.triangles.len());
        let mut sides = vec![vec![0_i8; self.positions.len()]; ranges.len().min(folds.len())];
        let mut found: Vec<Vec<Cut>> = Vec::with_capacity(sides.len());
        for ((range, folds), sides) in ranges.iter().zip(folds).zip(&mut sides) {
            let rim_from = self.sheets.get(found.len()).map_or(u32::MAX, |sheet| sheet.rim_from);
            let of_sheet = &self.triangles[range.clone()];
            let known: FxHashSet<[u32; 2]> = found.iter().flatten().map(|cut| cut.edge).collect();
            found.push(self.cuts_of(of_sheet, folds, &twins, rim_from, &known, sides));
        }
        let mut twin_in_plan = self.twins_in_plan(&ranges, &twins);
        if !twin_in_plan.is_empty() {
            self.cut_alike(folds, &twins, &twin_in_plan, &mut found);
        }
        for cut in found.iter().flatten() {
            cuts.insert(cut.edge, self.positions.len() as u32);
            self.positions.push(cut.point);
        }
        if !twin_in_plan.is_empty() {
            for cut in found.iter().flatten() {
                let twin = key(&twins, cut.edge.map(|vertex| twin_in_plan[vertex as usize]));
                twin_in_plan.push(cuts.get(&twin).copied().unwrap_or(u32::MAX));
            }
        }
        for (k, range) in ranges.into_iter().enumerate() {
            firsts.push(triangles.len());
            let of_sheet = &self.triangles[range.clone()];
            let Some(folds) = folds.get(k) else {
                origins.extend(range.start as u32..range.end as u32);
                triangles.extend_from_slice(of_sheet);
                continue;
            };
            let sides = &sides[k];
            let is_front = |corners: [u32; 3]| {
                view.is_front(corners.map(|vertex| self.positions[vertex as usize]))
            };
            let cut = |ends: [u32; 2]| cuts.get(&key(&twins, ends)).copied();
            let first = triangles.len();
            let has_rim = self.sheets.get(k).is_some_and(|sheet| sheet.rim_from < u32::MAX);
            let both = |corners: [u32; 3]| {
                let other = corners.map(|v| twin_in_plan.get(v as usize).copied());
                let other = other.map(|v| v.filter(|v| *v != u32::MAX));
                let other = match other {
                    [Some(a), Some(b), Some(c)] => is_front([a, b, c]),
                    _ => false,
                };
                [is_front(corners), other]
            };
            let sheet = u16::try_from(k + 1).unwrap_or(u16::MAX);
            for (corners, origin) in of_sheet.iter().zip(range.start as u32..) {
                split(*corners, &cut, &both, &mut triangles);
                origins.resize(triangles.len(), origin);
            }
            let n_before = twins.len() as u32;
            let twin =
                |vertex: u32| if vertex < n_before { twins[vertex as usize] } else { vertex };
            let side =
                |vertex: u32| sides.get(twin(vertex) as usize).map_or(0, |side| i32::from(*side));
            sided.par_extend(triangles[first..].par_iter().map(|corners| {
                let is_front = is_front(*corners);
                let sides = corners.map(side);
                let side = match sides.iter().sum::<i32>() {
                    0 => is_front,
                    side => (side > 0) != folds.is_turned,
                };
                let is_on_fold = sides.contains(&0);
                let corners = corners.map(twin);
                SidedTriangle { corners, sheet, is_on_fold, has_rim, side, is_front }
            }));
        }
        for (sheet, first) in self.sheets.iter_mut().zip(firsts) {
            sheet.first_triangle = first;
        }
        self.triangles = triangles;
        let mut lines = Vec::with_capacity(self.lines.len());
        for line in &self.lines {
            let [a, b] = line.ends;
            match cuts.get(&key(&twins, line.ends)) {
                Some(&m) => {
                    lines.extend([[a, m], [m, b]].map(|ends| SurfaceLine { ends, ..*line }))
                }
                None => lines.push(*line),
            }
        }
        self.lines = lines;
        let image = |vertex: u32| {
            view.camera.image(self.positions[vertex as usize]) * view.mm_per_image_unit
        };
        for (ends, sheet) in fold_lines(&sided, image) {
            let part = SurfacePart { sheet, ..SurfacePart::default() };
            self.lines.push(SurfaceLine { ends, kind: StrokeKind::Silhouette, part });
        }
        self.has_folds = true;
        FoldPieces { origins, cuts: cuts.into_iter().collect() }
    }

    /// For each vertex the first one at the same place: sheets share rims, and lattices meet at seams.
    fn first_twins(&self, is_in_plan: bool) -> Vec<u32> {
        if is_in_plan && self.sheets.len() < 2 {
            return (0..self.positions.len() as u32).collect();
        }
        let mut first: FxHashMap<[u64; 3], u32> = FxHashMap::default();
        let key = |p: &DVec3| (*p + 0.0).to_array().map(f64::to_bits);
        let number = |(p, vertex): (&DVec3, u32)| *first.entry(key(p)).or_insert(vertex);
        self.positions.iter().zip(0..).map(number).collect()
    }

    /// For each vertex the one above or below it, if the mesh is two sheets with the same triangles in plan
    /// that meet along their whole border; otherwise none.
    fn twins_in_plan(&self, ranges: &[Range<usize>], first_twins: &[u32]) -> Vec<u32> {
        let [one, other] = ranges else { return Vec::new() };
        let [one, other] = [one, other].map(|range| &self.triangles[range.clone()]);
        let plan = |vertex: u32| self.positions[vertex as usize].truncate();
        let is_alike = |(a, b): (&[u32; 3], &[u32; 3])| (0..3).all(|k| plan(a[k]) == plan(b[k]));
        let is_shared = |vertex: &u32| first_twins[*vertex as usize] != *vertex;
        let meet = || border(other).iter().flatten().all(is_shared);
        if !other.iter().flatten().any(is_shared)
            || !meet()
            || one.len() != other.len()
            || !one.par_iter().zip(other).all(is_alike)
        {
            return Vec::new();
        }
        let mut twins = vec![u32::MAX; self.positions.len()];
        for (&a, &b) in one.iter().flatten().zip(other.iter().flatten()) {
            (twins[a as usize], twins[b as usize]) = (b, a);
        }
        twins
    }

    /// Cuts two sheets at the same places in plan, so that their triangles lie over each other. Where both
    /// have a fold on one edge, the first decides.
    fn cut_alike(
        &self,
        folds: &[SheetFolds],
        twins: &[u32],
        twin_in_plan: &[u32],
        found: &mut [Vec<Cut>],
    ) {
        let [of_one, of_other] = folds else { return };
        let [one, other] = found else { return };
        let mut room = Vec::new();
        let mut alike = |of: &SheetFolds, cut: &Cut| {
            let [a, b] = cut.edge.map(|vertex| twin_in_plan[vertex as usize]);
            let edge = key(twins, [a, b]);
            let [from, to] = [a, b].map(|vertex| self.positions[vertex as usize]);
            let place = cut.point.truncate();
            let z = of.function.at(place, &mut room).position.z;
            let point = place.extend(if z.is_finite() { z } else { from.lerp(to, cut.t).z });
            let t = if edge[0] == twins[a as usize] { cut.t } else { 1.0 - cut.t };
            (edge != cut.edge).then_some(Cut { edge, t, point })
        };
        let from_one: Vec<Cut> = one.iter().filter_map(|cut| alike(of_other, cut)).collect();
        let edges: FxHashSet<[u32; 2]> = from_one.iter().map(|cut| cut.edge).collect();
        other.retain(|cut| !edges.contains(&cut.edge));
        one.extend(other.iter().filter_map(|cut| alike(of_one, cut)).collect::<Vec<_>>());
        other.extend(from_one);
    }

    /// The cuts of a sheet's edges that are not cut yet. Sets the sides of its vertices.
    fn cuts_of(
        &self,
        triangles: &[[u32; 3]],
        folds: &SheetFolds,
        twins: &[u32],
        rim_from: u32,
        known: &FxHashSet<[u32; 2]>,
        sides: &mut [i8],
    ) -> Vec<Cut> {
        let place = |vertex: u32| match folds.function.is_in_plan() {
            true => self.positions[vertex as usize].truncate(),
            false => folds.parameters.get(vertex as usize).copied().unwrap_or(DVec2::NAN),
        };
        let middle = folds.parameters.iter().sum::<DVec2>() / folds.parameters.len().max(1) as f64;
        let facing = |room: &mut Vec<_>, vertex: u32| {
            let place = place(vertex);
            let facing = folds.function.at(place, room).facing;
            // A pole has the normal of what is around it.
            let beside = || place.lerp(middle, BESIDE_POLE);
            if facing.is_nan() { folds.function.at(beside(), room).facing } else { facing }
        };
        let mut vertices = vec![false; self.positions.len()];
        triangles.iter().flatten().for_each(|&vertex| vertices[vertex as usize] = true);
        let of_vertex = |room: &mut Vec<_>, (&is_used, vertex)| {
            if is_used { facing(room, vertex) } else { f64::NAN }
        };
        let numbered = vertices.par_iter().zip(0..self.positions.len() as u32);
        let facings: Vec<f64> = numbered.map_init(Vec::new, of_vertex).collect();
        for ((facing, twin), _) in
            facings.iter().zip(twins).zip(&vertices).filter(|(_, used)| **used)
        {
            let is_known = !facing.is_nan();
            sides[*twin as usize] = i8::from(is_known && *facing >= 0.0) - i8::from(*facing < 0.0);
        }
        let is_fold = |ends: &[u32; 2]| {
            let [a, b] = ends.map(|vertex| facings[vertex as usize]);
            a >= 0.0 && b < 0.0 || a < 0.0 && b >= 0.0
        };
        let mut edges: Vec<([u32; 2], [u32; 2], u32)> = triangles
            .par_iter()
            .flat_map_iter(|&[a, b, c]| [[a, b], [b, c], [c, a]])
            .filter(is_fold)
            .map(|ends| (key(twins, ends), ends, 1))
            .filter(|(key, ..)| key[0] != key[1] && !known.contains(key))
            .collect();
        edges.par_sort_unstable();
        edges.dedup_by(|next, first| {
            let is_same = next.0 == first.0;
            first.2 += u32::from(is_same);
            is_same
        });
        let cut = |room: &mut Vec<_>, &(edge, ends, n): &([u32; 2], [u32; 2], u32)| {
            let at = ends.map(|vertex| facings[vertex as usize]);
            let (t, found) = folds.function.between(ends.map(place), at, room)?;
            let [a, b] = ends.map(|vertex| self.positions[vertex as usize]);
            // Another sheet may end at the same rim, which is straight between its points.
            let is_rim = n == 1 && ends.iter().any(|vertex| *vertex >= rim_from);
            let point = if is_rim { on_rim(a, b, t) } else { found.position };
            let is_in_order = edge[0] == twins[ends[0] as usize];
            Some(Cut { edge, t: if is_in_order { t } else { 1.0 - t }, point })
        };
        let mut cuts: Vec<Cut> =
            edges.par_iter().map_init(Vec::new, cut).filter_map(|cut| cut).collect();
        for Cut { edge: [a, b], t, .. } in &cuts {
            if *t < NEAR_VERTEX {
                sides[*a as usize] = 0;
            } else if *t > 1.0 - NEAR_VERTEX {
                sides[*b as usize] = 0;
            }
        }
        cuts.retain(|cut| cut.edge.iter().all(|&vertex| sides[vertex as usize] != 0));
        cuts
    }
}

/// A point of a straight rim, at a part of the way along it. Surfaces lie to the left of their rims, which
/// stay convex in plan where they are: where the point would be rounded into the surface, it moves outwards.
fn on_rim(a: DVec3, b: DVec3, t: f64) -> DVec3 {
    let point = a + t * (b - a);
    let turn = |p: DVec3| orient2d(a.truncate(), p.truncate(), b.truncate());
    if turn(point) != Sign::Negative {
        return point;
    }
    let along = b - a;
    let step = |x: f64, outwards: f64| if outwards > 0.0 { x.next_up() } else { x.next_down() };
    let aside = [
        DVec3 { x: step(point.x, along.y), ..point },
        DVec3 { y: step(point.y, -along.x), ..point },
    ];
    aside.into_iter().find(|p| turn(*p) != Sign::Negative).unwrap_or(point)
}

/// The edges of some triangles that only one of them has.
fn border(triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let sides = triangles.par_iter().flat_map_iter(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let mut sides: Vec<[u32; 2]> = sides.map(|[a, b]| [a.min(b), a.max(b)]).collect();
    sides.par_sort_unstable();
    sides.chunk_by(|a, b| a == b).filter(|uses| uses.len() == 1).map(|uses| uses[0]).collect()
}

/// An edge by the first vertices at its ends.
fn key(twins: &[u32], [a, b]: [u32; 2]) -> [u32; 2] {
    let [a, b] = [a, b].map(|vertex| twins[vertex as usize]);
    [a.min(b), a.max(b)]
}

/// Splits a triangle at the vertices that cut its sides. `facing` says which way the triangle faces, and
/// the one above or below it that is to be split alike.
fn split(
    corners: [u32; 3],
    cut: &impl Fn([u32; 2]) -> Option<u32>,
    facing: &impl Fn([u32; 3]) -> [bool; 2],
    out: &mut Vec<[u32; 3]>,
) {
    let [a, b, c] = corners;
    match [[a, b], [b, c], [c, a]].map(cut) {
        [None, None, None] => out.push(corners),
        [Some(m), None, None] => out.extend([[a, m, c], [m, b, c]]),
        [Some(m), Some(n), None] => {
            let tip = [m, b, n];
            let halves = [[[a, m, n], [a, n, c]], [[a, m, c], [m, n, c]]];
            let of_tip = facing(tip);
            let n_behind = |half: [[u32; 3]; 2]| {
                let n = |of: [bool; 2]| (0..2).filter(|&k| of[k] != of_tip[k]).count();
                half.into_iter().map(|triangle| n(facing(triangle))).sum::<usize>()
            };
            out.push(tip);
            out.extend(if n_behind(halves[1]) > n_behind(halves[0]) {
                halves[1]
            } else {
                halves[0]
            });
        }
        // The next corner first.
        [Some(_), None, Some(_)] => split([c, a, b], cut, facing, out),
        [None, ..] => split([b, c, a], cut, facing, out),
        [Some(m), Some(n), Some(o)] => out.extend([[a, m, o], [m, b, n], [n, c, o], [m, n, o]]),
    }
}
