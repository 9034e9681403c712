//! What two triangles have in common.
//!
//! Each triangle crosses the plane of the other in a part of the line in which the two planes meet.
//! The ends of that part are corners in the other's plane, or points where a side pierces it. What
//! both triangles share runs between the ends of either that lie in the other triangle:
//!
//! ```text
//!     A's part        a ●━━━━━━━━━━● b
//!     B's part               c ●━━━━━━━━━● d
//!     in common                ●━━━●               from c, which is in A, to b, which is in B
//! ```
//!
//! All of it is signs of volumes of four input points, so nothing is constructed yet. An end is
//! named by what makes it, so that neighboring triangles agree on it.

use super::diagonals::Diagonals;
use crate::predicates::{QuickPlane, Sign, Solid};
use glam::DVec3;

/// Where an intersection line ends, by vertex numbers; sides have the lower number first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum End {
    /// At a vertex.
    Vertex(u32),
    /// Where two sides cross, the lower one first.
    Sides([u32; 2], [u32; 2]),
    /// Where a side pierces the inside of a triangle, by its number.
    Inside([u32; 2], u32),
}

/// How to construct an end that is not a vertex: where a side meets the plane of a triangle.
pub(super) type Site = ([u32; 2], u32);

/// What two triangles that are not in one plane have in common.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece {
    /// Their numbers.
    pub triangles: [u32; 2],
    /// Its ends, the lower first.
    pub ends: [End; 2],
    /// How to construct each end.
    pub sites: [Site; 2],
    /// For each triangle the side that the piece runs along, if it does, and its other corner.
    pub along: [Option<Along>; 2],
    /// For a side that both triangles have, the face of which it is a diagonal; and the other
    /// triangle's, if it is a diagonal there too.
    pub diagonal_of: Option<[u32; 2]>,
}

/// A side of a triangle in the plane of another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Along {
    /// The side, the lower vertex first.
    pub side: [u32; 2],
    /// Which side of the other triangle's plane the rest lies on.
    pub rest: Sign,
    /// The third corner.
    pub corner: u32,
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    if a < b { [a, b] } else { [b, a] }
}

/// Where a point in a triangle's plane lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Location {
    Outside,
    Inside,
    OnSide([u32; 2]),
    AtCorner(u32),
}

/// A triangle with its points and plane.
#[derive(Debug)]
pub(super) struct Prepared {
    corners: [u32; 3],
    points: [DVec3; 3],
    plane: QuickPlane,
}

impl Prepared {
    #[inline]
    pub(super) fn new(solid: &Solid, corners: [u32; 3]) -> Self {
        let points = corners.map(|corner| solid.positions()[corner as usize]);
        Self { corners, points, plane: solid.quick_plane(points[0], points[1], points[2]) }
    }
}

/// Which corners of `own` are also corners of `other`: bit k stands for corner k.
#[inline]
pub(super) fn shared(own: [u32; 3], [p, q, r]: [u32; 3]) -> u32 {
    let [a, b, c] = own.map(|x| u32::from((x == p) | (x == q) | (x == r)));
    a | b << 1 | c << 2
}

/// Whether two triangles have a side in common.
#[inline]
pub(super) fn share_a_side(a: &Prepared, corners: [u32; 3]) -> bool {
    shared(a.corners, corners).count_ones() >= 2
}

/// Whether two triangles certainly share no line, as far as floating point can tell. Nearly all pairs
/// of neighbors in a mesh end here, so speed matters.
#[inline]
pub(super) fn are_apart(
    solid: &Solid,
    diagonals: &Diagonals,
    a: &Prepared,
    corners: [u32; 3],
) -> bool {
    let of_a = shared(a.corners, corners);
    if of_a.count_ones() >= 2 {
        return diagonals.is_empty();
    }
    let of_b = shared(corners, a.corners);
    let at = |corner: u32| solid.positions()[corner as usize];
    let [p, q, r] = corners.map(at);
    let side = |plane: &QuickPlane, point: DVec3| solid.certain_side(plane, point);
    let sides = [side(&a.plane, p), side(&a.plane, q), side(&a.plane, r)];
    if is_one_side(sides, of_b) {
        return true;
    }
    let plane = solid.quick_plane(p, q, r);
    let [u, v, w] = a.points;
    let sides = [side(&plane, u), side(&plane, v), side(&plane, w)];
    is_one_side(sides, of_a)
        || (of_a != 0 && leave_apart(solid, a.points, of_a, sides, [p, q, r], of_b))
}

/// Whether all corners but those left out are for certain on one side.
#[inline(always)]
fn is_one_side(sides: [i32; 3], left_out: u32) -> bool {
    let on = |side: i32| {
        u32::from(sides[0] == side)
            | u32::from(sides[1] == side) << 1
            | u32::from(sides[2] == side) << 2
            | left_out
    };
    on(1) == 7 || on(-1) == 7
}

/// Whether it is certain that two triangles with one corner in common leave it in opposite
/// directions of the line in which their planes meet.
///
/// ```text
///      a ╲    ╱ c        The side from a to b meets the plane of the triangle v c d on the other
///        ┄┄┄●┄┄┄         side of the line through v and c than the one on which d lies.
///      b ╱ v  ╲ d
/// ```
#[inline]
fn leave_apart(
    solid: &Solid,
    a: [DVec3; 3],
    shared_of_a: u32,
    sides: [i32; 3],
    b: [DVec3; 3],
    shared_of_b: u32,
) -> bool {
    let next = |shared: u32| (shared.trailing_zeros() as usize + 1) % 3;
    let (from, c) = (next(shared_of_a), next(shared_of_b));
    let (to, v) = ((from + 1) % 3, (c + 2) % 3);
    let plane = solid.quick_plane(b[v], b[c], a[from]);
    let side = solid.certain_side(&plane, a[to]);
    side != 0 && sides[from] == side && sides[to] == -side
}

/// Signs of the corners of one triangle against the plane of another; none when that is enough to
/// see that they share no line.
fn signs(solid: &Solid, triangle: [u32; 3], corners: [u32; 3]) -> Option<[Sign; 3]> {
    let plane = solid.plane(triangle);
    let signs = corners.map(|corner| match triangle.contains(&corner) {
        true => Sign::Zero,
        false => solid.side(&plane, triangle, corner),
    });
    let n_zeros = signs.iter().filter(|&&sign| sign == Sign::Zero).count();
    let both = signs.contains(&Sign::Positive) && signs.contains(&Sign::Negative);
    // On one side with a corner in the plane is contact in a point; all in it are coplanar.
    (both || n_zeros == 2).then_some(signs)
}

/// The line that two triangles share; `None` when it is a point or nothing, when they share a side
/// that is an edge of both faces, or when they lie in one plane or have no area.
#[inline(never)]
pub(super) fn piece(
    solid: &Solid,
    triangles: &[[u32; 3]],
    diagonals: &Diagonals,
    numbers: [u32; 2],
) -> Option<Piece> {
    let [a, b] = numbers.map(|t| triangles[t as usize]);
    if a.iter().filter(|corner| b.contains(corner)).count() >= 2 {
        return diagonal(solid, triangles, diagonals, numbers);
    }
    let of_b = signs(solid, a, b)?;
    let of_a = signs(solid, b, a)?;
    common(solid, numbers, [a, b], [of_a, of_b])
}

/// The side that two triangles of different faces share, when it is a diagonal of one of these.
fn diagonal(
    solid: &Solid,
    triangles: &[[u32; 3]],
    diagonals: &Diagonals,
    numbers: [u32; 2],
) -> Option<Piece> {
    let faces = numbers.map(|t| diagonals.face(t));
    if faces[0] == faces[1] {
        return None;
    }
    let [a, b] = numbers.map(|t| triangles[t as usize]);
    let i = (0..3).find(|&i| !b.contains(&a[i]))?;
    let side = sorted([a[(i + 1) % 3], a[(i + 2) % 3]]);
    let [of_a, of_b] = numbers.map(|t| diagonals.has(t, triangles[t as usize], side));
    if !of_a && !of_b {
        return None;
    }
    // The face that it is a diagonal of goes first; with two such faces, the lower one.
    let turn = !of_a || (of_b && faces[1] < faces[0]);
    let [first, last] = if turn { [numbers[1], numbers[0]] } else { numbers };
    let corner = |t: u32| triangles[t as usize].into_iter().find(|corner| !side.contains(corner));
    let (of_first, of_last) = (corner(first)?, corner(last)?);
    let rest = solid.side_of(triangles[first as usize], of_last);
    if rest == Sign::Zero {
        return None;
    }
    let along = [of_first, of_last].map(|corner| Some(Along { side, rest, corner }));
    Some(Piece {
        triangles: [first, last],
        ends: side.map(End::Vertex),
        sites: side.map(|end| ([end; 2], first)),
        along,
        diagonal_of: Some([
            diagonals.face(first),
            if of_a && of_b { diagonals.face(last) } else { u32::MAX },
        ]),
    })
}

fn common(
    solid: &Solid,
    numbers: [u32; 2],
    corners: [[u32; 3]; 2],
    signs: [[Sign; 3]; 2],
) -> Option<Piece> {
    let mut ends: [Option<(End, Site)>; 4] = [None; 4];
    let mut n = 0;
    for k in 0..2 {
        for_ends(solid, numbers, corners, signs, k, |end, site| {
            // Each of the two triangles may name the same end, constructed differently.
            if !ends[..n].iter().flatten().any(|&(known, _)| known == end) {
                ends[n] = Some((end, site));
                n += 1;
            }
        });
    }
    let (Some(mut first), Some(mut last), None) = (ends[0], ends[1], ends[2]) else {
        return None;
    };
    if last.0 < first.0 {
        std::mem::swap(&mut first, &mut last);
    }
    let along = [0, 1].map(|k| along(corners[k], signs[k]));
    Some(Piece {
        triangles: numbers,
        ends: [first.0, last.0],
        sites: [first.1, last.1],
        along,
        diagonal_of: None,
    })
}

/// The side of a triangle that lies in the other's plane.
fn along(corners: [u32; 3], signs: [Sign; 3]) -> Option<Along> {
    (0..3).find_map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        (signs[i] == Sign::Zero && signs[j] == Sign::Zero).then(|| Along {
            side: sorted([corners[i], corners[j]]),
            rest: signs[k],
            corner: corners[k],
        })
    })
}

/// Calls `f` with the ends of triangle `k`'s part of the line that lie in the other triangle.
pub(super) fn for_ends(
    solid: &Solid,
    numbers: [u32; 2],
    corners: [[u32; 3]; 2],
    signs: [[Sign; 3]; 2],
    k: usize,
    mut f: impl FnMut(End, Site),
) {
    let (own, other, signs) = (corners[k], corners[1 - k], signs[k]);
    let triangle = numbers[1 - k];
    for i in 0..3 {
        let j = (i + 1) % 3;
        if signs[i] == Sign::Zero {
            if other.contains(&own[i]) {
                f(End::Vertex(own[i]), ([own[i]; 2], triangle));
                continue;
            }
            let Some(off) = (0..3).find(|&off| signs[off] != Sign::Zero) else { continue };
            if locate(solid, other, own[off], signs[off], own[i]) != Location::Outside {
                f(End::Vertex(own[i]), ([own[i]; 2], triangle));
            }
        } else if signs[i].times(signs[j]) == Sign::Negative {
            let side = sorted([own[i], own[j]]);
            let end = match locate(solid, other, own[i], signs[i], own[j]) {
                Location::Outside => continue,
                Location::Inside => End::Inside(side, triangle),
                Location::OnSide(border) => End::Sides(side.min(border), side.max(border)),
                Location::AtCorner(corner) => End::Vertex(corner),
            };
            f(end, (side, triangle));
        }
    }
}

/// Where the line from `from`, which lies on the side `side` of a triangle's plane, through `to`,
/// which does not, meets that plane.
fn locate(solid: &Solid, triangle: [u32; 3], from: u32, side: Sign, to: u32) -> Location {
    let mut zeros = [false; 3];
    for i in 0..3 {
        let (r, s) = (triangle[i], triangle[(i + 1) % 3]);
        match solid.side_of([r, s, from], to).times(side) {
            Sign::Positive => return Location::Outside,
            Sign::Zero => zeros[i] = true,
            Sign::Negative => {}
        }
    }
    match zeros {
        [false, false, false] => Location::Inside,
        [true, false, false] => Location::OnSide(sorted([triangle[0], triangle[1]])),
        [false, true, false] => Location::OnSide(sorted([triangle[1], triangle[2]])),
        [false, false, true] => Location::OnSide(sorted([triangle[2], triangle[0]])),
        [true, true, _] => Location::AtCorner(triangle[1]),
        [_, true, true] => Location::AtCorner(triangle[2]),
        [true, _, true] => Location::AtCorner(triangle[0]),
    }
}
