//! A hill and a hollow over a square, by grid lines, with axes.

use hiddenline::{Aspect, Error, Paper, Sheet, Surface, SurfaceLines, Titles, View};

const PEAKS: &str =
    "3*(1-x)^2*exp(-x^2-(y+1)^2) - 10*(x/5-x^3-y^5)*exp(-x^2-y^2) - exp(-(x+1)^2-y^2)/3";

pub(crate) fn sheet() -> Result<Sheet, Error> {
    // Sampled finely for smooth curves, of which every fifth is drawn.
    let peaks = Surface::formula(PEAKS)?.x(-3.0, 3.0).y(-3.0, 3.0).samples(241, 241);
    let peaks = peaks.aspect(Aspect::Data).z_scale(0.22);
    let titles = Titles::of_drawing("Peaks");
    let lines = SurfaceLines::default().every(5).smoothness_mm(0.0).axes(titles);
    peaks.draw(&View::default(), &lines).title("Peaks").on(Paper::A4)
}

fn main() -> Result<(), Error> {
    let sheet = sheet()?;
    sheet.save("plots/surface_peaks.svg")?;
    sheet.save_png("plots/surface_peaks.png", 1000)
}
