//! Floating horizon against the sentence that defines it.

use glam::{DVec3, dvec3};
use hiddenline::stages::camera::{Camera, Projection};
use hiddenline::stages::engines::surface::floating_horizon::{self, Family};
use hiddenline::stages::surface::Grid;

use super::brute;
use super::max_min::{Dice, PERSPECTIVE, camera, coordinate, intervals, rough};

fn check(grid: &Grid, camera: &Camera, name: &str) {
    let scale = 64.0;
    let (place, w) = match camera.projection() {
        Projection::Perspective { .. } => (camera.eye() * scale, 1),
        Projection::Orthographic => (-camera.forward() * scale, 0),
    };
    let eye = [place.x as i128, place.y as i128, place.z as i128, w];
    let n_x_edges = grid.ys().len() * (grid.xs().len() - 1);
    for family in [Family::AlongX, Family::AlongY] {
        let pieces = floating_horizon::solve(grid, camera, family).expect("a drawing");
        let all = intervals(&pieces);
        let (x_lines, y_lines) = all.split_at(n_x_edges);
        let (got, other) =
            if family == Family::AlongX { (x_lines, y_lines) } else { (y_lines, x_lines) };
        assert!(other.iter().all(Vec::is_empty));
        let truth = brute::one_family(grid, eye, scale, family == Family::AlongX);
        assert_eq!(got.len(), truth.len());
        for (edge, (got, expected)) in got.iter().zip(&truth).enumerate() {
            assert!(
                brute::difference(got, expected) < 1e-9,
                "{name}, {family:?}: edge {edge} of {grid:?}\nfrom {camera:?}\nis visible at {expected:?}, not {got:?}"
            );
        }
    }
}

#[test]
fn each_family_equals_its_definition_in_perspective_from_all_nine_regions() {
    let mut dice = Dice(23);
    for round in 0..360 {
        let (kind, region) = (round % 5, round / 5 % 9);
        let (nx, ny) = (2 + dice.roll(5) as usize, 2 + dice.roll(5) as usize);
        let grid = rough(&mut dice, kind, nx, ny);
        let eye = dvec3(
            coordinate(&mut dice, region % 3, grid.xs()),
            coordinate(&mut dice, region / 3, grid.ys()),
            (dice.roll(160) as f64 - 80.0) / 4.0,
        );
        check(
            &grid,
            &camera(eye, eye + dvec3(1.0, 2.0, -0.5), PERSPECTIVE),
            &format!("round {round}"),
        );
    }
}

#[test]
fn each_family_equals_its_definition_in_orthographic_views() {
    let mut dice = Dice(29);
    for round in 0..180 {
        let (nx, ny) = (2 + dice.roll(5) as usize, 2 + dice.roll(5) as usize);
        let grid = rough(&mut dice, round % 5, nx, ny);
        let component = |dice: &mut Dice| (dice.roll(9) as f64 - 4.0) / 2.0;
        let forward = dvec3(component(&mut dice), component(&mut dice), component(&mut dice));
        if forward.truncate() != glam::DVec2::ZERO {
            let camera = camera(DVec3::ZERO, forward, Projection::Orthographic);
            check(&grid, &camera, &format!("round {round}"));
        }
    }
}
