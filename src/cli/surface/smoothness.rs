//! How finely formulas are sampled, so that drawn lines are as smooth as asked for.
//!
//! ```text
//!        ╭──●──╮       Of three neighboring samples on a drawn line the middle one lies off the
//!      ●´ ╌╌┆╌╌ `●     chord of the outer two, on paper; chords half as long are off a quarter of
//!                      that, since the distance grows with the square of the length.
//! ```

use std::error::Error;

use glam::{DVec2, DVec3};
use hiddenline::stages::camera::{Camera, Projection};
use hiddenline::stages::page::Page;

use super::Job;
use super::engine::{EngineName, only_grid};
use super::sheets::{Input, Surface};

/// Most cells along an axis that one cell of the samples asked for is divided into. Kinks and cliffs
/// are never smooth, however fine the samples.
const MOST_REFINED: usize = 8;

/// Most samples of a refined grid.
const MOST_SAMPLES: usize = 4_000_000;

/// Most samples of a refined surface that a mesh engine draws.
const MOST_MESH_SAMPLES: usize = 250_000;

/// Lines of a family that are looked at, evenly chosen.
const LINES_TESTED: usize = 128;

/// A surface that was sampled as finely as its lines need.
pub(super) struct Sampled {
    pub(super) surface: Surface,
    /// Factor of all heights.
    pub(super) factor: f64,
    pub(super) camera: Camera,
    /// How many cells along each axis stand for one of the samples asked for.
    pub(super) refined: usize,
    /// How far lines are from the function at most, in millimeters on paper; 0 when they may be as
    /// far as they are.
    pub(super) deviation_mm: f64,
    /// What reading has to tell.
    pub(super) warnings: Vec<String>,
}

/// Samples the surface, more finely where its lines would deviate from the function by more than
/// the job allows.
pub(super) fn sample(job: &Job) -> Result<Sampled, Box<dyn Error>> {
    let mut refined = 1;
    loop {
        let mut warnings = Vec::new();
        let (surface, factor) = job.sheets.read(refined, &mut warnings)?;
        let camera = job.view.camera(surface.bounds())?;
        let deviation_mm =
            if is_refinable(job) { deviation_mm(job, &surface, &camera) } else { 0.0 };
        let finer = finer(job, &surface, &camera, refined, deviation_mm);
        if finer <= refined {
            return Ok(Sampled { surface, factor, camera, refined, deviation_mm, warnings });
        }
        refined = finer;
    }
}

/// Whether the job's surface can be sampled more finely to make its lines smooth.
fn is_refinable(job: &Job) -> bool {
    let is_formula = matches!(job.sheets.input, Input::Formulas { .. } | Input::Parametric { .. });
    let is_floating = job.engine == EngineName::FloatingHorizon;
    let has_curves = job.lines.along_x || job.lines.along_y;
    is_formula && job.smoothness_mm > 0.0 && !job.all_edges && !is_floating && has_curves
}

/// How fine the samples have to be, at most; `refined` if they are fine enough.
fn finer(
    job: &Job,
    surface: &Surface,
    camera: &Camera,
    refined: usize,
    deviation_mm: f64,
) -> usize {
    let samples = match &job.sheets.input {
        Input::Formulas { samples, .. } | Input::Parametric { samples, .. } => *samples,
        _ => return refined,
    };
    if deviation_mm <= job.smoothness_mm || refined >= MOST_REFINED {
        return refined;
    }
    let by_grid = matches!(only_grid(surface, job, camera), Ok(Some(_)));
    let most = if by_grid { MOST_SAMPLES } else { MOST_MESH_SAMPLES };
    let cells = (samples.0 - 1).saturating_mul(samples.1 - 1).max(1);
    let affordable = (most as f64 / cells as f64).sqrt() as usize;
    let needed = refined as f64 * (deviation_mm / job.smoothness_mm).sqrt();
    (needed.ceil() as usize).min(MOST_REFINED).min(affordable).max(refined)
}

/// How far lines are from the function at most, in millimeters on paper.
fn deviation_mm(job: &Job, surface: &Surface, camera: &Camera) -> f64 {
    let projector = Projector::new(camera);
    let mut most = 0.0_f64;
    for (n_columns, n, at) in surface.lattices() {
        let n_rows = n / n_columns;
        let mut along = |n_lines: usize, n_points: usize, at: &dyn Fn(usize, usize) -> DVec3| {
            let step = n_lines.div_ceil(LINES_TESTED).max(1);
            for line in (0..n_lines).step_by(step) {
                let mut last: [Option<DVec2>; 2] = [None; 2];
                for k in 0..n_points {
                    let image = projector.image(at(line, k));
                    if let ([Some(a), Some(b)], Some(c)) = (last, image) {
                        most = most.max(off_chord(a, b, c) / 4.0);
                    }
                    last = [last[1], image];
                }
            }
        };
        along(n_rows, n_columns, &|line, k| at(line * n_columns + k));
        along(n_columns, n_rows, &|line, k| at(k * n_columns + line));
    }
    let page = Page::place(&surface.extent(camera), camera, &job.page);
    most * page.map_or(0.0, |page| page.mm_per_image_unit())
}

/// How far `b` is from the chord between `a` and `c`.
fn off_chord(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let chord = c - a;
    let length = chord.length();
    if length > 0.0 { (chord.perp_dot(b - a) / length).abs() } else { a.distance(b) }
}

struct Projector {
    camera: Camera,
    near: Option<f64>,
}

impl Projector {
    fn new(camera: &Camera) -> Self {
        let near = match camera.projection() {
            Projection::Perspective { near, .. } => Some(near * camera.forward().length_squared()),
            Projection::Orthographic => None,
        };
        Self { camera: *camera, near }
    }

    /// The image of a sample; none for a hole and for what the near plane cuts off.
    fn image(&self, p: DVec3) -> Option<DVec2> {
        let depth = (p - self.camera.eye()).dot(self.camera.forward());
        let is_seen = p.is_finite() && self.near.is_none_or(|near| depth >= near);
        is_seen.then(|| self.camera.image(p))
    }
}
