//! How much of the image the lines of a lattice take up.

use glam::DVec3;
use rayon::prelude::*;

use crate::camera::Camera;
use crate::extent::Extent;

/// The extent of the lines between neighboring samples of a lattice with `n_columns` samples in each
/// of its rows; samples that are not finite are holes. O(samples), in parallel.
pub fn lattice_extent(
    n_columns: usize,
    n_samples: usize,
    sample: impl Fn(usize) -> DVec3 + Sync,
    camera: &Camera,
) -> Extent {
    let all = (0..n_samples).into_par_iter().map(&sample);
    Extent::of_points(all, camera).unwrap_or_else(|| {
        let mut points = Vec::new();
        let mut numbers = vec![u32::MAX; n_samples];
        for (k, number) in numbers.iter_mut().enumerate() {
            let point = sample(k);
            if point.is_finite() {
                *number = points.len() as u32;
                points.push(point);
            }
        }
        let mut segments = Vec::new();
        for k in 0..n_samples {
            let to_the_right = ((k + 1) % n_columns != 0).then_some(k + 1);
            for other in to_the_right.into_iter().chain([k + n_columns]) {
                let ends = [Some(numbers[k]), numbers.get(other).copied()];
                if let [Some(a), Some(b)] = ends.map(|end| end.filter(|&n| n != u32::MAX)) {
                    segments.push([a, b]);
                }
            }
        }
        Extent::new(&points, &[&segments], camera)
    })
}
