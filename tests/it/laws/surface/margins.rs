//! Ridges that reach as high as the one in front to within rounding, every bit of every number in use.
//!
//! ```text
//!   v ▲  r   r   r   r    seen along y, all ridges are one level line to within a few units in the
//!     │ ╱ ╲ ╱ ╲ ╱ ╲ ╱     last place; a ridge is visible where it is exactly at least as high as all
//!     │╱   ╲   ╲   ╲      before it
//!     └───────────────► y
//! ```

use glam::DVec3;
use hiddenline::stages::camera::Projection;
use hiddenline::stages::engines::surface::{CellOrder, max_min};
use hiddenline::stages::surface::Grid;

use super::max_min::{Dice, camera, intervals};
use crate::oracle::exact::{Int, scaled};

/// Samples across the view.
const COLUMNS: usize = 8;

/// Rows away from the eye: enough for the steps of horizons to be found before the last ridges.
const ROWS: usize = 62;

/// From here on every other row is a ridge, as is row 2.
const FIRST_RIDGE: usize = 50;

/// A number from 0 to 1 with all of its bits in use.
fn part(dice: &mut Dice) -> f64 {
    (dice.roll(1 << 26) as f64 + dice.roll(1 << 27) as f64 / 2f64.powi(27)) / 2f64.powi(26)
}

fn is_ridge(row: usize) -> bool {
    row == 2 || row >= FIRST_RIDGE && row.is_multiple_of(2)
}

/// `x` moved by some units in the last place.
fn moved(x: f64, units: i64) -> f64 {
    f64::from_bits((x.to_bits() as i64 + units) as u64)
}

/// How high a point is seen, exactly but for a factor.
fn height(p: DVec3, forward: DVec3) -> Int {
    let product = |a: f64, b: f64| scaled(a, -120) * scaled(b, -120);
    product(p.z, forward.y) - product(p.y, forward.z)
}

#[test]
fn ridges_of_nearly_one_height_are_told_apart() {
    let mut dice = Dice(18);
    let mut n_seen = [0; 2];
    for round in 0..150 {
        let up = if round % 2 == 0 { 1.0 } else { -1.0 };
        let forward = DVec3::new(0.0, 0.5 + part(&mut dice), -up * (0.4 + part(&mut dice)));
        let line = |dice: &mut Dice, n: usize, step: f64| -> Vec<f64> {
            (0..n).map(|k| step * (k as f64 + 0.3 * part(dice))).collect()
        };
        let (xs, ys) = (line(&mut dice, COLUMNS, 1.0), line(&mut dice, ROWS, 0.1));
        let level = 1.0 + part(&mut dice);
        let mut zs = Vec::new();
        for (row, y) in ys.iter().enumerate() {
            for _ in 0..COLUMNS {
                let v = if is_ridge(row) { level } else { -part(&mut dice) };
                let z = (up * v + y * forward.z) / forward.y;
                zs.push(if is_ridge(row) { moved(z, dice.roll(5) as i64 - 2) } else { z });
            }
        }
        let grid = Grid::new(xs, ys, zs).unwrap();
        let heights: Vec<Int> = (0..(COLUMNS * ROWS) as u32)
            .map(|sample| height(grid.point(sample), forward))
            .map(|height| if up < 0.0 { -height } else { height })
            .collect();
        let is_higher = |row: usize, sample: u32| {
            heights[row * COLUMNS + sample as usize % COLUMNS] > heights[sample as usize]
        };
        let camera = camera(DVec3::ZERO, forward, Projection::Orthographic);
        for order in [CellOrder::Rows, CellOrder::Diagonals] {
            let pieces = max_min::solve(&grid, &camera, order).unwrap();
            for (edge, found) in intervals(&pieces).iter().enumerate() {
                let ends @ [a, b] = grid.ends(edge as u32);
                let row = a as usize / COLUMNS;
                if row < FIRST_RIDGE || !is_ridge(row) || row != b as usize / COLUMNS {
                    continue;
                }
                let is_visible = (0..row).all(|before| !ends.iter().any(|&p| is_higher(before, p)));
                let is_hidden = (0..row).any(|before| ends.iter().all(|&p| is_higher(before, p)));
                // Others cross the ridges before them.
                if is_visible || is_hidden {
                    let expected = if is_visible { &[(0.0, 1.0)][..] } else { &[] };
                    assert_eq!(found, expected, "round {round}, {order:?}: edge {ends:?}");
                    n_seen[usize::from(is_visible)] += 1;
                }
            }
        }
    }
    eprintln!("{} edges hidden, {} visible", n_seen[0], n_seen[1]);
    assert!(n_seen.iter().all(|&n| n > 1000), "{n_seen:?}");
}
