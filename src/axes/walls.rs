//! Lines on the faces behind a surface: grids, edges, and the rectangle that the box stands on.
//!
//! ```text
//!      ┌─┬─┬─┬─┐
//!     ╱├─┼─┼─┼─┤      They are behind all that is in the box, so that the surface may hide them. They
//!    ╱╱├─┴─┴─┴─┤      hide nothing.
//!   ╱╱╱ ╱ ╱ ╱ ╱
//! ```

use glam::DVec3;

use super::bounding_box::{BoundingBox, BoxEdge, EdgePlace};
use super::ticks::Ticks;
use crate::strokes::StrokeKind;
use crate::surface::AxisScale;

/// A line in space that the surface may hide.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wire {
    /// Its ends, in the coordinates of the drawn surface.
    pub ends: [DVec3; 2],
    /// Why it is drawn.
    pub kind: StrokeKind,
}

/// The grid on the faces behind the surface, at the numbers of the axes, and the edges between these
/// faces.
pub(super) fn grid(
    bbox: &BoundingBox,
    ticks: &[Option<Ticks>; 3],
    scales: &[AxisScale; 3],
) -> Vec<Wire> {
    let mut wires = Vec::new();
    for axis in 0..3 {
        for is_high in [false, true] {
            if !bbox.is_wall(axis, is_high) || bbox.low[axis] >= bbox.high[axis] {
                continue;
            }
            for (across, along) in
                [((axis + 1) % 3, (axis + 2) % 3), ((axis + 2) % 3, (axis + 1) % 3)]
            {
                let Some(ticks) = &ticks[across] else { continue };
                for (value, _) in &ticks.majors {
                    // At the very ends there are edges.
                    if !(ticks.range.0 < *value && *value < ticks.range.1) {
                        continue;
                    }
                    let at = scales[across].drawn(*value);
                    let end = |is_high_along: bool| {
                        let mut p = DVec3::ZERO;
                        p[axis] = bbox.side(axis, is_high);
                        p[across] = at;
                        p[along] = bbox.side(along, is_high_along);
                        p
                    };
                    let ends = [end(false), end(true)];
                    wires.push(Wire { ends, kind: StrokeKind::Back });
                }
            }
        }
    }
    wires
}

/// Edges of the box as wires.
pub(super) fn edges(
    bbox: &BoundingBox,
    kind: StrokeKind,
    is_wanted: impl Fn(&BoxEdge) -> bool,
) -> Vec<Wire> {
    let edges = (0..3).flat_map(|axis| bbox.edges(axis)).filter(is_wanted);
    edges.map(|edge| Wire { ends: bbox.ends(&edge), kind }).collect()
}

/// Whether an edge is between two faces behind the surface.
pub(super) fn is_between_walls(bbox: &BoundingBox, edge: &BoxEdge) -> bool {
    let is_wall = |k: usize| {
        let axis = (edge.axis + k) % 3;
        bbox.is_wall(axis, edge.sides[axis])
    };
    bbox.place(edge) == EdgePlace::Back && is_wall(1) && is_wall(2)
}

/// Whether an edge is behind the surface: it borders a wall, and both of its faces are seen from inside. If
/// the eye is between two opposite faces, the nearer one is not a wall, but borders others.
pub(super) fn is_behind(bbox: &BoundingBox, edge: &BoxEdge) -> bool {
    bbox.place(edge) == EdgePlace::Back && is_beside_wall(bbox, edge)
}

/// Whether an edge borders a face behind the surface.
pub(super) fn is_beside_wall(bbox: &BoundingBox, edge: &BoxEdge) -> bool {
    [1, 2].iter().any(|k| {
        let axis = (edge.axis + k) % 3;
        bbox.is_wall(axis, edge.sides[axis])
    })
}
