//! Which pen draws which strokes.

use std::borrow::Cow;

use crate::classify::LineSelection;
use crate::plot::{Layer, Pen, Polylines};
use crate::strokes::{GridFamily, HiddenLines, Stroke, StrokeKind, Strokes, SurfacePart};

use super::{Dash, PlotOptions};

/// Strokes that can have their own pen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PenRole {
    /// Visible strokes of all kinds without their own rule.
    Visible,
    /// Hidden strokes of all levels without their own rule.
    Hidden,
    /// Hidden strokes with this quantitative invisibility.
    HiddenLevel(u32),
    /// Strokes of the outline.
    Outline,
    /// Visible strokes on the underside of a surface.
    Underside,
    /// Visible strokes of one kind.
    Kind(StrokeKind),
    /// Visible grid lines of one family.
    Family(GridFamily),
    /// All visible lines of the sheet with this number, from 1.
    Sheet(u16),
    /// Visible strokes of one kind that belong to a sheet.
    KindOfSheet(u16, StrokeKind),
    /// Visible grid lines of one family that belong to a sheet.
    FamilyOfSheet(u16, GridFamily),
}

impl PenRole {
    /// The name on the command line and of the layer.
    pub fn name(self) -> Cow<'static, str> {
        match self {
            Self::Visible => "visible".into(),
            Self::Hidden => "hidden".into(),
            Self::HiddenLevel(level) => format!("hidden{level}").into(),
            Self::Outline => "outline".into(),
            Self::Underside => "underside".into(),
            Self::Kind(kind) => kind.name().into(),
            Self::Family(family) => family.name().into(),
            Self::Sheet(sheet) => format!("sheet{sheet}").into(),
            Self::KindOfSheet(sheet, kind) => format!("sheet{sheet}.{}", kind.name()).into(),
            Self::FamilyOfSheet(sheet, family) => format!("sheet{sheet}.{}", family.name()).into(),
        }
    }

    /// The role that draws a stroke, among those for which `has_rule` is true: the most specific one, and for
    /// visible strokes the outline before the underside before the kind of a sheet, the kind, and the sheet.
    /// A family is more specific than all grid lines, and index lines are level curves.
    fn of(stroke: &Stroke, has_rule: impl Fn(Self) -> bool) -> Self {
        if stroke.qi > 0 {
            let level = Self::HiddenLevel(stroke.qi);
            return if has_rule(level) { level } else { Self::Hidden };
        }
        let SurfacePart { sheet, family, .. } = stroke.part;
        let sheet = Some(sheet).filter(|sheet| *sheet > 0);
        let wider = (stroke.kind == StrokeKind::Index).then_some(StrokeKind::Level);
        let specials = [
            stroke.outline.then_some(Self::Outline),
            stroke.underside.then_some(Self::Underside),
            sheet.zip(family).map(|(sheet, family)| Self::FamilyOfSheet(sheet, family)),
            sheet.map(|sheet| Self::KindOfSheet(sheet, stroke.kind)),
            sheet.zip(wider).map(|(sheet, kind)| Self::KindOfSheet(sheet, kind)),
            family.map(Self::Family),
            Some(Self::Kind(stroke.kind)),
            wider.map(Self::Kind),
            sheet.map(Self::Sheet),
        ];
        specials.into_iter().flatten().find(|role| has_rule(*role)).unwrap_or(Self::Visible)
    }

    /// Whether lines of other kinds, parts of a surface or hidden levels must not be joined to those that it
    /// draws.
    pub fn tells_kinds_apart(self) -> bool {
        !matches!(self, Self::Visible | Self::Hidden | Self::Outline | Self::Underside)
    }

    /// Whether it is about hidden strokes.
    pub fn is_hidden(self) -> bool {
        matches!(self, Self::Hidden | Self::HiddenLevel(_))
    }
}

/// A pen and the strokes that it draws. Rules with the same number share one pen: the first one describes it
/// and names its layer.
#[derive(Debug, Clone, PartialEq)]
pub struct PenRule {
    /// What it draws.
    pub drawn: PenRole,
    /// Its number, 1 or more.
    pub number: u32,
    /// The pen.
    pub pen: Pen,
    /// Instructions for AxiDraw's software.
    pub controls: LayerControls,
}

impl PenRule {
    /// A rule for pen `number`, 1 or more: a fine pen in the default color of its number.
    ///
    /// ```
    /// use hiddenline::{PenRole, PenRule, StrokeKind};
    ///
    /// let pens = [
    ///     PenRule::new(PenRole::Visible, 1),
    ///     PenRule::new(PenRole::Kind(StrokeKind::Silhouette), 2).width_mm(0.7).color("#202020"),
    /// ];
    /// ```
    pub fn new(drawn: PenRole, number: u32) -> Self {
        let pen = Pen { color: default_pen_color(number).to_owned(), ..Pen::default() };
        Self { drawn, number, pen, controls: LayerControls::default() }
    }

    /// Its line width, in millimeters.
    #[must_use]
    pub fn width_mm(mut self, width_mm: f64) -> Self {
        self.pen.width_mm = width_mm;
        self
    }

    /// Its color, as `#rrggbb`.
    #[must_use]
    pub fn color(mut self, color: impl Into<String>) -> Self {
        self.pen.color = color.into();
        self
    }
}

/// Instructions for AxiDraw's software in the label of a layer.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct LayerControls {
    /// Whether to pause before the layer, to change the pen.
    pub pause: bool,
    /// Speed with the pen down, in percent from 1 to 110.
    pub speed: Option<u32>,
    /// Height of the pen when it is down, in percent from 0 to 100.
    pub height: Option<u32>,
    /// Delay after the pen is lowered, in milliseconds.
    pub delay_ms: Option<u32>,
}

impl LayerControls {
    /// The label of a layer with these controls; `None` without any.
    pub fn label(&self, number: u32, name: &str) -> Option<String> {
        if *self == Self::default() {
            return None;
        }
        let mut label = if self.pause { "!".to_owned() } else { String::new() };
        label.push_str(&number.to_string());
        let values = [("S", self.speed), ("H", self.height), ("D", self.delay_ms)];
        for (letter, value) in values {
            if let Some(value) = value {
                label.push_str(&format!(" +{letter}{value}"));
            }
        }
        Some(format!("{label} {name}"))
    }
}

/// Default colors of pens, by number.
const PALETTE: [&str; 8] =
    ["#000000", "#808080", "#c00000", "#0000c0", "#008000", "#c06000", "#8000a0", "#0090a0"];

/// Nearly black: programs that distinguish pens by color take it for a pen other than that of the visible
/// lines.
const OUTLINE_COLOR: &str = "#101010";

/// Nearly black too, and different from both.
const HATCH_COLOR: &str = "#202020";

/// As nearly black as these, and another color again.
const SILHOUETTE_COLOR: &str = "#181818";

/// As nearly black as these, and one more color.
const INDEX_COLOR: &str = "#080808";

/// Blue: easy to distinguish from the black of upper sides, for people and for programs.
const UNDERSIDE_COLOR: &str = "#0000c0";

/// The default color of pen `number`, counted from 1.
pub fn default_pen_color(number: u32) -> &'static str {
    PALETTE[number.saturating_sub(1) as usize % PALETTE.len()]
}

/// The pen of a visible stroke; one of width `width_mm` where there is no rule for it.
pub fn pen_of(rules: &[PenRule], width_mm: f64, stroke: &Stroke) -> Pen {
    let ruled = |drawn| rules.iter().rev().find(|rule| rule.drawn == drawn);
    let role = PenRole::of(stroke, |role| ruled(role).is_some());
    let usual = || Pen { width_mm, ..Pen::default() };
    // Rules about one pen say what it is like by the first of them.
    let first = |number| rules.iter().find(|rule| rule.number == number);
    ruled(role).and_then(|rule| first(rule.number)).map_or_else(usual, |rule| rule.pen.clone())
}

/// Those of `roles` that draw none of `strokes`, because there are none of that kind or because others of
/// `roles` are more specific.
pub fn idle_pens(roles: &[PenRole], strokes: &Strokes) -> Vec<PenRole> {
    let mut idle = roles.to_vec();
    for stroke in strokes.iter() {
        if idle.is_empty() {
            break;
        }
        let role = PenRole::of(&stroke, |role| roles.contains(&role));
        idle.retain(|other| *other != role);
    }
    idle
}

/// Line widths for lines that end a surface in the image.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum LineWeights {
    /// As wide as all visible lines.
    #[default]
    Plain,
    /// The outline twice as wide.
    Technical,
    /// The outline four times and silhouettes twice as wide.
    Bold,
}

impl LineWeights {
    /// The lines to draw, with the outline where it has its own width.
    #[must_use]
    pub fn lines(self, lines: LineSelection) -> LineSelection {
        if self == Self::Plain { lines } else { lines.with_outline() }
    }

    /// Whether kinds of lines have their own pens.
    pub fn tells_kinds_apart(self) -> bool {
        self == Self::Bold
    }

    /// Adds its pens to `rules`, unless these have some. The outline of twice the width comes with the
    /// usual pens.
    #[must_use]
    pub fn with_pens(self, mut rules: Vec<PenRule>, width_mm: f64) -> Vec<PenRule> {
        if self == Self::Bold {
            add_pen(&mut rules, PenRole::Outline, 4.0 * width_mm, OUTLINE_COLOR.into());
            let silhouette = PenRole::Kind(StrokeKind::Silhouette);
            add_pen(&mut rules, silhouette, 2.0 * width_mm, SILHOUETTE_COLOR.into());
        }
        rules
    }
}

/// Adds the usual pens of a drawing of models to `rules`, unless these have some: one twice as wide for the
/// outline, if other lines are drawn too, and a gray one for each level of hidden lines, paler the more faces
/// hide them.
pub fn with_line_pens(
    mut rules: Vec<PenRule>,
    lines: LineSelection,
    hidden_levels: Option<u32>,
    width_mm: f64,
) -> Vec<PenRule> {
    if lines.has_outline() && lines.has_more_than_outline() {
        add_pen(&mut rules, PenRole::Outline, 2.0 * width_mm, OUTLINE_COLOR.into());
    }
    let levels = hidden_levels.unwrap_or(0);
    for level in 1..=levels {
        let gray = 0x80 + (level - 1) * 0x60 / levels;
        let color = format!("#{gray:02x}{gray:02x}{gray:02x}");
        add_pen(&mut rules, PenRole::HiddenLevel(level), width_mm, color);
    }
    rules
}

/// Adds the usual pen of hatching to `rules`, unless these have one: as wide as the others, on a separate
/// layer.
pub fn with_hatch_pen(mut rules: Vec<PenRule>, width_mm: f64) -> Vec<PenRule> {
    add_pen(&mut rules, PenRole::Kind(StrokeKind::Hatch), width_mm, HATCH_COLOR.into());
    rules
}

/// The width of the pen that hatches according to `rules`, in millimeters; by default that of the other pens.
pub fn hatch_width_mm(rules: &[PenRule], width_mm: f64) -> f64 {
    let hatch = PenRole::Kind(StrokeKind::Hatch);
    let rule = rules.iter().rev().find(|rule| rule.drawn == hatch);
    rule.map_or(width_mm, |rule| rule.pen.width_mm)
}

/// Adds the usual pen of index lines to `rules`, unless these have one: twice as wide as that of the other
/// level curves.
pub fn with_index_pen(mut rules: Vec<PenRule>, width_mm: f64) -> Vec<PenRule> {
    let rule = |drawn| rules.iter().rev().find(|rule| rule.drawn == drawn);
    let of_levels = rule(PenRole::Kind(StrokeKind::Level));
    let pen = of_levels.or_else(|| rule(PenRole::Visible)).map(|rule| rule.pen.clone());
    let width_mm = 2.0 * pen.as_ref().map_or(width_mm, |pen| pen.width_mm);
    let color = of_levels.and(pen).map_or(INDEX_COLOR.to_owned(), |pen| pen.color);
    add_pen(&mut rules, PenRole::Kind(StrokeKind::Index), width_mm, color);
    rules
}

/// Adds a pen for each of several sheets to `rules`, unless these have one: the pen of visible lines for the
/// first sheet, and pens of the same width in the colors of their numbers for the others.
pub fn with_sheet_pens(mut rules: Vec<PenRule>, n_sheets: usize, width_mm: f64) -> Vec<PenRule> {
    let n_sheets = u16::try_from(n_sheets).unwrap_or(u16::MAX);
    if n_sheets < 2 {
        return rules;
    }
    let free = |rules: &[PenRule], from: u32| {
        let is_free = |number: &u32| rules.iter().all(|rule| rule.number != *number);
        (from..).find(is_free).unwrap_or(from)
    };
    let visible = rules.iter().rev().find(|rule| rule.drawn == PenRole::Visible).cloned();
    let visible = visible.unwrap_or_else(|| {
        let number = free(&rules, 1);
        let rule = PenRule::new(PenRole::Visible, number).width_mm(width_mm).color("#000000");
        rules.push(rule.clone());
        rule
    });
    for sheet in 1..=n_sheets {
        let drawn = PenRole::Sheet(sheet);
        if rules.iter().any(|rule| rule.drawn == drawn) {
            continue;
        }
        rules.push(if sheet == 1 {
            PenRule { drawn, ..visible.clone() }
        } else {
            PenRule::new(drawn, free(&rules, sheet.into())).width_mm(visible.pen.width_mm)
        });
    }
    rules
}

/// Whether several sheets have their own pens: with a legend, or if there are pens for some of their lines.
pub fn tells_sheets_apart(rules: &[PenRule], n_sheets: usize, has_legend: bool) -> bool {
    let is_for_all = |role| matches!(role, PenRole::Visible | PenRole::Hidden);
    n_sheets > 1 && (has_legend || rules.iter().any(|rule| !is_for_all(rule.drawn)))
}

/// Adds the usual pen of the underside of a surface to `rules`, unless these have one.
pub fn with_underside_pen(mut rules: Vec<PenRule>, width_mm: f64) -> Vec<PenRule> {
    add_pen(&mut rules, PenRole::Underside, width_mm, UNDERSIDE_COLOR.into());
    rules
}

/// Adds a pen unless there is a rule for what it draws. The first number is left for visible lines.
fn add_pen(rules: &mut Vec<PenRule>, drawn: PenRole, width_mm: f64, color: String) {
    if rules.iter().all(|rule| rule.drawn != drawn) {
        let is_free = |number: &u32| rules.iter().all(|rule| rule.number != *number);
        let number = (2..).find(is_free).unwrap_or(2);
        let (pen, controls) = (Pen { width_mm, color }, LayerControls::default());
        rules.push(PenRule { drawn, number, pen, controls });
    }
}

/// All pens while they draw.
pub(super) struct Holder {
    /// What is drawn by which layer.
    rules: Vec<(PenRole, usize)>,
    layers: Vec<Layer>,
    /// Whether a layer stays when nothing is drawn on it.
    fixed: Vec<bool>,
    visible: usize,
    hidden: usize,
    /// Whether layers for hidden lines have a pattern, and which; otherwise that of their pen.
    has_patterns: bool,
    dash: Option<Dash>,
}

impl Holder {
    pub(super) fn new(options: &PlotOptions) -> Self {
        let has_patterns = options.keep_dashes_whole && options.hidden == HiddenLines::Dashed;
        let mut holder = Self {
            rules: Vec::new(),
            layers: Vec::new(),
            fixed: Vec::new(),
            visible: 0,
            hidden: 0,
            has_patterns,
            dash: options.dash,
        };
        let with_hidden = options.hidden != HiddenLines::None;
        for rule in options.pens.iter().filter(|r| with_hidden || !r.drawn.is_hidden()) {
            let is_dashed = has_patterns && rule.drawn.is_hidden();
            // Whole lines and lines with a pattern cannot share a layer.
            let is_shared = |l: &Layer| l.number == rule.number && l.dash_mm.is_some() == is_dashed;
            let layer = match holder.layers.iter().position(is_shared) {
                Some(layer) => layer,
                None => {
                    let layer = holder.add(rule.drawn, rule.number, rule.pen.clone(), true);
                    let name = rule.drawn.name();
                    holder.layers[layer].label = rule.controls.label(rule.number, &name);
                    layer
                }
            };
            holder.rules.push((rule.drawn, layer));
        }
        let fixed = options.pens.is_empty();
        let mut layer_of = |drawn, color: &str, fixed| {
            let ruled = holder.rules.iter().rev().find(|rule| rule.0 == drawn);
            ruled.map(|rule| rule.1).unwrap_or_else(|| {
                let pen = Pen { width_mm: options.pen_width_mm, color: color.to_owned() };
                let number = holder.free_number();
                holder.add(drawn, number, pen, fixed)
            })
        };
        let visible = layer_of(PenRole::Visible, "#000000", fixed);
        let hidden = layer_of(PenRole::Hidden, "#808080", fixed && with_hidden);
        Self { visible, hidden, ..holder }
    }

    fn free_number(&self) -> u32 {
        let mut number = 1;
        while self.layers.iter().any(|layer| layer.number == number) {
            number += 1;
        }
        number
    }

    fn add(&mut self, drawn: PenRole, number: u32, pen: Pen, fixed: bool) -> usize {
        let name = drawn.name().into_owned();
        let dash = self.dash.unwrap_or(Dash::of_pen(pen.width_mm));
        let has_pattern = self.has_patterns && drawn.is_hidden();
        self.layers.push(Layer {
            number,
            name,
            pen,
            lines: Polylines::default(),
            dash_mm: has_pattern.then_some([dash.dash_mm, dash.gap_mm]),
            ..Layer::default()
        });
        self.fixed.push(fixed);
        self.layers.len() - 1
    }

    /// The layer of a stroke.
    pub(super) fn layer(&mut self, stroke: &Stroke) -> &mut Layer {
        let ruled = |drawn| self.rules.iter().rev().find(|rule| rule.0 == drawn).map(|rule| rule.1);
        let role = PenRole::of(stroke, |role| ruled(role).is_some());
        let usual = if role.is_hidden() { self.hidden } else { self.visible };
        let layer = ruled(role).unwrap_or(usual);
        &mut self.layers[layer]
    }

    /// The layers by number, without empty layers that were not requested.
    pub(super) fn into_layers(self) -> Vec<Layer> {
        let kept = self.layers.into_iter().zip(self.fixed);
        let kept = kept.filter(|(layer, fixed)| *fixed || !layer.lines.is_empty());
        let mut layers: Vec<Layer> = kept.map(|(layer, _)| layer).collect();
        layers.sort_by_key(|layer| layer.number);
        layers
    }
}
