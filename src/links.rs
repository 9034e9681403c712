//! Pieces joined end to end in pairs, and the trails that they form.
//!
//! ```text
//!   piece     0          2          1            ends are numbered 2 · piece + side;
//!          0 ─── 1 ↔ 5 ─── 4 ↔ 2 ─── 3           links: 1 ↔ 5 and 4 ↔ 2
//! ```

/// Marks an end that is joined to no other.
pub const FREE: u32 = u32::MAX;

/// Calls `f` with each trail of joined pieces, as the ends at which they are entered.
///
/// `links` has for each end, numbered `2 · piece + side`, the end it is joined to, or [`FREE`].
pub fn for_each_trail(links: &[u32], mut f: impl FnMut(&[u32])) {
    let mut is_drawn = vec![false; links.len() / 2];
    let mut trail = Vec::new();
    // Trails with loose ends first, from the end that comes first; then closed ones.
    for closed in [false, true] {
        for start in 0..links.len() as u32 {
            let is_loose = links[start as usize] == FREE;
            if is_drawn[start as usize / 2] || !(closed || is_loose) {
                continue;
            }
            trail.clear();
            let mut end = start;
            loop {
                is_drawn[end as usize / 2] = true;
                trail.push(end);
                end = links[(end ^ 1) as usize];
                if end == FREE || is_drawn[end as usize / 2] {
                    break;
                }
            }
            f(&trail);
        }
    }
}
