//! A judge that knows nothing of pixels: sight lines in space against every triangle.
//!
//! Where floating point is not sure, rational arithmetic decides. The sight line through a pixel's
//! center is taken as its rounded direction says, so engines, which round the corners' images, may
//! differ from it only where it passes next to a border or where depths agree: such pixels are
//! counted.

use super::{built, face, fitted};
use crate::scenes::{number_of_scenes, random};
use dashu_ratio::RBig;
use glam::{DVec2, DVec3};
use hiddenline::camera::{Camera, Projection};
use hiddenline::engines::image::{ImageEngine, solve};

/// Distances, as parts of the whole, at which floating point is not sure.
const DOUBT: f64 = 1e-9;

/// The sight line through a pixel's center: kept from `near` on, in multiples of `direction`.
struct SightLine {
    origin: DVec3,
    direction: DVec3,
    near: Option<f64>,
}

impl SightLine {
    fn new(camera: &Camera, image: DVec2) -> Self {
        let frame = camera.frame();
        let aside = frame.right * image.x + frame.upward * image.y;
        match camera.projection() {
            Projection::Perspective { near, .. } => Self {
                origin: camera.eye(),
                direction: frame.forward + aside,
                near: Some(near * camera.forward().length()),
            },
            Projection::Orthographic => {
                Self { origin: camera.eye() + aside, direction: frame.forward, near: None }
            }
        }
    }

    /// The number of the triangle that is met first; `Err` where rounding might decide.
    fn meets(&self, triangles: &[[DVec3; 3]]) -> Result<Option<u32>, ()> {
        let mut hits: Vec<(f64, u32)> = Vec::new();
        for (number, [a, b, c]) in (0..).zip(triangles) {
            let (p, q) = (b - a, c - a);
            let normal = p.cross(q);
            let towards = normal.dot(self.direction);
            let size = normal.length() * self.direction.length();
            if towards.abs() <= DOUBT * size {
                if (a - self.origin).dot(normal).abs() <= 1e-6 * size {
                    return Err(()); // edge-on
                }
                continue;
            }
            let t = (a - self.origin).dot(normal) / towards;
            let x = self.origin + self.direction * t - *a;
            let u = x.cross(q).dot(normal) / normal.length_squared();
            let v = p.cross(x).dot(normal) / normal.length_squared();
            let least = u.min(v).min(1.0 - u - v);
            if least < -DOUBT {
                continue;
            }
            if least < DOUBT || self.near.is_some_and(|near| (t - near).abs() < DOUBT) {
                return Err(());
            }
            if self.near.is_none_or(|near| t > near) {
                hits.push((t, number));
            }
        }
        hits.sort_by(|a, b| a.0.total_cmp(&b.0));
        match hits[..] {
            [] => Ok(None),
            [(_, number)] => Ok(Some(number)),
            [(t, number), (next, _), ..] if next - t > DOUBT * t.abs().max(1.0) => Ok(Some(number)),
            _ => Err(()),
        }
    }

    /// The same, decided in rational arithmetic; of several at one place the lowest number.
    fn meets_exactly(&self, triangles: &[[DVec3; 3]]) -> Option<u32> {
        let (origin, direction) = (rational(self.origin), rational(self.direction));
        let near = self.near.map(|near| RBig::try_from(near).unwrap());
        let mut first: Option<(RBig, u32)> = None;
        for (number, corners) in (0..).zip(triangles) {
            let [a, b, c] = corners.map(rational);
            let normal = cross(&minus(&b, &a), &minus(&c, &a));
            let towards = dot(&normal, &direction);
            if towards == RBig::ZERO {
                continue;
            }
            let t = dot(&minus(&a, &origin), &normal) / towards;
            let x: Rational3 = std::array::from_fn(|i| &origin[i] + &t * &direction[i]);
            let is_inside = [(&a, &b), (&b, &c), (&c, &a)].into_iter().all(|(from, to)| {
                dot(&cross(&minus(to, from), &minus(&x, from)), &normal) >= RBig::ZERO
            });
            let is_kept = near.as_ref().is_none_or(|near| t >= *near);
            if is_inside && is_kept && first.as_ref().is_none_or(|(nearest, _)| t < *nearest) {
                first = Some((t, number));
            }
        }
        first.map(|(_, number)| number)
    }
}

type Rational3 = [RBig; 3];

fn rational(point: DVec3) -> Rational3 {
    point.to_array().map(|x| RBig::try_from(x).unwrap())
}

fn minus(a: &Rational3, b: &Rational3) -> Rational3 {
    std::array::from_fn(|i| &a[i] - &b[i])
}

fn dot(a: &Rational3, b: &Rational3) -> RBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn cross(a: &Rational3, b: &Rational3) -> Rational3 {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        &a[j] * &b[k] - &a[k] * &b[j]
    })
}

#[test]
fn pixels_show_what_sight_lines_meet() {
    let engines = ImageEngine::ALL.into_iter().filter(|&engine| engine != ImageEngine::Painter);
    let engines: Vec<ImageEngine> = engines.collect();
    let (mut judged, mut by_rationals, mut differing) = (0u32, 0u32, 0u32);
    for seed in 0..number_of_scenes(120) {
        let (scene, camera) = built(&random(seed));
        let size = (31, 23);
        let (map, raster) = fitted(&scene, &camera, size);
        let pictures: Vec<_> = engines.iter().map(|&engine| solve(&raster, engine)).collect();
        let positions = scene.mesh().positions();
        let triangles: Vec<[DVec3; 3]> =
            scene.triangles().iter().map(|t| t.map(|vertex| positions[vertex as usize])).collect();
        for at in 0..size.0 * size.1 {
            let center = DVec2::new(f64::from(at % size.0), f64::from(at / size.0)) + 0.5;
            let image = (center - map.origin) / map.scale;
            let sight_line = SightLine::new(&camera, DVec2::new(image.x, -image.y));
            let sure = sight_line.meets(&triangles);
            let expected = sure.unwrap_or_else(|()| sight_line.meets_exactly(&triangles));
            let expected = expected.map(|number| scene.triangle_faces()[number as usize]);
            judged += 1;
            by_rationals += u32::from(sure.is_err());
            for (engine, picture) in engines.iter().zip(&pictures) {
                let found = face(&scene, &raster, picture[at as usize]);
                assert!(
                    found == expected || sure.is_err(),
                    "seed {seed}, pixel {at}, {engine:?}: {found:?} instead of {expected:?}"
                );
                differing += u32::from(found != expected);
            }
        }
    }
    eprintln!("{judged} pixels, {by_rationals} by rationals; {differing} differ on borders");
    // On a border the pixel rule gives the pixel to one side, which the judge knows nothing of.
    assert!(differing * 50 < judged, "{differing} of {judged} pixels differ");
}
