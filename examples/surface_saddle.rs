//! A saddle: the plane curves up along y and down along x.

use hiddenline::{Aspect, Error, Paper, Sheet, Surface, SurfaceLines, View};

pub(crate) fn sheet() -> Result<Sheet, Error> {
    // Sampled finely for smooth curves.
    let saddle = Surface::formula("y^2 - x^2")?.x(-1.0, 1.0).y(-1.0, 1.0).samples(161, 161);
    let saddle = saddle.aspect(Aspect::Data).z_scale(0.45);
    let lines = SurfaceLines::default().every(8).silhouette().smoothness_mm(0.0).without_axes();
    saddle.draw(&View::from_angles(-55.0, 24.0), &lines).title("Saddle").on(Paper::A4)
}

fn main() -> Result<(), Error> {
    let sheet = sheet()?;
    sheet.save("plots/surface_saddle.svg")?;
    sheet.save_png("plots/surface_saddle.png", 1000)
}
