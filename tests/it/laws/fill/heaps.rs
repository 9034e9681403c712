//! Many faces in one place: what would take too long is refused or left to another engine, and deep
//! nesting does not depend on the stack.

use glam::{DVec2, DVec3};
use hiddenline::stages::camera::{Camera, Projection};
use hiddenline::stages::engines::face::{
    FaceEngine, FaceError, FaceOptions, FaceWork, Prepared, depth_sort, weiler_atherton,
};
use hiddenline::stages::engines::image::{PixelMap, painter};
use hiddenline::stages::model::mesh::{Mesh, PolygonSoup};
use hiddenline::stages::model::scene::Scene;

use crate::scenes::Rng;

fn scene(faces: &[Vec<DVec3>]) -> Scene {
    let mut soup = PolygonSoup::default();
    for face in faces {
        let first = soup.positions.len() as u32;
        soup.positions.extend(face);
        soup.push_face(&(first..first + face.len() as u32).collect::<Vec<_>>());
    }
    Scene::new(Mesh::new(soup).unwrap().0)
}

/// Large triangles that pierce each other.
fn heap(n: usize) -> Scene {
    let mut rng = Rng(7);
    let mut corner =
        || DVec3::new(rng.integer(-50, 50), rng.integer(-50, 50), rng.integer(-50, 50));
    scene(&(0..n).map(|_| vec![corner(), corner(), corner()]).collect::<Vec<_>>())
}

/// Planes over a square that touch the bowl z = x²: seen from above, each is the nearest along a strip.
fn tangents(n: u32) -> Scene {
    let strip = |k: u32| {
        let t = 2.0 * f64::from(k) / f64::from(n - 1) - 1.0;
        let z = |x: f64| t * (2.0 * x - t);
        [(-1.0, 0.0), (1.0, 0.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(x, y)| DVec3::new(x, y, z(x)))
            .to_vec()
    };
    scene(&(0..n).map(strip).collect::<Vec<_>>())
}

fn from_above() -> Camera {
    let eye = DVec3::new(0.0, 0.0, 9.0);
    Camera::new(eye, DVec3::ZERO, DVec3::Y, Projection::Orthographic).unwrap()
}

const COARSE: FaceOptions = FaceOptions {
    leaf: Some(0.5),
    subdivision: hiddenline::stages::engines::face::warnock::Subdivision::Regular,
};

#[test]
fn heaps_are_left_to_windows_and_other_engines_say_so_at_once() {
    let heap = heap(500);
    let free = Prepared::new(&heap, FaceEngine::Auto).unwrap();
    assert_eq!(free.engine(), FaceEngine::Warnock);
    assert!(matches!(
        Prepared::new(&heap, FaceEngine::Bsp).map(|_| ()),
        Err(FaceError::TooManyFragments(_))
    ));
    let sorted = Prepared::new(&heap, FaceEngine::DepthSort).unwrap();
    let error = sorted.solve(&from_above(), &COARSE).unwrap_err();
    assert!(matches!(error, FaceError::NoOrder(depth_sort::DepthSortError::TooManyPiercings(_))));
    assert_eq!(error.instead(), [FaceEngine::Warnock], "{error}");
    let map = PixelMap::fitting((DVec2::splat(-9.0), DVec2::splat(9.0)), (64, 64), 1.0);
    let painted = painter::raster(&heap, &from_above(), &map, (64, 64));
    assert!(matches!(painted, Err(painter::NoOrder)));
}

#[test]
fn planes_that_all_overlap_are_left_to_windows() {
    let planes = tangents(1500);
    let named = Prepared::new(&planes, FaceEngine::WeilerAtherton).unwrap();
    let error = named.solve(&from_above(), &COARSE).unwrap_err();
    assert!(matches!(error, FaceError::TooManyPairs { .. }), "{error}");
    let free = Prepared::new(&planes, FaceEngine::Auto).unwrap();
    let (painting, work) = free.solve(&from_above(), &COARSE).unwrap();
    assert!(matches!(work, FaceWork::Warnock(_)) && !painting.is_empty());
    assert_eq!(work.engine(), FaceEngine::Warnock);
}

#[test]
fn deeply_nested_clipping_needs_no_deep_stack() {
    const N: u32 = 150;
    let strips = std::thread::Builder::new()
        .stack_size(128 << 10)
        .spawn(|| weiler_atherton::solve(&tangents(N), &from_above()).unwrap().0)
        .unwrap()
        .join()
        .unwrap();
    // Each plane is seen between its crossings with its neighbors, half way to them.
    let mut areas = vec![0.0; N as usize];
    for piece in strips.pieces() {
        for ring in piece.rings() {
            let next = ring.points.iter().cycle().skip(1);
            let crosses = ring.points.iter().zip(next).map(|(p, q)| p.perp_dot(*q));
            areas[piece.face as usize] += crosses.sum::<f64>() / 2.0;
        }
    }
    let width = 2.0 / f64::from(N - 1);
    for (face, area) in (0..).zip(areas) {
        let expected = if face == 0 || face == N - 1 { width / 2.0 } else { width };
        assert!((area - expected).abs() < 1e-9, "{face}: {area}");
    }
}
