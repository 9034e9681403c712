//! One view of a scene: which faces face the eye, which edges are drawn, and why.
//!
//! Faces are *front*, *back* or *edge-on* by the exact sign of their Newell normal against the
//! direction to the eye. Edges take the first kind that applies:
//!
//! | kind | uses | condition |
//! |---|---|---|
//! | boundary | 1 | |
//! | nonmanifold | 3 or more | |
//! | silhouette | 2 | one face front, the other not |
//! | crease | 2 | angle between the normals above a threshold |
//! | material | 2 | between two materials or groups; only when requested |
//! | mesh | any | |
//! | intersection | none | the line in which two faces cross |
//! | wire | none | a polyline of the model that borders no face |
//!
//! A bend of a face (see [`crate::model::bends`]) is a silhouette when one of the triangles along it
//! faces the eye and the other does not.
//!
//! When both uses run the same way, the faces are wound inconsistently; the second face is then
//! flipped for the comparison, so kinds do not depend on the winding.

mod segments;
mod selection;

use crate::camera::{Camera, ImageError, ImagePoint};
use crate::model::creases::CreaseAngle;
use crate::model::scene::{LineSource, Scene};
use crate::model::topology::EdgeUse;
use crate::predicates::{Kept, Sight, Sign, exact};
use crate::strokes::{StrokeKind, SurfacePart};
use glam::DVec3;
use rayon::prelude::*;

pub use self::segments::ViewSegments;
pub use self::selection::LineSelection;

/// The default crease angle: faces that meet at more than this angle, in degrees, form a crease.
pub const DEFAULT_CREASE_DEG: f64 = 30.0;

/// An edge to draw.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SelectedLine {
    /// Its number among the lines of the view; see [`ViewedScene::line`].
    pub edge: u32,
    /// Why it is drawn.
    pub kind: StrokeKind,
    /// The part of a surface that it belongs to.
    pub part: SurfacePart,
}

impl SelectedLine {
    /// A line that belongs to no part of a surface.
    pub fn new(edge: u32, kind: StrokeKind) -> Self {
        Self { edge, kind, part: SurfacePart::default() }
    }
}

/// A scene as one camera sees it, with the edges to draw.
#[derive(Debug)]
pub struct ViewedScene<'a> {
    scene: &'a Scene,
    camera: Camera,
    sight: Sight<'a>,
    image: Vec<ImagePoint>,
    triangle_turns: Vec<Sign>,
    /// Empty when every face is a triangle, since the turns then say it all.
    facings: Vec<Sign>,
    uneven: Option<Vec<u32>>,
    drawn: Vec<SelectedLine>,
    /// The lines in `drawn` that are drawn only where they are outline.
    only_outline: Vec<u32>,
    near_plane_cuts: bool,
    /// Whether bends and flush edges that the scene knows make a difference.
    is_tidied: bool,
    own: Option<&'a ViewSegments>,
    /// [`Scene::planes`], where the view has segments of its own.
    planes: &'a [u32],
}

impl<'a> ViewedScene<'a> {
    /// Classifies faces and edges; edges of the kinds in `lines` are drawn, in the order of the
    /// topology.
    ///
    /// An edge is selected by any kind that applies to it, and gets the first of its kinds. Edges whose
    /// image is a point are left out. `crease_deg` is in degrees. O(faces + edges), in parallel.
    pub fn new(scene: &'a Scene, camera: &Camera, lines: LineSelection, crease_deg: f64) -> Self {
        Self::with(scene, camera, lines, CreaseRule::above(crease_deg), true, None)
    }

    /// The same for the faces exactly as given: bends and flush edges that the scene knows make no
    /// difference.
    pub fn as_given(
        scene: &'a Scene,
        camera: &Camera,
        lines: LineSelection,
        crease_deg: f64,
    ) -> Self {
        Self::with(scene, camera, lines, CreaseRule::above(crease_deg), false, None)
    }

    /// The same as [`new`](Self::new) where `is_crease` says for each edge of the scene whether it is a
    /// crease, as [`CreaseChains`](crate::model::creases::CreaseChains) do.
    pub fn with_creases(
        scene: &'a Scene,
        camera: &Camera,
        lines: LineSelection,
        is_crease: &[bool],
    ) -> Self {
        Self::with(scene, camera, lines, CreaseRule::Chosen(is_crease), true, None)
    }

    /// The same with additional segments, all of which are drawn. They are numbered after the lines of
    /// the scene.
    pub fn with_segments(
        scene: &'a Scene,
        camera: &Camera,
        lines: LineSelection,
        crease_deg: f64,
        segments: &'a ViewSegments,
    ) -> Self {
        Self::with(scene, camera, lines, CreaseRule::above(crease_deg), true, Some(segments))
    }

    fn with(
        scene: &'a Scene,
        camera: &Camera,
        lines: LineSelection,
        rule: CreaseRule,
        is_tidied: bool,
        own: Option<&'a ViewSegments>,
    ) -> Self {
        let positions = scene.mesh().positions();
        let (points, constructed) = match own {
            Some(own) => (&own.points[..], &own.constructed[..]),
            None => (scene.points(), scene.intersections().points()),
        };
        let sight = Sight::with_pierced(points, constructed, camera);
        let (eye, frame) = (camera.eye(), camera.frame());
        let image = |d: DVec3| ImagePoint::new(d, camera, &frame);
        let mut images: Vec<ImagePoint> = Vec::with_capacity(points.len());
        images.par_extend(positions.par_iter().map(|&p| image(p - eye)));
        // With the rest of what is rounded they are as good as images of vertices.
        let constructed = constructed.par_iter();
        images.par_extend(constructed.map(|p| image(p.rounded() - eye + p.rest())));
        let near_plane_cuts = (0..positions.len() as u32)
            .into_par_iter()
            .any(|vertex| sight.near_distance(vertex).1 != Sign::Positive);
        let triangle_turns = turns(scene, &sight, &images[..positions.len()], near_plane_cuts);
        let n_faces = scene.mesh().n_faces() as u32;
        let facings = if scene.triangles().len() == n_faces as usize {
            Vec::new()
        } else {
            let facing = |face| sight.facing(scene.mesh().face(face));
            (0..n_faces).into_par_iter().map(facing).collect()
        };
        let uneven = facings.is_empty().then(|| uneven_edges(scene, &triangle_turns));
        let mut view = Self {
            scene,
            camera: *camera,
            sight,
            image: images,
            triangle_turns,
            facings,
            uneven,
            drawn: Vec::new(),
            only_outline: Vec::new(),
            near_plane_cuts,
            is_tidied,
            own,
            planes: own.map_or(&[], |_| scene.planes()),
        };
        let selected = view.select(lines, rule);
        let only_outline = selected.iter().filter(|(_, is_whole)| !is_whole);
        view.only_outline = only_outline.map(|(drawn, _)| drawn.edge).collect();
        view.drawn = selected.into_iter().map(|(drawn, _)| drawn).collect();
        view
    }

    /// Draws the given edges and no others, whatever kinds apply to them.
    ///
    /// They may come in any order. An edge listed more than once is a silhouette if any of its kinds is, and
    /// otherwise gets the last of its kinds in the order of [`StrokeKind`]; edges whose image is a point are
    /// left out. Panics when an edge does not exist. O(faces + edges log edges).
    pub fn with_edges(scene: &'a Scene, camera: &Camera, mut edges: Vec<SelectedLine>) -> Self {
        let mut view = Self::new(scene, camera, LineSelection::NONE, DEFAULT_CREASE_DEG);
        edges.par_sort_unstable_by_key(|drawn| {
            let is_fold = drawn.kind == StrokeKind::Silhouette;
            (drawn.edge, !is_fold, std::cmp::Reverse((drawn.kind, drawn.part)))
        });
        edges.dedup_by_key(|drawn| drawn.edge);
        edges.retain(|drawn| {
            let [a, b] = view.line(drawn.edge);
            !view.sight.same_image(a, b)
        });
        view.drawn = edges;
        view
    }

    /// The scene.
    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// The ends of a line of the scene, or of a segment added by the view, as numbers of points.
    /// Panics when there is no such line.
    #[inline]
    pub fn line(&self, line: u32) -> [u32; 2] {
        match self.own {
            Some(own) if line as usize >= self.scene.n_lines() => {
                own.ends[line as usize - self.scene.n_lines()]
            }
            _ => self.scene.line(line),
        }
    }

    /// Whether a line is known to lie in a triangle's plane: an intersection line of faces in that plane,
    /// or a segment of the view in a flat side of the model that the triangle is part of. The sign is then
    /// known.
    #[inline]
    pub fn is_known_in_plane_of(&self, line: u32, triangle: u32) -> bool {
        if let Some(own) = self.own
            && let Some(segment) = (line as usize).checked_sub(self.scene.n_lines())
        {
            let [first, end] = own.within[segment];
            let in_plane = |own: u32| self.planes[own as usize] == self.planes[triangle as usize];
            return (first..end).contains(&triangle) || first < end && in_plane(first);
        }
        match self.scene.source(line) {
            Some(LineSource::Intersection(k)) => {
                let crossings = self.scene.intersections();
                crossings.is_in_plane_of(&crossings.lines()[k as usize], triangle)
            }
            _ => false,
        }
    }

    /// Keeps only those lines to draw whose numbers pass `is_kept`.
    pub fn keep(&mut self, is_kept: impl Fn(u32) -> bool) {
        self.drawn.retain(|drawn| is_kept(drawn.edge));
    }

    /// The camera.
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The exact predicates for this view.
    pub fn sight(&self) -> &Sight<'a> {
        &self.sight
    }

    /// The image of every vertex, and of the constructed points.
    pub fn image(&self) -> &[ImagePoint] {
        &self.image
    }

    /// How far the images may be from the truth.
    pub fn image_error(&self) -> ImageError {
        ImageError::new(self.sight.has_near_plane(), self.sight.size())
    }

    /// The turn of every triangle's image, positive when counter-clockwise.
    pub fn triangle_turns(&self) -> &[Sign] {
        &self.triangle_turns
    }

    /// Which way a face faces: positive front, negative back, zero edge-on.
    pub fn facing(&self, face: u32) -> Sign {
        let facings = if self.facings.is_empty() { &self.triangle_turns } else { &self.facings };
        facings[face as usize]
    }

    /// The edges that are not known to be *even*, with one triangle on each side of their image, in order;
    /// `None` when there are faces of more than three corners. Silhouettes are among them.
    pub fn uneven_edges(&self) -> Option<&[u32]> {
        self.uneven.as_deref()
    }

    /// What to draw, by number: edges in the order of the topology, then the other lines of the scene,
    /// then the segments added by the view.
    pub fn selected(&self) -> &[SelectedLine] {
        &self.drawn
    }

    /// Whether an edge is among the drawn ones. O(log drawn).
    pub fn is_selected(&self, edge: u32) -> bool {
        self.drawn.binary_search_by_key(&edge, |drawn| drawn.edge).is_ok()
    }

    /// Whether an edge is drawn only where it is outline. O(log edges).
    pub fn is_only_outline(&self, edge: u32) -> bool {
        self.only_outline.binary_search(&edge).is_ok()
    }

    /// Whether any vertex is not strictly beyond the near plane.
    pub fn near_plane_cuts(&self) -> bool {
        self.near_plane_cuts
    }

    /// The part of a triangle beyond the near plane. Exact.
    #[inline]
    pub fn kept(&self, triangle: u32) -> Kept {
        match self.near_plane_cuts {
            true => self.sight.kept_of_triangle(self.scene.triangles()[triangle as usize]),
            false => Kept::All,
        }
    }

    /// The edges to draw, each with whether all of it is drawn and not only the outline.
    fn select(&self, lines: LineSelection, rule: CreaseRule) -> Vec<(SelectedLine, bool)> {
        let n_edges = self.scene.topology().edges().len() as u32;
        let creases = Creases::new(self.scene, lines, rule);
        let of_outline = LineSelection::NONE
            .with(StrokeKind::Silhouette)
            .with(StrokeKind::Boundary)
            .with(StrokeKind::Nonmanifold);
        let selected = |edge: u32| {
            let whole = self.kind(edge, lines, &creases);
            let kind = whole.or_else(|| {
                let outlined = lines.has_outline();
                outlined.then(|| self.kind(edge, of_outline, &creases))?
            })?;
            let [a, b] = self.scene.topology().edge(edge);
            let drawn = (SelectedLine::new(edge, kind), whole.is_some());
            (!self.sight.same_image(a, b)).then_some(drawn)
        };
        let even_kinds = [StrokeKind::Crease, StrokeKind::Material, StrokeKind::Mesh];
        let takes_even = even_kinds.into_iter().any(|kind| lines.contains(kind));
        let mut drawn: Vec<(SelectedLine, bool)> = match &self.uneven {
            Some(uneven) if !takes_even => {
                uneven.par_iter().with_min_len(4096).filter_map(|&edge| selected(edge)).collect()
            }
            _ => (0..n_edges).into_par_iter().with_min_len(4096).filter_map(selected).collect(),
        };
        let others = self.other_lines(lines, &drawn);
        drawn.extend(others);
        if let Some(own) = self.own {
            let first = self.scene.n_lines() as u32;
            let segments = (first..).zip(own.ends.iter().zip(&own.kinds));
            let seen = segments.filter(|(_, (ends, _))| !self.sight.same_image(ends[0], ends[1]));
            drawn.extend(seen.map(|(edge, (_, &kind))| (SelectedLine::new(edge, kind), true)));
        }
        drawn
    }

    /// The lines to draw beside the edges that are `drawn`: bends that are silhouettes, wires, parts of
    /// boundary edges, and intersection lines that are not part of one of these edges.
    fn other_lines(
        &self,
        lines: LineSelection,
        drawn: &[(SelectedLine, bool)],
    ) -> Vec<(SelectedLine, bool)> {
        let is_drawn =
            |edge: u32| drawn.binary_search_by_key(&edge, |(drawn, _)| drawn.edge).is_ok();
        let is_front = |triangle: u32| self.triangle_turns[triangle as usize] == Sign::Positive;
        let has_folds = lines.contains(StrokeKind::Silhouette);
        let every = lines.contains(StrokeKind::Mesh);
        let has_boundary = every || lines.contains(StrokeKind::Boundary);
        let parts = self.scene.boundary_parts();
        let (crossings, bends) = (self.scene.intersections().lines(), self.scene.bends());
        let kind = |source| match source {
            LineSource::Intersection(k) => {
                let crossing = &crossings[k as usize];
                let is_wanted = lines.contains(StrokeKind::Intersection);
                (is_wanted && !crossing.edges().any(is_drawn)).then_some(StrokeKind::Intersection)
            }
            LineSource::Bend(_) | LineSource::BoundaryPart(_) if !self.is_tidied => None,
            LineSource::Bend(k) => {
                let [one, other] = bends[k as usize].triangles.map(is_front);
                let is_wanted = has_folds || lines.has_outline();
                (is_wanted && one != other).then_some(StrokeKind::Silhouette)
            }
            LineSource::Wire(_) => lines.contains(StrokeKind::Wire).then_some(StrokeKind::Wire),
            LineSource::BoundaryPart(k) if parts[k as usize].is_flush => {
                let [from, to] = parts[k as usize].ends;
                // An edge of the face beyond is drawn in its place.
                let edge = self.scene.topology().find_edge(from, to);
                let is_drawn = edge.is_some_and(|edge| !self.scene.is_split(edge));
                (every && !is_drawn).then_some(StrokeKind::Mesh)
            }
            LineSource::BoundaryPart(_) => {
                let is_wanted = has_boundary || lines.has_outline();
                is_wanted.then_some(StrokeKind::Boundary)
            }
        };
        let first = self.scene.topology().edges().len() as u32;
        let others = self.scene.other_lines();
        let numbered = others.par_iter().zip(first..first + others.len() as u32);
        numbered
            .filter_map(|(line, edge)| {
                let kind = kind(line.source)?;
                let is_whole = match line.source {
                    LineSource::Bend(_) => has_folds,
                    LineSource::BoundaryPart(_) => has_boundary,
                    LineSource::Intersection(_) | LineSource::Wire(_) => true,
                };
                let is_seen = !self.sight.same_image(line.ends[0], line.ends[1]);
                is_seen.then_some((SelectedLine::new(edge, kind), is_whole))
            })
            .collect()
    }

    /// Which way a face faces along one of its edges: that of its triangle there if the face is known
    /// to be bent.
    fn facing_along(&self, face: u32, edge: u32) -> Sign {
        if !self.is_tidied || !self.scene.is_bent(face) {
            return self.facing(face);
        }
        let ends = self.scene.topology().edge(edge);
        let faces = self.scene.triangle_faces();
        let first = faces.partition_point(|&of| of < face);
        let mut triangles = (first..faces.len()).take_while(|&triangle| faces[triangle] == face);
        let along =
            triangles.find(|&t| ends.iter().all(|end| self.scene.triangles()[t].contains(end)));
        let Some(triangle) = along else { return self.facing(face) };
        let turn = self.triangle_turns[triangle];
        let corners = self.scene.triangles()[triangle];
        let [p, q, r] = corners.map(|vertex| self.scene.mesh().positions()[vertex as usize]);
        // A triangle without area faces nowhere.
        if turn == Sign::Zero && exact::collinear(p, q, r) { self.facing(face) } else { turn }
    }

    /// The first kind that applies to an edge, when any that applies is among `lines`.
    fn kind(&self, edge: u32, lines: LineSelection, creases: &Creases) -> Option<StrokeKind> {
        let topology = self.scene.topology();
        let every = lines.contains(StrokeKind::Mesh);
        let by_material = || {
            lines.contains(StrokeKind::Material) && creases.lie_between_groups(topology.uses(edge))
        };
        let chosen = |kind| (every || lines.contains(kind)).then_some(kind);
        let &[first, second] = topology.uses(edge) else {
            let kind = match topology.uses(edge) {
                [_] if self.is_tidied && self.scene.is_split(edge) => return None,
                [_] if self.is_tidied && self.scene.is_flush(edge) => StrokeKind::Mesh,
                [_] => StrokeKind::Boundary,
                _ => StrokeKind::Nonmanifold,
            };
            return chosen(kind).or_else(|| by_material().then_some(kind));
        };
        let faces = [first, second].map(EdgeUse::face);
        let against = first.runs_upwards() == second.runs_upwards();
        let [facing, other] = faces.map(|face| self.facing_along(face, edge));
        let other = if against { other.flipped() } else { other };
        let is_crease = || creases.has(edge);
        if (facing == Sign::Positive) != (other == Sign::Positive) {
            let by_crease = || lines.contains(StrokeKind::Crease) && is_crease();
            let by_name = every || lines.contains(StrokeKind::Silhouette);
            let selected = by_name || by_crease() || by_material();
            return selected.then_some(StrokeKind::Silhouette);
        }
        let is_border = by_material();
        if !every && !is_border && !lines.contains(StrokeKind::Crease) {
            return None;
        }
        match (is_crease(), is_border) {
            (true, false) => chosen(StrokeKind::Crease),
            (true, true) => Some(StrokeKind::Crease),
            (false, true) => Some(StrokeKind::Material),
            (false, false) => chosen(StrokeKind::Mesh),
        }
    }
}

/// The turn of the image of every triangle.
///
/// Exact. Images in single precision decide nearly all of them, and are quickly read.
fn turns(scene: &Scene, sight: &Sight, images: &[ImagePoint], near_plane_cuts: bool) -> Vec<Sign> {
    let exact = |&[p, q, r]: &[u32; 3]| sight.turn(p, q, r);
    let triangles = scene.triangles().par_iter();
    if near_plane_cuts || !sight.has_filters() {
        return triangles.map(exact).collect();
    }
    let single = |point: &ImagePoint| point.image().to_array().map(|x| x as f32);
    let images: Vec<[f32; 2]> = images.par_iter().map(single).collect();
    let sizes = images.par_iter().map(|[x, y]| x.abs() + y.abs());
    let size = f64::from(sizes.reduce(|| 0.0, f32::max));
    let error = ImageError::new(sight.has_near_plane(), sight.size());
    // Rounding to single precision adds half of its epsilon.
    let error = error.of_coordinate(size) + size * f64::from(f32::EPSILON);
    triangles
        .map(|corners| {
            let [a, b, c] = corners.map(|corner| images[corner as usize].map(f64::from));
            let (along, to) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
            let area = along[0] * to[1] - along[1] * to[0];
            let reach = along[0].abs() + along[1].abs() + to[0].abs() + to[1].abs();
            // Each factor is off by two errors; products round by far less than the rest.
            let slack = 4.0 * error * (reach + 4.0 * error);
            if area.abs() > slack { Sign::of(area) } else { exact(corners) }
        })
        .collect()
}

/// The edges that are not surely even: those without exactly two triangles, wound alike, that both face
/// the eye or both face away from it. The triangles must be the faces.
fn uneven_edges(scene: &Scene, turns: &[Sign]) -> Vec<u32> {
    let topology = scene.topology();
    let is_even = |edge: u32| match *topology.uses(edge) {
        [a, b] => {
            let turn = turns[a.face() as usize];
            turn != Sign::Zero
                && turn == turns[b.face() as usize]
                && a.runs_upwards() != b.runs_upwards()
        }
        _ => false,
    };
    let edges = (0..topology.edges().len() as u32).into_par_iter().with_min_len(4096);
    edges.filter(|&edge| !is_even(edge)).collect()
}

/// What is needed to find creases and borders of materials, if they are drawn.
struct Creases<'a> {
    scene: &'a Scene,
    rule: CreaseRule<'a>,
    /// For each face a number that faces of equal group and material share, or empty.
    groups: &'a [u32],
}

/// Which edges are creases.
#[derive(Debug, Clone, Copy)]
enum CreaseRule<'a> {
    Above(CreaseAngle),
    Chosen(&'a [bool]),
}

impl CreaseRule<'_> {
    fn above(crease_deg: f64) -> Self {
        Self::Above(CreaseAngle::from_degrees(crease_deg))
    }
}

impl<'a> Creases<'a> {
    fn new(scene: &'a Scene, lines: LineSelection, rule: CreaseRule<'a>) -> Self {
        let has_materials = lines.contains(StrokeKind::Material);
        let is_measured = matches!(rule, CreaseRule::Above(_))
            && (has_materials
                || lines.contains(StrokeKind::Crease)
                || lines.contains(StrokeKind::Mesh));
        if is_measured {
            // Once, before many threads ask.
            scene.dihedrals();
        }
        Self { scene, rule, groups: if has_materials { scene.groups() } else { &[] } }
    }

    /// Whether the faces along an edge are not all of one group and material.
    fn lie_between_groups(&self, uses: &[EdgeUse]) -> bool {
        let group = |along: &EdgeUse| self.groups.get(along.face() as usize);
        uses.windows(2).any(|pair| group(&pair[0]) != group(&pair[1]))
    }

    fn has(&self, edge: u32) -> bool {
        match self.rule {
            CreaseRule::Above(angle) => angle.is_exceeded(self.scene, edge),
            CreaseRule::Chosen(is_crease) => is_crease[edge as usize],
        }
    }
}
