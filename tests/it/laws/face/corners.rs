//! Corners: their bounds of errors and sides, against integers that share nothing with the library.

use crate::laws::engines::mesh;
use crate::oracle::exact::{Int, Plane, Point, negated, plane_through, scaled, sign, value};
use crate::scenes::{Model, Rng, orthographic, random};
use hiddenline::stages::engines::face::fragment::Fragment;
use hiddenline::stages::engines::face::{bsp, octree};
use hiddenline::stages::model::scene::Scene;
use hiddenline::stages::predicates::{CornerPlace, PlaneName, Planes, Sign};

/// Numbers count in this power of two: finer than any that comes up.
const UNIT: i32 = -1100;

fn point(p: [f64; 3]) -> Point {
    let [x, y, z] = p.map(|x| scaled(x, UNIT));
    [x, y, z, Int::ONE]
}

struct World<'a>(&'a Scene);

impl World<'_> {
    fn vertex(&self, vertex: u32) -> Point {
        point(self.0.mesh().positions()[vertex as usize].to_array())
    }

    /// Positive where the library says so.
    fn plane(&self, name: PlaneName) -> Plane {
        match name {
            PlaneName::Triangle(t) => {
                let [a, b, c] = self.0.triangles()[t as usize].map(|v| self.vertex(v));
                negated(plane_through(&a, &b, &c))
            }
            PlaneName::Across { axis, at } => {
                let mut plane = [Int::ZERO, Int::ZERO, Int::ZERO, -scaled(at, UNIT)];
                plane[usize::from(axis)] = Int::ONE;
                plane
            }
            PlaneName::Near => panic!("there is no camera"),
        }
    }

    fn place(&self, place: &CornerPlace) -> Point {
        let found = match *place {
            CornerPlace::Vertex(vertex) => self.vertex(vertex),
            CornerPlace::OnEdge(ends, plane) => {
                let plane = self.plane(plane);
                let [p, q] = ends.map(|v| self.vertex(v));
                let (of_p, of_q) = (value(&plane, &p), value(&plane, &q));
                [0, 1, 2, 3].map(|i| &q[i] * &of_p - &p[i] * &of_q)
            }
            CornerPlace::InFace(planes) => {
                // Points and planes change places.
                let [a, b, c] = planes.map(|plane| self.plane(plane));
                plane_through(&a, &b, &c)
            }
        };
        if sign(&found[3]) < 0 { negated(found) } else { found }
    }
}

fn check(scene: &Scene, fragments: &[Fragment], n_checked: &mut [u32; 3]) {
    let world = World(scene);
    let planes = Planes::new(scene.mesh().positions(), scene.triangles());
    let forms: Vec<(PlaneName, Plane)> = fragments
        .iter()
        .map(|fragment| PlaneName::Triangle(fragment.triangle()))
        .map(|name| (name, world.plane(name)))
        .collect();
    for (k, fragment) in fragments.iter().enumerate() {
        for corner in fragment.corners() {
            let truth = world.place(&corner.place);
            let kind = match corner.place {
                CornerPlace::Vertex(_) => 0,
                CornerPlace::OnEdge(..) => 1,
                CornerPlace::InFace(_) => 2,
            };
            n_checked[kind] += 1;
            // Unknown where numbers are out of range.
            if corner.error.is_finite() {
                let error = scaled(corner.error, UNIT) * &truth[3];
                for (i, x) in corner.point.to_array().into_iter().enumerate() {
                    let off = &truth[i] - scaled(x, UNIT) * &truth[3];
                    assert!(off <= error && -off <= error, "{corner:?}");
                }
            }
            // Its own plane, where all depends on the exact path, and some others.
            for (name, form) in forms.iter().skip(k).step_by(7).take(5) {
                let expected = match sign(&value(form, &truth)) {
                    1 => Sign::Positive,
                    0 => Sign::Zero,
                    _ => Sign::Negative,
                };
                let (_, found) = planes.side(&planes.plane(*name), corner);
                assert_eq!(found, expected, "{corner:?} to {name:?}");
            }
        }
    }
}

fn check_both(scene: &Scene, n_checked: &mut [u32; 3]) {
    check(scene, bsp::BspTree::new(scene).unwrap().fragments(), n_checked);
    check(scene, octree::Octree::new(scene).unwrap().fragments(), n_checked);
}

#[test]
fn corners_are_where_integers_say() {
    let mut n_checked = [0; 3];
    for seed in 0..40 {
        check_both(&Scene::new(mesh(&random(seed))), &mut n_checked);
    }
    for seed in 0..6 {
        let mut rng = Rng(seed);
        let mut model = Model::default();
        for k in 0..60 {
            // Every bit in use; some share a corner, and some are nearly in one plane.
            let mut corners =
                [0; 3].map(|_| [0; 3].map(|_| (rng.next() >> 11) as f64 / 2f64.powi(50) - 4.0));
            if k % 3 == 0 {
                for corner in &mut corners {
                    corner[2] = 0.1 * (corner[0] + corner[1]);
                }
            }
            model.face(&corners);
        }
        let scene = model.seen_by("any", orthographic([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]));
        check_both(&Scene::new(mesh(&scene)), &mut n_checked);
    }
    // Products of three so small numbers lose their digits, and then vanish.
    for exponent in [-330, -342, -348, -356, -365] {
        for seed in 0..6 {
            let mut scene = random(seed);
            scene.positions.iter_mut().flatten().for_each(|x| *x *= 2f64.powi(exponent));
            check_both(&Scene::new(mesh(&scene)), &mut n_checked);
        }
    }
    eprintln!("vertices, on edges, in faces: {n_checked:?}");
    assert!(n_checked.iter().all(|&n| n > 500), "{n_checked:?}");
}
