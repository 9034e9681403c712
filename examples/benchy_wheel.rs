//! The steering wheel of a small boat, with the edges that it hides dashed.

use hiddenline::{DrawOptions, Error, HiddenLines, Paper, Scene, Sheet, View};

pub(crate) fn sheet() -> Result<Sheet, Error> {
    let scene = Scene::open("examples/models/benchy_wheel.stl")?;
    let lines = DrawOptions::default().hidden(HiddenLines::Dashed);
    let drawing = scene.draw(&View::from_angles(205.0, 20.0), &lines);
    drawing.title("Wheel of a 3DBenchy").on(Paper::A4)
}

fn main() -> Result<(), Error> {
    let sheet = sheet()?;
    sheet.save("plots/benchy_wheel.svg")?;
    sheet.save_png("plots/benchy_wheel.png", 1000)
}
