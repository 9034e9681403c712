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

use crate::predicates::{PlaneThrough, Sign, Solid};

/// Where a line of intersection ends, by vertex numbers; sides have the lower number first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum End {
    /// At a vertex.
    Vertex(u32),
    /// Where two sides cross, the lower one first.
    Sides([u32; 2], [u32; 2]),
    /// Where a side pierces the inside of a triangle, by its number.
    Inside([u32; 2], u32),
}

/// How to construct an end that is no vertex: where a side meets the plane of a triangle.
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

/// Signs of the corners of one triangle against the plane of another; none when that is enough to
/// see that they share no line.
#[inline]
fn signs(
    solid: &Solid,
    plane: &PlaneThrough,
    triangle: [u32; 3],
    corners: [u32; 3],
) -> Option<[Sign; 3]> {
    let signs = corners.map(|corner| match triangle.contains(&corner) {
        true => Sign::Zero,
        false => solid.side(plane, triangle, corner),
    });
    let n_zeros = signs.iter().filter(|&&sign| sign == Sign::Zero).count();
    let both = signs.contains(&Sign::Positive) && signs.contains(&Sign::Negative);
    // On one side with a corner in the plane is contact in a point; all in it are coplanar.
    (both || n_zeros == 2).then_some(signs)
}

/// The line that two triangles share; `None` when it is a point or nothing, when they share a side,
/// or when they lie in one plane or have no area.
#[inline]
pub(super) fn piece(
    solid: &Solid,
    triangles: &[[u32; 3]],
    plane: &PlaneThrough,
    numbers: [u32; 2],
) -> Option<Piece> {
    let [a, b] = numbers.map(|t| triangles[t as usize]);
    let shared = a.iter().filter(|corner| b.contains(corner)).count();
    if shared >= 2 {
        return None;
    }
    let of_b = signs(solid, plane, a, b)?;
    let of_a = signs(solid, &solid.plane(b), b, a)?;
    common(solid, numbers, [a, b], [of_a, of_b])
}

#[cold]
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
            // Each of the two triangles may name the same end, with a construction of its own.
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
    Some(Piece { triangles: numbers, ends: [first.0, last.0], sites: [first.1, last.1], along })
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
fn for_ends(
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
