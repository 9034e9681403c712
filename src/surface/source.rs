//! Descriptions of surfaces, before they are sampled.

use glam::DVec3;
use thiserror::Error;

use super::formula::{Formula, FormulaError, Parameter, ParameterError, ParameterList, Variables};
use super::grid::{Grid, GridError, check_parameters, evenly};
use super::lined_mesh::close_seams;
use super::names::{name_of_values, typeset};
#[cfg(feature = "points")]
use super::points::{PointsError, delaunay};
use crate::model::mesh::MeshError;

/// The default range of x and y over which a formula is sampled.
pub const DEFAULT_RANGE: (f64, f64) = (-5.0, 5.0);

/// The default number of samples along each axis.
pub const DEFAULT_SAMPLES: usize = 81;

/// A surface to draw: one or more sheets z = f(x, y), a grid of heights, scattered points, or a
/// parametric surface in space.
///
/// ```
/// use hiddenline::{Grid, Surface};
///
/// let hat = Surface::formula("sinc(r)")?.x(-12.0, 12.0).y(-12.0, 12.0).samples(101, 101);
/// assert_eq!(hat.sample()?.to_string(), "101 × 101 samples");
///
/// // Two sheets over a disc.
/// let ball = Surface::formula("sqrt(9 - r^2)")?.sheet("-sqrt(9 - r^2)")?.domain("r <= 3")?;
///
/// let torus = ["(3 + cos(v)) * cos(u)", "(3 + cos(v)) * sin(u)", "sin(v)"];
/// let turn = (0.0, std::f64::consts::TAU);
/// let torus = Surface::parametric(torus, turn, turn)?;
///
/// let heights = vec![0.0, 1.0, 1.0, 2.0];
/// let field = Surface::grid(Grid::new(vec![0.0, 1.0], vec![0.0, 1.0], heights)?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
#[must_use]
pub struct Surface {
    pub(super) source: Source,
    pub(super) x: (f64, f64),
    pub(super) y: (f64, f64),
    pub(super) z: Option<(f64, f64)>,
    /// What to do with heights outside that range.
    pub(super) outside: Outside,
    pub(super) samples: (usize, usize),
    pub(super) aspect: Aspect,
    pub(super) z_scale: f64,
    /// Which of the axes x, y, z are logarithmic.
    pub(super) log: [bool; 3],
    /// Whether x and y are reversed.
    pub(super) reversed: [bool; 2],
    /// The names of the sheets that have one.
    names: Vec<String>,
}

/// Where the points of a surface come from.
#[derive(Debug, Clone)]
pub(super) enum Source {
    Formulas(Vec<FormulaSheet>),
    Grid(Grid),
    Triangles {
        points: Vec<DVec3>,
        triangles: Vec<[u32; 3]>,
    },
    /// Points in space, row by row.
    Lattice {
        n_columns: usize,
        points: Vec<DVec3>,
    },
    /// Formulas of x, y and z, and the ranges of u and v.
    Parametric {
        formulas: [Formula; 3],
        u: (f64, f64),
        v: (f64, f64),
    },
}

/// A sheet z = f(x, y).
#[derive(Debug, Clone, PartialEq)]
pub struct FormulaSheet {
    /// z as a formula in x and y.
    pub height: Formula,
    /// The domain of the sheet, as a condition on x and y; `None` for wherever it has a height.
    pub domain: Option<Formula>,
}

/// Why sheets cannot be made for values of parameters.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum FamilyError {
    /// The text is not a valid formula.
    #[error(transparent)]
    Formula(#[from] FormulaError),
    /// The values cannot be combined.
    #[error(transparent)]
    Parameters(#[from] ParameterError),
}

/// What to do with heights outside the range of z.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Outside {
    /// Cut the surface off.
    #[default]
    Cut,
    /// Clamp heights to the range, which makes plateaus.
    Clamp,
}

impl Outside {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Cut, Self::Clamp];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cut => "cut",
            Self::Clamp => "clamp",
        }
    }
}

/// The proportions of the box around a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Aspect {
    /// x and y to scale, and 0.4 times the longer of the two for heights. If one of x and y is more than
    /// 5 times as long as the other, or logarithmic, both are equally long.
    Box,
    /// All to scale.
    Data,
    /// In these proportions.
    Lengths([f64; 3]),
}

impl Surface {
    /// The sheet z = `text`, a formula in x, y, r and theta, for x and y from -5 to 5.
    ///
    /// # Errors
    /// The text is not a valid formula.
    pub fn formula(text: &str) -> Result<Self, FormulaError> {
        Ok(Self::formulas(vec![Formula::parse(text, Variables::Plane)?]))
    }

    /// One sheet for each formula; their variables are x and y.
    pub fn formulas(formulas: Vec<Formula>) -> Self {
        let sheet = |height| FormulaSheet { height, domain: None };
        Self::sheets(formulas.into_iter().map(sheet).collect())
    }

    /// Sheets that each have their own domain.
    pub fn sheets(sheets: Vec<FormulaSheet>) -> Self {
        Self::new(Source::Formulas(sheets), Aspect::Box)
    }

    /// One sheet z = `text` for each combination of values of parameters, which are constants in the
    /// formula.
    ///
    /// ```
    /// use hiddenline::{ParameterList, Surface};
    ///
    /// let a = ParameterList::new("a", [1.0, 2.0, 3.0])?;
    /// let bells = Surface::formula_for("a + exp(-a*r^2/2)", &[a])?.x(-3.0, 3.0).y(-3.0, 3.0);
    /// assert_eq!(bells.sheet_names(), ["a = 1", "a = 2", "a = 3"]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// The text is not a valid formula, a name is in two lists, or there are too many combinations.
    pub fn formula_for(text: &str, lists: &[ParameterList]) -> Result<Self, FamilyError> {
        let combinations = ParameterList::combinations(lists)?;
        let parse =
            |parameters: &Vec<Parameter>| Formula::parse_with(text, Variables::Plane, parameters);
        let formulas: Vec<Formula> = combinations.iter().map(parse).collect::<Result<_, _>>()?;
        let names = combinations.iter().map(|parameters| name_of_values(parameters));
        Ok(Self::formulas(formulas).names(names))
    }

    /// A grid of heights.
    pub fn grid(grid: Grid) -> Self {
        Self::new(Source::Grid(grid), Aspect::Box)
    }

    /// The heights `z(x, y)` over a rectangle, at `samples` points along x and along y. A height that
    /// is not finite is a hole.
    ///
    /// ```
    /// use hiddenline::Surface;
    ///
    /// let saddle = Surface::from_fn((-1.0, 1.0), (-1.0, 1.0), (41, 41), |x, y| x * y)?;
    /// # Ok::<(), hiddenline::Error>(())
    /// ```
    ///
    /// # Errors
    /// A range does not go from a smaller to a larger number, or there are too few or too many samples.
    pub fn from_fn(
        x: (f64, f64),
        y: (f64, f64),
        samples: (usize, usize),
        z: impl Fn(f64, f64) -> f64,
    ) -> Result<Self, GridError> {
        Ok(Self::grid(Grid::from_fn(x, y, samples, z)?))
    }

    /// A surface in space: the points `point(u, v)`, at `samples` places along u and along v. A point
    /// that is not finite is a hole. Ends are joined where they meet, and heights are drawn to the
    /// scale of x and y.
    ///
    /// ```
    /// use hiddenline::glam::dvec3;
    /// use hiddenline::Surface;
    ///
    /// let turn = (0.0, std::f64::consts::TAU);
    /// let tube = Surface::parametric_fn(turn, (0.0, 2.0), (73, 11), |u: f64, v| {
    ///     dvec3(u.cos(), u.sin(), v)
    /// })?;
    /// # Ok::<(), hiddenline::Error>(())
    /// ```
    ///
    /// # Errors
    /// There are too few or too many samples.
    pub fn parametric_fn(
        u: (f64, f64),
        v: (f64, f64),
        samples: (usize, usize),
        point: impl Fn(f64, f64) -> DVec3,
    ) -> Result<Self, GridError> {
        check_parameters(samples)?;
        let (us, vs) = (evenly(u.0, u.1, samples.0), evenly(v.0, v.1, samples.1));
        let mut points = Vec::with_capacity(us.len() * vs.len());
        for &v in &vs {
            points.extend(us.iter().map(|&u| point(u, v)));
        }
        close_seams(us.len(), &mut points);
        Ok(Self::new(Source::Lattice { n_columns: us.len(), points }, Aspect::Data))
    }

    /// The surface through scattered points: their Delaunay triangulation, seen from above.
    ///
    /// # Errors
    /// See [`PointsError`]. Expected O(n log n).
    #[cfg(feature = "points")]
    pub fn points(points: Vec<DVec3>) -> Result<Self, PointsError> {
        let triangles = delaunay(&points)?;
        Ok(Self::new(Source::Triangles { points, triangles }, Aspect::Box))
    }

    /// A surface of triangles over given points: each triangle lists three indices of `points`. Points
    /// that are not finite are holes and must not be used by triangles.
    ///
    /// # Errors
    /// A triangle refers to a point that does not exist or is not finite.
    pub fn triangles(points: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        for (face, corners) in triangles.iter().enumerate() {
            for &vertex in corners {
                match points.get(vertex as usize) {
                    Some(point) if point.is_finite() => {}
                    Some(_) => return Err(MeshError::NotFinite { vertex: vertex as usize }),
                    None => {
                        let n_vertices = points.len();
                        return Err(MeshError::MissingVertex { face, vertex, n_vertices });
                    }
                }
            }
        }
        Ok(Self::new(Source::Triangles { points, triangles }, Aspect::Box))
    }

    /// A surface in space: x, y and z as formulas of u and v. Its ends are joined where they meet, and
    /// its heights are drawn to the scale of x and y.
    ///
    /// # Errors
    /// A text is not a valid formula.
    pub fn parametric(
        texts: [&str; 3],
        u: (f64, f64),
        v: (f64, f64),
    ) -> Result<Self, FormulaError> {
        let parse = |text| Formula::parse(text, Variables::Parameters);
        let [x, y, z] = texts;
        Ok(Self::parametric_formulas([parse(x)?, parse(y)?, parse(z)?], u, v))
    }

    /// As [`parametric`](Self::parametric), from formulas whose variables are u and v.
    pub fn parametric_formulas(formulas: [Formula; 3], u: (f64, f64), v: (f64, f64)) -> Self {
        Self::new(Source::Parametric { formulas, u, v }, Aspect::Data)
    }

    fn new(source: Source, aspect: Aspect) -> Self {
        let (x, y) = (DEFAULT_RANGE, DEFAULT_RANGE);
        let samples = (DEFAULT_SAMPLES, DEFAULT_SAMPLES);
        Self {
            source,
            x,
            y,
            z: None,
            outside: Outside::default(),
            samples,
            aspect,
            z_scale: 1.0,
            log: [false; 3],
            reversed: [false; 2],
            names: Vec::new(),
        }
    }

    /// Adds a sheet. This applies only to surfaces of formulas.
    ///
    /// # Errors
    /// The text is not a valid formula.
    pub fn sheet(mut self, text: &str) -> Result<Self, FormulaError> {
        let formula = Formula::parse(text, Variables::Plane)?;
        if let Source::Formulas(sheets) = &mut self.source {
            let domain = sheets.last().and_then(|sheet| sheet.domain.clone());
            sheets.push(FormulaSheet { height: formula, domain });
        }
        Ok(self)
    }

    /// Sets the domain of the surface: a condition on x and y, such as `r <= 3`. The surface is cut along its
    /// border. This applies only to surfaces of formulas.
    ///
    /// # Errors
    /// The text is not a valid formula.
    pub fn domain(self, text: &str) -> Result<Self, FormulaError> {
        Ok(self.within(Formula::parse(text, Variables::Plane)?))
    }

    /// As [`domain`](Self::domain), from a formula whose variables are x and y.
    pub fn within(mut self, formula: Formula) -> Self {
        if let Source::Formulas(sheets) = &mut self.source {
            sheets.iter_mut().for_each(|sheet| sheet.domain = Some(formula.clone()));
        }
        self
    }

    /// The range of x over which formulas are sampled. If `from` is larger than `to`, the axis is reversed.
    pub fn x(mut self, from: f64, to: f64) -> Self {
        self.x = (from, to);
        self
    }

    /// The range of y over which formulas are sampled, as for [`x`](Self::x).
    pub fn y(mut self, from: f64, to: f64) -> Self {
        self.y = (from, to);
        self
    }

    /// The range of heights to draw: the surface is cut off exactly at both, and the box around it has these
    /// heights. If `from` is larger than `to`, the axis is reversed. By default all heights are drawn, except
    /// where formulas grow without bound at poles.
    ///
    /// ```
    /// use hiddenline::Surface;
    ///
    /// let bowl = Surface::formula("x^2 + y^2")?.z(0.0, 4.0);
    /// # Ok::<(), hiddenline::Error>(())
    /// ```
    pub fn z(mut self, from: f64, to: f64) -> Self {
        self.z = Some((from, to));
        self
    }

    /// What to do with heights outside the range of z.
    ///
    /// ```
    /// use hiddenline::{Outside, Surface};
    ///
    /// let crater = Surface::formula("r^2")?.z(1.0, 4.0).outside(Outside::Clamp);
    /// # Ok::<(), hiddenline::Error>(())
    /// ```
    pub fn outside(mut self, outside: Outside) -> Self {
        self.outside = outside;
        self
    }

    /// The number of samples of formulas along x (or u) and along y (or v).
    pub fn samples(mut self, along_x: usize, along_y: usize) -> Self {
        self.samples = (along_x, along_y);
        self
    }

    /// The proportions of the box around the surface; by default [`Aspect::Box`], or [`Aspect::Data`] for
    /// parametric surfaces.
    pub fn aspect(mut self, aspect: Aspect) -> Self {
        self.aspect = aspect;
        self
    }

    /// Multiplies heights, after the scaling of [`Aspect::Box`].
    pub fn z_scale(mut self, factor: f64) -> Self {
        self.z_scale = factor;
        self
    }

    /// Which of the axes x, y and z are logarithmic. Formulas use the true values, sampled evenly in the
    /// logarithm. Points where one of these values is not above 0 are holes.
    ///
    /// ```
    /// use hiddenline::Surface;
    ///
    /// let decay = Surface::formula("1/(x*y)")?.x(0.1, 1000.0).y(1.0, 5.0).log([true, false, true]);
    /// # Ok::<(), hiddenline::Error>(())
    /// ```
    pub fn log(mut self, axes: [bool; 3]) -> Self {
        self.log = axes;
        self
    }

    /// Which of the axes x and y are reversed.
    pub fn reversed(mut self, axes: [bool; 2]) -> Self {
        self.reversed = axes;
        self
    }

    /// Names of the sheets, for a legend.
    pub fn names<T: Into<String>>(mut self, names: impl IntoIterator<Item = T>) -> Self {
        self.names = names.into_iter().map(Into::into).collect();
        self
    }

    /// The number of sheets; 1 for surfaces that are not formulas.
    pub fn n_sheets(&self) -> usize {
        match &self.source {
            Source::Formulas(sheets) => sheets.len(),
            _ => 1,
        }
    }

    /// The names of the sheets: the given names, or else their formulas in mathematical notation. Empty if
    /// there is neither.
    pub fn sheet_names(&self) -> Vec<String> {
        let formula = |k: usize| match &self.source {
            Source::Formulas(sheets) => {
                sheets.get(k).map_or(String::new(), |sheet| typeset(sheet.height.text()))
            }
            _ => String::new(),
        };
        let name = |k: usize| self.names.get(k).cloned().unwrap_or_else(|| formula(k));
        (0..self.n_sheets()).map(name).collect()
    }

    /// The number of samples along each axis if formulas are sampled; `None` for surfaces given by points,
    /// which cannot be sampled more finely.
    pub fn samples_of_formulas(&self) -> Option<(usize, usize)> {
        match self.source {
            Source::Formulas(_) | Source::Parametric { .. } => Some(self.samples),
            Source::Grid(_) | Source::Triangles { .. } | Source::Lattice { .. } => None,
        }
    }
}
