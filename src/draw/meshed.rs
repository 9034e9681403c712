//! Surfaces of triangles: by [`tin`] where possible, otherwise by the mesh engines, which also draw
//! surfaces with holes, several sheets, and any shape in space.

use super::DrawOutput;
use crate::camera::Camera;
use crate::chain::{ChainOptions, chain};
use crate::classify::{DEFAULT_CREASE_DEG, LineSelection, SelectedLine, ViewedScene};
use crate::drafting::Drafted;
use crate::engines::edge::{LineCounts, LineEngine, VisibilityOptions, solve};
use crate::engines::surface::{max_min, tin};
use crate::engines::visibility::Visibility;
use crate::model::scene::Scene;
use crate::predicates::Sign;
use crate::strokes::{StrokeKind, SurfacePart};
use crate::surface::LinedScene;
use crate::timing::{Seconds, timed};

/// How a surface is drawn by a mesh engine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshedOptions {
    /// Which mesh engine; [`LineEngine::Auto`] first tries [`tin`].
    pub engine: LineEngine,
    /// Also edges between a front and a back triangle, unless the surface has its folds among its lines.
    /// They run along sides of triangles, so a fold of a smooth surface comes out as a zigzag within one
    /// row of cells, which is as narrow as the samples are close.
    pub folds: bool,
    /// Also edges with only one triangle.
    pub border: bool,
    /// Also lines in which sheets cross, as far as the scene knows them, and edges that they share
    /// there; see [`Scene::with_intersections`](crate::model::scene::Scene::with_intersections).
    pub intersections: bool,
    /// One two-point stroke for each maximal visible interval of each edge.
    pub exact: bool,
    /// Keep lines on the underside apart, that is where the triangles' backs are seen.
    pub underside: bool,
    /// Join only pieces of one kind.
    pub apart_by_kind: bool,
    /// Visible strokes shorter than this are dropped, in millimeters on paper.
    pub shortest_stroke_mm: f64,
}

/// Draws the lines of a surface as `camera` sees them.
///
/// The visible parts are exact for the triangles. `mm_per_unit` is the number of millimeters on paper
/// for one image unit, as for [`draw`](super::draw).
pub fn draw(
    surface: &LinedScene,
    camera: &Camera,
    options: &MeshedOptions,
    mm_per_unit: f64,
) -> DrawOutput {
    let mut seconds = Seconds::default();
    let view = timed(&mut seconds.classify, || view(surface, camera, options));
    let settings =
        VisibilityOptions { find_doubled: !options.exact, ..VisibilityOptions::default() };
    let mut n_exact = 0;
    let (visibility, counts, engine) = timed(&mut seconds.visibility, || {
        let by_horizons = if options.engine == LineEngine::Auto { tin::solve(&view) } else { None };
        match by_horizons {
            Some((visibility, work)) => {
                n_exact = work.exact;
                let candidate_pairs = work.comparisons;
                (visibility, LineCounts { candidate_pairs, ..LineCounts::default() }, max_min::NAME)
            }
            None => solve(&view, options.engine, &settings),
        }
    });
    n_exact += view.sight().n_exact();
    let chaining = ChainOptions {
        hidden: false,
        hidden_levels: None,
        exact: options.exact,
        apart_by_kind: options.apart_by_kind,
        shortest: if options.exact { 0.0 } else { options.shortest_stroke_mm / mm_per_unit },
    };
    let drawing = timed(&mut seconds.strokes, || {
        if !options.underside {
            return chain(&view, &visibility, None, &chaining);
        }
        let [upper, lower] = by_side(&view, &visibility)
            .map(|visibility| chain(&view, &visibility, None, &chaining));
        let mut drawing = upper;
        drawing.append_undersides(&lower);
        drawing
    });
    let n_lines = view.selected().len();
    let drafted = Drafted::default();
    DrawOutput { drawing, engine, n_lines, counts, n_exact, drafted, seconds }
}

/// The surface with its own lines and those of the view that the options ask for.
pub(super) fn view<'a>(
    surface: &'a LinedScene,
    camera: &Camera,
    options: &MeshedOptions,
) -> ViewedScene<'a> {
    let LinedScene { scene, lines, has_folds } = surface;
    let mut edges = lines.clone();
    let mut selection = LineSelection::NONE;
    for (is_wanted, kind) in [
        (options.folds && !has_folds, StrokeKind::Silhouette),
        (options.border, StrokeKind::Boundary),
        (options.intersections, StrokeKind::Intersection),
        (options.intersections, StrokeKind::Nonmanifold),
    ] {
        if is_wanted {
            selection = selection.with(kind);
        }
    }
    if selection != LineSelection::NONE {
        let of_the_view = ViewedScene::new(scene, camera, selection, DEFAULT_CREASE_DEG);
        edges.extend(of_the_view.selected().iter().map(|line| in_sheet(scene, *line)));
    }
    ViewedScene::with_edges(scene, camera, edges)
}

/// A fold or a piece of the border with the sheet that it belongs to. Intersection lines belong to none.
fn in_sheet(scene: &Scene, line: SelectedLine) -> SelectedLine {
    if !matches!(line.kind, StrokeKind::Silhouette | StrokeKind::Boundary) {
        return line;
    }
    let parts = scene.mesh().face_parts();
    let face = scene.topology().uses(line.edge).first().map(|used| used.face() as usize);
    let sheet = face.and_then(|face| parts.get(face)).map_or(1, |part| *part as u16 + 1);
    SelectedLine { part: SurfacePart { sheet, ..line.part }, ..line }
}

/// The spans of edges seen from above, and of those seen from below.
fn by_side(view: &ViewedScene, visibility: &Visibility) -> [Visibility; 2] {
    let mut sides = [Visibility::default(), Visibility::default()];
    for (k, drawn) in view.selected().iter().enumerate() {
        let is_below = usize::from(is_underside(view, drawn.edge));
        sides[is_below].push(visibility.spans(k));
        sides[1 - is_below].push(&[]);
    }
    sides
}

/// Whether the triangle that is seen at an edge faces away from the eye: of two that fold there, the
/// one that does not lie behind the other.
fn is_underside(view: &ViewedScene, edge: u32) -> bool {
    let scene = view.scene();
    let triangles = scene.topology().uses(edge).iter().map(|used| used.face());
    let is_below = |face: u32| view.facing(face) == Sign::Negative;
    let mut below = triangles.clone().filter(|&face| is_below(face));
    let mut above = triangles.clone().filter(|&face| !is_below(face));
    match (below.next(), above.next()) {
        (Some(below), Some(above)) => {
            let corners = scene.triangles()[above as usize];
            let ends = scene.line(edge);
            let apex = scene.triangles()[below as usize].into_iter().find(|v| !ends.contains(v));
            // In front of a triangle that faces the eye depth is negative.
            apex.is_some_and(|apex| view.sight().depth(corners, apex) == Sign::Negative)
        }
        (below, _) => below.is_some(),
    }
}
