//! The truth about hidden lines: all edges against all triangles, in exact integers.
//!
//! Written from the definition of "visible" alone and meant to be so simple that it is unlikely to
//! be wrong: conditions are linear forms, their zeros along an edge are fractions, and intervals
//! are merged by sorting those. It shares nothing with the library.
//!
//! The eye is a homogeneous point: (eye, 1) in perspective, (−forward, 0) in orthographic views,
//! so that one formula serves both.

pub(crate) mod compare;
mod cover;
pub(crate) mod crossings;
pub(crate) mod exact;
pub(crate) mod hatch;
pub(crate) mod ray_cast;
pub(crate) mod sight_lines;
pub(crate) mod triangulate;
mod world;

use cover::{Cover, Hidden, are_apart};
use exact::{Int, Ratio, cross, dot, is_zero, sign};
use std::collections::HashMap;
use triangulate::newell;
pub(crate) use world::World;

/// The camera's numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sight {
    pub eye: [f64; 3],
    pub target: [f64; 3],
    pub up: [f64; 3],
    /// The near plane in parts of the way to the target; `None` in orthographic views.
    pub near: Option<f64>,
}

impl Sight {
    /// `target − eye`, rounded once; exact from here on.
    pub(crate) fn forward(&self) -> [f64; 3] {
        [0, 1, 2].map(|i| self.target[i] - self.eye[i])
    }
}

/// What an edge is, before any option selects it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Kind {
    Boundary,
    Nonmanifold,
    Silhouette,
    Crease,
    Mesh,
}

/// The angle between the normals of an edge's two faces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Angle {
    /// Exactly none.
    Zero,
    Cosine(f64),
    /// No two faces, or one with next to no area.
    Unknown,
}

/// A maximal part of an edge with one count of covering triangles.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Piece {
    pub t0: Ratio,
    pub t1: Ratio,
    /// The smaller count of its two sides; 0 is visible.
    pub qi: u32,
}

/// Everything the definition says about one edge.
#[derive(Clone, Debug)]
pub(crate) struct EdgeTruth {
    /// Its two ends, the smaller first (by x, then y, then z); t runs from the first.
    pub ends: [[f64; 3]; 2],
    /// How many times the border of a face runs along it.
    pub n_uses: usize,
    /// For two uses, whether one face is front and one is not; `None` when undecidable.
    pub silhouette: Option<bool>,
    pub angle: Angle,
    pub image_is_point: bool,
    /// In order of t and without gaps; empty when nothing is kept or the image is a point.
    pub pieces: Vec<Piece>,
    /// The same for triangles at any depth, the edge's own too: where this is 0 nothing but the
    /// background is seen on one side of the edge. Empty for lines of intersection.
    pub image_pieces: Vec<Piece>,
}

impl EdgeTruth {
    /// Whether the edge is a crease; `None` when that cannot be told.
    pub(crate) fn crease(&self, threshold_deg: f64) -> Option<bool> {
        match self.angle {
            Angle::Zero => Some(false),
            Angle::Cosine(cosine) => {
                let limit = threshold_deg.to_radians().cos();
                ((cosine - limit).abs() > 1e-9).then_some(cosine < limit)
            }
            Angle::Unknown => None,
        }
    }

    /// All kinds that apply, the one to be written first; `None` when that cannot be told.
    pub(crate) fn kinds(&self, threshold_deg: f64) -> Option<Vec<Kind>> {
        match self.n_uses {
            1 => return Some(vec![Kind::Boundary]),
            2 => {}
            _ => return Some(vec![Kind::Nonmanifold]),
        }
        let mut kinds = Vec::new();
        if self.silhouette? {
            kinds.push(Kind::Silhouette);
        }
        if self.crease(threshold_deg)? {
            kinds.push(Kind::Crease);
        }
        if kinds.is_empty() {
            kinds.push(Kind::Mesh);
        }
        Some(kinds)
    }
}

/// How the truth is computed.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Settings {
    /// A triangle does not cover an edge both of whose ends lie within this distance of its plane.
    pub contact_tolerance: f64,
    /// Leaves out pairs whose boxes in the image, computed in `f64`, are clearly apart: by a
    /// thousandth of the image in perspective and a millionth of the distance in orthographic
    /// views, many times the rounding error.
    pub reject_by_boxes: bool,
}

/// The truth about every edge of a scene, ordered by their ends.
///
/// # Errors
/// A polygon that is not flat or crosses itself: what covers is not defined by its border alone.
pub(crate) fn truth(
    positions: &[[f64; 3]],
    faces: &[Vec<u32>],
    sight: &Sight,
    settings: Settings,
) -> Result<Vec<EdgeTruth>, String> {
    let world = World::new(positions, faces, sight);
    let covers: Vec<Cover> = world
        .triangles()?
        .into_iter()
        .filter_map(|t| world.cover(t, settings.reject_by_boxes))
        .collect();

    // (lower vertex, higher vertex) → (face, whether it runs from the lower one).
    let mut uses: HashMap<(usize, usize), Vec<(usize, bool)>> = HashMap::new();
    let normals: Vec<_> = world.faces.iter().map(|f| newell(&world.points, f)).collect();
    for (f, face) in world.faces.iter().enumerate() {
        for (i, &a) in face.iter().enumerate() {
            let b = face[(i + 1) % face.len()];
            uses.entry((a.min(b), a.max(b))).or_default().push((f, a < b));
        }
    }

    let mut edges: Vec<EdgeTruth> = uses
        .into_iter()
        .map(|((a, b), uses)| {
            let is_less = |a: usize, b: usize| world.positions[a] < world.positions[b];
            let (a, b) = if is_less(a, b) { (a, b) } else { (b, a) };
            let (mut silhouette, mut between) = (None, Angle::Unknown);
            if let [(f, f_up), (g, g_up)] = uses[..] {
                let normal_of_g = normals[g].clone();
                let flip = f_up == g_up;
                let normal_of_g = if flip { normal_of_g.map(|x| -x) } else { normal_of_g };
                let has_area = !is_zero(&normals[f]) && !is_zero(&normals[g]);
                if !world.is_sliver(f, &normals[f]) && !world.is_sliver(g, &normals[g]) {
                    between = angle(&normals[f], &normal_of_g);
                }
                let at_f = world.facing(&world.faces[f], &normals[f]);
                let at_g = world.facing(&world.faces[g], &normal_of_g);
                let decidable = has_area && !(flip && at_f * at_g == 0);
                silhouette = decidable.then_some((at_f > 0) != (at_g > 0));
            }
            let image_is_point = world.image_is_point(a, b);
            let (p, q) = (world.point(a), world.point(b));
            let (pieces, image_pieces) = match world.kept_range(&p, &q) {
                Some(kept) if !image_is_point => {
                    let edge_box =
                        if settings.reject_by_boxes { world.image_box(&[a, b]) } else { None };
                    let near = || covers.iter().filter(|c| !are_apart(edge_box, c.image_box));
                    let range = (&kept.0, &kept.1);
                    let in_image: Vec<Hidden> = near()
                        .filter_map(|c| world.image_part(c, [&p, &q], range, Vec::new()))
                        .collect();
                    let hidden: Vec<Hidden> = near()
                        .filter_map(|c| {
                            let tolerance = settings.contact_tolerance;
                            world.hidden_part(c, [&p, &q], range, tolerance)
                        })
                        .collect();
                    (pieces(kept.clone(), &hidden), pieces(kept, &in_image))
                }
                _ => (Vec::new(), Vec::new()),
            };
            EdgeTruth {
                ends: [world.positions[a], world.positions[b]],
                n_uses: uses.len(),
                silhouette,
                angle: between,
                image_is_point,
                pieces,
                image_pieces,
            }
        })
        .collect();
    edges.sort_by(|a, b| a.ends.partial_cmp(&b.ends).unwrap());
    Ok(edges)
}

/// The cosine of the angle between two vectors.
fn angle(a: &[Int; 3], b: &[Int; 3]) -> Angle {
    if is_zero(a) || is_zero(b) {
        return Angle::Unknown;
    }
    let product = dot(a, b);
    if is_zero(&cross(a, b)) && sign(&product) > 0 {
        return Angle::Zero;
    }
    let square = Ratio::new(&product * &product, dot(a, a) * dot(b, b)).to_f64();
    Angle::Cosine(f64::from(sign(&product)) * square.sqrt())
}

/// Counts the coverings of every elementary interval between two cuts, and joins equal ones.
fn pieces(kept: (Ratio, Ratio), hidden: &[Hidden]) -> Vec<Piece> {
    let mut cuts = vec![kept.0, kept.1];
    cuts.extend(hidden.iter().flat_map(|h| [h.t0.clone(), h.t1.clone()]));
    cuts.sort();
    cuts.dedup();
    let mut pieces: Vec<Piece> = Vec::new();
    for pair in cuts.windows(2) {
        let over = || hidden.iter().filter(|h| h.t0 <= pair[0] && h.t1 >= pair[1]);
        let left = over().filter(|h| h.left).count();
        let right = over().filter(|h| h.right).count();
        let qi = left.min(right) as u32;
        match pieces.last_mut() {
            Some(last) if last.qi == qi => last.t1 = pair[1].clone(),
            _ => pieces.push(Piece { t0: pair[0].clone(), t1: pair[1].clone(), qi }),
        }
    }
    pieces
}
