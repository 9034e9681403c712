//! How finely formulas are sampled, so that drawn lines are as smooth as requested.
//!
//! Enclosures of the formulas say for each piece of a drawn line how far it can be from the function on
//! paper. Where that is too far, columns and rows of samples are added; but only the original lines are
//! drawn. Heights that are found in this way may change the scale of the drawing, so the search is repeated a
//! few times.

use super::bound::PaperBound;
use super::certificate::{Certificate, Certifier, Needs};
use super::error::SurfaceError;
use super::grid::grid_to_draw;
use super::options::{SurfaceEngine, SurfaceLines};
use crate::camera::Camera;
use crate::camera::framing::View;
use crate::page::{Page, PageOptions};
use crate::surface::formula::Axis;
use crate::surface::{Places, SampledSurface, Surface};

/// Most samples of a refined grid.
const MOST_SAMPLES: usize = 4_000_000;

/// Most samples of a refined surface that a mesh engine draws.
const MOST_MESH_SAMPLES: usize = 250_000;

/// Most places along an axis beyond even parts of cells, for each own line; and at least so many.
const MOST_FURTHER: (usize, usize) = (2, 256);

/// Heights that are closer than this on paper are joined where a formula has no value between them, in
/// millimeters. If it is larger, small steps close; if smaller, gaps of rounding stay open.
const CLOSED_MM: f64 = 0.01;

/// Most searches for samples.
const MOST_SEARCHES: usize = 4;

/// Heights that differ by less than this part are drawn at the same scale, nearly.
const SAME_SCALE: f64 = 0.02;

/// A surface that was sampled as finely as its lines need.
pub(super) struct SmoothSurface {
    pub(super) surface: SampledSurface,
    pub(super) camera: Camera,
    /// How close its lines are to the formulas; none if nothing is to be proved.
    pub(super) certificate: Option<Certificate>,
    /// The heights that are drawn, as coordinates before any is multiplied, if others grow without end or
    /// are not requested.
    pub(super) heights: Option<(f64, f64)>,
}

/// Samples the surface, more finely where its lines would deviate from the function by more than
/// `lines` allow.
pub(super) fn sample(
    surface: &Surface,
    view: &View,
    lines: &SurfaceLines,
    page: &PageOptions,
) -> Result<SmoothSurface, SurfaceError> {
    let own = surface.sample()?;
    let camera = view.camera(own.box_bounds())?;
    let is_floating = lines.engine == SurfaceEngine::FloatingHorizon;
    let is_wanted = lines.smoothness_mm > 0.0 && !lines.mesh && !is_floating;
    let sheets = if is_wanted && lines.has_grid_lines() { surface.jets() } else { Vec::new() };
    let Some(places) = own.places().cloned().filter(|_| !sheets.is_empty()) else {
        return Ok(SmoothSurface { surface: own, camera, certificate: None, heights: None });
    };
    let seen = |sampled: &SampledSurface, camera: &Camera| {
        let page = Page::place(&sampled.extent(camera), camera, page);
        PaperBound::new(camera, page.map_or(0.0, |page| page.mm_per_image_unit()))
    };
    let closes = |paper: &PaperBound, sampled: &SampledSurface| {
        paper.height_of(CLOSED_MM, sampled.bounds()) / sampled.factors().z.abs()
    };
    // Heights near poles say nothing about the scale of the others.
    let ((low, high), usual) = (own.bounds(), usual_heights(&own));
    let usual = usual.map_or(high.z - low.z, |(a, b)| (b - a) * own.factors().z.abs());
    let gap = closes(&seen(&own, &camera), &own) * (usual / (high.z - low.z)).min(1.0);
    let mut heights = surface.heights();
    let mut torn = surface.sample_torn(places.clone(), heights, gap)?;
    if torn.has_poles() {
        heights = usual_heights(&own);
        torn = surface.sample_torn(places.clone(), heights, gap)?;
    }
    let own = torn;
    let (mut camera, mut factors) = (view.camera(own.box_bounds())?, own.factors());
    let mut paper = seen(&own, &camera);
    let mut refined: Option<SampledSurface> = None;
    let mut n_jets = 0;
    for _ in 0..MOST_SEARCHES {
        let certifier =
            Certifier { sheets: &sheets, sampled: &own, factors, heights, paper: &paper, lines };
        let (certificate, needs) = certifier.certify(true);
        n_jets += certificate.jets;
        if needs.are_none() {
            refined = None;
            break;
        }
        let by_grid = matches!(grid_to_draw(&own, lines, &camera), Ok(Some(_)));
        let most = if by_grid { MOST_SAMPLES } else { MOST_MESH_SAMPLES };
        let gap = closes(&paper, &own);
        let sampled = surface.sample_torn(divided(&places, needs, most), heights, gap)?;
        camera = view.camera(sampled.box_bounds())?;
        paper = seen(&sampled, &camera);
        let before = std::mem::replace(&mut factors, sampled.factors());
        refined = Some(sampled);
        if ((factors - before) / before).abs().max_element() <= SAME_SCALE {
            break;
        }
    }
    let sampled = refined.unwrap_or(own);
    let camera = view.camera(sampled.box_bounds())?;
    let paper = seen(&sampled, &camera);
    let factors = sampled.factors();
    let certifier =
        Certifier { sheets: &sheets, sampled: &sampled, factors, heights, paper: &paper, lines };
    let (mut certificate, _) = certifier.certify(false);
    certifier.certify_cells(&mut certificate);
    certificate.jets += n_jets;
    Ok(SmoothSurface { surface: sampled, camera, certificate: Some(certificate), heights })
}

/// The heights that are worth drawing of a surface with poles: those of all but the lowest and highest
/// twentieth of its samples, and half as much beyond them.
fn usual_heights(sampled: &SampledSurface) -> Option<(f64, f64)> {
    let mut heights: Vec<f64> = Vec::new();
    for lattice in sampled.lattices() {
        let all = (0..lattice.n_samples).map(|k| lattice.sample(k).z / sampled.factors().z);
        heights.extend(all.filter(|z| z.is_finite()));
    }
    let part = heights.len() / 20;
    let last = heights.len().checked_sub(1)?;
    let mut nth = |k: usize| *heights.select_nth_unstable_by(k, f64::total_cmp).1;
    let [least, low, high, most] = [0, part, last - part, last].map(&mut nth);
    let beyond = 0.5 * (high - low);
    (beyond > 0.0).then_some(((low - beyond).max(least), (high + beyond).min(most)))
}

/// Own lines and as many others between them as are needed and can be afforded.
fn divided(own: &Places, mut needs: Needs, most: usize) -> Places {
    for axis in [Axis::First, Axis::Second] {
        let further = &mut needs.further[axis as usize];
        if further.len() > MOST_FURTHER.0 * own.along(axis).len() + MOST_FURTHER.1 {
            further.clear();
        }
    }
    loop {
        let [a, b] = needs.parts.each_ref().map(Vec::as_slice);
        let [c, d] = needs.further.each_ref().map(Vec::as_slice);
        let n = |parts: &[u32], further: &[f64]| {
            1 + further.len() + parts.iter().map(|n| *n as usize).sum::<usize>()
        };
        if n(a, c).saturating_mul(n(b, d)) <= most {
            return own.divided([a, b], [c, d]);
        }
        let finest = a.iter().chain(b).copied().max().unwrap_or(1);
        if finest == 1 {
            return own.divided([&[], &[]], [&[], &[]]);
        }
        needs.parts.iter_mut().flatten().for_each(|n| *n = (*n).min(finest - 1));
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3};

    use super::*;
    use crate::page::Paper;
    use crate::surface::Aspect;
    use crate::surface::formula::{Formula, Variables};

    /// Points of the function that are looked at on each chord.
    const DENSE: usize = 11;

    struct Random(u64);

    impl Random {
        fn below(&mut self, n: usize) -> usize {
            self.0 ^= self.0 << 13;
            self.0 ^= self.0 >> 7;
            self.0 ^= self.0 << 17;
            (self.0 >> 33) as usize % n
        }
    }

    /// A random formula with poles, roots, logarithms, kinks and jumps.
    fn formula(random: &mut Random, depth: usize) -> String {
        if depth == 0 || random.below(8) == 0 {
            return ["x", "y", "x*y", "r", "0.7", "2", "x - y", "1.3*x", "theta"][random.below(9)]
                .into();
        }
        let mut part = || formula(random, depth - 1);
        let (a, b) = (part(), part());
        let unary = [
            "sin", "cos", "tan", "exp", "ln", "sqrt", "abs", "atan", "cbrt", "sinc", "tanh", "erf",
            "j0", "asinh", "floor",
        ];
        match random.below(12) {
            0 | 1 => format!("({a} + {b})"),
            2 => format!("({a} - {b})"),
            3 | 4 => format!("({a})*({b})"),
            5 => format!("({a})/({b})"),
            6 => format!("max({a}, {b})"),
            7 => format!("({a})^{}", [2, 3, -1][random.below(3)]),
            _ => format!("{}({a})", unary[random.below(unary.len())]),
        }
    }

    fn distance(p: DVec2, a: DVec2, b: DVec2) -> f64 {
        let along = b - a;
        let t = (p - a).dot(along) / along.length_squared();
        let t = if t.is_finite() { t.clamp(0.0, 1.0) } else { 0.0 };
        p.distance(a + t * along)
    }

    /// The farthest that any point of the function is from certified chords of drawn lines, as a part of
    /// the stated bound; and how many chords are certified, of how many.
    fn worst(surface: &Surface, text: &str, view: &View, every: usize) -> (f64, [usize; 2]) {
        let lines = SurfaceLines::default().every(every);
        let page = PageOptions::from(Paper::A4);
        let Ok(smooth) = sample(surface, view, &lines, &page) else { return (0.0, [0, 0]) };
        let (sampled, camera) = (&smooth.surface, &smooth.camera);
        let scale = Page::place(&sampled.extent(camera), camera, &page)
            .map_or(0.0, |p| p.mm_per_image_unit());
        let paper = PaperBound::new(camera, scale);
        let (sheets, factors) = (surface.jets(), sampled.factors());
        let certifier = Certifier {
            sheets: &sheets,
            sampled,
            factors,
            heights: smooth.heights,
            paper: &paper,
            lines: &lines,
        };
        let formula = Formula::parse(text, Variables::Plane).expect(text);
        let places = sampled.places().expect("places");
        let certificate = smooth.certificate.expect("a certificate");
        let mut worst = 0.0_f64;
        let mut counts = [0, 0];
        for axis in [Axis::First, Axis::Second] {
            let lattices = sampled.lattices();
            for (line, known) in certifier.family(&sheets[0], &lattices[0], places, axis, false) {
                let (along, fixed) = (places.along(axis), places.along(axis.other())[line]);
                for k in 0..along.len() - 1 {
                    let at = |t: f64| {
                        let (x, y) = if axis == Axis::First { (t, fixed) } else { (fixed, t) };
                        DVec3::new(x, y, formula.value(x, y) * factors.z)
                    };
                    let ends = [along[k], along[k + 1]].map(at);
                    // Chords that are drawn: not those that are torn, or end where nothing is.
                    let n_columns = lattices[0].n_columns;
                    let number = |k| match axis {
                        Axis::First => line * n_columns + k,
                        Axis::Second => k * n_columns + line,
                    };
                    let [first, next] = [k, k + 1].map(number);
                    let is_sampled = |k| paper.see(lattices[0].sample(k)).is_some();
                    let is_torn = lattices[0].is_torn(first, next);
                    if is_torn || !is_sampled(first) || !is_sampled(next) {
                        continue;
                    }
                    counts[1] += 1;
                    if known.failed.contains(&(k as u32)) {
                        continue;
                    }
                    counts[0] += 1;
                    let [a, b] = ends.map(|p| camera.image(p) * scale);
                    for n in 1..DENSE {
                        let t = n as f64 / DENSE as f64;
                        let p = at(along[k] * (1.0 - t) + along[k + 1] * t);
                        assert!(p.is_finite(), "{text}: certified where it has no value, {p}");
                        let off = distance(camera.image(p) * scale, a, b);
                        worst = worst.max(off / (certificate.bound_mm + 1e-9));
                    }
                }
            }
        }
        assert!(certificate.bound_mm <= lines.smoothness_mm, "{text}: {certificate:?}");
        (worst, counts)
    }

    #[test]
    fn no_point_of_random_formulas_is_farther_from_certified_lines_than_is_stated() {
        let mut random = Random(0x2545_F491_4F6C_DD1D);
        let view = View::default();
        let (mut certified, mut chords) = (0, 0);
        for k in 0..200 {
            let text = formula(&mut random, 4);
            let surface =
                Surface::formula(&text).expect(&text).x(-3.0, 2.9).y(-2.8, 3.1).samples(9, 9);
            let surface = if k % 4 == 0 { surface.aspect(Aspect::Data) } else { surface };
            let (worst, counts) = worst(&surface, &text, &view, 4);
            assert!(worst <= 1.0, "{text}: {worst} times the bound");
            certified += counts[0];
            chords += counts[1];
        }
        assert!(certified * 10 > chords * 6, "{certified} of {chords} chords are certified");
    }

    #[test]
    fn a_narrow_peak_between_samples_is_found() {
        let text = "1/(1 + 1e8*(x - 0.1371)^2)";
        let surface = Surface::formula(text).expect("a formula").samples(41, 41);
        let page = PageOptions::from(Paper::A4);
        let lines = SurfaceLines::default();
        let smooth = sample(&surface, &View::default(), &lines, &page).expect("a surface");
        let (low, high) = smooth.surface.bounds();
        let height = (high.z - low.z) / smooth.surface.factors().z;
        assert!(height > 0.98, "{height}");
        let certificate = smooth.certificate.expect("a certificate");
        assert!(certificate.holds(), "{certificate:?}");
        let (worst, counts) = worst(&surface, text, &View::default(), 20);
        assert!(worst <= 1.0 && counts[0] == counts[1], "{worst}, {counts:?}");
    }

    #[test]
    fn features_along_an_axis_take_few_samples() {
        let size = |text: &str| {
            let surface = Surface::formula(text).expect(text).samples(41, 41);
            let page = PageOptions::from(Paper::A4);
            let smooth = sample(&surface, &View::default(), &SurfaceLines::default(), &page);
            let smooth = smooth.expect("a surface");
            assert!(
                smooth.certificate.is_some_and(|c| c.holds()),
                "{text}: {:?}",
                smooth.certificate
            );
            smooth.surface.places().expect("places").size()
        };
        for (text, most) in [("x + y", 41), ("abs(x - 0.01)", 60), ("exp(-50*x^2)", 130)] {
            let (columns, rows) = size(text);
            assert!(columns <= most && rows == 41, "{text}: {columns} x {rows}");
        }
    }
}
