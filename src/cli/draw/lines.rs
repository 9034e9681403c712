//! Which lines are drawn, and how.

use clap::{Args, ValueEnum};
use hiddenline::stages::classify::{DEFAULT_CREASE_DEG, LineSelection};
use hiddenline::stages::draw::{DEFAULT_SHORTEST_STROKE_MM, DEFAULT_THIN, DrawOptions};
use hiddenline::stages::engines::edge::LineEngine;
use hiddenline::stages::page::{Dash, LineWeights};
use hiddenline::stages::strokes::HiddenLines;

use crate::cli::choice::one_of;
use crate::cli::plotting::Plotting;
use crate::cli::{config, values};

#[derive(Args)]
#[command(next_help_heading = "Lines")]
pub(super) struct LineArgs {
    /// Kinds of lines to draw, separated by commas
    ///
    ///   silhouette    between a front and a back face
    ///   crease        where faces meet at more than --crease
    ///   boundary      edges of only one face
    ///   nonmanifold   edges of three or more faces
    ///   intersection  where faces pierce each other
    ///   wire          polylines of the model that border no face
    ///   material      where groups or materials change
    ///   mesh, all     every edge of the mesh
    ///   outline       silhouette, boundary and nonmanifold edges against the background;
    ///                 together with other kinds it has its own pen, twice as wide
    ///   shadow        outlines of the shadows cast by --light, also on the --ground
    ///
    /// An edge of several kinds is drawn if any of them is selected.
    #[arg(long, value_name = "KINDS", value_parser = values::KindsOfLine, verbatim_doc_comment)]
    #[arg(hide_possible_values = true)]
    #[arg(default_value = "silhouette,crease,boundary,nonmanifold,intersection,wire")]
    pub(super) lines: LineSelection,
    /// Faces that meet at more than this angle form a crease
    #[arg(long, value_name = "DEG", value_parser = values::crease)]
    #[arg(default_value_t = DEFAULT_CREASE_DEG)]
    crease: f64,
    /// How to draw hidden lines [default: none]
    #[arg(long, value_parser = one_of::<HiddenLines>())]
    hidden: Option<HiddenLines>,
    /// Draw hidden lines behind at most N faces, each level on its own layer
    ///
    /// Every triangle in front of a line counts, so a solid body counts twice: its front and its
    /// back. The lines are dashed unless --hidden solid is given; --pen hidden1=…, hidden2=… set
    /// their pens.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=99))]
    hidden_levels: Option<u32>,
    /// Dash and gap length of hidden lines [default: 12 and 3 pen widths]
    #[arg(long, value_name = "DASH,GAP", value_parser = values::dash)]
    pub(super) dash: Option<Dash>,
    /// Draw overlapping ink once, or keep all of it
    ///
    /// Visible lines take precedence over hidden ones, then in the order outline, silhouette, boundary,
    /// intersection, crease, mesh. --overlap-tolerance sets how close counts as overlapping. Lines with
    /// exactly the same image are always drawn once.
    #[arg(long, value_name = "WHAT", value_enum, default_value = "drop")]
    overlap: Overlap,
    /// Thin out crowded lines: where two are closer than MM, end the less important one
    ///
    /// Distances are measured between centerlines that run in nearly the same direction. The default is
    /// 1.5 pen widths, which leaves half a pen width of paper between lines.
    #[arg(long, value_name = "MM", value_parser = values::length, num_args = 0..=1)]
    #[arg(require_equals = true)]
    thin: Option<Option<f64>>,
    /// Stop lines this far from nearer silhouettes, boundaries and wires
    ///
    /// The gap shows which of two lines passes in front. 0.8 suits most pens; some plotting software
    /// bridges gaps of less than 0.6.
    #[arg(long, value_name = "MM", value_parser = values::length, default_value_t = 0.0)]
    halo: f64,
    /// Line widths
    ///
    ///   plain      one pen for all visible lines
    ///   technical  outline twice as wide; the same as adding outline to --lines
    ///   bold       outline four times as wide, silhouettes twice as wide; with a 0.3 mm pen,
    ///              the same as adding outline to --lines, with the rules
    ///              `--pen outline=2:1.2mm --pen silhouette=3:0.6mm`
    #[arg(long, value_enum, default_value = "plain", verbatim_doc_comment)]
    pub(super) style: Style,
    /// Hidden-line algorithm; all give the same drawing
    #[arg(long, value_parser = one_of::<LineEngine>(), default_value = LineEngine::Auto.name())]
    engine: LineEngine,
    /// Faces do not hide lines this close to their plane, in model units
    ///
    /// For parts that nearly touch. The default is about the rounding error of the largest coordinate in
    /// single precision; 0 turns it off.
    #[arg(long, value_name = "D", value_parser = values::not_negative)]
    contact_tolerance: Option<f64>,
    /// Drop visible strokes shorter than this on paper, and close gaps shorter than this in a line
    #[arg(long, value_name = "MM", value_parser = values::not_negative)]
    #[arg(default_value_t = DEFAULT_SHORTEST_STROKE_MM)]
    shortest_stroke: f64,
    /// Draw what is exactly visible: one stroke for each visible interval of each edge
    ///
    /// Nothing is joined, dropped, dashed or merged. For comparisons, not for plotting.
    #[arg(long, conflicts_with = "contact_tolerance")]
    pub(super) exact: bool,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Overlap {
    Drop,
    Keep,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
pub(super) enum Style {
    Plain,
    Technical,
    Bold,
}

impl Style {
    /// What the widths of lines are.
    pub(super) fn weights(self) -> LineWeights {
        match self {
            Self::Plain => LineWeights::Plain,
            Self::Technical => LineWeights::Technical,
            Self::Bold => LineWeights::Bold,
        }
    }
}

impl LineArgs {
    /// Warnings about what was typed but has no effect.
    pub(super) fn without_effect(&self, plotting: &Plotting) -> Vec<String> {
        let hidden = self.hidden();
        let is_none = hidden == HiddenLines::None;
        let has_levels = self.hidden_levels.is_some();
        let idle = [
            (
                hidden != HiddenLines::Dashed,
                "--dash",
                "--dash has no effect without --hidden dashed",
            ),
            (
                is_none && has_levels,
                "--hidden-levels",
                "--hidden-levels has no effect with --hidden none",
            ),
            (
                is_none && plotting.has_hidden_pens(),
                "--pen",
                "--pen for hidden lines has no effect without --hidden dashed or solid",
            ),
        ];
        let typed = idle.iter().filter(|(is_idle, option, _)| *is_idle && config::is_typed(option));
        typed.map(|(.., warning)| (*warning).to_owned()).collect()
    }

    /// The options for a pen of this width; `overlap_mm` is how close ink lies on other ink, if that was
    /// set.
    pub(super) fn options(&self, pen_width_mm: f64, overlap_mm: Option<f64>) -> DrawOptions {
        let hidden = self.hidden();
        DrawOptions {
            lines: self.style.weights().lines(self.lines),
            crease_deg: self.crease,
            hidden,
            hidden_levels: self.hidden_levels.filter(|_| hidden != HiddenLines::None),
            exact: self.exact,
            engine: self.engine,
            contact_tolerance: self.contact_tolerance,
            shortest_stroke_mm: self.shortest_stroke,
            apart_by_kind: false,
            pen_width_mm,
            drops_overlaps: self.overlap == Overlap::Drop,
            overlap_mm,
            halo_mm: self.halo,
            thin_mm: self.thin.map(|mm| mm.unwrap_or(DEFAULT_THIN * pen_width_mm)),
        }
    }

    fn hidden(&self) -> HiddenLines {
        match self.hidden {
            None | Some(HiddenLines::None) if self.hidden_levels.is_none() => HiddenLines::None,
            Some(HiddenLines::None) if config::is_typed("--hidden") => HiddenLines::None,
            Some(HiddenLines::Solid) => HiddenLines::Solid,
            _ if self.exact => HiddenLines::Solid,
            _ => HiddenLines::Dashed,
        }
    }
}
