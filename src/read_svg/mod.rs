//! Reads from any SVG the lines that a pen can draw, in page millimeters, one layer for each pen.
//!
//! ```text
//!  bytes ─► decode ─► elements ─► shape ─► dash array ─► clip paths ─► layers
//!           gzip,     styles,     chords   real dashes   what shows    a pen for each
//!           encoding  transforms                                       label and color
//! ```
//!
//! Outlines of paths, lines, polylines, polygons, rectangles, circles and ellipses are read, with
//! transforms, units, view boxes, nested pictures, `<use>` and `<switch>`; curves become chords.
//! Text, images, masks and markers are not drawn by pens: those that would change the lines are
//! reported as warnings. What SVG does not show is left out: no paint, `opacity` of 0, `display:
//! none`.
//!
//! `usvg` 0.45 resolves most of this for rendering: units, CSS, transforms, `<use>`, `<switch>`,
//! gzip. It does not serve pens, as trying it on our test drawings showed:
//! - Groups keep their `id` alone. Labels of Inkscape layers, which choose the pens and hold AxiDraw's
//!   controls, are gone: seven labeled layers came out as six nameless groups.
//! - Coordinates are `f32`. Equal points stay equal, but pieces of one slanted line are no longer
//!   collinear, so ink drawn twice is not found.
//! - Clip paths and dash arrays are handed on for a rasterizer; a pen needs the cut lines.
//! - Broken path data is cut short without a word, and nothing has a position for messages.
//! - UTF-16 and other encodings are refused.
//!
//! So this module uses the crates that `usvg` is made of: `roxmltree`, `simplecss`, `svgtypes`
//! and `kurbo`.

mod clip;
mod css;
mod dash_array;
mod decode;
mod layers;
mod reader;
mod region;
mod shape;
mod style;
mod transform;

use std::collections::BTreeSet;

use roxmltree::{Document, ParsingOptions};

use crate::plot::Plot;
use css::style_text;
use layers::numbered;
use reader::Reader;

/// Elements inside each other, `<use>` counted too, beyond which a file is refused.
const MAX_DEPTH: usize = 200;
/// The most bytes that entities of the document type may expand to.
const MAX_ENTITY_BYTES: usize = 1 << 28;
/// Largest coordinate in millimeters: ten kilometers.
const MAX_COORDINATE_MM: f64 = 1e7;

/// How to read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SvgOptions {
    /// Maximum distance between a curve and its chords, in page millimeters.
    pub tolerance_mm: f64,
    /// Whether opaque fills hide the ink below them. A shape with a fill but no stroke then only
    /// hides; otherwise its outline is drawn.
    pub occlude: bool,
    /// Straight pieces beyond which a file is refused.
    pub max_segments: usize,
    /// XML nodes, and elements drawn through `<use>`, beyond which a file is refused.
    pub max_elements: u32,
}

impl Default for SvgOptions {
    fn default() -> Self {
        Self {
            tolerance_mm: 0.02,
            occlude: false,
            max_segments: 50_000_000,
            max_elements: 20_000_000,
        }
    }
}

/// Why a file could not be read.
#[derive(Debug, thiserror::Error)]
pub enum SvgError {
    /// The file is compressed and damaged.
    #[error("the gzip data is damaged: {0}")]
    Gzip(std::io::Error),
    /// The file is larger than any drawing, maybe only when unpacked.
    #[error("the file has more than {} MB of text", decode::MAX_TEXT_BYTES >> 20)]
    TooLarge,
    /// No such encoding.
    #[error("the file declares the unknown encoding {0:?}; save it as UTF-8")]
    Encoding(String),
    /// Not XML.
    #[error("not a readable SVG: {}", on_one_line(.0))]
    Xml(#[from] roxmltree::Error),
    /// The root is another element.
    #[error("the root element is <{0}>, not <svg>")]
    NotSvg(String),
    /// Entities would take too much memory.
    #[error("entities of the document type expand to too much text; save the file without them")]
    Entities,
    /// Too deep, or a `<use>` that shows itself.
    #[error(
        "line {line}: elements are nested more than {MAX_DEPTH} deep, or <use> refers to itself"
    )]
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

/// The parser quotes the character that it did not expect, which may break the line or the terminal.
fn on_one_line(error: &roxmltree::Error) -> String {
    let shown =
        |c: char| if c.is_control() { c.escape_default().to_string() } else { c.to_string() };
    error.to_string().chars().map(shown).collect()
}

/// A drawing that was read.
#[derive(Debug, Clone, PartialEq)]
pub struct LineSvg {
    /// The page. Layers whose label begins with a number come first, in the order of these numbers;
    /// the others follow in order of appearance with the next free numbers.
    pub plot: Plot,
    /// What was left out or taken for something else, each kind once; `line N: ` first where it has a place.
    pub warnings: BTreeSet<String>,
}

/// Reads an SVG file: plain or compressed (`.svgz`), in UTF-8, UTF-16 or the encoding it declares.
///
/// # Errors
/// As [`read()`], and damaged or unknown encodings.
pub fn read_bytes(bytes: &[u8], options: &SvgOptions) -> Result<LineSvg, SvgError> {
    let (text, warning) = decode::decode(bytes)?;
    let mut file = read(&text, options)?;
    file.warnings.extend(warning);
    Ok(file)
}

/// Reads the text of an SVG file.
///
/// Lines are kept apart by layer and by stroke color. Layers are the groups directly under the root
/// with `inkscape:groupmode="layer"` or, if there are none, those with an `id`. Shapes with neither
/// stroke nor fill, and those not displayed, are left out. O(file), in memory about ten times the
/// file.
///
/// # Errors
/// Broken XML, bad numbers, and files beyond the limits, before they fill the memory.
pub fn read(text: &str, options: &SvgOptions) -> Result<LineSvg, SvgError> {
    check_entities(text)?;
    let parsing = ParsingOptions {
        allow_dtd: true,
        nodes_limit: options.max_elements,
        ..ParsingOptions::default()
    };
    let document = Document::parse_with_options(text, parsing)?;
    let root = document.root_element();
    if root.tag_name().name() != "svg" {
        return Err(SvgError::NotSvg(root.tag_name().name().to_owned()));
    }
    let css = style_text(root);
    let mut reader = Reader::new(root, &css, options)?;
    reader.read_page(root)?;
    let title = root.children().find(|node| node.tag_name().name() == "title");
    let title = title.and_then(|node| node.text()).unwrap_or_default().trim().to_owned();
    let (pens, warnings, [width_mm, height_mm]) = reader.finish();
    let plot = Plot { width_mm, height_mm, title, source: String::new(), layers: numbered(pens) };
    Ok(LineSvg { plot, warnings })
}

/// Refuses documents whose entities could expand to more than the limit.
///
/// The parser stops loops, and more than 255 references from within one; references from outside
/// of entities it follows without end.
fn check_entities(text: &str) -> Result<(), SvgError> {
    let Some(first) = text.find("<!ENTITY") else { return Ok(()) };
    let last = text.rfind("<!ENTITY").unwrap_or(first);
    let end = text[last..].find('>').map_or(text.len(), |end| last + end);
    let definitions = &text[first..end];
    let nested = if definitions.contains('&') { 256 } else { 1 };
    let references = text[end..].bytes().filter(|&b| b == b'&').count();
    let expanded = references.saturating_mul(definitions.len()).saturating_mul(nested);
    if expanded > MAX_ENTITY_BYTES { Err(SvgError::Entities) } else { Ok(()) }
}
