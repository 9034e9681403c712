//! Which lines are drawn, and how.

use clap::Args;
use hiddenline::stages::classify::{DEFAULT_CREASE_DEG, LineSelection};
use hiddenline::stages::draw::{DEFAULT_SHORTEST_STROKE_MM, DrawOptions};
use hiddenline::stages::engines::edge::LineEngine;
use hiddenline::stages::page::Dash;
use hiddenline::stages::strokes::HiddenLines;

use crate::cli::choice::one_of;
use crate::cli::plotting::Plotting;
use crate::cli::{config, values};

#[derive(Args)]
#[command(next_help_heading = "Lines")]
pub(super) struct LineArgs {
    /// Kinds of line to draw, with commas between them
    ///
    ///   silhouette    between a front and a back face
    ///   crease        where faces meet at more than --crease
    ///   boundary      on one face only
    ///   nonmanifold   on three faces or more
    ///   intersection  where faces pierce each other
    ///   wire          polylines of the model that border no face
    ///   material      where groups or materials change
    ///   mesh, all     every edge of the mesh
    ///   outline       silhouette, boundary and nonmanifold edges where the background is seen
    ///                 beside them; with other kinds it has its own pen, twice as wide
    ///   shadow        outlines of the shadows that --light casts, also on the --ground
    ///
    /// An edge to which several kinds apply is drawn when any of them is named.
    #[arg(long, value_name = "KINDS", value_parser = values::KindsOfLine, verbatim_doc_comment)]
    #[arg(hide_possible_values = true)]
    #[arg(default_value = "silhouette,crease,boundary,nonmanifold,intersection,wire")]
    lines: LineSelection,
    /// Faces that meet at more than this angle make a crease
    #[arg(long, value_name = "DEG", value_parser = values::crease)]
    #[arg(default_value_t = DEFAULT_CREASE_DEG)]
    crease: f64,
    /// Hidden lines: left out, or drawn on their own layer [default: none]
    #[arg(long, value_parser = one_of::<HiddenLines>())]
    hidden: Option<HiddenLines>,
    /// Draw hidden lines behind at most N faces, each level on its own layer
    ///
    /// Every triangle in front of a line counts, so a solid body counts twice: its front and its
    /// back. The lines are dashed unless --hidden solid is given; --pen hidden1=…, hidden2=… set
    /// their pens.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=99))]
    hidden_levels: Option<u32>,
    /// Lengths of dashes and gaps of hidden lines
    #[arg(long, value_name = "DASH,GAP", value_parser = values::dash, default_value = "2.5,1.25")]
    pub(super) dash: Dash,
    /// Hidden-line algorithm; all give the same drawing
    #[arg(long, value_parser = one_of::<LineEngine>(), default_value = LineEngine::Auto.name())]
    engine: LineEngine,
    /// Faces do not hide lines this close to their plane, in model units
    ///
    /// For parts that touch, but not exactly. The default is about the rounding of the largest
    /// coordinate in single precision; 0 turns it off.
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

impl LineArgs {
    /// Warnings about what was typed but has no effect.
    pub(super) fn without_effect(&self, plotting: &Plotting) -> Vec<String> {
        let hidden = self.options().hidden;
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

    pub(super) fn options(&self) -> DrawOptions {
        let hidden = match self.hidden {
            None | Some(HiddenLines::None) if self.hidden_levels.is_none() => HiddenLines::None,
            Some(HiddenLines::None) if config::is_typed("--hidden") => HiddenLines::None,
            Some(HiddenLines::Solid) => HiddenLines::Solid,
            _ if self.exact => HiddenLines::Solid,
            _ => HiddenLines::Dashed,
        };
        DrawOptions {
            lines: self.lines,
            crease_deg: self.crease,
            hidden,
            hidden_levels: self.hidden_levels.filter(|_| hidden != HiddenLines::None),
            exact: self.exact,
            engine: self.engine,
            contact_tolerance: self.contact_tolerance,
            shortest_stroke_mm: self.shortest_stroke,
            apart_by_kind: false,
        }
    }
}
