//! How much of a file has been read, for those who wait.

use std::cell::Cell;

/// Reports to a listener, at most.
const TIMES: usize = 200;

/// Tells a listener which share of a file's bytes has been read.
pub(super) struct Watch<'a> {
    tell: &'a dyn Fn(f64),
    n_bytes: usize,
    /// The position at which the next report is due.
    next: Cell<usize>,
    /// The share of the whole work that is done once the bytes are read.
    most: f64,
}

impl<'a> Watch<'a> {
    /// For a file of `n_bytes`.
    pub(super) fn new(tell: &'a dyn Fn(f64), n_bytes: usize) -> Self {
        Self { tell, n_bytes, next: Cell::new(0), most: 1.0 }
    }

    /// The same for a first pass over the bytes that is only a share of the work.
    pub(super) fn up_to(self, most: f64) -> Self {
        Self { most, ..self }
    }

    /// Bytes before `position` have been read. O(1).
    pub(super) fn at(&self, position: usize) {
        if position >= self.next.get() && self.n_bytes > 0 {
            (self.tell)(self.most * (position as f64 / self.n_bytes as f64).min(1.0));
            self.next.set(position + (self.n_bytes / TIMES).max(1));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_rise_and_are_told_now_and_then() {
        let told = std::cell::RefCell::new(Vec::new());
        let tell = |share: f64| told.borrow_mut().push(share);
        let watch = Watch::new(&tell, 100_000).up_to(0.5);
        (0..=100_000).for_each(|position| watch.at(position));
        let told = told.borrow();
        assert!(told.len() <= TIMES + 1 && told.is_sorted());
        assert_eq!((told.first(), told.last()), (Some(&0.0), Some(&0.5)));
    }
}
