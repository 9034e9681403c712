//! Spot, a cow, in five inks that lie beside each other, below her visible lines.

use hiddenline::{DrawOptions, Error, FillOptions, Palette, Paper, Scene, Sheet, UpAxis, View};

/// From night to noon.
const INKS: [[u8; 3]; 5] = [
    [0x2b, 0x2d, 0x42],
    [0x5a, 0x4a, 0x6a],
    [0xa8, 0x5d, 0x6e],
    [0xe5, 0x98, 0x72],
    [0xf8, 0xdc, 0xa8],
];

pub(crate) fn sheet() -> Result<Sheet, Error> {
    let scene = Scene::builder().up_axis(UpAxis::Y).open("examples/models/spot.obj")?.build()?;
    let view = View::from_angles(215.0, 14.0).distance(4.5);
    let inks = Palette::Inks(INKS.to_vec());
    let fill = FillOptions::default().palette(inks).paint([255, 240, 210]);
    let drawing = scene.draw(&view, &DrawOptions::default()).filled(fill);
    drawing.title("Spot in five inks").on(Paper::A4)
}

fn main() -> Result<(), Error> {
    let sheet = sheet()?;
    sheet.save("plots/fill_spot.svg")?;
    sheet.save_png("plots/fill_spot.png", 1000)
}
