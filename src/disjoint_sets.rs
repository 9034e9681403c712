//! Union-find: elements grouped by joining two at a time.

/// Disjoint sets of the numbers from 0 up to some number, as a forest (R. E. Tarjan, "Efficiency of a good
/// but not linear set union algorithm", JACM 22, 1975).
#[derive(Debug, Clone)]
pub struct DisjointSets {
    parents: Vec<u32>,
}

impl DisjointSets {
    /// Each of `n` numbers in a set of its own.
    pub fn new(n: usize) -> Self {
        Self { parents: (0..n as u32).collect() }
    }

    /// The least number in the set of `one`.
    pub fn of(&mut self, one: u32) -> u32 {
        root(&mut self.parents, one)
    }

    /// Makes one set of the sets of `a` and `b`. Returns its least number and that of the set that is no
    /// more; they are equal if both were one set already.
    pub fn unite(&mut self, a: u32, b: u32) -> [u32; 2] {
        let (a, b) = (self.of(a), self.of(b));
        let [kept, gone] = [a.min(b), a.max(b)];
        self.parents[gone as usize] = kept;
        [kept, gone]
    }
}

/// The root of a number's set in a forest in which a root is its own parent. Halves the path to it.
pub fn root(parents: &mut [u32], one: u32) -> u32 {
    let mut root = one;
    while parents[root as usize] != root {
        let next = parents[parents[root as usize] as usize];
        parents[root as usize] = next;
        root = next;
    }
    root
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_are_what_searching_along_the_pairs_finds() {
        let n = 200u32;
        let mut state = 5u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 33) as u32 % n
        };
        let mut sets = DisjointSets::new(n as usize);
        let mut least: Vec<u32> = (0..n).collect();
        for _ in 0..150 {
            let (a, b) = (next(), next());
            let [one, other] = [least[a as usize], least[b as usize]];
            assert_eq!(sets.unite(a, b), [one.min(other), one.max(other)]);
            let gone = one.max(other);
            least.iter_mut().filter(|of| **of == gone).for_each(|of| *of = one.min(other));
            assert!((0..n).all(|k| sets.of(k) == least[k as usize]));
        }
    }
}
