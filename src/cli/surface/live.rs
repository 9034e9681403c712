//! Drawings of a surface that is read once and drawn many times, for the viewer.

use std::error::Error;

use hiddenline::stages::draw::surface::{TurningSurface, for_turning};
use hiddenline::stages::model::scene::Scene;
use hiddenline::stages::surface::Surface;
use hiddenline::stages::timing::timed;

use super::{Job, draw, failed, plot_options};
use crate::cli::draw::Turned;
use crate::cli::output::OutputOptions;
use crate::cli::paper::Run;

/// A surface with what reading it had to tell.
pub(in crate::cli) struct LiveSurface {
    surface: Surface,
    warnings: Vec<String>,
    /// For turning, once that was requested, with the lines that it is for.
    turning: Option<(String, TurningSurface)>,
}

impl Job {
    /// The surface: `known` if it is given, or else read.
    pub(in crate::cli) fn live(
        &self,
        known: Option<LiveSurface>,
        run: &mut Run,
    ) -> Result<LiveSurface, Box<dyn Error>> {
        if let Some(live) = known {
            return Ok(live);
        }
        run.progress.stage("reading");
        let mut warnings = Vec::new();
        let surface = timed(&mut run.stats.seconds.read, || self.sheets.read(&mut warnings))?;
        Ok(LiveSurface { surface, warnings, turning: None })
    }

    /// Draws a surface and ends the run.
    pub(in crate::cli) fn draw_live(
        &self,
        live: &LiveSurface,
        mut run: Run,
    ) -> Result<(), Box<dyn Error>> {
        run.unit_mm = self.unit_mm;
        run.dxf_scale = self.dxf_scale;
        run.notes.warnings.extend(live.warnings.iter().cloned());
        draw(self, &live.surface, run)
    }

    /// The output's options.
    pub(in crate::cli) fn output(&self) -> &OutputOptions {
        &self.output
    }

    /// The visible lines of a surface as they are found quickly, as it is sampled.
    pub(in crate::cli) fn turned(&self, live: &mut LiveSurface) -> Result<Turned, Box<dyn Error>> {
        let key = format!("{:?}", self.lines);
        if live.turning.as_ref().is_none_or(|(known, _)| *known != key) {
            let turning = for_turning(&live.surface, &self.lines);
            live.turning = Some((key, turning.map_err(|error| failed(self, &error))?));
        }
        let Some((_, turning)) = &live.turning else { return Err("no surface".into()) };
        let view = self.view.framing()?;
        let drawn = turning.lines(&view, &self.lines, &self.page);
        let (lines, camera, sheet) = drawn.map_err(|error| failed(self, &error))?;
        Ok(Turned {
            lines,
            camera,
            page: self.page,
            sheet,
            plot: plot_options(self, turning.has_index_levels()),
        })
    }
}

impl LiveSurface {
    /// The triangles, once it was turned.
    pub(in crate::cli) fn scene(&self) -> Option<&Scene> {
        self.turning.as_ref().map(|(_, turning)| turning.scene())
    }
}
