//! Quantitative invisibility of vertices, carried along edges.
//!
//! Every edge between two regular vertices gives the difference of their quantitative invisibilities. A
//! union-find structure with these differences joins vertices into connected sets; one sight line then
//! determines a whole set. An edge within a set repeats what is already known, which serves as a checksum.

/// Vertices in sets, each with its difference to a vertex that represents the set.
#[derive(Debug)]
pub(super) struct LayerCounts {
    parent: Vec<u32>,
    /// The vertex's number less its parent's.
    above: Vec<i32>,
    /// What is known about the set, at the vertex that represents it.
    base: Vec<Base>,
}

/// What is known about one set of vertices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Base {
    /// No sight line was asked.
    Unknown,
    /// The `qi` of the vertex that represents the set.
    Known(i32),
    /// Two ways gave different numbers.
    Contradicted,
}

impl LayerCounts {
    /// `n` vertices, each alone.
    pub(super) fn new(n: usize) -> Self {
        Self { parent: (0..n as u32).collect(), above: vec![0; n], base: vec![Base::Unknown; n] }
    }

    /// The vertex that represents the set, and how much more `vertex` has.
    pub(super) fn find(&mut self, vertex: u32) -> (u32, i32) {
        let (mut root, mut above) = (vertex, 0);
        while self.parent[root as usize] != root {
            above += self.above[root as usize];
            root = self.parent[root as usize];
        }
        // All on the way become children of the root.
        let (mut at, mut left) = (vertex, above);
        while self.parent[at as usize] != root && at != root {
            let next = self.parent[at as usize];
            let own = self.above[at as usize];
            self.parent[at as usize] = root;
            self.above[at as usize] = left;
            left -= own;
            at = next;
        }
        (root, above)
    }

    /// Notes that `b` has `more` than `a`. False when it is known to be otherwise.
    pub(super) fn join(&mut self, a: u32, b: u32, more: i32) -> bool {
        let ((root_a, above_a), (root_b, above_b)) = (self.find(a), self.find(b));
        if root_a == root_b {
            let agrees = above_b - above_a == more;
            if !agrees {
                self.base[root_a as usize] = Base::Contradicted;
            }
            return agrees;
        }
        // The lower number represents both, so that chains stay short and the result is unique.
        let (root, child, above) = if root_a < root_b {
            (root_a, root_b, above_a + more - above_b)
        } else {
            (root_b, root_a, above_b - more - above_a)
        };
        self.parent[child as usize] = root;
        self.above[child as usize] = above;
        if self.base[child as usize] == Base::Contradicted {
            self.base[root as usize] = Base::Contradicted;
        }
        true
    }

    /// Notes that nothing said about the set of `vertex` can be trusted.
    pub(super) fn contradict(&mut self, vertex: u32) {
        let (root, _) = self.find(vertex);
        self.base[root as usize] = Base::Contradicted;
    }

    /// What is known about a set, by the vertex that represents it.
    pub(super) fn base(&self, root: u32) -> Base {
        self.base[root as usize]
    }

    /// Notes the number of a vertex.
    pub(super) fn set(&mut self, vertex: u32, level: i32) {
        let (root, above) = self.find(vertex);
        let base = &mut self.base[root as usize];
        *base = match *base {
            Base::Unknown => Base::Known(level - above),
            Base::Known(known) if known == level - above => *base,
            _ => Base::Contradicted,
        };
    }

    /// The number of a vertex, when it is known.
    pub(super) fn level(&mut self, vertex: u32) -> Option<i32> {
        let (root, above) = self.find(vertex);
        match self.base[root as usize] {
            Base::Known(level) => Some(level + above),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Base, LayerCounts};

    #[test]
    fn differences_add_up_along_any_way_and_contradictions_are_found() {
        let mut levels = LayerCounts::new(6);
        assert!(levels.join(4, 3, 2));
        assert!(levels.join(1, 2, -1));
        assert!(levels.join(3, 2, 5));
        assert!(levels.join(4, 1, 8), "4 + 2 = 3, 3 + 5 = 2, 2 + 1 = 1");
        levels.set(3, 10);
        let numbers: Vec<_> = (0..5).map(|v| levels.level(v)).collect();
        assert_eq!(numbers, [None, Some(16), Some(15), Some(10), Some(8)]);
        assert!(!levels.join(4, 1, 7));
        assert_eq!(levels.level(2), None);
        assert!(levels.join(0, 2, 0));
        let (root, _) = levels.find(4);
        assert_eq!((root, levels.base(root)), (0, Base::Contradicted));
    }
}
