//! A view of a scene, to put on paper.

use rayon::prelude::*;

use super::{Error, Sheet};
use crate::camera::Camera;
use crate::camera::framing::{View, ViewError};
use crate::draw::{DrawOptions, draw};
use crate::extent::Extent;
use crate::hatch::{HatchOptions, HatchPage, hatch, shadow_outlines};
use crate::model::scene::Scene;
use crate::page::{Dash, Page, PageOptions, PenRule, PlotOptions, hatch_width_mm, with_hatch_pen};
use crate::shading::fill::{DEFAULT_SEAM_MM, FillOptions, fill};
use crate::strokes::{StrokeKind, Strokes};

/// What to draw: a scene, a view of it, and which lines.
///
/// Nothing is computed until the paper is known, since what is too short to draw, for example, is measured in
/// millimeters. [`on`](Self::on) puts the drawing on paper; [`strokes`](Self::strokes) gives its polylines.
#[derive(Debug, Clone)]
#[must_use = "a drawing does nothing until you put it on paper"]
pub struct Drawing<'a> {
    scene: &'a Scene,
    view: View,
    lines: DrawOptions,
    plot: PlotOptions,
    fill: Option<FillOptions>,
    hatch: Option<HatchOptions>,
    /// What is placed on the page; by default what the view shows.
    frame: Option<Extent>,
}

impl Scene {
    /// Draws the scene as `view` shows it.
    ///
    /// ```
    /// use hiddenline::{DrawOptions, Paper, Scene, View};
    ///
    /// let scene = Scene::open("examples/models/benchy_wheel.stl")?;
    /// for azimuth in [0.0, 120.0, 240.0] {
    ///     let view = View::from_angles(azimuth, 20.0);
    ///     let sheet = scene.draw(&view, &DrawOptions::default()).on(Paper::A5)?;
    ///     assert!(!sheet.is_empty());
    /// }
    /// # Ok::<(), hiddenline::Error>(())
    /// ```
    pub fn draw(&self, view: &View, lines: &DrawOptions) -> Drawing<'_> {
        Drawing {
            scene: self,
            view: *view,
            lines: *lines,
            plot: PlotOptions::default(),
            fill: None,
            hatch: None,
            frame: None,
        }
    }

    /// Draws the scene as each of `views` shows it, all on sheets of the same size, in parallel.
    /// The sheets come in the order of the views.
    ///
    /// # Errors
    /// A view is not a valid camera, or a drawing cannot be placed on the page.
    pub fn draw_views(
        &self,
        views: &[View],
        lines: &DrawOptions,
        page: impl Into<PageOptions>,
    ) -> Result<Vec<Sheet>, Error> {
        let page = page.into();
        views.par_iter().map(|view| self.draw(view, lines).on(page)).collect()
    }

    /// Draws the scene as each of `views` shows it, all with the same scale and position on the page, so that
    /// they can be overlaid or shown as an animation. The sheets are drawn in parallel and come in the order
    /// of the views.
    ///
    /// # Errors
    /// As for [`draw_views`](Self::draw_views).
    ///
    /// ```
    /// use hiddenline::{DrawOptions, Paper, Scene, View};
    ///
    /// let scene = Scene::open("examples/models/benchy_wheel.stl")?;
    /// let views = scene.turntable(&View::from_angles(0.0, 20.0), 4)?;
    /// let sheets = scene.draw_frames(&views, &DrawOptions::default(), Paper::A5)?;
    /// assert_eq!(sheets.len(), 4);
    /// # Ok::<(), hiddenline::Error>(())
    /// ```
    pub fn draw_frames(
        &self,
        views: &[View],
        lines: &DrawOptions,
        page: impl Into<PageOptions>,
    ) -> Result<Vec<Sheet>, Error> {
        let (page, bounds) = (page.into(), self.mesh().bounds().unwrap_or_default());
        let cameras: Result<Vec<Camera>, _> =
            views.iter().map(|view| view.camera(bounds)).collect();
        let frame = Some(self.extent_of_views(&cameras?));
        let drawing = |view| Drawing { frame, ..self.draw(view, lines) };
        views.par_iter().map(|view| drawing(view).on(page)).collect()
    }

    /// Views of one turn around the vertical axis through the target of `view`, at `n` equal angles, starting
    /// with `view` itself.
    ///
    /// # Errors
    /// A view is not a valid camera.
    pub fn turntable(&self, view: &View, n: u32) -> Result<Vec<View>, Error> {
        let camera = view.camera(self.mesh().bounds().unwrap_or_default())?;
        let cameras = camera.turntable(n).map_err(ViewError::from)?;
        Ok(cameras.iter().map(View::from).collect())
    }
}

impl Drawing<'_> {
    /// The title of the drawing, which is written into files.
    pub fn title(mut self, title: impl Into<String>) -> Self {
        self.plot.title = title.into();
        self
    }

    /// Line width of the pen in millimeters; 0.3 unless set.
    pub fn pen_width_mm(mut self, width_mm: f64) -> Self {
        self.plot.pen_width_mm = width_mm;
        self
    }

    /// Which pens draw which lines; by default one draws the visible lines and another the hidden lines.
    pub fn pens(mut self, pens: impl IntoIterator<Item = PenRule>) -> Self {
        self.plot.pens = pens.into_iter().collect();
        self
    }

    /// Lengths of dashes and gaps in hidden lines; see [`HiddenLines::Dashed`](crate::HiddenLines::Dashed).
    pub fn dash(mut self, dash: Dash) -> Self {
        self.plot.dash = Some(dash);
        self
    }

    /// Fills the visible faces with color, below the lines.
    pub fn filled(mut self, options: FillOptions) -> Self {
        self.fill = Some(options);
        self
    }

    /// Hatches the faces according to the light, with exact shadows, on a separate layer.
    ///
    /// Outlines of shadows are lines of the kind [`StrokeKind::Shadow`]; they also take the light and the
    /// ground from here.
    ///
    /// ```no_run
    /// use hiddenline::{DrawOptions, Ground, HatchOptions, Paper, Scene, View};
    ///
    /// let scene = Scene::open("examples/models/spot.obj")?;
    /// let drawing = scene.draw(&View::isometric(), &DrawOptions::default());
    /// drawing.hatched(HatchOptions::default().ground(Ground::Lowest)).on(Paper::A4)?;
    /// # Ok::<(), hiddenline::Error>(())
    /// ```
    pub fn hatched(mut self, options: HatchOptions) -> Self {
        self.hatch = Some(options);
        self
    }

    /// Puts the drawing on a sheet of paper, by default fitted to it with a margin of 10 mm.
    ///
    /// # Errors
    /// The view is not a valid camera, the drawing cannot be placed on the page, or the faces cannot be
    /// filled as requested.
    pub fn on(&self, page: impl Into<PageOptions>) -> Result<Sheet, Error> {
        let (camera, page) = self.place(page.into())?;
        let lines = DrawOptions { pen_width_mm: self.plot.pen_width_mm, ..self.lines };
        let strokes = self.strokes_on(&camera, &page, &lines)?;
        let mut plot = PlotOptions { hidden: self.lines.hidden, ..self.plot.clone() };
        if self.hatch.is_some() {
            plot.pens = with_hatch_pen(plot.pens, plot.pen_width_mm);
        }
        let placed = page.plot(&strokes, plot);
        let Some(options) = &self.fill else { return Ok(Sheet::new(placed)) };
        let filled = fill(self.scene, &camera, options)?;
        Ok(Sheet::new(placed.with_fills(&page, &filled.layers, DEFAULT_SEAM_MM)))
    }

    /// The strokes with their kinds, in image coordinates (y up), and the page, which maps these to
    /// millimeters: [`Page::page_from_image`].
    ///
    /// # Errors
    /// As for [`on`](Self::on).
    ///
    /// ```
    /// # use hiddenline::{DrawOptions, Paper, Scene, View};
    /// # let scene = Scene::open("examples/models/spot.obj")?;
    /// let drawing = scene.draw(&View::front(), &DrawOptions::default());
    /// let (strokes, page) = drawing.strokes(Paper::A4)?;
    /// for stroke in strokes.iter() {
    ///     let mm = stroke.points.iter().map(|&p| page.page_from_image.transform_point2(p));
    ///     println!("{}: {:?}", stroke.kind.name(), mm.collect::<Vec<_>>());
    /// }
    /// # Ok::<(), hiddenline::Error>(())
    /// ```
    pub fn strokes(&self, page: impl Into<PageOptions>) -> Result<(Strokes, Page), Error> {
        let (camera, page) = self.place(page.into())?;
        let pen_width_mm = self.plot.pen_width_mm;
        let lines = DrawOptions { apart_by_kind: true, pen_width_mm, ..self.lines };
        Ok((self.strokes_on(&camera, &page, &lines)?, page))
    }

    fn strokes_on(
        &self,
        camera: &Camera,
        page: &Page,
        lines: &DrawOptions,
    ) -> Result<Strokes, Error> {
        let mm_per_unit = page.mm_per_image_unit();
        let mut strokes = draw(self.scene, camera, lines, mm_per_unit).drawing;
        if lines.lines.contains(StrokeKind::Shadow) {
            let (light, ground) = match &self.hatch {
                Some(hatch) => (hatch.light, hatch.ground),
                None => Default::default(),
            };
            let outlines = shadow_outlines(self.scene, camera, light, ground, lines, mm_per_unit)?;
            strokes.append(&outlines);
        }
        if let Some(options) = &self.hatch {
            let page =
                HatchPage::new(page, hatch_width_mm(&self.plot.pens, self.plot.pen_width_mm));
            strokes.append(&hatch(self.scene, camera, options, lines, &page)?);
        }
        Ok(strokes)
    }

    fn place(&self, options: PageOptions) -> Result<(Camera, Page), Error> {
        let camera = self.view.camera(self.scene.mesh().bounds().unwrap_or_default())?;
        let extent = self.frame.unwrap_or_else(|| self.scene.extent(&camera));
        let page = Page::place(&extent, &camera, &options)?;
        Ok((camera, page))
    }
}
