//! From formulas, heights or points to a surface, and a view of it to put on paper.

use std::fs;
use std::path::Path;

use super::{Error, Sheet};
use crate::camera::framing::View;
use crate::draw::surface::{SurfaceError, SurfaceLines, SurfaceOutput, draw_surface};
use crate::hatch::{HatchOptions, hatch_surface};
use crate::model::scene::Scene;
use crate::page::{
    Page, PageOptions, PenRule, PlotOptions, hatch_width_mm, tells_sheets_apart, with_hatch_pen,
    with_index_pen, with_sheet_pens,
};
use crate::strokes::Strokes;
use crate::surface::{HeightField, HeightOptions, LatticeLines, Surface, read_heights};

impl Surface {
    /// Reads a file of heights: rows of numbers, an ESRI ASCII grid, NPY, NPZ, or a gray PNG or TIFF,
    /// recognized by its content.
    ///
    /// [`HeightField::open`] has options for placing the samples, and reports what it skipped.
    ///
    /// # Errors
    /// The file cannot be read, or holds no grid of heights.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, Error> {
        Ok(Self::grid(HeightField::open(path, &HeightOptions::default())?.grid))
    }

    /// Draws the surface as `view` shows it.
    ///
    /// ```
    /// use hiddenline::{Levels, Paper, Surface, SurfaceLines, View};
    ///
    /// let peak = Surface::formula("exp(-r^2)")?.x(-2.0, 2.0).y(-2.0, 2.0);
    /// let map = SurfaceLines::default().no_grid_lines().levels(Levels::Count(9)).border();
    /// let sheet = peak.draw(&View::top(), &map).title("A peak").on(Paper::A5)?;
    /// assert!(!sheet.is_empty());
    /// # Ok::<(), hiddenline::Error>(())
    /// ```
    pub fn draw(&self, view: &View, lines: &SurfaceLines) -> SurfaceDrawing<'_> {
        SurfaceDrawing {
            surface: self,
            view: *view,
            lines: lines.clone(),
            hatch: None,
            plot: PlotOptions::default(),
        }
    }

    /// The surface as triangles between its samples, to be filled or combined with models.
    ///
    /// # Errors
    /// The surface cannot be sampled, or no four neighboring samples have heights.
    ///
    /// ```
    /// use hiddenline::{DrawOptions, FillOptions, Paper, Surface, View};
    ///
    /// let hill = Surface::formula("exp(-r^2)")?.x(-2.0, 2.0).y(-2.0, 2.0).samples(21, 21).scene()?;
    /// let lines = DrawOptions::default().all_edges();
    /// let sheet = hill.draw(&View::isometric(), &lines).filled(FillOptions::default()).on(Paper::A4)?;
    /// # Ok::<(), hiddenline::Error>(())
    /// ```
    pub fn scene(&self) -> Result<Scene, Error> {
        let no_lines =
            LatticeLines { along_rows: false, along_columns: false, every: 1, triangles: false };
        let sampled = self.sample().map_err(SurfaceError::from)?;
        let mesh = sampled.lined(&no_lines, &[], None).into_mesh()?;
        if mesh.n_faces() == 0 {
            return Err(SurfaceError::NoCells.into());
        }
        Ok(Scene::new(mesh).with_intersections())
    }
}

impl HeightField {
    /// Reads a file of heights; see [`Surface::open`].
    ///
    /// # Errors
    /// The file cannot be read, or holds no grid of heights.
    pub fn open(path: impl AsRef<Path>, options: &HeightOptions) -> Result<Self, Error> {
        let path = path.as_ref();
        let bytes = fs::read(path).map_err(|error| Error::Open { path: path.to_owned(), error })?;
        read_heights(&bytes, options)
            .map_err(|error| Error::Heights { path: path.to_owned(), error: Box::new(error) })
    }
}

/// What to draw: a surface, a view of it, and which lines.
///
/// Nothing is computed until the paper is known: how finely a formula is sampled depends on how far its lines
/// may deviate in millimeters. [`on`](Self::on) puts the drawing on paper; [`strokes`](Self::strokes) gives
/// its polylines.
#[derive(Debug, Clone)]
#[must_use = "a drawing does nothing until you put it on paper"]
pub struct SurfaceDrawing<'a> {
    surface: &'a Surface,
    view: View,
    lines: SurfaceLines,
    hatch: Option<HatchOptions>,
    plot: PlotOptions,
}

impl SurfaceDrawing<'_> {
    /// The title of the drawing, which is written into files. [`SurfaceLines::axes`] draws a title.
    pub fn title(mut self, title: impl Into<String>) -> Self {
        self.plot.title = title.into();
        self
    }

    /// Line width of the pen in millimeters; 0.3 unless set.
    pub fn pen_width_mm(mut self, width_mm: f64) -> Self {
        self.plot.pen_width_mm = width_mm;
        self
    }

    /// Which pens draw which lines; by default one pen draws everything. If there are several sheets, and a
    /// legend or a rule for some of the lines, each sheet has its own pen.
    pub fn pens(mut self, pens: impl IntoIterator<Item = PenRule>) -> Self {
        self.plot.pens = pens.into_iter().collect();
        self
    }

    /// Also hatches the surface according to its light, with lines of the kind [`StrokeKind::Hatch`](crate::StrokeKind).
    ///
    /// ```
    /// use hiddenline::{HatchOptions, Paper, Surface, SurfaceLines, View};
    ///
    /// let hill = Surface::formula("2*exp(-r^2)")?.x(-2.0, 2.0).y(-2.0, 2.0).samples(31, 31);
    /// let drawing = hill.draw(&View::default(), &SurfaceLines::default().no_grid_lines());
    /// let sheet = drawing.hatched(HatchOptions::default()).on(Paper::A5)?;
    /// assert_eq!(sheet.plot().layers[0].name, "hatch");
    /// # Ok::<(), hiddenline::Error>(())
    /// ```
    pub fn hatched(mut self, options: HatchOptions) -> Self {
        self.hatch = Some(options);
        self
    }

    /// Puts the drawing on a sheet of paper, by default fitted to it with a margin of 10 mm.
    ///
    /// # Errors
    /// The surface cannot be sampled or drawn as requested, the view is not a valid camera, or the drawing
    /// cannot be placed on the page.
    pub fn on(&self, page: impl Into<PageOptions>) -> Result<Sheet, Error> {
        let mut plot = self.plot.clone();
        let (n_sheets, has_legend) = (self.surface.n_sheets(), self.lines.legend.is_some());
        if tells_sheets_apart(&plot.pens, n_sheets, has_legend) {
            plot.pens = with_sheet_pens(plot.pens, n_sheets, plot.pen_width_mm);
        }
        let tells_apart = plot.pens.iter().any(|rule| rule.drawn.tells_kinds_apart());
        let apart_by_kind = self.lines.apart_by_kind || tells_apart;
        let mut lines = SurfaceLines { apart_by_kind, ..self.lines.clone() };
        if let Some(axes) = &mut lines.axes {
            axes.pen_width_mm = plot.pen_width_mm;
        }
        if let Some(legend) = &mut lines.legend {
            (legend.pens, legend.pen_width_mm) = (plot.pens.clone(), plot.pen_width_mm);
        }
        let output = self.draw(&lines, page.into())?;
        let SurfaceOutput { drawn, page, notes, has_index_levels, .. } = output;
        if self.hatch.is_some() {
            plot.pens = with_hatch_pen(plot.pens, plot.pen_width_mm);
        }
        if has_index_levels {
            plot.pens = with_index_pen(plot.pens, plot.pen_width_mm);
        }
        Ok(Sheet::new(page.plot(&drawn.drawing, plot)).with_notes(notes))
    }

    /// The strokes with their kinds, axes included, in image coordinates (y up), and the page, which
    /// maps these to millimeters: [`Page::page_from_image`].
    ///
    /// # Errors
    /// As for [`on`](Self::on).
    pub fn strokes(&self, page: impl Into<PageOptions>) -> Result<(Strokes, Page), Error> {
        let lines = SurfaceLines { apart_by_kind: true, ..self.lines.clone() };
        let output = self.draw(&lines, page.into())?;
        Ok((output.drawn.drawing, output.page))
    }

    fn draw(&self, lines: &SurfaceLines, page: PageOptions) -> Result<SurfaceOutput, Error> {
        let Some(options) = &self.hatch else {
            return Ok(draw_surface(self.surface, &self.view, lines, &page)?);
        };
        let lines = SurfaceLines { keep_scene: true, ..lines.clone() };
        let mut output = draw_surface(self.surface, &self.view, &lines, &page)?;
        let width_mm = hatch_width_mm(&self.plot.pens, self.plot.pen_width_mm);
        let hatched = hatch_surface(&output, options, lines.exact, width_mm)?;
        output.drawn.drawing.append(&hatched);
        Ok(output)
    }
}
