//! A torus in a room that is as long as it is: all axes to one scale.

use std::f64::consts::TAU;

use hiddenline::{Aspect, Axes, AxesStyle, Error, Paper, Sheet, Surface, SurfaceLines, View};

pub(crate) fn sheet() -> Result<Sheet, Error> {
    let torus = ["(3 + cos(v)) * cos(u)", "(3 + cos(v)) * sin(u)", "sin(v)"];
    let torus = Surface::parametric(torus, (0.0, TAU), (0.0, TAU))?.samples(181, 91);
    let torus = torus.aspect(Aspect::Data);
    let lines = SurfaceLines::default().every(3).silhouette().smoothness_mm(0.0);
    let lines = lines.axes(Axes::new(AxesStyle::Back));
    torus.draw(&View::default(), &lines).title("Torus").on(Paper::A5)
}

fn main() -> Result<(), Error> {
    let sheet = sheet()?;
    sheet.save("plots/surface_room.svg")?;
    sheet.save_png("plots/surface_room.png", 1000)
}
