//! The text of a legend of a surface, and the dashes that distinguish sheets.

use super::dashes::Pattern;
use super::levels::LevelSet;
use super::options::{Legend, SurfaceLines};
use crate::axes::{LegendEntry, LegendPlace};
use crate::page::pen_of;
use crate::plot::Pen;
use crate::strokes::{GridFamily, Stroke, StrokeKind, Strokes, SurfacePart};
use crate::surface::SampledSurface;

/// Lengths of dashes and gaps of sheets whose pens look alike, in millimeters: one sheet for each.
const DASHES_MM: [&[f64]; 4] = [&[], &[4.0, 1.0], &[1.0, 1.0], &[4.0, 1.0, 1.0, 1.0]];

/// The entries of a legend, and the dashes of each sheet.
#[derive(Debug, Clone, Default)]
pub struct LegendText {
    pub(super) place: LegendPlace,
    pub(super) pen_width_mm: f64,
    pub(super) entries: Vec<LegendEntry>,
    dashes: Vec<&'static [f64]>,
    /// How many sheets look like another one.
    pub(super) n_alike: usize,
}

impl LegendText {
    pub(super) fn new(
        legend: &Legend,
        names: &[String],
        surface: &SampledSurface,
        lines: &SurfaceLines,
        levels: &LevelSet,
    ) -> Self {
        let (place, pen_width_mm) = (legend.place, legend.pen_width_mm);
        let mut text = Self { place, pen_width_mm, ..Self::default() };
        let has_levels = lines.levels.is_some();
        let sample = sample(surface, lines, has_levels);
        // The levels of a single sheet have their own entry.
        let sample = sample.filter(|(kind, _)| names.len() > 1 || *kind != StrokeKind::Level);
        let mut pens: Vec<Pen> = Vec::new();
        for (name, sheet) in names.iter().zip(1..) {
            let Some((kind, family)) = sample else { break };
            let part = SurfacePart { sheet, level: 0, family };
            let pen = pen_of(&legend.pens, legend.pen_width_mm, &shown(kind, part));
            let n_before = pens.iter().filter(|other| **other == pen).count();
            text.n_alike += usize::from(n_before >= DASHES_MM.len());
            let dashes = DASHES_MM[n_before % DASHES_MM.len()];
            pens.push(pen);
            text.dashes.push(dashes);
            let samples = vec![(kind, part)];
            text.entries.push(LegendEntry { text: name.clone(), samples, dashes });
        }
        if has_levels {
            let index = levels.has_index().then_some(StrokeKind::Index);
            let kinds = std::iter::once(StrokeKind::Level).chain(index);
            let samples = kinds.map(|kind| (kind, SurfacePart::default())).collect();
            text.entries.push(LegendEntry { text: levels.described(), samples, dashes: &[] });
        }
        text
    }

    /// Cuts the lines of sheets that have dashes, in image coordinates with `mm` millimeters to a unit.
    pub(super) fn dashed(
        &self,
        drawing: Strokes,
        is_dashed: impl Fn(&Stroke) -> bool,
        mm: f64,
    ) -> Strokes {
        if self.dashes.iter().all(|dashes| dashes.is_empty()) {
            return drawing;
        }
        let mut result = Strokes::default();
        for stroke in drawing.iter() {
            let sheet = usize::from(stroke.part.sheet).checked_sub(1);
            let dashes = sheet.and_then(|sheet| self.dashes.get(sheet)).copied().unwrap_or(&[]);
            if dashes.is_empty() || stroke.kind == StrokeKind::Label || is_dashed(&stroke) {
                result.push_like(&stroke, stroke.points.iter().copied());
                continue;
            }
            for part in Pattern::new(dashes, mm).parts(stroke.points) {
                result.push_like(&stroke, part);
            }
        }
        result
    }
}

/// The kind of line that shows a sheet: the first that is drawn of all sheets.
fn sample(
    surface: &SampledSurface,
    lines: &SurfaceLines,
    has_levels: bool,
) -> Option<(StrokeKind, Option<GridFamily>)> {
    let has_lattice = !surface.lattices().is_empty();
    let kinds = [
        (lines.along_x && has_lattice, StrokeKind::Grid, Some(GridFamily::AlongX)),
        (lines.along_y && has_lattice, StrokeKind::Grid, Some(GridFamily::AlongY)),
        (lines.mesh || lines.has_grid_lines(), StrokeKind::Mesh, None),
        (has_levels, StrokeKind::Level, None),
        (lines.silhouette, StrokeKind::Silhouette, None),
        (lines.border, StrokeKind::Boundary, None),
    ];
    kinds.into_iter().find(|kind| kind.0).map(|(_, kind, family)| (kind, family))
}

/// A stroke of a kind.
fn shown(kind: StrokeKind, part: SurfacePart) -> Stroke<'static> {
    Stroke { kind, qi: 0, outline: false, underside: false, lit: None, part, points: &[] }
}
