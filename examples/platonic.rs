//! The five regular solids, their far edges dashed.

use glam::{DQuat, DVec3, dvec3};
use hiddenline::{DrawOptions, Error, HiddenLines, Paper, PolygonSoup, Scene, Sheet, View};

/// The golden ratio.
const PHI: f64 = 1.618_033_988_749_895;

/// All of these points with any of their coordinates' signs changed and their axes rotated.
fn corners(of: &[DVec3]) -> Vec<DVec3> {
    let mut all: Vec<DVec3> = Vec::new();
    for &p in of {
        for p in [p, dvec3(p.y, p.z, p.x), dvec3(p.z, p.x, p.y)] {
            for signs in 0..8 {
                let sign = |bit: u32| if signs >> bit & 1 == 0 { 1.0 } else { -1.0 };
                let q = p * dvec3(sign(0), sign(1), sign(2)) + DVec3::ZERO;
                if !all.contains(&q) {
                    all.push(q);
                }
            }
        }
    }
    all
}

/// Appends the solid whose faces look in the directions `faces`: the corners farthest that way.
/// It stands on its first face.
fn push_solid(soup: &mut PolygonSoup, corners: &[DVec3], faces: &[DVec3], x: f64) {
    let first = soup.positions.len() as u32;
    let down = DQuat::from_rotation_arc(faces[0].normalize(), DVec3::NEG_Z);
    let turned = |p: DVec3| DQuat::from_rotation_z(0.35) * (down * p) / corners[0].length();
    let lowest = corners.iter().map(|&p| turned(p).z).fold(f64::MAX, f64::min);
    let at = dvec3(x, 0.0, -lowest);
    soup.positions.extend(corners.iter().map(|&p| at + turned(p)));
    for &normal in faces {
        let farthest = corners.iter().map(|p| p.dot(normal)).fold(f64::MIN, f64::max);
        let mut ring: Vec<u32> = (0..corners.len() as u32)
            .filter(|&i| corners[i as usize].dot(normal) > 0.99 * farthest)
            .collect();
        let right = normal.cross(corners[ring[0] as usize]);
        let upward = normal.cross(right) / normal.length();
        let angle = |&i: &u32| {
            let p = corners[i as usize];
            libm::atan2(p.dot(upward), p.dot(right))
        };
        ring.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
        soup.push_face(&ring.iter().map(|i| first + i).collect::<Vec<_>>());
    }
}

fn solids() -> Result<Scene, Error> {
    let cube = corners(&[DVec3::ONE]);
    let octahedron = corners(&[DVec3::X]);
    let icosahedron = corners(&[dvec3(0.0, 1.0, PHI)]);
    let dodecahedron = corners(&[DVec3::ONE, dvec3(0.0, PHI, 1.0 / PHI)]);
    let half = |even: bool| -> Vec<DVec3> {
        cube.iter().copied().filter(|p| (p.x * p.y * p.z > 0.0) == even).collect()
    };
    let mut soup = PolygonSoup::default();
    let row = [
        (&half(true), &half(false)),
        (&cube, &octahedron),
        (&octahedron, &cube),
        (&dodecahedron, &icosahedron),
        (&icosahedron, &dodecahedron),
    ];
    for (i, (corners, faces)) in row.into_iter().enumerate() {
        push_solid(&mut soup, corners, faces, 2.3 * i as f64);
    }
    Scene::from_polygons(soup)
}

pub(crate) fn sheet() -> Result<Sheet, Error> {
    let view = View::from_angles(0.0, 20.0).distance(30.0);
    let lines = DrawOptions::default().hidden(HiddenLines::Dashed);
    let solids = solids()?;
    solids.draw(&view, &lines).title("The regular solids").on(Paper::new(297.0, 75.0))
}

fn main() -> Result<(), Error> {
    let sheet = sheet()?;
    sheet.save("plots/platonic.svg")?;
    sheet.save_png("plots/platonic.png", 1000)
}
