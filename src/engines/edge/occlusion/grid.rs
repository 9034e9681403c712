//! Cells over the image, and the depth behind which each is covered.

use super::super::occluders::Occluders;
use super::super::rounding::{Rounding, rounded_down, rounded_up};
use super::super::sides::Sides;
use crate::camera::ImagePoint;
use crate::classify::ViewedScene;
use crate::predicates::{Sign, Viewpoint};
use glam::{DVec2, dvec2};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// Fewest and most cells along the longer side of the image.
const CELLS: std::ops::RangeInclusive<u32> = 16..=512;

/// A cell has about this many triangles. Smaller cells cost more than they cull.
const TRIANGLES_PER_CELL: usize = 16;

/// No point of the image is further than this from its spot, in cells.
const SPOT_ERROR: f64 = 1.0 / (1 << 11) as f64;

/// By how much boxes and cells are enlarged, in cells: more than twice the error.
const MARGIN: f64 = 1.0 / (1 << 9) as f64;

/// Images are too uncertain for cells when a coordinate may be off by more than this, in cells. What
/// rounding spots to single precision adds is less, since there are no more than 2⁹ cells in a row.
const MOST_IMAGE_ERROR: f64 = 1.0 / (1 << 12) as f64;

/// The sample point of a cell, near its middle; off it, since sides of regular meshes often run through
/// cells.
const SAMPLE: [f64; 2] = [0.4619, 0.5391];

/// Triangles over more sample points than this are taken one by one, nearest first, until
/// [`MOST_SAMPLES`] are looked at in all.
const MANY_SAMPLES: u64 = 64;

/// See [`MANY_SAMPLES`].
const MOST_SAMPLES: u64 = 1 << 22;

/// A cell that this many triangles do not cover is not covered.
const MOST_TRIANGLES: usize = 96;

/// A point of the image in units of cells, and its depth rounded both ways.
#[derive(Debug, Clone, Copy)]
struct Spot {
    x: f32,
    y: f32,
    nearest: f32,
    farthest: f32,
}

impl Spot {
    fn at(self) -> DVec2 {
        dvec2(f64::from(self.x), f64::from(self.y))
    }
}

/// Square cells over the images of all points.
pub(super) struct Grid {
    columns: u32,
    rows: u32,
    spots: Vec<Spot>,
}

/// The cells that something may touch: first and last column, first and last row.
#[derive(Debug, Clone, Copy)]
struct Block {
    columns: [u32; 2],
    rows: [u32; 2],
}

/// For each cell the depth behind which it is covered, then the largest of each block of 2 × 2 cells,
/// and so on.
pub(super) struct Pyramid {
    levels: Vec<Level>,
}

struct Level {
    columns: u32,
    rows: u32,
    depths: Vec<f32>,
}

impl Grid {
    /// Cells over the image; `None` when it has no size or is too uncertain.
    pub(super) fn over(view: &ViewedScene, rounding: &Rounding) -> Option<Self> {
        let image = view.image();
        let chunks = image.par_chunks(1 << 12).map(|points| {
            points.iter().fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[low, high], point| {
                [low.min(point.image()), high.max(point.image())]
            })
        });
        let [low, high] = chunks.reduce(
            || [DVec2::INFINITY, DVec2::NEG_INFINITY],
            |a, b| [a[0].min(b[0]), a[1].max(b[1])],
        );
        let n_cells = (view.scene().triangles().len() / TRIANGLES_PER_CELL).isqrt();
        let n_cells = (n_cells as u32).clamp(*CELLS.start(), *CELLS.end());
        let scale = f64::from(n_cells) / (high - low).max_element();
        let error = scale * rounding.image_error(low.abs().max(high.abs()).element_sum());
        // False where anything is not a number.
        if !(scale > 0.0 && scale.is_finite() && error <= MOST_IMAGE_ERROR) {
            return None;
        }
        let depth_error = rounding.depth_error();
        let spot = |point: &ImagePoint| {
            let at = (point.image() - low) * scale;
            Spot {
                x: at.x as f32,
                y: at.y as f32,
                nearest: rounded_down(point.depth - depth_error),
                farthest: rounded_up(point.depth + depth_error),
            }
        };
        let n_along = |size: f64| ((size * scale) as u32 + 1).min(n_cells);
        Some(Self {
            columns: n_along(high.x - low.x),
            rows: n_along(high.y - low.y),
            spots: image.par_iter().map(spot).collect(),
        })
    }

    fn spots_of<const N: usize>(&self, points: [u32; N]) -> [Spot; N] {
        points.map(|point| self.spots[point as usize])
    }

    /// For each cell the triangle over its sample point whose deepest point is nearest, if there is any.
    pub(super) fn samples(&self, view: &ViewedScene, occluders: &Occluders) -> Vec<Option<u32>> {
        const NONE: u64 = u64::MAX;
        let n_cells = (self.columns * self.rows) as usize;
        let samples: Vec<AtomicU64> = (0..n_cells).map(|_| AtomicU64::new(NONE)).collect();
        let triangles = view.scene().triangles();
        let sample = |triangle: u32, spots: &[Spot; 3], cells: Block| {
            let key = u64::from(ordered(farthest(spots))) << 32 | u64::from(triangle);
            for row in cells.rows[0]..cells.rows[1] {
                for column in cells.columns[0]..cells.columns[1] {
                    let cell = &samples[(row * self.columns + column) as usize];
                    // The smallest key wins, in whatever order they come.
                    if key < cell.load(Relaxed)
                        && holds(spots, DVec2::from(SAMPLE) + dvec2(column.into(), row.into()))
                    {
                        cell.fetch_min(key, Relaxed);
                    }
                }
            }
        };
        let is_large = |&triangle: &u32| {
            let spots = self.spots_of(triangles[triangle as usize]);
            let cells = self.sampled(&spots);
            let n = cells.n();
            if 0 < n && n <= MANY_SAMPLES {
                sample(triangle, &spots, cells);
            }
            n > MANY_SAMPLES
        };
        let large = occluders.list().par_iter().with_min_len(4096).copied().filter(is_large);
        let mut large: Vec<(u32, u32)> = large
            .map(|triangle| {
                let spots = self.spots_of(triangles[triangle as usize]);
                (ordered(farthest(&spots)), triangle)
            })
            .collect();
        large.par_sort_unstable();
        let mut n_left = MOST_SAMPLES;
        let n_taken = large.iter().take_while(|&&(_, triangle)| {
            let n = self.sampled(&self.spots_of(triangles[triangle as usize])).n();
            n_left = n_left.saturating_sub(n);
            n_left > 0
        });
        let n_taken = n_taken.count();
        large[..n_taken].par_iter().for_each(|&(_, triangle)| {
            let spots = self.spots_of(triangles[triangle as usize]);
            sample(triangle, &spots, self.sampled(&spots));
        });
        let found = |key: AtomicU64| match key.into_inner() {
            NONE => None,
            key => Some(key as u32),
        };
        samples.into_iter().map(found).collect()
    }

    /// The cells whose sample points may lie in the box of a triangle; last column and row excluded.
    fn sampled(&self, spots: &[Spot; 3]) -> Block {
        let range = |x: [f32; 3], at: f64, n: u32| {
            // To single precision it is as far off as a spot may be, where nothing is certain.
            let at = at as f32;
            let low = x[0].min(x[1]).min(x[2]);
            let high = x[0].max(x[1]).max(x[2]);
            [(low - at).ceil().max(0.0) as u32, ((high - at + 1.0).max(0.0) as u32).min(n)]
        };
        Block {
            columns: range(spots.map(|spot| spot.x), SAMPLE[0], self.columns),
            rows: range(spots.map(|spot| spot.y), SAMPLE[1], self.rows),
        }
    }

    /// For each cell a depth behind which it is covered; infinite where none is known.
    ///
    /// Behind it, nothing is within the contact tolerance of the triangles that cover the cell.
    pub(super) fn covered_from(
        &self,
        view: &ViewedScene,
        sides: &Sides,
        occluders: &Occluders,
        samples: &[Option<u32>],
        contact_tolerance: f64,
    ) -> Vec<f32> {
        let patches = Patches { grid: self, view, sides, occluders, contact_tolerance };
        let cells = samples.par_iter().enumerate().with_min_len(64);
        cells
            .map_init(Vec::new, |patch, (cell, &first)| {
                first.map_or(f32::INFINITY, |first| patches.covers_from(cell as u32, first, patch))
            })
            .collect()
    }

    /// The pyramid over the depths of all cells.
    pub(super) fn pyramid(&self, depths: Vec<f32>) -> Pyramid {
        let mut levels = vec![Level { columns: self.columns, rows: self.rows, depths }];
        while let Some(fine) = levels.last()
            && (fine.columns > 1 || fine.rows > 1)
        {
            let (columns, rows) = (fine.columns.div_ceil(2), fine.rows.div_ceil(2));
            let mut depths = vec![f32::NEG_INFINITY; (columns * rows) as usize];
            for row in 0..fine.rows {
                for column in 0..fine.columns {
                    let whole = &mut depths[(row / 2 * columns + column / 2) as usize];
                    *whole = whole.max(fine.depths[(row * fine.columns + column) as usize]);
                }
            }
            levels.push(Level { columns, rows, depths });
        }
        Pyramid { levels }
    }

    /// Whether some of a line or triangle may lie before the depths of the cells it touches.
    pub(super) fn may_show<const N: usize>(&self, pyramid: &Pyramid, points: [u32; N]) -> bool {
        let spots = self.spots_of(points);
        let nearest = spots.iter().fold(f32::INFINITY, |near, spot| near.min(spot.nearest));
        let range = |x: [f32; N], n: u32| {
            let (low, high) = (x.into_iter().reduce(f32::min), x.into_iter().reduce(f32::max));
            let cell = |x: Option<f32>, margin: f64| {
                ((f64::from(x.unwrap_or_default()) + margin).max(0.0) as u32).min(n - 1)
            };
            [cell(low, -MARGIN), cell(high, MARGIN)]
        };
        let columns = range(spots.map(|spot| spot.x), self.columns);
        let rows = range(spots.map(|spot| spot.y), self.rows);
        nearest <= pyramid.deepest(Block { columns, rows })
    }
}

impl Block {
    /// Number of cells, when the last column and row are excluded.
    fn n(&self) -> u64 {
        let n = |[first, last]: [u32; 2]| u64::from(last.saturating_sub(first));
        n(self.columns) * n(self.rows)
    }
}

impl Pyramid {
    /// The largest depth in a block of cells, or in a larger one.
    fn deepest(&self, block: Block) -> f32 {
        let Block { mut columns, mut rows } = block;
        let mut levels = self.levels.iter();
        let mut level = levels.next();
        while columns[1] - columns[0] > 2 || rows[1] - rows[0] > 2 {
            columns = columns.map(|column| column / 2);
            rows = rows.map(|row| row / 2);
            level = levels.next();
        }
        let Some(level) = level else { return f32::INFINITY };
        let mut deepest = f32::NEG_INFINITY;
        for row in rows[0]..=rows[1] {
            let first = row * level.columns;
            for column in columns[0]..=columns[1] {
                deepest = deepest.max(level.depths[(first + column) as usize]);
            }
        }
        deepest
    }
}

/// What is needed to cover cells by triangles.
struct Patches<'p, 'a> {
    grid: &'p Grid,
    view: &'p ViewedScene<'a>,
    sides: &'p Sides<'a>,
    occluders: &'p Occluders,
    contact_tolerance: f64,
}

impl Patches<'_, '_> {
    /// The depth behind which a cell is covered by the triangle `first` over its sample point and those
    /// around it; infinite when they leave it open. `patch` is work space.
    fn covers_from(&self, cell: u32, first: u32, patch: &mut Vec<u32>) -> f32 {
        let corner =
            dvec2(f64::from(cell % self.grid.columns), f64::from(cell / self.grid.columns));
        let middle = corner + 0.5;
        patch.clear();
        patch.push(first);
        let (mut next, mut depth) = (0, f32::NEG_INFINITY);
        while let Some(&triangle) = patch.get(next) {
            next += 1;
            let corners = self.view.scene().triangles()[triangle as usize];
            let spots = self.grid.spots_of(corners);
            depth = depth.max(self.depth_in_contact(corners, &spots));
            for side in 0..3 {
                let other = (side + 1) % 3;
                if comes_near(middle, spots[side].at(), spots[other].at())
                    && !self.add_along([corners[side], corners[other]], patch)
                {
                    return f32::INFINITY;
                }
            }
        }
        depth
    }

    /// Adds the triangles along a side to `patch`; false when there are more of them on the one side of
    /// it than on the other, or too many in all.
    fn add_along(&self, [p, q]: [u32; 2], patch: &mut Vec<u32>) -> bool {
        let Some(side) = self.sides.find(p, q) else { return false };
        let mut balance = 0;
        for (triangle, upwards) in self.sides.along(side) {
            if !self.occluders.contains(triangle) {
                continue;
            }
            let turn = self.view.triangle_turns()[triangle as usize];
            balance += if (turn == Sign::Positive) == upwards { 1 } else { -1 };
            if !patch.contains(&triangle) {
                if patch.len() == MOST_TRIANGLES {
                    return false;
                }
                patch.push(triangle);
            }
        }
        balance == 0
    }

    /// No point of a triangle, nor any in contact with it, is deeper than this.
    fn depth_in_contact(&self, corners: [u32; 3], spots: &[Spot; 3]) -> f32 {
        let farthest = farthest(spots);
        if self.contact_tolerance == 0.0 {
            return farthest;
        }
        let sight = self.view.sight();
        let reach = sight.contact_reach(corners, self.contact_tolerance);
        if reach.is_infinite() {
            return f32::INFINITY;
        }
        let length = match sight.viewpoint() {
            Viewpoint::Eye(_) => f64::from(farthest),
            Viewpoint::Direction(forward) => forward.length(),
        };
        rounded_up(f64::from(farthest) + reach * length)
    }
}

/// The depth of the deepest spot.
fn farthest(spots: &[Spot; 3]) -> f32 {
    spots.iter().fold(f32::NEG_INFINITY, |far, spot| far.max(spot.farthest))
}

/// A number that grows as `x` does.
fn ordered(x: f32) -> u32 {
    let bits = x.to_bits();
    if bits >> 31 == 1 { !bits } else { bits | 1 << 31 }
}

/// Whether a point certainly lies in a triangle's image.
fn holds(spots: &[Spot; 3], point: DVec2) -> bool {
    let offsets = spots.map(|spot| spot.at() - point);
    let reach = offsets.iter().fold(DVec2::ZERO, |reach, d| reach.max(d.abs()));
    // Each factor of an area is off by one error at most.
    let slack = 4.0 * SPOT_ERROR * (reach.element_sum() + SPOT_ERROR);
    let areas = [0, 1, 2].map(|i| offsets[i].perp_dot(offsets[(i + 1) % 3]));
    areas.iter().all(|&area| area > slack) || areas.iter().all(|&area| area < -slack)
}

/// Whether a line between two points may come near the cell around `middle`.
fn comes_near(middle: DVec2, a: DVec2, b: DVec2) -> bool {
    const HALF: f64 = 0.5 + MARGIN;
    let (low, high) = (middle - HALF, middle + HALF);
    if a.max(b).cmplt(low).any() || a.min(b).cmpgt(high).any() {
        return false;
    }
    // Beside the line lie all four corners, on one side. The margin is much larger than what rounding
    // does to these products.
    let along = b - a;
    along.perp_dot(middle - a).abs() <= HALF * along.abs().element_sum()
}
