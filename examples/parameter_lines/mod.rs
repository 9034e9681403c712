//! A surface in space on a sheet of the usual size.

use glam::DVec3;
use hiddenline::stages::camera::framing::View;
use hiddenline::stages::plot::Plot;
use hiddenline::stages::surface::{LinedMesh, close_seams};

use super::lined_surface::{lined_plot, net};
use super::plots::Result;

/// A surface in space over all pairs of u and v, by each `every`-th line of
/// both parameters.
pub(crate) fn parametric_plot(
    title: &str,
    [us, vs]: [Vec<f64>; 2],
    every: usize,
    framing: View,
    point: impl Fn(f64, f64) -> DVec3,
) -> Result<Plot> {
    let mut points: Vec<DVec3> = vs
        .iter()
        .flat_map(|&v| us.iter().map(move |&u| (u, v)))
        .map(|(u, v)| point(u, v))
        .collect();
    close_seams(us.len(), &mut points);
    let mut mesh = LinedMesh::default();
    mesh.push_lattice(us.len(), &points, &net(every));
    lined_plot(title, mesh, framing)
}
