//! Planar polygons into triangles, by the first diagonal that holds.

use super::exact::{Int, cross, dot, is_zero, minus, sign};

/// Newell's sum over the border.
pub(crate) fn newell(points: &[[Int; 3]], face: &[usize]) -> [Int; 3] {
    let mut normal = [Int::ZERO, Int::ZERO, Int::ZERO];
    for (i, &from) in face.iter().enumerate() {
        let (p, q) = (&points[from], &points[face[(i + 1) % face.len()]]);
        for (axis, sum) in normal.iter_mut().enumerate() {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            *sum += (&p[u] - &q[u]) * (&p[v] + &q[v]);
        }
    }
    normal
}

/// Triangles of one face; none when its normal is zero.
///
/// A polygon of four or more corners is cut along the first diagonal that runs inside it and
/// touches its border at its two ends only; both parts are cut again. Holes must be joined to the
/// border by bridges (keyholes).
///
/// # Errors
/// A polygon that is not flat, or whose border crosses itself.
pub(crate) fn triangles(points: &[[Int; 3]], face: &[usize]) -> Result<Vec<[usize; 3]>, String> {
    let normal = newell(points, face);
    if is_zero(&normal) {
        return Ok(Vec::new());
    }
    let first = &points[face[0]];
    if face.iter().any(|&v| sign(&dot(&minus(&points[v], first), &normal)) != 0) {
        return Err("the face is not flat".into());
    }
    let mut done = Vec::new();
    let mut open = vec![face.to_vec()];
    let polygon = Polygon { points, normal };
    while let Some(part) = open.pop() {
        if part.len() == 3 {
            if polygon.turn(part[0], part[1], part[2]) <= 0 {
                return Err("a triangle of the face is turned over or flat".into());
            }
            done.push([part[0], part[1], part[2]]);
            continue;
        }
        let (i, j) = polygon.first_diagonal(&part).ok_or("the face has no diagonal")?;
        open.push(part[i..=j].to_vec());
        open.push(part[j..].iter().chain(&part[..=i]).copied().collect());
    }
    Ok(done)
}

struct Polygon<'a> {
    points: &'a [[Int; 3]],
    normal: [Int; 3],
}

impl Polygon<'_> {
    /// Which way a → b → c turns, seen from the side the normal points to.
    fn turn(&self, a: usize, b: usize, c: usize) -> i32 {
        let (u, v) =
            (minus(&self.points[b], &self.points[a]), minus(&self.points[c], &self.points[a]));
        sign(&dot(&cross(&u, &v), &self.normal))
    }

    /// Whether x, known to be on the line through a and b, lies between them, ends included.
    fn between(&self, a: usize, b: usize, x: usize) -> bool {
        let p = self.points;
        sign(&dot(&minus(&p[a], &p[x]), &minus(&p[b], &p[x]))) <= 0
    }

    fn first_diagonal(&self, part: &[usize]) -> Option<(usize, usize)> {
        let n = part.len();
        (0..n)
            .flat_map(|i| (i + 2..n).map(move |j| (i, j)))
            .find(|&(i, j)| (i, j) != (0, n - 1) && self.is_diagonal(part, i, j))
    }

    fn is_diagonal(&self, part: &[usize], i: usize, j: usize) -> bool {
        let (a, b) = (part[i], part[j]);
        a != b
            && self.points_inside(part, i, b)
            && self.points_inside(part, j, a)
            && (0..part.len()).all(|k| !self.touches(a, b, part[k], part[(k + 1) % part.len()]))
    }

    /// Whether the way from corner i toward x begins strictly inside the corner's angle.
    fn points_inside(&self, part: &[usize], i: usize, x: usize) -> bool {
        let n = part.len();
        let (before, at, after) = (part[(i + n - 1) % n], part[i], part[(i + 1) % n]);
        let left_of_after = self.turn(at, after, x) > 0;
        let left_of_before = self.turn(before, at, x) > 0;
        match self.turn(before, at, after) {
            1 => left_of_after && left_of_before,
            -1 => left_of_after || left_of_before,
            _ if self.ahead(at, before, after) => {
                // The border turns back on itself: everything but the side itself is inside.
                !(self.turn(at, after, x) == 0 && self.ahead(at, after, x))
            }
            _ => left_of_after,
        }
    }

    /// Whether a and b lie in the same direction from `at`; the three are on one line.
    fn ahead(&self, at: usize, a: usize, b: usize) -> bool {
        let p = self.points;
        sign(&dot(&minus(&p[a], &p[at]), &minus(&p[b], &p[at]))) > 0
    }

    /// Whether the closed side c–d meets the segment a–b anywhere but at a or b.
    fn touches(&self, a: usize, b: usize, c: usize, d: usize) -> bool {
        let (at_c, at_d) = (self.turn(a, b, c), self.turn(a, b, d));
        let inner = |x: usize| x != a && x != b && self.between(a, b, x);
        if at_c == 0 && inner(c) || at_d == 0 && inner(d) {
            return true;
        }
        if at_c == 0 && at_d == 0 {
            // On one line without an inner corner: the side covers a–b, or misses it.
            return self.between(c, d, a) && self.between(c, d, b);
        }
        // Ends on the line are a, b or outside; what is left is a proper crossing, or a side that
        // passes through an end of the diagonal that is no corner of the side.
        at_c * at_d < 0 && self.turn(c, d, a) * self.turn(c, d, b) <= 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area2_of(points: &[[i32; 2]], face: &[usize]) -> (Int, Int) {
        let points: Vec<[Int; 3]> =
            points.iter().map(|p| [p[0], p[1], p[0] + 2 * p[1]].map(Int::from)).collect();
        let of = |f: &[usize]| newell(&points, f)[2].clone();
        let parts = triangles(&points, face).unwrap();
        (of(face), parts.iter().map(|t| of(t)).fold(Int::ZERO, |a, b| a + b))
    }

    #[test]
    fn triangles_add_up_to_the_polygon() {
        let ring: Vec<usize> = (0..6).collect();
        let ell = [[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]];
        let flat_corner = [[0, 0], [1, 0], [2, 0], [2, 2], [0, 2], [0, 1]];
        for points in [ell, flat_corner] {
            let (whole, parts) = area2_of(&points, &ring);
            assert_eq!(whole, parts);
            let reversed: Vec<usize> = ring.iter().rev().copied().collect();
            let (whole, parts) = area2_of(&points, &reversed);
            assert_eq!(whole, parts);
        }
        let keyhole = [[0, 0], [4, 0], [4, 4], [0, 4], [1, 1], [1, 3], [3, 3], [3, 1]];
        for first in [0, 3] {
            let mut face = vec![0, 1, 2, 3];
            face.rotate_left(first);
            // Bridge from the first corner to a corner of the hole and back.
            let hole = if first == 0 { [4, 5, 6, 7, 4] } else { [5, 6, 7, 4, 5] };
            let start = face[0];
            face.push(start);
            face.extend(hole);
            let (whole, parts) = area2_of(&keyhole, &face);
            assert_eq!((whole.clone(), parts), (whole, Int::from(2 * 12)));
        }
    }
}
