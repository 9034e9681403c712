//! Appel: quantitative invisibility is carried along edges and changes only at cutting edges.
//!
//! A. Appel, "The notion of quantitative invisibility and the machine rendering of solids", ACM
//! National Conference 1967. The quantitative invisibility of a point is the number of triangles
//! that cover it. Along a drawn edge it changes only where the edge pierces a triangle or passes behind
//! a nearer *cutting edge*, a side that has more of its triangles on one side of its image than on the
//! other:
//!
//! ```text
//!    qi 0    ┆   qi 2  ┆   qi 1  ┆   qi 0
//!   ●────────┆┄┄┄┄┄┄┄┄┄┆┄┄┄┄┄┄┄┄┄┆─────────●
//!   A        silhouette    boundary        B
//! ```
//!
//! So drawn edges are tested against the few cutting edges, not against all triangles. The `qi` at the
//! start of an edge is carried over from the edges that meet it, as follows. Let `qi₀(v)` be the number
//! of triangles that cover a vertex without touching it. A vertex is *regular* if its image is not on
//! that of a nearer cutting edge, and the vertex itself only on triangles it is a corner of. Then `qi₀(v)`
//! is the same all around it, and an edge leaves it with `qi₀(v)` plus the triangles around `v` that cover
//! the edge just beyond. So any edge between two regular vertices gives the difference of their `qi₀`, and
//! one sight line determines a whole connected set. Only an edge between two irregular vertices needs its
//! own sight line.
//!
//! Differs from the paper in:
//! * all triangles count, front and back, so that meshes may be open, non-manifold or badly wound;
//! * each of an edge's two sides has its own `qi` (module `trace`). A side is a path that meets no vertex
//!   and runs along no edge, so coincidences in the image need no special cases;
//! * nothing is rounded: crossings, depth and order are signs of [`crate::predicates`]. All paths to a
//!   vertex must give it the same `qi`, and on a closed surface some sight lines must meet an even number
//!   of triangles (module `parity`). A contradiction would be a defect of the program; it is counted, and
//!   [`roberts`] takes the edges concerned.
//!
//! Intersection lines go to [`roberts`]: their ends are on triangles, so each would need its own sight
//! line.
//!
//! Triangles that the near plane cuts are tested one by one, as in Roberts's algorithm. In near contact
//! (see [`VisibilityOptions::contact_tolerance`]), `qi` is carried as if there were no tolerance, and what
//! does not cover within the tolerance is subtracted at the end.
//!
//! # How the work grows
//!
//! All edges of a displaced sphere, open at the poles, in perspective. The number of cutting edges tested
//! grows like the contours; triangles are tested if they are near in space and the ends of the edge are
//! not certainly on one side of their plane.
//!
//! | triangles | edges | cutting edges tested | triangles tested | sight lines | Roberts' triangles |
//! |---|---|---|---|---|---|
//! | 9,800 | 14,800 | 29,022 | 6,334 | 1 | 181,503 |
//! | 101,760 | 152,960 | 113,959 | 51,393 | 1 | 2,108,630 |
//! | 998,000 | 1,498,000 | 389,362 | 1,126,541 | 1 | 20,964,609 |
//!
//! Coherence: edge coherence. Visibility changes only where an edge passes behind a cutting edge or
//! pierces a face, and is carried from edge to edge at vertices. Object coherence, in the indexes.

mod ahead;
mod box_join;
mod cutting;
mod doubled;
mod near;
mod parity;
mod places;
mod propagate;
mod start;
mod trace;

use super::occluders::Occluders;
use super::occlusion::{self, Visible};
use super::roberts;
use super::rounding::{Place, Rounding};
use super::segment::Segment;
use super::shadow::{Shadow, shadow};
use super::sides::Sides;
use super::sweep::Sweep;
use super::{LineCounts, VisibilityOptions};
use crate::classify::ViewedScene;
use crate::engines::visibility::Visibility;
use crate::groups::Groups;
use crate::predicates::CutPlane;
use ahead::cutting_edges_ahead;
use cutting::{Stars, cutting_edges};
use near::near_triangles;
use places::Places;
use propagate::{Base, LayerCounts};
use rayon::prelude::*;
use start::{is_plain, layers_beyond, local_layers};
use trace::{Change, Surroundings, Trace};

/// How many segments make one piece of parallel work.
const CHUNK: usize = 512;

/// Finds the spans of all drawn edges of `view`, in their order.
///
/// Expected cost: the triangles, once, for the indices; for each edge the cutting edges near its
/// image and the triangles near it in space; and a few sight lines. Where hidden layers need not be
/// counted, only what is not certainly hidden is looked at; see `occlusion`.
pub fn solve(view: &ViewedScene, options: &VisibilityOptions) -> (Visibility, LineCounts) {
    let sides = Sides::new(view);
    let rounding = Rounding::new(view);
    let occluders = Occluders::new(view);
    let Some(visible) = occlusion::cull(view, options, &rounding, &sides, &occluders) else {
        let segments = roberts::segments(view, None);
        return Appel { view, options, sides, rounding, occluders }.solve(segments);
    };
    let Visible { lines, occluders } = visible;
    let segments = roberts::segments(view, Some(&lines));
    let (n_lines, n_triangles) = (view.selected().len(), view.scene().triangles().len());
    let culled_triangles = (n_triangles - occluders.list().len()) as u64;
    let appel = Appel { view, options, sides, rounding, occluders };
    let (visibility, counts) = appel.solve(segments);
    let culled_edges = (n_lines - lines.len()) as u64;
    let counts = LineCounts { culled_edges, culled_triangles, ..counts };
    (occlusion::with_hidden(&visibility, &lines, n_lines), counts)
}

/// A view, and what is known of it before any line is traced.
struct Appel<'v, 'a> {
    view: &'v ViewedScene<'a>,
    options: &'v VisibilityOptions,
    sides: Sides<'a>,
    rounding: Rounding,
    occluders: Occluders,
}

impl Appel<'_, '_> {
    /// Finds the spans of some segments.
    fn solve(&self, segments: Vec<Option<Segment>>) -> (Visibility, LineCounts) {
        let Self { view, options, sides, rounding, occluders } = self;
        let (segments, crossings) = apart(view, segments);
        let Some(places) = Places::new(view, rounding, &segments) else {
            // No edge is drawn, or numbers are so large that their differences are not finite.
            let all: Vec<_> = segments.iter().zip(&crossings).map(|(a, b)| a.or(*b)).collect();
            return roberts::solve_segments(view, options, &all);
        };
        let (cutting, is_even) = cutting_edges(view, sides, occluders);
        let boxes = places.of_segments(rounding, &segments);
        let ahead = cutting_edges_ahead(view, rounding, &places, &segments, &boxes, &cutting);
        let tolerance = options.contact_tolerance;
        let near = near_triangles(view, occluders, &places, &segments, &boxes, tolerance);
        drop(boxes);
        let cut_by_near_plane = triangles_that_the_near_plane_cuts(view, rounding);
        let around = Surroundings {
            cutting: &cutting,
            ahead: &ahead,
            near: &near,
            rounding,
            cut_by_near_plane: &cut_by_near_plane,
            contact_tolerance: options.contact_tolerance,
        };
        let mut is_end = vec![false; view.scene().mesh().positions().len()];
        for &end in segments.iter().flatten().flat_map(|segment| &segment.ends) {
            is_end[end as usize] = true;
        }
        let stars = Stars::new(view, occluders, &is_end);
        let is_plain = (0..is_even.len() as u32)
            .into_par_iter()
            .map(|v| is_even[v as usize] && is_end[v as usize] && is_plain(view, &stars, v))
            .collect();
        let neighbors = Neighbors { sides, occluders, stars: &stars, is_plain };
        let traced: Vec<Chunk> = segments
            .par_chunks(CHUNK)
            .enumerate()
            .map(|(i, chunk)| Chunk::trace(view, &around, &neighbors, i * CHUNK, chunk))
            .collect();

        let mut starts = Starts::new(view, &segments, &traced);
        starts.ask_sight_lines(self, &places, &segments, &traced);
        // Without the culled triangles the surface is not closed.
        let n_odd = match occluders.are_culled() {
            true => 0,
            false => parity::count_odd(view, sides, &segments, &starts.layers),
        };
        if n_odd > 0 {
            // Which of the numbers is wrong is not known: Roberts does them all.
            starts.n_failures += n_odd;
            starts.layers.fill(None);
        }
        let partners = if options.find_doubled {
            doubled::partners(view, rounding, &segments)
        } else {
            Groups::default()
        };
        let builder = SpanBuilder { view, options, sides, partners: &partners, starts: &starts };
        let parts: Vec<(Visibility, Vec<u32>)> = segments
            .par_chunks(CHUNK)
            .zip(&traced)
            .enumerate()
            .map(|(i, (chunk, traced))| builder.spans(i * CHUNK, &segments, chunk, traced))
            .collect();

        let mut visibility = Visibility::default();
        let mut counts =
            LineCounts { checksum_failures: starts.n_failures, ..LineCounts::default() };
        let mut failed = Vec::new();
        for ((part, without_start), traced) in parts.iter().zip(&traced) {
            visibility.append(part);
            failed.extend_from_slice(without_start);
            counts.contour_crossings += traced.trace.crossings_tested;
            counts.candidate_pairs += traced.trace.crossings_tested + traced.trace.triangles_tested;
        }
        counts.fallback_edges = failed.len() as u64;
        counts.sight_lines = starts.n_sight_lines;
        let mut again = crossings;
        for &i in &failed {
            again[i as usize] = segments[i as usize];
        }
        if again.iter().any(Option::is_some) {
            visibility = replaced_by_roberts(view, options, &again, &visibility, &mut counts);
        }
        (visibility, counts)
    }
}

/// Splits segments into edges of faces and all other lines, each list with `None` for the rest.
///
/// Other lines end at no vertex of a surface, or on a face, so they cannot take over a count from an
/// edge. They go to [`roberts`].
fn apart(
    view: &ViewedScene,
    mut segments: Vec<Option<Segment>>,
) -> (Vec<Option<Segment>>, Vec<Option<Segment>>) {
    let n_edges = view.scene().topology().edges().len() as u32;
    let mut crossings = vec![None; segments.len()];
    for (segment, crossing) in segments.iter_mut().zip(&mut crossings) {
        if segment.is_some_and(|segment| segment.edge >= n_edges) {
            std::mem::swap(segment, crossing);
        }
    }
    (segments, crossings)
}

fn triangles_that_the_near_plane_cuts(view: &ViewedScene, rounding: &Rounding) -> Vec<u32> {
    if !view.near_plane_cuts() {
        return Vec::new();
    }
    (0..view.scene().triangles().len() as u32)
        .into_par_iter()
        .filter(|&triangle| matches!(rounding.place(view, triangle), Place::Everywhere))
        .collect()
}

/// What is around vertices.
struct Neighbors<'n> {
    sides: &'n Sides<'n>,
    occluders: &'n Occluders,
    stars: &'n Stars,
    /// Whether the triangles around a vertex lie side by side, once around.
    is_plain: Vec<bool>,
}

impl Neighbors<'_> {
    /// The layers of triangles around each end of a segment, just beyond it.
    fn local_layers(&self, view: &ViewedScene, segment: &Segment) -> [[i32; 2]; 2] {
        let plain = segment.ends.map(|end| self.is_plain[end as usize]);
        let is_between =
            (plain[0] || plain[1]) && self.sides.is_even(view, self.occluders, segment.edge);
        [0, 1].map(|end| match is_between && plain[end] {
            true => [0; 2],
            false => local_layers(view, self.stars, segment.ends, end),
        })
    }
}

/// What a chunk of segments meets.
struct Chunk {
    trace: Trace,
    /// Where the changes of each segment end.
    ends: Vec<u32>,
    links: Vec<Link>,
}

/// What a segment says about the numbers at its ends; on its left and right.
#[derive(Debug, Clone, Copy, Default)]
struct Link {
    /// The layers at the last end less those at the first.
    total: [i32; 2],
    /// The layers of triangles that touch the first end, just beyond it, and the last.
    local: [[i32; 2]; 2],
}

impl Chunk {
    fn trace(
        view: &ViewedScene,
        around: &Surroundings,
        neighbors: &Neighbors,
        first: usize,
        segments: &[Option<Segment>],
    ) -> Self {
        let mut chunk = Self { trace: Trace::default(), ends: Vec::new(), links: Vec::new() };
        for (i, segment) in segments.iter().enumerate() {
            let link = segment.as_ref().map_or_else(Link::default, |segment| Link {
                total: chunk.trace.follow(view, around, first + i, segment),
                local: neighbors.local_layers(view, segment),
            });
            chunk.links.push(link);
            chunk.ends.push(chunk.trace.changes.len() as u32);
        }
        chunk
    }

    fn changes(&self, i: usize) -> &[Change] {
        let start = if i == 0 { 0 } else { self.ends[i - 1] };
        &self.trace.changes[start as usize..self.ends[i] as usize]
    }
}

/// How many layers each segment begins with.
struct Starts {
    /// On the left and right; `None` when the checksum failed.
    layers: Vec<Option<[i32; 2]>>,
    levels: LayerCounts,
    is_irregular: Vec<bool>,
    n_sight_lines: u64,
    n_failures: u64,
}

/// Which ends of a segment are whole: not cut off by the near plane.
fn is_whole(segment: &Segment) -> [bool; 2] {
    [segment.from, segment.to].map(|cut| cut.plane == CutPlane::End)
}

impl Starts {
    /// Joins vertices along all segments with two regular ends.
    fn new(view: &ViewedScene, segments: &[Option<Segment>], traced: &[Chunk]) -> Self {
        let n_vertices = view.scene().mesh().positions().len();
        let mut starts = Self {
            layers: vec![None; segments.len()],
            levels: LayerCounts::new(n_vertices),
            is_irregular: vec![false; n_vertices],
            n_sight_lines: 0,
            n_failures: 0,
        };
        for &vertex in traced.iter().flat_map(|chunk| &chunk.trace.irregular) {
            starts.is_irregular[vertex as usize] = true;
        }
        let links = traced.iter().flat_map(|chunk| &chunk.links);
        for (segment, link) in segments.iter().zip(links) {
            let Some(segment) = segment else { continue };
            let [Some(a), Some(b)] = starts.regular_ends(segment) else { continue };
            let more = [0, 1].map(|k| link.local[0][k] + link.total[k] - link.local[1][k]);
            if more[0] != more[1] {
                starts.levels.contradict(a);
                starts.levels.contradict(b);
                starts.n_failures += 1;
            } else if !starts.levels.join(a, b, more[0]) {
                starts.n_failures += 1;
            }
        }
        starts
    }

    fn regular_ends(&self, segment: &Segment) -> [Option<u32>; 2] {
        let whole = is_whole(segment);
        [0, 1].map(|end| {
            let vertex = segment.ends[end];
            (whole[end] && !self.is_irregular[vertex as usize]).then_some(vertex)
        })
    }

    /// One sight line for each set of vertices, and one for each segment that has no regular end.
    fn ask_sight_lines(
        &mut self,
        appel: &Appel,
        places: &Places,
        segments: &[Option<Segment>],
        traced: &[Chunk],
    ) {
        let mut is_asked = vec![false; self.is_irregular.len()];
        // The segment, the end and the vertex whose set is in question.
        let mut questions: Vec<(u32, usize, Option<u32>)> = Vec::new();
        for (i, segment) in segments.iter().enumerate() {
            let Some(segment) = segment else { continue };
            let ends = self.regular_ends(segment);
            let regular = ends.iter().enumerate().find_map(|(end, vertex)| Some((end, (*vertex)?)));
            match regular {
                Some((end, vertex)) => {
                    let (root, _) = self.levels.find(vertex);
                    let is_new = !std::mem::replace(&mut is_asked[root as usize], true);
                    if is_new && self.levels.base(root) == Base::Unknown {
                        questions.push((i as u32, end, Some(vertex)));
                    }
                }
                None => {
                    let end = usize::from(!is_whole(segment)[0]);
                    questions.push((i as u32, end, None));
                }
            }
        }
        let ends = questions.iter().map(|&(i, end, _)| (segments[i as usize].as_ref(), end));
        let Appel { view, rounding, occluders, .. } = appel;
        let answers = layers_beyond(view, occluders, rounding, places, ends);
        self.n_sight_lines = questions.len() as u64;
        for (&(i, end, vertex), layers) in questions.iter().zip(answers) {
            let i = i as usize;
            let link = &traced[i / CHUNK].links[i % CHUNK];
            let local = link.local[end];
            match vertex {
                Some(vertex) if layers[0] - local[0] == layers[1] - local[1] => {
                    self.levels.set(vertex, layers[0] - local[0]);
                }
                Some(vertex) => {
                    self.levels.contradict(vertex);
                    self.n_failures += 1;
                }
                None => self.layers[i] = Some(first_layers(layers, end, link)),
            }
        }
        for (i, segment) in segments.iter().enumerate() {
            let Some(segment) = segment else { continue };
            let link = &traced[i / CHUNK].links[i % CHUNK];
            for (end, vertex) in self.regular_ends(segment).into_iter().enumerate() {
                if let Some(level) = vertex.and_then(|vertex| self.levels.level(vertex)) {
                    let layers = link.local[end].map(|local| level + local);
                    self.layers[i] = Some(first_layers(layers, end, link));
                    break;
                }
            }
        }
    }
}

/// The layers at a segment's first end from those at either end.
fn first_layers(layers: [i32; 2], end: usize, link: &Link) -> [i32; 2] {
    match end {
        0 => layers,
        _ => [0, 1].map(|k| layers[k] - link.total[k]),
    }
}

/// What is needed to turn counts into spans.
struct SpanBuilder<'d, 'a> {
    view: &'d ViewedScene<'a>,
    options: &'d VisibilityOptions,
    sides: &'d Sides<'a>,
    partners: &'d Groups,
    starts: &'d Starts,
}

impl SpanBuilder<'_, '_> {
    /// The spans of a chunk of segments that begins with number `first`, and the numbers of those
    /// of which nothing certain is known.
    fn spans(
        &self,
        first: usize,
        segments: &[Option<Segment>],
        chunk: &[Option<Segment>],
        traced: &Chunk,
    ) -> (Visibility, Vec<u32>) {
        let mut sweep = Sweep::default();
        let mut visibility = Visibility::default();
        let mut failed = Vec::new();
        for (i, segment) in chunk.iter().enumerate() {
            let Some(segment) = segment else {
                visibility.push(&[]);
                continue;
            };
            sweep.clear();
            sweep.start_with(self.starts.layers[first + i].unwrap_or_default());
            for change in traced.changes(i) {
                sweep.add_change(change.at, change.by);
            }
            for &partner in self.partners.of(first + i) {
                if let Some(partner) = &segments[partner as usize] {
                    self.double(segment, partner, &mut sweep);
                }
            }
            let spans = sweep.spans(self.view.sight(), segment, self.options.count_layers);
            visibility.push(spans);
            if self.starts.layers[first + i].is_none() || sweep.lowest() < 0 {
                failed.push((first + i) as u32);
            }
        }
        (visibility, failed)
    }

    /// Adds the parts of `segment` that `other` draws.
    fn double(&self, segment: &Segment, other: &Segment, sweep: &mut Sweep) {
        let tolerance = self.options.contact_tolerance;
        let [p, q] = other.ends;
        for (triangle, _) in self.sides.along_edge(self.view, other.edge) {
            let (cover, border, same_depth) =
                match shadow(self.view, segment, triangle, tolerance, true) {
                    Some(Shadow::AlongBorder(cover, border)) => (cover, border, false),
                    Some(Shadow::OnBorder(cover, border)) => (cover, border, true),
                    _ => continue,
                };
            if (border == [p, q] || border == [q, p]) && (!same_depth || other.edge < segment.edge)
            {
                sweep.add_doubled(&cover);
            }
        }
    }
}

/// The same spans, with those of some segments computed again.
fn replaced_by_roberts(
    view: &ViewedScene,
    options: &VisibilityOptions,
    again: &[Option<Segment>],
    visibility: &Visibility,
    counts: &mut LineCounts,
) -> Visibility {
    let (by_roberts, more) = roberts::solve_segments(view, options, again);
    counts.candidate_pairs += more.candidate_pairs;
    let mut merged = Visibility::default();
    for (i, segment) in again.iter().enumerate() {
        let source = if segment.is_some() { &by_roberts } else { visibility };
        merged.push(source.spans(i));
    }
    merged
}
