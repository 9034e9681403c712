//! A finished page: polylines and filled areas in millimeters, one layer per pen, ready for the writers.
//!
//! Page coordinates have their origin at the top left corner of the paper, x to the right and y
//! *downward*, in millimeters.

use std::borrow::Cow;

use glam::DVec2;

/// A sheet of paper with everything that is drawn on it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Plot {
    /// Width of the sheet in millimeters.
    pub width_mm: f64,
    /// Height of the sheet in millimeters.
    pub height_mm: f64,
    /// What the drawing shows, for the file's title.
    pub title: String,
    /// The command that made it, for the file's metadata; empty for none.
    pub source: String,
    /// One layer per pen, in drawing order.
    pub layers: Vec<Layer>,
}

impl Plot {
    /// The same plot with other layers, without copying its own layers.
    #[must_use]
    pub fn with_layers(&self, layers: Vec<Layer>) -> Self {
        let Self { width_mm, height_mm, title, source, .. } = self;
        let (title, source) = (title.clone(), source.clone());
        Self { width_mm: *width_mm, height_mm: *height_mm, title, source, layers }
    }

    /// The layers that machines draw: those for which [`Layer::is_plotted`] holds.
    pub fn plotted_layers(&self) -> impl Iterator<Item = &Layer> {
        self.layers.iter().filter(|layer| layer.is_plotted())
    }
}

/// Everything one pen draws.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Layer {
    /// The pen's number, 1 or more; plotters and their software select layers by it.
    pub number: u32,
    /// What the layer holds, as a word: `visible`, `hidden`.
    pub name: String,
    /// The layer's label in SVG; `None` for number and name, as in `1 visible`.
    ///
    /// AxiDraw's software reads control characters at its start: `%` for a layer that is never
    /// plotted, `!` for a pause, then a number, then `+S`, `+H` and `+D` for speed, pen height and
    /// delay.
    pub label: Option<String>,
    /// The pen.
    pub pen: Pen,
    /// Polylines in page millimeters; a closed one ends at its first point.
    pub lines: Polylines,
    /// Dash and gap in millimeters, for formats that have dash patterns; the lines are then whole.
    /// `None` for solid lines.
    pub dash_mm: Option<[f64; 2]>,
    /// Areas in page millimeters, painted in order and before the lines. Plots for plotters have none.
    pub fills: Fills,
}

impl Layer {
    /// The same layer with other lines, without copying its own lines.
    #[must_use]
    pub fn with_lines(&self, lines: Polylines) -> Self {
        let Self { number, name, label, pen, dash_mm, fills, .. } = self;
        Self {
            number: *number,
            name: name.clone(),
            label: label.clone(),
            pen: pen.clone(),
            lines,
            dash_mm: *dash_mm,
            fills: fills.clone(),
        }
    }

    /// The label in SVG.
    pub fn label(&self) -> Cow<'_, str> {
        match &self.label {
            Some(label) => label.into(),
            None => format!("{} {}", self.number, self.name).into(),
        }
    }

    /// Whether machines draw the layer. Those whose label begins with `%` are for the screen only.
    pub fn is_plotted(&self) -> bool {
        !self.label.as_ref().is_some_and(|label| label.trim_start().starts_with('%'))
    }

    /// Whether the machine pauses before the layer: the label begins with `!`.
    pub fn pauses(&self) -> bool {
        self.label.as_ref().is_some_and(|label| label.trim_start().starts_with('!'))
    }

    /// Pen-down speed requested by the label, in percent of the highest speed, as in `2 +S40`.
    /// AxiDraw's software takes 1 to 110.
    pub fn speed_percent(&self) -> Option<u32> {
        let label = self.label.as_ref()?.trim_start_matches(['%', '!', ' ']);
        let controls = label.trim_start_matches(|c: char| c.is_ascii_digit());
        let speeds = controls
            .split_whitespace()
            .filter_map(|word| word.strip_prefix(['+']))
            .filter_map(|word| word.strip_prefix(['S', 's']));
        speeds.filter_map(|digits| digits.parse().ok()).find(|percent| (1..=110).contains(percent))
    }
}

/// What draws a layer.
#[derive(Debug, Clone, PartialEq)]
pub struct Pen {
    /// Its line width in millimeters.
    pub width_mm: f64,
    /// Color as `#rrggbb`.
    pub color: String,
}

impl Default for Pen {
    /// A fine black pen.
    fn default() -> Self {
        Self { width_mm: 0.3, color: "#000000".to_owned() }
    }
}

/// Polylines in one flat array.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Polylines {
    points: Vec<DVec2>,
    ends: Vec<u32>,
}

impl Polylines {
    /// Appends a polyline. One of fewer than two points is left out.
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

    /// Sum of the lengths of all polylines in millimeters.
    pub fn length_mm(&self) -> f64 {
        // The sum of nothing is -0.
        self.iter().flat_map(|line| line.windows(2)).map(|s| s[0].distance(s[1])).sum::<f64>() + 0.0
    }

    /// Polyline number `line`. Panics when there is no such polyline.
    fn line(&self, line: usize) -> &[DVec2] {
        let start = line.checked_sub(1).map_or(0, |before| self.ends[before] as usize);
        &self.points[start..self.ends[line] as usize]
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

/// Filled areas in one flat array: each with a color and closed rings, filled by the even-odd rule.
/// An area may have outlines, which the layer's pen draws over it before the next area is painted.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Fills {
    points: Vec<DVec2>,
    ring_ends: Vec<u32>,
    outlines: Polylines,
    areas: Vec<AreaEnds>,
    /// Each area is also outlined in its own color with a line of this width, so that no background shows
    /// through between neighbors where a screen or printer antialiases edges. 0 leaves areas unchanged, for
    /// cutting machines.
    pub seam_mm: f64,
}

/// Areas of one ink before they are placed on a page.
#[derive(Debug, Clone, PartialEq)]
pub struct FillLayer {
    /// What the layer holds, as a word.
    pub name: String,
    /// The ink, or that of the first area.
    pub color: [u8; 3],
    /// The areas in image coordinates.
    pub fills: Fills,
}

/// Where an area ends among the rings and the outlines.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct AreaEnds {
    color: [u8; 3],
    rings: u32,
    outlines: u32,
}

/// One filled area.
#[derive(Debug, Clone, Copy)]
pub struct Area<'a> {
    /// Its color.
    pub color: [u8; 3],
    fills: &'a Fills,
    rings: (u32, u32),
    outlines: (u32, u32),
}

impl Fills {
    /// Adds an area over all others. Rings of fewer than three points are left out; the last point of
    /// a ring is joined to the first.
    pub fn push<R>(&mut self, color: [u8; 3], rings: impl IntoIterator<Item = R>)
    where
        R: IntoIterator<Item = DVec2>,
    {
        self.push_outlined(color, rings, []);
    }

    /// Adds an area over all others, and polylines over the area. Rings of fewer than three points
    /// and polylines of fewer than two are left out.
    pub fn push_outlined<R>(
        &mut self,
        color: [u8; 3],
        rings: impl IntoIterator<Item = R>,
        outlines: impl IntoIterator<Item = Vec<DVec2>>,
    ) where
        R: IntoIterator<Item = DVec2>,
    {
        let (n_rings, n_outlines) = (self.ring_ends.len(), self.outlines.len());
        for ring in rings {
            let start = self.points.len();
            self.points.extend(ring);
            if self.points.len() < start + 3 {
                self.points.truncate(start);
            } else {
                self.ring_ends.push(self.points.len() as u32);
            }
        }
        for outline in outlines {
            self.outlines.push(outline);
        }
        if self.ring_ends.len() > n_rings || self.outlines.len() > n_outlines {
            let (rings, outlines) = (self.ring_ends.len() as u32, self.outlines.len() as u32);
            self.areas.push(AreaEnds { color, rings, outlines });
        }
    }

    /// Whether any area has outlines.
    pub fn has_outlines(&self) -> bool {
        !self.outlines.is_empty()
    }

    /// Number of areas.
    pub fn len(&self) -> usize {
        self.areas.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.areas.is_empty()
    }

    /// Number of points of all areas.
    pub fn n_points(&self) -> usize {
        self.points.len()
    }

    /// The areas in paint order.
    pub fn iter(&self) -> impl Iterator<Item = Area<'_>> {
        self.areas.iter().scan(AreaEnds::default(), |before, &ends| {
            let rings = (before.rings, ends.rings);
            let outlines = (before.outlines, ends.outlines);
            *before = ends;
            Some(Area { color: ends.color, fills: self, rings, outlines })
        })
    }
}

impl<'a> Area<'a> {
    /// Its rings, without a last point that repeats the first.
    pub fn rings(&self) -> impl Iterator<Item = &'a [DVec2]> + use<'a> {
        let fills = self.fills;
        (self.rings.0 as usize..self.rings.1 as usize).map(move |ring| {
            let start = ring.checked_sub(1).map_or(0, |before| fills.ring_ends[before] as usize);
            &fills.points[start..fills.ring_ends[ring] as usize]
        })
    }

    /// The polylines that are drawn over it. A closed one ends at its first point.
    pub fn outlines(&self) -> impl Iterator<Item = &'a [DVec2]> + use<'a> {
        let outlines = &self.fills.outlines;
        (self.outlines.0 as usize..self.outlines.1 as usize).map(|line| outlines.line(line))
    }
}
