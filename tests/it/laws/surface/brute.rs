//! What is visible of the lines of a grid, by brute force in integers, straight from the
//! definition: every edge against every triangle.

use hiddenline::stages::surface::Grid;

/// Twice as many bits as any determinant below needs for coordinates under 2¹⁵.
type Int = i128;

/// A point, or a direction when the last is 0.
pub(super) type Point = [Int; 4];

fn det3(a: [Int; 3], b: [Int; 3], c: [Int; 3]) -> Int {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

fn det4(rows: [Point; 4]) -> Int {
    (0..4)
        .map(|k| {
            let minor = |row: Point| {
                let mut kept = row.iter().enumerate().filter(|(i, _)| *i != k).map(|(_, v)| *v);
                std::array::from_fn(|_| kept.next().expect("three are left"))
            };
            let sign = if k % 2 == 0 { 1 } else { -1 };
            sign * rows[0][k] * det3(minor(rows[1]), minor(rows[2]), minor(rows[3]))
        })
        .sum()
}

/// A number as numerator and positive denominator.
#[derive(Debug, Clone, Copy)]
struct Ratio(Int, Int);

impl Ratio {
    fn new(p: Int, q: Int) -> Self {
        if q < 0 { Self(-p, -q) } else { Self(p, q) }
    }
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        (self.0 * other.1).cmp(&(other.0 * self.1))
    }
    fn value(&self) -> f64 {
        self.0 as f64 / self.1 as f64
    }
}

/// Cuts `[low, high]` to where the linear function with values `p` at 0 and `q` at 1 is ≥ 0.
fn cut(range: &mut (Ratio, Ratio), p: Int, q: Int) {
    use std::cmp::Ordering::{Greater, Less};
    if p < 0 && q < 0 {
        *range = (Ratio(1, 1), Ratio(0, 1));
        return;
    }
    if p >= 0 && q >= 0 {
        return;
    }
    let t = Ratio::new(p, p - q);
    if p < 0 {
        if range.0.cmp(&t) == Less {
            range.0 = t;
        }
    } else if range.1.cmp(&t) == Greater {
        range.1 = t;
    }
}

/// Visible intervals of the segment `p`–`q` among triangles, seen from `eye`.
fn visible(eye: Point, p: Point, q: Point, triangles: &[[Point; 3]]) -> Vec<(f64, f64)> {
    let mut hidden: [Vec<(Ratio, Ratio)>; 2] = [Vec::new(), Vec::new()];
    for &[a, b, c] in triangles {
        let facing = det4([a, b, c, eye]);
        if facing == 0 {
            continue;
        }
        let plane = |x: Point| -det4([a, b, c, x]) * facing.signum();
        if plane(p) == 0 && plane(q) == 0 {
            continue;
        }
        let mut range = (Ratio(0, 1), Ratio(1, 1));
        cut(&mut range, plane(p), plane(q));
        let mut sides = [true, true];
        for (a, b, c) in [(a, b, c), (b, c, a), (c, a, b)] {
            let inner = det4([eye, a, b, c]).signum();
            let border = |x: Point| det4([eye, a, b, x]) * inner;
            if border(p) == 0 && border(q) == 0 {
                let side = det4([eye, p, q, c]);
                sides[usize::from(side > 0)] = false;
            }
            cut(&mut range, border(p), border(q));
        }
        if range.0.cmp(&range.1) == std::cmp::Ordering::Less {
            for side in 0..2 {
                if sides[side] {
                    hidden[side].push(range);
                }
            }
        }
    }
    let mut places: Vec<Ratio> = vec![Ratio(0, 1), Ratio(1, 1)];
    places.extend(hidden.iter().flatten().flat_map(|range| [range.0, range.1]));
    places.sort_by(Ratio::cmp);
    let covered = |side: usize, from: &Ratio, to: &Ratio| {
        hidden[side].iter().any(|range| range.0.cmp(from).is_le() && range.1.cmp(to).is_ge())
    };
    let mut found: Vec<(f64, f64)> = Vec::new();
    for pair in places.windows(2) {
        let (from, to) = (&pair[0], &pair[1]);
        if from.cmp(to).is_eq() || (covered(0, from, to) && covered(1, from, to)) {
            continue;
        }
        match found.last_mut() {
            Some(last) if last.1 == from.value() => last.1 = to.value(),
            _ => found.push((from.value(), to.value())),
        }
    }
    found
}

/// Visible intervals of each grid edge, in the order of the engine's edges. Coordinates times
/// `scale` must be small integers; an orthographic eye has 0 in its last place.
pub(super) fn grid_lines(grid: &Grid, eye: Point, scale: f64) -> Vec<Vec<(f64, f64)>> {
    let (nx, ny) = (grid.xs().len(), grid.ys().len());
    let point = |i: usize, j: usize| -> Point {
        let p = grid.point((j * nx + i) as u32) * scale;
        assert!(p == p.round() && p.abs().max_element() < 32768.0, "{p} is no small integer");
        [p.x as Int, p.y as Int, p.z as Int, 1]
    };
    let mut triangles = Vec::new();
    for j in 0..ny - 1 {
        for i in 0..nx - 1 {
            let [a, b, c, d] = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    let along_x = (0..ny).flat_map(|j| (0..nx - 1).map(move |i| ((i, j), (i + 1, j))));
    let along_y = (0..nx).flat_map(|i| (0..ny - 1).map(move |j| ((i, j), (i, j + 1))));
    along_x
        .chain(along_y)
        .map(|(a, b)| {
            let (p, q) = (point(a.0, a.1), point(b.0, b.1));
            let d = |k: usize| [p[k], q[k], eye[k]];
            // An edge whose image is a point is left to the engine.
            let collinear = [(0, 1), (0, 2), (1, 2)]
                .iter()
                .all(|&(k, l)| det3(d(k), d(l), [1, 1, eye[3]]) == 0);
            if collinear { vec![(f64::NAN, f64::NAN)] } else { visible(eye, p, q, &triangles) }
        })
        .collect()
}

/// Length of the parts of 0..1 that are in one list of disjoint intervals but not in the other.
pub(super) fn difference(a: &[(f64, f64)], b: &[(f64, f64)]) -> f64 {
    let length = |list: &[(f64, f64)]| list.iter().map(|(from, to)| to - from).sum::<f64>();
    let common: f64 =
        a.iter().flat_map(|p| b.iter().map(move |q| (p.1.min(q.1) - p.0.max(q.0)).max(0.0))).sum();
    length(a) + length(b) - 2.0 * common
}

/// What is visible of one family of lines by the sentence that defines the floating horizon: at
/// least as high as all nearer lines of the family at the same u, or at most as high.
pub(super) fn one_family(
    grid: &Grid,
    eye: Point,
    scale: f64,
    along_x: bool,
) -> Vec<Vec<(f64, f64)>> {
    // Swapping x and y turns one family into the other and leaves heights alone.
    let swap = |p: Point| if along_x { p } else { [p[1], p[0], p[2], p[3]] };
    let (xs, ys) = if along_x { (grid.xs(), grid.ys()) } else { (grid.ys(), grid.xs()) };
    let eye = swap(eye);
    let point = |i: usize, j: usize| -> Point {
        let k = if along_x { j * xs.len() + i } else { i * ys.len() + j };
        let p = grid.point(k as u32) * scale;
        swap([p.x as Int, p.y as Int, p.z as Int, 1])
    };
    // How far a line lies from the eye across it, and on which side.
    let side = |j: usize| {
        if eye[3] == 0 { -eye[1] * point(0, j)[1] } else { point(0, j)[1] - eye[1] }
    };
    let nearer = |j: usize, than: usize| {
        if eye[3] == 0 {
            side(j) < side(than)
        } else {
            side(j) * side(than) > 0 && side(j).abs() < side(than).abs()
        }
    };
    let radial = |j: usize| {
        if eye[3] == 0 { eye[1] == 0 } else { side(j) == 0 }
    };
    // Twice the area of the plan triangle of the eye and two points.
    let plan =
        |a: Point, b: Point| det3([a[0], a[1], a[3]], [b[0], b[1], b[3]], [eye[0], eye[1], eye[3]]);
    let at = |f: (Int, Int), t: f64| f.0 as f64 * (1.0 - t) + f.1 as f64 * t;
    let mut lines = Vec::new();
    for j in 0..ys.len() {
        for i in 0..xs.len() - 1 {
            let (p, q) = (point(i, j), point(i + 1, j));
            if radial(j) {
                lines.push(vec![(0.0, 1.0)]);
                continue;
            }
            let mut tests = Vec::new();
            let mut places = vec![0.0, 1.0];
            for k in (0..ys.len()).filter(|&k| nearer(k, j)) {
                for l in 0..xs.len() - 1 {
                    let (a, b) = (point(l, k), point(l + 1, k));
                    let turn = plan(a, b).signum();
                    let from = (plan(a, p) * turn, plan(a, q) * turn);
                    let to = (plan(p, b) * turn, plan(q, b) * turn);
                    let up = det4([eye, a, b, [0, 0, 1, 0]]).signum();
                    let over = (det4([eye, a, b, p]) * up, det4([eye, a, b, q]) * up);
                    for f in [from, to, over] {
                        if f.0 != f.1 {
                            places.push((f.0 as f64 / (f.0 - f.1) as f64).clamp(0.0, 1.0));
                        }
                    }
                    tests.push((from, to, over));
                }
            }
            places.sort_by(f64::total_cmp);
            let mut found: Vec<(f64, f64)> = Vec::new();
            for pair in places.windows(2) {
                let t = (pair[0] + pair[1]) / 2.0;
                let heights = tests
                    .iter()
                    .filter(|(from, to, _)| at(*from, t) > 0.0 && at(*to, t) > 0.0)
                    .map(|(.., over)| if *over == (0, 0) { 0.0 } else { at(*over, t) });
                let (low, high) = heights
                    .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
                if pair[0] < pair[1] && (low >= 0.0 || high <= 0.0) {
                    match found.last_mut() {
                        Some(last) if last.1 == pair[0] => last.1 = pair[1],
                        _ => found.push((pair[0], pair[1])),
                    }
                }
            }
            lines.push(found);
        }
    }
    lines
}
