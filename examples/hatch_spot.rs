//! Spot, a cow, in the light from the left: hatched, with its shadow on the ground.

use glam::dvec3;
use hiddenline::{
    DrawOptions, Error, Ground, HatchOptions, LightSource, LineSelection, PageOptions, Paper,
    Scene, Sheet, StrokeKind, UpAxis, View,
};

pub(crate) fn sheet() -> Result<Sheet, Error> {
    let scene = Scene::builder().up_axis(UpAxis::Y).open("examples/models/spot.obj")?.build()?;
    let lines = LineSelection::NONE.with(StrokeKind::Silhouette).with(StrokeKind::Boundary);
    let light = LightSource::From(dvec3(1.2, 1.0, 1.9));
    let hatch = HatchOptions::default().light(light).ground(Ground::Lowest);
    let sheet = scene
        .draw(&View::from_angles(215.0, 18.0), &DrawOptions::default().lines(lines))
        .hatched(hatch)
        .title("Spot, hatched")
        .on(PageOptions::from(Paper::A4).landscape())?;
    Ok(sheet.optimized())
}

fn main() -> Result<(), Error> {
    let sheet = sheet()?;
    sheet.save("plots/hatch_spot.svg")?;
    sheet.save_png("plots/hatch_spot.png", 1000)
}
