//! Joining and ordering, on drawings like those plotters get.

use divan::Bencher;
use glam::{DVec2, dvec2};
use hiddenline::stages::optimize::{Effort, OptimizeOptions, optimize_lines, order};
use hiddenline::stages::plot::Polylines;

fn main() {
    divan::main();
}

/// Short strokes along a smooth field of directions on A4: nothing to join.
fn hatch(n: usize) -> Polylines {
    let mut state = 1u64;
    let mut random = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 40) as f64 / (1u64 << 24) as f64
    };
    let mut lines = Polylines::default();
    for _ in 0..n {
        let center = dvec2(20.0 + 257.0 * random(), 20.0 + 170.0 * random());
        let angle = 1.5 * (center.x / 40.0).sin() + 1.2 * (center.y / 33.0).cos();
        let half = DVec2::from_angle(angle) * (0.5 + 1.5 * random());
        lines.push([center - half, center + half]);
    }
    lines
}

/// The faces of a bent net of about `n` edges, each with its whole outline, inner edges twice.
fn net(n: usize) -> Polylines {
    let side = (n as f64 / 4.0).sqrt() as usize;
    let step = 170.0 / side as f64;
    let place = |i: usize, j: usize| {
        let (x, y) = (20.0 + i as f64 * step, 20.0 + j as f64 * step);
        dvec2(x + 5.0 * (y / 17.0).sin(), y + 4.0 * (x / 23.0).cos())
    };
    let mut lines = Polylines::default();
    for i in 0..side {
        for j in 0..side {
            let corners =
                [place(i, j), place(i + 1, j), place(i + 1, j + 1), place(i, j + 1), place(i, j)];
            for pair in corners.windows(2) {
                lines.push([pair[0], pair[1]]);
            }
        }
    }
    lines
}

#[divan::bench(args = [2_000, 20_000, 200_000], max_time = 10)]
fn join_net(bencher: Bencher<'_, '_>, n: usize) {
    let lines = net(n);
    let options = OptimizeOptions { effort: Effort::None, ..OptimizeOptions::default() };
    bencher.bench_local(|| optimize_lines(&lines, None, &options));
}

#[divan::bench(args = [2_000, 20_000, 200_000], max_time = 10)]
fn order_hatch_fast(bencher: Bencher<'_, '_>, n: usize) {
    let lines = hatch(n);
    bencher.bench_local(|| order(&lines, Effort::Fast));
}
