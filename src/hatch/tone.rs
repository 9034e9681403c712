//! Tone: how dark a place is, and where a line of a family is drawn to match.
//!
//! ```text
//!   tone      T = ambient + (1 − ambient) · max(0, n · l) where the light reaches, else ambient
//!   darkness  D = (white − T) / white, from 0 to 1
//!   coverage  c = black · D          lines of width w at distance s cover w / s
//! ```
//!
//! Families share the coverage from light to dark: up to `black / n` only the first one draws, above
//! that it stays and the second one adds what is missing, and so on. All are linear in the tone, so a
//! line begins and ends where linear functions cross. All this is rounded: tone does not decide visibility.

use glam::DVec3;

use super::families::{Family, Paper};
use super::options::{HatchLevels, HatchOptions, HatchPage, HatchShadows};
use crate::camera::Camera;
use crate::model::scene::Scene;
use crate::predicates::Sign;
use crate::shading::light::Light;
use crate::shading::normals::{area_vector, corners, smooth_normals};

/// How dark the shadow on the ground is, as a part of that on faces.
const GROUND_DARKNESS: f64 = 0.5;

/// Densities over a triangle may be this much lower than at its corners.
const DENSITY_SLACK: f64 = 0.7;

/// The tones of a scene.
pub(super) struct Tones<'a> {
    scene: &'a Scene,
    light: Light,
    paper: Paper,
    pen_width_mm: f64,
    white: f64,
    ambient: f64,
    levels: HatchLevels,
    shadows: HatchShadows,
    /// For each corner of each triangle; empty where faces are flat.
    normals: Vec<[DVec3; 3]>,
}

/// What the tone is at a point, for one family.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sample {
    /// Coverage in the light; not cut off at zero nor at what shadows have.
    coverage: f64,
    /// Coverage in the shade.
    shade: f64,
    /// Lines a millimeter at base distance, times the width of the pen.
    density: f64,
    /// Above zero where the family draws.
    draws: f64,
}

impl<'a> Tones<'a> {
    pub(super) fn new(
        scene: &'a Scene,
        camera: &Camera,
        light: Light,
        options: &HatchOptions,
        page: &HatchPage,
    ) -> Self {
        Self {
            scene,
            light,
            paper: Paper::new(camera, page),
            pen_width_mm: page.pen_width_mm,
            white: options.white,
            ambient: options.ambient,
            levels: options.levels,
            shadows: options.shadows,
            normals: match options.smooth_deg > 0.0 {
                true => smooth_normals(scene, options.smooth_deg),
                false => Vec::new(),
            },
        }
    }

    /// Coverage at a tone, not cut off.
    fn coverage(&self, tone: f64, black: f64) -> f64 {
        black * (self.white - tone) / self.white
    }

    /// Coverage where no light reaches.
    fn shade(&self, black: f64) -> f64 {
        self.coverage(self.ambient, black).max(0.0)
    }

    /// Coverage by the cosine of the angle between normal and light.
    fn in_light(&self, cosine: f64, black: f64) -> f64 {
        let light = match self.shadows {
            // Half of what there is of it on the side turned away.
            HatchShadows::None => (1.0 + cosine) / 2.0,
            HatchShadows::Only => return f64::NEG_INFINITY,
            HatchShadows::Cast | HatchShadows::Own => cosine,
        };
        self.coverage(self.ambient + (1.0 - self.ambient) * light, black)
    }

    /// The normal at a point of a triangle, of length one, on the side of the viewer: that of the
    /// triangle's turn.
    pub(super) fn normal(&self, triangle: u32, at: DVec3, turn: Sign) -> DVec3 {
        let [a, b, c] = corners(self.scene, triangle);
        let flat = area_vector([a, b, c]);
        let normal = match self.normals.get(triangle as usize) {
            None => flat,
            Some(normals) => {
                let parts =
                    [[at, b, c], [a, at, c], [a, b, at]].map(|part| area_vector(part).dot(flat));
                let mixed: DVec3 =
                    normals.iter().zip(parts).map(|(&normal, part)| normal * part.max(0.0)).sum();
                if mixed.is_finite() && mixed != DVec3::ZERO { mixed } else { flat }
            }
        };
        let normal = normal.normalize_or_zero();
        if turn == Sign::Negative { -normal } else { normal }
    }

    /// Whether the normals over a triangle are all the same.
    pub(super) fn is_flat(&self, triangle: u32) -> bool {
        let Some([a, b, c]) = self.normals.get(triangle as usize) else { return true };
        a == b && b == c
    }

    /// What the tone is at a point of a triangle; `turn` is that of its image.
    pub(super) fn sample(&self, family: &Family, triangle: u32, at: DVec3, turn: Sign) -> Sample {
        let normal = self.normal(triangle, at, turn);
        let cosine = normal.dot(self.light.towards(at));
        Sample {
            coverage: self.in_light(cosine, family.black),
            shade: self.shade(family.black),
            density: family.density(&self.paper, at, normal) * self.pen_width_mm,
            draws: family.draws_on(normal),
        }
    }

    /// What the tone is at a point of the ground.
    pub(super) fn ground_sample(&self, family: &Family, at: DVec3) -> Sample {
        Sample {
            coverage: f64::NEG_INFINITY,
            shade: self.shade(family.black) * GROUND_DARKNESS,
            density: family.density(&self.paper, at, DVec3::Z) * self.pen_width_mm,
            draws: if family.draws_on_flat(DVec3::Z) { 1.0 } else { -1.0 },
        }
    }

    /// Lines of a family with this rank or a higher one are not drawn anywhere on a triangle.
    pub(super) fn highest_rank(
        &self,
        family: &Family,
        triangle: u32,
        points: &[DVec3; 3],
        turn: Sign,
    ) -> f64 {
        let samples = points.map(|point| self.sample(family, triangle, point, turn));
        let is_smooth = !self.is_flat(triangle);
        if samples.iter().all(|sample| sample.draws <= 0.0) && !is_smooth {
            return 0.0;
        }
        highest_rank(family, &samples, self.can_be_in_shade())
    }

    /// The same for a convex part of the ground.
    pub(super) fn highest_rank_on_ground(&self, family: &Family, points: &[DVec3]) -> f64 {
        let samples: Vec<Sample> = points.iter().map(|&p| self.ground_sample(family, p)).collect();
        if samples.iter().all(|sample| sample.draws <= 0.0) {
            return 0.0;
        }
        highest_rank(family, &samples, true)
    }

    fn can_be_in_shade(&self) -> bool {
        self.shadows != HatchShadows::None
    }

    /// Whether shadows that something casts matter.
    pub(super) fn has_cast_shadows(&self) -> bool {
        matches!(self.shadows, HatchShadows::Cast | HatchShadows::Only)
    }

    /// Whether faces that are turned away from the light are in the shade.
    pub(super) fn has_own_shadows(&self) -> bool {
        self.shadows != HatchShadows::None
    }

    /// Where between two samples a line with some rank is drawn, as parts of the way.
    pub(super) fn drawn_part(
        &self,
        family: &Family,
        rank: f64,
        ends: [&Sample; 2],
        is_lit: bool,
    ) -> Option<[f64; 2]> {
        let needed = |sample: &Sample| family.from + (1.0 - family.from) * rank * sample.density;
        let needed = match self.levels {
            HatchLevels::Halving | HatchLevels::Continuous => ends.map(needed),
            HatchLevels::Steps(n) => {
                // The least darkness that is rounded to more than is needed.
                let n = f64::from(n);
                let middle = (needed(ends[0]) + needed(ends[1])) / 2.0;
                let step = (n * middle / family.black).floor();
                [family.black * (step + 0.5) / n; 2]
            }
        };
        let mut part = [0.0, 1.0];
        let mut keep = |f: [f64; 2]| {
            if !(f[0] > 0.0 || f[1] > 0.0) {
                part = [1.0, 0.0];
            } else if f[0] <= 0.0 {
                part[0] = f64::max(part[0], f[0] / (f[0] - f[1]));
            } else if f[1] <= 0.0 {
                part[1] = f64::min(part[1], f[0] / (f[0] - f[1]));
            }
        };
        if is_lit {
            keep([0, 1].map(|i| ends[i].coverage - needed[i]));
        }
        keep([0, 1].map(|i| ends[i].shade - needed[i]));
        keep([0, 1].map(|i| family.most - rank * ends[i].density));
        keep([0, 1].map(|i| ends[i].draws));
        (part[0] < part[1]).then_some(part)
    }
}

fn highest_rank(family: &Family, samples: &[Sample], can_be_in_shade: bool) -> f64 {
    let most = samples.iter().fold(f64::NEG_INFINITY, |most, sample| {
        let in_light = sample.coverage.min(sample.shade);
        most.max(if can_be_in_shade { sample.shade } else { in_light })
    });
    let least = samples.iter().fold(f64::INFINITY, |least, sample| least.min(sample.density));
    (most - family.from) / ((1.0 - family.from) * least * DENSITY_SLACK)
}
