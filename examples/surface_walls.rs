//! A hat of ripples before walls with a grid.

use hiddenline::{Axes, AxesStyle, Error, Paper, Sheet, Surface, SurfaceLines, View};

pub(crate) fn sheet() -> Result<Sheet, Error> {
    let hat = Surface::formula("sinc(r)")?.x(-12.0, 12.0).y(-12.0, 12.0).samples(161, 161);
    let lines = SurfaceLines::default().every(2).smoothness_mm(0.0);
    let lines = lines.axes(Axes::new(AxesStyle::Back));
    hat.draw(&View::default(), &lines).title("sin r / r").on(Paper::A5)
}

fn main() -> Result<(), Error> {
    let sheet = sheet()?;
    sheet.save("plots/surface_walls.svg")?;
    sheet.save_png("plots/surface_walls.png", 1000)
}
