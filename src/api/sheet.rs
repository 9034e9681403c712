//! A sheet of paper with a drawing on it, and how to save it.

use std::fs;
use std::path::Path;

use super::Error;
use crate::draw::surface::SurfaceNote;
use crate::optimize::{OptimizeOptions, optimize};
use crate::page::PlacedPlot;
use crate::plot::Plot;
#[cfg(feature = "png")]
use crate::write::png::{Marks, Resolution};
use crate::write::{Format, Target, WriteError, write};

/// A drawing on paper: pens, their strokes in millimeters, and whether all of it fits.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    placed: PlacedPlot,
    notes: Vec<SurfaceNote>,
}

impl Sheet {
    pub(super) fn new(placed: PlacedPlot) -> Self {
        Self { placed, notes: Vec::new() }
    }

    pub(super) fn with_notes(self, notes: Vec<SurfaceNote>) -> Self {
        Self { notes, ..self }
    }

    /// The strokes of each pen, in millimeters from the upper left corner, y down.
    pub fn plot(&self) -> &Plot {
        &self.placed.plot
    }

    /// Whether nothing is drawn.
    pub fn is_empty(&self) -> bool {
        self.placed.plot.layers.iter().all(|l| l.lines.is_empty() && l.fills.is_empty())
    }

    /// Whether lines were cropped at the margins.
    pub fn is_cropped(&self) -> bool {
        self.placed.cropped
    }

    /// Notes on the drawing of a surface: for example, if its lines are farther from the function than they
    /// should be.
    pub fn notes(&self) -> &[SurfaceNote] {
        &self.notes
    }

    /// Joins strokes, draws doubled ink once, and orders the strokes of each pen for short pen-up
    /// travel.
    #[must_use]
    pub fn optimized(self) -> Self {
        self.optimized_with(&OptimizeOptions::for_drawings())
    }

    /// Like [`optimized`](Self::optimized), with options.
    #[must_use]
    pub fn optimized_with(mut self, options: &OptimizeOptions) -> Self {
        self.placed.plot = optimize(&self.placed.plot, options).0;
        self
    }

    /// Writes a file in the format of its extension: svg, pdf, dxf, png, or hpgl and gcode for the default
    /// machines. An existing file is replaced only after everything is written.
    ///
    /// # Errors
    /// The extension names no format, the format's feature is off, or the file cannot be written.
    ///
    /// ```no_run
    /// # use hiddenline::{DrawOptions, Paper, Scene, View};
    /// # let scene = Scene::open("examples/models/spot.obj")?;
    /// let sheet = scene.draw(&View::isometric(), &DrawOptions::default()).on(Paper::A4)?;
    /// sheet.optimized().save("cow.svg")?;
    /// # Ok::<(), hiddenline::Error>(())
    /// ```
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let path = path.as_ref();
        let format =
            Format::from_path(path).ok_or_else(|| Error::UnknownFormat(path.to_owned()))?;
        let failed = |error| Error::Write { path: path.to_owned(), error };
        self.save_as(path, &Target::usual(format).map_err(failed)?)
    }

    /// Writes a picture of the page, `width_px` pixels wide.
    ///
    /// # Errors
    /// As for [`save_as`](Self::save_as).
    #[cfg(feature = "png")]
    pub fn save_png(&self, path: impl AsRef<Path>, width_px: u32) -> Result<(), Error> {
        self.save_as(path, &Target::Png(Resolution::WidthPx(width_px), Marks::default()))
    }

    /// Writes a file of any format, for any machine (see [`Target`]). An existing file is replaced only after
    /// everything is written.
    ///
    /// # Errors
    /// The plot does not suit the target, or the file cannot be written.
    pub fn save_as(&self, path: impl AsRef<Path>, target: &Target) -> Result<(), Error> {
        let path = path.as_ref();
        let failed = |error| Error::Write { path: path.to_owned(), error };
        let bytes = self.to_bytes(target).map_err(failed)?;
        // Written beside it and renamed, so that a full disk does not cost the old file.
        let mut name = path.file_name().unwrap_or_default().to_owned();
        name.push(format!(".{}.partial", std::process::id()));
        let beside = path.with_file_name(name);
        let written = fs::write(&beside, bytes).and_then(|()| fs::rename(&beside, path));
        written.map_err(|error| {
            let _ = fs::remove_file(&beside);
            Error::Io { path: path.to_owned(), error }
        })
    }

    /// The sheet as bytes of any format, for any machine.
    ///
    /// # Errors
    /// The plot does not suit the target.
    ///
    /// ```
    /// use hiddenline::{DrawOptions, Format, Paper, Scene, Target, View};
    ///
    /// let scene = Scene::open("examples/models/spot.obj")?;
    /// let sheet = scene.draw(&View::front(), &DrawOptions::default()).on(Paper::A4)?;
    /// let svg = sheet.to_bytes(&Target::usual(Format::Svg)?)?;
    /// assert!(svg.starts_with(b"<svg"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn to_bytes(&self, target: &Target) -> Result<Vec<u8>, WriteError> {
        let mut bytes = Vec::new();
        write(&self.placed.plot, target, &mut bytes)?;
        Ok(bytes)
    }
}

impl From<Sheet> for Plot {
    fn from(sheet: Sheet) -> Self {
        sheet.placed.plot
    }
}
