//! Hatching: tone in lines, with exact shadows.
//!
//! ```text
//!   families of planes ─┐
//!                       ├─► cut ──► segments in faces ─┬─► seen from the eye ───┐
//!   scene, ground ──────┘                              └─► seen from the light ─┤
//!                                                                               ▼
//!              strokes ◄── chained along lines ◄── tone: which lines where ◄── pieces
//! ```
//!
//! A hatch line is where a plane cuts the faces of the scene. Each of its segments lies in a face and has
//! exact ends, and the line engine answers twice for it: which parts the eye sees, and which parts the light
//! sees. Both answers are parameters along the same segment, so borders of shadows are as exact as
//! visibility. Only then comes the tone, which is rounded: how many of the lines are drawn.
//!
//! Lines of one family nest: a darker place keeps every line of a lighter one (prioritized strokes:
//! G. Winkenbach and D. H. Salesin, "Computer-generated pen-and-ink illustration", SIGGRAPH 1994; E. Praun
//! et al., "Real-time hatching", SIGGRAPH 2001). Coverage is that of Murray and Davies: lines of width `w`
//! at distance `s` cover `w / s` of the paper.

mod cut;
mod families;
mod gap;
mod ground;
mod interval;
mod options;
mod outline;
mod pieces;
mod strokes;
mod tone;

use crate::camera::Camera;
use crate::classify::{LineSelection, ViewSegments, ViewedScene};
use crate::draw::DrawOptions;
use crate::draw::surface::SurfaceOutput;
use crate::engines::edge::{VisibilityOptions, roberts};
use crate::engines::visibility::{Span, Visibility};
use crate::model::scene::Scene;
use crate::predicates::FreePlane;
use crate::shading::light::Light;
use crate::strokes::Strokes;

use self::cut::{Cutter, GROUND, HatchSegment};
use self::families::Families;
use self::gap::{Gaps, outlines};
use self::ground::ground_height;
use self::pieces::Pieces;
use self::tone::Tones;

pub use self::outline::shadow_outlines;

pub use self::options::{
    DEFAULT_BLACK, DEFAULT_HATCH_GAP_MM, DEFAULT_SHORTEST_HATCH_MM, DEFAULT_SMOOTH_DEG,
    DEFAULT_WHITE, Ground, HatchError, HatchLevels, HatchMaterial, HatchMethod, HatchOptions,
    HatchPage, HatchShadows, LEVELS, MOST_FAMILIES,
};

/// Hatches a surface as its drawing shows it. Without a scene in the drawing, nothing is hatched.
///
/// With `exact` every line at the base distance is drawn; see [`hatch`]. `width_mm` is the pen width.
///
/// # Errors
/// See [`HatchError`].
pub fn hatch_surface(
    drawing: &SurfaceOutput,
    options: &HatchOptions,
    exact: bool,
    width_mm: f64,
) -> Result<Strokes, HatchError> {
    let Some(scene) = &drawing.scene else { return Ok(Strokes::default()) };
    let lines = DrawOptions { exact, contact_tolerance: Some(0.0), ..DrawOptions::default() };
    hatch(scene, &drawing.camera, options, &lines, &HatchPage::new(&drawing.page, width_mm))
}

/// Hatches `scene` as `camera` sees it.
///
/// Of `lines` only the contact tolerance counts, and whether the drawing is exact: then every line of
/// base distance is there, one stroke of two points for each maximal interval that is seen and either lit
/// or not, whatever the tone.
///
/// # Errors
/// See [`HatchError`].
pub fn hatch(
    scene: &Scene,
    camera: &Camera,
    options: &HatchOptions,
    lines: &DrawOptions,
    page: &HatchPage,
) -> Result<Strokes, HatchError> {
    options.check(page)?;
    let Some((low, high)) = scene.mesh().bounds() else { return Ok(Strokes::default()) };
    let light = Light::new(options.light, camera);
    let light_camera = light.camera((low, high))?;
    let families = Families::new(options, camera, &light, page, scene.mesh().parts());
    let tones = Tones::new(scene, camera, light, options, page);
    let mut segments = ViewSegments::new(scene);
    let cutter = Cutter {
        scene,
        camera,
        families: &families,
        tones: &tones,
        page,
        levels: options.levels,
        every_line: lines.exact,
    };
    let mut hatched = cutter.cut(&mut segments)?;
    if let Some(ground) = options.ground
        && tones.has_cast_shadows()
    {
        let height = ground_height(ground, low);
        cutter.cut_ground(&light, (low, high), height, &mut segments, &mut hatched)?;
    }
    if hatched.is_empty() {
        return Ok(Strokes::default());
    }

    let visibility = VisibilityOptions {
        contact_tolerance: lines.contact_tolerance_in(scene),
        count_layers: false,
        find_doubled: false,
        ..VisibilityOptions::EXACT
    };
    let has_gaps = options.gap_mm > 0.0 && !lines.exact;
    let outlines = if has_gaps { outlines() } else { LineSelection::NONE };
    let view = ViewedScene::with_segments(scene, camera, outlines, 180.0, &segments);
    let seen = Seen::new(&view, &visibility, hatched.len());
    let mut from_light =
        ViewedScene::with_segments(scene, &light_camera, LineSelection::NONE, 180.0, &segments);
    let first = scene.n_lines() as u32;
    let turns = |triangle: u32| [&view, &from_light].map(|v| v.triangle_turns()[triangle as usize]);
    let faces_light: Vec<bool> = hatched
        .iter()
        .map(|segment| match segment.at[0] {
            GROUND => true,
            triangle => {
                let [to_eye, to_light] = turns(triangle);
                to_eye == to_light
            }
        })
        .collect();
    let has_cast = tones.has_cast_shadows();
    let is_asked: Vec<bool> = (0..hatched.len())
        .map(|i| has_cast && faces_light[i] && seen.has_visible_part(i))
        .collect();
    from_light.keep(|line| line >= first && is_asked[(line - first) as usize]);
    let lit = Seen::new(&from_light, &visibility, hatched.len());

    let pieces = Pieces {
        view: &view,
        segments: &segments,
        hatched: &hatched,
        families: &families,
        tones: &tones,
        levels: options.levels,
        mm_per_image_unit: page.mm_per_image_unit,
        every_line: lines.exact,
    };
    let gaps = has_gaps
        .then(|| Gaps::new(&view, &seen.visibility, options.gap_mm, page.mm_per_image_unit));
    let intervals = pieces.intervals(&seen, gaps.as_ref(), |i| {
        if tones.has_own_shadows() && !faces_light[i] {
            Lit::Nowhere
        } else if is_asked[i] {
            Lit::Where(lit.spans(i))
        } else {
            Lit::Everywhere
        }
    });
    if lines.exact {
        return Ok(strokes::exact(&pieces, &intervals));
    }
    let shortest = options
        .shortest_mm
        .unwrap_or_else(|| DEFAULT_SHORTEST_HATCH_MM.max(3.0 * page.pen_width_mm));
    Ok(strokes::chained(&pieces, &intervals, shortest))
}

/// The planes of some lines of the families that all faces are cut by.
pub fn planes(
    camera: &Camera,
    options: &HatchOptions,
    page: &HatchPage,
    lines: std::ops::Range<i32>,
) -> Vec<FreePlane> {
    let light = Light::new(options.light, camera);
    let families = Families::new(options, camera, &light, page, &[]);
    let first = families.all.iter().filter(|family| family.class == 0 && !family.is_alternate());
    first.flat_map(|family| lines.clone().map(|line| family.plane(line))).collect()
}

/// What a camera sees of each segment.
struct Seen {
    visibility: Visibility,
    /// For each segment its place among those that were requested, or [`UNASKED`].
    place: Vec<u32>,
}

/// A segment that was not requested, or whose image is a point.
const UNASKED: u32 = u32::MAX;

impl Seen {
    fn new(view: &ViewedScene, options: &VisibilityOptions, n_segments: usize) -> Self {
        let (visibility, _) = roberts::solve(view, options);
        let mut place = vec![UNASKED; n_segments];
        let first = view.scene().n_lines() as u32;
        for (i, drawn) in (0..).zip(view.selected()) {
            if let Some(segment) = drawn.edge.checked_sub(first) {
                place[segment as usize] = i;
            }
        }
        Self { visibility, place }
    }

    /// The spans of a segment; none if it was not requested.
    fn spans(&self, segment: usize) -> &[Span] {
        match self.place[segment] {
            UNASKED => &[],
            place => self.visibility.spans(place as usize),
        }
    }

    fn has_visible_part(&self, segment: usize) -> bool {
        self.spans(segment).iter().any(|span| span.qi == 0)
    }
}

/// Where the light reaches a segment.
enum Lit<'a> {
    Everywhere,
    Nowhere,
    /// Where these spans say that it is seen, or say nothing.
    Where(&'a [Span]),
}
