//! A spiral staircase, looking down its well.

use std::f64::consts::TAU;

use glam::{DVec3, dvec3};
use hiddenline::{DrawOptions, Error, PageOptions, PolygonSoup, Scene, Sheet, View};
use libm::{cos, sin};

const STEPS: u32 = 240;
const STEPS_A_TURN: f64 = 24.0;
const RISE: f64 = 0.12;
const THICKNESS: f64 = 0.08;

/// Winders between two radii: each a wedge with a gap to the next one above.
fn stair() -> Result<Scene, Error> {
    let mut soup = PolygonSoup::default();
    for step in 0..STEPS {
        let first = soup.positions.len() as u32;
        for z in [0.0, THICKNESS] {
            for side in [0.0, 1.15] {
                let angle = TAU * (f64::from(step) + side) / STEPS_A_TURN;
                let direction = dvec3(cos(angle), sin(angle), 0.0);
                for radius in [0.6, 1.5] {
                    let height = RISE * f64::from(step) + z;
                    soup.positions.push(radius * direction + height * DVec3::Z);
                }
            }
        }
        let sides =
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        for side in sides {
            soup.push_face(&side.map(|corner: u32| first + corner));
        }
    }
    Scene::from_polygons(soup)
}

pub(crate) fn sheet() -> Result<Sheet, Error> {
    let top = RISE * f64::from(STEPS);
    let eye = dvec3(0.0, 0.0, top + 1.4);
    let view = View::from_eye(eye).target(dvec3(0.06, -0.08, 0.0)).fov_deg(50.0);
    let stair = stair()?;
    let drawing = stair.draw(&view, &DrawOptions::default()).title("A spiral staircase");
    drawing.on(PageOptions::default().field_of_view())
}

fn main() -> Result<(), Error> {
    let sheet = sheet()?;
    sheet.save("plots/spiral_stair.svg")?;
    sheet.save_png("plots/spiral_stair.png", 1000)
}
