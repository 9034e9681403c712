//! Spikes that stand in front of each other.

use hiddenline::{Aspect, Error, Paper, Sheet, Surface, SurfaceLines, View};

/// Hills and dents alternate.
const SPIKES: &str = "max(0, sin(x)*sin(y))^12 + max(0, -sin(x)*sin(y))^3/4";

pub(crate) fn sheet() -> Result<Sheet, Error> {
    let range = 9.42477796076938;
    // Sampled finely for smooth curves.
    let spikes = Surface::formula(SPIKES)?.x(-range, range).y(-range, range).samples(301, 301);
    let spikes = spikes.aspect(Aspect::Data).z_scale(5.0);
    let lines = SurfaceLines::default().every(5).silhouette().smoothness_mm(0.0).without_axes();
    spikes.draw(&View::from_angles(-65.0, 22.0), &lines).title("Spikes").on(Paper::A4)
}

fn main() -> Result<(), Error> {
    let sheet = sheet()?;
    sheet.save("plots/surface_spikes.svg")?;
    sheet.save_png("plots/surface_spikes.png", 1000)
}
