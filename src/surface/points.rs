//! Scattered points: a text of x y z, and the Delaunay triangulation over their x and y.

use glam::DVec3;
use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation};
use thiserror::Error;

/// Why a text of points makes no surface.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PointsError {
    /// A line that is not three numbers.
    #[error("line {line}: expected the three numbers x, y and z")]
    NotAPoint {
        /// Counted from 1.
        line: usize,
    },
    /// Two heights for one place.
    #[error("two points at x = {x}, y = {y} have different heights")]
    TwoHeights {
        /// Of both.
        x: f64,
        /// Of both.
        y: f64,
    },
    /// Too few points, or all on one line.
    #[error("{found} points make no triangle: at least 3 are needed that are not on one line")]
    NoTriangle {
        /// How many there are.
        found: usize,
    },
    /// A coordinate that the triangulation cannot take exactly.
    #[error("a coordinate is too large or too small to be triangulated exactly")]
    Range,
}

/// Reads points, one a line: x, y and z with comma, semicolon, tab or blanks between them. What
/// follows them on a line is passed over, as are lines that begin with `#` and one line of titles.
///
/// # Errors
/// The first line that is no point.
pub fn read_points(text: &str) -> Result<Vec<DVec3>, PointsError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut points = Vec::new();
    let mut is_first = true;
    for (k, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let cells = line.split([',', ';', '\t', ' ']).filter(|cell| !cell.is_empty());
        let mut numbers = cells.map(|cell| fast_float2::parse::<f64, _>(cell).ok());
        let mut next = || numbers.next().flatten().filter(|number| number.is_finite());
        match (next(), next(), next()) {
            (Some(x), Some(y), Some(z)) => points.push(DVec3::new(x, y, z)),
            _ if is_first => {}
            _ => return Err(PointsError::NotAPoint { line: k + 1 }),
        }
        is_first = false;
    }
    Ok(points)
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

/// The Delaunay triangles of the points' x and y, counter-clockwise from above, by their numbers.
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
        let mut order: Vec<&DVec3> = points.iter().collect();
        order.sort_by(|a, b| {
            (a.x + 0.0).total_cmp(&(b.x + 0.0)).then((a.y + 0.0).total_cmp(&(b.y + 0.0)))
        });
        let clash = order.windows(2).find(|pair| {
            pair[0].x == pair[1].x && pair[0].y == pair[1].y && pair[0].z != pair[1].z
        });
        if let Some(pair) = clash {
            return Err(PointsError::TwoHeights { x: pair[0].x, y: pair[0].y });
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
