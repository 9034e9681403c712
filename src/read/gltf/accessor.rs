//! Accessors: typed lists within the buffers, with every offset and count checked.

use std::borrow::Cow;

use glam::DVec3;
use gltf_json::accessor::{Accessor, ComponentType, Type};
use gltf_json::validation::Checked;
use gltf_json::{Index, Root, buffer};

use super::missing;
use crate::read::error::Fault;

/// Elements that may be read for each byte of the buffers, and those that always may: files use lists
/// several times, but not without end.
const READS_PER_BYTE: u64 = 8;
const FREE_READS: u64 = 1 << 23;

/// The lists of a file.
pub(super) struct Accessors<'a> {
    root: &'a Root,
    buffers: &'a [Cow<'a, [u8]>],
    /// How many more elements may be read.
    budget: u64,
}

/// How the elements of a list lie in bytes.
#[derive(Clone, Copy)]
struct Layout<'a> {
    bytes: &'a [u8],
    stride: usize,
    component: ComponentType,
    is_normalized: bool,
}

impl<'a> Accessors<'a> {
    pub(super) fn new(root: &'a Root, buffers: &'a [Cow<'a, [u8]>]) -> Self {
        let n_bytes: u64 = buffers.iter().map(|bytes| bytes.len() as u64).sum();
        Self { root, buffers, budget: FREE_READS + READS_PER_BYTE * n_bytes }
    }

    /// A list of vectors. Normalized whole numbers become those that they stand for.
    pub(super) fn vectors(&mut self, index: Index<Accessor>) -> Result<Vec<DVec3>, Fault> {
        let read = |layout: Layout<'_>, i: usize| {
            let component = |c| layout.number(i, c);
            DVec3::new(component(0), component(1), component(2))
        };
        self.elements(index, Type::Vec3, DVec3::ZERO, read)
    }

    /// A list of indices.
    pub(super) fn indices(&mut self, index: Index<Accessor>) -> Result<Vec<u32>, Fault> {
        self.elements(index, Type::Scalar, 0, |layout, i| layout.index(i))
    }

    fn elements<T: Clone>(
        &mut self,
        index: Index<Accessor>,
        kind: Type,
        zero: T,
        read: impl Fn(Layout<'_>, usize) -> T,
    ) -> Result<Vec<T>, Fault> {
        let accessor = self.root.get(index).ok_or_else(|| missing("accessor", index.value()))?;
        let wrong = |what: &str| Fault::Gltf(format!("accessor {} {what}", index.value()));
        if accessor.type_ != Checked::Valid(kind) {
            return Err(wrong("is of the wrong type"));
        }
        let Checked::Valid(component) = accessor.component_type else {
            return Err(wrong("has components of an unknown type"));
        };
        let component = component.0;
        let is_index = kind == Type::Scalar;
        if is_index
            && !matches!(component, ComponentType::U8 | ComponentType::U16 | ComponentType::U32)
        {
            return Err(wrong("holds indices that are not unsigned integers"));
        }
        let count = accessor.count.0;
        let n_sparse = accessor.sparse.as_ref().map_or(0, |sparse| sparse.count.0);
        let n_reads = count.saturating_add(n_sparse);
        let layout = match accessor.buffer_view {
            Some(view) => {
                let offset = accessor.byte_offset.map_or(0, |offset| offset.0);
                Some(self.layout(view, offset, count, component, kind)?)
            }
            None if accessor.sparse.is_some() => None,
            None => return Err(wrong("has no data; it may be compressed")),
        };
        self.budget = self.budget.checked_sub(n_reads).ok_or(Fault::TooManyInstances)?;
        let is_normalized = accessor.normalized;
        let mut elements = match layout {
            Some(layout) => {
                let layout = Layout { is_normalized, ..layout };
                (0..count as usize).map(|i| read(layout, i)).collect()
            }
            None => vec![zero; count as usize],
        };
        if let Some(sparse) = &accessor.sparse {
            let Checked::Valid(index_type) = sparse.indices.component_type else {
                return Err(wrong("has sparse indices of an unknown type"));
            };
            let (indices, values) = (&sparse.indices, &sparse.values);
            let places = self.layout(
                indices.buffer_view,
                indices.byte_offset.0,
                n_sparse,
                index_type.0,
                Type::Scalar,
            )?;
            let values =
                self.layout(values.buffer_view, values.byte_offset.0, n_sparse, component, kind)?;
            let values = Layout { is_normalized, ..values };
            for i in 0..n_sparse as usize {
                let place = places.index(i) as usize;
                let element = elements.get_mut(place);
                *element.ok_or_else(|| wrong("has a sparse index beyond its end"))? =
                    read(values, i);
            }
        }
        Ok(elements)
    }

    /// The bytes of `count` elements in a view, which are all there.
    fn layout(
        &self,
        view: Index<buffer::View>,
        offset: u64,
        count: u64,
        component: ComponentType,
        kind: Type,
    ) -> Result<Layout<'a>, Fault> {
        let number = view.value();
        let view = self.root.get(view).ok_or_else(|| missing("buffer view", number))?;
        let buffer = self.buffers.get(view.buffer.value());
        let buffer = buffer.ok_or_else(|| missing("buffer", view.buffer.value()))?;
        let size = component.size() * kind.multiplicity();
        let stride = view.byte_stride.map_or(size, |stride| stride.0.max(size));
        let start = view.byte_offset.map_or(0, |offset| offset.0).checked_add(offset);
        let end = count
            .checked_sub(1)
            .map_or(Some(0), |last| last.checked_mul(stride as u64)?.checked_add(size as u64));
        let within_view = end.and_then(|end| end.checked_add(offset));
        let is_within_view = within_view.is_some_and(|end| end <= view.byte_length.0);
        let bytes = start.zip(end).and_then(|(start, end)| {
            let start = usize::try_from(start).ok()?;
            let end = start.checked_add(usize::try_from(end).ok()?)?;
            buffer.get(start..end)
        });
        let bytes = bytes.filter(|_| is_within_view).ok_or_else(|| Fault::Truncated {
            expected: format!("{count} elements of buffer view {number}"),
            found: format!("buffer {} holds {} bytes", view.buffer.value(), buffer.len()),
        })?;
        Ok(Layout { bytes, stride, component, is_normalized: false })
    }
}

impl Layout<'_> {
    /// The bytes of one component of one element, at most four.
    fn component(self, element: usize, component: usize) -> [u8; 4] {
        let size = self.component.size();
        let at = element * self.stride + component * size;
        let mut bytes = [0; 4];
        bytes[..size].copy_from_slice(&self.bytes[at..at + size]);
        bytes
    }

    fn index(self, element: usize) -> u32 {
        u32::from_le_bytes(self.component(element, 0))
    }

    fn number(self, element: usize, component: usize) -> f64 {
        let bytes = self.component(element, component);
        let [low, high, ..] = bytes;
        let (number, largest) = match self.component {
            ComponentType::I8 => (f64::from(low as i8), 127.0),
            ComponentType::U8 => (f64::from(low), 255.0),
            ComponentType::I16 => (f64::from(i16::from_le_bytes([low, high])), 32767.0),
            ComponentType::U16 => (f64::from(u16::from_le_bytes([low, high])), 65535.0),
            ComponentType::U32 => (f64::from(u32::from_le_bytes(bytes)), 4_294_967_295.0),
            ComponentType::F32 => return f64::from(f32::from_le_bytes(bytes)),
        };
        if self.is_normalized { (number / largest).max(-1.0) } else { number }
    }
}
