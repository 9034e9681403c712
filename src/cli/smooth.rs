//! Smooth surfaces: which parts of a model are refined, and how far.

use std::error::Error;

use clap::Args;
use hiddenline::stages::camera::{Camera, Projection};
use hiddenline::stages::extent::Extent;
use hiddenline::stages::model::mesh::Mesh;
use hiddenline::stages::model::scene::Scene;
use hiddenline::stages::model::smooth::{SmoothParts, smooth};
use hiddenline::stages::page::{DEFAULT_PEN_WIDTH_MM, Page, PageOptions};
use rayon::prelude::*;

use super::messages::counted;
use super::page;
use super::paper::Notes;
use super::stats::SmoothedStats;
use super::values::{self, Smooth};

/// The curved surface is no farther from facets than this on paper, unless the pen is finer, in
/// millimeters.
const DEFAULT_TOLERANCE_MM: f64 = 0.05;

/// The same in pen widths.
const DEFAULT_TOLERANCE: f64 = 0.25;

/// Refinement does not grow finer nearer to the eye than this share of the distance to the target.
const NEAREST_SHARE: f64 = 0.01;

#[derive(Args)]
#[command(next_help_heading = "Model")]
pub(super) struct SmoothArgs {
    /// Refine curved parts until their facets cannot be seen: off, auto, or an angle in degrees
    ///
    /// auto refines the parts that have smooth vertex normals. With an angle, faces that meet at that angle
    /// or less belong to one smooth part; 30 suits most models. Circles, cylinders and spheres become round,
    /// and flat faces stay flat.
    #[arg(long, value_name = "HOW", value_parser = values::smooth, default_value = "off")]
    smooth: Smooth,
    /// Maximum distance between facets and the curved surface, on paper
    ///
    /// The default is 0.05 mm, or a quarter of the pen width if that is less.
    #[arg(long, value_name = "MM", value_parser = values::positive_length)]
    smooth_tolerance: Option<f64>,
}

/// What is refined, and how far.
#[derive(Debug, Clone, Copy)]
pub(super) struct Smoothing {
    parts: SmoothParts,
    tolerance_mm: f64,
    /// The page on which that is measured.
    page: PageOptions,
}

impl SmoothArgs {
    /// `None` when nothing is refined; `page` is what the tolerance is measured on.
    pub(super) fn smoothing(&self, page: PageOptions, pen_width_mm: f64) -> Option<Smoothing> {
        let Smooth::Parts(parts) = self.smooth else { return None };
        let usual = DEFAULT_TOLERANCE_MM.min(DEFAULT_TOLERANCE * pen_width_mm);
        let tolerance_mm = self.smooth_tolerance.unwrap_or(usual);
        Some(Smoothing { parts, tolerance_mm, page })
    }

    /// The same for pictures without pens, as if they were put on a page.
    pub(super) fn of_picture(&self) -> Option<Smoothing> {
        self.smoothing(PageOptions::default(), DEFAULT_PEN_WIDTH_MM)
    }
}

impl Smoothing {
    /// Refines a mesh as `camera` sees it, and notes what was done.
    pub(super) fn refine(
        &self,
        mesh: Mesh,
        camera: &Camera,
        notes: &mut Notes,
    ) -> Result<Mesh, Box<dyn Error>> {
        let scale = self.largest_scale(&mesh, camera, notes.unit_mm.unwrap_or(1.0))?;
        let (refined, smoothed) = smooth(&mesh, self.parts, self.tolerance_mm / scale)?;
        let [before, after] = smoothed.triangles;
        if after > before {
            notes.summary.push_str(&format!(
                "\nsmoothed: {} refined to {after}, within {:.3} mm of the curved surface",
                counted(before, "triangle", "triangles"),
                smoothed.farthest * scale
            ));
        }
        let farthest_mm = smoothed.farthest * scale;
        notes.smoothed = Some(SmoothedStats { triangles: smoothed.triangles, farthest_mm });
        if smoothed.is_cut_short {
            notes.warnings.push(format!(
                "smoothing ended at {after} triangles, {:.2} mm from the curved surface; use a \
                 larger --smooth-tolerance",
                smoothed.farthest * scale
            ));
        }
        Ok(refined)
    }

    /// The most millimeters on paper that a model unit has anywhere.
    fn largest_scale(
        &self,
        mesh: &Mesh,
        camera: &Camera,
        unit_mm: f64,
    ) -> Result<f64, Box<dyn Error>> {
        let points = mesh.positions();
        let extent = Extent::of_points(points.par_iter().copied(), camera)
            .unwrap_or_else(|| Scene::new(mesh.clone()).extent(camera));
        let page = Page::place(&extent, camera, &page::in_unit(self.page, unit_mm))
            .map_err(|error| super::paper::page_error(&error))?;
        let scale = page.mm_per_image_unit();
        let Projection::Perspective { near, .. } = camera.projection() else { return Ok(scale) };
        let forward = camera.frame().forward;
        let least = near * camera.forward().length();
        let depths = points.iter().map(|&p| (p - camera.eye()).dot(forward));
        // Near the eye a unit has no end of millimeters; what is that near is seldom on the page.
        let typical = camera.forward().length();
        let nearest = depths.filter(|&depth| depth > least).fold(typical, f64::min);
        Ok(scale / nearest.max(NEAREST_SHARE * typical))
    }
}
