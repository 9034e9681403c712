//! Triangles cut off at a lowest and a highest height, or made level there.
//!
//! ```text
//!             ╱╲                        ____
//!   ─ ─ ─ ─ ─╱─ ╲─ ─ ─ high      ╱ ╲   ╱    ╲    Triangles are cut exactly at both planes, as they are at
//!     ╱╲    ╱    ╲              ╱   ╲ ╱      ╲   levels. What is beyond is left out, or moved to the plane.
//!   ─╱─ ╲─ ╱─ ─ ─ ╲─ ─ low
//! ```

use rustc_hash::FxHashMap;

use super::lined_mesh::{LinedMesh, SurfaceLine};
use crate::strokes::{StrokeKind, SurfacePart};

/// The heights that are left of a surface given by points, as drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct HeightCut {
    pub(super) low: f64,
    pub(super) high: f64,
    /// Whether what is beyond them is made level instead of left out.
    pub(super) is_clamped: bool,
}

impl HeightCut {
    fn is_beyond(&self, z: f64) -> bool {
        z < self.low || z > self.high
    }

    /// The same after all heights were multiplied.
    #[must_use]
    pub(super) fn scaled(self, factor: f64) -> Self {
        let (a, b) = (self.low * factor, self.high * factor);
        Self { low: a.min(b), high: a.max(b), ..self }
    }
}

impl LinedMesh {
    /// Cuts what was added at two heights. Edges there are lines of kind cut.
    /// O(triangles + pieces).
    pub(super) fn cut_off(&mut self, cut: &HeightCut) {
        self.split_at_planes(&[cut.low, cut.high]);
        if cut.is_clamped {
            for position in &mut self.positions {
                position.z = position.z.clamp(cut.low, cut.high);
            }
            return;
        }
        let is_kept: Vec<bool> = self.positions.iter().map(|p| !cut.is_beyond(p.z)).collect();
        let is_whole = |ends: &[u32]| ends.iter().all(|vertex| is_kept[*vertex as usize]);
        // How many of the kept triangles are along an edge at a plane, for each sheet.
        let key =
            |vertex: u32| (self.positions[vertex as usize] + 0.0).to_array().map(f64::to_bits);
        let at = |vertex: u32, plane: f64| self.positions[vertex as usize].z == plane;
        let mut edges: FxHashMap<_, (usize, [u32; 2], u16)> = FxHashMap::default();
        let mut triangles = Vec::with_capacity(self.triangles.len());
        let mut firsts = Vec::with_capacity(self.sheets.len());
        let mut sheet = 0_u16;
        for (k, corners) in self.triangles.iter().enumerate() {
            while self.sheets.get(firsts.len()).is_some_and(|sheet| sheet.first_triangle <= k) {
                firsts.push(triangles.len());
                sheet = u16::try_from(firsts.len()).unwrap_or(u16::MAX);
            }
            if !is_whole(corners) {
                continue;
            }
            triangles.push(*corners);
            for side in 0..3 {
                let ends = [corners[side], corners[(side + 1) % 3]];
                if [cut.low, cut.high].iter().any(|plane| ends.iter().all(|v| at(*v, *plane))) {
                    let [a, b] = ends.map(key);
                    edges.entry((sheet, a.min(b), a.max(b))).or_insert((0, ends, sheet)).0 += 1;
                }
            }
        }
        firsts.resize(self.sheets.len(), triangles.len());
        let mut lines: Vec<SurfaceLine> =
            self.lines.iter().filter(|line| is_whole(&line.ends)).copied().collect();
        let mut rims: Vec<([u32; 2], u16)> = edges
            .into_values()
            .filter(|(n, ..)| *n == 1)
            .map(|(_, ends, sheet)| (ends, sheet))
            .collect();
        rims.sort_unstable();
        let part = |sheet| SurfacePart { sheet, ..SurfacePart::default() };
        let rim = |(ends, sheet)| SurfaceLine { ends, kind: StrokeKind::Cut, part: part(sheet) };
        lines.extend(rims.into_iter().map(rim));
        for (sheet, first_triangle) in self.sheets.iter_mut().zip(firsts) {
            sheet.first_triangle = first_triangle;
        }
        (self.triangles, self.lines) = (triangles, lines);
    }

    /// Leaves out lines of one kind.
    pub fn leave_out(&mut self, kind: StrokeKind) {
        self.lines.retain(|line| line.kind != kind);
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec3;

    use super::*;

    /// A tent with its ridge at height 1 over a square of side 2.
    fn tent() -> LinedMesh {
        let points = [
            dvec3(0., 0., 0.),
            dvec3(1., 0., 1.),
            dvec3(2., 0., 0.),
            dvec3(0., 2., 0.),
            dvec3(1., 2., 1.),
            dvec3(2., 2., 0.),
        ];
        let mut mesh = LinedMesh::default();
        mesh.push_triangles(&points, &[[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]], true);
        mesh
    }

    fn area(mesh: &LinedMesh) -> f64 {
        let of = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|k| mesh.positions[k as usize].truncate());
            (b - a).perp_dot(c - a) / 2.0
        };
        mesh.triangles.iter().map(of).sum()
    }

    fn cuts(mesh: &LinedMesh) -> Vec<[f64; 2]> {
        let cuts = mesh.lines.iter().filter(|line| line.kind == StrokeKind::Cut);
        let of = |line: &SurfaceLine| {
            let [a, b] = line.ends.map(|k| mesh.positions[k as usize]);
            assert_eq!(a.z, b.z);
            [a.z, a.distance(b)]
        };
        cuts.map(of).collect()
    }

    #[test]
    fn triangles_are_cut_at_both_planes() {
        let mut mesh = tent();
        mesh.cut_off(&HeightCut { low: 0.25, high: 0.75, is_clamped: false });
        assert!((area(&mesh) - 2.0).abs() < 1e-15);
        let length = |z: f64| cuts(&mesh).iter().filter(|c| c[0] == z).map(|c| c[1]).sum::<f64>();
        assert!((length(0.25) - 4.0).abs() < 1e-15 && (length(0.75) - 4.0).abs() < 1e-15);
        let beyond = |line: &SurfaceLine| {
            line.ends.iter().any(|k| !(0.25..=0.75).contains(&mesh.positions[*k as usize].z))
        };
        assert!(!mesh.lines.iter().any(beyond));
    }

    #[test]
    fn a_ridge_that_touches_a_plane_is_not_cut() {
        let mut mesh = tent();
        mesh.cut_off(&HeightCut { low: -1.0, high: 1.0, is_clamped: false });
        // Lines may be turned around, but none is cut.
        let ends = |mesh: &LinedMesh| -> Vec<[u32; 2]> {
            let sorted = |ends: [u32; 2]| [ends[0].min(ends[1]), ends[0].max(ends[1])];
            mesh.lines.iter().map(|line| sorted(line.ends)).collect()
        };
        assert_eq!((&mesh.positions, &mesh.triangles), (&tent().positions, &tent().triangles));
        assert_eq!(ends(&mesh), ends(&tent()));
        mesh.cut_off(&HeightCut { low: 0.5, high: 1.0, is_clamped: false });
        assert!((area(&mesh) - 2.0).abs() < 1e-15);
        assert!(cuts(&mesh).iter().all(|cut| cut[0] == 0.5));
        mesh.cut_off(&HeightCut { low: 2.0, high: 3.0, is_clamped: false });
        assert!(mesh.triangles.is_empty() && mesh.lines.is_empty());
    }

    #[test]
    fn plateaus_stand_where_heights_are_beyond() {
        let mut mesh = tent();
        mesh.cut_off(&HeightCut { low: 0.25, high: 0.75, is_clamped: true });
        assert!((area(&mesh) - 4.0).abs() < 1e-15 && cuts(&mesh).is_empty());
        // The volume below it: what is left of the tent, less what is above, and more what is below.
        let volume = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|k| mesh.positions[k as usize]);
            let base = (b - a).truncate().perp_dot((c - a).truncate()) / 2.0;
            base * (a.z + b.z + c.z) / 3.0
        };
        let expected = 2.0 - 2.0 * 0.25 * 0.25 / 1.0 + 2.0 * 0.25 * 0.25 / 1.0;
        let found: f64 = mesh.triangles.iter().map(volume).sum();
        assert!((found - expected).abs() < 1e-15, "{found}");
    }

    #[test]
    fn a_surface_that_is_turned_over_is_cut_at_the_same_places() {
        for factor in [2.0, -1.0, -0.5] {
            let mut mesh = tent();
            mesh.positions.iter_mut().for_each(|p| p.z *= factor);
            let cut = HeightCut { low: 0.25, high: 0.75, is_clamped: false };
            mesh.cut_off(&cut.scaled(factor));
            assert!((area(&mesh) - 2.0).abs() < 1e-15, "{factor}");
            let length: f64 = cuts(&mesh).iter().map(|cut| cut[1]).sum();
            assert!((length - 8.0).abs() < 1e-12, "{factor}: {length}");
        }
    }
}
