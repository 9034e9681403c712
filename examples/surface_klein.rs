//! A Klein bottle, the surface with one side, by the lines of its two parameters.

use hiddenline::{Error, Paper, Sheet, Surface, SurfaceLines, View};

/// A figure eight that makes half a turn while it goes around.
const KLEIN: [&str; 3] = [
    "(3 + cos(u/2)*sin(v) - sin(u/2)*sin(2*v))*cos(u)",
    "(3 + cos(u/2)*sin(v) - sin(u/2)*sin(2*v))*sin(u)",
    "sin(u/2)*sin(v) + cos(u/2)*sin(2*v)",
];

pub(crate) fn sheet() -> Result<Sheet, Error> {
    let turn = (0.0, std::f64::consts::TAU);
    let bottle = Surface::parametric(KLEIN, turn, turn)?.samples(145, 73);
    let lines = SurfaceLines::default().every(2).silhouette().smoothness_mm(0.0).without_axes();
    bottle.draw(&View::from_angles(20.0, 40.0), &lines).title("A Klein bottle").on(Paper::A4)
}

fn main() -> Result<(), Error> {
    let sheet = sheet()?;
    sheet.save("plots/surface_klein.svg")?;
    sheet.save_png("plots/surface_klein.png", 1000)
}
