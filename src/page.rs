//! The page: where on the paper the image goes, and what of it stays within the margins.
//!
//! ```text
//!   (0, 0) ●──────────────────────────► x, mm     image          y
//!          │   margin                                            ▲   ╱│
//!          │   ┌──────────────────┐                              │ ╱  │
//!          │   │     ╱│           │                              └────┴──► x
//!          │   │   ╱  │           │               page_from_image: one scale for both
//!          │   └──────────────────┘               axes, y turned downward, a shift
//!          ▼ y, mm
//! ```
//!
//! Nothing is written outside the margins: lines that would cross them are cropped there.

mod areas;
mod dash;
mod paper;
mod pens;
mod refit;

use glam::{DAffine2, DMat2, DVec2};
use thiserror::Error;

use crate::camera::{Camera, Projection};
use crate::extent::Extent;
use crate::extent::window::Window;
use crate::plot::{FillLayer, Layer, Pen, Plot};
use crate::strokes::{HiddenLines, Strokes};

pub use self::dash::Dash;
use self::dash::VisibleEnds;
pub use self::paper::{Paper, PaperError, parse_length_mm};
pub use self::pens::{
    LayerControls, LineWeights, PenRole, PenRule, default_pen_color, hatch_width_mm, idle_pens,
    pen_of, tells_sheets_apart, with_hatch_pen, with_index_pen, with_line_pens, with_sheet_pens,
    with_underside_pen,
};
pub use self::refit::{Crop, Cropped, RefitOptions, crop_to, refit};

/// The default margin of the page in millimeters.
pub const DEFAULT_MARGIN_MM: f64 = 10.0;

/// The default line width of the pen in millimeters.
pub const DEFAULT_PEN_WIDTH_MM: f64 = 0.3;

/// Cropping does not cut points that are outside the margins by less than half of the last digit written, but
/// moves them onto the margin: they are there only through rounding.
const CROP_SLACK_MM: f64 = 0.0005;

/// The orientation of the paper.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Orientation {
    /// At least as wide as high.
    Landscape,
    /// At least as high as wide.
    Portrait,
}

/// How large the drawing is on the page.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum Placement {
    /// As large as the margins allow, centered.
    #[default]
    Fit,
    /// At a scale, centered. In perspective it applies at the distance of the target.
    Scale {
        /// Millimeters on paper for one model unit.
        mm_per_unit: f64,
    },
    /// The height between the margins is exactly the vertical field of view.
    FieldOfView,
    /// The height between the margins shows this height at the target, which is centered, in either
    /// projection.
    ViewHeight {
        /// The height in model units.
        model_units: f64,
    },
}

/// Paper, margin and placement.
///
/// ```
/// use hiddenline::{PageOptions, Paper};
///
/// let poster = PageOptions::from(Paper::A3).landscape().margin_mm(15.0);
/// // A sheet of any size, and 20 mm on paper for one model unit.
/// let to_scale = PageOptions::from(Paper::new(200.0, 120.0)).scale(20.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PageOptions {
    /// The sheet.
    pub paper: Paper,
    /// Its orientation; `None` to suit the drawing.
    pub orientation: Option<Orientation>,
    /// Margin on all four sides.
    pub margin_mm: f64,
    /// How large the drawing is.
    pub placement: Placement,
}

impl Default for PageOptions {
    fn default() -> Self {
        Self {
            paper: Paper::A4,
            orientation: None,
            margin_mm: DEFAULT_MARGIN_MM,
            placement: Placement::Fit,
        }
    }
}

impl PageOptions {
    /// Leaves a margin of this width on all sides, in millimeters.
    #[must_use]
    pub fn margin_mm(self, margin_mm: f64) -> Self {
        Self { margin_mm, ..self }
    }

    /// At least as wide as high.
    #[must_use]
    pub fn landscape(self) -> Self {
        Self { orientation: Some(Orientation::Landscape), ..self }
    }

    /// At least as high as wide.
    #[must_use]
    pub fn portrait(self) -> Self {
        Self { orientation: Some(Orientation::Portrait), ..self }
    }

    /// Draws at a scale instead of fitting: this many millimeters on paper for one model unit.
    #[must_use]
    pub fn scale(self, mm_per_unit: f64) -> Self {
        Self { placement: Placement::Scale { mm_per_unit }, ..self }
    }

    /// Shows this height, in model units at the target, with the target at the center.
    #[must_use]
    pub fn view_height(self, model_units: f64) -> Self {
        Self { placement: Placement::ViewHeight { model_units }, ..self }
    }

    /// Shows exactly the field of view, in perspective.
    #[must_use]
    pub fn field_of_view(self) -> Self {
        Self { placement: Placement::FieldOfView, ..self }
    }
}

impl From<Paper> for PageOptions {
    fn from(paper: Paper) -> Self {
        Self { paper, ..Self::default() }
    }
}

/// Why a drawing cannot be placed on a page.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum PageError {
    /// The margins leave no room on the sheet.
    #[error(
        "margins of {} mm leave no room on a page of {} x {} mm",
        shown(*margin_mm), shown(*width_mm), shown(*height_mm)
    )]
    Margins {
        /// The margin.
        margin_mm: f64,
        /// Width of the sheet.
        width_mm: f64,
        /// Height of the sheet.
        height_mm: f64,
    },
    /// The margin is negative or not a number.
    #[error("the margin must be 0 or more, not {0} mm")]
    NegativeMargin(f64),
    /// The scale is not a positive number.
    #[error("the drawing's scale must be above 0")]
    Scale,
    /// An orthographic camera has no field of view.
    #[error("an orthographic view has no field of view to fit")]
    NoFieldOfView,
}

/// A length for people, in thousandths of a millimeter.
fn shown(mm: f64) -> f64 {
    (1e3 * mm).round() / 1e3
}

/// A sheet of paper and the map of the image onto it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Page {
    /// The paper, in its orientation.
    pub paper: Paper,
    /// Margin on all four sides.
    pub margin_mm: f64,
    /// Image coordinates (y upward) to page millimeters (y downward).
    pub page_from_image: DAffine2,
}

/// What the pens draw, and the labels of their layers.
#[derive(Debug, Clone, PartialEq)]
pub struct PlotOptions {
    /// Line width of pens without a rule, in millimeters.
    pub pen_width_mm: f64,
    /// Which pens draw which strokes.
    pub pens: Vec<PenRule>,
    /// Hidden lines: none, dashed, or solid.
    pub hidden: HiddenLines,
    /// Lengths of dashes and gaps; `None` to suit each pen width.
    pub dash: Option<Dash>,
    /// Whether dashed lines stay whole, on layers that name the pattern, for a format that draws it.
    pub keep_dashes_whole: bool,
    /// The title of the drawing.
    pub title: String,
    /// The command that made it; empty for none.
    pub source: String,
}

impl Default for PlotOptions {
    fn default() -> Self {
        Self {
            pen_width_mm: DEFAULT_PEN_WIDTH_MM,
            pens: Vec::new(),
            hidden: HiddenLines::default(),
            dash: None,
            keep_dashes_whole: false,
            title: String::new(),
            source: String::new(),
        }
    }
}

/// A plot, and whether all of the drawing is on it.
#[derive(Debug, Clone, PartialEq)]
pub struct PlacedPlot {
    /// The plot.
    pub plot: Plot,
    /// Whether lines were cropped at the margins.
    pub cropped: bool,
}

impl Page {
    /// Chooses the orientation and the map for a drawing with this `extent`.
    ///
    /// # Errors
    /// See [`PageError`].
    pub fn place(
        extent: &Extent,
        camera: &Camera,
        options: &PageOptions,
    ) -> Result<Self, PageError> {
        let margin_mm = options.margin_mm;
        if !(margin_mm >= 0.0 && margin_mm.is_finite()) {
            return Err(PageError::NegativeMargin(margin_mm));
        }
        let (low, high) = extent.corners().unwrap_or_default();
        let suits = match options.placement {
            Placement::FieldOfView => Orientation::Landscape,
            _ if high.y - low.y > high.x - low.x => Orientation::Portrait,
            _ => Orientation::Landscape,
        };
        let paper = options.paper.turned(options.orientation, suits);
        let sheet = DVec2::new(paper.width_mm, paper.height_mm);
        let usable = sheet - DVec2::splat(2.0 * margin_mm);
        if usable.min_element() <= 0.0 {
            return Err(PageError::Margins {
                margin_mm,
                width_mm: paper.width_mm,
                height_mm: paper.height_mm,
            });
        }
        let units_per_image = match camera.projection() {
            Projection::Perspective { .. } => camera.forward().length(),
            Projection::Orthographic => 1.0,
        };
        let (scale, center) = match options.placement {
            Placement::Fit => {
                let scale = (usable / (high - low)).min_element();
                // A point, or nothing at all, fits at any scale.
                (if scale.is_finite() { scale } else { 1.0 }, low / 2.0 + high / 2.0)
            }
            Placement::Scale { mm_per_unit } => {
                (mm_per_unit * units_per_image, low / 2.0 + high / 2.0)
            }
            Placement::ViewHeight { model_units } => {
                (usable.y / model_units * units_per_image, DVec2::ZERO)
            }
            Placement::FieldOfView => match camera.projection() {
                Projection::Perspective { fov_deg, .. } => {
                    (usable.y / (2.0 * libm::tan(fov_deg.to_radians() / 2.0)), DVec2::ZERO)
                }
                Projection::Orthographic => return Err(PageError::NoFieldOfView),
            },
        };
        if !(scale > 0.0 && scale.is_finite()) {
            return Err(PageError::Scale);
        }
        let linear = DMat2::from_diagonal(DVec2::new(scale, -scale));
        let page_from_image =
            DAffine2::from_mat2_translation(linear, sheet / 2.0 - linear * center);
        Ok(Self { paper, margin_mm, page_from_image })
    }

    /// Millimeters on paper for one unit of the image.
    pub fn mm_per_image_unit(&self) -> f64 {
        self.page_from_image.matrix2.x_axis.x
    }

    /// What lies between the margins, as the lowest and the highest corner in image coordinates.
    pub fn window_in_image(&self) -> (DVec2, DVec2) {
        let image_from_page = self.page_from_image.inverse();
        let Window { low, high, .. } = self.window();
        let corners = [low, high].map(|corner| image_from_page.transform_point2(corner));
        (corners[0].min(corners[1]), corners[0].max(corners[1]))
    }

    /// What lies between the margins.
    fn window(&self) -> Window {
        let margin = DVec2::splat(self.margin_mm);
        let sheet = DVec2::new(self.paper.width_mm, self.paper.height_mm);
        Window { low: margin, high: sheet - margin, slack: CROP_SLACK_MM }
    }

    /// Maps strokes onto the page, crops them to the margins and gives each to its pen.
    ///
    /// If there are rules for them, a stroke of the outline is drawn by the pen of the outline, any other
    /// visible stroke by the pen of its kind, and a hidden one by the pen of its level. All others are drawn
    /// by the pen of visible or hidden strokes: by default, visible ones are layer 1 and hidden ones, if
    /// drawn, layer 2. Strokes keep their order. O(points + dashes).
    pub fn plot(&self, drawing: &Strokes, options: PlotOptions) -> PlacedPlot {
        let window = self.window();
        let mut holder = pens::Holder::new(&options);
        let mut cropped = false;
        let mut on_page = Vec::new();
        let is_drawn = |qi| qi == 0 || options.hidden != HiddenLines::None;
        let is_dashed =
            |qi| qi > 0 && options.hidden == HiddenLines::Dashed && !options.keep_dashes_whole;
        let place = |points: &[DVec2], on_page: &mut Vec<DVec2>| {
            on_page.clear();
            on_page.extend(points.iter().map(|&p| self.page_from_image.transform_point2(p)));
        };
        let mut visible_ends = VisibleEnds::default();
        if options.hidden == HiddenLines::Dashed {
            for stroke in drawing.iter().filter(|stroke| stroke.qi == 0) {
                place(stroke.points, &mut on_page);
                visible_ends.add(&on_page);
            }
        }
        for stroke in drawing.iter().filter(|stroke| is_drawn(stroke.qi)) {
            place(stroke.points, &mut on_page);
            let layer = holder.layer(&stroke);
            let dash = options.dash.unwrap_or(Dash::of_pen(layer.pen.width_mm));
            let lines = &mut layer.lines;
            cropped |= window.crop(&mut on_page, |piece| {
                if let (true, [first, second, ..]) = (is_dashed(stroke.qi), piece) {
                    let [before, last] = [piece[piece.len() - 2], piece[piece.len() - 1]];
                    let goes_on =
                        [(*first, *second), (last, before)].map(|(a, b)| visible_ends.go_on(a, b));
                    dash.for_each_dash(piece, goes_on, |dash| lines.push(dash.iter().copied()));
                } else {
                    lines.push(piece.iter().copied());
                }
            });
        }
        let plot = Plot {
            width_mm: self.paper.width_mm,
            height_mm: self.paper.height_mm,
            title: options.title,
            source: options.source,
            layers: holder.into_layers(),
        };
        PlacedPlot { plot, cropped }
    }
}

impl PlacedPlot {
    /// Lays areas below the lines: one layer for each of `filled`, numbered before them.
    ///
    /// Each area is outlined in its own color by a line `seam_mm` wide, for which see
    /// [`Fills::seam_mm`](crate::plot::Fills::seam_mm); it may reach half of that into the margin.
    /// Outlines on top of areas are drawn by the pen of the first layer of lines.
    #[must_use]
    pub fn with_fills(mut self, page: &Page, filled: &[FillLayer], seam_mm: f64) -> Self {
        let window = page.window();
        let mut layers = Vec::with_capacity(filled.len() + self.plot.layers.len());
        for layer in filled {
            let (fills, cropped) =
                areas::placed(&layer.fills, &page.page_from_image, &window, seam_mm);
            self.cropped |= cropped;
            let [r, g, b] = layer.color;
            let pen = match self.plot.layers.first() {
                Some(lines) if fills.has_outlines() => lines.pen.clone(),
                _ => Pen { width_mm: seam_mm, color: format!("#{r:02x}{g:02x}{b:02x}") },
            };
            layers.push(Layer {
                number: layers.len() as u32 + 1,
                name: layer.name.clone(),
                pen,
                fills,
                ..Layer::default()
            });
        }
        let n_fills = layers.len() as u32;
        for layer in self.plot.layers {
            layers.push(Layer { number: n_fills + layer.number, ..layer });
        }
        self.plot.layers = layers;
        self
    }
}
