//! Warnock (1969): windows of the image, divided until each is simple.
//!
//! Read in "Algoritmy viditeľnosti" (section Warnockov algoritmus delenia okna, and AREA-SUBDIVISION
//! METHOD after Hearn and Baker) and in "Bereichsunterteilungs-Algorithmen" (Warnock-Algorithmus).
//! A window with simple content is drawn at once; any other is divided, down to a leaf as wide as a pen,
//! which takes the face nearest at its center.
//!
//! ```text
//!  surrounding   intersecting   contained     disjoint
//!  ▒▒▒▒▒▒▒▒▒▒     ┌──────┐       ┌──────┐     ┌──────┐ ▒▒     window ┌──┐
//!  ▒┌──────┐▒    ▒│▒▒    │       │ ▒▒▒  │     │      │ ▒▒            └──┘
//!  ▒│▒▒▒▒▒▒│▒    ▒│▒▒▒   │       │  ▒▒  │     │      │  ▒     polygon ▒▒
//!  ▒└──────┘▒     └──────┘       └──────┘     └──────┘
//!  ▒▒▒▒▒▒▒▒▒▒
//! ```
//!
//! * **K1**: a surrounding polygon is in front of all others: it fills the window.
//! * **K2**: at most one polygon reaches into the window: it fills the part that it covers.
//!
//! Whether a surrounding polygon is in front is tested in both ways of the source: by sorting (its
//! farthest point in the window is nearer than the nearest point of every other), and by the depths of
//! all planes at the four corners of the window. Before that, the planes decide exactly for polygons that
//! do not cross, see [`Images::place`]. Polygons behind a surrounding polygon are not passed on to the
//! parts of the window.
//!
//! Windows are divided into quarters, or at the polygon vertex nearest to the middle ([`Subdivision`]); a
//! window that is a single row or column of leaves is divided in one direction only. Window borders are
//! always leaf borders, so both ways end at the same leaves. Finally, all parts of a face are joined into
//! polygons.
//!
//! Differs from the sources in that windows with one polygon are clipped exactly, not in pixels; so the
//! border is a staircase of leaves only where several faces meet.
//!
//! Good for: showing how complex a picture is; scenes with few, large faces. Exactness: within a leaf of
//! where two faces meet. Cost: leaves along all borders between faces × log; each window has fewer
//! candidates than the one it is part of. Cannot: more than [`MOST_LEAVES`] leaves, refused at once.
//!
//! Coherence: face coherence, in the area of a window (a window of one face is done), and object
//! coherence (what a surrounding face hides is not passed on to the parts of a window).

use std::sync::atomic::{AtomicU64, Ordering};

use glam::DVec2;
use rayon::prelude::*;
use serde::Serialize;

use super::images::{DepthOrder, Images};
use super::painting::{NO_LINE, Painting};
use super::region::{Region, RegionSide};
use super::{FaceError, merge};
use crate::camera::Camera;
use crate::engines::image::depth::Depth;
use crate::model::scene::Scene;

/// Leaves along the diagonal of the image, unless a size is set.
pub const DEFAULT_LEAVES: f64 = 1000.0;

/// More leaves than this are refused.
pub const MOST_LEAVES: f64 = 100e6;

/// How windows are divided.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Subdivision {
    /// In the middle.
    #[default]
    Regular,
    /// At the vertex nearest to the middle, so that fewer windows hold several faces.
    Vertices,
}

impl Subdivision {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Regular, Self::Vertices];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Regular => "regular",
            Self::Vertices => "vertices",
        }
    }
}

/// The window that is divided, in leaves.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct WarnockOptions {
    /// Width and height of a leaf in image units; `None` for a thousandth of the image's diagonal.
    pub leaf: Option<f64>,
    /// The first window, as (lowest, highest) corner; `None` for the box around the image. It is
    /// widened to whole leaves at its high end.
    pub window: Option<(DVec2, DVec2)>,
    /// How windows are divided.
    pub subdivision: Subdivision,
}

/// How windows came to their end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct WarnockCounts {
    /// Windows examined: the sum of all below.
    pub windows: u64,
    /// Windows that were divided.
    pub divided: u64,
    /// Windows that no polygon reaches.
    pub empty: u64,
    /// Windows that one polygon covers, in front of all others if there are any.
    pub covered: u64,
    /// Windows that only one polygon reaches into, apart from those it hides.
    pub single: u64,
    /// Leaves where the nearest polygon at the center was taken.
    pub leaves: u64,
}

/// The same, for several threads that count at once.
#[derive(Debug, Default)]
struct Tally {
    divided: AtomicU64,
    empty: AtomicU64,
    covered: AtomicU64,
    single: AtomicU64,
    leaves: AtomicU64,
}

impl Tally {
    fn counts(self) -> WarnockCounts {
        let [divided, empty, covered, single, leaves] =
            [self.divided, self.empty, self.covered, self.single, self.leaves]
                .map(AtomicU64::into_inner);
        let windows = divided + empty + covered + single + leaves;
        WarnockCounts { windows, divided, empty, covered, single, leaves }
    }
}

fn count(tally: &AtomicU64) {
    tally.fetch_add(1, Ordering::Relaxed);
}

/// Finds the visible part of each face.
///
/// The pieces are disjoint, in the order of faces. In parallel; the result is the same for any number of
/// threads.
///
/// # Errors
/// [`FaceError::TooManyLeaves`].
pub fn solve(
    scene: &Scene,
    camera: &Camera,
    options: &WarnockOptions,
) -> Result<(Painting, WarnockCounts), FaceError> {
    let images = Images::new(scene, camera);
    if images.flats.is_empty() {
        return Ok((Painting::new(true), WarnockCounts::default()));
    }
    let (low, high) = options.window.unwrap_or(images.bounds);
    let diagonal = (high - low).length();
    let leaf = options.leaf.filter(|leaf| *leaf > 0.0).unwrap_or(diagonal / DEFAULT_LEAVES);
    let n = ((high - low) / leaf).ceil().max(DVec2::ONE);
    let n_leaves = n.x * n.y;
    if n_leaves.is_nan() || n_leaves > MOST_LEAVES {
        return Err(FaceError::TooManyLeaves { n: n_leaves, most: MOST_LEAVES });
    }
    let subdivision = options.subdivision;
    let warnock = Warnock { images: &images, low, leaf, subdivision, tally: Tally::default() };
    let all: Vec<u32> = (0..images.flats.len() as u32).collect();
    let root = Window { from: [0, 0], to: [n.x as u32, n.y as u32] };
    // What is drawn of each polygon, window by window in a fixed order.
    let mut drawn: Vec<Vec<Region>> = vec![Vec::new(); images.flats.len()];
    for (polygon, region) in warnock.window(root, &all, PARALLEL_LEVELS) {
        drawn[polygon as usize].push(region);
    }
    let faces = images.flats.iter().map(|flat| flat.face).zip(drawn);
    Ok((merge::by_face(faces, &images.grid), warnock.tally.counts()))
}

/// Down to this many divisions, the parts of a window are divided in parallel.
const PARALLEL_LEVELS: u32 = 4;

/// A rectangle of leaves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Window {
    from: [u32; 2],
    to: [u32; 2],
}

/// How a polygon and a window overlap.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Class {
    Surrounding,
    Intersecting,
    Contained,
    Disjoint,
}

struct Warnock<'a> {
    images: &'a Images<'a>,
    low: DVec2,
    leaf: f64,
    subdivision: Subdivision,
    tally: Tally,
}

type DrawOutput = Vec<(u32, Region)>;

impl Warnock<'_> {
    fn window(&self, window: Window, candidates: &[u32], parallel: u32) -> DrawOutput {
        let bounds = self.bounds(window);
        let mut reaching: Vec<(u32, Class)> = Vec::new();
        for &polygon in candidates {
            match self.class(polygon, bounds) {
                Class::Disjoint => {}
                class => reaching.push((polygon, class)),
            }
        }
        self.drop_hidden(&mut reaching, bounds);
        match reaching[..] {
            // K2
            [] => {
                count(&self.tally.empty);
                return Vec::new();
            }
            [(polygon, Class::Surrounding)] => {
                count(&self.tally.covered);
                return vec![(polygon, self.rectangle(bounds))];
            }
            [(polygon, _)] => {
                count(&self.tally.single);
                let region = &self.images.flats[polygon as usize].region;
                return vec![(polygon, region.within(&self.rectangle(bounds)))];
            }
            _ => {}
        }
        let [columns, rows] = [0, 1].map(|axis| window.to[axis] - window.from[axis]);
        if columns == 1 && rows == 1 {
            count(&self.tally.leaves);
            return self.leaf(&reaching, bounds);
        }
        count(&self.tally.divided);
        let polygons: Vec<u32> = reaching.iter().map(|&(polygon, _)| polygon).collect();
        let parts = self.divided(window, &polygons);
        if parallel > 0 {
            let drawn = parts.par_iter().map(|&part| self.window(part, &polygons, parallel - 1));
            return drawn.collect::<Vec<DrawOutput>>().into_iter().flatten().collect();
        }
        parts.into_iter().flat_map(|part| self.window(part, &polygons, 0)).collect()
    }

    /// Removes what is behind a polygon that surrounds the window. If nothing else is left, this is K1.
    fn drop_hidden(&self, reaching: &mut Vec<(u32, Class)>, bounds: (DVec2, DVec2)) {
        let middle = (bounds.0 + bounds.1) / 2.0;
        let at_middle = |polygon: u32| self.nearness(polygon, middle);
        let surrounding = reaching.iter().filter(|(_, class)| *class == Class::Surrounding);
        // Only the one nearest in the middle can be in front of all.
        let front = surrounding.map(|&(polygon, _)| polygon).reduce(|a, b| {
            if Depth::of_any(at_middle(b)) > Depth::of_any(at_middle(a)) { b } else { a }
        });
        let Some(front) = front else { return };
        reaching.retain(|&(polygon, _)| polygon == front || !self.hides(front, polygon, bounds));
    }

    /// Whether a polygon that surrounds a window is in front of another everywhere in it.
    fn hides(&self, front: u32, other: u32, bounds: (DVec2, DVec2)) -> bool {
        match self.images.place(front as usize, other as usize) {
            DepthOrder::Behind => true,
            DepthOrder::InFront => false,
            DepthOrder::Crossing => {
                let corners = corners(bounds);
                let farthest = corners
                    .map(|c| self.nearness(front, c))
                    .into_iter()
                    .fold(f64::INFINITY, f64::min);
                // Sorted by their depth.
                self.images.flats[other as usize].nearest < farthest
                    // By the planes at the corners.
                    || corners.iter().all(|&c| self.nearness(front, c) > self.nearness(other, c))
            }
        }
    }

    /// The nearest polygon at the center of a leaf; of equally near ones the first.
    fn leaf(&self, reaching: &[(u32, Class)], bounds: (DVec2, DVec2)) -> DrawOutput {
        let center = (bounds.0 + bounds.1) / 2.0;
        let on_grid = self.images.grid.snap(center);
        let covers = |polygon: u32| self.images.flats[polygon as usize].region.contains(on_grid);
        let covering = reaching.iter().map(|&(polygon, _)| polygon).filter(|&p| covers(p));
        let nearest = covering.reduce(|a, b| {
            let depth = |polygon| Depth::of_any(self.nearness(polygon, center));
            if depth(b) > depth(a) { b } else { a }
        });
        nearest.map(|polygon| (polygon, self.rectangle(bounds))).into_iter().collect()
    }

    fn nearness(&self, polygon: u32, point: DVec2) -> f64 {
        self.images.flats[polygon as usize].nearness.at(point)
    }

    fn bounds(&self, window: Window) -> (DVec2, DVec2) {
        let at = |[i, j]: [u32; 2]| self.low + DVec2::new(f64::from(i), f64::from(j)) * self.leaf;
        (at(window.from), at(window.to))
    }

    fn rectangle(&self, bounds: (DVec2, DVec2)) -> Region {
        let corners = corners(bounds).map(|corner| (self.images.grid.snap(corner), NO_LINE));
        Region::of_rings([corners])
    }

    fn class(&self, polygon: u32, bounds: (DVec2, DVec2)) -> Class {
        let region = &self.images.flats[polygon as usize].region;
        let (low, high) = (self.images.grid.snap(bounds.0), self.images.grid.snap(bounds.1));
        let of = region.bounds();
        if of.0.cmpge(high).any() || of.1.cmple(low).any() {
            return Class::Disjoint;
        }
        if of.0.cmpge(low).all() && of.1.cmple(high).all() {
            return Class::Contained;
        }
        if region.sides().iter().any(|side| reaches(side, low, high)) {
            return Class::Intersecting;
        }
        if region.contains(((low + high) / 2.0).round()) {
            Class::Surrounding
        } else {
            Class::Disjoint
        }
    }

    /// The parts of a window: four, or two for a row or column of leaves.
    fn divided(&self, window: Window, polygons: &[u32]) -> Vec<Window> {
        let at = match self.subdivision {
            Subdivision::Regular => None,
            Subdivision::Vertices => self.vertex(window, polygons),
        };
        let middle = [0, 1].map(|axis| (window.from[axis] + window.to[axis]) / 2);
        let at = at.unwrap_or(middle);
        let halves = |axis: usize| -> Vec<[u32; 2]> {
            let (from, to) = (window.from[axis], window.to[axis]);
            if to - from == 1 { vec![[from, to]] } else { vec![[from, at[axis]], [at[axis], to]] }
        };
        let (columns, rows) = (halves(0), halves(1));
        let parts = rows.iter().flat_map(|row| columns.iter().map(move |column| (column, row)));
        parts
            .map(|(column, row)| Window { from: [column[0], row[0]], to: [column[1], row[1]] })
            .collect()
    }

    /// The leaf border next to the vertex nearest to the middle of a window.
    fn vertex(&self, window: Window, polygons: &[u32]) -> Option<[u32; 2]> {
        let (low, high) = self.bounds(window);
        let middle = (low + high) / 2.0;
        let grid = &self.images.grid;
        let sides = polygons.iter().flat_map(|&p| self.images.flats[p as usize].region.sides());
        let vertices = sides.map(|side| grid.point(side.from));
        let inside = vertices.filter(|p| p.cmpgt(low).all() && p.cmplt(high).all());
        let vertex = inside
            .min_by(|a, b| a.distance_squared(middle).total_cmp(&b.distance_squared(middle)))?;
        let at = ((vertex - self.low) / self.leaf).round();
        // A window one leaf wide is not divided in that direction, whatever this says.
        let within = |axis: usize| {
            let (least, most) = (window.from[axis] + 1, (window.to[axis] - 1).max(1));
            (at[axis] as u32).clamp(least.min(most), most)
        };
        Some([within(0), within(1)])
    }
}

fn corners((low, high): (DVec2, DVec2)) -> [DVec2; 4] {
    [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)]
}

/// Whether a side runs through the inside of a rectangle.
fn reaches(side: &RegionSide, low: DVec2, high: DVec2) -> bool {
    let (a, b) = (side.from, side.to);
    if a.max(b).cmple(low).any() || a.min(b).cmpge(high).any() {
        return false;
    }
    // Not when all corners are on one side of it.
    let turns = corners((low, high)).map(|corner| super::region::turn(a, b, corner).signum());
    turns.contains(&1) && turns.contains(&-1)
}
