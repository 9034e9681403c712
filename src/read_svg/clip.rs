//! `clip-path`: the area of a `<clipPath>` on the page.

use std::rc::Rc;

use kurbo::{Affine, Point, Rect};
use roxmltree::Node;

use super::SvgError;
use super::reader::{Context, Purpose, Reader};
use super::region::{ClipRegion, Polygon};
use super::style::Style;
use super::transform;
use crate::plot::Polylines;

impl<'a, 'input> Reader<'a, 'input> {
    /// The area that `clip-path` leaves of `node`; `None`, with a warning, if it is unknown.
    pub(super) fn clip_region(
        &mut self,
        value: &str,
        node: Node<'a, 'input>,
        context: &Context,
    ) -> Result<Option<Rc<ClipRegion>>, SvgError> {
        let id = value.trim().strip_prefix("url(").and_then(|rest| rest.split(')').next());
        let id = id.map(|id| id.trim().trim_matches(['"', '\'']).trim_start_matches('#'));
        let Some(id) = id else {
            self.warn_at(node, &format!("`clip-path: {value}` is not understood"));
            return Ok(None);
        };
        let found = self.ids.get(id).copied().filter(|n| n.tag_name().name() == "clipPath");
        let Some(clip) = found else {
            self.warn_at(node, &format!("no <clipPath> has the id {id:?}"));
            return Ok(None);
        };
        if self.open_clips.contains(&clip.id()) {
            self.warn_at(clip, "<clipPath> clips itself; it is ignored");
            return Ok(None);
        }
        let mut to_page = context.to_page;
        if clip.attribute("clipPathUnits") == Some("objectBoundingBox") {
            match self.object_box(node, context)? {
                Some(object) => {
                    to_page *= Affine::new([
                        object.width(),
                        0.0,
                        0.0,
                        object.height(),
                        object.x0,
                        object.y0,
                    ]);
                }
                None => return Ok(Some(Rc::default())),
            }
        }
        let key = (clip.id(), to_page.as_coeffs().map(f64::to_bits));
        if let Some(region) = self.regions.get(&key) {
            return Ok(Some(region.clone()));
        }
        self.open_clips.push(clip.id());
        let region = self.read_clip(clip, Context { to_page, ..context.clone() });
        self.open_clips.pop();
        let region = Rc::new(region?);
        self.regions.insert(key, region.clone());
        Ok(Some(region))
    }

    /// The union of the shapes in a `<clipPath>`, within the areas that clip them.
    fn read_clip(
        &mut self,
        clip: Node<'a, 'input>,
        around: Context,
    ) -> Result<ClipRegion, SvgError> {
        let (style, own) = self.sheet.style(clip, &Style::default());
        let mut context = Context { style, clips: Vec::new(), depth: around.depth + 1, ..around };
        if let Some(text) = clip.attribute("transform") {
            match transform::parse_attribute(text) {
                Ok(transform) => context.to_page *= transform,
                Err(()) => self.warn_of_value(clip, "transform"),
            }
        }
        let mut region = ClipRegion::default();
        if let Some(value) = &own.clip_path {
            region.within.extend(self.clip_region(value, clip, &context)?);
        }
        for child in clip.children().filter(Node::is_element) {
            let (style, own) = self.sheet.style(child, &context.style);
            if child.tag_name().name() == "text" {
                self.warn_at(child, "<text> in <clipPath> is ignored");
            }
            let lines = self.outlines_of(child, &context)?;
            let mut within = Vec::new();
            if let Some(value) = &own.clip_path {
                let mut inner = context.clone();
                inner.to_page *= child
                    .attribute("transform")
                    .and_then(|text| transform::parse_attribute(text).ok())
                    .unwrap_or_default();
                within.extend(self.clip_region(value, child, &inner)?);
            }
            region.polygons.extend(Polygon::new(&lines, style.clip_rule, within));
        }
        Ok(region)
    }

    /// The outlines of an element and its children on the page, whatever their paint.
    fn outlines_of(
        &mut self,
        node: Node<'a, 'input>,
        context: &Context,
    ) -> Result<Polylines, SvgError> {
        let purpose = std::mem::replace(&mut self.purpose, Purpose::Outlines);
        let before = std::mem::take(&mut self.outlines);
        let result = self.read_element(node, context);
        self.purpose = purpose;
        let outlines = std::mem::replace(&mut self.outlines, before);
        result.map(|()| outlines)
    }

    /// The box of an element's outlines in its own coordinates. `context` is that of its contents.
    fn object_box(
        &mut self,
        node: Node<'a, 'input>,
        context: &Context,
    ) -> Result<Option<Rect>, SvgError> {
        // Read once more with its transform undone, so that contents land where `context` says.
        let (_, own) = self.sheet.style(node, &context.style);
        let own_transform = self.transform(node, &own, context)?;
        let around =
            Context { to_page: context.to_page * own_transform.inverse(), ..context.clone() };
        if !around.to_page.is_finite() {
            return Ok(None);
        }
        let outlines = self.outlines_of(node, &around)?;
        Ok(box_of(&outlines, context.to_page.inverse()))
    }

    /// The box of an element's outlines in the coordinates around it, as if it had no transform.
    pub(super) fn own_box(
        &mut self,
        node: Node<'a, 'input>,
        around: &Context,
    ) -> Result<Option<Rect>, SvgError> {
        if !around.to_page.inverse().is_finite() {
            return Ok(None);
        }
        let boxed = self.boxed.replace(node.id());
        let outlines = self.outlines_of(node, around);
        self.boxed = boxed;
        Ok(box_of(&outlines?, around.to_page.inverse()))
    }
}

/// The box of lines on the page in user units.
fn box_of(outlines: &Polylines, to_user: Affine) -> Option<Rect> {
    let points = outlines.iter().flatten().map(|p| to_user * Point::new(p.x, p.y));
    let mut found: Option<Rect> = None;
    for p in points {
        let at = Rect::from_points(p, p);
        found = Some(found.map_or(at, |all| all.union(at)));
    }
    found.filter(|object| object.is_finite())
}
