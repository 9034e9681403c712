//! The surface that is drawn: read, sampled, scaled.

use std::error::Error;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use glam::DVec3;
use hiddenline::stages::extent::Extent;
use hiddenline::stages::model::mesh::Mesh;
use hiddenline::stages::surface::formula::{Formula, Variables};
use hiddenline::stages::surface::{
    Duplicates, Grid, HeightField, HeightNote, HeightOptions, Holes, LatticeLines, LinedMesh,
    MAX_SAMPLES, PointsError, ScatteredPoints, TrimmedGrid, close_seams, delaunay, evenly,
    lattice_extent, read_heights,
};

use hiddenline::stages::camera::Camera;

use crate::cli::messages::counted;
use crate::cli::paper::Notes;
use crate::cli::paths;

/// Height of the drawn box as a part of the longer side of its base, with `--aspect box`.
const BOX_HEIGHT: f64 = 0.4;

/// Rim points of two sheets at the same x and y are one point if their heights differ by at most this
/// part of the height of both sheets.
const RIM_TOLERANCE: f64 = 1e-6;

/// The range of x and y that a formula is drawn over, unless given.
const DEFAULT_RANGE: (f64, f64) = (-5.0, 5.0);

/// What is wrong with a surface without triangles.
pub(super) const NO_CELLS: &str = "no four neighboring samples have a height: nothing to \
     draw; give more --samples or another range by --x and --y";

/// Where the surface comes from.
pub(in crate::cli) enum Input {
    Formulas {
        texts: Vec<String>,
        formulas: Vec<Formula>,
        /// The formula with its text.
        domain: Option<(Formula, String)>,
        samples: (usize, usize),
    },
    File(PathBuf),
    Points(PathBuf),
    Parametric {
        formulas: Vec<Formula>,
        u: (f64, f64),
        v: (f64, f64),
        samples: (usize, usize),
    },
}

/// Whether heights are drawn to the scale of x and y.
#[derive(Clone, Copy, PartialEq, ValueEnum)]
pub(in crate::cli) enum Aspect {
    Box,
    Data,
}

/// A surface as it is asked for.
pub(in crate::cli) struct Sheets {
    pub(super) input: Input,
    pub(super) options: HeightOptions,
    pub(super) duplicates: Duplicates,
    pub(super) z_scale: f64,
    pub(super) aspect: Aspect,
}

/// The surface that is drawn.
pub(super) enum Surface {
    /// One or more, over the same x and y.
    Grids(Vec<Grid>),
    /// One or more, each over a part of the plane. `n_joined` rim points of two sheets were moved to
    /// their mean height.
    Trimmed {
        grids: Vec<TrimmedGrid>,
        n_joined: usize,
    },
    Points {
        points: Vec<DVec3>,
        triangles: Vec<[u32; 3]>,
    },
    Lattice {
        n_columns: usize,
        points: Vec<DVec3>,
    },
}

/// How many samples are in a row, how many there are, and each of them.
pub(super) type Lattice<'a> = (usize, usize, Box<dyn Fn(usize) -> DVec3 + 'a>);

impl Surface {
    /// Box around all points; holes do not count.
    pub(super) fn bounds(&self) -> (DVec3, DVec3) {
        let mut bounds = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let mut add = |p: DVec3| bounds = (bounds.0.min(p), bounds.1.max(p));
        match self {
            Self::Grids(grids) => {
                for grid in grids {
                    let (xs, ys) = (grid.xs(), grid.ys());
                    if let Some((low, high)) = grid.heights() {
                        add(DVec3::new(xs[0], ys[0], low));
                        add(DVec3::new(xs[xs.len() - 1], ys[ys.len() - 1], high));
                    }
                }
            }
            Self::Trimmed { grids, .. } => {
                for trimmed in grids {
                    let grid = trimmed.grid();
                    let n = grid.zs().len() as u32;
                    let inside = (0..n).map(|k| grid.point(k)).filter(|p| !p.z.is_nan());
                    inside.chain(trimmed.rim()).for_each(&mut add);
                }
            }
            Self::Points { points, .. } | Self::Lattice { points, .. } => {
                points.iter().filter(|p| p.is_finite()).for_each(|p| add(*p));
            }
        }
        bounds
    }

    /// What of the image its lattices take up; nothing for scattered points.
    pub(super) fn extent(&self, camera: &Camera) -> Extent {
        let of_grid = |grid: &Grid| {
            let sample = |k: usize| grid.point(k as u32);
            lattice_extent(grid.xs().len(), grid.zs().len(), sample, camera)
        };
        match self {
            Self::Grids(grids) => grids.iter().map(of_grid).fold(Extent::EMPTY, Extent::union),
            Self::Trimmed { grids, .. } => {
                grids.iter().map(|g| of_grid(g.grid())).fold(Extent::EMPTY, Extent::union)
            }
            Self::Lattice { n_columns, points } => {
                lattice_extent(*n_columns, points.len(), |k| points[k], camera)
            }
            Self::Points { .. } => Extent::EMPTY,
        }
    }

    pub(super) fn scale_heights(&mut self, factor: f64) {
        match self {
            Self::Grids(grids) => grids.iter_mut().for_each(|grid| grid.scale_heights(factor)),
            Self::Trimmed { grids, .. } => {
                grids.iter_mut().for_each(|grid| grid.scale_heights(factor))
            }
            Self::Points { points, .. } | Self::Lattice { points, .. } => {
                points.iter_mut().for_each(|p| p.z *= factor);
            }
        }
    }

    /// Its triangles, with these lines of lattices; scattered points have lines along all edges if
    /// triangles are to have them. Cells that one of the levels `split_at` meets are split.
    pub(super) fn lined(&self, lines: &LatticeLines, split_at: &[f64]) -> LinedMesh {
        let mut mesh = LinedMesh::for_levels(split_at);
        match self {
            Self::Grids(grids) => grids.iter().for_each(|grid| mesh.push_grid(grid, lines)),
            Self::Trimmed { grids, .. } => {
                grids.iter().for_each(|grid| mesh.push_trimmed(grid, lines))
            }
            Self::Points { points, triangles } => {
                mesh.push_triangles(points, triangles, lines.triangles);
            }
            Self::Lattice { n_columns, points } => mesh.push_lattice(*n_columns, points, lines),
        }
        mesh
    }

    /// All samples that are on lines, one lattice for each sheet.
    pub(super) fn lattices(&self) -> Vec<Lattice<'_>> {
        let grid = |grid: &'_ Grid| (grid.xs().len(), grid.zs().len());
        fn points(grid: &Grid) -> Box<dyn Fn(usize) -> DVec3 + '_> {
            Box::new(|k| grid.point(k as u32))
        }
        match self {
            Self::Grids(grids) => grids.iter().map(|g| (grid(g).0, grid(g).1, points(g))).collect(),
            Self::Trimmed { grids, .. } => {
                let grids = grids.iter().map(TrimmedGrid::grid);
                grids.map(|g| (grid(g).0, grid(g).1, points(g))).collect()
            }
            Self::Lattice { n_columns, points } => {
                vec![(*n_columns, points.len(), Box::new(|k| points[k]))]
            }
            Self::Points { .. } => Vec::new(),
        }
    }

    /// One line about rim points that were moved.
    pub(super) fn note(&self) -> Option<String> {
        match self {
            Self::Trimmed { n_joined: n @ 1.., .. } => Some(format!(
                "both sheets end at the same rim: {n} rim points took the mean height of the two"
            )),
            _ => None,
        }
    }

    pub(super) fn described(&self) -> String {
        let size = |grid: &Grid| format!("{} × {} samples", grid.xs().len(), grid.ys().len());
        match self {
            Self::Grids(grids) => grids.first().map_or_else(String::new, size),
            Self::Trimmed { grids, .. } => {
                grids.first().map_or_else(String::new, |g| size(g.grid()))
            }
            Self::Points { points, triangles } => {
                format!("{} points, {} triangles", points.len(), triangles.len())
            }
            Self::Lattice { n_columns, points } => {
                format!("{} × {} samples", n_columns, points.len() / n_columns)
            }
        }
    }
}

/// Sheets whose rims meet up to rounding are joined there if there are two of them.
fn joined_at_rim(mut grids: Vec<TrimmedGrid>) -> Surface {
    let tolerance = rim_tolerance(&grids);
    let n_joined = match &mut grids[..] {
        [one, other] => one.meet_at_rim(other, tolerance),
        _ => 0,
    };
    Surface::Trimmed { grids, n_joined }
}

fn rim_tolerance(grids: &[TrimmedGrid]) -> f64 {
    let heights = grids.iter().filter_map(TrimmedGrid::heights);
    let (low, high) = heights
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (a, b)| (low.min(a), high.max(b)));
    RIM_TOLERANCE * (high - low)
}

fn read_bytes(path: &Path) -> io::Result<Vec<u8>> {
    if path.as_os_str() == "-" {
        let mut bytes = Vec::new();
        io::stdin().lock().read_to_end(&mut bytes)?;
        Ok(bytes)
    } else {
        std::fs::read(path)
    }
}

/// A note about a height file, with what can be done.
fn noted(path: &Path, note: &HeightNote) -> String {
    let path = path.display();
    match note {
        HeightNote::LooksLikePoints { .. } => {
            format!("{path}: {note}; if so, give --points {path} instead of --grid {path}")
        }
        _ => format!("{path}: {note}"),
    }
}

/// The same for scattered points; `None` if none was left out.
fn omitted(path: &Path, read: &ScatteredPoints, n_merged: usize) -> Option<String> {
    let parts =
        [(n_merged, "at the place of another"), (read.n_without_height, "without a height")];
    let parts = parts.iter().filter(|(n, _)| *n > 0);
    let parts: Vec<String> =
        parts.map(|(n, which)| format!("{} {which}", counted(*n, "point", "points"))).collect();
    (!parts.is_empty()).then(|| format!("{}: left out {}", path.display(), parts.join(" and ")))
}

/// An error about points that names their lines.
fn with_lines(path: &Path, error: &PointsError, lines: &[usize]) -> String {
    let path = path.display();
    match error {
        PointsError::TwoHeights { points, x, y, heights: [a, b] } => {
            let [first, second] = points.map(|k| lines.get(k).copied().unwrap_or(0));
            format!(
                "{path}:{first} and {path}:{second} are both at x = {x}, y = {y}, with heights {a} \
                 and {b}; give --duplicates first, mean or max to keep one of them"
            )
        }
        _ => format!("{path}: {error}"),
    }
}

impl Sheets {
    /// The surface with `refined` times as many cells along both axes as asked for, if it is given by
    /// formulas, and the factor that its heights were multiplied by. Warnings are added to `warnings`.
    pub(super) fn read(
        &self,
        refined: usize,
        warnings: &mut Vec<String>,
    ) -> Result<(Surface, f64), Box<dyn Error>> {
        let finely = |(u, v): (usize, usize)| {
            let finer = |n: usize| (n - 1).saturating_mul(refined).saturating_add(1);
            (finer(u), finer(v))
        };
        let failed = |path: &Path, error: &dyn Error| format!("{}: {error}", path.display());
        let mut surface = match &self.input {
            Input::Formulas { formulas, domain, samples, .. } => {
                let samples = finely(*samples);
                let x = self.options.x.unwrap_or(DEFAULT_RANGE);
                let y = self.options.y.unwrap_or(DEFAULT_RANGE);
                let formulas = formulas.iter();
                match domain {
                    None => {
                        let sample = |formula| Grid::sample(formula, x, y, samples);
                        let grids = formulas.clone().map(sample).collect::<Result<Vec<_>, _>>()?;
                        let has_holes = grids.iter().any(|grid| grid.holes() != Holes::None);
                        let everywhere = Formula::parse("1", Variables::Plane)?;
                        let trim =
                            |formula| TrimmedGrid::sample(formula, &everywhere, x, y, samples);
                        let ends_together = |trimmed: &Vec<TrimmedGrid>| match &trimmed[..] {
                            [one, other] => one.shares_rim(other, rim_tolerance(trimmed)),
                            _ => false,
                        };
                        let trimmed = match grids.len() {
                            2 if has_holes => {
                                Some(formulas.map(trim).collect::<Result<Vec<_>, _>>()?)
                            }
                            _ => None,
                        };
                        match trimmed.filter(ends_together) {
                            Some(trimmed) => joined_at_rim(trimmed),
                            None => Surface::Grids(grids),
                        }
                    }
                    Some((domain, _)) => {
                        let sample = |formula| TrimmedGrid::sample(formula, domain, x, y, samples);
                        let grids = formulas.map(sample).collect::<Result<Vec<_>, _>>()?;
                        if grids.iter().all(TrimmedGrid::is_whole) {
                            Surface::Grids(grids.iter().map(|g| g.grid().clone()).collect())
                        } else {
                            joined_at_rim(grids)
                        }
                    }
                }
            }
            Input::File(path) => {
                let bytes = read_bytes(path).map_err(|error| failed(path, &error))?;
                let field = read_heights(&bytes, &self.options);
                let HeightField { grid, notes } = field.map_err(|error| failed(path, &error))?;
                warnings.extend(notes.iter().map(|note| noted(path, note)));
                Surface::Grids(vec![grid])
            }
            Input::Points(path) => {
                let bytes = read_bytes(path).map_err(|error| failed(path, &error))?;
                let text = String::from_utf8_lossy(&bytes);
                let read = ScatteredPoints::read(&text, self.options.nodata);
                let mut read = read.map_err(|error| failed(path, &error))?;
                let merged = read.merge(self.duplicates);
                let n_merged = merged.map_err(|error| with_lines(path, &error, &read.lines))?;
                warnings.extend(omitted(path, &read, n_merged));
                let points = read.points;
                let triangles = delaunay(&points).map_err(|error| failed(path, &error))?;
                Surface::Points { points, triangles }
            }
            Input::Parametric { formulas, u, v, samples } => {
                let samples = finely(*samples);
                if samples.0.checked_mul(samples.1).is_none_or(|n| n > MAX_SAMPLES) {
                    let (u, v) = samples;
                    return Err(format!("{u} × {v} samples are more than {MAX_SAMPLES}").into());
                }
                let us = evenly(u.0, u.1, samples.0);
                let mut points = Vec::with_capacity(samples.0 * samples.1);
                for v in evenly(v.0, v.1, samples.1) {
                    let mut rows = [(); 3].map(|()| vec![0.0; us.len()]);
                    for (formula, row) in formulas.iter().zip(&mut rows) {
                        formula.values(&us, &vec![v; us.len()], row);
                    }
                    points.extend(
                        (0..us.len()).map(|i| DVec3::new(rows[0][i], rows[1][i], rows[2][i])),
                    );
                }
                close_seams(us.len(), &mut points);
                Surface::Lattice { n_columns: us.len(), points }
            }
        };
        let (low, high) = surface.bounds();
        if low.x > high.x {
            return Err(self.nothing_to_draw().into());
        }
        let size = high - low;
        if !size.is_finite() {
            return Err(format!(
                "heights from {:e} to {:e} are too far apart to draw; divide the formula or file",
                low.z, high.z
            )
            .into());
        }
        let fitted = BOX_HEIGHT * size.x.max(size.y) / size.z;
        let fits = self.aspect == Aspect::Box && fitted.is_finite() && fitted > 0.0;
        let factor = if fits { fitted } else { 1.0 } * self.z_scale;
        if !(low.z * factor).is_finite() || !(high.z * factor).is_finite() {
            return Err(format!("heights times {factor:e} are too large to draw").into());
        }
        surface.scale_heights(factor);
        Ok((surface, factor))
    }

    /// The file that is read, if there is one.
    pub(in crate::cli) fn file(&self) -> Option<PathBuf> {
        match &self.input {
            Input::File(path) | Input::Points(path) => Some(path.clone()),
            Input::Formulas { .. } | Input::Parametric { .. } => None,
        }
    }

    /// Why no sample has a height, and what can be done about it.
    fn nothing_to_draw(&self) -> String {
        let range = |(from, to): (f64, f64)| format!("{from}:{to}");
        match &self.input {
            Input::Formulas { texts, formulas, domain, samples } => {
                let x = self.options.x.unwrap_or(DEFAULT_RANGE);
                let y = self.options.y.unwrap_or(DEFAULT_RANGE);
                let has_value = |formula| {
                    Grid::sample(formula, x, y, *samples).is_ok_and(|grid| grid.heights().is_some())
                };
                let what = match domain {
                    Some((_, text)) if formulas.iter().any(has_value) => {
                        format!("the condition --where `{text}` holds")
                    }
                    _ if texts.len() > 1 => format!("`{}` have values", texts.join("`, `")),
                    _ => format!("`{}` has a value", texts.join("")),
                };
                let (columns, rows) = samples;
                format!(
                    "no sample has a height: {what} at none of {columns} × {rows} samples of x in {} \
                     and y in {}; give another range by --x and --y, or more --samples",
                    range(x),
                    range(y)
                )
            }
            Input::Parametric { u, v, .. } => format!(
                "no sample has a place in space: the formulas have no values for u in {} and v in \
                 {}; give another range by --u and --v",
                range(*u),
                range(*v)
            ),
            Input::File(path) | Input::Points(path) => {
                format!("{}: no sample has a height: nothing to draw", path.display())
            }
        }
    }

    /// What a picture of it is called.
    pub(in crate::cli) fn title(&self) -> String {
        match &self.input {
            Input::Formulas { texts, .. } => {
                let texts: Vec<&str> = texts.iter().map(|text| text.trim()).collect();
                format!("z = {}", texts.join(", "))
            }
            Input::Parametric { .. } => "parametric surface".to_owned(),
            Input::File(path) | Input::Points(path) => paths::title(path),
        }
    }

    /// The surface as a mesh, sampled as asked for.
    pub(in crate::cli) fn mesh(&self) -> Result<(Mesh, Notes), Box<dyn Error>> {
        let mut warnings = Vec::new();
        let (surface, _) = self.read(1, &mut warnings)?;
        let no_lines =
            LatticeLines { along_rows: false, along_columns: false, every: 1, triangles: false };
        let mesh = surface.lined(&no_lines, &[]).into_mesh()?;
        if mesh.n_faces() == 0 {
            return Err(NO_CELLS.into());
        }
        let summary = format!("{}: {}", self.title(), surface.described());
        warnings.extend(surface.note());
        Ok((mesh, Notes { summary, warnings }))
    }
}
