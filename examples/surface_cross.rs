//! A map of a saddle: level curves with their heights, dashed below zero.

use hiddenline::{Error, Labels, Levels, Paper, Sheet, Surface, SurfaceLines, View};

pub(crate) fn sheet() -> Result<Sheet, Error> {
    let saddle = Surface::formula("x*y")?;
    let lines = SurfaceLines::default().no_grid_lines().negative_dashed().labels(Labels::All);
    let heights = (-8..=8).map(|k| 3.0 * f64::from(k));
    let lines = lines.levels(Levels::At(heights.collect()));
    saddle.draw(&View::top(), &lines).title("A saddle").on(Paper::A5)
}

fn main() -> Result<(), Error> {
    let sheet = sheet()?;
    sheet.save("plots/surface_cross.svg")?;
    sheet.save_png("plots/surface_cross.png", 1000)
}
