//! The tests of a pair: whether one fragment hides a part of another.

use super::SortedFragment;
use crate::engines::face::fragment::{Fragment, Position};
use crate::predicates::{Corner, Plane, PlaneName, Planes, Sign};
use serde::Serialize;

/// The tests of a pair as the module above numbers them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Test {
    Depth,
    Boxes,
    /// Both are parts of one triangle.
    OneTriangle,
    Behind,
    InFront,
    /// Both are in one plane, and the order is that of faces.
    OnePlane,
    Apart,
    Corners,
    /// None of them passes.
    None,
}

/// How often each test was the first to pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Settled {
    /// The nearest point of P is no nearer than the farthest of Q.
    pub depth: u64,
    /// The boxes of the images are disjoint.
    pub boxes: u64,
    /// Both are parts of one triangle.
    pub one_triangle: u64,
    /// P is behind the plane of Q.
    pub behind: u64,
    /// Q is in front of the plane of P.
    pub in_front: u64,
    /// Both are in one plane, and P is of the later face.
    pub one_plane: u64,
    /// The images do not overlap.
    pub apart: u64,
    /// Q is nearer wherever the images overlap.
    pub corners: u64,
    /// No test passed.
    pub none: u64,
}

impl Settled {
    pub(super) fn count(&mut self, test: Test) {
        let count = match test {
            Test::Depth => &mut self.depth,
            Test::Boxes => &mut self.boxes,
            Test::OneTriangle => &mut self.one_triangle,
            Test::Behind => &mut self.behind,
            Test::InFront => &mut self.in_front,
            Test::OnePlane => &mut self.one_plane,
            Test::Apart => &mut self.apart,
            Test::Corners => &mut self.corners,
            Test::None => &mut self.none,
        };
        *count += 1;
    }
}

/// Where a fragment is relative to a plane, as the eye sees it.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Beside {
    Behind,
    InFront,
    Within,
    Across,
}

fn plane_of(planes: &Planes, item: &SortedFragment) -> Plane {
    planes.plane(PlaneName::Triangle(item.fragment.triangle()))
}

/// Where `item` is relative to the plane of `other`.
fn beside(planes: &Planes, item: &SortedFragment, other: &SortedFragment) -> Beside {
    let is_front = other.facing == Sign::Positive;
    match item.fragment.position(planes, &plane_of(planes, other)) {
        Position::Front if is_front => Beside::InFront,
        Position::Back if !is_front => Beside::InFront,
        Position::Front | Position::Back => Beside::Behind,
        Position::Within => Beside::Within,
        Position::Across => Beside::Across,
    }
}

/// The first test that shows that `p` may be painted before `q`, since it hides no part of it.
pub(super) fn test(planes: &Planes, p: &SortedFragment, q: &SortedFragment) -> Test {
    if p.near >= q.far {
        return Test::Depth;
    }
    if !p.may_meet(q) {
        return Test::Boxes;
    }
    if p.fragment.triangle() == q.fragment.triangle() {
        return Test::OneTriangle;
    }
    let p_to_q = beside(planes, p, q);
    match p_to_q {
        Beside::Behind => return Test::Behind,
        Beside::Within if p.face >= q.face => return Test::OnePlane,
        Beside::Within if images_overlap(planes, p, q) => return Test::None,
        Beside::Within => return Test::Apart,
        Beside::InFront | Beside::Across => {}
    }
    let q_to_p = beside(planes, q, p);
    if q_to_p == Beside::InFront {
        return Test::InFront;
    }
    if !images_overlap(planes, p, q) {
        return Test::Apart;
    }
    // If one is wholly on the wrong side of the other's plane, the common part cannot be right.
    let may_be = p_to_q == Beside::Across && q_to_p == Beside::Across;
    if may_be && is_behind_all_over(planes, p, q) { Test::Corners } else { Test::None }
}

/// Whether `fragment` of `item` crosses the plane of `other`.
pub(super) fn is_across(planes: &Planes, item: &SortedFragment, other: &SortedFragment) -> bool {
    beside(planes, item, other) == Beside::Across
}

/// Whether the images share more than borders.
///
/// Convex polygons do not if a side of one has all of the other beyond it.
fn images_overlap(planes: &Planes, p: &SortedFragment, q: &SortedFragment) -> bool {
    let parts = |a: &SortedFragment, b: &SortedFragment| {
        sides(&a.fragment).any(|(from, to)| {
            b.fragment.corners().all(|x| planes.turn(from, to, x).times(a.facing) != Sign::Positive)
        })
    };
    !parts(p, q) && !parts(q, p)
}

fn sides(fragment: &Fragment) -> impl Iterator<Item = (&Corner, &Corner)> {
    let sides = fragment.sides();
    let next = sides.iter().cycle().skip(1);
    sides.iter().zip(next).map(|(from, to)| (&from.corner, &to.corner))
}

/// Whether the image of a corner is in that of an item or on its border.
fn covers(planes: &Planes, item: &SortedFragment, corner: &Corner) -> bool {
    sides(&item.fragment)
        .all(|(from, to)| planes.turn(from, to, corner).times(item.facing) != Sign::Negative)
}

/// Whether `p` is at or behind `q` at every corner of the common part of their images.
///
/// The difference of their depths is linear there, so the corners suffice. A corner of the common part is
/// a corner of one inside the other, or a crossing of two sides.
fn is_behind_all_over(planes: &Planes, p: &SortedFragment, q: &SortedFragment) -> bool {
    let (of_p, of_q) = (plane_of(planes, p), plane_of(planes, q));
    let wrong = p.fragment.corners().any(|corner| {
        planes.side(&of_q, corner).1.times(q.facing) == Sign::Positive && covers(planes, q, corner)
    }) || q.fragment.corners().any(|corner| {
        planes.side(&of_p, corner).1.times(p.facing) == Sign::Negative && covers(planes, p, corner)
    });
    !wrong
        && sides(&p.fragment).all(|(a, b)| {
            sides(&q.fragment).all(|(c, d)| {
                let of_c = planes.turn(a, b, c);
                let crosses = of_c.times(planes.turn(a, b, d)) == Sign::Negative
                    && planes.turn(c, d, a).times(planes.turn(c, d, b)) == Sign::Negative;
                // Behind the plane of a, b and c, d takes the side of q there with it.
                !crosses || planes.volume([a, b, c, d]).times(of_c) != Sign::Negative
            })
        })
}
