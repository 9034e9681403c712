//! Which lines of a surface to draw, and how.

use crate::axes::{Axes, LegendPlace};
use crate::draw::DEFAULT_SHORTEST_STROKE_MM;
use crate::engines::surface::CellOrder;
use crate::page::{DEFAULT_PEN_WIDTH_MM, PenRule};
use crate::surface::SampledSurface;

/// The default deviation of lines from the true curves, in millimeters on paper.
pub const DEFAULT_SMOOTHNESS_MM: f64 = 0.1;

/// Which lines of a surface are drawn, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceLines {
    /// Grid lines along x, or along u. Scattered points have no grid lines: the edges of their triangles are
    /// drawn instead.
    pub along_x: bool,
    /// Grid lines along y, or along v.
    pub along_y: bool,
    /// Draw only every n-th grid line of a family, and the last one.
    pub every: usize,
    /// Level curves.
    pub levels: Option<Levels>,
    /// Every n-th level curve is an index line, of kind index and by default twice as wide. `None` means
    /// every fifth if the levels have a step, and none otherwise.
    pub index_every: Option<u16>,
    /// Also draw the level curves on the base of the box around the surface, where it does not hide them.
    pub project_levels: bool,
    /// Dash the level curves of heights below 0.
    pub negative_dashed: bool,
    /// Which level curves are labeled with their heights, in gaps. `None` means the index lines, or all
    /// curves if there are no index lines, in views from above without grid lines, and none in other
    /// drawings.
    pub labels: Option<Labels>,
    /// Orientation of labels.
    pub label_side: LabelSide,
    /// Height of the digits of labels, in millimeters; less where there is no room.
    pub label_height_mm: f64,
    /// Where the surface folds away from the eye: the folds of formulas, unless everything is drawn exactly
    /// as sampled; otherwise edges of triangles.
    pub silhouette: bool,
    /// The border.
    pub border: bool,
    /// The edges that complete grid lines of both families: the folds of formulas, and the border where no
    /// grid line runs along it. None if everything is drawn exactly as sampled.
    pub edges: bool,
    /// Lines where sheets cross.
    pub intersections: bool,
    /// All edges of all triangles.
    pub mesh: bool,
    /// Maximum deviation of lines from the true curves, in millimeters on paper; 0 draws them as sampled.
    /// Formulas are sampled as finely as needed, and left open at jumps and poles; only the lines of their
    /// own samples are drawn. The floating horizon and `mesh` ignore it.
    pub smoothness_mm: f64,
    /// Keep lines on the underside of the surface separate.
    pub underside: bool,
    /// Draw what is exactly visible, as one two-point stroke for each visible piece of each edge.
    pub exact: bool,
    /// The engine that decides what is visible.
    pub engine: SurfaceEngine,
    /// The order in which [`max_min`](crate::engines::surface::max_min) visits the cells of a grid; the
    /// drawing is the same. `None` for the default order, or for surfaces that are not a single grid.
    pub order: Option<CellOrder>,
    /// Axes around the surface; `None` for no axes.
    pub axes: Option<Axes>,
    /// A legend of the sheets and levels.
    pub legend: Option<Legend>,
    /// Keep the triangles between the samples, for hatching.
    pub keep_scene: bool,
    /// Join only pieces of one kind.
    pub apart_by_kind: bool,
    /// Strokes shorter than this are dropped if the surface is drawn as a mesh, in millimeters on paper.
    pub shortest_stroke_mm: f64,
}

impl Default for SurfaceLines {
    /// All grid lines, with folds, border and axes.
    fn default() -> Self {
        Self {
            along_x: true,
            along_y: true,
            every: 1,
            levels: None,
            index_every: None,
            project_levels: false,
            negative_dashed: false,
            labels: None,
            label_side: LabelSide::Upright,
            label_height_mm: DEFAULT_LABEL_HEIGHT_MM,
            silhouette: false,
            border: false,
            edges: true,
            intersections: false,
            mesh: false,
            smoothness_mm: DEFAULT_SMOOTHNESS_MM,
            underside: false,
            exact: false,
            engine: SurfaceEngine::default(),
            order: None,
            axes: Some(Axes::default()),
            legend: None,
            keep_scene: false,
            apart_by_kind: false,
            shortest_stroke_mm: DEFAULT_SHORTEST_STROKE_MM,
        }
    }
}

impl SurfaceLines {
    /// Grid lines along x, or along u, only.
    #[must_use]
    pub fn along_x_only(self) -> Self {
        Self { along_x: true, along_y: false, ..self }
    }

    /// Grid lines along y, or along v, only.
    #[must_use]
    pub fn along_y_only(self) -> Self {
        Self { along_x: false, along_y: true, ..self }
    }

    /// No grid lines.
    #[must_use]
    pub fn no_grid_lines(self) -> Self {
        Self { along_x: false, along_y: false, ..self }
    }

    /// Every `every`-th grid line of a family, and the last one.
    #[must_use]
    pub fn every(self, every: usize) -> Self {
        Self { every, ..self }
    }

    /// Level curves.
    #[must_use]
    pub fn levels(self, levels: Levels) -> Self {
        Self { levels: Some(levels), ..self }
    }

    /// Every `n`-th level curve is an index line.
    #[must_use]
    pub fn index_every(self, n: u16) -> Self {
        Self { index_every: Some(n), ..self }
    }

    /// Also level curves on the base of the box around the surface.
    #[must_use]
    pub fn project_levels(self) -> Self {
        Self { project_levels: true, ..self }
    }

    /// Heights written into gaps of level curves.
    #[must_use]
    pub fn labels(self, labels: Labels) -> Self {
        Self { labels: Some(labels), ..self }
    }

    /// Dashes in level curves below 0.
    #[must_use]
    pub fn negative_dashed(self) -> Self {
        Self { negative_dashed: true, ..self }
    }

    /// Edges where the surface folds away from the eye.
    #[must_use]
    pub fn silhouette(self) -> Self {
        Self { silhouette: true, ..self }
    }

    /// The border.
    #[must_use]
    pub fn border(self) -> Self {
        Self { border: true, ..self }
    }

    /// Only the requested lines: no folds and no border to complete the grid lines.
    #[must_use]
    pub fn without_edges(self) -> Self {
        Self { edges: false, ..self }
    }

    /// Lines where sheets cross.
    #[must_use]
    pub fn intersections(self) -> Self {
        Self { intersections: true, ..self }
    }

    /// Maximum deviation of lines from the true curves, in millimeters on paper; 0 draws the samples
    /// unchanged.
    #[must_use]
    pub fn smoothness_mm(self, smoothness_mm: f64) -> Self {
        Self { smoothness_mm, ..self }
    }

    /// No axes.
    #[must_use]
    pub fn without_axes(self) -> Self {
        Self { axes: None, ..self }
    }

    /// These axes, or the default axes with these titles.
    ///
    /// ```
    /// use hiddenline::{Axes, AxesStyle, SurfaceLines, Titles};
    ///
    /// let titled = SurfaceLines::default().axes(Titles::of_drawing("Peaks"));
    /// let walls = SurfaceLines::default().axes(Axes::new(AxesStyle::Back));
    /// ```
    #[must_use]
    pub fn axes(self, axes: impl Into<Axes>) -> Self {
        Self { axes: Some(axes.into()), ..self }
    }

    /// A legend of the sheets and levels; sheets whose pens look alike are dashed.
    ///
    /// ```
    /// use hiddenline::{Legend, LegendPlace, Levels, SurfaceLines};
    ///
    /// let beside = SurfaceLines::default().legend(Legend::default());
    /// let below = SurfaceLines::default().levels(Levels::Round).legend(LegendPlace::Bottom);
    /// ```
    #[must_use]
    pub fn legend(self, legend: impl Into<Legend>) -> Self {
        Self { legend: Some(legend.into()), ..self }
    }

    /// The hidden-line algorithm; all give the same lines.
    #[must_use]
    pub fn engine(self, engine: SurfaceEngine) -> Self {
        Self { engine, ..self }
    }

    /// Whether any grid lines are drawn.
    pub(super) fn has_grid_lines(&self) -> bool {
        self.along_x || self.along_y
    }

    /// Whether grid lines of the surface are closed by folds and border.
    fn closes(&self, surface: &SampledSurface) -> bool {
        let has_both = self.along_x && self.along_y && !surface.lattices().is_empty();
        self.edges && has_both && !self.exact
    }

    /// Whether folds of the surface are drawn.
    pub(super) fn has_folds(&self, surface: &SampledSurface) -> bool {
        self.silhouette || self.closes(surface) && surface.has_fold_functions()
    }

    /// Whether the border of the surface is drawn.
    pub(super) fn has_border(&self, surface: &SampledSurface) -> bool {
        self.border || self.closes(surface)
    }

    /// Whether any lines are drawn that are not grid lines, apart from level curves.
    pub(super) fn has_mesh_lines(&self) -> bool {
        self.silhouette || self.border || self.intersections || self.mesh
    }
}

/// A legend: which line belongs to which sheet, and the interval between levels.
#[derive(Debug, Clone, PartialEq)]
pub struct Legend {
    /// Where it is.
    pub place: LegendPlace,
    /// Which pens draw which strokes: sheets whose pens have the same width and color are dashed. Set by
    /// [`SurfaceDrawing`](crate::SurfaceDrawing).
    pub pens: Vec<PenRule>,
    /// Line width of pens without a rule, in millimeters.
    pub pen_width_mm: f64,
}

impl Default for Legend {
    fn default() -> Self {
        Self::from(LegendPlace::default())
    }
}

impl From<LegendPlace> for Legend {
    fn from(place: LegendPlace) -> Self {
        Self { place, pens: Vec::new(), pen_width_mm: DEFAULT_PEN_WIDTH_MM }
    }
}

/// The default height of the digits of labels, in millimeters.
pub const DEFAULT_LABEL_HEIGHT_MM: f64 = 2.0;

/// Which level curves are labeled with their heights.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Labels {
    /// None of them.
    None,
    /// Index lines.
    Index,
    /// All of them.
    All,
}

/// Orientation of labels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LabelSide {
    /// Read from the bottom or the right of the page.
    Upright,
    /// Tops point uphill.
    Uphill,
}

/// Which level curves are drawn.
#[derive(Debug, Clone, PartialEq)]
pub enum Levels {
    /// This many, evenly spaced between the lowest and highest points.
    Count(u16),
    /// At these heights, before any scaling.
    At(Vec<f64>),
    /// At all multiples of `step`, counted from `offset`.
    Every {
        /// Above 0.
        step: f64,
        /// Added to each multiple.
        offset: f64,
    },
    /// At the multiples of a round step, about a dozen of them.
    Round,
}

/// The engines for surfaces.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum SurfaceEngine {
    /// Max-min where it applies, otherwise a mesh engine.
    #[default]
    Auto,
    /// One surface z = f(x, y) without holes, or two that meet along their border.
    MaxMin,
    /// One family of grid lines, hidden by its own nearer lines.
    FloatingHorizon,
    /// Any surface, by Roberts's algorithm.
    Roberts,
    /// Any surface, by Appel's algorithm.
    Appel,
}

impl SurfaceEngine {
    /// All of them, in the order of the documentation.
    pub const ALL: [Self; 5] =
        [Self::Auto, Self::MaxMin, Self::FloatingHorizon, Self::Roberts, Self::Appel];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::MaxMin => "max-min",
            Self::FloatingHorizon => "floating-horizon",
            Self::Roberts => "roberts",
            Self::Appel => "appel",
        }
    }
}
