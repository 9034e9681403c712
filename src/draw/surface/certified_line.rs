//! One drawn line: whether its chords are as close to the function as requested, and where more samples are
//! needed for that.
//!
//! ```text
//!   ├─┼─┼─┼─┼─┼─┼─┼─┤    one jet encloses eight cells at once; a block whose bound fails is halved
//!           ├─┼─┼─┼─┤    down to single cells, and these into up to eight parts
//! ```

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::DVec3;

use super::bound::{PaperBound, SeenPoint, off_bent, off_chord};
use crate::surface::formula::{Class, Interval, Jet, JetLine};

/// Cells that are enclosed together at first.
const BLOCK: usize = 8;

/// Most parts that a cell is divided into evenly.
pub(super) const MOST_PARTS: u32 = 8;

/// How much of what is allowed a cell may take up when it is divided: the final samples are seen from
/// another place and with other neighbors.
const MARGIN: f64 = 0.8;

/// Most jets for one line beyond its even parts, spent where the bound is greatest.
const MOST_DEEP: usize = 400;

/// Parts that are divided more often are as narrow as numbers can tell.
const MOST_HALVINGS: u32 = 40;

/// A line of the lattice: a coordinate of a point in space for each formula, the others being linear.
pub(super) struct CertifiedLine<'a> {
    pub(super) paper: &'a PaperBound,
    /// The axis in space of each formula, its enclosure along the line, and its scale.
    pub(super) formulas: Vec<(usize, JetLine<'a>, f64)>,
    /// Where the samples are along the line, and in space.
    pub(super) places: &'a [f64],
    pub(super) points: Vec<DVec3>,
    /// The cells whose chords are torn open.
    pub(super) torn: Vec<bool>,
    /// What heights are drawn, if not all are.
    pub(super) heights: Option<Interval>,
    /// Most millimeters on paper.
    pub(super) allowed_mm: f64,
}

/// What is known about a line.
#[derive(Debug, Default)]
pub(super) struct LineCertificate {
    /// Chords that were looked at, without holes.
    pub(super) n_chords: usize,
    /// The greatest distance of those that are certified, in millimeters on paper.
    pub(super) bound_mm: f64,
    /// The cells whose chords are not certified.
    pub(super) failed: Vec<u32>,
    /// Chords that are torn open.
    pub(super) n_torn: usize,
    /// Evaluations of jets.
    pub(super) n_jets: usize,
    /// Into how many parts cells should be divided, where that is more than one.
    pub(super) parts: Vec<(u32, u32)>,
    /// Further places that samples are needed at.
    pub(super) further: Vec<f64>,
}

/// A part of a cell.
#[derive(Debug, Clone, Copy)]
struct Part {
    ends: [f64; 2],
    points: [DVec3; 2],
    bound_mm: f64,
    /// How far the curve may be from its chord in space: what is found is where that is greatest, although
    /// bounds on paper may all be infinite.
    off: f64,
    depth: u32,
}

impl PartialEq for Part {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Part {}

impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Part {
    /// The one that is farthest off comes first, then the one that comes first on the line.
    fn cmp(&self, other: &Self) -> Ordering {
        self.off.total_cmp(&other.off).then(other.ends[0].total_cmp(&self.ends[0]))
    }
}

impl CertifiedLine<'_> {
    /// Looks at all chords; with `searches` also for places where samples would help.
    pub(super) fn certify(&mut self, searches: bool) -> LineCertificate {
        let mut known = LineCertificate::default();
        let seen: Vec<Option<SeenPoint>> = self.points.iter().map(|p| self.paper.see(*p)).collect();
        let n_cells = self.places.len() - 1;
        let has_chord = |cell: usize| seen[cell].is_some() && seen[cell + 1].is_some();
        known.n_torn = self.torn.iter().filter(|torn| **torn).count();
        known.n_chords = (0..n_cells).filter(|&k| has_chord(k) && !self.torn[k]).count();
        for start in (0..n_cells).step_by(BLOCK) {
            self.block(start, (start + BLOCK).min(n_cells), &seen, &mut known);
        }
        if searches {
            // Lines that end in a cell are to be smooth up to their end.
            let broken = (0..n_cells).filter(|&cell| {
                self.torn[cell] || seen[cell].is_some() != seen[cell + 1].is_some()
            });
            self.search(broken.map(|cell| cell as u32).collect(), &mut known);
        }
        known
    }

    /// Certifies the cells from one to another, or notes those that fail.
    fn block(
        &mut self,
        from: usize,
        to: usize,
        seen: &[Option<SeenPoint>],
        known: &mut LineCertificate,
    ) {
        let torn = &self.torn;
        let ends = |cell: usize| {
            if torn[cell] { None } else { Some([seen[cell]?, seen[cell + 1]?]) }
        };
        if (from..to).all(|cell| ends(cell).is_none()) {
            return;
        }
        let jets = enclose(&mut self.formulas, self.places[from], self.places[to], known);
        let mut most = 0.0_f64;
        for cell in from..to {
            let Some(ends) = ends(cell) else { continue };
            let off = self.off(&jets, [cell, cell + 1].map(|k| (self.places[k], self.points[k])));
            most = most.max(self.paper.on_paper(&ends, off));
        }
        if most <= self.allowed_mm {
            known.bound_mm = known.bound_mm.max(most);
        } else if to - from == 1 {
            known.failed.push(from as u32);
        } else {
            let middle = (from + to) / 2;
            self.block(from, middle, seen, known);
            self.block(middle, to, seen, known);
        }
    }

    /// How far the curve is from the chord between two samples along each axis in space.
    fn off(&self, jets: &[Option<Jet>; 3], [(from, p), (to, q)]: [(f64, DVec3); 2]) -> DVec3 {
        let (h, p, q) = if from < to { (to - from, p, q) } else { (from - to, q, p) };
        let of = |axis: usize| jets[axis].map_or(0.0, |jet| off_chord(&jet, h, p[axis], q[axis]));
        DVec3::new(of(0), of(1), of(2))
    }

    /// Finds into how many parts each cell that fails must be divided, and where more is needed, the
    /// places of parts that are halved as often as it takes.
    fn search(&mut self, broken: Vec<u32>, known: &mut LineCertificate) {
        let mut deep = BinaryHeap::new();
        for cell in known.failed.clone().into_iter().chain(broken) {
            let k = cell as usize;
            let ends = [self.places[k], self.places[k + 1]];
            let points = [0, 1].map(|n| self.point(self.points[k + n], ends[n], known));
            let whole = Part { ends, points, bound_mm: 0.0, off: 0.0, depth: 0 };
            let n = self.parts(whole, known, &mut deep);
            if n > 1 {
                known.parts.push((cell, n));
            }
        }
        let most = known.n_jets + MOST_DEEP;
        while let Some(part) = deep.pop() {
            if known.n_jets > most {
                break;
            }
            let Some((middle, halves)) = self.halves(part, known) else { continue };
            known.further.push(middle);
            for half in halves {
                let (half, class, _) = self.judged(half, known);
                let is_further =
                    half.bound_mm > MARGIN * self.allowed_mm && half.depth < MOST_HALVINGS;
                if is_further && class >= Class::Continuous {
                    deep.push(half);
                }
            }
        }
    }

    /// How many even parts of a cell are certified, at most [`MOST_PARTS`]; what is not goes to `deep` if
    /// it is continuous.
    fn parts(
        &mut self,
        part: Part,
        known: &mut LineCertificate,
        deep: &mut BinaryHeap<Part>,
    ) -> u32 {
        let (part, class, smooth_mm) = self.judged(part, known);
        let allowed = MARGIN * self.allowed_mm;
        if part.bound_mm <= allowed {
            return 1 << part.depth;
        }
        // The bound of smooth functions falls with the square of the length.
        let needed = (smooth_mm / allowed).sqrt().ceil() * f64::from(1 << part.depth);
        if needed <= f64::from(MOST_PARTS) {
            return needed as u32;
        }
        if 1 << part.depth >= MOST_PARTS {
            if class >= Class::Continuous {
                deep.push(part);
            }
            return MOST_PARTS;
        }
        match self.halves(part, known) {
            Some((_, halves)) => {
                halves.map(|half| self.parts(half, known, deep)).into_iter().max().unwrap_or(1)
            }
            None => MOST_PARTS,
        }
    }

    /// A part with its bound on paper, the class of its formulas, and its bound by second derivatives
    /// alone.
    fn judged(&mut self, part: Part, known: &mut LineCertificate) -> (Part, Class, f64) {
        let jets = enclose(&mut self.formulas, part.ends[0], part.ends[1], known);
        let is_drawn = |heights: Interval| jets[2].is_none_or(|z| z.value.overlaps(heights));
        if !self.heights.is_none_or(is_drawn) {
            return (Part { bound_mm: 0.0, ..part }, Class::Nowhere, 0.0);
        }
        let class = jets.iter().flatten().map(|jet| jet.class).min().unwrap_or(Class::Smooth);
        let [p, q] = part.points;
        // What is not seen needs no samples.
        let (Some(a), Some(b)) = (self.paper.see(p), self.paper.see(q)) else {
            return (Part { bound_mm: 0.0, ..part }, class, 0.0);
        };
        let off = self.off(&jets, [(part.ends[0], p), (part.ends[1], q)]);
        let h = (part.ends[1] - part.ends[0]).abs();
        let bent = |axis: usize| jets[axis].map_or(0.0, |jet| off_bent(&jet, h));
        let smooth_mm = self.paper.on_paper(&[a, b], DVec3::new(bent(0), bent(1), bent(2)));
        let bound_mm = self.paper.on_paper(&[a, b], off);
        (Part { bound_mm, off: off.max_element(), ..part }, class, smooth_mm)
    }

    /// The point of the curve at a place, of which those coordinates are given that are linear.
    fn point(&mut self, mut point: DVec3, at: f64, known: &mut LineCertificate) -> DVec3 {
        for (axis, jet) in enclose(&mut self.formulas, at, at, known).into_iter().enumerate() {
            let Some(jet) = jet else { continue };
            let has_value = jet.class > Class::Nowhere && jet.value.is_bounded();
            point[axis] = if has_value { jet.value.middle() } else { f64::NAN };
        }
        point
    }

    /// Both halves of a part, and where they meet; none if no number is between its ends.
    fn halves(&mut self, part: Part, known: &mut LineCertificate) -> Option<(f64, [Part; 2])> {
        let [from, to] = part.ends;
        let middle = 0.5 * from + 0.5 * to;
        if middle == from || middle == to {
            return None;
        }
        let [p, q] = part.points;
        let point = self.point(0.5 * p + 0.5 * q, middle, known);
        let half = |ends: [f64; 2], points: [DVec3; 2]| Part {
            ends,
            points,
            bound_mm: 0.0,
            off: 0.0,
            depth: part.depth + 1,
        };
        Some((middle, [half([from, middle], [p, point]), half([middle, to], [point, q])]))
    }
}

/// The jets of all formulas between two places of a line, at scale.
fn enclose(
    formulas: &mut [(usize, JetLine, f64)],
    from: f64,
    to: f64,
    known: &mut LineCertificate,
) -> [Option<Jet>; 3] {
    let mut jets = [None; 3];
    let range = Interval::new(from.min(to), from.max(to));
    for (axis, line, scale) in formulas {
        known.n_jets += 1;
        let jet = line.over(range);
        let scaled = |interval: Interval| {
            if *scale == 1.0 { interval } else { interval.times(*scale) }
        };
        jets[*axis] = Some(Jet {
            value: scaled(jet.value),
            first: scaled(jet.first),
            second: scaled(jet.second),
            ..jet
        });
    }
    jets
}
