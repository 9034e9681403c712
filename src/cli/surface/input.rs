//! The surface to draw: read, sampled, scaled.

use std::error::Error;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use hiddenline::stages::draw::surface::{SurfaceError, SurfaceNote, axes_box};
use hiddenline::stages::model::mesh::Mesh;
use hiddenline::stages::page::{PenRule, tells_sheets_apart, with_sheet_pens};
use hiddenline::stages::surface::formula::{Formula, Parameter};
use hiddenline::stages::surface::{
    Aspect, DEFAULT_RANGE, Duplicates, FormulaSheet, HeightField, HeightNote, HeightOptions,
    LatticeLines, Outside, PointsError, SamplingError, ScatteredPoints, Surface, read_heights,
};

use crate::cli::messages::counted;
use crate::cli::paper::Notes;
use crate::cli::paths;
use crate::cli::plotting::Plotting;

/// An error that other samples mend.
pub(super) fn with_samples(error: &SurfaceError) -> String {
    format!("{error}; use more --samples or another range for --x and --y")
}

/// Where the surface comes from.
pub(in crate::cli) enum SurfaceSource {
    Formulas {
        texts: Vec<String>,
        /// For each formula one sheet for each combination of the values of parameters.
        sheets: Vec<FormulaSheet>,
        samples: (usize, usize),
    },
    File(PathBuf),
    Points(PathBuf),
    Parametric {
        formulas: Box<[Formula; 3]>,
        u: (f64, f64),
        v: (f64, f64),
        samples: (usize, usize),
    },
}

/// A surface as requested.
pub(in crate::cli) struct SurfaceInput {
    pub(super) input: SurfaceSource,
    pub(super) options: HeightOptions,
    pub(super) duplicates: Duplicates,
    pub(super) z_scale: f64,
    pub(super) aspect: Aspect,
    pub(super) log: [bool; 3],
    pub(super) reversed: [bool; 2],
    pub(super) z: Option<(f64, f64)>,
    pub(super) outside: Outside,
    /// The parameters of each sheet of a formula, whose values its name may show.
    pub(super) parameters: Vec<Vec<Parameter>>,
    /// Warnings about parameters that no formula names.
    pub(super) unused: Vec<String>,
    /// The names of sheets, where they are not the usual ones.
    pub(super) names: Vec<String>,
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
            format!("{path}: {note}; if so, use --points {path} instead of --grid {path}")
        }
        _ => format!("{path}: {note}"),
    }
}

/// Cells on a line of points, besides x, y and z, that colors, normals and intensities fill.
const MOST_OTHER_CELLS: usize = 7;

/// The hint at `--grid`, for lines with more numbers than points have.
fn looks_like_a_grid(path: &Path, read: &ScatteredPoints) -> Option<String> {
    let n = 3 + read.n_other_cells;
    let is_short = read.n_other_cells > 0 && read.points.len() <= n;
    (is_short || read.n_other_cells > MOST_OTHER_CELLS).then(|| {
        let path = path.display();
        format!(
            "the {n} numbers on each line of {path} look like heights in rows; if so, use --grid \
             {path} instead of --points {path}"
        )
    })
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
                "{path}:{first} and {path}:{second} are both at x = {x}, y = {y}, with heights \
                 {a} and {b}; use --duplicates first, mean or max to keep one of them"
            )
        }
        _ => format!("{path}: {error}"),
    }
}

impl SurfaceInput {
    /// Reads the surface. Warnings are added to `warnings`.
    pub(super) fn read(&self, warnings: &mut Vec<String>) -> Result<Surface, Box<dyn Error>> {
        let failed = |path: &Path, error: &dyn Error| format!("{}: {error}", path.display());
        warnings.extend(self.unused.iter().cloned());
        let surface = match &self.input {
            SurfaceSource::Formulas { sheets, samples, .. } => {
                let x = self.options.x.unwrap_or(DEFAULT_RANGE);
                let y = self.options.y.unwrap_or(DEFAULT_RANGE);
                let surface = Surface::sheets(sheets.clone()).x(x.0, x.1).y(y.0, y.1);
                surface.samples(samples.0, samples.1)
            }
            SurfaceSource::File(path) => {
                let bytes = read_bytes(path).map_err(|error| failed(path, &error))?;
                let field = read_heights(&bytes, &self.options);
                let HeightField { grid, notes } = field.map_err(|error| failed(path, &error))?;
                warnings.extend(notes.iter().map(|note| noted(path, note)));
                Surface::grid(grid)
            }
            SurfaceSource::Points(path) => {
                let bytes = read_bytes(path).map_err(|error| failed(path, &error))?;
                let text = String::from_utf8_lossy(&bytes);
                let read = ScatteredPoints::read(&text, self.options.nodata);
                let mut read = read.map_err(|error| failed(path, &error))?;
                let merged = read.merge(self.duplicates);
                let n_merged = merged.map_err(|error| with_lines(path, &error, &read.lines))?;
                warnings.extend(omitted(path, &read, n_merged));
                let grid = looks_like_a_grid(path, &read);
                let made = Surface::points(read.points);
                let made = made.map_err(|error| {
                    let hint = grid.as_ref().map_or_else(String::new, |hint| format!("; {hint}"));
                    failed(path, &error) + &hint
                });
                warnings.extend(grid.filter(|_| made.is_ok()));
                made?
            }
            SurfaceSource::Parametric { formulas, u, v, samples } => {
                let surface = Surface::parametric_formulas((**formulas).clone(), *u, *v);
                surface.samples(samples.0, samples.1)
            }
        };
        let surface = surface.aspect(self.aspect).z_scale(self.z_scale);
        let surface = surface.log(self.log).reversed(self.reversed);
        let surface = match self.z {
            Some((from, to)) => surface.z(from, to).outside(self.outside),
            None => surface,
        };
        Ok(match (&self.input, self.names.is_empty()) {
            (SurfaceSource::Formulas { .. }, _) | (_, false) => surface.names(self.names.clone()),
            _ => surface.names([self.title()]),
        })
    }

    /// How many sheets there are.
    fn n_sheets(&self) -> usize {
        match &self.input {
            SurfaceSource::Formulas { sheets, .. } => sheets.len(),
            _ => 1,
        }
    }

    /// The pens from the command line, and one for each sheet where sheets have pens of their own.
    pub(super) fn pens(
        &self,
        plotting: &Plotting,
        width_mm: f64,
        has_legend: bool,
    ) -> Vec<PenRule> {
        let (pens, n_sheets) = (plotting.pens(width_mm), self.n_sheets());
        match tells_sheets_apart(&pens, n_sheets, has_legend) {
            true => with_sheet_pens(pens, n_sheets, width_mm),
            false => pens,
        }
    }

    /// Names the sheets, one for each, or one for each formula, in which `{a}` is the value of a.
    pub(super) fn name_sheets(&mut self, names: &[String]) -> Result<(), String> {
        let n_sheets = self.n_sheets();
        let n_formulas = match &self.input {
            SurfaceSource::Formulas { texts, .. } => texts.len(),
            _ => 1,
        };
        let each = match names.len() {
            n if n == n_sheets => 1,
            n if n == n_formulas => n_sheets / n_formulas,
            n => {
                return Err(format!(
                    "--names gives {n} names for {}; a comma in a name is written `\\,`",
                    counted(n_sheets, "sheet", "sheets")
                ));
            }
        };
        let none = Vec::new();
        let name = |k: usize| {
            let parameters = self.parameters.get(k).unwrap_or(&none).iter();
            parameters.fold(names[k / each].clone(), |name, parameter| {
                name.replace(&format!("{{{}}}", parameter.name()), parameter.text())
            })
        };
        self.names = (0..n_sheets).map(name).collect();
        Ok(())
    }

    /// Why the surface cannot be sampled, and what can be done about it.
    pub(super) fn sampling_error(&self, error: &SamplingError) -> String {
        match error {
            SamplingError::NoHeights { outside_domain } => self.nothing_to_draw(*outside_domain),
            SamplingError::OutOfRange { low, high } => {
                format!("the surface has heights from {low} to {high}: none is within --z")
            }
            SamplingError::NotPositive { axis, .. } => {
                format!("{error}; use another range for --{axis} or leave {axis} out of --log")
            }
            _ => error.to_string(),
        }
    }

    /// The file that is read, if there is one.
    pub(in crate::cli) fn file(&self) -> Option<PathBuf> {
        match &self.input {
            SurfaceSource::File(path) | SurfaceSource::Points(path) => Some(path.clone()),
            SurfaceSource::Formulas { .. } | SurfaceSource::Parametric { .. } => None,
        }
    }

    /// Why no sample has a height, and what can be done about it.
    fn nothing_to_draw(&self, outside_domain: bool) -> String {
        let range = |(from, to): (f64, f64)| format!("{from}:{to}");
        match &self.input {
            SurfaceSource::Formulas { texts, sheets, samples } => {
                let x = self.options.x.unwrap_or(DEFAULT_RANGE);
                let y = self.options.y.unwrap_or(DEFAULT_RANGE);
                let domain = sheets.first().and_then(|sheet| sheet.domain.as_ref());
                let what = match domain {
                    Some(domain) if outside_domain => {
                        format!("the condition --where `{}` holds", domain.text())
                    }
                    _ if texts.len() > 1 => format!("`{}` have values", texts.join("`, `")),
                    _ => format!("`{}` has a value", texts.join("")),
                };
                let (columns, rows) = samples;
                format!(
                    "no sample has a height: {what} at none of {columns} × {rows} samples of x in \
                     {} and y in {}; use another range for --x and --y, or more --samples",
                    range(x),
                    range(y)
                )
            }
            SurfaceSource::Parametric { u, v, .. } => format!(
                "no sample has a position: the formulas have no values for u in {} and v in {}; \
                 use another range for --u and --v",
                range(*u),
                range(*v)
            ),
            SurfaceSource::File(path) | SurfaceSource::Points(path) => {
                format!("{}: no sample has a height: nothing to draw", path.display())
            }
        }
    }

    /// What a picture of it is called.
    pub(in crate::cli) fn title(&self) -> String {
        match &self.input {
            SurfaceSource::Formulas { texts, .. } => {
                let texts: Vec<&str> = texts.iter().map(|text| text.trim()).collect();
                format!("z = {}", texts.join(", "))
            }
            SurfaceSource::Parametric { .. } => "parametric surface".to_owned(),
            SurfaceSource::File(path) | SurfaceSource::Points(path) => paths::title(path),
        }
    }

    /// The surface as a mesh, sampled as requested.
    pub(in crate::cli) fn mesh(&self) -> Result<(Mesh, Notes), Box<dyn Error>> {
        let mut warnings = Vec::new();
        let surface = self.read(&mut warnings)?;
        let surface = surface.sample().map_err(|error| self.sampling_error(&error))?;
        let no_lines =
            LatticeLines { along_rows: false, along_columns: false, every: 1, triangles: false };
        let mesh = surface.lined(&no_lines, &[], None).into_mesh()?;
        if mesh.n_faces() == 0 {
            return Err(with_samples(&SurfaceError::NoCells).into());
        }
        let summary = format!("{}: {surface}", self.title());
        warnings.extend(match surface.n_rim_points_joined() {
            0 => None,
            n => Some(SurfaceNote::RimsJoined(n).to_string()),
        });
        let axes_box = Some(axes_box(&surface));
        Ok((mesh, Notes { summary, warnings, axes_box, ..Notes::default() }))
    }
}
