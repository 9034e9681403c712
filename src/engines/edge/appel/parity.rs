//! Parity: a sight line meets a closed surface an even number of times.
//!
//! ```text
//!            ╭──────────╮      ╭───╮
//!   eye ─────┼──────────┼──────┼───┼────►     1, 2, 3, 4
//!            ╰──────────╯      ╰───╯
//! ```
//!
//! Where every side of the triangles has an even number of them, each sight line that meets no side
//! crosses an even number of triangles, whatever their winding and whether or not they cross
//! themselves, as long as the eye lies outside: it does when nothing is cut by the near plane. So the
//! layers in front of a segment, which were carried from elsewhere, and the triangles at or behind it,
//! which are counted here one by one, must have an even sum on either side of it.

use super::super::rounding::Rounding;
use super::super::segment::Segment;
use super::super::shadow::{Shadow, image_cover, shadow};
use super::super::sides::Sides;
use crate::classify::ViewedScene;
use crate::predicates::CutPlane;
use rayon::prelude::*;

/// Triangles that are looked at, at most: what bounds the number of sight lines. For small meshes it
/// is hundreds, for one with more triangles than this none.
const LOOKED_AT: usize = 1 << 17;

/// How many of some sight lines, spread over all segments, meet an odd number of triangles.
///
/// `starts` are the layers in front of each segment where it begins. Zero unless the surface is closed
/// and wholly beyond the near plane. O(triangles) for each line, with a limit on the total.
pub(super) fn count_odd(
    view: &ViewedScene,
    sides: &Sides,
    segments: &[Option<Segment>],
    starts: &[Option<[i32; 2]>],
) -> u64 {
    let n_triangles = view.scene().triangles().len();
    let n_lines = (LOOKED_AT / n_triangles.max(1)).min(segments.len());
    if view.near_plane_cuts() || n_lines == 0 || !sides.are_closed() {
        return 0;
    }
    let rounding = Rounding::new(view);
    let lines = (0..n_lines).map(|line| line * segments.len() / n_lines);
    let is_odd = |i: usize| match (&segments[i], starts[i]) {
        (Some(segment), Some(in_front)) => {
            let beyond = not_in_front(view, &rounding, segment);
            [0, 1].iter().any(|&k| (in_front[k] + beyond[k]) % 2 != 0)
        }
        _ => false,
    };
    lines.filter(|&i| is_odd(i)).count() as u64
}

/// How many triangles lie at or behind a segment where it begins, on its left and right.
fn not_in_front(view: &ViewedScene, rounding: &Rounding, segment: &Segment) -> [i32; 2] {
    let start = Segment { image: [segment.image[0]; 2], depth: [segment.depth[0]; 2], ..*segment };
    let bounds = rounding.bounds(start.image, start.depth);
    let begins = |cut| cut == CutPlane::End || cut == CutPlane::Near;
    (0..view.scene().triangles().len() as u32)
        .into_par_iter()
        .with_min_len(4096)
        .filter(|&triangle| {
            let corners = view.scene().triangles()[triangle as usize];
            let points = corners.map(|corner| view.image()[corner as usize]);
            rounding.bounds(points.map(|p| p.image()), points.map(|p| p.depth)).overlaps(&bounds)
        })
        .map(|triangle| {
            let Some(all) = image_cover(view, segment, triangle) else { return [0; 2] };
            if !begins(all.from.plane) {
                return [0; 2];
            }
            let in_front = match shadow(view, segment, triangle, 0.0, false) {
                Some(Shadow::Covers(cover)) if begins(cover.from.plane) => cover.sides.counts(),
                _ => [0; 2],
            };
            let counts = all.sides.counts();
            [0, 1].map(|k| counts[k] - in_front[k])
        })
        .reduce(|| [0; 2], |a, b| [a[0] + b[0], a[1] + b[1]])
}

#[cfg(test)]
mod tests {
    use super::super::super::roberts;
    use super::super::super::sides::Sides;
    use super::count_odd;
    use crate::camera::{Camera, Projection};
    use crate::classify::{LineSelection, ViewedScene};
    use crate::model::mesh::{Mesh, PolygonSoup};
    use crate::model::scene::Scene;
    use glam::{DVec3, dvec3};

    /// Two tetrahedra that cross each other, the second wound inwards.
    fn crossing() -> Scene {
        let mut soup = PolygonSoup::default();
        for (shift, flipped) in [(0.0, false), (0.5, true)] {
            let first = soup.positions.len() as u32;
            let corners =
                [DVec3::ZERO, dvec3(4.0, 0.0, 0.0), dvec3(0.0, 4.0, 0.0), dvec3(1.0, 1.0, 4.0)];
            soup.positions.extend(corners.map(|p| p + shift));
            for mut face in [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]] {
                if flipped {
                    face.reverse();
                }
                soup.push_face(&face.map(|corner| first + corner));
            }
        }
        Mesh::new(soup).map(|(mesh, _)| Scene::new(mesh)).unwrap_or_default()
    }

    #[test]
    fn one_layer_too_many_or_one_triangle_too_few_is_odd() {
        let scene = crossing();
        let eye = dvec3(9.0, -7.0, 5.0);
        for projection in
            [Projection::Orthographic, Projection::Perspective { fov_deg: 40.0, near: 1e-6 }]
        {
            let camera = Camera::new(eye, DVec3::ZERO, DVec3::Z, projection).expect("a camera");
            let view = ViewedScene::new(&scene, &camera, LineSelection::all_edges(), 30.0);
            let segments = roberts::segments(&view, None);
            // What covers each segment's beginning, by Roberts with all layers.
            let options = super::super::super::VisibilityOptions {
                count_layers: true,
                ..super::super::super::VisibilityOptions::default()
            };
            let (visibility, _) = roberts::solve_all_pairs(&view, &options);
            let mut starts: Vec<_> = (0..segments.len())
                .map(|i| visibility.spans(i).first().map(|span| [span.qi as i32; 2]))
                .collect();
            let sides = Sides::new(&view);
            assert_eq!(count_odd(&view, &sides, &segments, &starts), 0);
            starts[3] = starts[3].map(|[left, right]| [left, right + 1]);
            assert_eq!(count_odd(&view, &sides, &segments, &starts), 1);
        }
    }
}
