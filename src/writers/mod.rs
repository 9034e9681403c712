//! Files: one writer a format, each a function of a finished page and a stream.

mod clip;
mod decimal;
pub mod dxf;
pub mod gcode;
pub mod hpgl;
pub mod json;
pub mod pdf;
pub mod png;
pub mod svg;

use std::path::Path;

/// What can be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Scalable vector graphics in millimetres, one layer a pen.
    Svg,
    /// The strokes in image coordinates, for tests and scripts.
    Json,
    /// A picture of the page.
    Png,
}

impl Format {
    /// All formats.
    pub const ALL: [Self; 3] = [Self::Svg, Self::Json, Self::Png];

    /// The name on the command line, which is also the extension of file names.
    pub fn name(self) -> &'static str {
        match self {
            Self::Svg => "svg",
            Self::Json => "json",
            Self::Png => "png",
        }
    }

    /// The format that a file name's extension stands for.
    pub fn from_path(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?;
        Self::ALL.into_iter().find(|format| extension.eq_ignore_ascii_case(format.name()))
    }

    /// Whether the format is bytes rather than text.
    pub fn is_binary(self) -> bool {
        self == Self::Png
    }
}
