//! Numbers from buffers, with all bounds checked.

use super::buffer::Buffer;
use super::error::GltfError;
use super::json::{count, index, list, member, text};
use core::cell::Cell;
use serde_json::Value;

/// The greatest number of elements of an accessor without a bufferView: their number is not limited
/// by the size of the file.
const MOST: usize = 1 << 16;

/// The greatest number of elements of one motion, counted again for each channel that uses them.
const BUDGET: usize = 1 << 24;

/// The source of numbers: the buffers of a file.
#[derive(Clone, Debug)]
pub(super) struct Source<'a> {
    root: &'a Value,
    buffers: &'a [Buffer],
    /// The number of elements that may still be read.
    left: Cell<usize>,
}

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Kind {
    /// Returns the type of a code of section 3.6.2.2.
    fn of(code: u64) -> Option<Self> {
        match code {
            5120 => Some(Self::I8),
            5121 => Some(Self::U8),
            5122 => Some(Self::I16),
            5123 => Some(Self::U16),
            5125 => Some(Self::U32),
            5126 => Some(Self::F32),
            _ => None,
        }
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }
}

/// Elements in a view from `offset` bytes on.
#[derive(Clone, Copy)]
struct Stretch {
    view: usize,
    offset: u64,
    count: usize,
    kind: Kind,
    components: usize,
}

/// A run of elements of one type.
struct Run<'a> {
    bytes: &'a [u8],
    kind: Kind,
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
            Kind::I8 => (f64::from(at[0].cast_signed()), 127.0),
            Kind::U8 => (f64::from(at[0]), 255.0),
            Kind::I16 => (f64::from(i16::from_le_bytes([at[0], at[1]])), 32767.0),
            Kind::U16 => (f64::from(u16::from_le_bytes([at[0], at[1]])), 65535.0),
            Kind::U32 => {
                (f64::from(u32::from_le_bytes([at[0], at[1], at[2], at[3]])), 4294967295.0)
            }
            Kind::F32 => {
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
    pub(super) fn new(root: &'a Value, buffers: &'a [Buffer]) -> Self {
        Self { root, buffers, left: Cell::new(BUDGET) }
    }

    /// Reads the elements of an accessor, which must have `D` components.
    pub(super) fn read<const D: usize>(&self, number: usize) -> Result<Vec<[f64; D]>, GltfError> {
        let place = format!("accessors[{number}]");
        let fail = |what: String| GltfError::new(&*place, what, "mend the file or export it again");
        let accessor = list(self.root, "accessors")
            .get(number)
            .ok_or_else(|| fail("does not exist".into()))?;
        let elements = index(accessor, "count").map_err(fail)?;
        let components = width(accessor).ok_or_else(|| fail("an unknown type".into()))?;
        if components != D {
            return Err(fail(format!("elements of {components} numbers where {D} are needed")));
        }
        let kind = kind(accessor).ok_or_else(|| fail("an unknown component type".into()))?;
        let normalized = match member(accessor, "normalized").map(Value::as_bool) {
            None => false,
            Some(Some(normalized)) => normalized,
            Some(None) => return Err(fail("its `normalized` is neither true nor false".into())),
        };
        let run = |stretch: Stretch| self.run(stretch, &fail).map(|run| Run { normalized, ..run });
        let sparse = member(accessor, "sparse");
        let whole = match member(accessor, "bufferView") {
            Some(_) => {
                let view = index(accessor, "bufferView").map_err(fail)?;
                let offset = offset(accessor).map_err(fail)?;
                Some(run(Stretch { view, offset, count: elements, kind, components })?)
            }
            None if sparse.is_none() => return Err(fail("no bufferView".into())),
            None if MOST < elements => {
                return Err(fail(format!("{elements} elements without a bufferView")));
            }
            None => None,
        };
        let left = self.left.get().checked_sub(elements);
        self.left.set(left.ok_or_else(|| fail(format!("more than {BUDGET} keys in one motion")))?);
        let mut values = match whole {
            Some(run) => (0..elements)
                .map(|element| core::array::from_fn(|component| run.number(element, component)))
                .collect(),
            None => vec![[0.0; D]; elements],
        };
        if let Some(sparse) = sparse {
            let changed = index(sparse, "count").map_err(fail)?;
            if elements < changed {
                return Err(fail(format!("{changed} sparse elements of {elements}")));
            }
            let part = |key: &str, kind: Option<Kind>, components: usize| {
                let part = &sparse[key];
                let kind = kind.or_else(|| self::kind(part));
                let kind = kind.ok_or_else(|| fail("an unknown type of sparse indices".into()))?;
                let view = index(part, "bufferView").map_err(fail)?;
                let offset = offset(part).map_err(fail)?;
                Ok(Stretch { view, offset, count: changed, kind, components })
            };
            let places = self.run(part("indices", None, 1)?, &fail)?;
            if !matches!(places.kind, Kind::U8 | Kind::U16 | Kind::U32) {
                return Err(fail("an unknown type of sparse indices".into()));
            }
            let numbers = run(part("values", Some(kind), D)?)?;
            for element in 0..changed {
                let at = places.number(element, 0) as usize;
                let value = values.get_mut(at).ok_or_else(|| {
                    fail(format!("sparse element {element} replaces number {at} of {elements}"))
                })?;
                *value = core::array::from_fn(|component| numbers.number(element, component));
            }
        }
        Ok(values)
    }

    /// Returns the elements of a stretch, which must be within its view and the view within its
    /// buffer.
    fn run(
        &self,
        stretch: Stretch,
        fail: &dyn Fn(String) -> GltfError,
    ) -> Result<Run<'a>, GltfError> {
        let Stretch { view: number, offset, count: elements, kind, components } = stretch;
        let view = list(self.root, "bufferViews")
            .get(number)
            .ok_or_else(|| fail(format!("bufferViews[{number}] does not exist")))?;
        let of_view = |what: String| fail(format!("bufferViews[{number}]: {what}"));
        let source = index(view, "buffer").map_err(of_view)?;
        let buffer = self
            .buffers
            .get(source)
            .ok_or_else(|| fail(format!("buffers[{source}] does not exist")))?;
        let buffer = buffer.as_ref().map_err(Clone::clone)?;
        let start = self::offset(view).map_err(of_view)?;
        let length = index(view, "byteLength").map_err(of_view)? as u64;
        let within = start.checked_add(length).filter(|&end| end <= buffer.len() as u64);
        let Some(end) = within else {
            return Err(fail(format!(
                "bufferViews[{number}] goes beyond the {} bytes of buffers[{source}]",
                buffer.len()
            )));
        };
        let size = components * kind.size();
        // Zero means packed, as in glTF 1.0.
        let stride = count(view, "byteStride").map_err(of_view)?.filter(|&stride| stride != 0);
        let stride = stride.map_or(size, |stride| usize::try_from(stride).unwrap_or(usize::MAX));
        if stride < size {
            return Err(fail(format!("elements of {size} bytes every {stride} bytes")));
        }
        let bytes = &buffer[start as usize..end as usize];
        let fits = match elements.checked_sub(1) {
            None => true,
            Some(last) => (last as u64)
                .checked_mul(stride as u64)
                .and_then(|sum| sum.checked_add(size as u64))
                .and_then(|sum| sum.checked_add(offset))
                .is_some_and(|end| end <= bytes.len() as u64),
        };
        if !fits {
            return Err(fail(format!(
                "{elements} elements from byte {offset} on go beyond the {} bytes of bufferViews[{number}]",
                bytes.len()
            )));
        }
        let bytes = if elements == 0 { bytes } else { &bytes[offset as usize..] };
        Ok(Run { bytes, kind, normalized: false, stride })
    }
}

/// Returns the `byteOffset` of a part, zero by default.
fn offset(part: &Value) -> Result<u64, String> {
    Ok(count(part, "byteOffset")?.unwrap_or(0))
}

/// Returns the type of the numbers of a part.
fn kind(part: &Value) -> Option<Kind> {
    count(part, "componentType").ok().flatten().and_then(Kind::of)
}

/// Returns the number of components of an element; 0 for matrices, which are not supported.
fn width(accessor: &Value) -> Option<usize> {
    match text(accessor, "type")? {
        "SCALAR" => Some(1),
        "VEC2" => Some(2),
        "VEC3" => Some(3),
        "VEC4" => Some(4),
        "MAT2" | "MAT3" | "MAT4" => Some(0),
        _ => None,
    }
}
