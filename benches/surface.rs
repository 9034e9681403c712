//! Function surfaces: sampling, visibility and chaining of the sinc hat, both families of lines.

use divan::Bencher;
use glam::{DVec3, dvec3};
use hiddenline::stages::camera::{Camera, Projection};
use hiddenline::stages::chain::grid_lines::{GridLines, strokes};
use hiddenline::stages::engines::surface::{CellOrder, max_min};
use hiddenline::stages::surface::formula::{Formula, Variables};
use hiddenline::stages::surface::{CutGrid, Grid, GridCuts};

const SIZES: [usize; 4] = [150, 500, 1000, 2000];

fn main() {
    divan::main();
}

fn sinc_hat(n: usize) -> Grid {
    let formula = Formula::parse("sinc(r)", Variables::Plane).expect("a formula");
    let mut grid = Grid::sample(&formula, (-12.0, 12.0), (-12.0, 12.0), (n, n)).expect("a grid");
    grid.scale_heights(8.0);
    grid
}

fn camera() -> Camera {
    let projection = Projection::Perspective { fov_deg: 30.0, near: 1e-6 };
    Camera::new(dvec3(30.0, -45.0, 30.0), DVec3::ZERO, DVec3::Z, projection).expect("a camera")
}

#[divan::bench(args = SIZES, sample_count = 5)]
fn sampling(n: usize) -> Grid {
    sinc_hat(n)
}

#[divan::bench(args = SIZES, sample_count = 5)]
fn visibility(bencher: Bencher, n: usize) {
    let (grid, camera) = (sinc_hat(n), camera());
    bencher.bench(|| max_min::solve(&grid, &camera, CellOrder::Rows));
}

#[divan::bench(args = SIZES, sample_count = 5)]
fn chaining(bencher: Bencher, n: usize) {
    let (grid, camera) = (sinc_hat(n), camera());
    let pieces = max_min::solve(&grid, &camera, CellOrder::Rows).expect("a drawing");
    bencher.bench(|| {
        strokes(
            &CutGrid { grid: &grid, cuts: &GridCuts::NONE },
            &pieces,
            &camera,
            &GridLines::default(),
        )
    });
}
