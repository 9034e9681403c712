//! Shapes to polylines on the page.

use glam::{DVec2, dvec2};
use kurbo::{Affine, Arc, Ellipse, PathEl, Point, Shape, SvgArc, Vec2};
use roxmltree::Node;
use svgtypes::{PathParser, PathSegment, PointsParser};

use super::MAX_COORDINATE_MM;
use super::style::parse_length;
use crate::plot::Polylines;

/// Share of the tolerance spent on turning arcs into cubic curves.
const ARC_SHARE: f64 = 0.1;

/// Collects the polylines of one shape.
pub(super) struct ShapeOutline {
    to_page: Affine,
    tolerance_mm: f64,
    left: usize,
    lines: Polylines,
    open: Vec<DVec2>,
    /// Last point in user units.
    last: Point,
    start: Point,
    fault: Option<ShapeFault>,
}

/// Why a shape cannot be drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ShapeFault {
    Coordinate,
    TooMany,
}

impl ShapeOutline {
    /// `left` is the number of points that may still be made.
    pub(super) fn new(to_page: Affine, tolerance_mm: f64, left: usize) -> Self {
        Self {
            to_page,
            tolerance_mm,
            left,
            lines: Polylines::default(),
            open: Vec::new(),
            last: Point::ZERO,
            start: Point::ZERO,
            fault: None,
        }
    }

    pub(super) fn finish(mut self) -> Result<Polylines, ShapeFault> {
        self.end_line();
        self.fault.map_or(Ok(self.lines), Err)
    }

    fn end_line(&mut self) {
        // A lone move draws nothing, as in SVG.
        self.lines.push(self.open.drain(..));
    }

    /// Tolerance in user units.
    fn user_tolerance(&self) -> f64 {
        let scale = self.to_page.determinant().abs().sqrt();
        if scale > 0.0 { self.tolerance_mm / scale } else { f64::INFINITY }
    }

    fn page_point(&mut self, p: Point) -> Option<DVec2> {
        let p = self.to_page * p;
        let reachable = |v: f64| v.abs() <= MAX_COORDINATE_MM;
        if !(reachable(p.x) && reachable(p.y)) {
            self.fault.get_or_insert(ShapeFault::Coordinate);
            return None;
        }
        if self.left == 0 {
            self.fault.get_or_insert(ShapeFault::TooMany);
            return None;
        }
        self.left -= 1;
        Some(dvec2(p.x, p.y))
    }

    fn move_to(&mut self, p: Point) {
        self.end_line();
        (self.last, self.start) = (p, p);
        if let Some(p) = self.page_point(p) {
            self.open.push(p);
        }
    }

    /// Begins at the current point if the last line was closed.
    fn begin(&mut self) {
        if self.open.is_empty() && self.fault.is_none() {
            self.move_to(self.last);
        }
    }

    fn line_to(&mut self, p: Point) {
        self.begin();
        self.last = p;
        if let Some(p) = self.page_point(p) {
            self.open.push(p);
        }
    }

    fn close(&mut self) {
        if let (Some(&first), Some(&last)) = (self.open.first(), self.open.last()) {
            if first != last || self.open.len() == 1 {
                self.open.push(first);
            }
            self.end_line();
        }
        self.last = self.start;
    }

    /// Draws a curve from the current point.
    fn curve(&mut self, curve: PathEl) {
        self.begin();
        let end = curve.end_point().unwrap_or(self.last);
        let path = [PathEl::MoveTo(self.last), curve].map(|el| self.to_page * el);
        let reachable = |p: Point| p.x.abs() <= MAX_COORDINATE_MM && p.y.abs() <= MAX_COORDINATE_MM;
        let controls = match path[1] {
            PathEl::CurveTo(a, b, c) => [a, b, c],
            PathEl::QuadTo(a, b) => [a, b, b],
            _ => [path[0].end_point().unwrap_or_default(); 3],
        };
        if !controls.into_iter().all(reachable) {
            self.fault.get_or_insert(ShapeFault::Coordinate);
        }
        if self.fault.is_some() {
            return;
        }
        let (open, left) = (&mut self.open, &mut self.left);
        kurbo::flatten(path, self.tolerance_mm, |el| {
            if let PathEl::LineTo(p) = el
                && *left > 0
            {
                *left -= 1;
                open.push(dvec2(p.x, p.y));
            }
        });
        if self.left == 0 {
            self.fault = Some(ShapeFault::TooMany);
        }
        self.last = end;
    }

    fn arc(&mut self, arc: &SvgArc) {
        if !(arc.radii.x.is_finite() && arc.radii.y.is_finite() && arc.x_rotation.is_finite()) {
            self.fault.get_or_insert(ShapeFault::Coordinate);
            return;
        }
        // Checked before the arc is cut into as many curves as its size requires.
        let size = arc.radii.x.abs().max(arc.radii.y.abs());
        let reach = (arc.to - arc.from).hypot() * self.to_page.determinant().abs().sqrt();
        if reach > MAX_COORDINATE_MM || reach.is_nan() {
            self.fault.get_or_insert(ShapeFault::Coordinate);
            return;
        }
        let tolerance = (ARC_SHARE * self.user_tolerance()).max(size / MAX_COORDINATE_MM);
        match Arc::from_svg_arc(arc) {
            Some(curve) if tolerance > 0.0 && tolerance.is_finite() => {
                for el in curve.append_iter(tolerance) {
                    self.curve(el);
                }
                // The arc ends where it says, whatever the sines were rounded to.
                self.snap_last(arc.to);
            }
            _ => self.line_to(arc.to),
        }
    }

    fn snap_last(&mut self, p: Point) {
        self.last = p;
        let page = self.to_page * p;
        if let Some(last) = self.open.last_mut() {
            *last = dvec2(page.x, page.y);
        }
    }

    /// Draws a closed shape of curves.
    fn closed_shape(&mut self, shape: &impl Shape, size: f64) {
        let tolerance = (ARC_SHARE * self.user_tolerance()).max(size / MAX_COORDINATE_MM);
        if !(tolerance > 0.0 && tolerance.is_finite()) {
            return;
        }
        for el in shape.path_elements(tolerance) {
            match el {
                PathEl::MoveTo(p) => self.move_to(p),
                PathEl::LineTo(p) => self.line_to(p),
                PathEl::QuadTo(..) | PathEl::CurveTo(..) => self.curve(el),
                PathEl::ClosePath => {}
            }
        }
        // It ends where it begins, whatever the sines were rounded to.
        self.snap_last(self.start);
        self.close();
    }
}

/// Draws the outline of a shape; `css` holds attributes that style sheets set, and `attribute` reads a
/// length from the element itself, given what a percentage is of. Returns what is wrong with data of
/// which only the beginning could be drawn.
pub(super) fn trace(
    node: Node<'_, '_>,
    css: &[(String, String)],
    viewport: [f64; 2],
    outline: &mut ShapeOutline,
    attribute: impl Fn(&str, f64) -> Option<f64>,
) -> Option<String> {
    let [width, height] = viewport;
    let diagonal = ((width * width + height * height) / 2.0).sqrt();
    let from_css = |name: &str| {
        css.iter().rev().find(|(property, _)| property == name).map(|(_, value)| value.as_str())
    };
    let length = |name: &str, of: f64| match from_css(name) {
        Some(text) => match parse_length(text, of) {
            Ok(length) => length,
            // What cannot be read in CSS has no effect.
            Err(()) => attribute(name, of),
        },
        None => attribute(name, of),
    };
    let number = |name: &str, of: f64| length(name, of).unwrap_or(0.0);
    match node.tag_name().name() {
        "path" => {
            let data = match from_css("d") {
                Some(css) => css_path(css),
                None => node.attribute("d").unwrap_or_default(),
            };
            return trace_path(data, outline);
        }
        "line" => {
            outline.move_to(Point::new(number("x1", width), number("y1", height)));
            outline.line_to(Point::new(number("x2", width), number("y2", height)));
        }
        name @ ("polyline" | "polygon") => {
            let text = node.attribute("points").unwrap_or_default();
            let mut n_read = 0;
            for (i, (x, y)) in PointsParser::from(text).enumerate() {
                let p = Point::new(x, y);
                if i == 0 {
                    outline.move_to(p)
                } else {
                    outline.line_to(p)
                }
                n_read = i + 1;
            }
            if name == "polygon" {
                outline.close();
            }
            if 2 * n_read < n_numbers(text) {
                return Some(format!(
                    "the points of <{name}> are drawn up to an error after the first {n_read}"
                ));
            }
        }
        "rect" => {
            let (x, y) = (number("x", width), number("y", height));
            let (w, h) = (number("width", width), number("height", height));
            let rx = length("rx", width);
            let ry = length("ry", height);
            let radius = |own: Option<f64>, other: Option<f64>, side: f64| {
                own.or(other).unwrap_or(0.0).clamp(0.0, side / 2.0)
            };
            if w > 0.0 && h > 0.0 {
                trace_rectangle([x, y, w, h], [radius(rx, ry, w), radius(ry, rx, h)], outline);
            }
        }
        "circle" | "ellipse" => {
            let center = Point::new(number("cx", width), number("cy", height));
            let radii = match node.tag_name().name() {
                "circle" => Vec2::splat(number("r", diagonal)),
                _ => {
                    // A radius that is missing or `auto` is the other one.
                    let (rx, ry) = (length("rx", width), length("ry", height));
                    Vec2::new(rx.or(ry).unwrap_or(0.0), ry.or(rx).unwrap_or(0.0))
                }
            };
            if radii.x > 0.0 && radii.y > 0.0 {
                let ellipse = Ellipse::new(center, radii, 0.0);
                outline.closed_shape(&ellipse, radii.x.max(radii.y));
            }
        }
        _ => {}
    }
    None
}

/// The data in CSS's `path("…")`; nothing for `none`.
fn css_path(css: &str) -> &str {
    let inner = css.strip_prefix("path(").and_then(|rest| rest.strip_suffix(')'));
    let inner = inner.unwrap_or_default().trim();
    // A fill rule may come first.
    let inner = inner.split_once(['"', '\'']).map_or("", |(_, rest)| rest);
    inner.trim_end_matches(['"', '\''])
}

/// Words that may be numbers.
fn n_numbers(text: &str) -> usize {
    text.split([' ', ',', '\t', '\r', '\n']).filter(|word| !word.is_empty()).count()
}

/// Draws path data up to its first error, and says where that is.
fn trace_path(text: &str, outline: &mut ShapeOutline) -> Option<String> {
    // The control point that a smooth curve mirrors, and whether it was a cubic's.
    let mut control: Option<(Point, bool)> = None;
    for segment in PathParser::from(text) {
        let segment = match segment {
            Ok(segment) => segment,
            Err(error) => {
                return Some(format!("path data is drawn up to an error: {error}"));
            }
        };
        let last = outline.last;
        let at = |abs: bool, x: f64, y: f64| {
            if abs { Point::new(x, y) } else { Point::new(last.x + x, last.y + y) }
        };
        let mirrored = |cubic: bool| match control {
            Some((p, c)) if c == cubic => last + (last - p),
            _ => last,
        };
        let mut next_control = None;
        match segment {
            PathSegment::MoveTo { abs, x, y } => outline.move_to(at(abs, x, y)),
            PathSegment::LineTo { abs, x, y } => outline.line_to(at(abs, x, y)),
            PathSegment::HorizontalLineTo { abs, x } => {
                outline.line_to(Point::new(if abs { x } else { last.x + x }, last.y));
            }
            PathSegment::VerticalLineTo { abs, y } => {
                outline.line_to(Point::new(last.x, if abs { y } else { last.y + y }));
            }
            PathSegment::CurveTo { abs, x1, y1, x2, y2, x, y } => {
                let second = at(abs, x2, y2);
                outline.curve(PathEl::CurveTo(at(abs, x1, y1), second, at(abs, x, y)));
                next_control = Some((second, true));
            }
            PathSegment::SmoothCurveTo { abs, x2, y2, x, y } => {
                let second = at(abs, x2, y2);
                outline.curve(PathEl::CurveTo(mirrored(true), second, at(abs, x, y)));
                next_control = Some((second, true));
            }
            PathSegment::Quadratic { abs, x1, y1, x, y } => {
                let middle = at(abs, x1, y1);
                outline.curve(PathEl::QuadTo(middle, at(abs, x, y)));
                next_control = Some((middle, false));
            }
            PathSegment::SmoothQuadratic { abs, x, y } => {
                let middle = mirrored(false);
                outline.curve(PathEl::QuadTo(middle, at(abs, x, y)));
                next_control = Some((middle, false));
            }
            PathSegment::EllipticalArc { abs, rx, ry, x_axis_rotation, large_arc, sweep, x, y } => {
                outline.arc(&SvgArc {
                    from: last,
                    to: at(abs, x, y),
                    radii: Vec2::new(rx, ry),
                    x_rotation: x_axis_rotation.to_radians(),
                    large_arc,
                    sweep,
                })
            }
            PathSegment::ClosePath { .. } => outline.close(),
        }
        control = next_control;
    }
    None
}

/// Clockwise from the end of the upper left corner, as SVG has it.
fn trace_rectangle([x, y, w, h]: [f64; 4], radii: [f64; 2], outline: &mut ShapeOutline) {
    let round = radii[0] > 0.0 && radii[1] > 0.0;
    let [rx, ry] = if round { radii } else { [0.0, 0.0] };
    let at = Point::new;
    let sides = [
        (at(x + rx, y), at(x + w - rx, y), at(x + w, y + ry)),
        (at(x + w, y + ry), at(x + w, y + h - ry), at(x + w - rx, y + h)),
        (at(x + w - rx, y + h), at(x + rx, y + h), at(x, y + h - ry)),
        (at(x, y + h - ry), at(x, y + ry), at(x + rx, y)),
    ];
    outline.move_to(sides[0].0);
    for (_, side_end, corner_end) in sides {
        outline.line_to(side_end);
        if round {
            outline.arc(&SvgArc {
                from: side_end,
                to: corner_end,
                radii: Vec2::new(rx, ry),
                x_rotation: 0.0,
                large_arc: false,
                sweep: true,
            });
        }
    }
    outline.close();
}
