//! A mesh on a sheet of paper.

use hiddenline::camera::framing::Framing;
use hiddenline::draw::{DrawOptions, draw};
use hiddenline::model::mesh::Mesh;
use hiddenline::model::scene::Scene;
use hiddenline::page::{Page, PageOptions, PlotOptions};
use hiddenline::plot::Plot;
use hiddenline::stats::Stats;
use hiddenline::strokes::Drawing;

use super::plots::{Result, plot_options};

/// A mesh, from where it is seen, how it is drawn, and on what paper.
pub(crate) struct Sheet {
    pub(crate) title: &'static str,
    pub(crate) mesh: Mesh,
    pub(crate) framing: Framing,
    pub(crate) draw: DrawOptions,
    pub(crate) page: PageOptions,
}

impl Sheet {
    /// The finished page.
    pub(crate) fn plot(self) -> Result<Plot> {
        let camera = self.framing.camera(self.mesh.bounds().unwrap_or_default())?;
        let scene = Scene::new(self.mesh);
        let mm_per_unit = |drawing: &Drawing| {
            Page::new(drawing, &camera, &self.page).map_or(1.0, |page| page.mm_per_image_unit())
        };
        let drawing = draw(&scene, &camera, &self.draw, mm_per_unit, &mut Stats::default());
        let options = PlotOptions { hidden: self.draw.hidden, ..plot_options(self.title) };
        Ok(Page::new(&drawing, &camera, &self.page)?.plot(&drawing, options).plot)
    }
}
