//! A function with poles on a circle, open along it.

use hiddenline::{Error, Paper, Sheet, Surface, SurfaceLines, Titles, View};

pub(crate) fn sheet() -> Result<Sheet, Error> {
    let ring = Surface::formula("1/(x^2 + y^2 - 4)")?.x(-4.0, 4.0).y(-4.0, 4.0).samples(61, 61);
    let lines = SurfaceLines::default().axes(Titles::of_drawing("1/(x² + y² − 4)"));
    ring.draw(&View::default(), &lines).title("A ring of poles").on(Paper::A4)
}

fn main() -> Result<(), Error> {
    let sheet = sheet()?;
    sheet.save("plots/surface_pole_ring.svg")?;
    sheet.save_png("plots/surface_pole_ring.png", 1000)
}
