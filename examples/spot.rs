//! Spot, a cow: every visible edge of her mesh.

use hiddenline::{DrawOptions, Error, Paper, Scene, Sheet, UpAxis, View};

pub(crate) fn sheet() -> Result<Sheet, Error> {
    let scene = Scene::builder().up_axis(UpAxis::Y).open("examples/models/spot.obj")?.build()?;
    let view = View::from_angles(215.0, 14.0).distance(4.5);
    scene.draw(&view, &DrawOptions::default().all_edges()).title("Spot").on(Paper::A4)
}

fn main() -> Result<(), Error> {
    let sheet = sheet()?;
    sheet.save("plots/spot.svg")?;
    sheet.save_png("plots/spot.png", 1000)
}
