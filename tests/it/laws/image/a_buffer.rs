//! Shares of pixels: coverage as counted in a finer picture, transparency as computed by hand.

use super::{built, fitted};
use crate::scenes::{number_of_scenes, random};
use glam::DVec3;
use hiddenline::stages::engines::image::a_buffer::{SIDE, Share, solve as resolve};
use hiddenline::stages::engines::image::{ImageEngine, NOTHING, Raster, solve};
use std::collections::BTreeMap;

/// The shares in each pixel.
fn shares(fine: &Raster, opacity: f64) -> Vec<Vec<Share>> {
    let mut pixels = Vec::new();
    for strip in 0..fine.n_strips() {
        resolve(fine, &fine.strip(strip), opacity, |shares| pixels.push(shares.to_vec()));
    }
    pixels
}

#[test]
fn opaque_shares_are_those_of_sixteen_samples() {
    let mut partly = 0;
    for seed in 0..number_of_scenes(150) {
        let (scene, camera) = built(&random(seed));
        let (map, _) = fitted(&scene, &camera, (31, 23));
        let fine = Raster::new(&scene, &camera, &map.finer(SIDE), (31 * SIDE, 23 * SIDE));
        let samples = solve(&fine, ImageEngine::ZBuffer);
        let pixels = shares(&fine, 1.0);
        assert_eq!(pixels.len(), 31 * 23);
        for (at, pixel) in (0..).zip(&pixels) {
            let mut counted = BTreeMap::new();
            let (column, row) = (at % 31, at / 31);
            for k in 0..SIDE * SIDE {
                let (x, y) = (column * SIDE + k % SIDE, row * SIDE + k / SIDE);
                let item = samples[(y * fine.width() + x) as usize];
                if item != NOTHING {
                    *counted.entry(item).or_insert(0) += 1;
                }
            }
            let mut found = BTreeMap::new();
            for share in pixel {
                *found.entry(share.triangle).or_insert(0.0) += share.weight * 16.0;
            }
            let found: BTreeMap<u32, u32> =
                found.into_iter().map(|(item, n): (u32, f64)| (item, n.round() as u32)).collect();
            assert_eq!(found, counted, "seed {seed}, pixel {at}");
            partly += u32::from(counted.len() > 1);
        }
    }
    assert!(partly > 1000, "only {partly} pixels show more than one triangle");
}

/// Squares that cover the picture, one behind the other, of two triangles each.
fn layers(n: u32, tilt: f64) -> Raster {
    // Two by two pixels of four by four samples.
    let size = (2 * SIDE, 2 * SIDE);
    let triangles: Vec<_> = (0..n)
        .flat_map(|k| {
            let near = 10.0 - f64::from(k);
            let corner = |x: f64, y: f64| DVec3::new(x, y, near + tilt * x);
            let [a, b, c, d] =
                [corner(0.0, 0.0), corner(8.0, 0.0), corner(8.0, 8.0), corner(0.0, 8.0)];
            [([a, b, c], 2 * k), ([a, c, d], 2 * k + 1)]
        })
        .collect();
    Raster::of_triangles(&triangles, size)
}

#[test]
fn transparent_layers_follow_the_closed_form() {
    for opacity in [0.25, 0.3, 0.5, 0.9] {
        for n in [2, 3] {
            // Steep layers begin before others end, which takes the way sample by sample.
            for tilt in [0.0, 1.0, 50.0] {
                for pixel in shares(&layers(n, tilt), opacity) {
                    for k in 0..n {
                        let of_layer = pixel.iter().filter(|share| share.triangle / 2 == k);
                        let found: f64 = of_layer.map(|share| share.weight).sum();
                        let expected = opacity * (1.0 - opacity).powi(k as i32);
                        assert!((found - expected).abs() < 1e-12, "{n}, {k}: {found}, {expected}");
                    }
                }
            }
        }
    }
}

#[test]
fn crossing_layers_change_places_where_they_cross() {
    let square = |slope: f64, number| {
        let at = |x: f64, y: f64| DVec3::new(x, y, 10.0 + slope * (x - 2.0));
        [
            ([at(0.0, 0.0), at(4.0, 0.0), at(4.0, 4.0)], number),
            ([at(0.0, 0.0), at(4.0, 4.0), at(0.0, 4.0)], number),
        ]
    };
    let triangles = [square(1.0, 0), square(-1.0, 1)].concat();
    // They cross in the middle of the only pixel.
    let fine = Raster::of_triangles(&triangles, (4, 4));
    let pixel = &shares(&fine, 0.5)[0];
    let found: f64 = pixel.iter().filter(|s| s.triangle < 2).map(|s| s.weight).sum();
    // In each half one of them is in front: ½ · ½ + ½ · ¼.
    assert!((found - 0.375).abs() < 1e-12, "{found}");
}
