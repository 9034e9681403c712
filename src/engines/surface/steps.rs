//! A step function that a horizon is certainly beyond, to skip what is well inside it.
//!
//! ```text
//!   v ▲     ╱╲            horizon (upper)
//!     │ ___╱_ ╲__         steps, at or below it
//!     │ ───   ╲___╲___    a cell whose corners are all below the steps above it hides nothing,
//!     │  ▱ ───────── ▱    and nothing of it is seen
//!     └──────────────► u
//! ```
//!
//! A horizon only ever moves outwards, so steps once found stay right; they are found again when as
//! many cells have come as that costs.

/// Steps in a strip. Fewer are coarser than cells; more cost more to find.
const STEPS: usize = 128;

/// Heights count outwards: upward for an upper horizon, downward for a lower one.
#[derive(Clone)]
pub(super) struct Steps {
    start: f64,
    per_u: f64,
    heights: Vec<f64>,
}

impl Steps {
    /// Steps over a strip that nothing is inside of.
    pub(super) fn new(start: f64, border: f64) -> Self {
        let per_u = STEPS as f64 / (border - start);
        let per_u = if per_u.is_finite() { per_u } else { 0.0 };
        Self { start, per_u, heights: vec![f64::NEG_INFINITY; STEPS] }
    }

    /// Number of steps.
    pub(super) fn len(&self) -> usize {
        self.heights.len()
    }

    /// Rounding keeps the order, so a place is never in a step outside those of a range around it.
    #[inline]
    fn range(&self, from: f64, to: f64) -> std::ops::RangeInclusive<usize> {
        let at = |u: f64| (((u - self.start) * self.per_u) as usize).min(STEPS - 1);
        at(from)..=at(to)
    }

    /// Begins to find the steps again; every part of the strip must be given to
    /// [`lower`](Self::lower) then.
    pub(super) fn raise(&mut self) {
        self.heights.fill(f64::INFINITY);
    }

    /// Says that the horizon is at `height` or beyond between two places.
    #[inline]
    pub(super) fn lower(&mut self, from: f64, to: f64, height: f64) {
        let range = self.range(from, to);
        for step in &mut self.heights[range] {
            // What is not a number says nothing.
            *step = if height >= *step {
                *step
            } else if height < *step {
                height
            } else {
                f64::NEG_INFINITY
            };
        }
    }

    /// Whether the horizon is beyond `height` all the way between two places.
    #[inline]
    pub(super) fn are_beyond(&self, height: f64, from: f64, to: f64) -> bool {
        self.heights[self.range(from, to)].iter().all(|&step| step > height)
    }
}
