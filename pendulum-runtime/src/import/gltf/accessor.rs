//! Numbers from buffers, with all bounds checked.

use super::error::GltfError;
use core::cell::Cell;
use gltf::json::accessor::{Accessor, ComponentType, Type};
use gltf::json::validation::Checked;
use gltf::json::{Index, Root, buffer};

/// The greatest number of elements of an accessor without a bufferView: their number is not limited
/// by the size of the file.
const MOST: usize = 1 << 16;

/// The greatest number of elements of one motion, counted again for each channel that uses them.
const BUDGET: usize = 1 << 24;

/// The source of numbers: the buffers of a file.
#[derive(Clone, Debug)]
pub(super) struct Source<'a> {
    root: &'a Root,
    buffers: &'a [Vec<u8>],
    /// The number of elements that may still be read.
    left: Cell<usize>,
}

/// A run of elements of one type.
struct Run<'a> {
    bytes: &'a [u8],
    kind: ComponentType,
    normalized: bool,
    /// The distance between elements in bytes.
    stride: usize,
}

impl Run<'_> {
    /// Returns a component of an element; integers may be normalized as in section 3.11 of glTF
    /// 2.0.
    fn number(&self, element: usize, component: usize) -> f64 {
        let at = &self.bytes[element * self.stride + component * self.kind.size()..];
        let (value, largest) = match self.kind {
            ComponentType::I8 => (f64::from(at[0].cast_signed()), 127.0),
            ComponentType::U8 => (f64::from(at[0]), 255.0),
            ComponentType::I16 => (f64::from(i16::from_le_bytes([at[0], at[1]])), 32767.0),
            ComponentType::U16 => (f64::from(u16::from_le_bytes([at[0], at[1]])), 65535.0),
            ComponentType::U32 => {
                (f64::from(u32::from_le_bytes([at[0], at[1], at[2], at[3]])), 4294967295.0)
            }
            ComponentType::F32 => {
                return f64::from(f32::from_le_bytes([at[0], at[1], at[2], at[3]]));
            }
        };
        if !self.normalized {
            return value;
        }
        let share = value / largest;
        if share < -1.0 { -1.0 } else { share }
    }
}

impl<'a> Source<'a> {
    pub(super) fn new(root: &'a Root, buffers: &'a [Vec<u8>]) -> Self {
        Self { root, buffers, left: Cell::new(BUDGET) }
    }

    /// Reads the elements of an accessor, which must have `D` components.
    pub(super) fn read<const D: usize>(&self, index: usize) -> Result<Vec<[f64; D]>, GltfError> {
        let place = format!("accessors[{index}]");
        let fail = |what: String| GltfError::new(&*place, what, "mend the file or export it again");
        let accessor =
            self.root.accessors.get(index).ok_or_else(|| fail("does not exist".into()))?;
        let count = usize::try_from(accessor.count.0).unwrap_or(usize::MAX);
        let components = width(accessor).ok_or_else(|| fail("an unknown type".into()))?;
        if components != D {
            return Err(fail(format!("elements of {components} numbers where {D} are needed")));
        }
        let Checked::Valid(kind) = accessor.component_type else {
            return Err(fail("an unknown component type".into()));
        };
        let run = |view: Index<buffer::View>,
                   offset: u64,
                   count: usize,
                   kind: ComponentType,
                   components: usize| {
            let normalized = accessor.normalized;
            self.run(view, offset, count, kind, components)
                .map(|run| Run { normalized, ..run })
                .map_err(fail)
        };
        let whole = match accessor.buffer_view {
            Some(view) => Some(run(
                view,
                accessor.byte_offset.map_or(0, |offset| offset.0),
                count,
                kind.0,
                D,
            )?),
            None if accessor.sparse.is_none() => return Err(fail("no bufferView".into())),
            None if MOST < count => {
                return Err(fail(format!("{count} elements without a bufferView")));
            }
            None => None,
        };
        let left = self.left.get().checked_sub(count);
        self.left.set(left.ok_or_else(|| fail(format!("more than {BUDGET} keys in one motion")))?);
        let mut values = match whole {
            Some(run) => (0..count)
                .map(|element| core::array::from_fn(|component| run.number(element, component)))
                .collect(),
            None => vec![[0.0; D]; count],
        };
        if let Some(sparse) = &accessor.sparse {
            let changed = sparse.count.0;
            if (count as u64) < changed {
                return Err(fail(format!("{changed} sparse elements of {count}")));
            }
            let changed = changed as usize;
            let (indices, replaced) = (&sparse.indices, &sparse.values);
            let Checked::Valid(index_kind) = indices.component_type else {
                return Err(fail("an unknown type of sparse indices".into()));
            };
            let places = self
                .run(indices.buffer_view, indices.byte_offset.0, changed, index_kind.0, 1)
                .map_err(fail)?;
            let numbers = run(replaced.buffer_view, replaced.byte_offset.0, changed, kind.0, D)?;
            for element in 0..changed {
                let at = places.number(element, 0) as usize;
                let value = values.get_mut(at).ok_or_else(|| {
                    fail(format!("sparse element {element} replaces number {at} of {count}"))
                })?;
                *value = core::array::from_fn(|component| numbers.number(element, component));
            }
        }
        Ok(values)
    }

    /// Returns `count` elements of a view from `offset` on, which must be within its buffer.
    fn run(
        &self,
        view: Index<buffer::View>,
        offset: u64,
        count: usize,
        kind: ComponentType,
        components: usize,
    ) -> Result<Run<'a>, String> {
        let index = view.value();
        let view = self
            .root
            .buffer_views
            .get(index)
            .ok_or_else(|| format!("bufferViews[{index}] does not exist"))?;
        let number = view.buffer.value();
        let buffer =
            self.buffers.get(number).ok_or_else(|| format!("buffers[{number}] does not exist"))?;
        let start = view.byte_offset.map_or(0, |offset| offset.0);
        let within =
            start.checked_add(view.byte_length.0).filter(|&end| end <= buffer.len() as u64);
        let Some(end) = within else {
            return Err(format!(
                "bufferViews[{index}] goes beyond the {} bytes of buffers[{number}]",
                buffer.len()
            ));
        };
        let size = components * kind.size();
        let stride = view.byte_stride.map_or(size, |stride| stride.0);
        if stride < size {
            return Err(format!("elements of {size} bytes every {stride} bytes"));
        }
        let bytes = &buffer[start as usize..end as usize];
        let fits = match count.checked_sub(1) {
            None => true,
            Some(last) => (last as u64)
                .checked_mul(stride as u64)
                .and_then(|sum| sum.checked_add(size as u64))
                .and_then(|sum| sum.checked_add(offset))
                .is_some_and(|end| end <= bytes.len() as u64),
        };
        if !fits {
            return Err(format!(
                "{count} elements from byte {offset} on go beyond the {} bytes of bufferViews[{index}]",
                bytes.len()
            ));
        }
        let bytes = if count == 0 { bytes } else { &bytes[offset as usize..] };
        Ok(Run { bytes, kind, normalized: false, stride })
    }
}

/// Returns the number of components of an element; 0 for matrices, which are not supported.
fn width(accessor: &Accessor) -> Option<usize> {
    match accessor.type_ {
        Checked::Valid(Type::Scalar) => Some(1),
        Checked::Valid(Type::Vec2) => Some(2),
        Checked::Valid(Type::Vec3) => Some(3),
        Checked::Valid(Type::Vec4) => Some(4),
        Checked::Valid(Type::Mat2 | Type::Mat3 | Type::Mat4) => Some(0),
        Checked::Invalid => None,
    }
}
