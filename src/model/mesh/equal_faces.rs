//! Which faces have the same border, in either winding.

use hashbrown::HashTable;
use std::hash::{BuildHasher, Hasher};

use super::Mesh;

/// For each face the first one with the same border. O(corners) expected.
pub(super) fn first_equal_face(mesh: &Mesh) -> Vec<u32> {
    // The hash has a new seed in each run, so no file can be made to collide on purpose. The result
    // does not depend on it.
    let hasher = hashbrown::DefaultHashBuilder::default();
    let hash = |face: u32| {
        // Of all borders through the same vertices the sum and the product are the same, wherever
        // they begin and whichever way they run.
        let (mut sum, mut product) = (0u64, 1u64);
        for &vertex in mesh.face(face) {
            sum = sum.wrapping_add(u64::from(vertex));
            product = product.wrapping_mul(2 * u64::from(vertex) + 3);
        }
        let mut state = hasher.build_hasher();
        [sum, product].into_iter().for_each(|word| state.write_u64(word));
        state.finish()
    };
    let mut first: HashTable<u32> = HashTable::with_capacity(mesh.n_faces());
    (0..mesh.n_faces() as u32)
        .map(|face| {
            let is_equal = |&earlier: &u32| same_border(mesh.face(earlier), mesh.face(face));
            *first.entry(hash(face), is_equal, |&earlier| hash(earlier)).or_insert(face).get()
        })
        .collect()
}

/// Whether two closed borders pass the same vertices in the same cyclic order, either way round.
fn same_border(a: &[u32], b: &[u32]) -> bool {
    let n = a.len();
    n == b.len()
        && (0..n).filter(|&start| b[start] == a[0]).any(|start| {
            (0..n).all(|i| a[i] == b[(start + i) % n])
                || (0..n).all(|i| a[i] == b[(start + n - i) % n])
        })
}
