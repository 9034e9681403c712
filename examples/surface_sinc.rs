//! A hat: sin r / r.

use hiddenline::{Aspect, Error, Paper, Sheet, Surface, SurfaceLines, View};

pub(crate) fn sheet() -> Result<Sheet, Error> {
    // Sampled finely for smooth curves.
    let hat = Surface::formula("sinc(r)")?.x(-12.0, 12.0).y(-12.0, 12.0).samples(241, 241);
    let hat = hat.aspect(Aspect::Data).z_scale(8.0);
    let lines = SurfaceLines::default().every(4).silhouette().smoothness_mm(0.0).without_axes();
    hat.draw(&View::from_angles(-60.0, 28.0), &lines).title("Sinc hat").on(Paper::A4)
}

fn main() -> Result<(), Error> {
    let sheet = sheet()?;
    sheet.save("plots/surface_sinc.svg")?;
    sheet.save_png("plots/surface_sinc.png", 1000)
}
