//! Outlines of shadows, as lines.
//!
//! ```text
//!       ☼   ┌──┐         Lines where the surface ends, as the light sees it, throw their own shadows onto
//!           │  │╲        what lies behind them (module `engines::edge::lifted`). These are outlines of
//!     ──────└──┘─╲───    shadows exactly where the light is kept from one of their sides and not from
//!            ╲____╲      the other.
//! ```
//!
//! The shadow of an edge has the edge's image in the light's view, so the triangles beside the edge cover
//! only one side of it each; whatever covers both sides makes it the inside of a larger shadow.
//!
//! Where a curved surface turns away from the light its own shadow has no outline here.

use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::ground::ground_height;
use super::options::{Ground, HatchError};
use crate::camera::Camera;
use crate::chain::{ChainOptions, chain};
use crate::classify::{LineSelection, ViewSegments, ViewedScene};
use crate::draw::DrawOptions;
use crate::engines::edge::lifted::{Lifted, lifted};
use crate::engines::edge::{VisibilityOptions, roberts};
use crate::engines::visibility::{Span, Visibility};
use crate::model::scene::Scene;
use crate::predicates::{CutPlane, FreePlane, PiercePoint, Screen, Sign, Viewpoint};
use crate::shading::light::{Light, LightSource};
use crate::strokes::{StrokeKind, Strokes};

/// Draws the outlines of the shadows that `light` casts on the faces of `scene` and on the ground.
///
/// Of `lines` the contact tolerance counts, whether the drawing is exact, and the shortest stroke.
///
/// # Errors
/// See [`HatchError`].
pub fn shadow_outlines(
    scene: &Scene,
    camera: &Camera,
    light: LightSource,
    ground: Option<Ground>,
    lines: &DrawOptions,
    mm_per_unit: f64,
) -> Result<Strokes, HatchError> {
    let Some(bounds) = scene.mesh().bounds() else { return Ok(Strokes::default()) };
    let light = Light::new(light, camera);
    let light_camera = light.camera(bounds)?;
    let casting = super::gap::outlines();
    let from_light = ViewedScene::new(scene, &light_camera, casting, 180.0);
    let to_eye = ViewedScene::new(scene, camera, LineSelection::NONE, 180.0);
    let is_lit_side = |triangle: u32| {
        let [to_eye, to_light] =
            [&to_eye, &from_light].map(|view| view.triangle_turns()[triangle as usize]);
        to_eye == to_light && to_eye != Sign::Zero
    };
    let mut segments = ViewSegments::new(scene);
    let shadows = lifted(&from_light, is_lit_side);
    add(&from_light, &shadows, &mut segments);
    if let Some(ground) = ground {
        let z = ground_height(ground, bounds.0);
        if !light.is_above(z) {
            return Err(HatchError::Horizon);
        }
        if camera.is_above(z) {
            add_on_ground(&from_light, z, &mut segments);
        }
    }
    drop((from_light, to_eye));

    let options = VisibilityOptions {
        contact_tolerance: lines.contact_tolerance_in(scene),
        count_layers: false,
        find_doubled: false,
        ..VisibilityOptions::EXACT
    };
    let none = LineSelection::NONE;
    let view = ViewedScene::with_segments(scene, camera, none, 180.0, &segments);
    let (seen, _) = roberts::solve(&view, &options);
    let of_light = ViewedScene::with_segments(scene, &light_camera, none, 180.0, &segments);
    let borders = roberts::solve_borders(&of_light, &options);
    let both = both(&view, &seen, &of_light, &borders);
    let chaining = ChainOptions {
        hidden: false,
        hidden_levels: None,
        exact: lines.exact,
        apart_by_kind: false,
        shortest: if lines.exact { 0.0 } else { lines.shortest_stroke_mm / mm_per_unit },
    };
    Ok(chain(&view, &both, None, &chaining))
}

/// What a point at the end of a shadow is; equal places are one point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
enum Place {
    Vertex(u32),
    /// The shadow of a vertex on a triangle.
    Cast(u32, u32),
    /// Where the shadow of a line crosses a side of triangles.
    Side([u32; 2], [u32; 2]),
    /// Where a line pierces a triangle.
    Pierced([u32; 2], u32),
}

/// Adds the shadows on triangles.
fn add(view: &ViewedScene, shadows: &[Lifted], segments: &mut ViewSegments) {
    let places: Vec<Option<[Place; 2]>> =
        shadows.par_iter().map(|shadow| places(view, shadow)).collect();
    let mut distinct: Vec<Place> = places.iter().flatten().flatten().copied().collect();
    distinct.par_sort_unstable();
    distinct.dedup();
    distinct.retain(|place| !matches!(place, Place::Vertex(_)));
    let points: Vec<PiercePoint> =
        distinct.par_iter().map(|&place| construct(view, place)).collect();
    let first = segments.n_points() as u32;
    segments.extend_points(points);
    let number: FxHashMap<Place, u32> = distinct.into_iter().zip(first..).collect();
    for (shadow, places) in shadows.iter().zip(places) {
        let Some(places) = places else { continue };
        let ends = places.map(|place| match place {
            Place::Vertex(vertex) => vertex,
            _ => number.get(&place).copied().unwrap_or_default(),
        });
        if ends[0] != ends[1] {
            let triangle = shadow.triangle;
            segments.push_within(ends, StrokeKind::Shadow, [triangle, triangle + 1]);
        }
    }
}

/// The places of a shadow's ends; `None` where the near plane cuts.
fn places(view: &ViewedScene, shadow: &Lifted) -> Option<[Place; 2]> {
    let [a, b] = shadow.line;
    let line = [a.min(b), a.max(b)];
    let corners = view.scene().triangles()[shadow.triangle as usize];
    let mut places = [Place::Vertex(0); 2];
    for (i, place) in places.iter_mut().enumerate() {
        *place = match shadow.ends[i] {
            CutPlane::End => {
                let vertex = shadow.line[i];
                match view.sight().depth(corners, vertex) {
                    Sign::Zero => Place::Vertex(vertex),
                    _ => Place::Cast(vertex, shadow.triangle),
                }
            }
            CutPlane::Sight(p, q) => {
                match [p, q].into_iter().find(|&v| view.sight().turn(a, b, v) == Sign::Zero) {
                    Some(vertex) => Place::Vertex(vertex),
                    None => Place::Side([p, q], line),
                }
            }
            CutPlane::Triangle(_) => Place::Pierced(line, shadow.triangle),
            CutPlane::Near | CutPlane::NearCut(_) => return None,
        };
    }
    Some(places)
}

fn construct(view: &ViewedScene, place: Place) -> PiercePoint {
    let scene = view.scene();
    let positions = scene.mesh().positions();
    let at = |vertex: u32| positions[vertex as usize];
    let corners = |triangle: u32| scene.triangles()[triangle as usize];
    let light = view.sight().viewpoint();
    match place {
        Place::Vertex(vertex) => PiercePoint::vertex(at(vertex)),
        Place::Cast(vertex, triangle) => {
            PiercePoint::cast(light, at(vertex), &Screen::Triangle(corners(triangle).map(at)))
        }
        Place::Side(side, line) => PiercePoint::on_side(light, positions, line, side),
        Place::Pierced(line, triangle) => {
            PiercePoint::new(positions, line, corners(triangle), None)
        }
    }
}

/// Adds the shadows on the ground at height `z` of all that is above it.
fn add_on_ground(view: &ViewedScene, z: f64, segments: &mut ViewSegments) {
    let positions = view.scene().mesh().positions();
    let plane = FreePlane { normal: DVec3::Z, offset: z };
    let light = view.sight().viewpoint();
    let mut number: FxHashMap<u32, u32> = FxHashMap::default();
    let is_below_light = |p: DVec3| match light {
        Viewpoint::Eye(eye) => p.z < eye.z,
        Viewpoint::Direction(_) => true,
    };
    for drawn in view.selected() {
        let ends = view.line(drawn.edge);
        let at = ends.map(|end| positions[end as usize]);
        if at.iter().all(|p| p.z <= z) || !at.iter().all(|&p| is_below_light(p)) {
            continue;
        }
        let ends = [0, 1].map(|i| {
            if at[i].z < z {
                segments.push_point(PiercePoint::on_plane(positions, ends, plane))
            } else if at[i].z == z {
                ends[i]
            } else {
                *number.entry(ends[i]).or_insert_with(|| {
                    let screen = Screen::Free(plane);
                    segments.push_point(PiercePoint::cast(light, at[i], &screen))
                })
            }
        });
        segments.push(ends, StrokeKind::Shadow);
    }
}

/// What is seen and is a border: spans with `qi` 0, in the order of the view's lines.
fn both(
    view: &ViewedScene,
    seen: &Visibility,
    of_light: &ViewedScene,
    borders: &Visibility,
) -> Visibility {
    let place: FxHashMap<u32, usize> =
        of_light.selected().iter().enumerate().map(|(i, drawn)| (drawn.edge, i)).collect();
    let mut both = Visibility::default();
    let mut spans = Vec::new();
    for (i, drawn) in view.selected().iter().enumerate() {
        spans.clear();
        let borders = place.get(&drawn.edge).map_or(&[][..], |&place| borders.spans(place));
        let mut at = 0.0;
        let mut push = |t0: f64, t1: f64, qi: u32| {
            if t0 < t1 {
                spans.push(Span { t0, t1, qi, doubled: false });
            }
        };
        for span in seen.spans(i).iter().filter(|span| span.qi == 0) {
            for border in borders.iter().filter(|border| border.qi == 0) {
                let (t0, t1) = (span.t0.max(border.t0), span.t1.min(border.t1));
                if t0 < t1 {
                    push(at, t0, 1);
                    push(t0, t1, 0);
                    at = t1;
                }
            }
        }
        push(at, 1.0, 1);
        both.push(&spans);
    }
    both
}
