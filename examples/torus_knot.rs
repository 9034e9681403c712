//! A knotted tube, woven of quadrilaterals.

mod plots;
mod sheet;

use std::f64::consts::TAU;

use glam::DVec3;
use libm::{cos, sin};

use hiddenline::stages::camera::framing::{Standpoint, View};
use hiddenline::stages::classify::LineSelection;
use hiddenline::stages::draw::DrawOptions;
use hiddenline::stages::model::mesh::{Mesh, PolygonSoup};
use hiddenline::stages::page::PageOptions;
use hiddenline::stages::plot::Plot;

use plots::{Result, save};
use sheet::Sheet;

const AROUND_KNOT: u32 = 360;
const AROUND_TUBE: u32 = 18;
const TUBE: f64 = 0.44;

/// The knot that winds twice around the axis while it goes thrice around the ring.
fn knot(turn: f64) -> DVec3 {
    let (long, short) = (2.0 * turn, 3.0 * turn);
    let radius = 2.0 + cos(short);
    DVec3::new(radius * cos(long), radius * sin(long), -sin(short))
}

/// Away from the ring that the knot is wound on.
fn outwards(turn: f64) -> DVec3 {
    let (long, short) = (2.0 * turn, 3.0 * turn);
    DVec3::new(cos(short) * cos(long), cos(short) * sin(long), -sin(short))
}

fn tube() -> Result<Mesh> {
    let mut soup = PolygonSoup::default();
    for i in 0..AROUND_KNOT {
        let turn = TAU * f64::from(i) / f64::from(AROUND_KNOT);
        let along = (knot(turn + 0.01) - knot(turn - 0.01)).normalize();
        let across = along.cross(outwards(turn)).normalize();
        let outwards = across.cross(along);
        for j in 0..AROUND_TUBE {
            let angle = TAU * f64::from(j) / f64::from(AROUND_TUBE);
            soup.positions.push(knot(turn) + TUBE * (cos(angle) * outwards + sin(angle) * across));
            let corner = |di, dj| (i + di) % AROUND_KNOT * AROUND_TUBE + (j + dj) % AROUND_TUBE;
            soup.push_face(&[corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)]);
        }
    }
    Ok(Mesh::new(soup)?.0)
}

pub(crate) fn plot() -> Result<Plot> {
    let standpoint = Standpoint::Angles { azimuth_deg: 12.0, elevation_deg: 55.0, distance: None };
    Sheet {
        title: "A knotted tube",
        mesh: tube()?,
        framing: View { standpoint, ..View::default() },
        draw: DrawOptions { lines: LineSelection::all_edges(), ..DrawOptions::default() },
        page: PageOptions::default(),
    }
    .plot()
}

fn main() -> Result<()> {
    save("torus_knot", &plot()?)
}
