//! A spiral staircase, looking down its well.

mod plots;
mod sheet;

use std::f64::consts::TAU;

use glam::{DVec3, dvec3};
use libm::{cos, sin};

use hiddenline::stages::camera::framing::{Standpoint, View};
use hiddenline::stages::draw::DrawOptions;
use hiddenline::stages::model::mesh::{Mesh, PolygonSoup};
use hiddenline::stages::page::{PageOptions, Placement};
use hiddenline::stages::plot::Plot;

use plots::{Result, save};
use sheet::Sheet;

const STEPS: u32 = 240;
const STEPS_A_TURN: f64 = 24.0;
const RISE: f64 = 0.12;
const THICKNESS: f64 = 0.08;

/// Winders between two radii: each a wedge with a gap to the next one above.
fn stair() -> Result<Mesh> {
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
    Ok(Mesh::new(soup)?.0)
}

pub(crate) fn plot() -> Result<Plot> {
    let top = RISE * f64::from(STEPS);
    let framing = View {
        standpoint: Standpoint::Eye(dvec3(0.0, 0.0, top + 1.4)),
        target: Some(dvec3(0.06, -0.08, 0.0)),
        fov_deg: 50.0,
        ..View::default()
    };
    Sheet {
        title: "A spiral staircase",
        mesh: stair()?,
        framing,
        draw: DrawOptions::default(),
        page: PageOptions { placement: Placement::FieldOfView, ..PageOptions::default() },
    }
    .plot()
}

fn main() -> Result<()> {
    save("spiral_stair", &plot()?)
}
