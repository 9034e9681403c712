//! Ripples that two stones made, in cross-hatching under a low lamp.

use glam::{DVec3, dvec3};
use hiddenline::{
    DrawOptions, Error, HatchOptions, LightSource, LineSelection, Paper, Scene, Sheet, StrokeKind,
    View,
};

/// Points along a side.
const N: u32 = 110;

fn height(x: f64, y: f64) -> f64 {
    let wave = |a: f64, b: f64| {
        let r = (x - a).hypot(y - b);
        (3.2 * r).cos() * (-0.34 * r).exp()
    };
    0.75 * (wave(-1.6, -0.9) + wave(2.0, 1.3))
}

fn ripples() -> Result<Scene, Error> {
    let at = |k: u32| 5.0 * (2.0 * f64::from(k) / f64::from(N - 1) - 1.0);
    let points = (0..N).flat_map(|row| (0..N).map(move |column| (at(column), at(row))));
    let positions: Vec<DVec3> = points.map(|(x, y)| dvec3(x, y, height(x, y))).collect();
    let mut faces = Vec::new();
    for row in 0..N - 1 {
        for column in 0..N - 1 {
            let corner = row * N + column;
            faces.push([corner, corner + 1, corner + N + 1]);
            faces.push([corner, corner + N + 1, corner + N]);
        }
    }
    Scene::from_faces(&positions, faces)
}

pub(crate) fn sheet() -> Result<Sheet, Error> {
    let scene = ripples()?;
    let lines = LineSelection::NONE.with(StrokeKind::Silhouette).with(StrokeKind::Boundary);
    let hatch = HatchOptions::default()
        .angles_deg([20.0, -50.0])
        .light(LightSource::At(dvec3(-7.0, 2.0, 4.0)));
    let sheet = scene
        .draw(&View::from_angles(-28.0, 34.0), &DrawOptions::default().lines(lines))
        .hatched(hatch)
        .title("Ripples")
        .on(Paper::A5)?;
    Ok(sheet.optimized())
}

fn main() -> Result<(), Error> {
    let sheet = sheet()?;
    sheet.save("plots/hatch_ripples.svg")?;
    sheet.save_png("plots/hatch_ripples.png", 1000)
}
