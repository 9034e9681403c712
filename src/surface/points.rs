//! Scattered points: a text of x y z, and the Delaunay triangulation over their x and y.

use glam::DVec3;
use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation};
use thiserror::Error;

use super::cells::{Cell, Numbers, Separator, lines};

/// Points that were read from a text.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ScatteredPoints {
    /// In the order of the file.
    pub points: Vec<DVec3>,
    /// The line of each point, counted from 1.
    pub lines: Vec<usize>,
    /// How many lines before the first point hold words.
    pub n_titles: usize,
    /// How many cells the first point's line has besides x, y and z.
    pub n_other_cells: usize,
    /// How many points were left out because their z is missing.
    pub n_without_height: usize,
}

/// How points with the same x and y but different heights are merged.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Duplicates {
    /// They are an error.
    #[default]
    Error,
    /// The first one counts.
    First,
    /// One point with their mean height counts.
    Mean,
    /// The highest one counts.
    Max,
}

impl Duplicates {
    /// All of them, in the order of the documentation.
    pub const ALL: [Self; 4] = [Self::Error, Self::First, Self::Mean, Self::Max];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Error => "error",
            Self::First => "first",
            Self::Mean => "mean",
            Self::Max => "max",
        }
    }
}

/// Why a text of points makes no surface.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PointsError {
    /// A line that is not three numbers.
    #[error("line {line}: expected the three numbers x, y and z")]
    NotAPoint {
        /// Counted from 1.
        line: usize,
    },
    /// Decimal points and decimal commas in one file.
    #[error("line {line}: decimal points and decimal commas are mixed")]
    MixedDecimals {
        /// Counted from 1.
        line: usize,
    },
    /// Two heights for one place.
    #[error(
        "points {} and {} are both at x = {x}, y = {y}, with heights {} and {}",
        points[0] + 1, points[1] + 1, heights[0], heights[1]
    )]
    TwoHeights {
        /// The indices of the two points, the smaller first.
        points: [usize; 2],
        /// Of both.
        x: f64,
        /// Of both.
        y: f64,
        /// Of each.
        heights: [f64; 2],
    },
    /// Too few points, or all on one line.
    #[error("{found} points make no triangle: at least 3 that are not on one line are needed")]
    NoTriangle {
        /// How many there are.
        found: usize,
    },
    /// A coordinate that the triangulation cannot take exactly.
    #[error("a coordinate is too large or too small to be triangulated exactly")]
    Range,
}

impl ScatteredPoints {
    /// Reads points, one a line: x, y and z with comma, semicolon, tab or blanks between them. More
    /// cells on a line are ignored, as are comments and titles. Where titles name columns x, y and z,
    /// these are read, in whatever order they are. O(bytes).
    ///
    /// A point whose z is missing, `nan` or `nodata` is left out.
    ///
    /// # Errors
    /// The first line that is not a point.
    pub fn read(text: &str, nodata: Option<f64>) -> Result<Self, PointsError> {
        let mut read = Self::default();
        let (mut numbers, mut known) = (Numbers::default(), None);
        let mut columns = [0, 1, 2];
        for (line, text) in lines(text) {
            let separator = known.unwrap_or_else(|| Separator::of(text));
            // Numbers in titles do not decide between decimal points and commas.
            let mut trial = numbers;
            let mut row = [Cell::Word; 3];
            let mut n_left = 3;
            for (k, cell) in separator.cells(text).enumerate() {
                if n_left == 0 {
                    break;
                }
                if let Some(axis) = columns.iter().position(|column| *column == k) {
                    let cell = trial.read(cell);
                    row[axis] = cell.map_err(|_| PointsError::MixedDecimals { line })?;
                    n_left -= 1;
                }
            }
            match (row[0], row[1], row[2]) {
                (Cell::Number(x), Cell::Number(y), z) if x.is_finite() && y.is_finite() => {
                    match z {
                        Cell::Number(z) if z.is_finite() && nodata != Some(z) => {
                            read.points.push(DVec3::new(x, y, z));
                            read.lines.push(line);
                        }
                        Cell::Number(_) | Cell::Missing => read.n_without_height += 1,
                        Cell::Word => return Err(PointsError::NotAPoint { line }),
                    }
                }
                (Cell::Word, ..) if read.points.is_empty() && read.n_without_height == 0 => {
                    read.n_titles += 1;
                    let titles: Vec<&str> = separator.cells(text).collect();
                    columns = named_columns(&titles).unwrap_or(columns);
                    continue;
                }
                _ => return Err(PointsError::NotAPoint { line }),
            }
            if known.is_none() {
                read.n_other_cells = separator.cells(text).count().saturating_sub(3);
            }
            (known, numbers) = (Some(separator), trial);
        }
        Ok(read)
    }

    /// Leaves one point at each place and says how many were taken away. Equal points are never an
    /// error. O(n log n).
    ///
    /// # Errors
    /// With [`Duplicates::Error`], the first point in the file that has another height than an
    /// earlier one at its place.
    pub fn merge(&mut self, duplicates: Duplicates) -> Result<usize, PointsError> {
        let order = by_place(&self.points);
        let same = |a: &usize, b: &usize| is_same_place(self.points[*a], self.points[*b]);
        let places: Vec<&[usize]> = order.chunk_by(same).filter(|place| place.len() > 1).collect();
        if duplicates == Duplicates::Error
            && let Some(clash) = clash(&self.points, places.iter().copied())
        {
            return Err(clash);
        }
        let mut heights: Vec<(usize, f64)> = Vec::with_capacity(places.len());
        let mut is_kept = vec![true; self.points.len()];
        for place in places {
            let zs = || place.iter().map(|&k| self.points[k].z);
            let z = match duplicates {
                Duplicates::Error | Duplicates::First => self.points[place[0]].z,
                // Parts first: the sum of two finite heights may overflow.
                Duplicates::Mean => zs().map(|z| z / place.len() as f64).sum(),
                Duplicates::Max => zs().fold(f64::NEG_INFINITY, f64::max),
            };
            heights.push((place[0], z));
            place[1..].iter().for_each(|&k| is_kept[k] = false);
        }
        heights.into_iter().for_each(|(k, z)| self.points[k].z = z);
        let before = self.points.len();
        let mut kept = is_kept.iter();
        self.points.retain(|_| kept.next() == Some(&true));
        let mut kept = is_kept.iter();
        self.lines.retain(|_| kept.next() == Some(&true));
        Ok(before - self.points.len())
    }
}

/// The indices of the points, those at one place beside each other in their order.
/// The places of the cells called x, y and z among titles, if each is there once.
fn named_columns(titles: &[&str]) -> Option<[usize; 3]> {
    let place = |name: &str| {
        let is_it = |title: &&str| title.trim_matches(['"', '\'']).eq_ignore_ascii_case(name);
        let mut places = titles.iter().enumerate().filter(|(_, title)| is_it(title));
        let (place, _) = places.next()?;
        places.next().is_none().then_some(place)
    };
    Some([place("x")?, place("y")?, place("z")?])
}

fn by_place(points: &[DVec3]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    // −0 and 0 are one place.
    let key = |k: usize| (points[k].x + 0.0, points[k].y + 0.0);
    order.sort_by(|&a, &b| {
        let ((ax, ay), (bx, by)) = (key(a), key(b));
        ax.total_cmp(&bx).then(ay.total_cmp(&by)).then(a.cmp(&b))
    });
    order
}

fn is_same_place(a: DVec3, b: DVec3) -> bool {
    a.x == b.x && a.y == b.y
}

/// The first point that has another height than an earlier one at its place.
fn clash<'a>(points: &[DVec3], places: impl Iterator<Item = &'a [usize]>) -> Option<PointsError> {
    let clashes = places.filter_map(|place| {
        let first = points[place[0]].z;
        place.iter().find(|&&k| points[k].z != first).map(|&k| [place[0], k])
    });
    clashes.min_by_key(|pair| pair[1]).map(|pair| {
        let [a, b] = pair.map(|k| points[k]);
        PointsError::TwoHeights { points: pair, x: a.x, y: a.y, heights: [a.z, b.z] }
    })
}

/// A point with its number.
struct Site {
    at: Point2<f64>,
    number: u32,
}

impl HasPosition for Site {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.at
    }
}

/// The Delaunay triangles of the points' x and y, counter-clockwise from above, as indices.
///
/// Decided exactly; of cocircular points the triangulation is one of the possible ones. Equal
/// points count once. Expected O(n log n).
///
/// # Errors
/// Two heights at one place, coordinates out of range (about 1e-43 to 1e60), or no triangle.
pub fn delaunay(points: &[DVec3]) -> Result<Vec<[u32; 3]>, PointsError> {
    let sites = points.iter().zip(0..).map(|(p, number)| Site {
        // −0 and 0 are one place.
        at: Point2::new(p.x + 0.0, p.y + 0.0),
        number,
    });
    let triangulation = DelaunayTriangulation::<Site>::bulk_load(sites.collect())
        .map_err(|_| PointsError::Range)?;
    if triangulation.num_vertices() < points.len() {
        let order = by_place(points);
        let same = |a: &usize, b: &usize| is_same_place(points[*a], points[*b]);
        if let Some(clash) = clash(points, order.chunk_by(same)) {
            return Err(clash);
        }
    }
    let triangles: Vec<[u32; 3]> = triangulation
        .inner_faces()
        .map(|face| face.vertices().map(|vertex| vertex.data().number))
        .collect();
    if triangles.is_empty() {
        return Err(PointsError::NoTriangle { found: points.len() });
    }
    Ok(triangles)
}
