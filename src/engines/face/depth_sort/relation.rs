//! The tests of a pair: whether one fragment hides a part of another.

use super::Item;
use crate::engines::face::fragment::{Fragment, Position};
use crate::predicates::{Corner, Plane, PlaneName, Planes, Sign};

/// Where a fragment lies, as the eye sees it.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Beside {
    Behind,
    InFront,
    Within,
    Across,
}

fn plane_of(planes: &Planes, item: &Item) -> Plane {
    planes.plane(PlaneName::Triangle(item.fragment.triangle()))
}

/// How `item` lies to the plane of `other`.
fn beside(planes: &Planes, item: &Item, other: &Item) -> Beside {
    let is_front = other.facing == Sign::Positive;
    match item.fragment.position(planes, &plane_of(planes, other)) {
        Position::Front if is_front => Beside::InFront,
        Position::Back if !is_front => Beside::InFront,
        Position::Front | Position::Back => Beside::Behind,
        Position::Within => Beside::Within,
        Position::Across => Beside::Across,
    }
}

/// Whether `p` may be painted before `q`: it hides no part of it. See the module above for the tests.
pub(super) fn may_precede(planes: &Planes, p: &Item, q: &Item) -> bool {
    if p.near >= q.far || !p.may_meet(q) {
        return true;
    }
    if p.fragment.triangle() == q.fragment.triangle() {
        return true;
    }
    let p_to_q = beside(planes, p, q);
    match p_to_q {
        Beside::Behind => return true,
        Beside::Within => return p.face >= q.face || !images_overlap(planes, p, q),
        Beside::InFront | Beside::Across => {}
    }
    let q_to_p = beside(planes, q, p);
    if q_to_p == Beside::InFront {
        return true;
    }
    if !images_overlap(planes, p, q) {
        return true;
    }
    // With one wholly on the wrong side of the other's plane the common part cannot be right.
    p_to_q == Beside::Across && q_to_p == Beside::Across && is_behind_all_over(planes, p, q)
}

/// Whether `fragment` of `item` lies across the plane of `other`.
pub(super) fn is_across(planes: &Planes, item: &Item, other: &Item) -> bool {
    beside(planes, item, other) == Beside::Across
}

/// Whether the images have more than borders in common.
///
/// Convex polygons have not when one of their sides has all of the other polygon beyond it.
fn images_overlap(planes: &Planes, p: &Item, q: &Item) -> bool {
    let parts = |a: &Item, b: &Item| {
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

/// Whether the image of a corner lies in that of an item or on its border.
fn covers(planes: &Planes, item: &Item, corner: &Corner) -> bool {
    sides(&item.fragment)
        .all(|(from, to)| planes.turn(from, to, corner).times(item.facing) != Sign::Negative)
}

/// Whether `p` is at or behind `q` at every corner of the common part of their images.
///
/// The depth of one over the other is linear there, so that corners tell all. A corner of the common
/// part is a corner of one in the other, or a crossing of two sides.
fn is_behind_all_over(planes: &Planes, p: &Item, q: &Item) -> bool {
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
