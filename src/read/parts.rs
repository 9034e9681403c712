//! Parts of a mesh while it is read: each combination of group, material and color once.

use std::collections::HashMap;

use crate::model::mesh::MeshPart;

/// The parts found so far, in order of first use.
#[derive(Debug, Default)]
pub(super) struct PartTable {
    parts: Vec<MeshPart>,
    indices: HashMap<MeshPart, u32>,
    /// The part requested last, since faces of one part mostly follow each other.
    last: Option<u32>,
}

impl PartTable {
    /// The index of a part, which becomes a new one if need be.
    pub(super) fn index(&mut self, part: &MeshPart) -> u32 {
        if let Some(last) = self.last.filter(|&last| self.parts[last as usize] == *part) {
            return last;
        }
        let next = self.parts.len() as u32;
        let index = *self.indices.entry(part.clone()).or_insert(next);
        if index == next {
            self.parts.push(part.clone());
        }
        self.last = Some(index);
        index
    }

    /// The index of the part that has a color, or none, and no names.
    pub(super) fn index_of_color(&mut self, color: Option<[u8; 3]>) -> u32 {
        self.index(&MeshPart { color, ..MeshPart::default() })
    }

    /// All parts; none if they hold no names or colors.
    pub(super) fn into_parts(self) -> Vec<MeshPart> {
        let says_nothing = self.parts.iter().all(|part| *part == MeshPart::default());
        if says_nothing { Vec::new() } else { self.parts }
    }
}

/// A color from components between 0 and 1; others are clamped.
pub(super) fn color_of_parts(parts: [f64; 3]) -> [u8; 3] {
    parts.map(|part| (part * 255.0).round().clamp(0.0, 255.0) as u8)
}

/// The mean of the colors of a face's corners; `None` without corners.
pub(super) fn mean_color(colors: impl Iterator<Item = [u8; 3]>) -> Option<[u8; 3]> {
    let mut sum = [0u64; 3];
    let mut n = 0;
    for color in colors {
        sum = std::array::from_fn(|i| sum[i] + u64::from(color[i]));
        n += 1;
    }
    (n > 0).then(|| sum.map(|part| ((part + n / 2) / n) as u8))
}
