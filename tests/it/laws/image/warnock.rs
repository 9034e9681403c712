//! Warnock's example: a triangle that crosses a square, in a window of 16 × 16 pixels.
//!
//! The triangle lies in z = y − x + 6, so it is in front of the square at z = 6 where y < x; along
//! y = x they are equally near, and the triangle, being the first, is seen.

use glam::DVec3;
use hiddenline::stages::engines::image::{ImageEngine, NOTHING, Raster, solve};

const A: [[f64; 3]; 3] = [[18.5, 12.5, 0.0], [22.5, 16.5, 0.0], [14.5, 22.5, 14.0]];
const B: [[f64; 3]; 4] =
    [[12.5, 14.5, 6.0], [20.5, 14.5, 6.0], [20.5, 20.5, 6.0], [12.5, 20.5, 6.0]];

/// The picture, as it is or mirrored from left to right.
fn picture(mirrored: bool) -> Raster {
    let place = |[x, y, z]: [f64; 3]| {
        let x = if mirrored { 25.5 - x } else { x - 9.5 };
        DVec3::new(x, y - 9.5, 100.0 - z)
    };
    let triangles =
        [(A.map(place), 0), ([B[0], B[1], B[2]].map(place), 1), ([B[0], B[2], B[3]].map(place), 2)];
    Raster::of_triangles(&triangles, (16, 16))
}

/// What a center shows: 'A', 'B' or ' '.
fn expected(x: i32, y: i32, with_border: bool) -> char {
    // Twice the corners, so that all are integers.
    let corners = A.map(|[x, y, _]| [(2.0 * x) as i32, (2.0 * y) as i32]);
    let side = |k: usize| {
        let ([px, py], [qx, qy]) = (corners[k], corners[(k + 1) % 3]);
        (qx - px) * (2 * y - py) - (qy - py) * (2 * x - px)
    };
    let in_a = side(1) > 0 && side(2) > 0 && (side(0) > 0 || with_border && side(0) == 0);
    let in_b = (13..=20).contains(&x) && (15..=20).contains(&y);
    match (in_a, in_b) {
        (true, true) => {
            if y <= x {
                'A'
            } else {
                'B'
            }
        }
        (true, false) => 'A',
        (false, true) => 'B',
        (false, false) => ' ',
    }
}

#[test]
fn the_example_has_its_known_picture() {
    // The upper right border passes through four centers: the triangle's when it is on the left.
    for (mirrored, n_a) in [(false, 20), (true, 24)] {
        let raster = picture(mirrored);
        for engine in ImageEngine::ALL {
            if engine == ImageEngine::Painter {
                continue;
            }
            let items = solve(&raster, engine);
            let mut counts = [0; 3];
            for (at, &item) in (0..).zip(&items) {
                let (column, y) = (at % 16, 10 + at / 16);
                let x = if mirrored { 25 - column } else { 10 + column };
                let found = match item {
                    0 => 'A',
                    NOTHING => ' ',
                    _ => 'B',
                };
                assert_eq!(found, expected(x, y, mirrored), "{engine:?}, {mirrored}: {x}, {y}");
                counts[" AB".find(found).unwrap()] += 1;
            }
            assert_eq!(counts, [256 - n_a - 34, n_a, 34], "{engine:?}, {mirrored}");
        }
    }
}
