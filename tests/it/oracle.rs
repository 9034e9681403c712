//! The truth about hidden lines: all edges against all triangles, in exact integers.
//!
//! Written from the definition of "visible" alone and meant to be so simple that it is unlikely to
//! be wrong: conditions are linear forms, their zeros along an edge are fractions, and intervals
//! are merged by sorting those. It shares nothing with the library.
//!
//! The eye is a homogeneous point: (eye, 1) in perspective, (−forward, 0) in orthographic views,
//! so that one formula serves both.

pub(crate) mod crossings;
pub(crate) mod exact;
pub(crate) mod ray_cast;
pub(crate) mod triangulate;

use exact::{
    Int, Plane, Point, Ratio, common_exponent, cross, decomposed, dot, is_zero, minus, negated,
    plane_through, scaled, sign, value,
};
use std::collections::HashMap;
use triangulate::{newell, triangles};

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

/// One side of a triangle's kept part, seen from the eye.
struct Border {
    /// Through the side and the eye; positive on the inner side.
    plane: Plane,
    /// A corner of the kept part off the side.
    inner_corner: Point,
}

/// The part of a triangle in front of the near plane.
struct Cover {
    borders: Vec<Border>,
    /// The triangle's own plane; negative on the eye's side.
    plane: Plane,
    /// Squared length of the plane's normal, in scaled units.
    normal_squared: Int,
    image_box: Option<ImageBox>,
}

/// Lowest and highest image coordinates.
#[derive(Clone, Copy)]
struct ImageBox([f64; 2], [f64; 2]);

/// One triangle's part of an edge.
struct Hidden {
    t0: Ratio,
    t1: Ratio,
    left: bool,
    right: bool,
}

/// A scene turned into integers.
pub(crate) struct World {
    /// Distinct positions, in order of appearance.
    pub positions: Vec<[f64; 3]>,
    points: Vec<[Int; 3]>,
    /// Faces without repeated corners, of three corners or more.
    pub faces: Vec<Vec<usize>>,
    /// The unit of `points` is 2^exponent.
    exponent: i32,
    eye: Point,
    /// Positive in front of the near plane; `None` in orthographic views.
    near: Option<Plane>,
    sight: Sight,
}

impl World {
    pub(crate) fn new(positions: &[[f64; 3]], faces: &[Vec<u32>], sight: &Sight) -> Self {
        let mut of_position: HashMap<[u64; 3], usize> = HashMap::new();
        let mut distinct: Vec<[f64; 3]> = Vec::new();
        let vertex_of: Vec<usize> = positions
            .iter()
            .map(|&p| {
                let p = p.map(|x| if x == 0.0 { 0.0 } else { x });
                *of_position.entry(p.map(f64::to_bits)).or_insert_with(|| {
                    distinct.push(p);
                    distinct.len() - 1
                })
            })
            .collect();
        let faces = faces
            .iter()
            .map(|face| {
                let mut face: Vec<usize> = face.iter().map(|&v| vertex_of[v as usize]).collect();
                face.dedup();
                while face.len() > 1 && face.first() == face.last() {
                    face.pop();
                }
                face
            })
            .filter(|face| face.len() >= 3)
            .collect();

        let exponent = common_exponent(distinct.iter().chain([&sight.eye]).flatten().copied());
        let forward = sight.forward();
        let forward_exponent = common_exponent(forward);
        let forward = forward.map(|x| scaled(x, forward_exponent));
        let eye = sight.eye.map(|x| scaled(x, exponent));
        let (eye, near) = match sight.near {
            None => {
                let [x, y, z] = forward;
                ([-x, -y, -z, Int::ZERO], None)
            }
            Some(near) => {
                // (p − eye)·F − near F·F, where p and the eye count in 2^exponent and F in
                // 2^forward_exponent; all divided by both.
                let (mantissa, near_exponent) = decomposed(near);
                let part = Int::from(mantissa) * dot(&forward, &forward);
                let shift = near_exponent + forward_exponent - exponent;
                let (times, part) = if shift >= 0 {
                    (Int::ONE, part << shift as usize)
                } else {
                    (Int::ONE << (-shift) as usize, part)
                };
                let [x, y, z] = forward.clone().map(|f| f * &times);
                let last = -(dot(&eye, &forward) * &times + part);
                let [ex, ey, ez] = eye;
                ([ex, ey, ez, Int::ONE], Some([x, y, z, last]))
            }
        };
        Self {
            points: distinct.iter().map(|p| p.map(|x| scaled(x, exponent))).collect(),
            positions: distinct,
            faces,
            exponent,
            eye,
            near,
            sight: *sight,
        }
    }

    fn point(&self, vertex: usize) -> Point {
        let [x, y, z] = self.points[vertex].clone();
        [x, y, z, Int::ONE]
    }

    /// All triangles, with the vertices they have.
    ///
    /// # Errors
    /// A polygon that is not flat or crosses itself.
    pub(crate) fn triangles(&self) -> Result<Vec<[usize; 3]>, String> {
        let mut all = Vec::new();
        for face in &self.faces {
            all.extend(triangles(&self.points, face)?);
        }
        Ok(all)
    }

    /// Corners of the part of a triangle that the near plane keeps.
    fn kept_part(&self, triangle: [usize; 3]) -> Vec<Point> {
        let corners = triangle.map(|v| self.point(v));
        let Some(near) = &self.near else {
            return corners.to_vec();
        };
        let heights = [0, 1, 2].map(|i| value(near, &corners[i]));
        let mut kept = Vec::new();
        for i in 0..3 {
            let j = (i + 1) % 3;
            if sign(&heights[i]) >= 0 {
                kept.push(corners[i].clone());
            }
            if sign(&heights[i]) * sign(&heights[j]) < 0 {
                // The weights are those of the other end's distance, both positive.
                let (a, b) = if sign(&heights[i]) > 0 { (i, j) } else { (j, i) };
                let (of_a, of_b) = (-&heights[b], &heights[a]);
                kept.push([0, 1, 2, 3].map(|k| &corners[a][k] * &of_a + &corners[b][k] * of_b));
            }
        }
        kept
    }

    /// What of a triangle can cover; `None` for one behind the near plane, edge-on or without area.
    fn cover(&self, triangle: [usize; 3], boxes: bool) -> Option<Cover> {
        let [a, b, c] = triangle.map(|v| self.point(v));
        let mut plane = plane_through(&a, &b, &c);
        match sign(&value(&plane, &self.eye)) {
            0 => return None,
            1 => plane = negated(plane),
            _ => {}
        }
        let kept = self.kept_part(triangle);
        if kept.len() < 3 {
            return None;
        }
        let borders = (0..kept.len())
            .map(|i| {
                let n = kept.len();
                let inner_corner = kept[(i + 2) % n].clone();
                let plane = plane_through(&kept[i], &kept[(i + 1) % n], &self.eye);
                let plane = match sign(&value(&plane, &inner_corner)) {
                    0 => panic!("a kept part without area that is not edge-on"),
                    1 => plane,
                    _ => negated(plane),
                };
                Border { plane, inner_corner }
            })
            .collect();
        let normal_squared = &plane[0] * &plane[0] + &plane[1] * &plane[1] + &plane[2] * &plane[2];
        let image_box = if boxes { self.image_box(&triangle) } else { None };
        Some(Cover { borders, plane, normal_squared, image_box })
    }

    /// A box around the image, a little too large; `None` when a vertex is not well in front.
    fn image_box(&self, vertices: &[usize]) -> Option<ImageBox> {
        let forward = self.sight.forward();
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        // Any two directions across the view will do: those of the axes other than the main one.
        let main = (0..3).max_by(|&i, &j| forward[i].abs().total_cmp(&forward[j].abs()))?;
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        let mut size = 0.0f64;
        for &v in vertices {
            let d = [0, 1, 2].map(|i| self.positions[v][i] - self.sight.eye[i]);
            let depth = dot(d, forward) / forward[main];
            let lengths = d.map(f64::abs);
            let spread = lengths[0].max(lengths[1]).max(lengths[2]);
            for (k, axis) in [(main + 1) % 3, (main + 2) % 3].into_iter().enumerate() {
                let x = if self.near.is_some() {
                    // Well in front: no cancellation in the depth to speak of.
                    if depth * forward[main].signum() < 1e-3 * spread {
                        return None;
                    }
                    size = size.max(1e3 * spread / depth.abs());
                    d[axis] / depth
                } else {
                    let t = dot(d, forward) / dot(forward, forward);
                    size = size.max(spread);
                    d[axis] - t * forward[axis]
                };
                (low[k], high[k]) = (low[k].min(x), high[k].max(x));
            }
        }
        let margin = 1e-6 * size;
        Some(ImageBox(low.map(|x| x - margin), high.map(|x| x + margin)))
    }

    /// What `cover` hides of the edge within t0..t1.
    fn hidden_part(
        &self,
        cover: &Cover,
        ends: [&Point; 2],
        kept: (&Ratio, &Ratio),
        tolerance: f64,
    ) -> Option<Hidden> {
        let [p, q] = ends;
        let behind = [value(&cover.plane, p), value(&cover.plane, q)];
        if tolerance > 0.0 && behind.iter().all(|b| self.is_within(b, cover, tolerance)) {
            return None;
        }
        // Strictly behind the plane somewhere.
        if behind.iter().all(|b| sign(b) <= 0) {
            return None;
        }
        self.image_part(cover, ends, kept, vec![behind])
    }

    /// Where the edge's image lies in that of `cover` and the conditions, given by their values at
    /// both ends, hold.
    fn image_part(
        &self,
        cover: &Cover,
        [p, q]: [&Point; 2],
        kept: (&Ratio, &Ratio),
        mut conditions: Vec<[Int; 2]>,
    ) -> Option<Hidden> {
        let (mut t0, mut t1) = (kept.0.clone(), kept.1.clone());
        let (mut left, mut right) = (true, true);
        for border in &cover.borders {
            let inside = [value(&border.plane, p), value(&border.plane, q)];
            match (sign(&inside[0]), sign(&inside[1])) {
                (0, 0) => {
                    // The image runs along this border: only the inner side is covered.
                    let line = plane_through(p, q, &self.eye);
                    if sign(&value(&line, &border.inner_corner)) > 0 {
                        right = false;
                    } else {
                        left = false;
                    }
                }
                (a, b) if a <= 0 && b <= 0 => return None,
                _ => conditions.push(inside),
            }
        }
        for [at_p, at_q] in conditions {
            // at_p (1 − t) + at_q t is zero at at_p / (at_p − at_q).
            let (from, to) = (sign(&at_p), sign(&at_q));
            if from < 0 {
                t0 = t0.max(Ratio::new(at_p.clone(), at_p - at_q));
            } else if to < 0 {
                t1 = t1.min(Ratio::new(at_p.clone(), at_p - at_q));
            }
        }
        (t0 < t1).then_some(Hidden { t0, t1, left, right })
    }

    /// Whether the point with this value in the triangle's plane is at most `tolerance` away.
    fn is_within(&self, value: &Int, cover: &Cover, tolerance: f64) -> bool {
        // |value| / |normal| counts in 2^exponent.
        let (mantissa, exponent) = decomposed(tolerance);
        let limit = Int::from(mantissa) * Int::from(mantissa) * &cover.normal_squared;
        let shift = 2 * (exponent - self.exponent);
        let square = value * value;
        if shift >= 0 {
            square <= limit << shift as usize
        } else {
            square << (-shift) as usize <= limit
        }
    }

    /// The t that the near plane keeps of an edge; `None` when that is a point or nothing.
    fn kept_range(&self, p: &Point, q: &Point) -> Option<(Ratio, Ratio)> {
        let whole = (Ratio::integer(0), Ratio::integer(1));
        let Some(near) = &self.near else {
            return Some(whole);
        };
        let (at_p, at_q) = (value(near, p), value(near, q));
        match (sign(&at_p), sign(&at_q)) {
            (a, b) if a >= 0 && b >= 0 => Some(whole),
            (a, b) if a <= 0 && b <= 0 => None,
            (a, _) => {
                let cut = Ratio::new(at_p.clone(), at_p - at_q);
                Some(if a > 0 { (whole.0, cut) } else { (cut, whole.1) })
            }
        }
    }

    /// −1, 0 or 1: whether a face shows its back, its rim or its front.
    fn facing(&self, face: &[usize], normal: &[Int; 3]) -> i32 {
        let [x, y, z, w] = &self.eye;
        let p = &self.points[face[0]];
        let to_eye = [x - w * &p[0], y - w * &p[1], z - w * &p[2]];
        sign(&dot(normal, &to_eye))
    }

    /// Whether a face's normal, computed in `f64`, could be off by more than 1e-9 of its length.
    fn is_sliver(&self, face: usize, normal: &[Int; 3]) -> bool {
        let corners = || self.faces[face].iter().map(|&v| self.positions[v]);
        let largest = corners().flatten().fold(0.0, |a: f64, x| a.max(x.abs()));
        let spread = |k: usize| {
            let (low, high) = corners()
                .map(|p| p[k])
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
            high - low
        };
        let size = (0..3).map(spread).fold(0.0, f64::max);
        // The normal's unit is 2^exponent squared; it has the size of an area.
        let area = normal.clone().map(|x| Ratio::new(x, Int::ONE).to_f64().abs());
        let area = area.iter().fold(0.0, |a: f64, &x| a.max(x));
        area * 2f64.powi(2 * self.exponent) <= 1e-6 * size * largest
    }

    fn image_is_point(&self, a: usize, b: usize) -> bool {
        let [x, y, z, w] = &self.eye;
        let (p, q) = (&self.points[a], &self.points[b]);
        let to_eye = [x - w * &p[0], y - w * &p[1], z - w * &p[2]];
        is_zero(&cross(&minus(q, p), &to_eye))
    }
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

fn are_apart(a: Option<ImageBox>, b: Option<ImageBox>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => (0..2).any(|k| a.1[k] < b.0[k] || b.1[k] < a.0[k]),
        _ => false,
    }
}
