//! What it means that one face hides another: definitions 1 and 1′ of the lecture notes on visibility
//! (Slovak), word for word in exact numbers, against what the face engines paint.
//!
//! 1: S_i hides S_j along v when the two do not meet in space, their parallel images overlap, and at some
//! point of the overlap S_i is the nearer one. 1′: the same from a center C, by distances from C. The
//! notes reduce 1′ to 1 by a projective map P that takes sight lines through C to parallels.

use super::{ENGINES, EXACT};
use crate::laws::engines::{camera, mesh};
use crate::scenes::{Model, Rng, orthographic, perspective};
use hiddenline::stages::engines::face::Painting;
use hiddenline::stages::model::scene::Scene;

type P = [i64; 3];

fn minus(a: P, b: P) -> P {
    [0, 1, 2].map(|k| a[k] - b[k])
}

/// A triangle over the square of side `2 * SIZE` around the axis z, of no great tilt.
const SIZE: i64 = 6;

/// The plane of a triangle as `n · x = d`, with `n[2] > 0`.
fn plane([a, b, c]: [P; 3]) -> (P, i64) {
    let (p, q) = (minus(b, a), minus(c, a));
    let n = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
    let n = if n[2] < 0 { n.map(|x| -x) } else { n };
    (n, n[0] * a[0] + n[1] * a[1] + n[2] * a[2])
}

/// z of a plane above (x, y) / w, as numerator and positive denominator.
fn height((n, d): (P, i64), x: i64, y: i64, w: i64) -> (i64, i64) {
    (d * w - n[0] * x - n[1] * y, n[2] * w)
}

/// Corners of the plan square of triangle pairs below; both cover the middle.
fn triangle(rng: &mut Rng, level: i64) -> [P; 3] {
    let z = |rng: &mut Rng| level + rng.point(-1, 1)[2] as i64;
    [[-SIZE, -SIZE, z(rng)], [SIZE, -SIZE, z(rng)], [0, SIZE, z(rng)]]
}

fn model(triangles: &[[P; 3]]) -> Model {
    let mut model = Model::default();
    for triangle in triangles {
        model.face(&triangle.map(|p| p.map(|x| x as f64)));
    }
    model
}

/// The face that is painted last at the image of a point.
fn shown(painting: &Painting, at: glam::DVec2) -> Option<u32> {
    let holds = |ring: &[glam::DVec2]| {
        let sides = ring.iter().zip(ring.iter().cycle().skip(1));
        let crossed = sides.filter(|(a, b)| {
            (a.y > at.y) != (b.y > at.y) && at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x)
        });
        crossed.count() % 2 == 1
    };
    let pieces = painting
        .pieces()
        .filter(|piece| piece.rings().filter(|ring| holds(ring.points)).count() % 2 == 1);
    pieces.map(|piece| piece.face).last()
}

#[test]
fn a_face_hides_another_along_a_direction_as_definition_1_says() {
    let mut rng = Rng(21);
    let mut hidden = [0; 2];
    for _ in 0..40 {
        // The eye is at z = +∞; levels four apart keep the triangles from meeting.
        let levels = if rng.one_in(2) { [0, 4] } else { [4, 0] };
        let triangles = levels.map(|level| triangle(&mut rng, level));
        let planes = triangles.map(plane);
        let scene = model(&triangles)
            .seen_by("definition 1", orthographic([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]));
        let (built, camera) = (Scene::new(mesh(&scene)), camera(&scene));
        for (x, y) in [(0, -1), (1, -3), (-2, -4), (1, 1)] {
            let [a, b] = planes.map(|plane| height(plane, x, y, 1));
            // Nearer to z = +∞: the higher one.
            let first_hides = a.0 * b.1 > b.0 * a.1;
            hidden[usize::from(first_hides)] += 1;
            let at = camera.image(glam::dvec3(x as f64, y as f64, 0.0));
            for (name, solve) in [EXACT].into_iter().chain(ENGINES) {
                let found = shown(&solve(&built, &camera), at);
                assert_eq!(found, Some(u32::from(!first_hides)), "{name}: {triangles:?}");
            }
        }
    }
    assert!(hidden.iter().all(|&n| n > 20), "{hidden:?}");
}

#[test]
fn a_face_hides_another_from_a_center_as_definition_1_prime_says_and_as_its_parallel_image_does() {
    // C is at z = D. The map P, (x, y, z) to (x, y, −z D) / (D − z) up to a shift along z, keeps the
    // plane z = 0 and takes C to infinity: sight lines through C become parallels to z.
    const D: i64 = 24;
    let mut rng = Rng(22);
    let mut hidden = [0; 2];
    for _ in 0..40 {
        let levels = if rng.one_in(2) { [0, 4] } else { [4, 0] };
        let triangles = levels.map(|level| triangle(&mut rng, level));
        let sight = perspective([0.0, 0.0, D as f64], [0.0, 0.0, 0.0], 1e-6);
        let scene = model(&triangles).seen_by("definition 1 prime", sight);
        let (built, camera) = (Scene::new(mesh(&scene)), camera(&scene));
        for (x, y) in [(0, -1), (1, -3), (-2, -4), (1, 1)] {
            // Along the sight line C + t (x, y, −D): n · C + t (n · d) = d, so t as a fraction.
            let [a, b] = triangles.map(|triangle| {
                let (n, d) = plane(triangle);
                let (over, along) = (d - n[2] * D, n[0] * x + n[1] * y - n[2] * D);
                if along < 0 { (-over, -along) } else { (over, along) }
            });
            // Definition 1′: the smaller distance from C hides.
            let first_hides = a.0 * b.1 < b.0 * a.1;
            // Definition 1 on the images under P: there z′ = z D / (D − z), the higher one hides.
            let mapped = [a, b].map(|(over, along)| {
                let z = D as f64 * (1.0 - over as f64 / along as f64);
                z * D as f64 / (D as f64 - z)
            });
            assert_eq!(mapped[0] > mapped[1], first_hides, "{triangles:?}");
            hidden[usize::from(first_hides)] += 1;
            let at = camera.image(glam::dvec3(x as f64, y as f64, 0.0));
            for (name, solve) in [EXACT].into_iter().chain(ENGINES) {
                let found = shown(&solve(&built, &camera), at);
                assert_eq!(found, Some(u32::from(!first_hides)), "{name}: {triangles:?}");
            }
        }
    }
    assert!(hidden.iter().all(|&n| n > 20), "{hidden:?}");
}
