//! Where faces only touch along an edge, and where they cross there.
//!
//! ```text
//!        │                │                 A face whose side lies on another face touches it.
//!   ─────┴─────      ─────┼─────            Only with a second one beyond do the two surfaces
//!      touches            │ crosses         cross.
//! ```
//!
//! A box on a table touches it: there the box's own edge is drawn, if any. A wall that continues below the
//! floor crosses it, even where the floor happens to run along edges of the wall.

use super::pair::{Along, End, Piece};
use crate::predicates::{Sign, Solid};

/// What pieces along edges have in common that make one crossing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Site {
    /// Along a side of triangles and through another triangle.
    Through([u32; 2], u32),
    /// Along sides of both, the lower one first.
    Edges([u32; 2], [u32; 2]),
    /// Along a diagonal of a face that is an edge of other faces, or a diagonal of another.
    Diagonal([u32; 2], [u32; 2]),
}

/// Leaves out pieces along edges where faces touch but do not cross, and keeps one piece for each
/// crossing.
pub(super) fn crossings(pieces: Vec<Piece>, solid: &Solid) -> Vec<Piece> {
    let (doubtful, mut kept): (Vec<Piece>, Vec<Piece>) =
        pieces.into_iter().partition(|piece| piece.along != [None; 2]);
    let mut sited: Vec<(Site, [End; 2], Piece)> = doubtful
        .into_iter()
        .filter_map(|piece| {
            let site = match piece.along {
                [Some(a), _] if let Some(faces) = piece.diagonal_of => {
                    Site::Diagonal(a.side, faces)
                }
                [Some(a), None] => Site::Through(a.side, piece.triangles[1]),
                [None, Some(b)] => Site::Through(b.side, piece.triangles[0]),
                [Some(a), Some(b)] => Site::Edges(a.side.min(b.side), a.side.max(b.side)),
                [None, None] => return None,
            };
            Some((site, piece.ends, piece))
        })
        .collect();
    sited.sort_unstable_by_key(|&(site, ends, piece)| (site, ends, piece.triangles));
    for group in sited.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        let alongs = group.iter().flat_map(|(.., piece)| piece.along.into_iter().flatten());
        let crosses = match group[0].0 {
            Site::Through(..) => {
                let on = |side: Sign| alongs.clone().any(|along| along.rest == side);
                on(Sign::Negative) && on(Sign::Positive)
            }
            Site::Diagonal(side, _) => {
                let fan = |k: usize| {
                    let fan = group.iter().filter_map(|(.., piece)| piece.along[k]);
                    fan.collect::<Vec<Along>>()
                };
                are_alternate(solid, side, &fan(0), &fan(1))
            }
            Site::Edges(first, last) => {
                let fan = |side: [u32; 2]| {
                    let fan = alongs.clone().filter(|along| along.side == side);
                    fan.collect::<Vec<Along>>()
                };
                are_alternate(solid, first, &fan(first), &fan(last))
            }
        };
        if crosses {
            kept.push(group[0].2);
        }
    }
    kept
}

/// Whether going around an edge, half planes of the one fan lie on both sides of two of the other.
fn are_alternate(solid: &Solid, [p, q]: [u32; 2], a: &[Along], b: &[Along]) -> bool {
    // The way from one half plane to another around the edge is positive up to half a turn.
    let way = |from: u32, to: u32| solid.side_of([p, q, from], to).flipped();
    // Strictly between two half planes, on the way from the one to the other.
    let is_between = |from: &Along, x: &Along, to: &Along| {
        let [from, x, to] = [from.corner, x.corner, to.corner];
        match way(from, to) {
            Sign::Negative => way(to, x) == Sign::Negative || way(x, from) == Sign::Negative,
            _ => way(from, x) == Sign::Positive && way(x, to) == Sign::Positive,
        }
    };
    a.iter().enumerate().any(|(i, first)| {
        a[..i].iter().any(|second| {
            b.iter().any(|x| is_between(first, x, second))
                && b.iter().any(|x| is_between(second, x, first))
        })
    })
}
