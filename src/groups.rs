//! Items in numbered groups, in one flat array: what lies in each cell of a grid, what meets at each vertex.
//!
//! ```text
//!   starts  0    2 2       5      group 0 has items[0..2], group 1 none, group 2 items[2..5]
//!   items   a b    c d e
//! ```

/// Items by the number of their group.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Groups<T = u32> {
    starts: Vec<u32>,
    items: Vec<T>,
}

impl<T> Default for Groups<T> {
    /// No groups.
    fn default() -> Self {
        Self { starts: vec![0], items: Vec::new() }
    }
}

/// Takes items with their groups, first to count them, then to put them in their places.
pub struct Sorter<T> {
    starts: Vec<u32>,
    items: Vec<T>,
    is_counting: bool,
}

impl<T> Sorter<T> {
    /// Takes one item.
    #[inline]
    pub fn put(&mut self, group: usize, item: T) {
        // While they are counted and placed, the items of a group belong to the next one, so that each
        // start ends up where it should.
        if self.is_counting {
            self.starts[group + 2] += 1;
        } else {
            let slot = &mut self.starts[group + 1];
            self.items[*slot as usize] = item;
            *slot += 1;
        }
    }
}

impl<T: Copy + Default> Groups<T> {
    /// Sorts what `hand_out` puts into a sorter. It is called twice and must put the same both times. Items
    /// of one group keep their order. O(groups + items).
    pub fn new(n_groups: usize, hand_out: impl Fn(&mut Sorter<T>)) -> Self {
        let mut sorter =
            Sorter { starts: vec![0; n_groups + 2], items: Vec::new(), is_counting: true };
        hand_out(&mut sorter);
        for group in 2..sorter.starts.len() {
            sorter.starts[group] += sorter.starts[group - 1];
        }
        let n_items = sorter.starts.last().map_or(0, |&n| n as usize);
        sorter.items = vec![T::default(); n_items];
        sorter.is_counting = false;
        hand_out(&mut sorter);
        sorter.starts.pop();
        Self { starts: sorter.starts, items: sorter.items }
    }
}

impl<T> Groups<T> {
    /// Groups from pairs of a group and an item that are sorted by their groups. O(groups + items).
    pub fn of_sorted(n_groups: usize, pairs: Vec<(u32, T)>) -> Self {
        let mut starts = vec![0; n_groups + 1];
        pairs.iter().for_each(|(group, _)| starts[*group as usize + 1] += 1);
        for group in 1..starts.len() {
            starts[group] += starts[group - 1];
        }
        Self { starts, items: pairs.into_iter().map(|(_, item)| item).collect() }
    }

    /// The items of a group; none for a group that does not exist.
    #[inline]
    pub fn of(&self, group: usize) -> &[T] {
        match self.starts.get(group..group + 2) {
            Some(&[start, end]) => &self.items[start as usize..end as usize],
            _ => &[],
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn groups_hold_their_items_in_order(pairs in prop::collection::vec((0_u32..9, 0_u32..99), 0..60)) {
            let by_groups = Groups::new(9, |sorter| {
                pairs.iter().for_each(|&(group, item)| sorter.put(group as usize, item));
            });
            let mut sorted = pairs.clone();
            sorted.sort_by_key(|(group, _)| *group);
            prop_assert_eq!(&by_groups, &Groups::of_sorted(9, sorted));
            for group in 0..9 {
                let expected: Vec<u32> =
                    pairs.iter().filter(|(g, _)| *g == group).map(|(_, item)| *item).collect();
                prop_assert_eq!(by_groups.of(group as usize), expected);
            }
            prop_assert!(by_groups.of(9).is_empty() && Groups::<u32>::default().of(0).is_empty());
        }
    }
}
