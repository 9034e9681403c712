//! Menger's sponge after three steps, seen from near by.

use glam::DVec3;
use hiddenline::{DrawOptions, Error, Paper, PolygonSoup, Scene, Sheet, View};

const STEPS: u32 = 3;
const SIDE: i32 = 3_i32.pow(STEPS);

/// Whether the small cube at these places along x, y and z is left: at no step is it in the middle
/// third along two of them.
fn is_left(mut cube: [i32; 3]) -> bool {
    if cube.iter().any(|&place| !(0..SIDE).contains(&place)) {
        return false;
    }
    (0..STEPS).all(|_| {
        let middles = cube.iter().filter(|&&place| place % 3 == 1).count();
        cube = cube.map(|place| place / 3);
        middles < 2
    })
}

/// One square for each side of a small cube on which there is no other.
fn sponge() -> Result<Scene, Error> {
    let mut soup = PolygonSoup::default();
    for number in 0..SIDE.pow(3) {
        let cube = [number % SIDE, number / SIDE % SIDE, number / SIDE / SIDE];
        for (axis, step) in [(0, -1), (0, 1), (1, -1), (1, 1), (2, -1), (2, 1)] {
            let mut beside = cube;
            beside[axis] += step;
            if !is_left(cube) || is_left(beside) {
                continue;
            }
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let ring = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[along_u, along_v]| {
                let mut corner = cube;
                corner[axis] += (step + 1) / 2;
                corner[u] += along_u;
                corner[v] += along_v;
                soup.positions.push(DVec3::from_array(corner.map(f64::from)));
                soup.positions.len() as u32 - 1
            });
            soup.push_face(&ring);
        }
    }
    Scene::from_polygons(soup)
}

pub(crate) fn sheet() -> Result<Sheet, Error> {
    let view = View::from_angles(37.0, 27.0).distance(62.0);
    let sponge = sponge()?;
    sponge.draw(&view, &DrawOptions::default()).title("Menger's sponge").on(Paper::A4)
}

fn main() -> Result<(), Error> {
    let sheet = sheet()?;
    sheet.save("plots/menger.svg")?;
    sheet.save_png("plots/menger.png", 1000)
}
