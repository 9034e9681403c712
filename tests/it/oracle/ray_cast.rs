//! A second opinion: displaced sight lines.
//!
//! A point of an edge is moved aside in the image by next to nothing, and the triangles that its
//! sight line meets are counted in rational arithmetic. Faces that contain the edge would decide by
//! that displacement alone, so meetings next to the point itself do not count. Only the welded
//! positions and triangles are shared with the oracle.

use super::exact::Ratio;
use super::{EdgeTruth, Sight, World};
use dashu_ratio::RBig;

type V = [RBig; 3];

fn v(p: [f64; 3]) -> V {
    p.map(|x| RBig::try_from(x).unwrap())
}

fn minus(a: &V, b: &V) -> V {
    [&a[0] - &b[0], &a[1] - &b[1], &a[2] - &b[2]]
}

fn along(a: &V, t: &RBig, d: &V) -> V {
    [&a[0] + t * &d[0], &a[1] + t * &d[1], &a[2] + t * &d[2]]
}

fn dot(a: &V, b: &V) -> RBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn cross(a: &V, b: &V) -> V {
    [&a[1] * &b[2] - &a[2] * &b[1], &a[2] * &b[0] - &a[0] * &b[2], &a[0] * &b[1] - &a[1] * &b[0]]
}

/// How many triangles lie in front of a point just left and just right of t0..t1 on an edge.
///
/// Wrong when something lies closer in front of the edge than a millionth of the distance to the
/// eye without touching it, or passes closer beside it than 1e-12.
fn counts_beside(world: &World, ends: [[f64; 3]; 2], t0: &Ratio, t1: &Ratio) -> [u32; 2] {
    let triangles = world.triangles().unwrap();
    let rational = |r: &Ratio| RBig::from_parts_signed(r.numerator.clone(), r.denominator.clone());
    // No simple fraction of the piece: nothing else should happen to pass through the point.
    let somewhere = RBig::from_parts_signed(41_421_356.into(), 100_000_007.into());
    let (t0, t1) = (rational(t0), rational(t1));
    let t = &t0 + somewhere * (t1 - &t0);
    let (p, q) = (v(ends[0]), v(ends[1]));
    let forward = v(world.sight.forward());
    let eye = v(world.sight.eye);
    let direction = minus(&q, &p);
    let x = along(&p, &t, &direction);
    let to_eye = match world.sight.near {
        Some(_) => minus(&eye, &x),
        None => [-&forward[0], -&forward[1], -&forward[2]],
    };
    let aside = cross(&direction, &to_eye);
    let step = RBig::from_parts_signed(1.into(), 1_000_000_000_007i64.into());
    let least = RBig::from_parts_signed(1.into(), 1_000_000.into());
    let zero = RBig::ZERO;

    [step.clone(), -step].map(|step| {
        let from = along(&x, &step, &aside);
        let sight_line = match world.sight.near {
            Some(_) => minus(&eye, &from),
            None => to_eye.clone(),
        };
        let meets = |t: &[usize; 3]| {
            let [a, b, c] = t.map(|i| v(world.positions[i]));
            let normal = cross(&minus(&b, &a), &minus(&c, &a));
            let slope = dot(&sight_line, &normal);
            if slope == zero {
                return false;
            }
            let s = dot(&minus(&a, &from), &normal) / slope;
            if s <= least || world.sight.near.is_some() && s >= RBig::ONE {
                return false;
            }
            let hit = along(&from, &s, &sight_line);
            if let Some(near) = world.sight.near {
                let depth = dot(&minus(&hit, &eye), &forward);
                if depth < RBig::try_from(near).unwrap() * dot(&forward, &forward) {
                    return false;
                }
            }
            [(&a, &b), (&b, &c), (&c, &a)]
                .iter()
                .all(|(u, w)| dot(&cross(&minus(w, u), &minus(&hit, u)), &normal) >= zero)
        };
        triangles.iter().filter(|t| meets(t)).count() as u32
    })
}

/// Checks every piece of every edge; the number of pieces.
///
/// # Errors
/// The first piece whose count differs, in words.
pub(crate) fn agrees_with(
    positions: &[[f64; 3]],
    faces: &[Vec<u32>],
    sight: &Sight,
    edges: &[EdgeTruth],
) -> Result<usize, String> {
    let world = World::new(positions, faces, sight);
    let mut n_pieces = 0;
    for edge in edges {
        for piece in &edge.pieces {
            let (t0, t1) = (piece.t0.to_f64(), piece.t1.to_f64());
            if t1 - t0 < 1e-5 {
                continue; // what ends it may be nearer than the displacement allows for
            }
            let [left, right] = counts_beside(&world, edge.ends, &piece.t0, &piece.t1);
            if left.min(right) != piece.qi {
                return Err(format!(
                    "edge {:?} from {t0} to {t1}: qi {}, but {left} and {right} beside it",
                    edge.ends, piece.qi
                ));
            }
            n_pieces += 1;
        }
    }
    Ok(n_pieces)
}
