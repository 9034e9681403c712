//! From exactly visible lines to the lines that a drafter would draw.
//!
//! Everything here selects, joins, cuts or leaves out lines on paper, with lengths in pen widths and
//! millimeters. Visibility has already been decided, and no line is added.
//!
//! ```text
//!   draft ─► outline ─► tidy: stitch, corners, shadows, specks and spurs
//!                         │
//!                         ▼
//!                       precedence: coincident ink once ─► thin, halos, on request ─► strokes
//! ```

mod background;
mod cells;
mod edits;
mod halo;
mod inked;
mod leave_out;
mod near;
mod near_ends;
mod outline;
mod stitch;
mod tidy;
mod tiles;

use glam::DVec2;

use crate::camera::Projection;
use crate::classify::ViewedScene;
use crate::model::creases::looseness;
use crate::strokes::draft::Draft;

use self::background::BackgroundFinder;
use self::edits::Tidied;
use self::leave_out::{Rule, Stretch, crowded_share, leave_out};
use self::near::SegmentGrid;
use self::tidy::{rejoin, tidy};

/// In drawings of organic models, figures smaller than this are specks, in millimeters.
const FIGURE_MM: f64 = 3.0;

/// Ink is sorted into cells at least this many times as large as the reach of a search: several cells
/// are looked at, none of which holds much else.
const CELL_REACHES: f64 = 1.0;

/// Ink lies on other ink when their directions differ by no more than this, in degrees.
const OVERLAP_TURN_DEG: f64 = 10.0;

/// Ink this close to other ink lies on it but for rounding, in millimeters.
const ROUNDED_MM: f64 = 0.002;

/// Ink this close to other ink looks as if it lay on it, in millimeters.
const CLOSE_MM: f64 = 0.05;

/// Ink overlaps over at least this many times the distance at which it does: ends that touch do not
/// count.
const SHORTEST_OVERLAP: f64 = 4.0;

/// Where overlaps are left out, pieces shorter than this go too, in millimeters.
const SHORTEST_PIECE_MM: f64 = 0.5;

/// Lines crowd each other when their directions differ by no more than this, in degrees.
const CROWDED_TURN_DEG: f64 = 30.0;

/// Thinned lines return only where there is this much more room than where they ended.
const THIN_RETURN: f64 = 1.4;

/// Thinned stretches are at least this many distances long.
const SHORTEST_THINNED: f64 = 4.0;

/// Where lines are thinned, pieces shorter than this many distances go too, and those shorter than
/// [`SHORTEST_THIN_PIECE_MM`].
const SHORTEST_THIN_PIECE: f64 = 6.0;

/// See [`SHORTEST_THIN_PIECE`], in millimeters.
const SHORTEST_THIN_PIECE_MM: f64 = 1.0;

/// When less than this share of a stroke is left, only scraps of [`SHORTEST_SCRAP_MM`] stay.
const SCRAP_SHARE: f64 = 0.4;

/// See [`SCRAP_SHARE`], in millimeters.
const SHORTEST_SCRAP_MM: f64 = 5.0;

/// Ink is crowded as a whole when more than this share of it is.
pub const CROWDED_SHARE: f64 = 0.25;

/// The default distance between thinned lines, in pen widths: it leaves half a pen width of paper between
/// them.
pub const DEFAULT_THIN: f64 = 1.5;

/// Drawings of more points are not thinned to see what that would save.
const MOST_TRIED_POINTS: usize = 1 << 17;

/// In perspective, lines farther out than this in the image are left as they are. Pages are fitted to
/// less, and a point beside the eye is arbitrarily far out.
const WIDEST: f64 = 10.0;

/// How lines are finished on paper.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DraftingOptions {
    /// Width of the pen in millimeters.
    pub pen_width_mm: f64,
    /// Visible strokes whose extent is below this are left out, in millimeters.
    pub shortest_stroke_mm: f64,
    /// Whether outline is kept apart from other lines.
    pub outline: bool,
    /// Ink this close to other ink, and in its direction, is drawn once, in millimeters; `None` keeps
    /// it.
    pub overlap_mm: Option<f64>,
    /// Least distance between the middles of lines that run beside each other, in millimeters; `None`
    /// for any.
    pub thin_mm: Option<f64>,
    /// How far farther lines stop short of nearer ones, in millimeters; zero for not at all.
    pub halo_mm: f64,
    /// Millimeters on paper of an image unit.
    pub mm_per_unit: f64,
}

/// What was joined and left out.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Drafted {
    /// Ends that were joined to others.
    pub n_joined: usize,
    /// The widest gap that was bridged, in millimeters.
    pub farthest_mm: f64,
    /// Short strokes that were left out.
    pub n_dropped: usize,
    /// Their length in millimeters.
    pub dropped_mm: f64,
    /// Length of what was left out since it lay on other ink, in millimeters.
    pub overlap_mm: f64,
    /// Length of what was left out where lines crowded each other, in millimeters.
    pub thinned_mm: f64,
    /// The share of the ink that has other ink beside it within a pen width, before lines are thinned.
    pub crowded_share: f64,
    /// Length of what thinning to [`DEFAULT_THIN`] would leave out, in millimeters; known only where more than
    /// [`CROWDED_SHARE`] is crowded and lines are not thinned, and not for very large drawings.
    pub thinnable_mm: Option<f64>,
}

/// Finishes the visible and the hidden lines of a view.
///
/// O(points), and O(area of the page over that of the pen), in parallel.
pub fn finish(
    view: &ViewedScene,
    drafts: [Draft; 2],
    options: &DraftingOptions,
) -> (Draft, Drafted) {
    let [visible, hidden] = drafts;
    let mut tidied = Tidied::default();
    let grown = looseness(view.scene()).of_scene();
    let Some(paper) = Paper::new(view, [&visible, &hidden], options, grown) else {
        let mut all = visible;
        all.append(&hidden);
        return (all, Drafted::default());
    };
    let background = BackgroundFinder::new(view, paper.bounds, paper.pen);
    let visible = if options.outline || options.thin_mm.is_some() {
        outline::mark(visible, &background, &paper, options.outline)
    } else {
        visible
    };
    let shortest = options.shortest_stroke_mm * paper.mm;
    let visible = tidy(visible, &paper, Some(&background), shortest, &mut tidied);
    let hidden = tidy(hidden, &paper, None, 0.0, &mut tidied);
    let mut all = visible;
    all.append(&hidden);
    let mut overlap = 0.0;
    if let Some(overlap_mm) = options.overlap_mm {
        let (once, left_out) = leave_out(&all, &paper, &paper.overlaps(overlap_mm));
        if left_out > 0.0 {
            all = rejoin(once, &paper, &background, shortest, &mut tidied);
            overlap += left_out;
        }
    }
    let crowded_share = crowded_share(&all, &paper, &paper.crowds(options.pen_width_mm));
    let is_tried = options.thin_mm.is_none()
        && crowded_share > CROWDED_SHARE
        && all.points().len() <= MOST_TRIED_POINTS;
    let thinnable = is_tried.then(|| {
        let rule = paper.crowds(DEFAULT_THIN * options.pen_width_mm);
        leave_out(&all, &paper, &rule).1
    });
    let mut thinned = 0.0;
    if let Some(distance_mm) = options.thin_mm {
        (all, thinned) = leave_out(&all, &paper, &paper.crowds(distance_mm));
    }
    if options.halo_mm > 0.0 {
        let is_perspective = matches!(view.camera().projection(), Projection::Perspective { .. });
        all = halo::cut(&all, &paper, options.halo_mm * paper.mm, is_perspective);
    }
    if !options.outline {
        all.forget_outline();
    }
    let drafted = Drafted {
        n_joined: tidied.n_joined,
        farthest_mm: tidied.farthest / paper.mm,
        n_dropped: tidied.n_dropped,
        dropped_mm: tidied.dropped / paper.mm,
        overlap_mm: overlap / paper.mm,
        thinned_mm: thinned / paper.mm,
        crowded_share,
        thinnable_mm: thinnable.map(|length| length / paper.mm),
    };
    (all, drafted)
}

/// Lengths on paper in image units.
struct Paper {
    /// A millimeter.
    mm: f64,
    /// The pen width.
    pen: f64,
    /// Smaller figures are specks.
    figure: f64,
    /// What of the image the lines take up.
    bounds: (DVec2, DVec2),
}

impl Paper {
    /// `None` when there is nothing that could be finished.
    fn new(
        view: &ViewedScene,
        drafts: [&Draft; 2],
        options: &DraftingOptions,
        grown: f64,
    ) -> Option<Self> {
        let mm = 1.0 / options.mm_per_unit;
        let pen = options.pen_width_mm * mm;
        let points = || drafts.into_iter().flat_map(Draft::points).map(|point| point.at);
        let first = points().next()?;
        let widest = match view.camera().projection() {
            Projection::Perspective { .. } => DVec2::splat(WIDEST),
            Projection::Orthographic => DVec2::INFINITY,
        };
        let (low, high) = points().fold((first, first), |(l, h), p| (l.min(p), h.max(p)));
        let bounds = (low.clamp(-widest, widest), high.clamp(-widest, widest));
        let is_usable = mm.is_finite() && mm > 0.0 && pen > 0.0 && pen.is_finite();
        let figure = pen.max(FIGURE_MM * grown * mm);
        is_usable.then_some(Self { mm, pen, figure, bounds })
    }

    /// Ink that lies on other ink. First what does so most closely, however short it is.
    fn overlaps(&self, distance_mm: f64) -> Rule {
        let stretch = |distance_mm: f64| {
            let distance = distance_mm * self.mm;
            let shortest_gap = SHORTEST_OVERLAP * distance;
            let shortest_piece = (SHORTEST_PIECE_MM * self.mm).min(shortest_gap);
            Stretch { near: distance, crowded: distance, shortest_gap, shortest_piece }
        };
        let distances = [ROUNDED_MM.min(distance_mm), CLOSE_MM.min(distance_mm), distance_mm];
        Rule {
            stretches: distances.map(stretch).into(),
            sine: libm::sin(OVERLAP_TURN_DEG.to_radians()),
            shortest_scrap: 0.0,
            scrap_share: 0.0,
        }
    }

    /// Ink that leaves no room between itself and other ink.
    fn crowds(&self, distance_mm: f64) -> Rule {
        let distance = distance_mm * self.mm;
        let stretch = Stretch {
            near: THIN_RETURN * distance,
            crowded: distance,
            shortest_gap: SHORTEST_THINNED * distance,
            shortest_piece: (SHORTEST_THIN_PIECE * distance).max(SHORTEST_THIN_PIECE_MM * self.mm),
        };
        Rule {
            stretches: vec![stretch],
            sine: libm::sin(CROWDED_TURN_DEG.to_radians()),
            shortest_scrap: SHORTEST_SCRAP_MM * self.mm,
            scrap_share: SCRAP_SHARE,
        }
    }

    /// For searches within `reach` of a segment.
    fn grid(&self, draft: &Draft, reach: f64) -> SegmentGrid {
        SegmentGrid::new(draft, self.bounds, CELL_REACHES * reach)
    }
}
