//! Drawings of a scene that is read once and drawn many times, for the viewer.

use std::error::Error;

use glam::DVec3;
use hiddenline::stages::camera::Camera;
use hiddenline::stages::draw::turning::{TurningLines, turning_lines};
use hiddenline::stages::model::scene::Scene;
use hiddenline::stages::optimize::OptimizeOptions;
use hiddenline::stages::page::{PageOptions, PlotOptions};
use hiddenline::stages::timing::timed;

use super::{Job, plot_options, strokes};
use crate::cli::models::HeldFiles;
use crate::cli::output::OutputOptions;
use crate::cli::page;
use crate::cli::paper::{Notes, PlacedPage, Run};
use crate::cli::scene::Needs;

/// A scene with what reading it had to tell.
pub(in crate::cli) struct Live {
    scene: Scene,
    needs: Needs,
    notes: Notes,
}

/// What is shown while turning, and the sheet that it is on.
pub(in crate::cli) struct Turned {
    pub(in crate::cli) lines: TurningLines,
    pub(in crate::cli) camera: Camera,
    pub(in crate::cli) page: PageOptions,
    pub(in crate::cli) sheet: hiddenline::stages::page::Page,
    pub(in crate::cli) plot: PlotOptions,
}

impl Job {
    /// The same with files whose contents are held in memory.
    pub(in crate::cli) fn holding(mut self, held: HeldFiles) -> Self {
        self.files = self.files.holding(held);
        self
    }

    /// How the drawing is placed on its page, and the page itself for models in the scene's unit.
    pub(in crate::cli) fn page_in(&self, live: &Live) -> PageOptions {
        page::in_unit(self.page, live.notes.unit_mm.unwrap_or(1.0))
    }

    /// The output's options.
    pub(in crate::cli) fn output(&self) -> &OutputOptions {
        &self.output
    }

    fn needs(&self) -> Needs {
        Needs::new(Some(self.draw.lines), !self.draw.exact)
    }

    /// The scene: `known` if it is given and suits, or else made of its mesh, or else read.
    pub(in crate::cli) fn live(
        &self,
        known: Option<Live>,
        run: &mut Run,
    ) -> Result<Live, Box<dyn Error>> {
        let needs = self.needs();
        let (mesh, notes) = match known {
            Some(live) if live.needs == needs => return Ok(live),
            Some(live) => (live.scene.mesh().clone(), live.notes),
            None => {
                run.progress.stage("reading");
                timed(&mut run.stats.seconds.read, || self.files.read(&run.progress))?
            }
        };
        run.progress.stage("finding edges");
        let scene = timed(&mut run.stats.seconds.topology, || needs.scene(mesh, &run.progress));
        Ok(Live { scene, needs, notes })
    }

    /// Draws a scene and ends the run.
    pub(in crate::cli) fn draw_live(
        &self,
        live: &Live,
        mut run: Run,
    ) -> Result<(), Box<dyn Error>> {
        let camera = self.view.camera(live.bounds())?;
        let mut notes = live.notes.clone();
        let refined = match &self.smoothing {
            Some(smoothing) => {
                // How fine depends on the view, so this scene is not kept.
                run.progress.stage("smoothing");
                let seconds = &mut run.stats.seconds.topology;
                Some(timed(seconds, || -> Result<Scene, Box<dyn Error>> {
                    let mesh = live.scene.mesh().clone();
                    let mesh = smoothing.refine(mesh, &camera, &mut notes)?;
                    Ok(live.needs.scene(mesh, &run.progress))
                })?)
            }
            None => None,
        };
        let scene = refined.as_ref().unwrap_or(&live.scene);
        let extent = scene.extent(&camera);
        let (drawing, sheet) = strokes(self, scene, camera, extent, notes, &mut run)?;
        run.draw(&drawing, &sheet, plot_options(self), &OptimizeOptions::for_drawings())
    }

    /// The camera and the page of a scene, without drawing it.
    pub(in crate::cli) fn sheet(&self, live: &Live) -> Result<PlacedPage, Box<dyn Error>> {
        let camera = self.view.camera(live.bounds())?;
        Ok(PlacedPage::new(live.scene.extent(&camera), camera, &self.page_in(live))?)
    }

    /// The visible lines of a scene as they are found quickly. It need not have all that the options ask for.
    pub(in crate::cli) fn turned(&self, live: &Live) -> Result<Turned, Box<dyn Error>> {
        let PlacedPage { camera, page: sheet, options: page, .. } = self.sheet(live)?;
        let lines = turning_lines(&live.scene, &camera, &self.draw);
        Ok(Turned { lines, camera, page, sheet, plot: plot_options(self) })
    }
}

impl Live {
    /// The lowest and the highest corner of the scene.
    pub(in crate::cli) fn bounds(&self) -> (DVec3, DVec3) {
        self.scene.mesh().bounds().unwrap_or_default()
    }

    pub(in crate::cli) fn scene(&self) -> &Scene {
        &self.scene
    }
}
