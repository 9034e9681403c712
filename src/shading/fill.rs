//! Fills: from the regions that a face engine found to colored areas, or areas for each ink.
//!
//! ```text
//!  engines::face ─► Painting ─► light, depth cue, materials ─► inks ────► Filled
//!                   pieces      a color for each face          nearest    areas, one layer per ink
//! ```
//!
//! Shading is flat: a face has one color, by its Newell normal. Adjacent fragments of one face make one area.
//! With inks, adjacent fragments of one ink make one area, and areas never overlap: areas painted over are
//! subtracted first.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use thiserror::Error;

use crate::camera::{Camera, Projection};
use crate::engines::face::region::Region;
use crate::engines::face::{
    FaceEngine, FaceError, FaceOptions, FaceWork, Painting, Prepared, merge,
};
use crate::model::mesh::MeshPart;
use crate::model::scene::Scene;
use crate::plot::{FillLayer, Fills};
use crate::shading::light::{
    DEFAULT_PAINT, FARTHEST, Light, LightSource, number_color, order_color, parts, to_bytes,
};

/// The maximum number of inks.
pub const MOST_INKS: usize = 64;

/// The default width of the outline that closes seams, in millimeters: thinner than any pen, and wide enough
/// where screens and printers antialias edges.
pub const DEFAULT_SEAM_MM: f64 = 0.05;

/// What the colors show.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Coloring {
    /// Faces in the light.
    #[default]
    Shaded,
    /// The paint order: blue first, then green, red last.
    Order,
    /// How near faces are: the nearest white, the farthest dark.
    Depth,
    /// The fragments that faces were split into, a color for each.
    Splits,
}

impl Coloring {
    /// All of them, in the order of the documentation.
    pub const ALL: [Self; 4] = [Self::Shaded, Self::Order, Self::Depth, Self::Splits];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Shaded => "shaded",
            Self::Order => "order",
            Self::Depth => "depth",
            Self::Splits => "splits",
        }
    }
}

/// The inks of a picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Palette {
    /// This many grays, evenly from the darkest to the lightest tone of the picture.
    Grays(usize),
    /// These colors.
    Inks(Vec<[u8; 3]>),
}

/// How faces are filled.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FillOptions {
    /// The visible-surface algorithm.
    pub engine: FaceEngine,
    /// Options of the engine.
    pub settings: FaceOptions,
    /// Areas never overlap, even if the engine paints them over each other; with a palette they never do.
    pub disjoint: bool,
    /// What the colors show.
    pub show: Coloring,
    /// Where the light comes from.
    pub light: LightSource,
    /// How much the farthest face fades into the paper, from 0 to 1; nearer faces fade less.
    pub depth_cue: f64,
    /// The color of faces whose material has none; `None` for the color of paper.
    pub paint: Option<[u8; 3]>,
    /// Colors of materials by name, for each model of the scene; they take precedence over the colors in
    /// the model itself.
    pub materials: Vec<BTreeMap<String, [u8; 3]>>,
    /// The inks; `None` for any number of colors.
    pub palette: Option<Palette>,
}

impl FillOptions {
    /// The visible-surface algorithm.
    #[must_use]
    pub fn engine(self, engine: FaceEngine) -> Self {
        Self { engine, ..self }
    }

    /// Uses only these inks, each on its own layer.
    #[must_use]
    pub fn palette(self, palette: Palette) -> Self {
        Self { palette: Some(palette), ..self }
    }

    /// The color of faces whose material has none, as red, green and blue.
    #[must_use]
    pub fn paint(self, color: [u8; 3]) -> Self {
        Self { paint: Some(color), ..self }
    }

    /// Where the light comes from.
    #[must_use]
    pub fn light(self, light: LightSource) -> Self {
        Self { light, ..self }
    }

    /// How much the farthest face fades into the paper, from 0 to 1.
    #[must_use]
    pub fn depth_cue(self, share: f64) -> Self {
        Self { depth_cue: share, ..self }
    }

    /// Areas never overlap.
    #[must_use]
    pub fn disjoint(self) -> Self {
        Self { disjoint: true, ..self }
    }
}

/// Why faces cannot be filled.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum FillError {
    /// The engine cannot handle the scene.
    #[error(transparent)]
    Engine(#[from] FaceError),
    /// A palette without inks or with too many.
    #[error("a palette has from 1 to {MOST_INKS} inks, not {0}")]
    Inks(usize),
    /// A palette is for shaded pictures.
    #[error("order, depth and splits need many colors; leave out the palette")]
    DebugInks,
    /// The engine does not paint one face over another.
    #[error("{0} makes areas side by side, and painting over needs them from far to near")]
    NotPaintedOver(&'static str),
}

/// A filled picture, in image coordinates.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Filled {
    /// One layer, or one for each ink that occurs, in the order of the palette.
    pub layers: Vec<FillLayer>,
    /// The engine that found the regions.
    pub engine: FaceEngine,
    /// Whether no area overlaps another.
    pub is_disjoint: bool,
    /// How many fragments the engine made.
    pub n_pieces: usize,
    /// How much work the engine did, if it found the regions.
    pub work: Option<FaceWork>,
}

/// Fills the visible regions of a scene's faces.
///
/// # Errors
/// See [`FillError`].
pub fn fill(scene: &Scene, camera: &Camera, options: &FillOptions) -> Result<Filled, FillError> {
    options.check()?;
    fill_prepared(&Prepared::new(scene, options.engine)?, camera, options)
}

/// The same for a scene prepared for an engine, as for many views of it; the engine in the options is
/// ignored.
///
/// # Errors
/// See [`FillError`].
pub fn fill_prepared(
    prepared: &Prepared,
    camera: &Camera,
    options: &FillOptions,
) -> Result<Filled, FillError> {
    fill_prepared_watched(prepared, camera, options, &mut |_| {})
}

/// The share of the time after which the engine is done, roughly.
const SHARE_OF_ENGINE: f64 = 0.8;

/// The same, and calls `watch` with the share of the work done, as far as it is known: after each step.
///
/// # Errors
/// As [`fill_prepared`].
pub fn fill_prepared_watched(
    prepared: &Prepared,
    camera: &Camera,
    options: &FillOptions,
    watch: &mut dyn FnMut(f64),
) -> Result<Filled, FillError> {
    options.check()?;
    watch(0.0);
    let (painting, work) = prepared.solve(camera, &options.settings)?;
    watch(SHARE_OF_ENGINE);
    let filled = fill_painting(prepared.scene(), camera, &painting, work.engine(), options);
    Ok(Filled { work: Some(work), ..filled })
}

impl FillOptions {
    /// Checks that the options can be combined.
    ///
    /// # Errors
    /// [`FillError::Inks`], [`FillError::DebugInks`].
    pub fn check(&self) -> Result<(), FillError> {
        let n = match &self.palette {
            None => return Ok(()),
            Some(Palette::Grays(n)) => *n,
            Some(Palette::Inks(inks)) => inks.len(),
        };
        if self.show != Coloring::Shaded {
            return Err(FillError::DebugInks);
        }
        if (1..=MOST_INKS).contains(&n) { Ok(()) } else { Err(FillError::Inks(n)) }
    }
}

/// Fills known regions.
pub fn fill_painting(
    scene: &Scene,
    camera: &Camera,
    painting: &Painting,
    engine: FaceEngine,
    options: &FillOptions,
) -> Filled {
    let colors = colors(scene, camera, painting, options);
    let n_pieces = painting.len();
    let wants_disjoint = options.disjoint || options.palette.is_some();
    let debugs_pieces = matches!(options.show, Coloring::Order | Coloring::Splits);
    let layers = match &options.palette {
        Some(palette) => layers_by_ink(painting, &colors, palette),
        None if painting.is_disjoint || !wants_disjoint || debugs_pieces => {
            vec![as_painted(painting, &colors)]
        }
        None => {
            let (regions, grid) = merge::seen(painting);
            let mut faces: Vec<(u32, Vec<Region>)> = painting
                .pieces()
                .map(|piece| piece.face)
                .zip(regions.into_iter().map(|r| vec![r]))
                .collect();
            faces.sort_by_key(|(face, _)| *face);
            let color_of: BTreeMap<u32, [u8; 3]> =
                painting.pieces().map(|piece| piece.face).zip(colors).collect();
            let merged = merge::by_face(faces, &grid);
            let colors: Vec<[u8; 3]> = merged
                .pieces()
                .map(|piece| color_of.get(&piece.face).copied().unwrap_or(DEFAULT_PAINT))
                .collect();
            vec![as_painted(&merged, &colors)]
        }
    };
    let is_disjoint = painting.is_disjoint || wants_disjoint && !debugs_pieces;
    Filled { layers, engine, is_disjoint, n_pieces, work: None }
}

/// The color of each piece.
fn colors(
    scene: &Scene,
    camera: &Camera,
    painting: &Painting,
    options: &FillOptions,
) -> Vec<[u8; 3]> {
    let faces: Vec<u32> = painting.pieces().map(|piece| piece.face).collect();
    let last = faces.len().saturating_sub(1).max(1) as f64;
    match options.show {
        Coloring::Order => {
            (0..faces.len()).map(|number| order_color(number as f64 / last)).collect()
        }
        Coloring::Splits => {
            (0..faces.len() as u32).map(|number| to_bytes(number_color(number))).collect()
        }
        Coloring::Shaded | Coloring::Depth => {
            let shader = Shader::new(scene, camera, &faces, options);
            faces.par_iter().map(|&face| to_bytes(shader.color(face))).collect()
        }
    }
}

struct Shader<'a> {
    scene: &'a Scene,
    camera: &'a Camera,
    light: Light,
    show: Coloring,
    depth_cue: f64,
    paint: DVec3,
    /// The color of each part of the mesh.
    part_paints: Vec<DVec3>,
    /// Least and greatest distance of the faces.
    distances: (f64, f64),
}

impl<'a> Shader<'a> {
    fn new(scene: &'a Scene, camera: &'a Camera, faces: &[u32], options: &FillOptions) -> Self {
        let paint = parts(options.paint.unwrap_or(DEFAULT_PAINT));
        let of_part = |part: &MeshPart| {
            let colors = options.materials.get(part.model as usize);
            let named = colors.and_then(|colors| colors.get(&part.material)).copied();
            named.or(part.color).map_or(paint, parts)
        };
        let mut shader = Self {
            scene,
            camera,
            light: Light::new(options.light, camera),
            show: options.show,
            depth_cue: options.depth_cue.clamp(0.0, 1.0),
            paint,
            part_paints: scene.mesh().parts().iter().map(of_part).collect(),
            distances: (0.0, 1.0),
        };
        let range = |a: (f64, f64), b: (f64, f64)| (a.0.min(b.0), a.1.max(b.1));
        let distances = faces.par_iter().map(|&face| shader.distance(face));
        shader.distances =
            distances.map(|d| (d, d)).reduce(|| (f64::INFINITY, f64::NEG_INFINITY), range);
        shader
    }

    /// The mean distance of a face's corners along the direction of view.
    fn distance(&self, face: u32) -> f64 {
        let corners = self.scene.mesh().face(face);
        let forward = self.camera.frame().forward;
        let sum: f64 = corners
            .iter()
            .map(|&v| (self.scene.mesh().positions()[v as usize] - self.camera.eye()).dot(forward))
            .sum();
        sum / corners.len().max(1) as f64
    }

    fn color(&self, face: u32) -> DVec3 {
        let (nearest, farthest) = self.distances;
        let part = ((self.distance(face) - nearest) / (farthest - nearest)).clamp(0.0, 1.0);
        let part = if part.is_nan() { 0.0 } else { part };
        if self.show == Coloring::Depth {
            return DVec3::splat(1.0 - part * (1.0 - FARTHEST));
        }
        let positions = self.scene.mesh().positions();
        let corners = self.scene.mesh().face(face);
        let normal = self.scene.normals()[face as usize];
        let first = corners.first().map_or(DVec3::ZERO, |&v| positions[v as usize]);
        let sight = match self.camera.projection() {
            Projection::Perspective { .. } => first - self.camera.eye(),
            Projection::Orthographic => self.camera.forward(),
        };
        let towards = if normal.dot(sight) > 0.0 { -normal } else { normal };
        let part_of = self.scene.mesh().face_parts().get(face as usize);
        let paint = part_of.and_then(|&part| self.part_paints.get(part as usize));
        let sum: DVec3 = corners.iter().map(|&v| positions[v as usize]).sum();
        let middle = sum / corners.len().max(1) as f64;
        let lit =
            *paint.unwrap_or(&self.paint) * self.light.tone(towards.normalize_or_zero(), middle);
        lit.lerp(DVec3::ONE, self.depth_cue * part)
    }
}

/// The pieces as they are.
fn as_painted(painting: &Painting, colors: &[[u8; 3]]) -> FillLayer {
    let mut fills = Fills::default();
    for (piece, &color) in painting.pieces().zip(colors) {
        fills.push(color, piece.rings().map(|ring| ring.points.iter().copied()));
    }
    FillLayer { name: "fills".into(), color: colors.first().copied().unwrap_or_default(), fills }
}

/// The pieces nearest to each ink, joined ink by ink.
fn layers_by_ink(painting: &Painting, colors: &[[u8; 3]], palette: &Palette) -> Vec<FillLayer> {
    let inks = inks(colors, palette);
    let (regions, grid) = merge::seen(painting);
    let mut of_ink: Vec<Vec<&Region>> = vec![Vec::new(); inks.len()];
    for (region, color) in regions.iter().zip(colors) {
        of_ink[nearest(&inks, *color)].push(region);
    }
    let joined: Vec<Region> = of_ink.into_par_iter().map(Region::union).collect();
    let mut layers = Vec::new();
    for (number, (color, region)) in inks.into_iter().zip(joined).enumerate() {
        let mut fills = Fills::default();
        for part in region.parts() {
            let point = |side: &crate::engines::face::region::RegionSide| grid.point(side.from);
            fills.push(
                color,
                part.iter().map(|ring| ring.iter().map(point).collect::<Vec<DVec2>>()),
            );
        }
        if !fills.is_empty() {
            layers.push(FillLayer { name: format!("ink{}", number + 1), color, fills });
        }
    }
    layers
}

fn inks(colors: &[[u8; 3]], palette: &Palette) -> Vec<[u8; 3]> {
    match palette {
        Palette::Inks(inks) => inks.clone(),
        Palette::Grays(n) => {
            let tone =
                |color: &[u8; 3]| color.iter().map(|&part| f64::from(part)).sum::<f64>() / 3.0;
            let tones = colors.iter().map(tone);
            let (low, high) = tones
                .fold((255.0_f64, 0.0_f64), |(low, high), tone| (low.min(tone), high.max(tone)));
            let of = |k: usize| match n {
                1 => (low + high) / 2.0,
                _ => low + (high - low) * k as f64 / (n - 1) as f64,
            };
            (0..*n).map(|k| [of(k).round().clamp(0.0, 255.0) as u8; 3]).collect()
        }
    }
}

/// The ink with the least difference in red, green and blue; of equal ones the first.
fn nearest(inks: &[[u8; 3]], color: [u8; 3]) -> usize {
    let difference = |ink: &[u8; 3]| {
        ink.iter().zip(color).map(|(&a, b)| (i32::from(a) - i32::from(b)).pow(2)).sum::<i32>()
    };
    (0..inks.len()).min_by_key(|&ink| difference(&inks[ink])).unwrap_or_default()
}
