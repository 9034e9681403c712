//! A landscape made of smooth noise, finer and lower from octave to octave.

use hiddenline::{Aspect, Error, Paper, Sheet, Surface, SurfaceLines, View};

/// Cells of the coarsest octave along each axis.
const CELLS: f64 = 3.0;

/// Octaves of noise.
const OCTAVES: u32 = 6;

/// A number in 0..1 that belongs to a point of the lattice.
fn lattice(i: u32, j: u32) -> f64 {
    let mut h = i.wrapping_mul(0x9e37_79b9) ^ j.wrapping_mul(0x85eb_ca6b) ^ 0x27d4_eb2f;
    for _ in 0..2 {
        h = (h ^ (h >> 15)).wrapping_mul(0x2c1b_3c6d);
        h = (h ^ (h >> 12)).wrapping_mul(0x297a_2d39);
    }
    f64::from(h ^ (h >> 15)) / f64::from(u32::MAX)
}

fn noise(x: f64, y: f64) -> f64 {
    let (i, j) = (x.floor(), y.floor());
    let smooth = |t: f64| t * t * t * (t * (6.0 * t - 15.0) + 10.0);
    let (s, t) = (smooth(x - i), smooth(y - j));
    let at = |di: u32, dj: u32| lattice(i as u32 + di, j as u32 + dj);
    let below = at(0, 0) + s * (at(1, 0) - at(0, 0));
    let above = at(0, 1) + s * (at(1, 1) - at(0, 1));
    below + t * (above - below)
}

/// Ridges where the noise is middling, squared so that valleys are wide.
fn height(x: f64, y: f64) -> f64 {
    let octave = |k: u32| {
        let scale = f64::from(1_u32 << k);
        let ridge = 1.0 - (2.0 * noise(x * scale, y * scale + f64::from(7 * k)) - 1.0).abs();
        ridge * ridge / scale
    };
    (0..OCTAVES).map(octave).sum()
}

pub(crate) fn sheet() -> Result<Sheet, Error> {
    let range = (0.0, CELLS);
    let land = Surface::from_fn(range, range, (261, 261), |x, y| 0.42 * height(x, y))?;
    let land = land.aspect(Aspect::Data);
    let lines = SurfaceLines::default().every(2).silhouette().smoothness_mm(0.0).without_axes();
    land.draw(&View::from_angles(-70.0, 36.0), &lines).title("Landscape").on(Paper::A4)
}

fn main() -> Result<(), Error> {
    let sheet = sheet()?;
    sheet.save("plots/surface_terrain.svg")?;
    sheet.save_png("plots/surface_terrain.png", 1000)
}
