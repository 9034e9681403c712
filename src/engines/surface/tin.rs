//! Max-Min patches over a triangulation: any surface z = f(x, y) made of triangles over a convex
//! domain, such as scattered points, a grid with level curves, or a formula over a disk; also two
//! such surfaces that meet along the border, such as a sphere.
//!
//! ```text
//!       ╱╲ 3 ╱╲       Front to back: of two triangles that share an edge, the one on the eye's
//!      ╱ 2╲ ╱ 4╲      side of it in plan comes first. Each triangle tests its far edges, which
//!      ╲  ╱╲  ╱       then hide. Its near edges were far edges of earlier triangles, except on
//!       ╲╱ 1╲╱        the border of the domain.
//!         ●           the eye's foot
//! ```
//!
//! Parts around the eye, strips, horizons and radial edges work as in [`max_min`](super::max_min).
//! Delaunay triangulations can always be ordered this way (L. De Floriani, B. Falcidieno, G. Nagy
//! and C. Pienovi, "On sorting triangles in a Delaunay tessellation", Algorithmica 6, 1991); others
//! are tried for each view. When triangles form a cycle, or when the domain has holes or bays to look
//! through, the engine declines and a mesh engine draws. O(triangles + crossings).
//!
//! # Two sheets
//!
//! Source: Vega-Páez, Ortega and Pulido 2008, section 6.2, the sphere. Two sheets that meet along the
//! whole border share their horizons. In a vertical plane through the eye both sheets start at the
//! same border point, so all that is nearer than a point still covers one interval of heights. The
//! upper sheet alone is its maximum and the lower sheet alone its minimum. So the upper sheet is
//! tested against the upper horizon and the lower sheet against the lower one, each front to back;
//! the shared border is visible where either says so. When the eye is above or below the domain it
//! sees one sheet only. When it is between the sheets, the engine declines.
//!
//! Coherence: object coherence (the order in plan settles depth once for each view), and edge
//! coherence (a horizon is changed next to its last change).

use std::cmp::Ordering;
use std::sync::atomic::AtomicU8;

use glam::DVec3;
use rayon::prelude::*;

use super::HorizonCounts;
use super::max_min::strips;
use super::pieces::{GridPieces, HIDDEN, LOWER, PARTLY, UPPER};
use super::plan_predicates::{PlanSight, over_plane};
use super::plan_triangle::{Facing, PlanTriangle, Side, facing, signs};
use super::segment::{HorizonPlane, HorizonVertex, Samples};
use super::strip::HorizonStrip;
use crate::camera::{Camera, Projection};
use crate::classify::ViewedScene;
use crate::engines::visibility::{Span, Visibility};
use crate::model::scene::Scene;
use crate::predicates::{Kept, Sign};

mod sheets;

use self::sheets::{Sheets, is_border};

/// About how many triangles of a part one strip takes.
const TRIANGLES_PER_STRIP: usize = 60_000;

/// Finds the visible parts of the drawn edges. Hidden parts get quantitative invisibility 1.
///
/// `None` when the scene is neither a function over a convex domain nor two that meet along its
/// border, when triangles hide each other in a cycle, when the eye is on the surface or between two
/// sheets, when the near plane cuts a triangle, or when lines are drawn that are not edges of
/// triangles.
pub fn solve(view: &ViewedScene) -> Option<(Visibility, HorizonCounts)> {
    solve_in_strips(view, TRIANGLES_PER_STRIP)
}

/// Like [`solve`], with strips of about `triangles_per_strip` triangles. The result is the same up to
/// the rounding of where pieces end.
pub fn solve_in_strips(
    view: &ViewedScene,
    triangles_per_strip: usize,
) -> Option<(Visibility, HorizonCounts)> {
    let scene = view.scene();
    let n_edges = scene.topology().edges().len();
    let has_others = view.selected().last().is_some_and(|drawn| drawn.edge as usize >= n_edges);
    let sheets = Sheets::of(scene)?;
    if has_others || !is_clear_of_near_plane(view) {
        return None;
    }
    let camera = view.camera();
    let forward = camera.forward();
    let is_perspective = matches!(camera.projection(), Projection::Perspective { .. });
    let pieces = if !is_perspective && forward.x == 0.0 && forward.y == 0.0 {
        let n_edges = scene.topology().edges().len() as u32;
        let seen = if forward.z < 0.0 { UPPER } else { LOWER };
        let status = |edge| if sheets.faces_up_or_down(scene, edge, seen) { seen } else { HIDDEN };
        GridPieces::join(0, 0, (0..n_edges).map(status).collect(), Vec::new())
    } else {
        sweep(&Tin::new(scene, camera)?, &sheets, triangles_per_strip)?
    };
    Some((visibility(view, &pieces), pieces.work))
}

/// Whether every triangle is beyond the near plane, or wholly behind the eye, where it hides nothing.
fn is_clear_of_near_plane(view: &ViewedScene) -> bool {
    let (camera, positions) = (view.camera(), view.scene().mesh().positions());
    let is_behind = |v: u32| (positions[v as usize] - camera.eye()).dot(camera.forward()) <= 0.0;
    let is_clear = |triangle: u32| {
        view.kept(triangle) == Kept::All
            || view.scene().triangles()[triangle as usize].into_iter().all(is_behind)
    };
    let triangles = 0..view.scene().triangles().len() as u32;
    !view.near_plane_cuts() || triangles.into_par_iter().all(is_clear)
}

/// A triangulated surface as one camera sees it.
struct Tin<'a> {
    scene: &'a Scene,
    /// For each triangle its edges and where the eye is relative to them, from its first corner on.
    sides: Vec<[(u32, Facing); 3]>,
    /// The triangles from the eye outwards.
    order: Vec<u32>,
    camera: Camera,
    /// The eye, or a fixed point in the middle.
    center: DVec3,
    /// Greatest distance of a vertex from it along each axis.
    size: DVec3,
    is_perspective: bool,
}

impl Samples for Tin<'_> {
    fn point(&self, sample: u32) -> DVec3 {
        self.scene.mesh().positions()[sample as usize]
    }
}

impl<'a> Tin<'a> {
    /// `None` when triangles come before each other in turn.
    fn new(scene: &'a Scene, camera: &Camera) -> Option<Self> {
        let is_perspective = matches!(camera.projection(), Projection::Perspective { .. });
        let (low, high) = scene.mesh().bounds()?;
        let center = if is_perspective { camera.eye() } else { low + 0.5 * (high - low) };
        let size = (high - center).abs().max((low - center).abs());
        let positions = scene.mesh().positions();
        let (sx, sy) = signs(camera);
        let sight = PlanSight::new(camera, sx, sy, center);
        let facing = |a: u32, b: u32| facing(&sight, [a, b].map(|v| positions[v as usize]));
        let topology = scene.topology();
        let sides: Vec<[(u32, Facing); 3]> = scene
            .triangles()
            .par_iter()
            .map(|&[a, b, c]| {
                [(a, b), (b, c), (c, a)].map(|(a, b)| {
                    let edge = topology.find_edge(a.min(b), a.max(b)).unwrap_or_default();
                    (edge, facing(a, b))
                })
            })
            .collect();
        let order = outwards(scene, &sides)?;
        Some(Self { scene, sides, order, camera: *camera, center, size, is_perspective })
    }

    /// Which horizons each sheet is tested against, (upper, lower). `None` with the eye on the surface
    /// or between two sheets.
    fn horizons(&self, sheets: &Sheets) -> Option<[(bool, bool); 2]> {
        let holds_eye = |sides: &[(u32, Facing); 3]| {
            self.is_perspective && sides.iter().all(|(_, facing)| *facing != Facing::Near)
        };
        let over = |sheet: usize| {
            let mut triangles = (0..).zip(&self.sides);
            let own = |triangle: u32| sheets.sheet(triangle) == sheet;
            let (triangle, _) = triangles.find(|&(t, sides)| own(t) && holds_eye(sides))?;
            let [a, b, c] = self.scene.triangles()[triangle as usize].map(|v| self.point(v));
            Some(over_plane(self.camera.eye(), a, b, c))
        };
        let is_two = sheets.n() == 2;
        let (upper, lower) = (over(0), if is_two { over(1) } else { None });
        match (upper, lower) {
            (None, None) if is_two => Some([(true, false), (false, true)]),
            (None, None) => Some([(true, true); 2]),
            (Some(Ordering::Greater), None | Some(Ordering::Greater)) => {
                Some([(true, false), (false, false)])
            }
            (Some(Ordering::Less), None) => Some([(false, true); 2]),
            (Some(Ordering::Less), Some(Ordering::Less)) => Some([(false, false), (false, true)]),
            // Between two sheets; or on the surface, where the near plane cuts the triangle around the
            // eye or a neighbor, so that nothing is left to draw by the time this is asked.
            _ => None,
        }
    }

    fn is_border(&self, edge: u32) -> bool {
        is_border(self.scene, edge)
    }
}

/// The triangles front to back: of two that share an edge inside a sheet, the one on the eye's side
/// comes first. `None` when there is no such order. Depth first, so that neighbors follow each other.
fn outwards(scene: &Scene, sides: &[[(u32, Facing); 3]]) -> Option<Vec<u32>> {
    let topology = scene.topology();
    let neighbor = |triangle: usize, edge: u32| {
        if is_border(scene, edge) {
            return None;
        }
        topology.uses(edge).iter().map(|used| used.face()).find(|&face| face as usize != triangle)
    };
    let mut n_before: Vec<u8> = Vec::with_capacity(sides.len());
    n_before.extend(sides.iter().enumerate().map(|(triangle, sides)| {
        let is_behind = |(edge, facing): &&(u32, Facing)| {
            *facing == Facing::Near && neighbor(triangle, *edge).is_some()
        };
        sides.iter().filter(is_behind).count() as u8
    }));
    let mut free: Vec<u32> =
        (0..).zip(&n_before).filter(|(_, n)| **n == 0).map(|(t, _)| t).collect();
    free.reverse();
    let mut order = Vec::with_capacity(sides.len());
    while let Some(triangle) = free.pop() {
        order.push(triangle);
        for (edge, facing) in sides[triangle as usize] {
            if let (Facing::Far, Some(behind)) = (facing, neighbor(triangle as usize, edge)) {
                let left = &mut n_before[behind as usize];
                *left -= 1;
                if *left == 0 {
                    free.push(behind);
                }
            }
        }
    }
    (order.len() == sides.len()).then_some(order)
}

/// A part of the domain with its vertices in the plane of horizons.
struct TinPart {
    sight: PlanSight,
    /// By number; only those within the part are right.
    vertices: Vec<HorizonVertex>,
}

fn sweep(tin: &Tin, sheets: &Sheets, triangles_per_strip: usize) -> Option<GridPieces> {
    let horizons = tin.horizons(sheets)?;
    let n_edges = tin.scene.topology().edges().len();
    let status: Vec<AtomicU8> = (0..n_edges).map(|_| AtomicU8::new(HIDDEN)).collect();
    let reflections = if tin.is_perspective {
        vec![(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)]
    } else {
        vec![signs(&tin.camera)]
    };
    let mut pieces = Vec::new();
    let mut work = HorizonCounts::default();
    for (sx, sy) in reflections {
        let sight = PlanSight::new(&tin.camera, sx, sy, tin.center);
        let plane = HorizonPlane::new(tin, sight, tin.size);
        let n_vertices = tin.scene.mesh().positions().len() as u32;
        let vertices = (0..n_vertices).into_par_iter().map(|v| plane.vertex(v)).collect();
        let part = TinPart { sight, vertices };
        for (sheet, horizons) in horizons.into_iter().enumerate().take(sheets.n()) {
            if horizons == (false, false) {
                continue;
            }
            let order: Vec<u32> =
                tin.order.iter().copied().filter(|&t| sheets.sheet(t) == sheet).collect();
            let ranges: Vec<Option<(f64, f64)>> =
                order.par_iter().map(|&triangle| part.range(tin, triangle)).collect();
            let middles = ranges.iter().flatten().map(|(from, to)| from + (to - from) / 2.0);
            let n_strips = ranges.iter().flatten().count() / triangles_per_strip.max(1);
            let strips = strips(middles.collect(), n_strips, &sight, tin.size);
            let margin = 4.0 * plane.du;
            let found: Vec<_> = strips
                .par_iter()
                .with_max_len(1)
                .map(|&(from, to)| {
                    let plane = HorizonPlane::new(tin, sight, tin.size);
                    let mut strip = HorizonStrip::new(plane, (from, to), horizons, &status);
                    let meets =
                        |range: &(f64, f64)| range.0 <= to + margin && range.1 >= from - margin;
                    for (&triangle, range) in order.iter().zip(&ranges) {
                        if range.as_ref().is_some_and(meets) {
                            part.visit(tin, triangle, &mut strip);
                        }
                    }
                    (strip.work(), strip.found)
                })
                .collect();
            for (strip_work, found) in found {
                work += strip_work;
                pieces.extend(found);
            }
        }
    }
    let status = status.into_iter().map(AtomicU8::into_inner).collect();
    let mut pieces = GridPieces::join(0, 0, status, pieces);
    pieces.work = work;
    Some(pieces)
}

impl TinPart {
    /// The range of u that a triangle is within; `None` when it has nothing in the part.
    fn range(&self, tin: &Tin, triangle: u32) -> Option<(f64, f64)> {
        let corners = tin.scene.triangles()[triangle as usize];
        let outside = corners.map(|v| self.sight.is_outside(tin.point(v)));
        if outside.iter().all(|o| o.0) || outside.iter().all(|o| o.1) {
            return None;
        }
        let mut range = (f64::INFINITY, f64::NEG_INFINITY);
        for (v, outside) in corners.into_iter().zip(outside) {
            let u = self.vertices[v as usize].u;
            // What is beyond x comes in at u = −1, what is beyond y at u = 1; the eye's foot, whose u
            // is not a number, is next to all.
            let (low, high) = match outside {
                (false, false) if !u.is_nan() => (u, u),
                (true, false) => (-1.0, -1.0),
                (false, true) => (1.0, 1.0),
                _ => (-1.0, 1.0),
            };
            range = (range.0.min(low), range.1.max(high));
        }
        Some(range)
    }

    /// Tests what a triangle adds and lets it hide.
    fn visit(&self, tin: &Tin, triangle: u32, strip: &mut HorizonStrip<Tin>) {
        let corners = tin.scene.triangles()[triangle as usize];
        let sides = tin.sides[triangle as usize].map(|(edge, facing)| Side {
            edge: Some(edge),
            facing,
            is_border: tin.is_border(edge),
        });
        let vertices = corners.map(|v| self.vertices[v as usize]);
        PlanTriangle { corners, sides }.visit(vertices, strip);
    }
}

/// The spans of the drawn edges.
fn visibility(view: &ViewedScene, pieces: &GridPieces) -> Visibility {
    let mut visibility = Visibility::default();
    let mut spans: Vec<Span> = Vec::new();
    for drawn in view.selected() {
        spans.clear();
        let ends = view.scene().topology().edge(drawn.edge);
        let is_kept = ends.iter().all(|&v| view.sight().near_distance(v).1 != Sign::Negative);
        let mut at = 0.0;
        let mut push = |t0: f64, t1: f64, qi: u32| {
            if t0 < t1 {
                spans.push(Span { t0, t1, qi, doubled: false });
            }
        };
        match pieces.status[drawn.edge as usize] {
            _ if !is_kept => {}
            HIDDEN => push(0.0, 1.0, 1),
            PARTLY => {
                let first = pieces.pieces.partition_point(|piece| piece.edge < drawn.edge);
                let own = pieces.pieces[first..].iter().take_while(|p| p.edge == drawn.edge);
                for piece in own {
                    push(at, piece.t0, 1);
                    push(piece.t0.max(at), piece.t1, 0);
                    at = piece.t1;
                }
                push(at, 1.0, 1);
            }
            _ => push(0.0, 1.0, 0),
        }
        visibility.push(&spans);
    }
    visibility
}
