//! From a scene and a camera to strokes, stage by stage.

pub mod meshed;
pub mod surface;
pub mod turning;

use crate::camera::Camera;
use crate::chain::{ChainOptions, chain, draft};
use crate::classify::{DEFAULT_CREASE_DEG, LineSelection, ViewedScene};
use crate::drafting::{Drafted, DraftingOptions, finish};
use crate::engines::edge::{LineCounts, LineEngine, VisibilityOptions, outline, solve};
use crate::model::creases::CreaseChains;
use crate::model::scene::Scene;
use crate::page::DEFAULT_PEN_WIDTH_MM;
use crate::strokes::{HiddenLines, StrokeKind, Strokes};
use crate::timing::{Seconds, timed};

/// The default contact tolerance as a fraction of the largest coordinate: twice the spacing of
/// single-precision numbers, which most model files hold.
///
/// Less loses bottom edges of boxes on turned tables (half of it is the least that lost none of
/// twelve); more lets lines shine through thin parts of models that lie far from the origin.
pub const DEFAULT_CONTACT_TOLERANCE: f64 = 1.0 / (1 << 22) as f64;

/// The least default contact tolerance as a fraction of the model's longest side: the rounding of a
/// model one unit in size that was written with six decimals.
pub const LEAST_CONTACT_TOLERANCE: f64 = 1.0 / (1 << 19) as f64;

/// The default shortest stroke in millimeters on paper: a little less than the width of a pen, whose smallest
/// dot is that large anyway.
pub const DEFAULT_SHORTEST_STROKE_MM: f64 = 0.25;

pub use crate::drafting::DEFAULT_THIN;

/// What to draw, and how.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrawOptions {
    /// Which kinds of lines to draw.
    pub lines: LineSelection,
    /// Faces that meet at more than this angle, in degrees, form a crease.
    pub crease_deg: f64,
    /// Whether hidden lines are left out, or kept with their quantitative invisibility.
    pub hidden: HiddenLines,
    /// Keep only hidden lines with at most this quantitative invisibility, which is then constant along
    /// each stroke; `None` keeps all.
    pub hidden_levels: Option<u32>,
    /// One two-point stroke for each maximal visible interval of each line: nothing is joined, dropped or
    /// deduplicated, contact tolerance and shortest stroke are zero, and faces are used as given: bent ones
    /// by their mean normals, flush edges as boundaries.
    pub exact: bool,
    /// The line engine.
    pub engine: LineEngine,
    /// A triangle does not hide a segment if both ends lie within this distance of its plane, in model units;
    /// `None` for the default, which depends on the size of the coordinates.
    pub contact_tolerance: Option<f64>,
    /// Visible strokes shorter than this are dropped, and hidden gaps shorter than this between two
    /// visible pieces of one edge are closed. In millimeters on paper.
    pub shortest_stroke_mm: f64,
    /// Join only pieces of one kind and one `qi`, so that a stroke's attributes apply to all of it.
    /// Otherwise everything that one pen draws is joined.
    pub apart_by_kind: bool,
    /// Pen width in millimeters: lines closer than this cannot be distinguished on paper. Zero leaves the
    /// chained strokes unchanged.
    pub pen_width_mm: f64,
    /// Draw overlapping ink once: visible over hidden lines, and more important over less important ones.
    /// Otherwise only lines with exactly the same image are drawn once.
    pub drops_overlaps: bool,
    /// How close ink must be to count as overlapping, in millimeters; `None` for half the pen width.
    pub overlap_mm: Option<f64>,
    /// Minimum distance between the centerlines of lines that run beside each other, in millimeters: where
    /// they are closer, the less important one ends. `None` for any distance.
    pub thin_mm: Option<f64>,
    /// How far lines stop short of nearer silhouettes, boundaries and wires, in millimeters, measured across
    /// them. Zero for no gap.
    pub halo_mm: f64,
}

impl Default for DrawOptions {
    fn default() -> Self {
        Self {
            lines: LineSelection::default(),
            crease_deg: DEFAULT_CREASE_DEG,
            hidden: HiddenLines::default(),
            hidden_levels: None,
            exact: false,
            engine: LineEngine::default(),
            contact_tolerance: None,
            shortest_stroke_mm: DEFAULT_SHORTEST_STROKE_MM,
            apart_by_kind: false,
            pen_width_mm: DEFAULT_PEN_WIDTH_MM,
            drops_overlaps: true,
            overlap_mm: None,
            thin_mm: None,
            halo_mm: 0.0,
        }
    }
}

impl DrawOptions {
    /// Which kinds of lines to draw.
    #[must_use]
    pub fn lines(self, lines: LineSelection) -> Self {
        Self { lines, ..self }
    }

    /// Every edge of the mesh.
    #[must_use]
    pub fn all_edges(self) -> Self {
        self.lines(LineSelection::all_edges())
    }

    /// The angle in degrees above which faces that meet form a crease.
    #[must_use]
    pub fn crease_deg(self, crease_deg: f64) -> Self {
        Self { crease_deg, ..self }
    }

    /// Whether hidden lines are left out, dashed or solid.
    #[must_use]
    pub fn hidden(self, hidden: HiddenLines) -> Self {
        Self { hidden, ..self }
    }

    /// Keeps only hidden lines with at most this quantitative invisibility.
    #[must_use]
    pub fn hidden_levels(self, levels: u32) -> Self {
        Self { hidden_levels: Some(levels), ..self }
    }

    /// A triangle does not hide a segment if both ends lie within this distance of its plane, in model units.
    #[must_use]
    pub fn contact_tolerance(self, distance: f64) -> Self {
        Self { contact_tolerance: Some(distance), ..self }
    }

    /// Drops visible strokes shorter than this, and closes gaps shorter than this, in millimeters on
    /// paper.
    #[must_use]
    pub fn shortest_stroke_mm(self, length_mm: f64) -> Self {
        Self { shortest_stroke_mm: length_mm, ..self }
    }

    /// The hidden-line algorithm; all give the same drawing.
    #[must_use]
    pub fn engine(self, engine: LineEngine) -> Self {
        Self { engine, ..self }
    }

    /// Draws one two-point stroke for each maximal visible interval, without tidying. Equal faces must be
    /// kept when the scene is built:
    /// [`SceneBuilder::keep_equal_faces`](crate::SceneBuilder::keep_equal_faces).
    #[must_use]
    pub fn exact(self) -> Self {
        Self { exact: true, ..self }
    }

    /// The contact tolerance in a scene, in model units.
    pub(crate) fn contact_tolerance_in(&self, scene: &Scene) -> f64 {
        if self.exact {
            return 0.0;
        }
        let default = || {
            let (low, high) = scene.mesh().bounds().unwrap_or_default();
            let largest = low.abs().max(high.abs()).max_element();
            let side = (high - low).max_element();
            (largest * DEFAULT_CONTACT_TOLERANCE).max(side * LEAST_CONTACT_TOLERANCE)
        };
        self.contact_tolerance.unwrap_or_else(default)
    }

    fn visibility(&self, scene: &Scene) -> VisibilityOptions {
        VisibilityOptions {
            contact_tolerance: self.contact_tolerance_in(scene),
            count_layers: self.hidden != HiddenLines::None,
            find_doubled: !self.exact,
            ..VisibilityOptions::default()
        }
    }
}

/// A drawing, with statistics of how it was made.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct DrawOutput {
    /// The strokes.
    pub drawing: Strokes,
    /// The engine that removed hidden lines, by its name on the command line.
    pub engine: &'static str,
    /// How many edges and other lines of the scene were selected.
    pub n_lines: usize,
    /// How much work the engine did.
    pub counts: LineCounts,
    /// How many decisions needed exact arithmetic after the floating-point filters.
    pub n_exact: u64,
    /// What was joined and left out on paper.
    pub drafted: Drafted,
    /// Wall time of classification, visibility and strokes; the rest is zero.
    pub seconds: Seconds,
}

/// How large a mesh is, as drawn.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct MeshSize {
    /// Distinct vertices.
    pub vertices: usize,
    /// Faces.
    pub faces: usize,
    /// Triangles that these faces consist of, before clipping.
    pub triangles: usize,
    /// Distinct edges of these faces, before clipping.
    pub edges: usize,
    /// Intersection lines, before any are selected for drawing.
    pub intersections: usize,
    /// Pairs of triangles whose boxes touch, tested for intersection lines.
    pub intersection_pairs: u64,
}

impl MeshSize {
    /// The size of a scene's mesh.
    pub fn of(scene: &Scene) -> Self {
        Self {
            vertices: scene.mesh().positions().len(),
            faces: scene.mesh().n_faces(),
            triangles: scene.triangles().len(),
            edges: scene.topology().edges().len(),
            intersections: scene.intersections().lines().len(),
            intersection_pairs: scene.intersections().n_pairs(),
        }
    }
}

/// Draws `scene` as `camera` sees it.
///
/// Intersection lines are drawn when the scene has them; see
/// [`Scene::with_intersections`](crate::model::scene::Scene::with_intersections).
///
/// `mm_per_unit` is the number of millimeters on paper for one image unit, which the page knows from the
/// scene's [`Extent`](crate::extent::Extent) alone. It converts the shortest stroke to a length in the image;
/// if that is zero, it has no effect.
pub fn draw(scene: &Scene, camera: &Camera, options: &DrawOptions, mm_per_unit: f64) -> DrawOutput {
    draw_watched(scene, camera, options, mm_per_unit, &mut |_| {})
}

/// Shares of the work that are done when edges are classified, when their visible parts are found, and when
/// these are chained. Measured on models of a million triangles.
const SHARES: [f64; 3] = [0.05, 0.45, 0.55];

/// The same, and calls `watch` with the share of the work done, as far as it is known: after each step.
pub fn draw_watched(
    scene: &Scene,
    camera: &Camera,
    options: &DrawOptions,
    mm_per_unit: f64,
    watch: &mut dyn FnMut(f64),
) -> DrawOutput {
    let mut seconds = Seconds::default();
    let view = timed(&mut seconds.classify, || view(scene, camera, options, mm_per_unit));
    watch(SHARES[0]);
    let (visibility, counts, engine) =
        timed(&mut seconds.visibility, || solve(&view, options.engine, &options.visibility(scene)));
    watch(SHARES[1]);
    let (n_lines, n_exact) = (view.selected().len(), view.sight().n_exact());
    let chaining = ChainOptions {
        hidden: options.hidden != HiddenLines::None,
        hidden_levels: options.hidden_levels,
        exact: options.exact,
        apart_by_kind: options.apart_by_kind,
        shortest: if options.exact { 0.0 } else { options.shortest_stroke_mm / mm_per_unit },
    };
    if options.exact || options.pen_width_mm <= 0.0 {
        let outline = timed(&mut seconds.visibility, || {
            options.lines.has_outline().then(|| outline::find(&view))
        });
        let drawing =
            timed(&mut seconds.strokes, || chain(&view, &visibility, outline.as_ref(), &chaining));
        let drafted = Drafted::default();
        return DrawOutput { drawing, engine, n_lines, counts, n_exact, drafted, seconds };
    }
    let drafts = timed(&mut seconds.strokes, || draft(&view, &visibility, &chaining));
    watch(SHARES[2]);
    let (draft, drafted) = timed(&mut seconds.drafting, || {
        let drafting = DraftingOptions {
            pen_width_mm: options.pen_width_mm,
            shortest_stroke_mm: options.shortest_stroke_mm,
            outline: options.lines.has_outline(),
            overlap_mm: options
                .drops_overlaps
                .then_some(options.overlap_mm.unwrap_or(0.5 * options.pen_width_mm)),
            thin_mm: options.thin_mm,
            halo_mm: options.halo_mm,
            mm_per_unit,
        };
        finish(&view, drafts, &drafting)
    });
    let drawing = timed(&mut seconds.strokes, || draft.into_strokes(|mark| chaining.class(mark)));
    DrawOutput { drawing, engine, n_lines, counts, n_exact, drafted, seconds }
}

/// A scene as a camera sees it, with the lines to draw.
fn view<'a>(
    scene: &'a Scene,
    camera: &Camera,
    options: &DrawOptions,
    mm_per_unit: f64,
) -> ViewedScene<'a> {
    let (lines, crease_deg) = (options.lines, options.crease_deg);
    if options.exact {
        return ViewedScene::as_given(scene, camera, lines, crease_deg);
    }
    let has_creases = lines.contains(StrokeKind::Crease);
    let creases = if has_creases { CreaseChains::of_scene(scene, crease_deg) } else { None };
    let Some(creases) = creases else {
        return ViewedScene::new(scene, camera, lines, crease_deg);
    };
    let is_crease = creases.of_view(scene, camera, mm_per_unit, options.pen_width_mm);
    ViewedScene::with_creases(scene, camera, lines, &is_crease)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Projection;
    use crate::model::mesh::{Mesh, PolygonSoup};
    use glam::DVec3;

    #[test]
    fn the_share_done_grows() {
        let mut soup =
            PolygonSoup { positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y], ..Default::default() };
        soup.push_face(&[0, 1, 2]);
        let scene = Mesh::new(soup).map(|(mesh, _)| Scene::new(mesh)).unwrap_or_default();
        let camera = Camera::new(DVec3::Z, DVec3::ZERO, DVec3::Y, Projection::Orthographic);
        let mut shares = vec![0.0];
        let options = DrawOptions::default();
        let camera = camera.expect("a camera");
        let drawn = draw_watched(&scene, &camera, &options, 10.0, &mut |share| shares.push(share));
        assert_eq!(drawn.drawing, draw(&scene, &camera, &options, 10.0).drawing);
        assert!(shares.len() == 4 && shares.is_sorted() && shares[3] < 1.0, "{shares:?}");
    }
}
