//! A knotted tube, woven of quadrilaterals.

use std::f64::consts::TAU;

use glam::DVec3;
use hiddenline::{DrawOptions, Error, Paper, PolygonSoup, Scene, Sheet, View};
use libm::{atan2, cos, sin};

const AROUND_KNOT: u32 = 360;
const AROUND_TUBE: u32 = 18;
const TUBE: f64 = 0.44;

/// The knot that winds twice around the axis while it goes thrice around the ring.
fn knot(turn: f64) -> DVec3 {
    let (long, short) = (2.0 * turn, 3.0 * turn);
    let radius = 2.0 + cos(short);
    DVec3::new(radius * cos(long), radius * sin(long), -sin(short))
}

fn along(turn: f64) -> DVec3 {
    (knot(turn + 0.01) - knot(turn - 0.01)).normalize()
}

/// Directions across the tube that twist as little as the knot allows: each is the one before it,
/// made perpendicular to the knot again.
fn across() -> Vec<DVec3> {
    let turns = (0..=AROUND_KNOT).map(|i| TAU * f64::from(i) / f64::from(AROUND_KNOT));
    let start = along(0.0).cross(DVec3::X).normalize();
    let carried = turns.scan(start, |across, turn| {
        *across = across.reject_from_normalized(along(turn)).normalize();
        Some(*across)
    });
    carried.collect()
}

fn tube() -> Result<Scene, Error> {
    let across = across();
    // Once around, the directions come back turned. The turn to the nearest seam of the tube is
    // spread over all steps, so that the quadrilaterals close.
    let (first, last) = (across[0], across[AROUND_KNOT as usize]);
    let missing = atan2(first.cross(last).dot(along(0.0)), first.dot(last));
    let seam = TAU / f64::from(AROUND_TUBE);
    let seams = (missing / seam).round();
    let twist = (missing - seams * seam) / f64::from(AROUND_KNOT);
    let mut soup = PolygonSoup::default();
    for i in 0..AROUND_KNOT {
        let turn = TAU * f64::from(i) / f64::from(AROUND_KNOT);
        let (u, v) = (across[i as usize], along(turn).cross(across[i as usize]));
        for j in 0..AROUND_TUBE {
            let angle = seam * f64::from(j) - twist * f64::from(i);
            soup.positions.push(knot(turn) + TUBE * (cos(angle) * u + sin(angle) * v));
            let shift = if i + 1 == AROUND_KNOT { seams as i64 } else { 0 };
            let corner = |di: u32, dj: u32| {
                let around =
                    (i64::from(j + dj) + i64::from(di) * shift).rem_euclid(AROUND_TUBE.into());
                (i + di) % AROUND_KNOT * AROUND_TUBE + around as u32
            };
            soup.push_face(&[corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)]);
        }
    }
    Scene::from_polygons(soup)
}

pub(crate) fn sheet() -> Result<Sheet, Error> {
    let tube = tube()?;
    let lines = DrawOptions::default().all_edges();
    tube.draw(&View::from_angles(12.0, 55.0), &lines).title("A knotted tube").on(Paper::A4)
}

fn main() -> Result<(), Error> {
    let sheet = sheet()?;
    sheet.save("plots/torus_knot.svg")?;
    sheet.save_png("plots/torus_knot.png", 1000)
}
