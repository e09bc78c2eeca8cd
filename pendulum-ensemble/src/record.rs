//! Conversion of values to bytes, for checkpoints and for other processes.

use pendulum_core::integrate::State;

/// A value that checkpoints can store, as bytes that are equal on all machines.
///
/// ```
/// use pendulum_runtime::ensemble::Record;
///
/// struct Mean { count: u64, sum: f64 }
///
/// impl Record for Mean {
///     fn write(&self, bytes: &mut Vec<u8>) {
///         (self.count, self.sum).write(bytes);
///     }
///
///     fn read(bytes: &mut &[u8]) -> Option<Self> {
///         let (count, sum) = Record::read(bytes)?;
///         Some(Self { count, sum })
///     }
/// }
/// ```
pub trait Record: Sized {
    /// Appends the value to `bytes`.
    fn write(&self, bytes: &mut Vec<u8>);

    /// Reads a value from the front of `bytes` and removes its bytes; returns `None` if they do not
    /// represent a value.
    fn read(bytes: &mut &[u8]) -> Option<Self>;
}

/// The two functions of a [`Record`], for code without this bound.
pub(super) struct Codec<P> {
    pub(super) write: fn(&P, &mut Vec<u8>),
    pub(super) read: fn(&mut &[u8]) -> Option<P>,
}

impl<P: Record> Codec<P> {
    pub(super) fn new() -> Self {
        Self { write: P::write, read: P::read }
    }
}

impl<P> Clone for Codec<P> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<P> Copy for Codec<P> {}

macro_rules! numbers {
    ($($number:ty)+) => {$(
        impl Record for $number {
            fn write(&self, bytes: &mut Vec<u8>) {
                bytes.extend(self.to_le_bytes());
            }

            fn read(bytes: &mut &[u8]) -> Option<Self> {
                let (number, rest) = bytes.split_first_chunk()?;
                *bytes = rest;
                Some(Self::from_le_bytes(*number))
            }
        }
    )+};
}

numbers! { u8 u16 u32 u64 u128 i8 i16 i32 i64 i128 f32 f64 }

impl Record for usize {
    fn write(&self, bytes: &mut Vec<u8>) {
        (*self as u64).write(bytes);
    }

    fn read(bytes: &mut &[u8]) -> Option<Self> {
        u64::read(bytes)?.try_into().ok()
    }
}

impl Record for bool {
    fn write(&self, bytes: &mut Vec<u8>) {
        u8::from(*self).write(bytes);
    }

    fn read(bytes: &mut &[u8]) -> Option<Self> {
        match u8::read(bytes)? {
            0 => Some(false),
            1 => Some(true),
            _ => None,
        }
    }
}

impl<T: Record> Record for Option<T> {
    fn write(&self, bytes: &mut Vec<u8>) {
        self.is_some().write(bytes);
        if let Some(value) = self {
            value.write(bytes);
        }
    }

    fn read(bytes: &mut &[u8]) -> Option<Self> {
        Some(if bool::read(bytes)? { Some(T::read(bytes)?) } else { None })
    }
}

impl<T: Record> Record for Vec<T> {
    fn write(&self, bytes: &mut Vec<u8>) {
        self.len().write(bytes);
        for value in self {
            value.write(bytes);
        }
    }

    fn read(bytes: &mut &[u8]) -> Option<Self> {
        // A damaged length must not cause a large allocation.
        let mut values = Self::new();
        for _ in 0..usize::read(bytes)? {
            values.push(T::read(bytes)?);
        }
        Some(values)
    }
}

impl Record for String {
    fn write(&self, bytes: &mut Vec<u8>) {
        self.len().write(bytes);
        bytes.extend(self.as_bytes());
    }

    fn read(bytes: &mut &[u8]) -> Option<Self> {
        let length = usize::read(bytes)?;
        let (text, rest) = bytes.split_at_checked(length)?;
        *bytes = rest;
        Self::from_utf8(text.to_vec()).ok()
    }
}

impl<T: Record, const K: usize> Record for [T; K] {
    fn write(&self, bytes: &mut Vec<u8>) {
        for value in self {
            value.write(bytes);
        }
    }

    fn read(bytes: &mut &[u8]) -> Option<Self> {
        let mut values = Vec::with_capacity(K);
        for _ in 0..K {
            values.push(T::read(bytes)?);
        }
        values.try_into().ok()
    }
}

impl Record for () {
    fn write(&self, _: &mut Vec<u8>) {}

    fn read(_: &mut &[u8]) -> Option<Self> {
        Some(())
    }
}

macro_rules! tuples {
    ($(($($member:ident $index:tt),+))+) => {$(
        impl<$($member: Record),+> Record for ($($member,)+) {
            fn write(&self, bytes: &mut Vec<u8>) {
                $(self.$index.write(bytes);)+
            }

            fn read(bytes: &mut &[u8]) -> Option<Self> {
                Some(($($member::read(bytes)?,)+))
            }
        }
    )+};
}

tuples! {
    (A 0)
    (A 0, B 1)
    (A 0, B 1, C 2)
    (A 0, B 1, C 2, D 3)
    (A 0, B 1, C 2, D 3, E 4)
    (A 0, B 1, C 2, D 3, E 4, F 5)
}

impl<T: Record, const N: usize> Record for State<T, N> {
    fn write(&self, bytes: &mut Vec<u8>) {
        self.t.write(bytes);
        self.q.write(bytes);
        self.v.write(bytes);
    }

    fn read(bytes: &mut &[u8]) -> Option<Self> {
        Some(Self { t: f64::read(bytes)?, q: Record::read(bytes)?, v: Record::read(bytes)? })
    }
}

/// Returns the hash FNV-1a of Fowler, Noll and Vo.
pub(super) fn hash(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, &byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3)
    })
}

#[cfg(test)]
mod tests {
    use super::Record;
    use core::fmt::Debug;
    use pendulum_core::integrate::State;

    fn same<T: Record + PartialEq + Debug>(value: &T) {
        let mut bytes = Vec::new();
        value.write(&mut bytes);
        let mut rest = &bytes[..];
        assert_eq!(T::read(&mut rest).as_ref(), Some(value));
        assert!(rest.is_empty());
        for length in 0..bytes.len() {
            assert_ne!(T::read(&mut &bytes[..length]).as_ref(), Some(value), "{length} bytes");
        }
    }

    #[test]
    fn values_come_back() {
        same(&(1_u8, -2_i64, 3.5_f64, f32::INFINITY, usize::MAX, true));
        same(&vec![Some([1.0, -0.0]), None]);
        same(&("θ and λ".to_string(), (), vec![String::new()]));
        same(&State { t: 0.1, q: [1.0, 2.0], v: [3.0, 4.0] });
    }

    #[test]
    fn damaged_lengths_do_not_ask_for_memory() {
        let bytes = [0xff; 16];
        assert_eq!(Vec::<f64>::read(&mut &bytes[..]), None);
        assert_eq!(String::read(&mut &bytes[..]), None);
        assert_eq!(bool::read(&mut &bytes[..]), None);
    }
}
