//! The walk through the elements: what each adds to the drawing, where, and on which layer.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::rc::Rc;

use kurbo::{Affine, Point};
use roxmltree::{Document, Node, NodeId};
use rustc_hash::FxHashMap;

use super::css::StyleSheet;
use super::layers::{PenLines, layer_labels};
use super::region::{ClipRegion, Keep, Polygon};
use super::shape::{ShapeFault, ShapeOutline, trace};
use super::style::{OwnStyle, Style, parse_length};
use super::{MAX_COORDINATE_MM, MAX_DEPTH, SvgError, SvgOptions, transform};
use crate::plot::{Pen, Polylines};

/// The most declarations of style sheets, counted for each selector of their rule: all may apply to one element.
const MAX_DECLARATIONS: usize = 1 << 20;

/// Millimeters in a CSS pixel.
const MM_PER_PX: f64 = 25.4 / 96.0;

/// What a group's children take from it.
#[derive(Clone)]
pub(super) struct Context {
    /// User units to page millimeters.
    pub(super) to_page: Affine,
    pub(super) style: Style,
    /// Index of the layer's label in the reader's; 0 is outside of all layers.
    pub(super) layer: usize,
    pub(super) depth: usize,
    /// Width and height that percentages are of.
    pub(super) viewport: [f64; 2],
    /// Areas outside of which nothing shows.
    pub(super) clips: Vec<Rc<ClipRegion>>,
}

/// What shapes are read for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Purpose {
    /// To be drawn.
    Strokes,
    /// For the area or the box of their outlines: paint, dashes and clip paths do not matter.
    Outlines,
}

pub(super) struct Reader<'a, 'input> {
    pub(super) options: &'a SvgOptions,
    document: &'a Document<'input>,
    pub(super) sheet: StyleSheet<'a>,
    pub(super) ids: FxHashMap<&'a str, Node<'a, 'input>>,
    layers: Vec<String>,
    layer_of: FxHashMap<NodeId, usize>,
    pens: Vec<PenLines>,
    pen_of: FxHashMap<(usize, String), usize>,
    /// Outlines that serve as areas or boxes and are not drawn.
    pub(super) outlines: Polylines,
    pub(super) purpose: Purpose,
    /// Regions of clip paths by element and coordinate system.
    pub(super) regions: FxHashMap<(NodeId, [u64; 6]), Rc<ClipRegion>>,
    /// The element whose box is being found, and whose own transform does not count.
    pub(super) boxed: Option<NodeId>,
    /// Clip paths being read.
    pub(super) open_clips: Vec<NodeId>,
    /// Opaque areas, with the number of shapes below each.
    covers: Vec<(u32, ClipRegion)>,
    n_shapes: u32,
    n_segments: usize,
    n_elements: usize,
    width_mm: f64,
    height_mm: f64,
    pub(super) warnings: RefCell<BTreeSet<String>>,
}

impl<'a, 'input> Reader<'a, 'input> {
    /// `css` is the text of the style sheets.
    pub(super) fn new(
        root: Node<'a, 'input>,
        css: &'a str,
        options: &'a SvgOptions,
    ) -> Result<Self, SvgError> {
        let document = root.document();
        let mut ids = FxHashMap::default();
        for node in root.descendants() {
            if let Some(id) = node.attribute("id") {
                ids.entry(id).or_insert(node);
            }
        }
        let sheet = StyleSheet::new(css);
        let work = sheet.len().saturating_mul(root.descendants().count());
        if work > 1 << 32 {
            return Err(SvgError::TooMany { what: "style rules times elements", limit: 1 << 32 });
        }
        let n_declarations = sheet.n_declarations();
        if n_declarations > MAX_DECLARATIONS {
            let what = "declarations times selectors";
            return Err(SvgError::TooMany { what, limit: MAX_DECLARATIONS });
        }
        Ok(Self {
            options,
            document,
            sheet,
            ids,
            layers: vec![String::new()],
            layer_of: FxHashMap::default(),
            pens: Vec::new(),
            pen_of: FxHashMap::default(),
            outlines: Polylines::default(),
            purpose: Purpose::Strokes,
            regions: FxHashMap::default(),
            boxed: None,
            open_clips: Vec::new(),
            covers: Vec::new(),
            n_shapes: 0,
            n_segments: 0,
            n_elements: 0,
            width_mm: 0.0,
            height_mm: 0.0,
            warnings: RefCell::default(),
        })
    }

    /// The pens with what shows of their lines, the warnings, and the size of the page.
    pub(super) fn finish(mut self) -> (Vec<PenLines>, BTreeSet<String>, [f64; 2]) {
        if !self.covers.is_empty() {
            self.pens.iter_mut().for_each(|pen| pen.hide_below(&self.covers));
        }
        (self.pens, self.warnings.into_inner(), [self.width_mm, self.height_mm])
    }

    pub(super) fn line_of(&self, node: Node<'_, '_>) -> u32 {
        self.document.text_pos_at(node.range().start).row
    }

    /// Says that the value of an attribute cannot be read, which then is as if it were not there.
    pub(super) fn warn_of_value(&self, node: Node<'_, '_>, attribute: &str) {
        let value: String =
            node.attribute(attribute).unwrap_or_default().chars().take(40).collect();
        self.warn_at(node, &format!("{attribute}={value:?} cannot be read and is left out"));
    }

    pub(super) fn warn_at(&self, node: Node<'_, '_>, message: &str) {
        self.warn(format!("line {}: {message}", self.line_of(node)));
    }

    pub(super) fn warn(&self, message: String) {
        self.warnings.borrow_mut().insert(message);
    }

    /// A length in user units; `of` is what a percentage is of.
    pub(super) fn length(&self, node: Node<'_, '_>, name: &str, of: f64) -> Option<f64> {
        let text = node.attribute(name).filter(|text| text.trim() != "auto")?;
        let read = parse_length(text, of);
        read.unwrap_or_else(|()| {
            self.warn_of_value(node, name);
            None
        })
    }

    pub(super) fn read_page(&mut self, root: Node<'a, 'input>) -> Result<(), SvgError> {
        let view_box = self.view_box(root);
        let natural = view_box.map_or([300.0, 150.0], |b| [b.w, b.h]);
        let width = self.length(root, "width", natural[0]).unwrap_or(natural[0]);
        let height = self.length(root, "height", natural[1]).unwrap_or(natural[1]);
        let (width_mm, height_mm) = (width * MM_PER_PX, height * MM_PER_PX);
        let sized = |v: f64| v > 0.0 && v <= MAX_COORDINATE_MM;
        if !sized(width_mm) || !sized(height_mm) {
            return Err(SvgError::PageSize);
        }
        (self.width_mm, self.height_mm) = (width_mm, height_mm);
        for (group, label) in layer_labels(root) {
            self.layer_of.insert(group.id(), self.layers.len());
            self.layers.push(label);
        }
        let context = Context {
            to_page: Affine::scale(MM_PER_PX),
            style: Style::default(),
            layer: 0,
            depth: 0,
            viewport: [width, height],
            clips: Vec::new(),
        };
        let inner = self.enter_view(root, &context, [0.0, 0.0], [width, height])?;
        self.read_children(root, &inner)
    }

    fn view_box(&self, node: Node<'_, '_>) -> Option<svgtypes::ViewBox> {
        let read = node.attribute("viewBox")?.parse();
        read.map_err(|_| self.warn_of_value(node, "viewBox")).ok()
    }

    /// The context inside a picture that fills `size` at `corner` of the context around it.
    fn enter_view(
        &self,
        node: Node<'_, '_>,
        around: &Context,
        corner: [f64; 2],
        size: [f64; 2],
    ) -> Result<Context, SvgError> {
        let mut inner = around.clone();
        inner.style = self.sheet.style(node, &around.style).0;
        inner.viewport = size;
        inner.to_page *= Affine::translate((corner[0], corner[1]));
        let Some(view) = self.view_box(node) else { return Ok(inner) };
        let aspect: svgtypes::AspectRatio = match node.attribute("preserveAspectRatio") {
            Some(text) => text.parse().unwrap_or_else(|_| {
                self.warn_of_value(node, "preserveAspectRatio");
                svgtypes::AspectRatio::default()
            }),
            None => svgtypes::AspectRatio::default(),
        };
        let (fx, fy) = (size[0] / view.w, size[1] / view.h);
        let (sx, sy) = match (aspect.align, aspect.slice) {
            (svgtypes::Align::None, _) => (fx, fy),
            (_, true) => (fx.max(fy), fx.max(fy)),
            (_, false) => (fx.min(fy), fx.min(fy)),
        };
        use svgtypes::Align as A;
        let left = match aspect.align {
            A::None | A::XMinYMin | A::XMinYMid | A::XMinYMax => 0.0,
            A::XMidYMin | A::XMidYMid | A::XMidYMax => 0.5,
            A::XMaxYMin | A::XMaxYMid | A::XMaxYMax => 1.0,
        };
        let top = match aspect.align {
            A::None | A::XMinYMin | A::XMidYMin | A::XMaxYMin => 0.0,
            A::XMinYMid | A::XMidYMid | A::XMaxYMid => 0.5,
            A::XMinYMax | A::XMidYMax | A::XMaxYMax => 1.0,
        };
        let shift = ((size[0] - view.w * sx) * left, (size[1] - view.h * sy) * top);
        inner.to_page *= Affine::translate(shift)
            * Affine::scale_non_uniform(sx, sy)
            * Affine::translate((-view.x, -view.y));
        inner.viewport = [view.w, view.h];
        Ok(inner)
    }

    pub(super) fn read_children(
        &mut self,
        node: Node<'a, 'input>,
        context: &Context,
    ) -> Result<(), SvgError> {
        for child in node.children().filter(Node::is_element) {
            self.read_element(child, context)?;
        }
        Ok(())
    }

    pub(super) fn read_element(
        &mut self,
        node: Node<'a, 'input>,
        around: &Context,
    ) -> Result<(), SvgError> {
        self.n_elements += 1;
        if self.n_elements > self.options.max_elements as usize {
            let limit = self.options.max_elements as usize;
            return Err(SvgError::TooMany { what: "elements", limit });
        }
        if around.depth >= MAX_DEPTH {
            return Err(SvgError::TooDeep { line: self.line_of(node) });
        }
        let name = node.tag_name().name();
        if !holds_here(node) {
            return Ok(());
        }
        match name {
            "text" | "image" | "foreignObject" => {
                self.warn(format!("<{name}> is not drawn: pens only follow lines"));
                return Ok(());
            }
            "svg" | "g" | "a" | "switch" | "use" | "path" | "line" | "polyline" | "polygon"
            | "rect" | "circle" | "ellipse" => {}
            _ => return Ok(()),
        }
        let (style, own) = self.sheet.style(node, &around.style);
        if !style.displayed {
            return Ok(());
        }
        let mut context = Context { style, depth: around.depth + 1, ..around.clone() };
        let transform = self.transform(node, &own, &context)?;
        context.to_page *= transform;
        if self.purpose == Purpose::Strokes {
            if own.has_mask {
                self.warn("masks are ignored: lines are drawn whole".to_owned());
            }
            if let Some(clip_path) = &own.clip_path
                && let Some(region) = self.clip_region(clip_path, node, &context)?
            {
                context.clips.push(region);
            }
        }
        match name {
            "svg" => self.read_nested(node, &own, &context),
            "use" => self.read_use(node, &context),
            "switch" => self.read_switch(node, &context),
            "g" | "a" => {
                context.layer = self.layer_of.get(&node.id()).copied().unwrap_or(context.layer);
                self.read_children(node, &context)
            }
            _ => self.read_shape(node, &own, &context),
        }
    }

    /// The transform of an element into the coordinates around it.
    pub(super) fn transform(
        &mut self,
        node: Node<'a, 'input>,
        own: &OwnStyle,
        around: &Context,
    ) -> Result<Affine, SvgError> {
        if self.boxed == Some(node.id()) {
            return Ok(Affine::IDENTITY);
        }
        let has_transform = own.transform.is_some() || node.has_attribute("transform");
        let own_box = match own.turns_in_own_box && has_transform {
            true => self.own_box(node, around)?,
            false => None,
        };
        let size = own_box.map_or(around.viewport, |own| [own.width(), own.height()]);
        let parsed = match (&own.transform, node.attribute("transform")) {
            (Some(css), _) => match transform::parse_css(css, size) {
                Ok(transform) => transform,
                Err(()) => {
                    self.warn_at(node, &format!("CSS `transform: {css}` is not understood"));
                    return Ok(Affine::IDENTITY);
                }
            },
            (None, Some(text)) => transform::parse_attribute(text).unwrap_or_else(|()| {
                self.warn_of_value(node, "transform");
                Affine::IDENTITY
            }),
            (None, None) => return Ok(Affine::IDENTITY),
        };
        // By default about the corner of the box.
        let origin = own.transform_origin.as_deref();
        let origin = origin.or(own_box.is_some().then_some("0 0"));
        let Some(origin) = origin else { return Ok(parsed) };
        let corner = own_box.map_or(Point::ZERO, |own| own.origin());
        transform::about_origin(parsed, origin, size, corner).or_else(|()| {
            self.warn_at(node, &format!("`transform-origin: {origin}` is not understood"));
            Ok(parsed)
        })
    }

    /// Reads the first child that can be drawn and whose conditions are met.
    fn read_switch(&mut self, node: Node<'a, 'input>, context: &Context) -> Result<(), SvgError> {
        const DRAWN: [&str; 11] = [
            "svg", "g", "a", "switch", "use", "path", "line", "polyline", "polygon", "rect",
            "circle",
        ];
        let is_drawn = |child: &Node<'_, '_>| {
            let name = child.tag_name().name();
            DRAWN.contains(&name) || name == "ellipse" || name == "text" || name == "image"
        };
        let mut children = node.children().filter(Node::is_element);
        match children.find(|child| is_drawn(child) && holds_here(*child)) {
            Some(child) => self.read_element(child, context),
            None => {
                if node.first_element_child().is_some() {
                    self.warn_at(
                        node,
                        "no child of <switch> meets its conditions, so none is drawn",
                    );
                }
                Ok(())
            }
        }
    }

    fn read_nested(
        &mut self,
        node: Node<'a, 'input>,
        own: &OwnStyle,
        context: &Context,
    ) -> Result<(), SvgError> {
        let [width, height] = context.viewport;
        let corner = [
            self.length(node, "x", width).unwrap_or(0.0),
            self.length(node, "y", height).unwrap_or(0.0),
        ];
        let size = [
            self.length(node, "width", width).unwrap_or(width),
            self.length(node, "height", height).unwrap_or(height),
        ];
        let mut inner = self.enter_view(node, context, corner, size)?;
        if !own.overflows {
            inner.clips.extend(rectangle(context.to_page, corner, size));
        }
        self.read_children(node, &inner)
    }

    fn read_use(&mut self, node: Node<'a, 'input>, context: &Context) -> Result<(), SvgError> {
        const XLINK: &str = "http://www.w3.org/1999/xlink";
        let href = node.attribute("href").or(node.attribute((XLINK, "href"))).unwrap_or_default();
        let Some(&shown) = href.strip_prefix('#').and_then(|id| self.ids.get(id)) else {
            self.warn(format!("<use> of {href:?}: no such element in this file"));
            return Ok(());
        };
        let [width, height] = context.viewport;
        let corner = [
            self.length(node, "x", width).unwrap_or(0.0),
            self.length(node, "y", height).unwrap_or(0.0),
        ];
        if shown.tag_name().name() == "symbol" {
            let size = [
                self.length(node, "width", width).unwrap_or(width),
                self.length(node, "height", height).unwrap_or(height),
            ];
            let mut inner = self.enter_view(shown, context, corner, size)?;
            inner.depth += 1;
            if shown.has_attribute("viewBox") && shown.attribute("overflow") != Some("visible") {
                inner.clips.extend(rectangle(context.to_page, corner, size));
            }
            return self.read_children(shown, &inner);
        }
        let mut inner = context.clone();
        inner.to_page *= Affine::translate((corner[0], corner[1]));
        self.read_element(shown, &inner)
    }

    fn read_shape(
        &mut self,
        node: Node<'a, 'input>,
        own: &OwnStyle,
        context: &Context,
    ) -> Result<(), SvgError> {
        let style = &context.style;
        let is_read = match self.purpose {
            Purpose::Strokes => style.is_seen(),
            Purpose::Outlines => style.is_visible(),
        };
        if !is_read {
            return Ok(());
        }
        for (name, value) in &own.geometry {
            // `calc` and its like are valid where a bad value is not, and then has no effect.
            if name != "d" && value.contains('(') {
                self.warn_at(node, &format!("CSS `{name}: {value:.40}` is not understood"));
            }
        }
        let mut outline =
            ShapeOutline::new(context.to_page, self.options.tolerance_mm, self.segments_left());
        let damage = trace(node, &own.geometry, context.viewport, &mut outline, |name, of| {
            self.length(node, name, of)
        });
        if let Some(damage) = damage {
            self.warn_at(node, &damage);
        }
        let lines = outline.finish().map_err(|fault| match fault {
            ShapeFault::Coordinate => SvgError::Coordinate { line: self.line_of(node) },
            ShapeFault::TooMany => self.too_many_segments(),
        })?;
        if lines.is_empty() {
            return Ok(());
        }
        if self.purpose == Purpose::Outlines {
            self.n_segments += lines.n_points();
            lines.iter().for_each(|line| self.outlines.push(line.iter().copied()));
            return Ok(());
        }
        self.n_shapes += 1;
        // What machines do not draw hides nothing that they draw.
        let is_guide = self.layers[context.layer].trim_start().starts_with('%');
        if self.options.occlude && !is_guide && style.is_opaque() {
            let clips = context.clips.clone();
            if let Some(polygon) = Polygon::new(&lines, style.fill_rule, clips) {
                let region = ClipRegion { polygons: vec![polygon], within: Vec::new() };
                self.covers.push((self.n_shapes, region));
            }
            if !style.has_stroke() {
                return Ok(());
            }
        }
        let lines = self.dashed(node, own, context, lines)?;
        let lines = context.clips.iter().fold(lines, |lines, region| {
            let mut kept = Polylines::default();
            for line in lines.iter() {
                region.cut(line, Keep::Inside, |piece| kept.push(piece.iter().copied()));
            }
            kept
        });
        self.n_segments += lines.n_points();
        if self.n_segments > self.options.max_segments {
            return Err(self.too_many_segments());
        }
        if !lines.is_empty() {
            let pen = self.pen_for(own, context);
            let shape = self.n_shapes;
            lines.iter().for_each(|line| self.pens[pen].push(line, shape));
        }
        Ok(())
    }

    fn segments_left(&self) -> usize {
        self.options.max_segments.saturating_sub(self.n_segments)
    }

    fn too_many_segments(&self) -> SvgError {
        SvgError::TooMany { what: "straight pieces", limit: self.options.max_segments }
    }

    /// The lines of a shape as dashes, if its stroke has any.
    fn dashed(
        &self,
        node: Node<'_, '_>,
        own: &OwnStyle,
        context: &Context,
        lines: Polylines,
    ) -> Result<Polylines, SvgError> {
        let [width, height] = context.viewport;
        let diagonal = ((width * width + height * height) / 2.0).sqrt();
        let dashes = context.style.dash_array(diagonal);
        let Some(mut dashes) = dashes.filter(|_| context.style.has_stroke()) else {
            return Ok(lines);
        };
        let to_user = if own.keeps_stroke_width {
            Affine::scale(1.0 / MM_PER_PX)
        } else {
            context.to_page.inverse()
        };
        if !to_user.is_finite() {
            return Ok(lines);
        }
        let [a, b, c, d, ..] = to_user.as_coeffs();
        let length_of =
            |step: glam::DVec2| (a * step.x + c * step.y).hypot(b * step.x + d * step.y);
        let walk = |line: &[glam::DVec2]| -> f64 {
            line.windows(2).map(|pair| length_of(pair[1] - pair[0])).sum()
        };
        let length: f64 = lines.iter().map(walk).sum();
        if let Some(stated) = self.length(node, "pathLength", 0.0).filter(|&length| length > 0.0) {
            dashes = dashes.scaled(length / stated);
        }
        if dashes.n_dashes(length) > self.segments_left() as f64 {
            return Err(self.too_many_segments());
        }
        let mut dashed = Polylines::default();
        for line in lines.iter() {
            dashes.for_each_dash(line, length_of, |dash| dashed.push(dash.iter().copied()));
        }
        Ok(dashed)
    }

    /// Index of the pen that draws in the context's layer and color.
    fn pen_for(&mut self, own: &OwnStyle, context: &Context) -> usize {
        let color = context.style.pen_color();
        let key = (context.layer, color);
        if let Some(&pen) = self.pen_of.get(&key) {
            return pen;
        }
        let label = Some(self.layers[context.layer].clone()).filter(|label| !label.is_empty());
        let scale = match own.keeps_stroke_width {
            true => MM_PER_PX,
            false => context.to_page.determinant().abs().sqrt(),
        };
        let width_mm = context.style.stroke_width * scale;
        let pen = Pen { width_mm, color: key.1.clone() };
        self.pens.push(PenLines::new(label, pen));
        self.pen_of.insert(key, self.pens.len() - 1);
        self.pens.len() - 1
    }
}

/// Whether an element's conditions are met: this reader has no extensions, prefers English, and supports
/// every feature except `Extensibility`, which is for foreign objects.
fn holds_here(node: Node<'_, '_>) -> bool {
    let words = |name: &str| node.attribute(name).map(|value| value.split_whitespace());
    let no_extensions = words("requiredExtensions").is_none_or(|mut words| words.next().is_none());
    let features = words("requiredFeatures")
        .is_none_or(|mut words| words.all(|word| !word.ends_with("#Extensibility")));
    let language = node.attribute("systemLanguage").is_none_or(|languages| {
        let is_english = |tag: &str| {
            tag.trim().split('-').next().is_some_and(|tag| tag.eq_ignore_ascii_case("en"))
        };
        languages.split(',').any(is_english)
    });
    no_extensions && features && language
}

/// The area of a rectangle in user units.
fn rectangle(to_page: Affine, [x, y]: [f64; 2], [w, h]: [f64; 2]) -> Option<Rc<ClipRegion>> {
    let corners = [(x, y), (x + w, y), (x + w, y + h), (x, y + h)];
    let mut lines = Polylines::default();
    lines.push(corners.map(|(x, y)| {
        let p = to_page * Point::new(x, y);
        glam::dvec2(p.x, p.y)
    }));
    let polygon = Polygon::new(&lines, Default::default(), Vec::new())?;
    Some(Rc::new(ClipRegion { polygons: vec![polygon], within: Vec::new() }))
}
