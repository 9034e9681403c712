//! A round temple: columns on steps under a dome, hatched by straight lines, with exact shadows.

use std::f64::consts::PI;

use glam::{DVec3, dvec3};
use hiddenline::{
    DrawOptions, Error, Ground, HatchLevels, HatchOptions, LightSource, PageOptions, Paper, Scene,
    Sheet, View,
};

/// Corners around a column, a step or the dome.
const SIDES: u32 = 48;

#[derive(Default)]
struct Temple {
    positions: Vec<DVec3>,
    faces: Vec<Vec<u32>>,
}

impl Temple {
    /// A solid of revolution about the vertical through `center`: rings given by radius and height from
    /// the bottom to the top, which are both closed.
    fn turn(&mut self, center: DVec3, profile: &[(f64, f64)], sides: u32) {
        let first = self.positions.len() as u32;
        for &(radius, height) in profile {
            for k in 0..sides {
                let angle = 2.0 * PI * (f64::from(k) + 0.5) / f64::from(sides);
                let around = dvec3(radius * angle.cos(), radius * angle.sin(), height);
                self.positions.push(center + around);
            }
        }
        let at = |ring: usize, k: u32| first + ring as u32 * sides + k % sides;
        let top = profile.len() - 1;
        self.faces.push((0..sides).rev().map(|k| at(0, k)).collect());
        self.faces.push((0..sides).map(|k| at(top, k)).collect());
        for ring in 0..top {
            for k in 0..sides {
                let quad = [at(ring, k), at(ring, k + 1), at(ring + 1, k + 1), at(ring + 1, k)];
                self.faces.push(quad.to_vec());
            }
        }
    }
}

fn temple() -> Result<Scene, Error> {
    let mut temple = Temple::default();
    for (radius, from, to) in [(6.2, 0.0, 0.35), (5.7, 0.35, 0.7), (5.2, 0.7, 1.05)] {
        temple.turn(DVec3::ZERO, &[(radius, from), (radius, to)], SIDES);
    }
    for k in 0..12 {
        let angle = 2.0 * PI * (f64::from(k) + 0.5) / 12.0;
        let foot = dvec3(4.4 * angle.cos(), 4.4 * angle.sin(), 1.05);
        let shaft = [
            (0.52, 0.0),
            (0.52, 0.15),
            (0.40, 0.25),
            (0.38, 1.8),
            (0.33, 3.9),
            (0.50, 4.1),
            (0.50, 4.3),
        ];
        temple.turn(foot, &shaft, 24);
    }
    temple.turn(DVec3::ZERO, &[(2.6, 1.05), (2.6, 5.35)], SIDES);
    let ring = [(5.1, 5.35), (5.1, 5.75), (5.25, 5.85), (5.25, 6.0), (4.6, 6.2)];
    temple.turn(DVec3::ZERO, &ring, SIDES);
    let dome: Vec<(f64, f64)> = (0..=14)
        .map(|k| {
            let angle = PI / 2.0 * f64::from(k) / 15.0;
            (4.2 * angle.cos(), 6.2 + 3.4 * angle.sin())
        })
        .collect();
    temple.turn(DVec3::ZERO, &dome, SIDES);
    temple.turn(dvec3(0.0, 0.0, 9.55), &[(0.5, 0.0), (0.5, 0.5), (0.05, 1.0)], 24);
    Scene::from_faces(&temple.positions, temple.faces)
}

pub(crate) fn sheet() -> Result<Sheet, Error> {
    let scene = temple()?;
    let hatch = HatchOptions::default()
        .straight()
        .light(LightSource::From(dvec3(-3.0, -2.2, 4.0)))
        .levels(HatchLevels::Steps(6))
        .ground(Ground::Lowest);
    let sheet = scene
        .draw(&View::from_angles(24.0, 16.0), &DrawOptions::default())
        .hatched(hatch)
        .title("Temple")
        .on(PageOptions::from(Paper::A4).landscape())?;
    Ok(sheet.optimized())
}

fn main() -> Result<(), Error> {
    let sheet = sheet()?;
    sheet.save("plots/hatch_temple.svg")?;
    sheet.save_png("plots/hatch_temple.png", 1000)
}
