//! Output files: one writer for each format, a function of a finished page and a stream.

#[cfg(feature = "plotters")]
mod clip;
mod decimal;
pub mod dxf;
#[cfg(feature = "plotters")]
pub mod gcode;
#[cfg(feature = "plotters")]
pub mod hpgl;
#[cfg(feature = "json")]
pub mod json;
#[cfg(feature = "pdf")]
pub mod pdf;
#[cfg(feature = "png")]
pub mod png;
pub mod svg;
mod target;

use std::io;
use std::path::Path;

use thiserror::Error;

pub use self::target::{Target, WriteError, write};

use crate::plot::Plot;

/// Output formats.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Scalable vector graphics in millimeters, one layer for each pen.
    Svg,
    /// Instructions for pen plotters.
    Hpgl,
    /// Instructions for machines with GRBL, Marlin and similar firmware.
    Gcode,
    /// A page for print.
    Pdf,
    /// Polylines for CAD and CAM programs.
    Dxf,
    /// A picture of the page.
    Png,
    /// The strokes in image coordinates, for tests and scripts.
    Json,
}

impl Format {
    /// All formats.
    pub const ALL: [Self; 7] =
        [Self::Svg, Self::Hpgl, Self::Gcode, Self::Pdf, Self::Dxf, Self::Png, Self::Json];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Svg => "svg",
            Self::Hpgl => "hpgl",
            Self::Gcode => "gcode",
            Self::Pdf => "pdf",
            Self::Dxf => "dxf",
            Self::Png => "png",
            Self::Json => "json",
        }
    }

    /// Extensions of file names, without the dot.
    pub fn extensions(self) -> &'static [&'static str] {
        match self {
            Self::Svg => &["svg"],
            Self::Hpgl => &["hpgl", "plt"],
            Self::Gcode => &["gcode", "nc", "ngc"],
            Self::Pdf => &["pdf"],
            Self::Dxf => &["dxf"],
            Self::Png => &["png"],
            Self::Json => &["json"],
        }
    }

    /// The format of a file name extension.
    pub fn from_path(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?;
        let is_known = |known: &&str| extension.eq_ignore_ascii_case(known);
        Self::ALL.into_iter().find(|format| format.extensions().iter().any(&is_known))
    }

    /// Whether the format has filled areas.
    pub fn has_fills(self) -> bool {
        matches!(self, Self::Svg | Self::Pdf | Self::Png)
    }

    /// Whether the format is binary rather than text.
    pub fn is_binary(self) -> bool {
        matches!(self, Self::Png | Self::Pdf)
    }
}

/// The extensions of all output formats, for messages.
pub(crate) fn known_extensions() -> String {
    let extensions = Format::ALL.iter().flat_map(|format| format.extensions());
    extensions.map(|extension| format!(".{extension}")).collect::<Vec<_>>().join(", ")
}

/// A page has filled areas, and the format has none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error(
    "{} holds lines only, no filled areas; SVG, PDF and PNG hold both",
    .0.name()
)]
pub struct NoFills(pub Format);

/// Refuses a page with filled areas.
fn only_lines(plot: &Plot, format: Format) -> io::Result<()> {
    if plot.layers.iter().all(|layer| layer.fills.is_empty()) {
        return Ok(());
    }
    Err(io::Error::new(io::ErrorKind::InvalidInput, NoFills(format)))
}
