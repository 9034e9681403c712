//! Whether two triangles of a surface meet anywhere but at the vertex or side that they share.
//!
//! ```text
//!    ╲a │ b╱        ╲a │            a and b share a side. They touch no further, unless b is
//!     ╲ │ ╱          ╲ │ b          folded flat onto a.
//!      ╲│╱        ────╲┼────
//! ```
//!
//! Exact. Triangles without area count as touching.

use super::pair::{End, for_ends, shared};
use crate::predicates::{Sign, Solid, orient2d};
use glam::{DVec2, DVec3, dvec2};

/// Whether two triangles meet anywhere but at their shared corners and the side between these.
pub(super) fn touch(solid: &Solid, triangles: &[[u32; 3]], numbers: [u32; 2]) -> bool {
    let [a, b] = numbers.map(|triangle| triangles[triangle as usize]);
    let n_shared = shared(a, b).count_ones();
    if n_shared > 2 {
        return true;
    }
    let signs = |triangle: [u32; 3], corners: [u32; 3]| {
        let plane = solid.plane(triangle);
        corners.map(|corner| match triangle.contains(&corner) {
            true => Sign::Zero,
            false => solid.side(&plane, triangle, corner),
        })
    };
    let (of_a, of_b) = (signs(b, a), signs(a, b));
    if of_a == [Sign::Zero; 3] || of_b == [Sign::Zero; 3] {
        return touch_in_plane(solid, a, b);
    }
    if n_shared == 2 {
        // Their planes meet in the line of the side.
        return false;
    }
    let is_shared = |end: End| matches!(end, End::Vertex(v) if a.contains(&v) && b.contains(&v));
    let mut touch = false;
    for k in 0..2 {
        for_ends(solid, numbers, [a, b], [of_a, of_b], k, |end, _| touch |= !is_shared(end));
    }
    touch
}

/// The same for two triangles in one plane; true when one of them has no area.
fn touch_in_plane(solid: &Solid, a: [u32; 3], b: [u32; 3]) -> bool {
    let at = |vertex: u32| solid.positions()[vertex as usize];
    let turn = |along: fn(DVec3) -> DVec2, [p, q, r]: [u32; 3]| {
        orient2d(along(at(p)), along(at(q)), along(at(r)))
    };
    let axes: [fn(DVec3) -> DVec2; 3] =
        [|p| dvec2(p.y, p.z), |p| dvec2(p.z, p.x), |p| dvec2(p.x, p.y)];
    let Some(along) =
        axes.into_iter().find(|&along| [a, b].iter().all(|&t| turn(along, t) != Sign::Zero))
    else {
        return true;
    };
    // Apart when all of one lies beyond a side of the other.
    let is_apart = |own: [u32; 3], other: [u32; 3]| {
        let inward = turn(along, own);
        (0..3).any(|i| {
            let (p, q) = (own[i], own[(i + 1) % 3]);
            other.iter().all(|&x| {
                if x == p || x == q {
                    return true;
                }
                match turn(along, [p, q, x]).times(inward) {
                    Sign::Negative => true,
                    // On the line of the side, it must lie beyond the corner that both have.
                    Sign::Zero if other.contains(&p) => is_between(at(q), at(p), at(x)),
                    Sign::Zero if other.contains(&q) => is_between(at(p), at(q), at(x)),
                    _ => false,
                }
            })
        })
    };
    !is_apart(a, b) && !is_apart(b, a)
}

/// Whether the middle one of three different points on a line lies between the others.
fn is_between(a: DVec3, middle: DVec3, b: DVec3) -> bool {
    let [a, middle, b] = [a, middle, b].map(|p| p.to_array());
    (0..3).any(|i| (a[i] < middle[i] && middle[i] < b[i]) || (b[i] < middle[i] && middle[i] < a[i]))
}
