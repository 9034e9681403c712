//! A finished page: polylines in millimetres, one layer a pen. What every writer writes.
//!
//! Page coordinates have their origin at the top left corner of the paper, x to the right and y
//! *downwards*, in millimetres.

use glam::DVec2;

/// A sheet of paper with everything that is drawn on it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Plot {
    /// Width of the sheet in millimetres.
    pub width_mm: f64,
    /// Height of the sheet in millimetres.
    pub height_mm: f64,
    /// What the drawing shows, for the file's title.
    pub title: String,
    /// The command that made it, for the file's metadata; empty for none.
    pub source: String,
    /// One layer a pen, in drawing order.
    pub layers: Vec<Layer>,
}

/// Everything one pen draws.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// The pen's number, 1 or more; plotters and their software select layers by it.
    pub number: u32,
    /// What the layer holds, as a word: `visible`, `hidden`.
    pub name: String,
    /// The pen.
    pub pen: Pen,
    /// Polylines in page millimetres; a closed one ends at its first point.
    pub lines: Polylines,
}

/// What draws a layer.
#[derive(Debug, Clone, PartialEq)]
pub struct Pen {
    /// Width of its line in millimetres.
    pub width_mm: f64,
    /// Colour as `#rrggbb`.
    pub color: String,
}

/// Polylines in one flat array.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Polylines {
    points: Vec<DVec2>,
    ends: Vec<u32>,
}

impl Polylines {
    /// Appends a polyline. Fewer than two points are none and are left out.
    pub fn push(&mut self, points: impl IntoIterator<Item = DVec2>) {
        let start = self.points.len();
        self.points.extend(points);
        if self.points.len() < start + 2 {
            self.points.truncate(start);
        } else {
            self.ends.push(self.points.len() as u32);
        }
    }

    /// Number of polylines.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// Number of points of all polylines.
    pub fn n_points(&self) -> usize {
        self.points.len()
    }

    /// Sum of the lengths of all polylines in millimetres.
    pub fn length_mm(&self) -> f64 {
        self.iter().flat_map(|line| line.windows(2)).map(|s| s[0].distance(s[1])).sum()
    }

    /// The polylines in order.
    pub fn iter(&self) -> impl Iterator<Item = &[DVec2]> {
        self.ends.iter().scan(0, |start, &end| {
            let points = &self.points[*start..end as usize];
            *start = end as usize;
            Some(points)
        })
    }
}
