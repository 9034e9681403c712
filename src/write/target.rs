//! How a plot is written: a format and its settings.

use std::io;

use thiserror::Error;

use super::dxf::DxfScale;
use super::svg::StrokeElement;
use super::{Format, NoFills, dxf, svg};
use crate::plot::Plot;

#[cfg(feature = "png")]
use super::png::{self, Marks, PngError, Resolution};
#[cfg(feature = "plotters")]
use super::{gcode, hpgl};

/// A format and its settings.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Target {
    /// Scalable vector graphics.
    Svg(StrokeElement),
    /// Polylines for CAD and CAM programs, and what their coordinates mean.
    Dxf(DxfScale),
    /// A page for print.
    #[cfg(feature = "pdf")]
    Pdf,
    /// A picture, and how it shows pen movement.
    #[cfg(feature = "png")]
    Png(Resolution, Marks),
    /// HPGL for a plotter.
    #[cfg(feature = "plotters")]
    Hpgl(Box<hpgl::Plotter>),
    /// G-code for a machine.
    #[cfg(feature = "plotters")]
    Gcode(Box<gcode::GcodeProfile>),
}

/// Why a plot cannot be written.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum WriteError {
    /// Writing to the output failed.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// The format is not in this build.
    #[error("this build cannot write {}; enable its feature of the crate", .0.name())]
    FormatOff(Format),
    /// JSON holds strokes, which contain more than a plot.
    #[error("JSON holds strokes in image coordinates, which a sheet no longer has")]
    OnlyStrokes,
    /// The format has lines only.
    #[error(transparent)]
    NoFills(#[from] NoFills),
    /// No plotter and no G-code profile has this name.
    #[cfg(feature = "plotters")]
    #[error("unknown machine `{name}`; choose from {known}")]
    UnknownMachine {
        /// The requested name.
        name: String,
        /// All names.
        known: String,
    },
    /// The plot does not suit the plotter.
    #[cfg(feature = "plotters")]
    #[error(transparent)]
    Hpgl(#[from] hpgl::PlotterError),
    /// The profile is damaged.
    #[cfg(feature = "plotters")]
    #[error(transparent)]
    Gcode(#[from] gcode::GcodeError),
    /// The picture cannot be made.
    #[cfg(feature = "png")]
    #[error(transparent)]
    Png(PngError),
}

#[cfg(feature = "png")]
impl From<PngError> for WriteError {
    fn from(error: PngError) -> Self {
        match error {
            PngError::Write(error) => Self::Io(error),
            error => Self::Png(error),
        }
    }
}

impl Target {
    /// The default target of a format: HPGL for an HP 7475A, G-code for GRBL with a pen servo, 300
    /// pixels per inch.
    ///
    /// # Errors
    /// The format's feature is off, or it needs more than a plot (JSON).
    pub fn usual(format: Format) -> Result<Self, WriteError> {
        Ok(match format {
            Format::Svg => Self::Svg(StrokeElement::default()),
            Format::Dxf => Self::Dxf(DxfScale::default()),
            #[cfg(feature = "pdf")]
            Format::Pdf => Self::Pdf,
            #[cfg(feature = "png")]
            Format::Png => Self::Png(Resolution::default(), Marks::default()),
            #[cfg(feature = "plotters")]
            Format::Hpgl => Self::Hpgl(Box::new(hpgl::Plotter::named(hpgl::DEFAULT_MACHINE)?)),
            #[cfg(feature = "plotters")]
            Format::Gcode => {
                Self::Gcode(Box::new(gcode::GcodeProfile::named(gcode::DEFAULT_PROFILE)?))
            }
            Format::Json => return Err(WriteError::OnlyStrokes),
            #[allow(unreachable_patterns, reason = "reached where features are off")]
            format => return Err(WriteError::FormatOff(format)),
        })
    }

    /// HPGL or G-code for a machine by its name, such as `hp7475a` or `grbl-z`.
    ///
    /// # Errors
    /// [`WriteError::UnknownMachine`].
    ///
    /// ```
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// use hiddenline::{DrawOptions, Paper, Scene, Target, View};
    ///
    /// let scene = Scene::open("examples/models/benchy_wheel.stl")?;
    /// let sheet = scene.draw(&View::front(), &DrawOptions::default()).on(Paper::A4)?.optimized();
    /// let hpgl = sheet.to_bytes(&Target::machine("hp7475a")?)?;
    /// assert!(!hpgl.is_empty());
    /// # Ok(())
    /// # }
    /// ```
    #[cfg(feature = "plotters")]
    pub fn machine(name: &str) -> Result<Self, WriteError> {
        let (plotters, profiles) = (hpgl::machines()?, gcode::GcodeProfile::names()?);
        if let Some(plotter) = plotters.iter().find(|plotter| plotter.name == name) {
            return Ok(Self::Hpgl(Box::new(plotter.clone())));
        }
        if profiles.iter().any(|profile| profile == name) {
            return Ok(Self::Gcode(Box::new(gcode::GcodeProfile::named(name)?)));
        }
        let plotters = plotters.iter().map(|plotter| plotter.name.as_str());
        let known: Vec<&str> = plotters.chain(profiles.iter().map(String::as_str)).collect();
        Err(WriteError::UnknownMachine { name: name.to_owned(), known: known.join(", ") })
    }
}

/// Writes `plot` to `out`. O(points), and O(pixels) for a picture.
///
/// # Errors
/// See [`WriteError`]. Nothing is written to `out` if the plot does not suit the target.
pub fn write(plot: &Plot, target: &Target, out: &mut dyn io::Write) -> Result<(), WriteError> {
    match target {
        Target::Svg(element) => Ok(svg::write(plot, *element, out)?),
        Target::Dxf(scale) => Ok(dxf::write(plot, *scale, out)?),
        #[cfg(feature = "pdf")]
        Target::Pdf => Ok(super::pdf::write(plot, out)?),
        #[cfg(feature = "png")]
        Target::Png(resolution, marks) => Ok(png::write_marked(plot, *resolution, *marks, out)?),
        #[cfg(feature = "plotters")]
        Target::Hpgl(machine) => {
            let profile = hpgl::LoadedPlotter::on(plot, machine.as_ref().clone(), None)?;
            Ok(hpgl::write(plot, &profile, out)?)
        }
        #[cfg(feature = "plotters")]
        Target::Gcode(profile) => Ok(gcode::write(plot, profile, out)?),
    }
}
