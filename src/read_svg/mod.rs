//! Reads the lines of any SVG: what a pen can follow, in page millimetres, a layer for each pen.
//!
//! Outlines of paths, lines, polylines, polygons, rectangles, circles and ellipses are read, with
//! transforms, units, view boxes, nested pictures and `<use>`; curves become chords. Text, images,
//! clip paths, masks, markers and dash arrays are not drawn by pens: those that would change the
//! lines are told as warnings.
//!
//! `usvg` would resolve all of this, but rounds coordinates to `f32` and loses Inkscape's layer
//! names; so this stands on the crates it is made of: `roxmltree`, `simplecss`, `svgtypes`, `kurbo`.

mod pens;
mod shape;
mod style;

use std::collections::BTreeSet;

use kurbo::Affine;
use roxmltree::{Document, Node, ParsingOptions};
use rustc_hash::FxHashMap;

use crate::plot::{Pen, Plot, Polylines};
use pens::{PenLines, numbered};
use shape::Outline;
use style::{Style, StyleSheet, length_attribute};

/// Millimeters in a CSS pixel.
const MM_PER_PX: f64 = 25.4 / 96.0;
/// Elements inside each other, `<use>` counted too, beyond which a file is refused.
const MAX_DEPTH: usize = 200;
/// Bytes that entities of the document type may stand for in all.
const MAX_ENTITY_BYTES: usize = 1 << 28;
/// Largest coordinate in millimetres: ten kilometers.
const MAX_COORDINATE_MM: f64 = 1e7;

/// How to read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// How far chords may be from the curves they stand for, in page millimetres.
    pub tolerance_mm: f64,
    /// Straight pieces beyond which a file is refused.
    pub max_segments: usize,
    /// XML nodes, and elements drawn through `<use>`, beyond which a file is refused.
    pub max_elements: u32,
}

impl Default for Options {
    fn default() -> Self {
        Self { tolerance_mm: 0.02, max_segments: 50_000_000, max_elements: 20_000_000 }
    }
}

/// Why a file could not be read.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// Not XML.
    #[error("not a readable SVG: {0}")]
    Xml(#[from] roxmltree::Error),
    /// The root is another element.
    #[error("the root element is <{0}>, not <svg>")]
    NotSvg(String),
    /// Entities would take too much memory.
    #[error("entities of the document type expand to too much text; save the file without them")]
    Entities,
    /// Too deep, or a `<use>` that shows itself.
    #[error("line {line}: elements are nested more than {MAX_DEPTH} deep, or <use> shows itself")]
    TooDeep {
        /// Line of the file.
        line: u32,
    },
    /// Too many lines.
    #[error("more than {limit} {what}; split the drawing")]
    TooMany {
        /// What there is too much of.
        what: &'static str,
        /// How much there may be.
        limit: usize,
    },
    /// Something that is not a number, or not one that can be drawn.
    #[error("line {line}: {attribute}={value:?} cannot be read")]
    Value {
        /// Line of the file.
        line: u32,
        /// The attribute.
        attribute: String,
        /// The beginning of its value.
        value: String,
    },
    /// A point out of reach.
    #[error("line {line}: a coordinate is not a number or larger than ten kilometers")]
    Coordinate {
        /// Line of the file.
        line: u32,
    },
    /// The page has no size.
    #[error("the page has no positive width and height")]
    PageSize,
}

/// A drawing that was read.
#[derive(Debug, Clone, PartialEq)]
pub struct LineSvg {
    /// The page. Layers are in order of appearance; their numbers are those that Inkscape layers
    /// begin with, where they do, and otherwise the next free ones.
    pub plot: Plot,
    /// What was left out or taken for something else, each kind once.
    pub warnings: BTreeSet<String>,
}

/// Reads the text of an SVG file.
///
/// Lines are kept apart by Inkscape layer (a group directly under the root with
/// `inkscape:groupmode="layer"`) and by stroke color. Shapes with neither stroke nor fill, and
/// those not displayed, are left out. O(file), in memory some ten times the file.
///
/// # Errors
/// Broken XML, bad numbers, and files beyond the limits, before they fill the memory.
pub fn read(text: &str, options: &Options) -> Result<LineSvg, Error> {
    check_entities(text)?;
    let parsing = ParsingOptions {
        allow_dtd: true,
        nodes_limit: options.max_elements,
        ..ParsingOptions::default()
    };
    let document = Document::parse_with_options(text, parsing)?;
    let root = document.root_element();
    if root.tag_name().name() != "svg" {
        return Err(Error::NotSvg(root.tag_name().name().to_owned()));
    }
    let mut reader = Reader::new(root, options)?;
    reader.read_page(root)?;
    let title = root.children().find(|node| node.tag_name().name() == "title");
    let title = title.and_then(|node| node.text()).unwrap_or_default().trim().to_owned();
    let warnings = reader.warnings;
    let plot = Plot {
        width_mm: reader.width_mm,
        height_mm: reader.height_mm,
        title,
        source: String::new(),
        layers: numbered(reader.pens),
    };
    Ok(LineSvg { plot, warnings })
}

/// Refuses documents whose entities could expand to more than the limit.
///
/// The parser stops loops, and more than 255 references from within one; references from outside
/// of entities it follows without end.
fn check_entities(text: &str) -> Result<(), Error> {
    let Some(first) = text.find("<!ENTITY") else { return Ok(()) };
    let last = text.rfind("<!ENTITY").unwrap_or(first);
    let end = text[last..].find('>').map_or(text.len(), |end| last + end);
    let definitions = &text[first..end];
    let nested = if definitions.contains('&') { 256 } else { 1 };
    let references = text[end..].bytes().filter(|&b| b == b'&').count();
    let expanded = references.saturating_mul(definitions.len()).saturating_mul(nested);
    if expanded > MAX_ENTITY_BYTES { Err(Error::Entities) } else { Ok(()) }
}

/// What a group's children take from it.
#[derive(Clone)]
struct Context {
    /// User units to page millimetres.
    to_page: Affine,
    style: Style,
    /// Inkscape layer, as an index into the reader's; 0 is outside of any.
    layer: usize,
    depth: usize,
    /// Width and height that percentages are of.
    viewport: [f64; 2],
}

struct Reader<'a, 'input> {
    options: &'a Options,
    document: &'a Document<'input>,
    sheet: StyleSheet<'a>,
    ids: FxHashMap<&'a str, Node<'a, 'input>>,
    layers: Vec<String>,
    pens: Vec<PenLines>,
    pen_of: FxHashMap<(usize, String), usize>,
    n_segments: usize,
    n_elements: usize,
    width_mm: f64,
    height_mm: f64,
    warnings: BTreeSet<String>,
}

impl<'a, 'input> Reader<'a, 'input> {
    fn new(root: Node<'a, 'input>, options: &'a Options) -> Result<Self, Error> {
        let document = root.document();
        let mut ids = FxHashMap::default();
        for node in root.descendants() {
            if let Some(id) = node.attribute("id") {
                ids.entry(id).or_insert(node);
            }
        }
        let sheet = StyleSheet::new(root);
        let work = sheet.len().saturating_mul(root.descendants().count());
        if work > 1 << 32 {
            return Err(Error::TooMany { what: "style rules times elements", limit: 1 << 32 });
        }
        Ok(Self {
            options,
            document,
            sheet,
            ids,
            layers: vec![String::new()],
            pens: Vec::new(),
            pen_of: FxHashMap::default(),
            n_segments: 0,
            n_elements: 0,
            width_mm: 0.0,
            height_mm: 0.0,
            warnings: BTreeSet::new(),
        })
    }

    fn line_of(&self, node: Node<'_, '_>) -> u32 {
        self.document.text_pos_at(node.range().start).row
    }

    fn bad_value(&self, node: Node<'_, '_>, attribute: &str) -> Error {
        let value = node.attribute(attribute).unwrap_or_default();
        Error::Value {
            line: self.line_of(node),
            attribute: attribute.to_owned(),
            value: value.chars().take(40).collect(),
        }
    }

    /// A length in user units; `of` is what a percentage is of.
    fn length(&self, node: Node<'_, '_>, name: &str, of: f64) -> Result<Option<f64>, Error> {
        length_attribute(node, name, of).map_err(|()| self.bad_value(node, name))
    }

    fn read_page(&mut self, root: Node<'a, 'input>) -> Result<(), Error> {
        let view_box = self.view_box(root)?;
        let natural = view_box.map_or([300.0, 150.0], |b| [b.w, b.h]);
        let width = self.length(root, "width", natural[0])?.unwrap_or(natural[0]);
        let height = self.length(root, "height", natural[1])?.unwrap_or(natural[1]);
        let (width_mm, height_mm) = (width * MM_PER_PX, height * MM_PER_PX);
        let sized = |v: f64| v > 0.0 && v <= MAX_COORDINATE_MM;
        if !sized(width_mm) || !sized(height_mm) {
            return Err(Error::PageSize);
        }
        (self.width_mm, self.height_mm) = (width_mm, height_mm);
        let context = Context {
            to_page: Affine::scale(MM_PER_PX),
            style: Style::default(),
            layer: 0,
            depth: 0,
            viewport: [width, height],
        };
        let inner = self.enter_view(root, &context, [0.0, 0.0], [width, height])?;
        self.read_children(root, &inner, true)
    }

    fn view_box(&self, node: Node<'_, '_>) -> Result<Option<svgtypes::ViewBox>, Error> {
        let Some(text) = node.attribute("viewBox") else { return Ok(None) };
        text.parse().map(Some).map_err(|_| self.bad_value(node, "viewBox"))
    }

    /// The context inside a picture that fills `size` at `corner` of the context around it.
    fn enter_view(
        &self,
        node: Node<'_, '_>,
        around: &Context,
        corner: [f64; 2],
        size: [f64; 2],
    ) -> Result<Context, Error> {
        let mut inner = around.clone();
        inner.style = self.sheet.style(node, &around.style);
        inner.viewport = size;
        inner.to_page *= Affine::translate((corner[0], corner[1]));
        let Some(view) = self.view_box(node)? else { return Ok(inner) };
        let aspect: svgtypes::AspectRatio = match node.attribute("preserveAspectRatio") {
            Some(text) => text.parse().map_err(|_| self.bad_value(node, "preserveAspectRatio"))?,
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

    fn read_children(
        &mut self,
        node: Node<'a, 'input>,
        context: &Context,
        is_root: bool,
    ) -> Result<(), Error> {
        for child in node.children().filter(Node::is_element) {
            self.read_element(child, context, is_root)?;
        }
        Ok(())
    }

    fn read_element(
        &mut self,
        node: Node<'a, 'input>,
        around: &Context,
        under_root: bool,
    ) -> Result<(), Error> {
        self.n_elements += 1;
        if self.n_elements > self.options.max_elements as usize {
            let limit = self.options.max_elements as usize;
            return Err(Error::TooMany { what: "elements", limit });
        }
        if around.depth >= MAX_DEPTH {
            return Err(Error::TooDeep { line: self.line_of(node) });
        }
        let name = node.tag_name().name();
        match name {
            "text" | "image" | "foreignObject" => {
                self.warnings.insert(format!("<{name}> is not drawn: pens only follow lines"));
                return Ok(());
            }
            "svg" | "g" | "a" | "switch" | "use" | "path" | "line" | "polyline" | "polygon"
            | "rect" | "circle" | "ellipse" => {}
            _ => return Ok(()),
        }
        let mut context = around.clone();
        context.depth += 1;
        context.style = self.sheet.style(node, &around.style);
        if !context.style.displayed {
            return Ok(());
        }
        if let Some(text) = node.attribute("transform") {
            let t: svgtypes::Transform =
                text.parse().map_err(|_| self.bad_value(node, "transform"))?;
            context.to_page *= Affine::new([t.a, t.b, t.c, t.d, t.e, t.f]);
        }
        for ignored in ["clip-path", "mask", "stroke-dasharray"] {
            if node.attribute(ignored).is_some_and(|value| value != "none") {
                self.warnings.insert(format!("{ignored} is ignored: lines are drawn whole"));
            }
        }
        match name {
            "svg" => self.read_nested(node, &context),
            "use" => self.read_use(node, &context),
            "switch" => match node.first_element_child() {
                Some(child) => self.read_element(child, &context, false),
                None => Ok(()),
            },
            "g" | "a" => {
                const INKSCAPE: &str = "http://www.inkscape.org/namespaces/inkscape";
                if under_root && node.attribute((INKSCAPE, "groupmode")) == Some("layer") {
                    let label = node.attribute((INKSCAPE, "label")).or(node.attribute("id"));
                    self.layers.push(label.unwrap_or_default().to_owned());
                    context.layer = self.layers.len() - 1;
                }
                self.read_children(node, &context, false)
            }
            _ => self.read_shape(node, &context),
        }
    }

    fn read_nested(&mut self, node: Node<'a, 'input>, context: &Context) -> Result<(), Error> {
        let [width, height] = context.viewport;
        let corner = [
            self.length(node, "x", width)?.unwrap_or(0.0),
            self.length(node, "y", height)?.unwrap_or(0.0),
        ];
        let size = [
            self.length(node, "width", width)?.unwrap_or(width),
            self.length(node, "height", height)?.unwrap_or(height),
        ];
        let inner = self.enter_view(node, context, corner, size)?;
        self.read_children(node, &inner, false)
    }

    fn read_use(&mut self, node: Node<'a, 'input>, context: &Context) -> Result<(), Error> {
        const XLINK: &str = "http://www.w3.org/1999/xlink";
        let href = node.attribute("href").or(node.attribute((XLINK, "href"))).unwrap_or_default();
        let Some(&shown) = href.strip_prefix('#').and_then(|id| self.ids.get(id)) else {
            self.warnings.insert(format!("<use> of {href:?}: there is no such element here"));
            return Ok(());
        };
        let [width, height] = context.viewport;
        let corner = [
            self.length(node, "x", width)?.unwrap_or(0.0),
            self.length(node, "y", height)?.unwrap_or(0.0),
        ];
        if shown.tag_name().name() == "symbol" {
            let size = [
                self.length(node, "width", width)?.unwrap_or(width),
                self.length(node, "height", height)?.unwrap_or(height),
            ];
            let mut inner = self.enter_view(shown, context, corner, size)?;
            inner.depth += 1;
            return self.read_children(shown, &inner, false);
        }
        let mut inner = context.clone();
        inner.to_page *= Affine::translate((corner[0], corner[1]));
        self.read_element(shown, &inner, false)
    }

    fn read_shape(&mut self, node: Node<'a, 'input>, context: &Context) -> Result<(), Error> {
        if !context.style.is_seen() {
            return Ok(());
        }
        let mut outline = Outline::new(
            context.to_page,
            self.options.tolerance_mm,
            self.options.max_segments - self.n_segments.min(self.options.max_segments),
        );
        self.trace(node, context.viewport, &mut outline)?;
        let lines = outline.finish().map_err(|fault| match fault {
            shape::Fault::Coordinate => Error::Coordinate { line: self.line_of(node) },
            shape::Fault::TooMany => {
                Error::TooMany { what: "straight pieces", limit: self.options.max_segments }
            }
        })?;
        if lines.is_empty() {
            return Ok(());
        }
        self.n_segments += lines.n_points();
        let pen = self.pen_for(context);
        for line in lines.iter() {
            self.pens[pen].lines.push(line.iter().copied());
        }
        Ok(())
    }

    /// Index of the pen that draws in the context's layer and color.
    fn pen_for(&mut self, context: &Context) -> usize {
        let color = context.style.color();
        let key = (context.layer, color);
        if let Some(&pen) = self.pen_of.get(&key) {
            return pen;
        }
        let label = match self.layers[context.layer].as_str() {
            "" => key.1.trim_start_matches('#').to_owned(),
            label => label.to_owned(),
        };
        let scale = context.to_page.determinant().abs().sqrt();
        let pen = Pen { width_mm: context.style.stroke_width * scale, color: key.1.clone() };
        self.pens.push(PenLines { label, pen, lines: Polylines::default() });
        self.pen_of.insert(key, self.pens.len() - 1);
        self.pens.len() - 1
    }
}
