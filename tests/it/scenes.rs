//! Scenes: small, with integer coordinates, and full of things that touch, align and coincide.
//!
//! `random(seed)` is a pure function of its seed, so a failure that prints its seed can be repeated.

use crate::oracle::Sight;

pub(crate) type P = [f64; 3];

/// A model and a camera.
#[derive(Clone, Debug)]
pub(crate) struct Scene {
    pub name: String,
    pub positions: Vec<P>,
    pub faces: Vec<Vec<u32>>,
    pub sight: Sight,
    /// Whether coordinates are tenths, so that coincidences hold only nearly.
    pub is_in_tenths: bool,
}

/// How many random scenes to run: `n`, or what the environment variable HIDDENLINE_SCENES says.
pub(crate) fn number_of_scenes(n: u64) -> u64 {
    std::env::var("HIDDENLINE_SCENES").ok().and_then(|s| s.parse().ok()).unwrap_or(n)
}

pub(crate) fn orthographic(direction: P, up: P) -> Sight {
    Sight { eye: [0.0; 3], target: direction, up, near: None }
}

pub(crate) fn perspective(eye: P, target: P, near: f64) -> Sight {
    let forward = [0, 1, 2].map(|i| target[i] - eye[i]);
    let up = if forward[0] == 0.0 && forward[1] == 0.0 { [0.0, 1.0, 0.0] } else { [0.0, 0.0, 1.0] };
    Sight { eye, target, up, near: Some(near) }
}

/// splitmix64.
pub(crate) struct Rng(pub u64);

impl Rng {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    /// An integer from `low` to `high`, both included.
    pub(crate) fn integer(&mut self, low: i32, high: i32) -> f64 {
        f64::from(low + self.below((high - low + 1) as usize) as i32)
    }

    pub(crate) fn one_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }

    pub(crate) fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len())]
    }

    pub(crate) fn point(&mut self, low: i32, high: i32) -> P {
        [0; 3].map(|_| self.integer(low, high))
    }

    pub(crate) fn shuffle<T>(&mut self, list: &mut [T]) {
        for i in (1..list.len()).rev() {
            list.swap(i, self.below(i + 1));
        }
    }
}

/// Positions and faces in the making; vertices of different objects are not shared.
#[derive(Default)]
pub(crate) struct Model {
    pub positions: Vec<P>,
    pub faces: Vec<Vec<u32>>,
}

impl Model {
    pub(crate) fn face(&mut self, corners: &[P]) {
        let first = self.positions.len() as u32;
        self.positions.extend_from_slice(corners);
        self.faces.push((first..first + corners.len() as u32).collect());
    }

    /// Six outward squares.
    pub(crate) fn add_box(&mut self, a: P, b: P) {
        for corners in box_faces(a, b) {
            self.face(&corners);
        }
    }

    pub(crate) fn seen_by(self, name: impl Into<String>, sight: Sight) -> Scene {
        let (positions, faces) = (self.positions, self.faces);
        Scene { name: name.into(), positions, faces, sight, is_in_tenths: false }
    }
}

fn box_faces(a: P, b: P) -> [[P; 4]; 6] {
    let corner = |i: usize| [0, 1, 2].map(|k| if i >> k & 1 == 0 { a[k] } else { b[k] });
    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
        .map(|f| f.map(corner))
}

fn plus(p: P, times: f64, d: P) -> P {
    [0, 1, 2].map(|i| p[i] + times * d[i])
}

/// A few objects and a camera, all decided by the seed.
pub(crate) fn random(seed: u64) -> Scene {
    let mut rng = Rng(seed);
    let mut model = Model::default();
    let mut boxes: Vec<(P, P)> = Vec::new();
    let n_objects = 1 + rng.below(4);
    for _ in 0..n_objects {
        if model.faces.len() > 14 {
            break;
        }
        match rng.below(12) {
            0..=5 => add_random_box(&mut rng, &mut model, &mut boxes),
            6 => add_triangles(&mut rng, &mut model),
            7 => add_tetrahedron(&mut rng, &mut model),
            8 => add_fin(&mut rng, &mut model),
            9 => add_polygon(&mut rng, &mut model),
            10 => add_sheet(&mut rng, &mut model),
            _ => add_doubtful_faces(&mut rng, &mut model, &boxes),
        }
    }
    if model.faces.is_empty() {
        add_tetrahedron(&mut rng, &mut model); // all that there was has been removed
    }
    let sight = random_sight(&mut rng, &model);
    if rng.one_in(4) {
        rng.shuffle(&mut model.faces);
    }
    let mut scene = model.seen_by(format!("seed {seed}"), sight);
    if rng.one_in(16) {
        scene = in_tenths(scene);
    }
    scene
}

fn add_random_box(rng: &mut Rng, model: &mut Model, boxes: &mut Vec<(P, P)>) {
    let size = [0; 3].map(|_| rng.integer(1, 3));
    let mut low = rng.point(-3, 2);
    let mut size = size;
    if let Some(&(a, b)) = boxes.last() {
        match rng.below(6) {
            // The same box again.
            0 => (low, size) = (a, [0, 1, 2].map(|k| b[k] - a[k])),
            // Beside, on top or below, aligned on the other axes or not.
            1 | 2 => {
                let axis = rng.below(3);
                if rng.one_in(2) {
                    (low, size) = (a, [0, 1, 2].map(|k| b[k] - a[k]));
                }
                low[axis] = if rng.one_in(2) { b[axis] } else { a[axis] - size[axis] };
            }
            // The same box somewhere along an axis or a diagonal.
            3 => {
                let d = rng.point(-1, 1);
                (low, size) = (plus(a, 4.0, d), [0, 1, 2].map(|k| b[k] - a[k]));
            }
            _ => {}
        }
    }
    let high = [0, 1, 2].map(|k| low[k] + size[k]);
    boxes.push((low, high));
    let style = rng.below(4);
    for mut corners in box_faces(low, high) {
        if style == 0 && rng.one_in(4) {
            continue; // removed
        }
        if style == 1 && rng.one_in(4) {
            corners.reverse();
        }
        corners.rotate_left(rng.below(4));
        if style >= 2 && rng.one_in(2) {
            model.face(&corners[..3]);
            model.face(&[corners[0], corners[2], corners[3]]);
        } else {
            model.face(&corners);
        }
        if style == 1 && rng.one_in(8) {
            model.face(&corners); // twice
        }
    }
}

fn add_triangles(rng: &mut Rng, model: &mut Model) {
    for _ in 0..1 + rng.below(3) {
        let corners = [0; 3].map(|_| rng.point(-4, 4));
        model.face(&corners);
    }
}

fn add_tetrahedron(rng: &mut Rng, model: &mut Model) {
    let [a, b, c, d] = [0; 4].map(|_| rng.point(-3, 3));
    for corners in [[a, c, b], [a, b, d], [b, c, d], [c, a, d]] {
        model.face(&corners);
    }
}

/// Three or four triangles around one edge.
fn add_fin(rng: &mut Rng, model: &mut Model) {
    let (a, b) = (rng.point(-3, 3), rng.point(-3, 3));
    for _ in 0..3 + rng.below(2) {
        let c = rng.point(-3, 3);
        model.face(&[a, b, c]);
    }
}

/// A concave or keyhole polygon in some lattice plane.
fn add_polygon(rng: &mut Rng, model: &mut Model) {
    let ell: &[[i32; 2]] = &[[0, 0], [3, 0], [3, 1], [1, 1], [1, 3], [0, 3]];
    let star: &[[i32; 2]] = &[[0, 0], [2, 1], [4, 0], [3, 2], [4, 4], [2, 3], [0, 4], [1, 2]];
    let comb: &[[i32; 2]] = &[
        [0, 0],
        [5, 0],
        [5, 3],
        [4, 3],
        [4, 1],
        [3, 1],
        [3, 3],
        [2, 3],
        [2, 1],
        [1, 1],
        [1, 3],
        [0, 3],
    ];
    let keyhole: &[[i32; 2]] =
        &[[0, 0], [4, 0], [4, 4], [0, 4], [0, 0], [1, 1], [1, 3], [3, 3], [3, 1], [1, 1]];
    let flat_corners: &[[i32; 2]] = &[[0, 0], [1, 0], [2, 0], [2, 2], [1, 2], [0, 2], [0, 1]];
    let shape = rng.pick(&[ell, star, comb, keyhole, flat_corners]);
    let origin = rng.point(-4, 1);
    let (u, v) = loop {
        let (u, v) = if rng.one_in(2) {
            let k = rng.below(3);
            let mut axes = [[0.0; 3]; 2];
            axes[0][k] = 1.0;
            axes[1][(k + 1 + rng.below(2)) % 3] = 1.0;
            (axes[0], axes[1])
        } else {
            (rng.point(-1, 1), rng.point(-1, 1))
        };
        let cross = [0, 1, 2].map(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            u[j] * v[k] - u[k] * v[j]
        });
        if cross != [0.0; 3] {
            break (u, v);
        }
    };
    let at = |p: &[i32; 2]| plus(plus(origin, f64::from(p[0]), u), f64::from(p[1]), v);
    let mut corners: Vec<P> = shape.iter().map(at).collect();
    let start = rng.below(corners.len());
    corners.rotate_left(start);
    if rng.one_in(2) {
        corners.reverse();
    }
    model.face(&corners);
}

/// A height field of two by two cells, each of two triangles.
fn add_sheet(rng: &mut Rng, model: &mut Model) {
    let origin = rng.point(-3, 1);
    let heights = [0; 9].map(|_| rng.integer(0, 2));
    let at = |i: usize, j: usize| plus(origin, 1.0, [i as f64, j as f64, heights[3 * i + j]]);
    for i in 0..2 {
        for j in 0..2 {
            model.face(&[at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            model.face(&[at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
}

/// Faces without area, faces lying on others, faces given twice.
fn add_doubtful_faces(rng: &mut Rng, model: &mut Model, boxes: &[(P, P)]) {
    let (a, d) = (rng.point(-3, 3), rng.point(-1, 1));
    model.face(&[a, plus(a, 1.0, d), plus(a, 2.0, d)]);
    if let Some(&(low, high)) = boxes.last() {
        // A triangle on the top of a box, and one standing on it.
        let top = |x: f64, y: f64| [x, y, high[2]];
        model.face(&[top(low[0], low[1]), top(high[0], low[1]), top(high[0], high[1] + 1.0)]);
        model.face(&[top(low[0], low[1]), top(high[0], high[1]), [low[0], low[1], high[2] + 2.0]]);
    }
    if !model.faces.is_empty() {
        let mut again = model.faces[rng.below(model.faces.len())].clone();
        if rng.one_in(2) {
            again.reverse();
        }
        model.faces.push(again);
    }
}

fn random_sight(rng: &mut Rng, model: &Model) -> Sight {
    let vertex = |rng: &mut Rng| rng.pick(&model.positions);
    let difference = |a: P, b: P| plus(a, -1.0, b);
    let half = |rng: &mut Rng, low, high| rng.point(2 * low, 2 * high).map(|x| 0.5 * x);
    let eye = match rng.below(6) {
        0 => rng.point(-3, 3),
        1 => half(rng, -3, 3),
        2 => {
            // In the line of two vertices, or in the plane of a face.
            let (a, b) = (vertex(rng), vertex(rng));
            let times = rng.integer(-3, 3);
            plus(a, times, difference(b, a))
        }
        3 => {
            let face = &model.faces[rng.below(model.faces.len())];
            let [a, b, c] = [0, 1, 2].map(|i| model.positions[face[i] as usize]);
            let (s, t) = (rng.integer(-3, 3), rng.integer(-3, 3));
            plus(plus(a, s, difference(b, a)), t, difference(c, a))
        }
        _ => rng.point(-9, 9),
    };
    let mut forward = match rng.below(7) {
        0 => rng.pick(&[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]).map(|x| -4.0 * x),
        1 => [0; 3].map(|_| rng.pick(&[-1.0, 1.0])),
        2 => difference(vertex(rng), vertex(rng)),
        3..=5 => difference(rng.point(-1, 1), eye),
        _ => rng.point(-4, 4),
    };
    if rng.one_in(4) {
        forward = forward.map(|x| -x);
    }
    if forward == [0.0; 3] {
        forward = [-1.0, 2.0, -1.0];
    }
    let ups =
        [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 1.0], [-1.0, 2.0, 5.0]];
    let parallel = |up: P| {
        (0..3).all(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            forward[j] * up[k] == forward[k] * up[j]
        })
    };
    let up = loop {
        let up = rng.pick(&ups);
        if !parallel(up) {
            break up;
        }
    };
    let near =
        if rng.one_in(2) { None } else { Some(rng.pick(&[1e-6, 1e-6, 0.25, 0.5, 1.0, 0.001])) };
    Sight { eye, target: plus(eye, 1.0, forward), up, near }
}

/// The same in tenths, so that what was flat, aligned or in contact is so only nearly. Polygons are
/// cut into triangles where they can be by a fan, and left out where not.
fn in_tenths(scene: Scene) -> Scene {
    let tenth = |p: P| p.map(|x| x * 0.1);
    let mut sight = scene.sight;
    (sight.eye, sight.target) = (tenth(sight.eye), tenth(sight.target));
    let faces = scene
        .faces
        .iter()
        .filter(|f| f.len() <= 4)
        .flat_map(|f| (1..f.len() - 1).map(|i| vec![f[0], f[i], f[i + 1]]).collect::<Vec<_>>())
        .collect();
    Scene {
        name: format!("{} in tenths", scene.name),
        positions: scene.positions.into_iter().map(tenth).collect(),
        faces,
        sight,
        is_in_tenths: true,
    }
}
