//! Signs that a model differs from what its author meant: worth a hint, never a change.

use glam::DVec3;
use rayon::prelude::*;

use crate::model::mesh::Mesh;
use crate::model::topology::Topology;
use crate::model::triangulate::newell_normal;

/// From this share of edges with one face on, a mesh seems to lack shared vertices.
const OPEN_SHARE: f64 = 0.3;

/// Vertices whose nearest neighbors are looked for.
const SAMPLES: usize = 64;

/// Whether a model seems to be made with y up rather than z.
///
/// Three signs count; at least one must say y, and none z:
///
/// 1. It is an open surface that looks up or down along one axis everywhere, as terrain does.
/// 2. It has a base: faces that look down, at the very bottom.
/// 3. It starts at zero along one axis, and extends to both sides of zero along the other.
///
/// O(faces).
pub fn seems_y_up(mesh: &Mesh) -> bool {
    let [y, z] = [1, 2].map(|axis| (axis, 3 - axis));
    let signs = [is_height_field, has_base, stands_on_zero];
    let facts = Facts::new(mesh);
    let says = |(axis, other): (usize, usize)| signs.iter().any(|sign| sign(&facts, axis, other));
    says(y) && !says(z)
}

/// The measurements behind the signs.
struct Facts {
    low: DVec3,
    extent: DVec3,
    is_open: bool,
    /// Area of all faces.
    area: f64,
    /// For each axis the area of faces that look up along it, and of those that look down.
    up: DVec3,
    down: DVec3,
    /// For each axis the area of faces that look straight down at the very bottom.
    base: DVec3,
}

impl Facts {
    fn new(mesh: &Mesh) -> Self {
        const SLANTED: f64 = 0.1;
        const LEVEL: f64 = -0.97;
        const BOTTOM: f64 = 0.02;
        let (low, high) = mesh.bounds().unwrap_or_default();
        let extent = high - low;
        let mut facts = Self {
            low,
            extent,
            is_open: Topology::new(mesh).count_edges().boundary > 0,
            area: 0.0,
            up: DVec3::ZERO,
            down: DVec3::ZERO,
            base: DVec3::ZERO,
        };
        for face in 0..mesh.n_faces() as u32 {
            let corners = mesh.face(face);
            let normal = newell_normal(mesh.positions(), corners);
            let area = normal.length() / 2.0;
            if !(area > 0.0 && area.is_finite()) {
                continue;
            }
            let normal = normal.normalize_or_zero();
            facts.area += area;
            for axis in 0..3 {
                facts.up[axis] += if normal[axis] > SLANTED { area } else { 0.0 };
                facts.down[axis] += if normal[axis] < -SLANTED { area } else { 0.0 };
                let limit = low[axis] + BOTTOM * extent[axis];
                let is_bottom =
                    || corners.iter().all(|&v| mesh.positions()[v as usize][axis] <= limit);
                if normal[axis] < LEVEL && is_bottom() {
                    facts.base[axis] += area;
                }
            }
        }
        facts
    }

    /// The base along an axis as a share of the box seen along it.
    fn base_share(&self, axis: usize) -> f64 {
        let section = self.extent[(axis + 1) % 3] * self.extent[(axis + 2) % 3];
        if section > 0.0 { self.base[axis] / section } else { 0.0 }
    }

    /// Whether nearly all area looks to one side of an axis.
    fn looks_along(&self, axis: usize) -> bool {
        self.up[axis].max(self.down[axis]) >= 0.99 * self.area && self.area > 0.0
    }
}

fn is_height_field(facts: &Facts, axis: usize, _: usize) -> bool {
    facts.is_open && (0..3).all(|other| facts.looks_along(other) == (other == axis))
}

fn has_base(facts: &Facts, axis: usize, other: usize) -> bool {
    let share = facts.base_share(axis);
    share >= 0.05 && share >= 5.0 * facts.base_share(other).max(0.01)
}

fn stands_on_zero(facts: &Facts, axis: usize, other: usize) -> bool {
    let stands = facts.low[axis].abs() <= 0.01 * facts.extent[axis];
    let below = facts.low[other] / facts.extent[other];
    stands && facts.extent[axis] > 0.0 && (-0.9..=-0.1).contains(&below)
}

/// A mesh whose faces mostly share no vertices, and the distance within which they nearly do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OpenSeams {
    /// Edges with one face.
    pub n_open: usize,
    /// All edges.
    pub n_edges: usize,
    /// Merging vertices closer than this, in model units, closes at least half of the open edges and
    /// makes hardly any face vanish. One, two or five times a power of ten.
    pub distance: f64,
}

/// Looks for vertices that are nearly but not quite common to several faces, as in files that list
/// each triangle by itself with rounded coordinates.
///
/// The distance is tried before it is returned. O(vertices) for meshes with few open edges; a merge of
/// vertices for others.
pub fn open_seams(mesh: &Mesh) -> Option<OpenSeams> {
    let topology = Topology::new(mesh);
    let n_edges = topology.edges().len();
    let n_open = topology.count_edges().boundary;
    if mesh.n_faces() < 4 || (n_open as f64) < OPEN_SHARE * n_edges as f64 {
        return None;
    }
    let distance = round_up(2.0 * typical_gap(mesh, &topology)?)?;
    let (welded, repairs) = mesh.clone().weld(distance).ok()?;
    let n_left = Topology::new(&welded).count_edges().boundary;
    let is_closed = 2 * n_left <= n_open && 100 * repairs.degenerate_faces <= mesh.n_faces();
    is_closed.then_some(OpenSeams { n_open, n_edges, distance })
}

/// The distance within which nine of ten ends of open edges have another one, by a sample.
fn typical_gap(mesh: &Mesh, topology: &Topology) -> Option<f64> {
    let mut ends: Vec<u32> = (0..topology.edges().len() as u32)
        .filter(|&edge| topology.uses(edge).len() == 1)
        .flat_map(|edge| topology.edge(edge))
        .collect();
    ends.sort_unstable();
    ends.dedup();
    let at = |vertex: u32| mesh.positions()[vertex as usize];
    let step = ends.len().div_ceil(SAMPLES).max(1);
    let samples: Vec<u32> = ends.iter().step_by(step).copied().collect();
    let nearest = |&sample: &u32| {
        let others = ends.iter().filter(|&&end| end != sample);
        others.map(|&end| at(end).distance_squared(at(sample))).fold(f64::INFINITY, f64::min)
    };
    let mut gaps: Vec<f64> = samples.par_iter().map(nearest).collect();
    gaps.sort_unstable_by(f64::total_cmp);
    gaps.get(gaps.len().saturating_sub(1) * 9 / 10).map(|gap| gap.sqrt())
}

/// The next larger one of 1, 2 and 5 times a power of ten, as people write it.
fn round_up(length: f64) -> Option<f64> {
    if !(length > 0.0 && length.is_finite()) {
        return None;
    }
    let exponent = libm::floor(libm::log10(length)) as i32;
    (exponent..=exponent + 1)
        .flat_map(|exponent| [1, 2, 5].map(|digit| format!("{digit}e{exponent}")))
        .filter_map(|text| text.parse().ok())
        .find(|&round: &f64| round > length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_rounded_up_to_what_people_write() {
        for (length, round) in [
            (1.0, 2.0),
            (0.9, 1.0),
            (2.1e-5, 5e-5),
            (6.0, 10.0),
            (0.0004, 0.0005),
            (3e-300, 5e-300),
        ] {
            assert_eq!(round_up(length), Some(round), "{length}");
        }
        assert_eq!(round_up(0.0), None);
        assert_eq!(round_up(f64::INFINITY), None);
    }
}
