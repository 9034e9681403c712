//! From a surface and a view to strokes on a page.
//!
//! ```text
//!   Surface ─► samples, as fine as smooth lines need on paper
//!                 │
//!                 ├─ one grid, grid lines only ─► engine for grids ─┐
//!                 └─ all else ─► mesh with lines ─► meshed::draw ───┴─► strokes, with axes
//! ```

mod around;
mod base_levels;
mod bound;
mod certificate;
mod certified_cells;
mod certified_line;
mod dashes;
mod error;
mod grid;
mod labels;
mod legend;
mod levels;
mod options;
mod smoothness;

use glam::DVec2;

pub use self::around::{Around, Surroundings, axes_box, surround};
pub use self::certificate::Certificate;
pub use self::error::{MAX_TRIANGLES, NoLevels, SurfaceError, SurfaceNote};
pub use self::options::{
    DEFAULT_LABEL_HEIGHT_MM, DEFAULT_SMOOTHNESS_MM, LabelSide, Labels, Legend, Levels,
    SurfaceEngine, SurfaceLines,
};

use self::base_levels::base_levels;
use self::dashes::dash_negative;
use self::grid::{draw_grid, grid_to_draw};
use self::labels::{Labelling, label};
use self::legend::LegendText;
use self::levels::LevelSet;
use self::smoothness::{SmoothSurface, sample};
use super::turning::{TurningLines, surface_turning_lines};
use super::{DrawOutput, MeshSize, meshed};
use crate::axes::is_straight_down;
use crate::camera::framing::View;
use crate::camera::{Camera, Projection};
use crate::engines::edge::LineEngine;
use crate::engines::surface::max_min::{self, OrderedGrid};
use crate::extent::Extent;
use crate::model::scene::Scene;
use crate::page::{Page, PageOptions};
use crate::strokes::{Stroke, StrokeKind, Strokes};
use crate::surface::{
    AxisScale, CutGrid, FoldView, GridCuts, LatticeLines, LevelCurve, LinedScene, SampledSurface,
    Surface,
};
use crate::timing::{Seconds, timed};

/// More of the paper covered with lines than this looks like a sheet of ink.
const CROWDED: f64 = 0.5;

/// How much of the paper is covered if lines are easy to distinguish.
const WELL_COVERED: f64 = 0.25;

/// Drawings with at most this many points are joined and ordered again in no time.
const FEW_POINTS: usize = 12_000;

/// A drawing of a surface, with the page that it was drawn for.
#[derive(Debug, Clone)]
pub struct SurfaceOutput {
    /// The strokes, with the axes, and what drawing counted.
    pub drawn: DrawOutput,
    /// How large the mesh is that was drawn.
    pub size: MeshSize,
    /// From where the surface is seen.
    pub camera: Camera,
    /// The page.
    pub page: Page,
    /// What the surface and its axes take up of the image.
    pub extent: Extent,
    /// How many samples there are, in words.
    pub samples: String,
    /// How close drawn lines are to the formulas; none if that is not requested, or not by formulas.
    pub certificate: Option<Certificate>,
    /// What is worth knowing about the drawing.
    pub notes: Vec<SurfaceNote>,
    /// Whether the strokes run along the lines of a grid already, with short pen-up travel and none on
    /// another, and are too many to be joined and ordered again in a moment.
    pub is_ordered: bool,
    /// Whether some level curves are index lines.
    pub has_index_levels: bool,
    /// The triangles between the samples, if they were to be kept.
    pub scene: Option<Scene>,
    ink: Ink,
}

/// How much of the image grid lines cover, without axes.
#[derive(Debug, Clone, Copy, Default)]
struct Ink {
    /// Every n-th line of the surface's own samples is drawn; 0 if no grid lines are.
    every: usize,
    /// Sum of the lengths of all strokes, in millimeters.
    length_mm: f64,
    /// Size of the drawing, in millimeters.
    size_mm: DVec2,
}

/// Draws the lines of a surface as `view` shows it, for a page.
///
/// The surface is sampled as finely as lines need to be smooth on paper. The visible parts are exact
/// for the triangles between the samples.
///
/// # Errors
/// See [`SurfaceError`].
///
/// ```
/// use hiddenline::{PageOptions, View};
/// use hiddenline::stages::draw::surface::{SurfaceLines, draw_surface};
/// use hiddenline::stages::surface::Surface;
///
/// let surface = Surface::formula("sinc(r)")?.x(-12.0, 12.0).y(-12.0, 12.0).samples(41, 41);
/// let (view, page) = (View::default(), PageOptions::default());
/// let drawing = draw_surface(&surface, &view, &SurfaceLines::default(), &page)?;
/// assert!(!drawing.drawn.drawing.is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn draw_surface(
    surface: &Surface,
    view: &View,
    lines: &SurfaceLines,
    page: &PageOptions,
) -> Result<SurfaceOutput, SurfaceError> {
    draw_surface_watched(surface, view, lines, page, &mut |_| {})
}

/// The share of the time after which the surface is sampled, its scene is known, and its lines are drawn,
/// roughly.
const SHARES: [f64; 3] = [0.3, 0.6, 0.9];

/// The same, and calls `watch` with the share of the work done, as far as it is known: after each step.
///
/// # Errors
/// As [`draw_surface`].
pub fn draw_surface_watched(
    surface: &Surface,
    view: &View,
    lines: &SurfaceLines,
    page: &PageOptions,
    watch: &mut dyn FnMut(f64),
) -> Result<SurfaceOutput, SurfaceError> {
    let mut seconds = Seconds::default();
    let names = surface.sheet_names();
    let SmoothSurface { surface, camera, certificate, heights } =
        timed(&mut seconds.read, || sample(surface, view, lines, page))?;
    watch(SHARES[0]);
    let mut notes = Vec::new();
    if let Some(certificate) = certificate.filter(|certificate| !certificate.holds()) {
        notes.push(SurfaceNote::Uncertified(certificate));
    }
    if let Some((low, high)) = heights.filter(|_| !surface.has_given_heights()) {
        let scale = AxisScale { factor: 1.0, ..surface.scales()[2] };
        let [a, b] = [low, high].map(|height| brief(scale.value(height)));
        let (low, high) = (a.min(b), a.max(b));
        notes.push(SurfaceNote::Poles { low, high });
    }
    if surface.n_rim_points_joined() > 0 {
        notes.push(SurfaceNote::RimsJoined(surface.n_rim_points_joined()));
    }
    if surface.n_not_positive() > 0 {
        notes.push(SurfaceNote::NotPositive(surface.n_not_positive()));
    }
    if let Some(none) = without_levels(&surface, lines) {
        if !lines.has_grid_lines() && !lines.has_mesh_lines() {
            return Err(none.into());
        }
        notes.push(SurfaceNote::NoLevels(none));
    }
    let levels = LevelSet::new(lines, &surface)?;
    let grid = grid_to_draw(&surface, lines, &camera)?;
    if grid.is_none() && lines.order.is_some() {
        return Err(SurfaceError::Order);
    }
    let own_page = Page::place(&surface.extent(&camera), &camera, page);
    let mm_per_image_unit = own_page.map_or(1.0, |page| page.mm_per_image_unit());
    let folds = FoldView { camera: &camera, mm_per_image_unit };
    let cuts = timed(&mut seconds.topology, || match grid {
        Some(_) if lines.has_folds(&surface) => surface.fold_cuts(&folds),
        _ => GridCuts::NONE,
    });
    let grid = grid.and_then(|grid| OrderedGrid::new(CutGrid { grid, cuts: &cuts }, &camera));
    let lined = match &grid {
        Some(_) => None,
        None => {
            let lined = || lined(&surface, lines, &levels, Some(&folds));
            Some(timed(&mut seconds.topology, lined)?)
        }
    };
    watch(SHARES[1]);
    let extent = match &lined {
        Some((lined, _)) => lined.scene.extent(&camera),
        None => surface.extent(&camera).union(Extent::new(cuts.points(), &[], &camera)),
    };
    let legend = lines.legend.as_ref();
    let legend = legend.map(|legend| LegendText::new(legend, &names, &surface, lines, &levels));
    let wanted = Surroundings { axes: lines.axes.as_ref(), legend: legend.as_ref() };
    let (around, extent, page) = surround(&axes_box(&surface), extent, &camera, wanted, page)?;
    if let Some(n) = legend.as_ref().map(|legend| legend.n_alike).filter(|n| *n > 0) {
        notes.push(SurfaceNote::SheetsAlike(n));
    }
    notes.extend(around.notes.iter().cloned());
    let mut visible_wires = None;
    let (mut drawn, size) = match (&grid, &lined) {
        (Some(grid), _) => {
            let wires = around.layout.wires();
            let scale = page.mm_per_image_unit();
            let drawn = draw_grid(grid, surface.places(), &camera, lines, wires, scale)?;
            visible_wires = drawn.wires;
            (drawn.drawn, drawn.size)
        }
        (None, Some((lined, _))) => {
            let scale = page.mm_per_image_unit();
            let drawn = meshed::draw(lined, &camera, &meshed_options(lines, &surface), scale);
            if lines.engine == SurfaceEngine::MaxMin && drawn.engine != max_min::NAME {
                return Err(SurfaceError::MaxMin);
            }
            (drawn, MeshSize::of(&lined.scene))
        }
        (None, None) => Default::default(),
    };
    watch(SHARES[2]);
    drawn.seconds += seconds;
    let drawing = &mut drawn.drawing;
    let ink = Ink::of(drawing, lines, &page);
    let on_base = match &lined {
        Some((lined, curves)) if !drawing.is_empty() => {
            timed(&mut drawn.seconds.visibility, || {
                base_levels(curves, around.base, &lined.scene, &camera, lines.exact)
            })
        }
        _ => Strokes::default(),
    };
    let which = labels(lines, &levels, &camera);
    if which != Labels::None {
        let labelling =
            Labelling { which, side: lines.label_side, height_mm: lines.label_height_mm };
        let mut others = around.strokes.clone();
        others.append(&on_base);
        let left = timed(&mut drawn.seconds.strokes, || {
            label(drawing, &others, &levels, &labelling, page.mm_per_image_unit())
        });
        if !left.is_empty() {
            let texts = left.into_iter().map(|level| levels.text(level));
            notes.push(SurfaceNote::Unlabelled(texts.collect()));
        }
    }
    drawing.append(&on_base);
    if lines.negative_dashed && !lines.exact {
        *drawing = dash_negative(drawing, &levels, page.mm_per_image_unit());
    }
    if let Some(legend) = &legend {
        let is_dashed =
            |stroke: &Stroke| lines.negative_dashed && levels.is_negative(stroke.part.level);
        let whole = std::mem::take(drawing);
        *drawing = legend.dashed(whole, is_dashed, page.mm_per_image_unit());
    }
    let scene = match lined {
        Some((lined, _)) => Some(lined.scene),
        None if lines.keep_scene
            || visible_wires.is_none() && !around.layout.wires().is_empty() =>
        {
            Some(self::lined(&surface, lines, &levels, Some(&folds))?.0.scene)
        }
        None => None,
    };
    if !drawing.is_empty() {
        drawing.append(&match (visible_wires, &scene) {
            (Some(parts), _) => around.with_visible(&parts, &camera),
            (None, Some(scene)) => around.with_wires(scene, &camera),
            (None, None) => around.strokes,
        });
    }
    let has_index_levels = levels.has_index();
    let is_edge_on = camera.projection() == Projection::Orthographic && camera.forward().z == 0.0;
    let is_ordered = grid.is_some() && !is_edge_on && drawing.n_points() > FEW_POINTS;
    let samples = surface.to_string();
    let scene = scene.filter(|_| lines.keep_scene);
    Ok(SurfaceOutput {
        drawn,
        size,
        camera,
        page,
        extent,
        samples,
        certificate,
        notes,
        is_ordered,
        has_index_levels,
        scene,
        ink,
    })
}

impl SurfaceOutput {
    /// Whether lines are so close that they flow into each other when drawn with a pen of this width:
    /// then what [`SurfaceLines::every`] should be to keep them apart.
    pub fn crowded(&self, pen_width_mm: f64) -> Option<usize> {
        let Ink { every, length_mm, size_mm } = self.ink;
        let covered = length_mm * pen_width_mm / (size_mm.x * size_mm.y);
        // A flat surface seen edge-on is a line, with nothing to keep apart.
        let is_area = size_mm.min_element() > pen_width_mm;
        (every > 0 && is_area && covered > CROWDED)
            .then(|| (every as f64 * covered / WELL_COVERED).ceil() as usize)
    }
}

impl Ink {
    fn of(drawing: &Strokes, lines: &SurfaceLines, page: &Page) -> Self {
        let Some((low, high)) = drawing.bounds() else { return Self::default() };
        if lines.exact || !lines.has_grid_lines() {
            return Self::default();
        }
        let pairs = |points: &[DVec2]| points.windows(2).map(|p| p[0].distance(p[1])).sum::<f64>();
        let length: f64 = drawing.iter().map(|stroke| pairs(stroke.points)).sum();
        let scale = page.mm_per_image_unit();
        Self { every: lines.every, length_mm: length * scale, size_mm: (high - low) * scale }
    }
}

/// Which level curves are labeled.
fn labels(lines: &SurfaceLines, levels: &LevelSet, camera: &Camera) -> Labels {
    let is_level = lines.levels.is_some() && !lines.exact;
    match lines.labels {
        _ if !is_level => Labels::None,
        Some(labels) => labels,
        None if !is_straight_down(camera) || lines.has_grid_lines() => Labels::None,
        None if levels.has_index() => Labels::Index,
        None => Labels::All,
    }
}

/// Why there are no level curves, if they are to be drawn.
fn without_levels(surface: &SampledSurface, lines: &SurfaceLines) -> Option<NoLevels> {
    let levels = lines.levels.as_ref()?;
    let (low, high) = surface.bounds();
    let (least, most) = surface.ranges()[2];
    let range = least..=most;
    match levels {
        _ if low.z == high.z => Some(NoLevels::Level { height: brief(*range.start()) }),
        Levels::At(heights) if heights.iter().all(|z| !range.contains(z)) => {
            let (low, high) = (brief(*range.start()), brief(*range.end()));
            Some(NoLevels::OutOfRange { low, high })
        }
        _ => None,
    }
}

/// A number with at most six significant digits.
fn brief(number: f64) -> f64 {
    format!("{number:.5e}").parse().unwrap_or(number)
}

/// The surface as a scene, with the chosen grid lines and level curves; and these curves once more if they
/// are to be drawn on the base, too.
fn lined(
    surface: &SampledSurface,
    lines: &SurfaceLines,
    levels: &LevelSet,
    view: Option<&FoldView>,
) -> Result<(LinedScene, Vec<LevelCurve>), SurfaceError> {
    let lattices = surface.lattices();
    // Scattered points have no grid lines.
    let triangles = lines.mesh || lattices.is_empty() && lines.has_grid_lines();
    let (along_rows, along_columns) = (lines.along_x, lines.along_y);
    let chosen = LatticeLines { along_rows, along_columns, every: lines.every, triangles };
    let check = |n: u64| {
        if n > MAX_TRIANGLES { Err(SurfaceError::TooManyTriangles(n)) } else { Ok(()) }
    };
    let cells = lattices
        .iter()
        .map(|lattice| (lattice.n_columns - 1) as u64 * lattice.n_rows().saturating_sub(1) as u64);
    check(2 * cells.sum::<u64>())?;
    let heights = levels.heights();
    let split_at = if lines.exact { &[] } else { &heights[..] };
    let mut mesh =
        surface.lined(&chosen, split_at, view.filter(|_| lines.has_folds(surface) && !lines.exact));
    if mesh.n_triangles() == 0 {
        return Err(SurfaceError::NoCells);
    }
    if !(lines.has_grid_lines() || lines.border || lines.mesh) {
        mesh.leave_out(StrokeKind::Cut);
    }
    if lines.levels.is_some() {
        check(mesh.n_pieces_with_levels(&heights))?;
        mesh.add_levels(&heights);
        mesh.mark_index_levels(|number| levels.is_index(number));
    }
    let curves = if lines.project_levels { mesh.level_curves() } else { Vec::new() };
    let lined = mesh.into_scene()?;
    let scene = if lines.intersections { lined.scene.with_intersections() } else { lined.scene };
    Ok((LinedScene { scene, ..lined }, curves))
}

/// The lines of a surface as it is sampled, ready for any number of views while it is turned, and its
/// lowest and highest corner.
///
/// # Errors
/// See [`SurfaceError`].
pub fn for_turning(
    surface: &Surface,
    lines: &SurfaceLines,
) -> Result<TurningSurface, SurfaceError> {
    let sampled = surface.sample()?;
    let levels = LevelSet::new(lines, &sampled)?;
    let (lined, curves) = lined(&sampled, lines, &levels, None)?;
    let legend = lines.legend.as_ref();
    let names = surface.sheet_names();
    let legend = legend.map(|legend| LegendText::new(legend, &names, &sampled, lines, &levels));
    Ok(TurningSurface { lined, curves, sampled, legend, has_index_levels: levels.has_index() })
}

/// A surface made ready to be turned.
#[derive(Debug, Clone)]
pub struct TurningSurface {
    lined: LinedScene,
    /// Level curves that are drawn on the base, too.
    curves: Vec<LevelCurve>,
    sampled: SampledSurface,
    legend: Option<LegendText>,
    has_index_levels: bool,
}

impl TurningSurface {
    /// Whether some level curves are index lines.
    pub fn has_index_levels(&self) -> bool {
        self.has_index_levels
    }

    /// The triangles.
    pub fn scene(&self) -> &Scene {
        &self.lined.scene
    }

    /// The visible lines of a view, with the axes; the camera; and the page.
    ///
    /// # Errors
    /// The view makes no camera, or the drawing cannot be placed on the page.
    pub fn lines(
        &self,
        view: &View,
        lines: &SurfaceLines,
        page: &PageOptions,
    ) -> Result<(TurningLines, Camera, Page), SurfaceError> {
        let camera = view.camera(self.sampled.box_bounds())?;
        // Folds of the triangles zigzag; those of formulas would have to be found for each view.
        let options = meshed::MeshedOptions {
            folds: lines.silhouette,
            ..meshed_options(lines, &self.sampled)
        };
        let mut visible = surface_turning_lines(&self.lined, &camera, &options);
        let scene = &self.lined.scene;
        let extent = scene.extent(&camera);
        let wanted = Surroundings { axes: lines.axes.as_ref(), legend: self.legend.as_ref() };
        let (around, _, page) = surround(&axes_box(&self.sampled), extent, &camera, wanted, page)?;
        let on_base = base_levels(&self.curves, around.base, scene, &camera, lines.exact);
        visible.push_pane(&on_base, &camera);
        visible.push_pane(&around.with_wires(scene, &camera), &camera);
        Ok((visible, camera, page))
    }
}

fn meshed_options(lines: &SurfaceLines, surface: &SampledSurface) -> meshed::MeshedOptions {
    meshed::MeshedOptions {
        engine: match lines.engine {
            SurfaceEngine::Roberts => LineEngine::Roberts,
            SurfaceEngine::Appel => LineEngine::Appel,
            SurfaceEngine::Auto | SurfaceEngine::MaxMin | SurfaceEngine::FloatingHorizon => {
                LineEngine::Auto
            }
        },
        folds: lines.has_folds(surface),
        intersections: lines.intersections,
        border: lines.has_border(surface),
        exact: lines.exact,
        underside: lines.underside,
        // What is done to some level curves must not be done to the lines that they continue into.
        apart_by_kind: lines.apart_by_kind || lines.levels.is_some() && !lines.exact,
        shortest_stroke_mm: lines.shortest_stroke_mm,
    }
}
