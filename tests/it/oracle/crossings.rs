//! Where triangles cross: all pairs of them, in exact integers.
//!
//! Two surfaces cross along a piece of a line when, going around it, one of them is met on both
//! sides of the other. A surface at a line is a triangle through which the line runs, or all
//! triangles along one edge.

use super::exact::{Int, Plane, Point, Ratio, cross, dot, is_zero, sign};
use super::{Angle, Cover, EdgeTruth, Hidden, World, pieces};
use std::collections::BTreeMap;

/// A piece of a line in which surfaces cross, with exact ends.
pub(crate) struct Crossing {
    pub ends: [Point; 2],
}

/// A line in space: points are `(base + s direction / direction²)`, where s = direction · point.
struct Line {
    direction: [Int; 3],
    /// Times the square of the direction.
    base: [Int; 3],
    square: Int,
}

/// What a triangle is at a line that lies in its plane.
struct Sheet {
    /// The triangle that the line runs through, or the edge or diagonal of a face that it runs
    /// along.
    surface: Surface,
    from: Ratio,
    to: Ratio,
    /// Directions off the line into the triangle.
    sides: Vec<[Int; 3]>,
}

#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Surface {
    Triangle(usize),
    Edge(usize, usize),
    Diagonal(usize, usize, usize),
}

/// A part of a face.
struct Triangle<'w> {
    corners: [usize; 3],
    face: usize,
    border: &'w [usize],
}

impl Triangle<'_> {
    fn side(&self, a: usize, b: usize) -> Surface {
        let n = self.border.len();
        let is_edge = (0..n).any(|i| {
            let pair = [self.border[i], self.border[(i + 1) % n]];
            pair == [a, b] || pair == [b, a]
        });
        let (a, b) = (a.min(b), a.max(b));
        if is_edge { Surface::Edge(a, b) } else { Surface::Diagonal(self.face, a, b) }
    }
}

impl Line {
    /// Of two planes; `None` when they are parallel.
    fn between(a: &([Int; 3], Int), b: &([Int; 3], Int)) -> Option<Self> {
        let direction = cross(&a.0, &b.0);
        if is_zero(&direction) {
            return None;
        }
        let (u, v) = (cross(&b.0, &direction), cross(&direction, &a.0));
        let base = [0, 1, 2].map(|i| &a.1 * &u[i] + &b.1 * &v[i]);
        let square = dot(&direction, &direction);
        Some(Self { direction, base, square })
    }

    fn at(&self, s: &Ratio) -> Point {
        let [x, y, z] =
            [0, 1, 2].map(|i| &self.base[i] * &s.denominator + &self.direction[i] * &s.numerator);
        [x, y, z, &self.square * &s.denominator]
    }

    fn sheet(&self, number: usize, triangle: &Triangle, points: &[[Int; 3]]) -> Option<Sheet> {
        let corners = triangle.corners;
        let (normal, height) = plane(corners, points);
        let in_plane = sign(&dot(&normal, &self.direction)) == 0
            && dot(&normal, &self.base) == &height * &self.square;
        if is_zero(&normal) || !in_plane {
            return None;
        }
        let off = cross(&normal, &self.direction);
        let at = dot(&off, &self.base);
        let off_line = corners.map(|c| dot(&off, &points[c]) * &self.square - &at);
        let along = corners.map(|c| dot(&self.direction, &points[c]));
        let mut met = Vec::new();
        for i in 0..3 {
            let j = (i + 1) % 3;
            if sign(&off_line[i]) == 0 {
                met.push(Ratio::new(along[i].clone(), Int::ONE));
            } else if sign(&off_line[i]) * sign(&off_line[j]) < 0 {
                met.push(Ratio::new(
                    &along[i] * &off_line[j] - &along[j] * &off_line[i],
                    &off_line[j] - &off_line[i],
                ));
            }
        }
        met.sort();
        let (from, to) = (met.first()?.clone(), met.last()?.clone());
        if from == to {
            return None;
        }
        let on: Vec<usize> = (0..3).filter(|&i| sign(&off_line[i]) == 0).collect();
        let back = off.clone().map(|x| -x);
        let (surface, sides) = if let [i, j] = on[..] {
            let (a, b) = (corners[i], corners[j]);
            let third = 3 - i - j;
            let side = if sign(&off_line[third]) > 0 { off } else { back };
            (triangle.side(a, b), vec![side])
        } else {
            (Surface::Triangle(number), vec![off, back])
        };
        Some(Sheet { surface, from, to, sides })
    }

    /// Where `x` comes, going around from `start`: same direction, first half, opposite, second.
    fn half(&self, start: &[Int; 3], x: &[Int; 3]) -> i32 {
        match (sign(&dot(&self.direction, &cross(start, x))), sign(&dot(start, x))) {
            (0, 1) => 0,
            (1, _) => 1,
            (0, _) => 2,
            _ => 3,
        }
    }

    /// Whether `x` comes strictly before `y`, going around from `start`.
    fn is_before(&self, start: &[Int; 3], x: &[Int; 3], y: &[Int; 3]) -> bool {
        let (of_x, of_y) = (self.half(start, x), self.half(start, y));
        of_x < of_y || (of_x == of_y && sign(&dot(&self.direction, &cross(x, y))) > 0)
    }

    fn cross_each_other(&self, a: &[&[Int; 3]], b: &[&[Int; 3]]) -> bool {
        a.iter().any(|start| {
            let starts = |x: &&&[Int; 3]| self.half(start, x) == 0;
            a.iter().filter(|end| !starts(end)).any(|end| {
                let others = || b.iter().filter(|x| !starts(x));
                others().any(|x| self.is_before(start, x, end))
                    && others().any(|x| self.is_before(start, end, x))
            })
        })
    }
}

fn plane(corners: [usize; 3], points: &[[Int; 3]]) -> ([Int; 3], Int) {
    let [a, b, c] = corners.map(|corner| &points[corner]);
    let minus = |p: &[Int; 3]| [0, 1, 2].map(|i| &p[i] - &a[i]);
    let normal = cross(&minus(b), &minus(c));
    let height = dot(&normal, a);
    (normal, height)
}

impl World {
    /// Every piece of a line in which surfaces cross, possibly several times.
    pub(crate) fn crossings(&self) -> Result<Vec<Crossing>, String> {
        let mut triangles = Vec::new();
        for (face, border) in self.faces.iter().enumerate() {
            for corners in super::triangulate::triangles(&self.points, border)? {
                triangles.push(Triangle { corners, face, border });
            }
        }
        let planes: Vec<_> = triangles.iter().map(|t| plane(t.corners, &self.points)).collect();
        let mut found = Vec::new();
        for i in 0..triangles.len() {
            for j in 0..i {
                let Some(line) = Line::between(&planes[i], &planes[j]) else { continue };
                let sheet = |t: usize| line.sheet(t, &triangles[t], &self.points);
                let (Some(a), Some(b)) = (sheet(i), sheet(j)) else { continue };
                let from = a.from.clone().max(b.from.clone());
                let to = a.to.clone().min(b.to.clone());
                if from >= to {
                    continue;
                }
                let sheets: Vec<Sheet> = (0..triangles.len()).filter_map(sheet).collect();
                let ends = sheets.iter().flat_map(|s| [s.from.clone(), s.to.clone()]);
                let mut cuts: Vec<Ratio> = ends
                    .filter(|s| *s > from && *s < to)
                    .chain([from.clone(), to.clone()])
                    .collect();
                cuts.sort();
                cuts.dedup();
                for cut in cuts.windows(2) {
                    let mut surfaces: BTreeMap<_, Vec<&[Int; 3]>> = BTreeMap::new();
                    for s in sheets.iter().filter(|s| s.from <= cut[0] && s.to >= cut[1]) {
                        surfaces.entry(s.surface).or_default().extend(&s.sides);
                    }
                    let both = [&a, &b].map(|sheet| &surfaces[&sheet.surface]);
                    if a.surface != b.surface && line.cross_each_other(both[0], both[1]) {
                        let ends = [line.at(&cut[0]), line.at(&cut[1])];
                        found.push(Crossing { ends });
                    }
                }
            }
        }
        Ok(found)
    }

    /// A point in the scene's own unit, rounded.
    pub(crate) fn rounded(&self, p: &Point) -> [f64; 3] {
        let unit = 2f64.powi(self.exponent);
        [0, 1, 2].map(|i| Ratio::new(p[i].clone(), p[3].clone()).to_f64() * unit)
    }

    /// What is hidden of any segment between two points; `ends` only names it.
    pub(crate) fn segment_truth(&self, points: [&Point; 2], ends: [[f64; 3]; 2]) -> EdgeTruth {
        // The same w for both makes t run evenly in space.
        let [p, q] = [(points[0], &points[1][3]), (points[1], &points[0][3])]
            .map(|(point, times)| point.clone().map(|x| x * times));
        let covers: Vec<Cover> = self
            .triangles()
            .unwrap_or_default()
            .into_iter()
            .filter_map(|triangle| self.cover(triangle, false))
            .collect();
        let eye: &Plane = &self.eye;
        let to_eye = [0, 1, 2].map(|i| &eye[i] * &p[3] - &eye[3] * &p[i]);
        let along = [0, 1, 2].map(|i| &q[i] - &p[i]);
        let image_is_point = is_zero(&cross(&along, &to_eye));
        let pieces = match self.kept_range(&p, &q) {
            Some(kept) if !image_is_point => {
                let hidden = |cover: &Cover| -> Option<Hidden> {
                    self.hidden_part(cover, [&p, &q], (&kept.0, &kept.1), 0.0)
                };
                let hidden: Vec<Hidden> = covers.iter().filter_map(hidden).collect();
                pieces(kept, &hidden)
            }
            _ => Vec::new(),
        };
        EdgeTruth {
            ends,
            n_uses: 0,
            silhouette: None,
            angle: Angle::Unknown,
            image_is_point,
            pieces,
            image_pieces: Vec::new(),
        }
    }
}
