//! A volcano with a crater and gullies down its slopes.

use hiddenline::{Aspect, Error, Paper, Sheet, Surface, SurfaceLines, View};

/// A cone with gullies, less its crater.
const VOLCANO: &str =
    "exp(-(r/3.2)^1.5)*(1 + 0.07*sin(13*theta + 2*sin(r))*min(1, r/2)) - 0.75*exp(-(r/0.85)^2)";

pub(crate) fn sheet() -> Result<Sheet, Error> {
    // Sampled finely for smooth curves.
    let volcano = Surface::formula(VOLCANO)?.x(-6.0, 6.0).y(-6.0, 6.0).samples(301, 301);
    let volcano = volcano.aspect(Aspect::Data).z_scale(4.2);
    let lines = SurfaceLines::default().every(5).silhouette().smoothness_mm(0.0).without_axes();
    volcano.draw(&View::from_angles(-50.0, 32.0), &lines).title("Volcano").on(Paper::A4)
}

fn main() -> Result<(), Error> {
    let sheet = sheet()?;
    sheet.save("plots/surface_volcano.svg")?;
    sheet.save_png("plots/surface_volcano.png", 1000)
}
