//! The page: its size, and the size of the drawing on it.

use clap::Args;
use hiddenline::stages::page::{
    DEFAULT_MARGIN_MM, DEFAULT_PEN_WIDTH_MM, Orientation, PageOptions, Paper, Placement,
};

use hiddenline::stages::write::dxf::{DxfScale, DxfUnit};

use super::choice::one_of;
use super::values;

/// The sheet, for all commands that draw on one.
#[derive(Args)]
#[command(next_help_heading = "Page")]
pub(super) struct PaperArgs {
    /// Paper size: a0 to a6, letter, legal, tabloid, or WIDTHxHEIGHT in mm [default: a4; for `optimize`, that
    /// of the file]
    ///
    /// A named size is turned to suit the drawing. Numbers may have a unit, as in 8x10in.
    #[arg(long, value_name = "SIZE")]
    page: Option<Paper>,
    /// Turn the sheet to be wider than tall
    #[arg(long, conflicts_with = "portrait")]
    landscape: bool,
    /// Turn the sheet to be taller than wide
    #[arg(long)]
    portrait: bool,
    /// Blank margin on all sides [default: 10; for `optimize`, 0]
    #[arg(long, value_name = "MM", value_parser = values::length)]
    margin: Option<f64>,
}

impl PaperArgs {
    /// The sheet, if it was given.
    pub(super) fn paper(&self) -> Option<Paper> {
        self.page
    }

    /// Which way the sheet lies, if that was given.
    pub(super) fn orientation(&self) -> Option<Orientation> {
        match (self.landscape, self.portrait) {
            (true, _) => Some(Orientation::Landscape),
            (_, true) => Some(Orientation::Portrait),
            _ => None,
        }
    }

    /// Empty border, if it was given.
    pub(super) fn margin_mm(&self) -> Option<f64> {
        self.margin
    }
}

#[derive(Args)]
#[command(next_help_heading = "Page")]
pub(super) struct PageArgs {
    #[command(flatten)]
    paper: PaperArgs,
    /// Draw at this scale, as in 1:10, instead of fitting the page
    ///
    /// In perspective the scale applies at the distance of the target. DXF coordinates are then in model
    /// units.
    #[arg(long, value_name = "1:N", value_parser = values::scale, conflicts_with = "fit_fov")]
    drawing_scale: Option<f64>,
    /// Unit of the model, for --drawing-scale [default: as in the file, otherwise mm]
    #[arg(long, value_parser = one_of::<DxfUnit>())]
    unit: Option<DxfUnit>,
    /// Fit the field of view, not the scene, between the top and bottom margins
    #[arg(long)]
    fit_fov: bool,
    /// Height to show between the top and bottom margins, in model units at the target
    ///
    /// The target is at the center of the page. Anything outside the margins is cropped.
    #[arg(long, value_name = "HEIGHT", value_parser = values::positive)]
    #[arg(conflicts_with_all = ["drawing_scale", "fit_fov"])]
    view_height: Option<f64>,
    /// Line width of the pen
    #[arg(long, value_name = "MM", value_parser = values::positive_length)]
    #[arg(default_value_t = DEFAULT_PEN_WIDTH_MM)]
    pen_width: f64,
}

impl PageArgs {
    pub(super) fn pen_width_mm(&self) -> f64 {
        self.pen_width
    }

    /// What coordinates in DXF mean: model units if the drawing has a scale, or else millimeters on
    /// paper.
    pub(super) fn dxf_scale(&self) -> DxfScale {
        let unit = self.unit.unwrap_or(DxfUnit::Millimeter);
        let at_scale = |scale: f64| DxfScale { mm_per_unit: scale * self.unit_mm(), unit };
        self.drawing_scale.map_or(DxfScale::default(), at_scale)
    }

    /// Millimeters in a model unit, if it was given.
    pub(super) fn given_unit_mm(&self) -> Option<f64> {
        self.unit.map(DxfUnit::mm)
    }

    /// Millimeters in a model unit, for --drawing-scale.
    pub(super) fn unit_mm(&self) -> f64 {
        self.given_unit_mm().unwrap_or(1.0)
    }

    pub(super) fn options(&self) -> PageOptions {
        PageOptions {
            paper: self.paper.paper().unwrap_or(Paper::A4),
            orientation: self.paper.orientation(),
            margin_mm: self.paper.margin_mm().unwrap_or(DEFAULT_MARGIN_MM),
            placement: match (self.drawing_scale, self.view_height) {
                (Some(scale), _) => Placement::Scale { mm_per_unit: scale * self.unit_mm() },
                (None, Some(model_units)) => Placement::ViewHeight { model_units },
                (None, None) if self.fit_fov => Placement::FieldOfView,
                (None, None) => Placement::Fit,
            },
        }
    }
}

/// The same page for models in units of `unit_mm` millimeters rather than of one.
pub(super) fn in_unit(page: PageOptions, unit_mm: f64) -> PageOptions {
    let placement = match page.placement {
        Placement::Scale { mm_per_unit } => Placement::Scale { mm_per_unit: mm_per_unit * unit_mm },
        other => other,
    };
    PageOptions { placement, ..page }
}

/// The same meaning of coordinates in DXF for models in units of `unit_mm` millimeters rather than of one.
/// In units that DXF does not know, coordinates stay in millimeters.
pub(super) fn dxf_in_unit(scale: DxfScale, page: &PageOptions, unit_mm: f64) -> DxfScale {
    if unit_mm == 1.0 {
        return scale;
    }
    let unit = DxfUnit::ALL.into_iter().find(|unit| unit.mm() == unit_mm);
    match (page.placement, unit) {
        (Placement::Scale { mm_per_unit }, Some(unit)) => DxfScale { mm_per_unit, unit },
        _ => scale,
    }
}
