//! A mesh on a sheet of paper.

use hiddenline::stages::camera::framing::View;
use hiddenline::stages::draw::{DrawOptions, draw};
use hiddenline::stages::model::mesh::Mesh;
use hiddenline::stages::model::scene::Scene;
use hiddenline::stages::page::{Page, PageOptions, PlotOptions};
use hiddenline::stages::plot::Plot;

use super::plots::{Result, plot_options};

/// A mesh, from where it is seen, how it is drawn, and on what paper.
pub(crate) struct Sheet {
    pub(crate) title: &'static str,
    pub(crate) mesh: Mesh,
    pub(crate) framing: View,
    pub(crate) draw: DrawOptions,
    pub(crate) page: PageOptions,
}

impl Sheet {
    /// The finished page.
    pub(crate) fn plot(self) -> Result<Plot> {
        let camera = self.framing.camera(self.mesh.bounds().unwrap_or_default())?;
        let scene = Scene::new(self.mesh);
        let page = Page::place(&scene.extent(&camera), &camera, &self.page)?;
        let drawing = draw(&scene, &camera, &self.draw, page.mm_per_image_unit()).drawing;
        let options = PlotOptions { hidden: self.draw.hidden, ..plot_options(self.title) };
        Ok(page.plot(&drawing, options).plot)
    }
}
