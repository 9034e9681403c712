//! The page: its size, and how large the drawing is on it.

use clap::{Args, ValueEnum};
use hiddenline::stages::page::{
    DEFAULT_MARGIN_MM, DEFAULT_PEN_WIDTH_MM, Orientation, PageOptions, Paper, Placement,
};

use hiddenline::stages::write::dxf::{DxfScale, DxfUnit};

use super::values;

#[derive(Args)]
#[command(next_help_heading = "Page")]
pub(super) struct PageArgs {
    /// a0 to a6, letter, legal, tabloid, or WIDTHxHEIGHT in mm
    ///
    /// A named size is turned to suit the drawing. Numbers may have a unit, as in 8x10in.
    #[arg(long, value_name = "SIZE", default_value = "a4")]
    page: Paper,
    /// Wide rather than high
    #[arg(long, conflicts_with = "portrait")]
    landscape: bool,
    /// High rather than wide
    #[arg(long)]
    portrait: bool,
    /// Empty border; nothing is drawn outside
    #[arg(long, value_name = "MM", value_parser = values::length)]
    #[arg(default_value_t = DEFAULT_MARGIN_MM)]
    margin: f64,
    /// Scale, as in 1:10, instead of fitting the drawing to the page
    ///
    /// In perspective it holds at the distance of the target. Coordinates in DXF are then model units.
    #[arg(long, value_name = "1:N", value_parser = values::scale, conflicts_with = "fit_fov")]
    drawing_scale: Option<f64>,
    /// What a model unit is, for --drawing-scale [default: what the model says, else mm]
    #[arg(long, value_enum)]
    unit: Option<LengthUnit>,
    /// Show exactly the field of view between the upper and the lower margin
    #[arg(long)]
    fit_fov: bool,
    /// Width of the pen's line
    #[arg(long, value_name = "MM", value_parser = values::positive_length)]
    #[arg(default_value_t = DEFAULT_PEN_WIDTH_MM)]
    pen_width: f64,
}

#[derive(Clone, Copy, ValueEnum)]
enum LengthUnit {
    Mm,
    Cm,
    M,
    In,
}

impl PageArgs {
    pub(super) fn pen_width_mm(&self) -> f64 {
        self.pen_width
    }

    /// What coordinates in DXF mean: model units if the drawing has a scale, or else millimeters on
    /// paper.
    pub(super) fn dxf_scale(&self) -> DxfScale {
        let unit = match self.unit.unwrap_or(LengthUnit::Mm) {
            LengthUnit::Mm => DxfUnit::Millimeter,
            LengthUnit::Cm => DxfUnit::Centimeter,
            LengthUnit::M => DxfUnit::Meter,
            LengthUnit::In => DxfUnit::Inch,
        };
        let at_scale = |scale: f64| DxfScale { mm_per_unit: scale * self.unit_mm(), unit };
        self.drawing_scale.map_or(DxfScale::default(), at_scale)
    }

    /// Millimeters in a model unit, if it was given.
    pub(super) fn given_unit_mm(&self) -> Option<f64> {
        self.unit.map(|unit| match unit {
            LengthUnit::Mm => 1.0,
            LengthUnit::Cm => 10.0,
            LengthUnit::M => 1000.0,
            LengthUnit::In => 25.4,
        })
    }

    /// Millimeters in a model unit, for --drawing-scale.
    pub(super) fn unit_mm(&self) -> f64 {
        self.given_unit_mm().unwrap_or(1.0)
    }

    pub(super) fn options(&self) -> PageOptions {
        PageOptions {
            paper: self.page,
            orientation: match (self.landscape, self.portrait) {
                (true, _) => Some(Orientation::Landscape),
                (_, true) => Some(Orientation::Portrait),
                _ => None,
            },
            margin_mm: self.margin,
            placement: match (self.drawing_scale, self.fit_fov) {
                (Some(scale), _) => Placement::Scale { mm_per_unit: scale * self.unit_mm() },
                (None, true) => Placement::FieldOfView,
                (None, false) => Placement::Fit,
            },
        }
    }
}

/// The same page for models in a unit of so many millimeters rather than in millimeters.
pub(super) fn in_unit(page: PageOptions, unit_mm: f64) -> PageOptions {
    let placement = match page.placement {
        Placement::Scale { mm_per_unit } => Placement::Scale { mm_per_unit: mm_per_unit * unit_mm },
        other => other,
    };
    PageOptions { placement, ..page }
}

/// The same meaning of coordinates in DXF for models in a unit of so many millimeters rather than in
/// millimeters. In units other than these, coordinates stay in millimeters.
pub(super) fn dxf_in_unit(scale: DxfScale, page: &PageOptions, unit_mm: f64) -> DxfScale {
    let unit = match unit_mm {
        10.0 => DxfUnit::Centimeter,
        25.4 => DxfUnit::Inch,
        1000.0 => DxfUnit::Meter,
        _ => return scale,
    };
    match page.placement {
        Placement::Scale { mm_per_unit } => DxfScale { mm_per_unit, unit },
        _ => scale,
    }
}
