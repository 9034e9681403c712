//! How finely formulas are sampled, so that drawn lines are as smooth as asked for.
//!
//! ```text
//!        ╭──●──╮       Of three neighboring samples on a drawn line the middle one lies off the
//!      ●´ ╌╌┆╌╌ `●     chord of the outer two, on paper; chords half as long are off by a quarter
//!                      of that, since the distance grows with the square of the length.
//! ```

use glam::{DVec2, DVec3};

use super::error::SurfaceError;
use super::grid::grid_to_draw;
use super::options::{SurfaceEngine, SurfaceLines};
use crate::camera::framing::View;
use crate::camera::{Camera, Projection};
use crate::page::{Page, PageOptions};
use crate::surface::{SampledSurface, Surface};

/// Most cells along an axis that one cell of the surface's own samples is divided into. Kinks and
/// cliffs are never smooth, however fine the samples.
const MOST_REFINED: usize = 8;

/// Most samples of a refined grid.
const MOST_SAMPLES: usize = 4_000_000;

/// Most samples of a refined surface that a mesh engine draws.
const MOST_MESH_SAMPLES: usize = 250_000;

/// Lines of a family that are looked at, evenly chosen.
const LINES_TESTED: usize = 128;

/// A surface that was sampled as finely as its lines need.
pub(super) struct SmoothSurface {
    pub(super) surface: SampledSurface,
    pub(super) camera: Camera,
    /// How many cells along each axis replace one cell of the surface's own samples.
    pub(super) refined: usize,
    /// How far lines are from the function at most, in millimeters on paper; 0 when they may be as
    /// far off as they are.
    pub(super) deviation_mm: f64,
}

/// Samples the surface, more finely where its lines would deviate from the function by more than
/// `lines` allow.
pub(super) fn sample(
    surface: &Surface,
    view: &View,
    lines: &SurfaceLines,
    page: &PageOptions,
) -> Result<SmoothSurface, SurfaceError> {
    let is_floating = lines.engine == SurfaceEngine::FloatingHorizon;
    let is_wanted = lines.smoothness_mm > 0.0 && !lines.mesh && !is_floating;
    let samples = surface.samples_of_formulas().filter(|_| is_wanted && lines.has_grid_lines());
    let mut refined = 1;
    loop {
        let sampled = surface.sample(refined)?;
        let camera = view.camera(sampled.bounds())?;
        let deviation_mm = samples.map_or(0.0, |_| deviation_mm(&sampled, &camera, page));
        let finer = match samples {
            Some(samples) if deviation_mm > lines.smoothness_mm && refined < MOST_REFINED => {
                let by_grid = matches!(grid_to_draw(&sampled, lines, &camera), Ok(Some(_)));
                let most = if by_grid { MOST_SAMPLES } else { MOST_MESH_SAMPLES };
                let cells = (samples.0 - 1).saturating_mul(samples.1 - 1).max(1);
                let affordable = (most as f64 / cells as f64).sqrt() as usize;
                let needed = refined as f64 * (deviation_mm / lines.smoothness_mm).sqrt();
                (needed.ceil() as usize).min(MOST_REFINED).min(affordable).max(refined)
            }
            _ => refined,
        };
        if finer <= refined {
            return Ok(SmoothSurface { surface: sampled, camera, refined, deviation_mm });
        }
        refined = finer;
    }
}

/// How far lines are from the function at most, in millimeters on paper.
fn deviation_mm(surface: &SampledSurface, camera: &Camera, page: &PageOptions) -> f64 {
    let projector = Projector::new(camera);
    let mut most = 0.0_f64;
    for lattice in surface.lattices() {
        let (n_columns, n_rows) = (lattice.n_columns, lattice.n_rows());
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
        along(n_rows, n_columns, &|line, k| lattice.sample(line * n_columns + k));
        along(n_columns, n_rows, &|line, k| lattice.sample(k * n_columns + line));
    }
    let page = Page::place(&surface.extent(camera), camera, page);
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
