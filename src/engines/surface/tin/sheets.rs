//! Which scenes Max-Min draws: one sheet over a convex domain, or two that meet along its border.
//!
//! ```text
//!            ╱‾‾‾‾‾‾╲  upper         Vertices at the same place are one vertex, so the sheets share
//!     rim  ●          ●  rim         the edges of the rim. Both are wound counter-clockwise in plan,
//!            ╲______╱  lower         so both run along a rim edge in the same direction; the two
//!                                    triangles at any other edge run along it in opposite ones.
//! ```

use glam::DVec2;
use rustc_hash::{FxHashMap, FxHashSet};

use super::{LOWER, UPPER};
use crate::model::scene::Scene;
use crate::predicates::{Sign, orient2d};

/// The sheets of a scene.
#[derive(Debug)]
pub(super) enum Sheets {
    One,
    /// For each triangle whether it belongs to the lower of two sheets.
    Two {
        is_lower: Vec<bool>,
    },
}

impl Sheets {
    /// `None` for any other scene. O(triangles).
    ///
    /// Two sheets must be cut into the same triangles in plan, and the upper one must not be below the
    /// lower one at any vertex.
    pub(super) fn of(scene: &Scene) -> Option<Self> {
        let is_one_to_one = scene.triangles().len() == scene.mesh().n_faces();
        if !is_one_to_one || !scene.triangles().iter().all(|t| is_upward(scene, t)) {
            return None;
        }
        let (sheet_of, n_sheets) = components(scene);
        let is_function =
            (0..n_sheets).all(|sheet| is_function_over_convex_domain(scene, &sheet_of, sheet));
        match n_sheets {
            1 if is_function => Some(Self::One),
            2 if is_function && meet_along_border(scene) => {
                let first_is_lower = first_is_lower(scene, &sheet_of)?;
                let is_lower = sheet_of.iter().map(|&s| (s == 0) == first_is_lower).collect();
                Some(Self::Two { is_lower })
            }
            _ => None,
        }
    }

    /// Number of sheets.
    pub(super) fn n(&self) -> usize {
        match self {
            Self::One => 1,
            Self::Two { .. } => 2,
        }
    }

    /// The sheet of a triangle: 0 is the upper one or the only one.
    pub(super) fn sheet(&self, triangle: u32) -> usize {
        match self {
            Self::One => 0,
            Self::Two { is_lower } => usize::from(is_lower[triangle as usize]),
        }
    }

    /// Whether an edge is on the sheet that a vertical view shows: `UPPER` or `LOWER`.
    pub(super) fn faces_up_or_down(&self, scene: &Scene, edge: u32, seen: u8) -> bool {
        let Self::Two { .. } = self else { return true };
        let shown = if seen == UPPER { 0 } else { 1 };
        debug_assert!(seen == UPPER || seen == LOWER);
        scene.topology().uses(edge).iter().any(|used| self.sheet(used.face()) == shown)
    }
}

/// Whether an edge is on the border of its sheet, shared with another sheet or not.
pub(super) fn is_border(scene: &Scene, edge: u32) -> bool {
    match scene.topology().uses(edge) {
        [one, other] => one.runs_upwards() == other.runs_upwards(),
        _ => true,
    }
}

fn plan(scene: &Scene, vertex: u32) -> DVec2 {
    scene.mesh().positions()[vertex as usize].truncate()
}

fn turn(scene: &Scene, [a, b, c]: [u32; 3]) -> Sign {
    orient2d(plan(scene, a), plan(scene, b), plan(scene, c))
}

fn is_upward(scene: &Scene, triangle: &[u32; 3]) -> bool {
    turn(scene, *triangle) == Sign::Positive
}

/// The number of the connected part that each triangle belongs to, and how many there are. Triangles
/// connect at edges that are not on a border.
fn components(scene: &Scene) -> (Vec<u32>, u32) {
    let topology = scene.topology();
    let mut component = vec![u32::MAX; scene.triangles().len()];
    let mut n = 0;
    let mut waiting = Vec::new();
    for start in 0..component.len() as u32 {
        if component[start as usize] != u32::MAX {
            continue;
        }
        component[start as usize] = n;
        waiting.push(start);
        while let Some(triangle) = waiting.pop() {
            let [a, b, c] = scene.triangles()[triangle as usize];
            for [a, b] in [[a, b], [b, c], [c, a]] {
                let edge = topology.find_edge(a.min(b), a.max(b)).unwrap_or_default();
                if is_border(scene, edge) {
                    continue;
                }
                for used in topology.uses(edge) {
                    let other = &mut component[used.face() as usize];
                    if *other == u32::MAX {
                        *other = n;
                        waiting.push(used.face());
                    }
                }
            }
        }
        n += 1;
    }
    (component, n)
}

/// Whether every border edge belongs to both sheets.
fn meet_along_border(scene: &Scene) -> bool {
    (0..scene.topology().edges().len() as u32).all(|edge| scene.topology().uses(edge).len() == 2)
}

/// Whether the triangles of a sheet lie side by side in plan and together cover a convex region. All
/// of them turn counter-clockwise.
fn is_function_over_convex_domain(scene: &Scene, sheet_of: &[u32], sheet: u32) -> bool {
    let topology = scene.topology();
    let n_positions = scene.mesh().positions().len();
    // The border, from each vertex on it to the next.
    let mut next = vec![u32::MAX; n_positions];
    let (mut n_border, mut n_edges, mut start) = (0, 0, 0);
    for (edge, &[low, high]) in (0..).zip(topology.edges()) {
        let mut own = topology.uses(edge).iter().filter(|u| sheet_of[u.face() as usize] == sheet);
        match (own.next(), own.next(), own.next()) {
            (None, ..) => continue,
            (Some(only), None, _) => {
                let (from, to) = if only.runs_upwards() { (low, high) } else { (high, low) };
                if std::mem::replace(&mut next[from as usize], to) != u32::MAX {
                    return false;
                }
                (n_border, start) = (n_border + 1, from);
            }
            (Some(one), Some(other), None) if one.runs_upwards() != other.runs_upwards() => {}
            _ => return false,
        }
        n_edges += 1;
    }
    // One loop that always turns left and goes around once bounds a convex region. A disk whose
    // triangles all turn one way then covers it once (Euler: a disk has characteristic 1).
    let is_upper = |a: u32, b: u32| {
        let (a, b) = (plan(scene, a), plan(scene, b));
        b.y > a.y || b.y == a.y && b.x > a.x
    };
    let mut at = start;
    let mut n_rises = 0;
    for k in 0..n_border {
        let middle = next[at as usize];
        let Some(&after) = next.get(middle as usize).filter(|&&v| v != u32::MAX) else {
            return false;
        };
        let is_left = turn(scene, [at, middle, after]) != Sign::Negative;
        if !is_left || (middle == start) != (k + 1 == n_border) {
            return false;
        }
        n_rises += usize::from(!is_upper(at, middle) && is_upper(middle, after));
        at = middle;
    }
    let mut is_used = vec![false; n_positions];
    let mut n_triangles = 0;
    for (triangle, _) in scene.triangles().iter().zip(sheet_of).filter(|(_, of)| **of == sheet) {
        n_triangles += 1;
        triangle.iter().for_each(|&v| is_used[v as usize] = true);
    }
    let n_vertices = is_used.iter().filter(|&&is_used| is_used).count();
    n_rises == 1 && n_vertices + n_triangles == n_edges + 1
}

/// Whether the first of two sheets is the lower one. `None` when they cross or have different
/// triangles in plan.
fn first_is_lower(scene: &Scene, sheet_of: &[u32]) -> Option<bool> {
    let of_sheet = |sheet: u32| {
        let all = scene.triangles().iter().zip(sheet_of);
        all.filter(move |(_, of)| **of == sheet).map(|(triangle, _)| *triangle)
    };
    let key = |v: u32| (plan(scene, v) + 0.0).to_array().map(f64::to_bits);
    let twins: FxHashMap<[u64; 2], u32> =
        of_sheet(1).flatten().map(|vertex| (key(vertex), vertex)).collect();
    let first_corner_lowest = |mut corners: [u32; 3]| {
        let k = (0..3).min_by_key(|&k| corners[k]).unwrap_or_default();
        corners.rotate_left(k);
        corners
    };
    let others: FxHashSet<[u32; 3]> = of_sheet(1).map(first_corner_lowest).collect();
    let (mut n_matched, mut is_below, mut is_above) = (0, false, false);
    for triangle in of_sheet(0) {
        let mut twin = [0; 3];
        for (vertex, twin) in triangle.into_iter().zip(&mut twin) {
            *twin = *twins.get(&key(vertex))?;
            let z = |v: u32| scene.mesh().positions()[v as usize].z;
            is_below |= z(vertex) < z(*twin);
            is_above |= z(vertex) > z(*twin);
        }
        if !others.contains(&first_corner_lowest(twin)) {
            return None;
        }
        n_matched += 1;
    }
    (n_matched == others.len() && is_below != is_above).then_some(is_below)
}
