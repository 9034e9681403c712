//! Vertex normals of OBJ files: `vn x y z`, and the third number of `f a/b/c`.

/// The normals of a file, and those of the corners of its faces.
///
/// Nothing here is an error: a number of a normal that does not exist, or is none, says nothing, and the
/// face is as good without.
#[derive(Debug, Default)]
pub(super) struct Normals {
    vectors: Vec<[f32; 3]>,
    /// For each corner the number of its normal, counted from 1; 0 without one. Shorter than the corners
    /// are many where the last have none.
    corners: Vec<u32>,
}

impl Normals {
    /// Adds a normal.
    pub(super) fn push(&mut self, normal: [f32; 3]) {
        self.vectors.push(normal);
    }

    /// Notes the normal of a corner, from what follows the number of its vertex: `/b/c`. Corners come in
    /// order.
    pub(super) fn note(&mut self, corner: usize, rest: &[u8]) {
        let mut fields = rest.split(|&byte| byte == b'/').skip(2);
        let Some(word) = fields.next().filter(|word| !word.is_empty()) else { return };
        if let Some(number) = self.number(word) {
            self.corners.resize(corner, 0);
            self.corners.push(number);
        }
    }

    /// Forgets the corners from one on.
    pub(super) fn truncate(&mut self, n_corners: usize) {
        self.corners.truncate(n_corners);
    }

    /// Says how many corners there are when all are known.
    pub(super) fn end(&mut self, n_corners: usize) {
        if !self.corners.is_empty() {
            self.corners.resize(n_corners, 0);
        }
    }

    /// The normals of all corners, zero where there is none; empty when there are none at all.
    pub(super) fn of_corners(&self) -> Vec<[f32; 3]> {
        let normal = |&number: &u32| {
            let index = (number as usize).checked_sub(1);
            index.and_then(|index| self.vectors.get(index)).copied().unwrap_or_default()
        };
        let normals: Vec<[f32; 3]> = self.corners.iter().map(normal).collect();
        if normals.iter().all(|&normal| normal == [0.0; 3]) { Vec::new() } else { normals }
    }

    /// The normal's number, counted from 1. Negative ones count back from the last normal.
    fn number(&self, word: &[u8]) -> Option<u32> {
        let number: i64 = std::str::from_utf8(word).ok()?.parse().ok()?;
        let number = if number < 0 {
            (self.vectors.len() as i64).checked_add(number)?.checked_add(1)?
        } else {
            number
        };
        u32::try_from(number).ok().filter(|&number| number > 0)
    }
}
