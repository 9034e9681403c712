//! A city of boxes, seen from a helicopter.

use glam::{DVec3, dvec3};
use hiddenline::{DrawOptions, Error, PageOptions, PolygonSoup, Scene, Sheet, View};

const BLOCKS: i32 = 20;

/// The same number between 0 and 1 for the same seed, like no other's.
fn chance(seed: u64) -> f64 {
    let mut bits = seed.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((bits ^ bits >> 31) >> 11) as f64 / (1_u64 << 53) as f64
}

fn push_box(soup: &mut PolygonSoup, low: DVec3, high: DVec3) {
    let first = soup.positions.len() as u32;
    soup.positions.extend((0..8).map(|corner| {
        let pick = |bit: u32, low, high| if corner >> bit & 1 == 0 { low } else { high };
        dvec3(pick(0, low.x, high.x), pick(1, low.y, high.y), pick(2, low.z, high.z))
    }));
    for side in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    {
        soup.push_face(&side.map(|corner: u32| first + corner));
    }
}

/// Towers on a square grid with streets between them, the higher the nearer to the middle; each
/// tower is up to three boxes on top of each other.
fn city() -> Result<Scene, Error> {
    let mut soup = PolygonSoup::default();
    for x in -BLOCKS..BLOCKS {
        for y in -BLOCKS..BLOCKS {
            let seed = ((x + BLOCKS) * 2 * BLOCKS + y + BLOCKS) as u64 * 8;
            let middle = dvec3(f64::from(x) + 0.5, f64::from(y) + 0.5, 0.0);
            let nearness = libm::exp(-middle.length_squared() / 60.0);
            let mut half = dvec3(0.3 + 0.12 * chance(seed), 0.3 + 0.12 * chance(seed + 1), 0.0);
            let mut ground = 0.0;
            for storey in 2..5 {
                let height = 0.3 + (0.5 + 3.2 * nearness) * chance(seed + storey).powi(2);
                let low = middle - half + ground * DVec3::Z;
                push_box(&mut soup, low, middle + half + (ground + height) * DVec3::Z);
                if chance(seed + storey + 3) > 0.25 + 0.6 * nearness {
                    break;
                }
                ground += height;
                half *= 0.72;
            }
        }
    }
    Scene::from_polygons(soup)
}

pub(crate) fn sheet() -> Result<Sheet, Error> {
    let view = View::from_eye(dvec3(8.5, -13.5, 8.5)).target(dvec3(-0.5, 0.0, 1.5)).fov_deg(40.0);
    let city = city()?;
    let drawing = city.draw(&view, &DrawOptions::default()).title("A city");
    drawing.on(PageOptions::default().field_of_view())
}

fn main() -> Result<(), Error> {
    let sheet = sheet()?;
    sheet.save("plots/city.svg")?;
    sheet.save_png("plots/city.png", 1000)
}
