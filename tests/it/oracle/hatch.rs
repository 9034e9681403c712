//! The truth about hatch lines: what is seen of where planes cut faces, and what of it is lit.
//!
//! Planes cut the oracle's own triangles. Visibility is that of edges, from the eye and from the light;
//! a face that shows the light its other side is not lit.

use super::compare::Image;
use super::cover::Cover;
use super::exact::{Int, Point, Ratio, common_exponent, decomposed, scaled, sign};
use super::triangulate::{newell, triangles};
use super::{Piece, Sight, World, pieces};

/// A plane `normal · x = offset`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HatchPlane {
    pub normal: [f64; 3],
    pub offset: f64,
}

/// A visible part of a hatch line, in the image.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HatchTruth {
    pub ends: [[f64; 2]; 2],
    pub is_lit: bool,
    /// Number of its face.
    pub face: usize,
}

/// All visible parts of the lines that some planes cut from the faces.
///
/// # Errors
/// A polygon that is not flat or crosses itself.
pub(crate) fn hatch_truth(
    positions: &[[f64; 3]],
    faces: &[Vec<u32>],
    eye: &Sight,
    light: &Sight,
    planes: &[HatchPlane],
) -> Result<Vec<HatchTruth>, String> {
    let worlds = [eye, light].map(|sight| World::new(positions, faces, sight));
    let mut covers: [Vec<Cover>; 2] = [Vec::new(), Vec::new()];
    for (world, covers) in worlds.iter().zip(&mut covers) {
        let all = world.triangles()?;
        covers.extend(all.into_iter().filter_map(|t| world.cover(t, false)));
    }
    let image = Image::new(eye);
    let mut found = Vec::new();
    for (number, face) in worlds[0].faces.iter().enumerate() {
        let facing = [0, 1].map(|k| {
            let world = &worlds[k];
            let face = &world.faces[number];
            world.facing(face, &newell(&world.points, face))
        });
        if facing[0] == 0 {
            continue;
        }
        let faces_light = facing[0] == facing[1];
        for triangle in triangles(&worlds[0].points, face)? {
            for plane in planes {
                let ends = worlds.each_ref().map(|world| cut(world, triangle, plane));
                let [Some(of_eye), Some(of_light)] = ends else { continue };
                let [seen, lit] = [(0, &of_eye), (1, &of_light)].map(|(k, [p, q])| {
                    let world = &worlds[k];
                    let Some(kept) = world.kept_range(p, q) else { return Vec::new() };
                    let hidden: Vec<_> = covers[k]
                        .iter()
                        .filter_map(|c| world.hidden_part(c, [p, q], (&kept.0, &kept.1), 0.0))
                        .collect();
                    pieces(kept, &hidden)
                });
                let ends = of_eye.each_ref().map(|p| rounded(&worlds[0], p));
                for piece in seen.iter().filter(|piece| piece.qi == 0) {
                    for (t0, t1, is_lit) in by_light(piece, &lit) {
                        let ends = [t0, t1].map(|t| image.at(ends, t.to_f64()));
                        found.push(HatchTruth {
                            ends,
                            is_lit: is_lit && faces_light,
                            face: number,
                        });
                    }
                }
            }
        }
    }
    Ok(found)
}

/// The ends of where a plane cuts a triangle, with one last coordinate; what is on the plane counts as
/// above it.
fn cut(world: &World, triangle: [usize; 3], plane: &HatchPlane) -> Option<[Point; 2]> {
    let of_normal = common_exponent(plane.normal);
    let normal = plane.normal.map(|x| scaled(x, of_normal));
    let of_product = of_normal + world.exponent;
    let exponent = of_product.min(decomposed(plane.offset).1);
    let offset = scaled(plane.offset, exponent);
    let at = triangle.map(|v| {
        let product: Int = (0..3).map(|k| &normal[k] * &world.points[v][k]).sum();
        (product << (of_product - exponent) as usize) - &offset
    });
    let mut ends = Vec::new();
    for i in 0..3 {
        let j = (i + 1) % 3;
        if (sign(&at[i]) >= 0) != (sign(&at[j]) >= 0) {
            // The weights are those of the other end's distance, both with one sign.
            let (below, above) = if sign(&at[i]) < 0 { (i, j) } else { (j, i) };
            let (of_below, of_above) = (at[above].clone(), -&at[below]);
            let (p, q) = (world.point(triangle[below]), world.point(triangle[above]));
            ends.push([0, 1, 2, 3].map(|k| &p[k] * &of_below + &q[k] * &of_above));
        }
    }
    let [p, q]: [Point; 2] = ends.try_into().ok()?;
    let (of_p, of_q) = (p[3].clone(), q[3].clone());
    let (p, q) = (p.map(|x| x * &of_q), q.map(|x| x * &of_p));
    (p != q).then_some([p, q])
}

fn rounded(world: &World, p: &Point) -> [f64; 3] {
    let unit = 2f64.powi(world.exponent);
    [0, 1, 2].map(|k| Ratio::new(p[k].clone(), p[3].clone()).to_f64() * unit)
}

/// The parts of a piece with whether the light sees them; what it does not look at is lit.
fn by_light(piece: &Piece, lit: &[Piece]) -> Vec<(Ratio, Ratio, bool)> {
    let mut parts = Vec::new();
    let mut at = piece.t0.clone();
    for dark in lit.iter().filter(|dark| dark.qi > 0) {
        let (from, to) = (dark.t0.clone().max(at.clone()), dark.t1.clone().min(piece.t1.clone()));
        if from < to {
            if at < from {
                parts.push((at, from.clone(), true));
            }
            parts.push((from, to.clone(), false));
            at = to;
        }
    }
    if at < piece.t1 {
        parts.push((at, piece.t1.clone(), true));
    }
    parts
}
